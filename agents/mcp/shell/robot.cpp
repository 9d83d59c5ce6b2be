// The robot for a language model: tools, and their requests.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "door.hpp"
#include "saphira/mcp/results.hpp"
#include "saphira/situation/why.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::mcp {

namespace {

constexpr double kLongestStart = 3.0;  // [s] for the activities and the first facts
constexpr double kLongestWait = 50.0;  // [s] of a call: clients give up after 60
constexpr double kStill = 0.01;        // [m/s], [rad/s]
constexpr std::size_t kMostTools = 250;
constexpr std::size_t kMostPlaces = 60;  // that a tool names
constexpr const char* kPlace = "place";  // a parameter
constexpr double kRest = 0.5;            // [s] without a new announcement: all have come

Json object(Json properties, const std::vector<std::string>& required = {}) {
  return {{"type", "object"},
          {"properties", properties.is_null() ? Json::object() : std::move(properties)},
          {"required", required},
          {"additionalProperties", false}};
}

Json wait_of(double most) {
  return {{"type", "number"},
          {"minimum", 0},
          {"maximum", most},
          {"description", "[s] to wait at most before this answers; 20 where it is not given"}};
}

std::string tool_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_')
      c = '_';
  return name.substr(0, 64);
}

Json point() {
  return object({{"x", {{"type", "number"}, {"description", "[m]"}}},
                 {"y", {{"type", "number"}, {"description", "[m]"}}},
                 {"heading", {{"type", "number"}, {"description", "[rad] counter-clockwise"}}},
                 {"frame",
                  {{"type", "string"},
                   {"enum", {"map", "odom", "robot"}},
                   {"description",
                    "of the map; of where the robot began; of the robot: x ahead, y left. robot "
                    "where it is not given"}}}},
                {"x", "y"});
}

Json schema_of(const v1::ActivityParameter& parameter) {
  std::string text = parameter.unit.empty() ? "" : "[" + parameter.unit + "]";
  if (!parameter.usual.empty())
    text += (text.empty() ? "usually " : "; usually ") + parameter.usual;
  Json json = Json::object();
  if (!text.empty())
    json["description"] = text;
  switch (parameter.kind) {
    case v1::PARAMETER_NUMBER:
      json["type"] = "number";
      if (parameter.low < parameter.high && std::isfinite(parameter.low) &&
          std::isfinite(parameter.high)) {
        json["minimum"] = parameter.low;
        json["maximum"] = parameter.high;
      }
      break;
    case v1::PARAMETER_TEXT:
      json["type"] = "string";
      break;
    case v1::PARAMETER_POINT:
      json = point();
      break;
    case v1::PARAMETER_ANY:
      break;
  }
  return json;
}

Json schema_of(const v1::CapabilityParameter& parameter) {
  Json json;
  switch (parameter.kind) {
    case v1::ARGUMENT_NUMBER:
      json["type"] = "number";
      if (parameter.low < parameter.high) {
        json["minimum"] = parameter.low;
        json["maximum"] = parameter.high;
      }
      break;
    case v1::ARGUMENT_TEXT:
      json["type"] = "string";
      if (!parameter.choices.empty())
        json["enum"] = parameter.choices;
      break;
    case v1::ARGUMENT_POINT:
      json = point();
      break;
    case v1::ARGUMENT_TRUTH:
      json["type"] = "boolean";
      break;
    case v1::ARGUMENT_UNBOUND:
      break;
  }
  std::string text = parameter.required ? "" : "left out, the answer says it";
  if (!parameter.meaning.empty())
    text = "the agent says: " + quotation(parameter.meaning) + (text.empty() ? "" : "; ") + text;
  json["description"] = text;
  return json;
}

/// True for an activity that needs a value without a declared kind, such as a path: only another
/// activity has that.
bool is_part(const v1::ActivitySchema& schema) {
  return std::ranges::any_of(schema.parameters, [](const v1::ActivityParameter& parameter) {
    return parameter.required && parameter.kind == v1::PARAMETER_ANY;
  });
}

/// The names on a map, for the model to choose from.
std::string places_of(const v1::FloorMap& map) {
  std::set<std::string> names;
  for (const v1::MapArtifact& artifact : map.artifacts)
    if (!artifact.name.empty() && names.size() < kMostPlaces)
      names.insert(artifact.name);
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? ": " : ", ") + name;
  return text;
}

/// Shipped activities that are parts of others, or the manual's examples. A person rarely asks for
/// them by name, and each tool costs the model room.
bool is_apart(const std::string& tool) {
  static const std::set<std::string> names{"about_turn",      "ask",           "attend",
                                           "attend_person",   "avoid",         "back_off",
                                           "back_up",         "blob_search",   "build_map",
                                           "bump_and_go",     "come_back",     "drive",
                                           "explore_unknown", "find_position", "find_and_follow",
                                           "find_person",     "follow_trail",  "halt",
                                           "inquire",         "look_there",    "make_sure",
                                           "monitor_planex",  "pause",         "recover",
                                           "report_at",       "roam",          "to_point"};
  return names.contains(tool);
}

