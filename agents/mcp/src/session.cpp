#include "saphira/mcp/session.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace saphira::mcp {

namespace {

constexpr std::array kRevisions{"2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05"};
constexpr int kParseError = -32700;
constexpr int kBadRequest = -32600;
constexpr int kNoMethod = -32601;
constexpr int kBadParameters = -32602;
constexpr std::size_t kDeepest = 16;

bool is_id(const Json& id) {
  return id.is_string() || id.is_number_integer();
}

Json member(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? Json() : *found;
}

Json describe(const Tool& tool) {
  return {{"name", tool.name},
          {"description", tool.description},
          {"inputSchema", tool.input},
          {"annotations",
           {{"readOnlyHint", tool.reads}, {"destructiveHint", false}, {"openWorldHint", false}}}};
}

bool has_type(const Json& value, const std::string& type) {
  if (type == "number")
    return value.is_number();
  if (type == "integer")
    return value.is_number_integer();
  if (type == "string")
    return value.is_string();
  if (type == "boolean")
    return value.is_boolean();
  if (type == "object")
    return value.is_object();
  return type != "null" || value.is_null();
}

std::string misfit_at(const std::string& where, const Json& value, const Json& schema) {
  const std::string who = where.empty() ? "the arguments" : "\"" + where + "\"";
  if (const Json type = member(schema, "type"); type.is_string() && !has_type(value, type))
    return who + ": expected " + type.get<std::string>() + ", found " + value.dump().substr(0, 60);
  if (const Json choices = member(schema, "enum");
      choices.is_array() && std::find(choices.begin(), choices.end(), value) == choices.end())
    return who + ": expected one of " + choices.dump() + ", found " + value.dump().substr(0, 60);
  if (value.is_number()) {
    const double number = value.get<double>();
    const Json low = member(schema, "minimum");
    const Json high = member(schema, "maximum");
    if ((low.is_number() && !(number >= low.get<double>())) ||
        (high.is_number() && !(number <= high.get<double>())))
      return who + ": expected a number" + (low.is_number() ? " from " + low.dump() : "") +
             (high.is_number() ? " up to " + high.dump() : "") + ", found " + value.dump();
  }
  if (!value.is_object())
    return {};
  const Json properties = member(schema, "properties");
  for (const Json& name : member(schema, "required"))
    if (!value.contains(name.get<std::string>()))
      return (where.empty() ? "" : who + ": ") + name.dump() + " is missing";
  for (const auto& [name, inner] : value.items()) {
    const Json of = properties.is_object() ? member(properties, name.c_str()) : Json();
    if (of.is_null()) {
      if (member(schema, "additionalProperties") == false)
        return "there is no argument \"" + name.substr(0, 60) + "\"";
      continue;
    }
    if (std::string why = misfit_at(where.empty() ? name : where + "." + name, inner, of);
        !why.empty())
      return why;
  }
  return {};
}

}  // namespace

std::string misfit(const Json& arguments, const Json& schema) {
  return misfit_at({}, arguments, schema);
}

void Session::set_tools(std::vector<Tool> tools) {
  std::sort(tools.begin(), tools.end(),
            [](const Tool& a, const Tool& b) { return a.name < b.name; });
  if (tools == tools_)
    return;
  tools_ = std::move(tools);
  if (begun_)
    send({{"jsonrpc", "2.0"}, {"method", "notifications/tools/list_changed"}});
}

void Session::reply(const Json& id, Json result) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
}

void Session::error(const Json& id, int code, const std::string& text) {
  send({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}});
}

