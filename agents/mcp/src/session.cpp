#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "protocol.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/mcp/results.hpp"

namespace saphira::mcp {

namespace {

constexpr const char* kStructured = "2025-06-18";  // the first with structured results
constexpr const char* kBatches = "2025-03-26";     // the only one with batches
constexpr std::array kRevisions{Session::kLegacy, kStructured, kBatches, "2024-11-05"};
constexpr int kParseError = -32700;
constexpr int kNoMethod = -32601;
constexpr int kInternal = -32603;
constexpr int kBadHeader = -32020;
constexpr int kBadVersion = -32022;
constexpr std::size_t kDeepest = 16;
constexpr std::size_t kLongestName = 40;
const std::string kQuestion = "question ";  // begins the id of a question to a person

bool is_id(const Json& id) {
  return id.is_string() || id.is_number_integer();
}

/// The client can show its person a form: it says so, or says nothing of other ways.
bool has_forms(const Json& capabilities) {
  const Json elicitation = member(capabilities, "elicitation");
  return elicitation.is_object() && (elicitation.contains("form") || !elicitation.contains("url"));
}

bool is_answer(const Json& message) {
  return message.is_object() && !message.contains("method") &&
         (message.contains("result") || message.contains("error"));
}

bool is_task_method(const std::string& method) {
  return method == "tasks/get" || method == "tasks/cancel" || method == "tasks/update";
}

struct Parsed {
  Json json;          ///< discarded: it is none
  bool deep = false;  ///< for it is nested too deeply for copies, which are recursive
};
Parsed parsed(std::string_view text) {
  Parsed parsed;
  parsed.json = Json::parse(
      text.begin(), text.end(),
      [&parsed](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
        parsed.deep = parsed.deep || depth > static_cast<int>(kDeepest);
        return !parsed.deep;
      },
      false);
  return parsed;
}

Json describe(const Tool& tool, bool structured) {
  Json json{{"name", tool.name},
            {"description", tool.description},
            {"inputSchema", tool.input},
            {"annotations",
             {{"readOnlyHint", tool.reads}, {"destructiveHint", false}, {"openWorldHint", false}}}};
  if (structured && !tool.output.is_null())
    json["outputSchema"] = tool.output;
  return json;
}

}  // namespace

Sender sender_of(std::string_view message) {
  Sender sender;
  if (message.size() > Session::kLongestLine)
    return sender;
  const Json json = parsed(message).json;
  sender.answers = is_answer(json) || (json.is_array() && std::ranges::any_of(json, is_answer));
  if (!json.is_object())
    return sender;
  const Json& parameters = member(json, "params");
  const Json& meta = member(parameters, "_meta");
  sender.begins = member(json, "method") == "initialize";
  sender.modern = meta.is_object() && meta.contains(kMeta + "protocolVersion");
  const Json& info =
      sender.begins ? member(parameters, "clientInfo") : member(meta, kMeta + "clientInfo");
  if (sender.modern)
    sender.client = info.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (const Json& name = member(info, "name"); name.is_string())
    sender.name = one_line(std::string(first_letters(name.get<std::string>(), kLongestName)));
  if (const Json& tool = member(parameters, "name");
      member(json, "method") == "tools/call" && tool.is_string())
    sender.tool = tool.get<std::string>();
  return sender;
}

void Session::wait_for_tools(bool waits) {
  waits_ = waits;
  if (waits_)
    return;
  for (const Held& held : std::exchange(held_, {}))
    ask_either(held.method, held.request, held.parameters);
}

bool Session::leave() {
  left_ = true;
  return !held_.empty() || std::ranges::any_of(open_, [](const auto& each) {
    return !each.second.watches && each.second.task.empty();
  });
}

void Session::ping() {
  send({{"jsonrpc", "2.0"}, {"id", "ping " + std::to_string(++pings_)}, {"method", "ping"}}, 0);
}

std::uint64_t Session::ask_person(const std::string& question, std::uint64_t call) {
  const auto found = open_.find(call);
  const bool modern = found != open_.end() && found->second.request.modern;
  if (modern ? !found->second.request.elicits : !elicits_)
    return 0;
  const std::uint64_t number = ++questions_;
  const Json yes{{"type", "boolean"}, {"title", "Yes, let the robot begin"}, {"default", false}};
  Json request{{"method", "elicitation/create"},
               {"params",
                {{"message", question},
                 {"requestedSchema",
                  {{"type", "object"}, {"properties", {{"yes", yes}}}, {"required", {"yes"}}}}}}};
  if (modern)
    request["params"]["mode"] = "form";
  if (asked_.size() >= kMostOpen)
    asked_.erase(asked_.begin());
  Question& asked = asked_[number] = {std::move(request)};
  if (!modern) {
    Json message = asked.request;
    message.update({{"jsonrpc", "2.0"}, {"id", kQuestion + std::to_string(number)}});
    // It belongs to the call, on whose connection a client without a stream hears it, too.
    send(message, found == open_.end() ? 0 : found->second.request.exchange);
  } else if (!found->second.task.empty()) {
    asked.task = found->second.task;
    tasks_[asked.task].state["inputRequests"] = {
        {kQuestion + std::to_string(number), asked.request}};
    change_task(asked.task, "input_required", question);
  } else {
    asked.tool = found->second.tool;
    note(asked.tool, "asks the person at the client", false);
    const Request of_call = found->second.request;
    open_.erase(found);
    require(of_call, number);
  }
  return number;
}

/// Answers a call with the question: the client repeats the call with the answer.
void Session::require(const Request& request, std::uint64_t question) {
  const std::string key = kQuestion + std::to_string(question);
  reply(request, {{"resultType", "input_required"},
                  {"inputRequests", {{key, asked_.at(question).request}}},
                  {"requestState", key}});
}

void Session::take_back(std::uint64_t question) {
  const auto found = asked_.find(question);
  if (found == asked_.end() || !found->second.tool.empty())
    return;  // the client repeats its call, and gets the newest state
  const std::string task = found->second.task;
  asked_.erase(found);
  if (task.empty())
    send({{"jsonrpc", "2.0"},
          {"method", "notifications/cancelled"},
          {"params", {{"requestId", kQuestion + std::to_string(question)}}}},
         0);
  else
    tasks_[task].state.erase("inputRequests");
}

bool Session::is_silent_for(std::uint64_t question) const {
  const auto found = asked_.find(question);
  return found != asked_.end() && !found->second.tool.empty();
}

std::vector<std::pair<std::uint64_t, bool>> Session::take_consents() {
  return std::exchange(consents_, {});
}

/// The number in the name of a question; 0: it is none.
std::uint64_t Session::question_of(const Json& name) {
  if (!name.is_string() || !name.get<std::string>().starts_with(kQuestion))
    return 0;
  return number_in<std::uint64_t>(name.get<std::string>().substr(kQuestion.size())).value_or(0);
}

/// True where the question was open.
bool Session::take_response(std::uint64_t question, const Json& response) {
  if (asked_.erase(question) == 0)
    return false;
  consents_.emplace_back(question, member(response, "action") == "accept" &&
                                       member(member(response, "content"), "yes") == true);
  return true;
}

/// An error is nobody's answer: the question is open for the page and for commands.
void Session::take_answer(const Json& message) {
  if (message.contains("result"))
    take_response(question_of(member(message, "id")), message["result"]);
}

/// A stop is never held back.
bool Session::has_to_wait(const std::string& method, const Json& parameters) const {
  if (!waits_)
    return false;
  const Json name = member(parameters, "name");
  if (method == "tools/call")
    return std::ranges::none_of(tools_,
                                [&](const Tool& each) { return each.always && name == each.name; });
  return method == "tools/list" || method == "resources/list" || method == "resources/read" ||
         method == "resources/subscribe" || method == "subscriptions/listen";
}

void Session::hold(const std::string& method, const Request& request, const Json& parameters) {
  if (held_.size() >= kMostOpen)
    return error(request, kInternal,
                 "the tools of the robot are not known yet, and too many requests wait for them");
  held_.push_back({method, request, parameters});
}

void Session::reply(const Request& request, Json result) {
  if (request.modern) {
    result.emplace("resultType", "complete");
    result["_meta"][kMeta + "serverInfo"] = {{"name", name_}, {"version", version_}};
  }
  respond(request, {{"jsonrpc", "2.0"}, {"id", request.id}, {"result", std::move(result)}}, 200);
}

bool Session::structures(const Request& request) const {
  return request.modern || revision_ >= kStructured;
}

/// The last message of a request.
void Session::respond(const Request& request, Json message, int status) {
  const auto batch = batches_.find(request.batch);
  if (batch == batches_.end())
    return send(message, request.exchange, true, status);
  batch->second.answers.push_back(std::move(message));
  settle(request.batch, request.exchange);
}

/// A message of a batch gets no further answer.
void Session::settle(std::uint64_t number, std::uint64_t exchange) {
  const auto batch = batches_.find(number);
  if (batch == batches_.end() || --batch->second.waits > 0)
    return;
  if (!batch->second.answers.empty())
    send(batch->second.answers, exchange, true);
  batches_.erase(batch);
}

void Session::error(const Request& request, int code, const std::string& text, Json data) {
  Json error{{"code", code}, {"message", text}};
  if (!data.is_null())
    error["data"] = std::move(data);
  Json message{{"jsonrpc", "2.0"}, {"error", std::move(error)}};
  // A client of the newer era expects no id where none was readable.
  if (!request.modern || !request.id.is_null())
    message["id"] = request.id;
  respond(request, std::move(message),
          request.id.is_null() ? 400
          : !request.modern    ? 200
          : code == kNoMethod  ? 404
                               : 400);
}

bool Session::take(std::string_view text, std::uint64_t exchange, const Headers* headers) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos && headers == nullptr)
    return false;
  Request request{nullptr, exchange, headers != nullptr && headers->version == kModern};
  const auto wrong = [&](int code, const std::string& why) {
    error(request, code, why);
    return true;
  };
  if (text.size() > kLongestLine)
    return wrong(kBadRequest, "a message has at most " + std::to_string(kLongestLine) + " bytes");
  const auto [message, deep] = parsed(text);
  if (message.is_discarded() || deep)
    return wrong(kParseError,
                 deep ? "nested too deeply"
                      : "this is no JSON: one message is expected, and numbers must be finite "
                        "(no NaN, Infinity or 1e400)");
  if (message.is_array() && revision_ == kBatches && !request.modern && !message.empty())
    return take_batch(message, exchange, headers);
  return take_message(message, request, headers);
}