/// The input schema of a tool with these parameters.
template <class Parameters>
Json input_of(const Parameters& parameters) {
  Json properties;
  std::vector<std::string> required;
  for (const auto& parameter : parameters) {
    properties[parameter.name] = schema_of(parameter);
    if (parameter.required)
      required.push_back(parameter.name);
  }
  return object(std::move(properties), required);
}

/// The permanent tools.
std::vector<Tool> fixed_tools() {
  return {
      {"robot_status", "The driver of the robot, the goals underway, and programs that are missing",
       object(nullptr), true},
      {"why", "Why the robot does what it does now, in a sentence and as a tree", object(nullptr),
       true},
      {"map",
       "The robot's place on the map, the places that have a name, nearest first, and closed doors",
       object(nullptr), true},
      {"look",
       "The walls, doors, people and echoes around the robot, nearest first; x ahead, y left [m]; "
       "and the picture of its camera, if it has one",
       object(nullptr), true},
      {"knows",
       "What people told the robot, and it knows now: each fact with its number, speaker and time",
       object(nullptr), true},
      {"goals", "Every goal that is known, every action of yours, and what became of it",
       object(nullptr), true},
      {"goal", "The outcome of one goal or of one action of yours; waits for its end",
       object({{"goal", {{"type", "string"}}}, {"wait_s", wait_of(kWait)}}, {"goal"}), true},
      {"cancel",
       "Withdraws a goal or an action of yours, or all of them and what you began with say, and "
       "says "
       "whether the robot stands",
       object(
           {{"goal", {{"type", "string"}, {"description", "all of yours where it is not given"}}},
            {"sure",
             {{"type", "boolean"},
              {"description", "true: also a goal of another client, whose person was asked"}}}}),
       false},
      {"say",
       "Says a sentence to the robot, such as: Flakey, go to Karen's office. It has to begin with "
       "the robot's keyword, such as Flakey. Answers what the robot says. What it begins ends with "
       "this client, and by cancel",
       object({{"text", {{"type", "string"}}}}, {"text"}), false},
      {"wait_for",
       "Waits until an agent or a person reports an event, such as pointed_out, or until a belief "
       "of the robot changes, such as *cur-place*, way-blocked or at-rest (t: yes, nil: no)",
       object({{"event", {{"type", "string"}, {"description", "any where it is not given"}}},
               {"belief", {{"type", "string"}, {"description", "in place of an event"}}},
               {"value",
                {{"type", "string"},
                 {"description", "of the belief; any other value where it is not given"}}},
               {"wait_s", wait_of(kLongestWait)}}),
       true},
      {.name = Session::kOthers,
       .description = "Asks for another activity of the robot, such as roam or back_off. Without a "
                      "name it lists them, with their arguments",
       .input = object({{"name", {{"type", "string"}}}, {"arguments", {{"type", "object"}}}})},
      {.name = "stop",
       .description = "Ends whatever moves the robot: goals, programs and people. Answers who was "
                      "stopped, once the robot is at rest",
       .input = object(nullptr),
       .always = true},
      {.name = "emergency_stop",
       .description = "Stops the robot by the hardest means. Only a person can release it",
       .input = object(nullptr),
       .always = true}};
}

}  // namespace

Robot::Robot(bus::Node& node, std::vector<std::string> described)
    : node_(node), described_(std::move(described)), mind_(node, false) {
  make_tools();
}

void Robot::poll(double now) {
  began_ = began_.value_or(now);
  now_ = now;
  mind_.poll();
  sonars_.poll();
  perception_.poll();
  vision_.poll();
  knowledge_.poll();
  bool changed = map_.poll();
  changed = schemas_.poll() || changed;
  for (const auto& sample : agent_reader_.take()) {
    if (sample.info.disposed)
      agents_.erase(sample.data.id);
    else
      agents_[sample.data.id] = sample;
    changed = true;
  }
  for (const bus::WriterId& writer : agent_reader_.take_lost())  // killed, perhaps
    changed =
        std::erase_if(agents_,
                      [&](const auto& each) { return each.second.info.writer == writer; }) > 0 ||
        changed;
  if (changed)
    make_tools();
}