void Session::take(std::string_view line) {
  if (line.find_first_not_of(" \t\r") == std::string_view::npos)
    return;
  if (line.size() > kLongestLine)
    return error(nullptr, kBadRequest,
                 "a message has at most " + std::to_string(kLongestLine) + " bytes");
  bool deep = false;
  const Json message = Json::parse(
      line.begin(), line.end(),
      [&deep](int depth, Json::parse_event_t /*event*/, Json& /*parsed*/) {
        deep = deep || depth > static_cast<int>(kDeepest);
        return !deep;
      },
      false);
  if (message.is_discarded() || deep)
    return error(nullptr, kParseError,
                 deep ? "nested too deeply" : "this is no JSON: one message a line is expected");
  const Json method = message.is_object() ? member(message, "method") : Json();
  const Json id = message.is_object() ? member(message, "id") : Json();
  if (!method.is_string()) {
    // An answer to a request: none was made.
    if (!message.is_object() || !(message.contains("result") || message.contains("error")))
      error(is_id(id) ? id : Json(), kBadRequest, "expected a request with a method");
    return;
  }
  Json parameters = member(message, "params");
  if (parameters.is_null())
    parameters = Json::object();
  if (!parameters.is_object())
    return error(is_id(id) ? id : Json(), kBadParameters, "params: expected an object");
  if (id.is_null()) {
    if (method == "notifications/cancelled")
      give_up(parameters);
    return;
  }
  if (!is_id(id))
    return error(nullptr, kBadRequest, "id: expected a text or a whole number");
  request(method, id, parameters);
}

void Session::request(const std::string& method, const Json& id, const Json& parameters) {
  if (method == "initialize") {
    const Json asked = member(parameters, "protocolVersion");
    const bool known = std::find(kRevisions.begin(), kRevisions.end(), asked) != kRevisions.end();
    begun_ = true;
    return reply(id, {{"protocolVersion", known ? asked : Json(kRevisions.front())},
                      {"capabilities", {{"tools", {{"listChanged", true}}}}},
                      {"serverInfo", {{"name", name_}, {"version", version_}}},
                      {"instructions", instructions_}});
  }
  if (method == "ping")
    return reply(id, Json::object());
  if (method == "tools/list") {
    Json list = Json::array();
    for (const Tool& tool : tools_)
      list.push_back(describe(tool));
    return reply(id, {{"tools", std::move(list)}});
  }
  if (method == "tools/call")
    return call(id, parameters);
  error(id, kNoMethod, "there is no method \"" + method.substr(0, 60) + "\"");
}

void Session::call(const Json& id, const Json& parameters) {
  const Json name = member(parameters, "name");
  const auto tool = std::find_if(tools_.begin(), tools_.end(),
                                 [&](const Tool& each) { return name == each.name; });
  if (tool == tools_.end())
    return error(id, kBadParameters, "there is no tool " + name.dump().substr(0, 70));
  Json arguments = member(parameters, "arguments");
  if (arguments.is_null())
    arguments = Json::object();
  const std::uint64_t number = ++count_;
  const Json meta = member(parameters, "_meta");
  open_[number] = {id, meta.is_object() ? member(meta, "progressToken") : Json()};
  if (const std::string why = misfit(arguments, tool->input); !why.empty())
    return answer(number, {"not done: " + why, nullptr, true});
  if (open_.size() > kMostOpen)
    return answer(number, {"not done: too many calls are not answered yet; wait for one of them",
                           nullptr, true});
  calls_.push_back({number, tool->name, std::move(arguments)});
}

void Session::give_up(const Json& parameters) {
  const Json id = member(parameters, "requestId");
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [&](const auto& each) { return each.second.id == id; });
  if (found == open_.end())
    return;
  const std::uint64_t number = found->first;
  open_.erase(found);
  std::erase_if(calls_, [&](const Call& each) { return each.number == number; });
  given_up_.push_back(number);
}

void Session::answer(std::uint64_t call, const Result& result) {
  const auto found = open_.find(call);
  if (found == open_.end())
    return;
  Json json{{"content", {{{"type", "text"}, {"text", result.text}}}}, {"isError", result.is_error}};
  if (result.value.is_object())
    json["structuredContent"] = result.value;
  reply(found->second.id, std::move(json));
  open_.erase(found);
}

void Session::progress(std::uint64_t call, double value, const std::string& text) {
  const auto found = open_.find(call);
  if (found == open_.end() || found->second.token.is_null())
    return;
  send({{"jsonrpc", "2.0"},
        {"method", "notifications/progress"},
        {"params",
         {{"progressToken", found->second.token}, {"progress", value}, {"message", text}}}});
}

std::vector<Call> Session::take_calls() {
  return std::exchange(calls_, {});
}

std::vector<std::uint64_t> Session::take_given_up() {
  return std::exchange(given_up_, {});
}

std::vector<std::string> Session::take_lines() {
  return std::exchange(lines_, {});
}

}  // namespace saphira::mcp