bool Session::take_batch(const Json& messages, std::uint64_t exchange, const Headers* headers) {
  const std::uint64_t number = ++batch_count_;
  batches_[number].waits = messages.size() + 1;
  bool answers = false;
  for (const Json& message : messages)
    if (take_message(message, {nullptr, exchange, false, number}, headers))
      answers = true;
    else
      settle(number, exchange);
  settle(number, exchange);
  return answers;
}

bool Session::take_message(const Json& message, Request request, const Headers* headers) {
  const auto wrong = [&](int code, const std::string& why) {
    error(request, code, why);
    return true;
  };
  const Json method = message.is_object() ? member(message, "method") : Json();
  if (const Json id = message.is_object() ? member(message, "id") : Json(); is_id(id))
    request.id = id;
  const bool has_id = message.is_object() && message.contains("id");
  if (!method.is_string()) {
    if (is_answer(message)) {
      take_answer(message);
      return false;
    }
    return wrong(kBadRequest,
                 message.is_array()
                     ? std::string("a batch of messages is of the revision ") + kBatches + " alone"
                     : "expected a request with a method");
  }
  Json parameters = member(message, "params");
  if (parameters.is_null())
    parameters = Json::object();
  if (!parameters.is_object())
    return wrong(kBadParameters, "params: expected an object");
  if (!has_id || message["id"].is_null()) {
    if (method == "notifications/cancelled")
      give_up(parameters, request.exchange);
    return false;
  }
  if (request.id.is_null())
    return wrong(kBadRequest, "id: expected a text or a whole number");
  const Json meta = member(parameters, "_meta");
  request.modern = request.modern || (meta.is_object() && meta.contains(kMeta + "protocolVersion"));
  if (headers != nullptr && !fits(method, request, parameters, *headers))
    return true;
  if (request.modern)
    ask_modern(method, request, parameters);
  else
    ask(method, request, parameters);
  return true;
}