/// The permanent tools come first, then activities, then capabilities of the same name.
void Robot::make_tools() {
  const std::vector<Tool> before = std::exchange(tools_, fixed_tools());
  for (Tool& tool : tools_)
    tool.output = form_of(tool.name);
  activities_.clear();
  capabilities_.clear();
  const auto is_new = [&](const std::string& name) {
    return !name.empty() && tools_.size() < kMostTools &&
           std::ranges::none_of(tools_, [&](const Tool& tool) { return tool.name == name; });
  };
  std::set<std::string> activities;
  const std::vector<v1::ActivitySchema> none;
  for (const v1::ActivitySchema& schema : schemas_ ? schemas_->schemas : none) {
    const std::string name = tool_name(schema.name);
    activities.insert(name);
    if (is_part(schema) || !is_new(name))
      continue;
    Json input = input_of(schema.parameters);
    if (map_ && input["properties"].contains(kPlace))
      input["properties"][kPlace]["description"] = "a place of the map" + places_of(*map_);
    input["properties"]["wait_s"] = wait_of(kWait);
    tools_.push_back(
        {.name = name,
         .description = schema.summary.empty() ? "The activity " + schema.name : schema.summary,
         .input = std::move(input),
         .output = goal_form(),
         .lasts = true,
         .apart = is_apart(name)});
    activities_[name] = schema;
  }
  for (const auto& [id, agent] : agents_) {
    // A description steers the model: it is shown where a person has allowed the agent. Where
    // members are known, an agent of another program than the robot's own goes by its member.
    const auto& sender = agent.info.sender;
    const bool is_own = !sender || sender->role == "services" || sender->role == "robot";
    const bool is_shown =
        std::ranges::find(described_, is_own ? agent.data.name : sender->name) != described_.end();
    for (v1::Capability capability : agent.data.capabilities) {
      const std::string name = tool_name(capability.functor);
      // The agent "robot" announces the activities once more.
      if (activities.contains(name) || !is_new(name))
        continue;
      capabilities_[name] = capability;
      if (!is_shown)
        for (v1::CapabilityParameter& parameter : capability.parameters)
          parameter.meaning = "";
      Json input = input_of(capability.parameters);
      if (capability.acts)
        input["properties"]["wait_s"] = wait_of(kWait);
      tools_.push_back({.name = name,
                        .description = "An agent " + quotation(agent.data.name) +
                                       (is_shown ? " says: " + quotation(capability.summary)
                                                 : " offers this; nobody has allowed its words"),
                        .input = std::move(input),
                        .reads = !capability.acts,
                        .output = form_of(capability),
                        .lasts = capability.acts});
    }
  }
  if (tools_ != before)
    changed_ = now_;
}

/// The announcements of activities and agents, and the map, come one by one, in any order.
bool Robot::knows_tools() const {
  if (has_listened())
    return true;
  std::set<bus::WriterId> announced;
  for (const auto& [id, agent] : agents_)
    announced.insert(agent.info.writer);
  return schemas_ && announced.size() >= agent_reader_.matched() && (map_ || map_.matched() == 0) &&
         now_ - std::max(changed_, *began_) >= kRest;
}

bool Robot::has_listened() const {
  return began_ && now_ - *began_ >= kLongestStart;
}

bool Robot::is_early(const Call& call) const {
  if (has_listened())
    return false;
  if (call.tool == "robot_status" || call.tool == "why" || call.tool == "goals" ||
      call.tool == "goal")
    return !mind_.whole(mind_.newest_cycle()) || !mind_.knows_goals();
  if (call.tool == "map")
    return !map_ || mind_.registration() == nullptr;
  if (call.tool == "look")
    return !mind_.robot() || !perception_;
  if (call.tool == "knows")
    return !knowledge_;
  return call.arguments.contains("belief") && mind_.beliefs() == nullptr;
}

const v1::ActivitySchema* Robot::activity(const std::string& tool) const {
  const auto found = activities_.find(tool);
  return found == activities_.end() ? nullptr : &found->second;
}

const v1::Capability* Robot::capability(const std::string& tool) const {
  const auto found = capabilities_.find(tool);
  return found == capabilities_.end() ? nullptr : &found->second;
}

Surroundings Robot::surroundings() const {
  return {mind_.robot(), sonars_.get(),     mind_.registration(),
          map_.get(),    perception_.get(), vision_.get()};
}

Result Robot::status() const {
  const situation::Situation now = mind_.situation();
  std::string text = situation::driver(now);
  if (const std::string trouble = situation::trouble(now); !trouble.empty())
    text += "\n" + trouble;
  Json value{{"robot", node_.options().robot},
             {"drive", situation::driver(now)},
             {"trouble", situation::trouble(now)}};
  if (const v1::RobotState* const robot = mind_.robot()) {
    value["pose_in_odom"] = {{"x", robot->pose_in_odom.x},
                             {"y", robot->pose_in_odom.y},
                             {"heading", robot->pose_in_odom.th}};
    value["velocity"] = robot->velocity;
    value["battery"] = robot->battery;
  }
  return {text, value, false};
}

Result Robot::why() const {
  const situation::Explanation why = situation::why(mind_.situation());
  return {situation::to_text(why), {{"sentence", why.sentence}}, false};
}

std::optional<std::string> Robot::belief(const std::string& name) const {
  if (const v1::BeliefSet* const set = mind_.beliefs())
    for (const v1::Belief& belief : set->beliefs)
      if (belief.name == name)
        return belief.value;
  return std::nullopt;
}

std::string Robot::beliefs() const {
  std::string names;
  if (const v1::BeliefSet* const set = mind_.beliefs())
    for (const v1::Belief& belief : set->beliefs)
      names += (names.empty() ? "" : ", ") + belief.name;
  return names;
}

bool Robot::moves() const {
  const v1::RobotState* const robot = mind_.robot();
  return robot != nullptr &&
         (std::abs(robot->velocity) > kStill || std::abs(robot->rotation_velocity) > kStill);
}

}  // namespace saphira::mcp
