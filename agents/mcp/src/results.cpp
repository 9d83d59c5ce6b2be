#include "saphira/mcp/results.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "saphira/base/text.hpp"
#include "saphira/bus/goal_client.hpp"

namespace saphira::mcp {

namespace {

Json object(Json properties, const std::vector<std::string>& required = {}) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"required", Json(required)}};
}

Json list_of(Json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

Json of_type(const char* type) {
  return {{"type", type}};
}

Json text() {
  return of_type("string");
}

Json truth() {
  return of_type("boolean");
}

/// JSON has no number for infinity and the like: null stands for them.
Json number() {
  return {{"type", {"number", "null"}}};
}

Json text_or_nothing() {
  return {{"type", {"string", "null"}}};
}

Json pose() {
  return object({{"x", number()}, {"y", number()}, {"heading", number()}}, {"x", "y", "heading"});
}

Json state() {
  Json names = Json::array({"unknown"});
  for (const v1::GoalState each :
       {v1::GOAL_WAITING, v1::GOAL_REFUSED, v1::GOAL_UNDERWAY, v1::GOAL_SUSPENDED,
        v1::GOAL_SUCCEEDED, v1::GOAL_FAILED, v1::GOAL_CANCELED})
    names.push_back(bus::describe(each));
  return {{"type", "string"}, {"enum", std::move(names)}};
}

Json goal_with(Json results) {
  return object({{"goal", text()},
                 {"what", text()},
                 {"asked_by", text()},
                 {"yours", truth()},
                 {"state", state()},
                 {"step", text()},
                 {"reason", text()},
                 {"progress", number()},
                 {"waits_for", text()},
                 {"results", std::move(results)}},
                {"goal", "state"});
}

Json form_of(v1::ArgumentKind kind) {
  switch (kind) {
    case v1::ARGUMENT_NUMBER:
      return number();
    case v1::ARGUMENT_TEXT:
      return text();
    case v1::ARGUMENT_POINT: {
      Json point = pose();
      point["properties"]["frame"] = text();
      return point;
    }
    case v1::ARGUMENT_TRUTH:
      return truth();
    case v1::ARGUMENT_UNBOUND:
      break;
  }
  return Json::object();
}

Json json_of(const v1::Argument& argument) {
  switch (argument.kind) {
    case v1::ARGUMENT_NUMBER:
      return argument.number;
    case v1::ARGUMENT_TEXT:
      return argument.text;
    case v1::ARGUMENT_POINT:
      return {{"x", argument.point.x},
              {"y", argument.point.y},
              {"heading", argument.point.th},
              {"frame", argument.frame == v1::FRAME_MAP    ? "map"
                        : argument.frame == v1::FRAME_ODOM ? "odom"
                                                           : "robot"}};
    case v1::ARGUMENT_TRUTH:
      return argument.number != 0.0;
    case v1::ARGUMENT_UNBOUND:
      break;
  }
  return nullptr;
}

v1::GoalState state_of(const v1::Answer& answer, bool withdrawn) {
  switch (answer.code) {
    case v1::ANSWER_UNDERWAY:
      return v1::GOAL_UNDERWAY;
    case v1::ANSWER_DONE:
    case v1::ANSWER_SENT:
      return v1::GOAL_SUCCEEDED;
    case v1::ANSWER_REFUSED:
    case v1::ANSWER_UNKNOWN_FUNCTOR:
    case v1::ANSWER_BAD_ARGUMENT:
    case v1::ANSWER_NOBODY:
      return withdrawn ? v1::GOAL_CANCELED : v1::GOAL_REFUSED;
    case v1::ANSWER_GIVEN_UP:
      return withdrawn ? v1::GOAL_CANCELED : v1::GOAL_FAILED;
    case v1::ANSWER_TOO_LATE:
    case v1::ANSWER_LOST:
      break;
  }
  return v1::GOAL_FAILED;
}

}  // namespace

std::string for_model(std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kWords{
      {{"(saphira map show)", "(the tool map lists them)"},
       {"(saphira device motors on)", "(a person turns them on)"},
       {"(saphira drive hand-back)", "(by a person)"},
       {": saphira drive hand-back", " by a person"},
       {"until saphira estop reset", "until a person releases it"},
       {"saphira map place X Y TH", "a person has to place it on the map"},
       {"saphira map place X Y HEADING, or saphira map find",
        "a person has to place me on the map"},
       {"a person's approval: saphira goal approve", "a person's approval of goal"},
       {"saphira status shows", "the tool robot_status shows"},
       {"saphira knows lists", "the tool knows lists"}}};
  for (const auto& [command, words] : kWords)
    for (std::size_t at = text.find(command); at != std::string::npos;
         at = text.find(command, at + words.size()))
      text.replace(at, command.size(), words);
  // No tool takes a priority.
  constexpr std::string_view kBegin = "; with a priority of ";
  constexpr std::string_view kEnd = " it would go first";
  if (const std::size_t begin = text.find(kBegin); begin != std::string::npos)
    if (const std::size_t end = text.find(kEnd, begin); end != std::string::npos)
      text.erase(begin, end + kEnd.size() - begin);
  return text;
}

Json for_model(Json value) {
  if (value.is_string())
    return for_model(value.get<std::string>());
  if (value.is_structured())
    for (Json& each : value)
      each = for_model(std::move(each));
  return value;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == '\x7f'; }, ' ');
  return text;
}

std::string quotation(const std::string& text) {
  constexpr std::size_t kLongest = 200;
  std::string line = one_line(std::string(first_letters(text, kLongest)));
  if (line.size() < text.size())
    line += "...";
  std::ranges::replace(line, '"', '\'');
  return '"' + line + '"';
}