/// True where the headers agree with the message; otherwise the client gets an error.
bool Session::fits(const std::string& method, const Request& request, const Json& parameters,
                   const Headers& headers) {
  if (!request.modern) {
    // Before the answer to `initialize` a client cannot know the version.
    if (headers.version.empty() ||
        std::ranges::find(kRevisions, headers.version) != kRevisions.end())
      return true;
    respond(request,
            {{"jsonrpc", "2.0"},
             {"id", request.id},
             {"error",
              {{"code", kBadRequest},
               {"message",
                "MCP-Protocol-Version: there is no version " + headers.version.substr(0, 40)}}}},
            400);
    return false;
  }
  const auto wrong = [&](const std::string& header, const std::string& found,
                         const Json& expected) {
    error(request, kBadHeader,
          header + ": " + (found.empty() ? "missing" : "\"" + found.substr(0, 70) + "\"") +
              ", and the message says " + expected.dump().substr(0, 70));
    return false;
  };
  const Json version = member(member(parameters, "_meta"), kMeta + "protocolVersion");
  if (version.is_string() && version != headers.version)
    return wrong("MCP-Protocol-Version", headers.version, version);
  if (method != headers.method)
    return wrong("Mcp-Method", headers.method, method);
  const std::string names = method == "tools/call"       ? "name"
                            : method == "resources/read" ? "uri"
                            : is_task_method(method)     ? "taskId"
                                                         : "";
  if (const Json name = member(parameters, names); name.is_string() && name != headers.name)
    return wrong("Mcp-Name", headers.name, name);
  return true;
}

void Session::ask(const std::string& method, const Request& request, const Json& parameters) {
  if (method == "initialize") {
    const Json asked = member(parameters, "protocolVersion");
    const bool known = std::ranges::find(kRevisions, asked) != kRevisions.end();
    older().tools = true;
    elicits_ = has_forms(member(parameters, "capabilities"));
    revision_ = known ? asked.get<std::string>() : kLegacy;
    return reply(request, {{"protocolVersion", revision_},
                           {"capabilities", capabilities(false)},
                           {"serverInfo", {{"name", name_}, {"version", version_}}},
                           {"instructions", instructions_}});
  }
  if (method == "ping")
    return reply(request, Json::object());
  ask_either(method, request, parameters);
}

/// The methods that both eras have.
void Session::ask_either(const std::string& method, const Request& request,
                         const Json& parameters) {
  if (has_to_wait(method, parameters))
    return hold(method, request, parameters);
  if (method == "tools/list")
    return list_tools(request);
  if (method == "tools/call")
    return call(request, parameters);
  if (method == "resources/list")
    return list_resources(request);
  if (method == "prompts/list")
    return list(request, prompts());
  if (method == "prompts/get") {
    Json arguments = member(parameters, "arguments");
    Json got =
        prompt(member(parameters, "name"), arguments.is_object() ? arguments : Json::object());
    return got.is_string() ? error(request, kBadParameters, got.get<std::string>())
                           : reply(request, std::move(got));
  }
  if (method == "resources/templates/list")
    return list(request, {{"resourceTemplates", Json::array()}});
  if (method == "resources/read")
    return read(request, parameters);
  if (method == "subscriptions/listen" && request.modern)
    return listen(request, parameters);
  if ((method == "resources/subscribe" || method == "resources/unsubscribe") && !request.modern)
    return subscribe(request, member(parameters, "uri"), method == "resources/subscribe");
  error(request, kNoMethod, "there is no method \"" + method.substr(0, 60) + "\"");
}