Json json_of(const v1::GoalStatus& status) {
  Json json{{"goal", bus::describe(status.id)},
            {"what", status.functor},
            {"asked_by", status.requester},
            {"state", bus::describe(status.state)},
            {"step", status.step},
            {"reason", status.reason},
            {"progress", status.progress}};
  if (status.waits_for.writer != 0)
    json["waits_for"] = bus::describe(status.waits_for);
  return json;
}

Json values_of(const std::vector<v1::Argument>& arguments,
               const std::vector<v1::CapabilityParameter>& declared) {
  Json value = Json::object();
  for (const v1::Argument& result : arguments) {
    const auto parameter = std::ranges::find(declared, result.name, &v1::CapabilityParameter::name);
    if (parameter != declared.end() && parameter->kind != v1::ARGUMENT_UNBOUND &&
        parameter->kind != result.kind)
      continue;
    Json& place = value[result.name];
    if (place.is_null())
      place = json_of(result);
    else if (place.is_array())
      place.push_back(json_of(result));
    else
      place = Json::array({place, json_of(result)});
  }
  return value;
}

Json goal_form() {
  return goal_with(object(Json::object()));
}

Json form_of(const std::string& tool) {
  const Json seen = object({{"what", text()},
                            {"where", text()},
                            {"distance", number()},
                            {"x", number()},
                            {"y", number()}},
                           {"what", "where", "distance"});
  const Json place = object({{"name", text()}, {"kind", text()}, {"x", number()}, {"y", number()}},
                            {"name", "x", "y"});
  const Json fact = object({{"number", of_type("integer")},
                            {"what", text()},
                            {"speaker", text()},
                            {"time", text_or_nothing()},
                            {"said", text()}},
                           {"number", "what"});
  if (tool == "robot_status")
    return object({{"robot", text()},
                   {"drive", text()},
                   {"trouble", text()},
                   {"pose_in_odom", pose()},
                   {"velocity", number()},
                   {"battery", number()},
                   {"goals", list_of(goal_form())}},
                  {"robot", "drive", "trouble", "goals"});
  if (tool == "why")
    return object({{"sentence", text()}}, {"sentence"});
  if (tool == "map") {
    Json robot = pose();
    robot["properties"]["sigma"] = number();
    robot["properties"]["in"] = text_or_nothing();
    return object({{"map", text()},
                   {"robot", std::move(robot)},
                   {"places", list_of(place)},
                   {"closed_doors", list_of(text())}});
  }
  if (tool == "look")
    return object({{"seen", list_of(seen)}}, {"seen"});
  if (tool == "knows")
    return object({{"known", list_of(fact)}}, {"known"});
  if (tool == "goals")
    return object({{"goals", list_of(goal_form())}}, {"goals"});
  if (tool == "goal")
    return goal_form();
  if (tool == Session::kOthers) {  // the list, or a goal
    Json either = goal_form();
    either["properties"]["activities"] = list_of(text());
    either["required"] = Json::array();
    return either;
  }
  if (tool == "cancel")
    return object({{"ended", truth()}, {"moves", truth()}}, {"ended", "moves"});
  if (tool == "say")
    return object({{"said", text()}}, {"said"});
  if (tool == "wait_for")
    return object({{"happened", truth()},
                   {"event", text()},
                   {"source", text()},
                   {"arguments", object(Json::object())},
                   {"belief", text()},
                   {"value", text()}},
                  {"happened"});
  if (tool == "stop")
    return object({{"stopped", truth()}, {"moves", truth()}}, {"stopped", "moves"});
  if (tool == "emergency_stop")
    return object({{"latched", truth()}, {"moves", truth()}}, {"latched", "moves"});
  return nullptr;
}

Json form_of(const v1::Capability& capability) {
  Json properties = Json::object();
  for (const v1::CapabilityParameter& parameter : capability.parameters) {
    if (parameter.required)
      continue;
    const Json one = form_of(parameter.kind);
    properties[parameter.name] = {{"anyOf", Json::array({one, list_of(one)})}};
  }
  return capability.acts ? goal_with(object(std::move(properties))) : object(std::move(properties));
}

Action action_of(const v1::GoalId& id, const v1::Request& request) {
  Action action;
  action.status.id = id;
  action.status.functor = request.functor;
  action.status.requester = request.source;
  action.status.state = v1::GOAL_WAITING;
  action.status.reason = "no agent has answered yet; without saphira-facilitator none does";
  return action;
}

void take_answer(Action& action, const v1::Answer& answer, bool withdrawn,
                 const std::vector<v1::CapabilityParameter>& declared) {
  action.status.state = state_of(answer, withdrawn);
  const bool silent = answer.text.empty() && !bus::well(answer.code);
  const bool late = answer.code == v1::ANSWER_TOO_LATE;
  const std::string text = (silent ? "no reason was given" : answer.text) +
                           (late ? "; whether it was done is not known" : "");
  action.status.reason =
      (answer.service.empty() || text.empty() ? "" : answer.service + ": ") + text;
  if (bus::ended(answer.code))
    action.results = values_of(answer.results, declared);
}

Json json_of(const Action& action) {
  Json json = json_of(action.status);
  json.erase("progress");
  json["results"] = action.results;
  return json;
}

std::string words_of(const Action& action) {
  const v1::GoalStatus& status = action.status;
  return bus::describe(status.state) + (status.reason.empty() ? "" : ": " + status.reason) +
         (action.results.empty()
              ? ""
              : "; results " + action.results.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace saphira::mcp