void Session::ask_modern(const std::string& method, Request request, const Json& parameters) {
  const Json meta = member(parameters, "_meta");
  const Json version = member(meta, kMeta + "protocolVersion");
  if (!version.is_string())
    return error(request, kBadParameters, "_meta: " + kMeta + "protocolVersion is missing");
  if (version != kModern)
    return error(request, kBadVersion, "Unsupported protocol version",
                 {{"supported", {kModern}}, {"requested", version}});
  if (!member(meta, kMeta + "clientCapabilities").is_object())
    return error(request, kBadParameters, "_meta: " + kMeta + "clientCapabilities is missing");
  request.elicits = has_forms(member(meta, kMeta + "clientCapabilities"));
  if (method == "server/discover")
    return reply(request, {{"supportedVersions", {kModern}},
                           {"capabilities", capabilities(true)},
                           {"instructions", instructions_},
                           {"ttlMs", 3600000},
                           {"cacheScope", "public"}});
  if (is_task_method(method))
    return ask_task(method, request, parameters);
  ask_either(method, request, parameters);
}

Json Session::capabilities(bool modern) const {
  Json all{{"tools", {{"listChanged", true}}},
           {"resources", {{"subscribe", true}}},
           {"prompts", Json::object()}};
  if (modern)
    all["extensions"][kTasks] = Json::object();
  return all;
}

void Session::list_tools(const Request& request) {
  Json all = Json::array();
  for (const Tool& tool : tools_)
    if (!tool.apart)
      all.push_back(describe(tool, structures(request)));
  list(request, {{"tools", std::move(all)}});
}

void Session::list_resources(const Request& request) {
  Json all = Json::array();
  for (const Tool& tool : tools_)
    if (is_resource(tool))
      all.push_back({{"uri", kResources + tool.name},
                     {"name", tool.name},
                     {"description", tool.description},
                     {"mimeType", "text/plain"}});
  list(request, {{"resources", std::move(all)}});
}

/// The tool behind a resource; null: there is none.
const Tool* Session::resource(const Json& uri) const {
  const auto tool = std::ranges::find_if(
      tools_, [&](const Tool& each) { return is_resource(each) && uri == kResources + each.name; });
  return tool == tools_.end() ? nullptr : &*tool;
}

void Session::no_resource(const Request& request, const Json& uri) {
  error(request, request.modern ? kBadParameters : kNoResource,
        "there is no resource " + uri.dump().substr(0, 100), {{"uri", uri}});
}

/// The answer of the tool behind a resource.
void Session::read(const Request& request, const Json& parameters) {
  const Json uri = member(parameters, "uri");
  const Tool* const tool = resource(uri);
  if (tool == nullptr)
    return no_resource(request, uri);
  call(request, {{"name", tool->name}}, uri);
}

/// An answer that is not to be kept: it changes with the programs that run.
void Session::list(const Request& request, Json result) {
  if (request.modern) {
    result["ttlMs"] = 0;
    result["cacheScope"] = "private";
  }
  reply(request, std::move(result));
}

/// [s] until a further call is allowed; 0: now, which counts it.
double Session::too_soon() {
  allowed_ = std::min(kMostAtOnce, allowed_ + (time_ - counted_) * kMostASecond);
  counted_ = time_;
  if (allowed_ < 1.0)
    return (1.0 - allowed_) / kMostASecond;
  allowed_ -= 1.0;
  return 0.0;
}

void Session::call(const Request& request, const Json& parameters, const Json& uri) {
  const Json name = member(parameters, "name");
  const auto tool =
      std::ranges::find_if(tools_, [&](const Tool& each) { return name == each.name; });
  if (tool == tools_.end()) {
    std::vector<std::string> names;
    for (const Tool& each : tools_)
      names.push_back(each.name);
    const std::string why = "there is no tool " + name.dump().substr(0, 70) +
                            did_you_mean(name.is_string() ? name.get<std::string>() : "", names);
    note("call", why, true);
    return error(request, kBadParameters, why);
  }
  Json arguments = member(parameters, "arguments");
  if (arguments.is_null())
    arguments = Json::object();
  const std::uint64_t number = ++count_;
  open_[number] = {request, tool->name, member(member(parameters, "_meta"), "progressToken"), uri};
  const auto refuse = [&](const std::string& why) {
    answer(number, {"not done: " + why, nullptr, true});
  };
  drop_nulls(arguments, tool->input);
  if (arguments.dump(-1, ' ', false, Json::error_handler_t::replace).size() > kLongestArguments)
    return refuse("the arguments have at most " + std::to_string(kLongestArguments) + " bytes");
  if (tool->name == kOthers && misfit(arguments, tool->input).empty()) {
    const Json meant = member(arguments, "name");
    if (meant.is_null())
      return answer(number, others());
    if (std::ranges::any_of(tools_,
                            [&](const Tool& each) { return each.apart && meant == each.name; })) {
      open_.erase(number);
      Json inner = parameters;
      inner["name"] = meant;
      inner["arguments"] = member(arguments, "arguments");
      return call(request, inner, uri);
    }
    return refuse("there is no other activity " + meant.dump().substr(0, 70) +
                  "; without a name this tool lists them");
  }
  if (const std::string why = misfit(arguments, tool->input); !why.empty())
    return refuse(why);
  if (left_ && tool->lasts)
    return refuse("the input of this client has ended, and a goal ends with its client");
  if (!tool->always) {
    if (open_.size() > kMostOpen)
      return refuse("too many calls are not answered yet; wait for one of them");
    if (const double wait = too_soon(); wait > 0.0)
      return refuse("at most 5 calls a second; again in " + Json(std::ceil(wait * 10) / 10).dump() +
                    " s");
  }
  std::uint64_t question = 0;
  if (const Json state = member(parameters, "requestState"); request.modern && !state.is_null()) {
    question = question_of(state);
    const auto asked = asked_.find(question);
    if (asked == asked_.end() || asked->second.tool != tool->name) {
      open_.erase(number);
      return error(request, kBadParameters, "requestState: there is no such question of this call");
    }
    const Json response = member(member(parameters, "inputResponses"), state);
    if (response.is_null()) {
      open_.erase(number);
      return require(request, question);
    }
    take_response(question, response);
  }
  const bool as_task = tool->lasts && request.modern && has_tasks(parameters);
  calls_.push_back({number, tool->name, std::move(arguments), as_task, !uri.is_null(), question});
}

Result Session::others() const {
  Result result{{}, {{"activities", Json::array()}}, false};
  for (const Tool& tool : tools_) {
    if (!tool.apart)
      continue;
    result.value["activities"].push_back(tool.name);
    result.text += tool.name + ": " + tool.description + "; arguments " +
                   member(tool.input, "properties").dump() + "\n";
  }
  return result;
}

void Session::note(const std::string& tool, const std::string& text, bool is_error) {
  if (outcomes_.size() < kMostOpen)
    outcomes_.push_back({tool, text, is_error});
}

void Session::erase(std::uint64_t number) {
  if (const auto found = open_.find(number); found != open_.end()) {
    note(found->second.tool, "given up by the client", false);
    settle(found->second.request.batch, found->second.request.exchange);
    open_.erase(found);
  }
  std::erase_if(calls_, [&](const Call& each) { return each.number == number; });
  given_up_.push_back(number);
}

void Session::give_up(const Json& parameters, std::uint64_t exchange) {
  const Json id = member(parameters, "requestId");
  if (!is_id(id))
    return;
  std::erase_if(listeners_, [&](const Listener& each) {
    return each.request.id == id && each.request.exchange == exchange;
  });
  const auto found = std::ranges::find_if(open_, [&](const auto& each) {
    const Request& request = each.second.request;
    // Clients of the newer era may share this session, so an id is unique within a connection only.
    return request.id == id && (!request.modern || request.exchange == exchange) &&
           each.second.task.empty();
  });
  if (found != open_.end())
    return erase(found->first);
  const auto held = std::ranges::find_if(held_, [&](const Held& each) {
    return each.request.id == id && (!each.request.modern || each.request.exchange == exchange);
  });
  if (held == held_.end())
    return;
  settle(held->request.batch, held->request.exchange);
  held_.erase(held);
}

void Session::close(std::uint64_t exchange) {
  std::erase_if(listeners_, [&](const Listener& each) {
    return each.request.modern && each.request.exchange == exchange;
  });
  std::erase_if(held_, [&](const Held& each) {
    return each.request.modern && each.request.exchange == exchange;
  });
  std::vector<std::uint64_t> gone;
  for (const auto& [number, each] : open_)
    if (each.request.modern && each.request.exchange == exchange && each.task.empty())
      gone.push_back(number);
  for (const std::uint64_t number : gone)
    erase(number);
}

void Session::answer(std::uint64_t call, const Result& told) {
  const auto found = open_.find(call);
  if (found == open_.end())
    return;
  const Result result{for_model(told.text), for_model(told.value), told.is_error, told.jpeg};
  const Open open = std::move(found->second);
  open_.erase(found);
  if (open.watches)
    return see(open.uri, result.text);
  note(open.tool, result.text, result.is_error);
  if (!open.uri.is_null() && result.is_error)
    return error(open.request, kInternal, result.text, {{"uri", open.uri}});
  if (!open.uri.is_null())
    return list(
        open.request,
        {{"contents", {{{"uri", open.uri}, {"mimeType", "text/plain"}, {"text", result.text}}}}});
  Json json{{"content", {{{"type", "text"}, {"text", result.text}}}}, {"isError", result.is_error}};
  if (!result.jpeg.empty())
    json["content"].push_back(
        {{"type", "image"}, {"data", result.jpeg}, {"mimeType", "image/jpeg"}});
  if (result.value.is_object() && structures(open.request))
    json["structuredContent"] = result.value;
  if (!open.task.empty())
    return end_task(open.task, std::move(json), result);
  reply(open.request, std::move(json));
}

void Session::progress(std::uint64_t call, double value, const std::string& text) {
  const auto found = open_.find(call);
  if (found != open_.end() && !found->second.task.empty())
    return change_task(found->second.task, "working", for_model(text));
  if (found == open_.end() || found->second.token.is_null())
    return;
  send({{"jsonrpc", "2.0"},
        {"method", "notifications/progress"},
        {"params",
         {{"progressToken", found->second.token},
          {"progress", value},
          {"message", for_model(text)}}}},
       found->second.request.exchange);
}

std::vector<Call> Session::take_calls() {
  return std::exchange(calls_, {});
}

std::vector<std::uint64_t> Session::take_given_up() {
  return std::exchange(given_up_, {});
}

std::vector<Outcome> Session::take_outcomes() {
  return std::exchange(outcomes_, {});
}

std::vector<Line> Session::take_lines() {
  return std::exchange(lines_, {});
}

}  // namespace saphira::mcp
