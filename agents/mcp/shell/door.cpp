#include "door.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/situation/words.hpp"

namespace saphira::mcp {

namespace {

using std::chrono::milliseconds;

constexpr double kWait = 20.0;         // [s] that a call waits for the end of its goal, at most
constexpr double kDeadline = 600.0;    // [s] of a goal that names none
constexpr std::size_t kMostGoals = 4;  // underway at once
constexpr double kReply = 10.0;        // [s] for what the robot says
constexpr double kStill = 0.01;        // [m/s], [rad/s]

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
          {"description", "[s] to wait for the end before this answers; 20 where it is not given"}};
}

std::string tool_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_')
      c = '_';
  return name.substr(0, 64);
}

Json schema_of(const v1::ActivityParameter& parameter) {
  const std::string unit = parameter.unit().empty() ? "" : " [" + parameter.unit() + "]";
  Json json{
      {"description", parameter.name() + unit +
                          (parameter.usual().empty() ? "" : "; usually " + parameter.usual())}};
  switch (parameter.kind()) {
    case v1::PARAMETER_NUMBER:
      json["type"] = "number";
      if (parameter.low() < parameter.high() && std::isfinite(parameter.low()) &&
          std::isfinite(parameter.high())) {
        json["minimum"] = parameter.low();
        json["maximum"] = parameter.high();
      }
      break;
    case v1::PARAMETER_TEXT:
      json["type"] = "string";
      break;
    case v1::PARAMETER_POINT:
      json = object({{"x", {{"type", "number"}, {"description", "[m]"}}},
                     {"y", {{"type", "number"}, {"description", "[m]"}}},
                     {"heading", {{"type", "number"}, {"description", "[rad] counter-clockwise"}}},
                     {"frame",
                      {{"type", "string"},
                       {"enum", {"map", "odom", "robot"}},
                       {"description",
                        "of the map; of where the robot began; of the robot: x ahead, y left. "
                        "robot where it is not given"}}}},
                    {"x", "y"});
      break;
    case v1::PARAMETER_ANY:
      break;
  }
  return json;
}

v1::Argument argument(const std::string& name, const Json& value) {
  if (value.is_number())
    return bus::number(name, value.get<double>());
  if (value.is_object()) {
    const std::string frame = value.value("frame", "robot");
    return bus::point(name, value.value("x", 0.0), value.value("y", 0.0),
                      value.value("heading", 0.0),
                      frame == "map"    ? v1::FRAME_MAP
                      : frame == "odom" ? v1::FRAME_ODOM
                                        : v1::FRAME_ROBOT);
  }
  return bus::text(name, value.is_string() ? value.get<std::string>() : value.dump());
}

Json json_of(const v1::GoalStatus& status) {
  return {{"goal", bus::describe(status.id())},
          {"what", status.functor()},
          {"asked_by", status.requester()},
          {"state", bus::describe(status.state())},
          {"step", status.step()},
          {"reason", status.reason()},
          {"progress", status.progress()}};
}

}  // namespace

Door::Door(bus::Node& node, Session& session, const std::string& who)
    : node_(node),
      session_(session),
      who_(who),
      mind_(node, false),
      goals_(node, who),
      schema_reader_(node.reader(bus::topics::kActivitySchemas)),
      said_reader_(node.reader(bus::topics::kSaid)),
      heard_writer_(node.writer(bus::topics::kHeard)),
      stop_writer_(node.writer(bus::topics::kDriveEstop)) {
  take_schemas();
}

/// A tool for each activity, and those that are always there.
void Door::take_schemas() {
  const auto newest = schema_reader_.take_newest();
  if (!newest && !session_.tools().empty())
    return;
  std::vector<Tool> tools{
      {"robot_status", "Who drives the robot, what is underway, what is missing", object(nullptr),
       true},
      {"why", "Why the robot does what it does now, in a sentence and as a tree", object(nullptr),
       true},
      {"goals", "Every goal that is known, and what became of it", object(nullptr), true},
      {"goal", "What became of one goal; waits for its end",
       object({{"goal", {{"type", "string"}}}, {"wait_s", wait_of(kWait)}}, {"goal"}), true},
      {"cancel", "Withdraws a goal of yours, or all of them, and says whether the robot stands",
       object(
           {{"goal", {{"type", "string"}, {"description", "all of yours where it is not given"}}}}),
       false},
      {"say",
       "Says a sentence to the robot, such as: Flakey, go to Karen's office. Answers what the "
       "robot says",
       object({{"text", {{"type", "string"}}}}, {"text"}), false},
      {"emergency_stop", "Stops the robot by the hardest means. Only a person can release it",
       object(nullptr), false}};
  if (newest) {
    schemas_.clear();
    for (const v1::ActivitySchema& schema : newest->schemas()) {
      const std::string name = tool_name(schema.name());
      // The fixed ones have no rivals.
      if (name.empty() ||
          std::any_of(tools.begin(), tools.end(), [&](const Tool& t) { return t.name == name; }))
        continue;
      Json properties;
      std::vector<std::string> required;
      for (const v1::ActivityParameter& parameter : schema.parameters()) {
        properties[parameter.name()] = schema_of(parameter);
        if (parameter.required())
          required.push_back(parameter.name());
      }
      properties["wait_s"] = wait_of(kWait);
      tools.push_back({name, schema.summary(), object(std::move(properties), required), false});
      schemas_[name] = schema;
    }
  }
  session_.set_tools(std::move(tools));
}

void Door::turn() {
  mind_.poll();
  goals_.poll();
  take_schemas();
  for (const auto& sample : said_reader_.take())
    for (auto& [number, waiting] : waiting_)
      if (waiting.what == Waiting::For::words &&
          sample.data.answers().writer() == node_.instance() &&
          sample.data.answers().number() == waiting.words) {
        waiting.said += (waiting.said.empty() ? "" : "\n") + sample.data.text();
        if (sample.data.end())
          waiting.until = Clock::now();
      }
  for (const std::uint64_t number : session_.take_given_up())
    if (const auto found = waiting_.find(number); found != waiting_.end()) {
      if (found->second.what == Waiting::For::goal && found->second.goal)
        goals_.cancel(*found->second.goal);
      waiting_.erase(found);
    }
  for (const Call& call : session_.take_calls())
    begin(call);
  if (std::any_of(waiting_.begin(), waiting_.end(),
                  [](const auto& each) { return each.second.what == Waiting::For::stop; }))
    press();
  for (auto each = waiting_.begin(); each != waiting_.end();)
    each = is_over(each->first, each->second) ? waiting_.erase(each) : std::next(each);
}

void Door::begin(const Call& call) {
  if (const auto schema = schemas_.find(call.tool); schema != schemas_.end())
    return ask(call, schema->second);
  const auto now = Clock::now();
  if (call.tool == "emergency_stop") {
    waiting_[call.number] = {.what = Waiting::For::stop, .until = now + std::chrono::seconds(10)};
  } else if (call.tool == "cancel") {
    cancel(call);
  } else if (call.tool == "say") {
    v1::Utterance utterance;
    utterance.id().writer(node_.instance());
    utterance.id().number(++utterances_);
    utterance.speaker(who_);
    utterance.text(call.arguments.value("text", ""));
    utterance.means(v1::UTTERANCE_TYPED);
    utterance.confidence(1.0);
    utterance.time(
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count());
    heard_writer_.write(utterance);
    waiting_[call.number] = {.what = Waiting::For::words,
                             .words = utterances_,
                             .until = now + milliseconds(static_cast<int>(1000 * kReply))};
  } else if (call.tool == "goal") {
    const auto id = bus::parse_goal_id(call.arguments.value("goal", ""));
    if (!id || !goals_.status(*id))
      return session_.answer(
          call.number, {"nothing is known of this goal; the tool goals lists them", nullptr, true});
    waiting_[call.number] = {
        .goal = id,
        .until =
            now + milliseconds(static_cast<int>(1000 * call.arguments.value("wait_s", kWait)))};
  } else {
    look(call);
  }
}

void Door::look(const Call& call) {
  if (call.tool == "goals")
    return session_.answer(call.number, {goals().dump(), {{"goals", goals()}}, false});
  if (call.tool == "robot_status")
    return session_.answer(call.number, status());
  const situation::Explanation why = situation::why(mind_.situation(mind_.newest_cycle(), false));
  session_.answer(call.number, {situation::to_text(why), {{"sentence", why.sentence}}, false});
}

void Door::ask(const Call& call, const v1::ActivitySchema& schema) {
  std::erase_if(own_, [this](const v1::GoalId& id) {
    const auto known = goals_.status(id);
    return known && bus::ended(known->state());
  });
  if (own_.size() >= kMostGoals)
    return session_.answer(call.number, {"not done: " + std::to_string(own_.size()) +
                                             " goals of yours have not ended; cancel one, or wait",
                                         nullptr, true});
  v1::Goal goal;
  goal.functor(schema.name());
  for (const auto& [name, value] : call.arguments.items())
    if (name != "wait_s")
      goal.arguments().push_back(argument(name, value));
  goal.deadline(kDeadline);
  goal.writer_lost(v1::WRITER_LOST_CANCEL);
  const v1::GoalId id = goals_.ask(goal);
  own_.push_back(id);
  waiting_[call.number] = {
      .goal = id,
      .until = Clock::now() +
               milliseconds(static_cast<int>(1000 * call.arguments.value("wait_s", kWait)))};
}

void Door::cancel(const Call& call) {
  Waiting waiting{.what = Waiting::For::cancel, .until = Clock::now() + std::chrono::seconds(5)};
  if (call.arguments.contains("goal")) {
    const auto id = bus::parse_goal_id(call.arguments.value("goal", ""));
    const bool own = id && std::any_of(own_.begin(), own_.end(), [&](const v1::GoalId& each) {
                       return each.writer() == id->writer() && each.number() == id->number();
                     });
    if (!own)
      return session_.answer(
          call.number, {"not done: this is no goal of yours that is underway", nullptr, true});
    waiting.goal = id;
    goals_.cancel(*id);
  } else {
    for (const v1::GoalId& id : own_)
      goals_.cancel(id);
  }
  waiting_[call.number] = waiting;
}

/// Answers a call that waits, where it can be answered now.
bool Door::is_over(std::uint64_t number, Waiting& waiting) {
  const bool late = Clock::now() >= waiting.until;
  switch (waiting.what) {
    case Waiting::For::goal: {
      const auto status = goals_.status(*waiting.goal);
      if (!late && !(status && bus::ended(status->state()))) {
        if (status && status->progress() > waiting.told) {
          waiting.told = status->progress();
          session_.progress(number, waiting.told, bus::describe(*status));
        }
        return false;
      }
      session_.answer(number, outcome(*waiting.goal));
      return true;
    }
    case Waiting::For::cancel: {
      const bool ended = std::all_of(own_.begin(), own_.end(), [&](const v1::GoalId& id) {
        const bool meant = !waiting.goal || waiting.goal->number() == id.number();
        const auto status = goals_.status(id);
        return !meant || (status && bus::ended(status->state()));
      });
      if (!late && (!ended || moves()))
        return false;
      const std::string robot =
          moves() ? "the robot still moves: somebody else may drive it, or it is stopping"
                  : "the robot stands";
      session_.answer(
          number,
          {std::string(ended ? "withdrawn; " : "withdrawn, and not heard to have ended; ") + robot,
           {{"ended", ended}, {"moves", moves()}},
           !ended});
      return true;
    }
    case Waiting::For::words:
      if (!late)
        return false;
      session_.answer(number,
                      {waiting.said.empty() ? "the robot said nothing: saphira-dialogue may not run"
                                            : waiting.said,
                       {{"said", waiting.said}},
                       waiting.said.empty()});
      return true;
    case Waiting::For::stop: {
      const bool latched = mind_.grant() != nullptr && mind_.grant()->estopped();
      if (!late && !latched)
        return false;
      if (latched)
        press();  // lets go, so that a person can release it
      session_.answer(
          number,
          {latched ? "the emergency stop is latched, pressed by " + mind_.grant()->estop_source() +
                         "; a person releases it: saphira estop reset"
                   : "NOT CONFIRMED: no bridge has answered; the robot has a switch of its own",
           {{"latched", latched}, {"moves", moves()}},
           !latched});
      return true;
    }
  }
  return true;
}

/// Says that it presses until the bridge has latched it, and then that it lets go. The topic is
/// best effort.
void Door::press() {
  const bool latched = mind_.grant() != nullptr && mind_.grant()->estopped();
  v1::MotorCommand command;
  command.source(who_);
  for (int i = 0; i < 4; ++i) {
    command.number(++utterances_);
    command.active(!latched);
    stop_writer_.write(command);
  }
}

Result Door::outcome(const v1::GoalId& id) const {
  const auto status = goals_.status(id);
  if (!status)
    return {"goal " + bus::describe(id) +
                ": no answer yet; intentions may not run (robot_status says more)",
            {{"goal", bus::describe(id)}, {"state", "unknown"}},
            false};
  const bool bad = bus::ended(status->state()) && status->state() != v1::GOAL_SUCCEEDED;
  std::string text = "goal " + bus::describe(id) + ": " + bus::describe(*status);
  if (!bus::ended(status->state()))
    text += "; it goes on: ask the tool goal for its end, or cancel it";
  return {text, json_of(*status), bad};
}

Json Door::goals() const {
  Json all = Json::array();
  for (const v1::GoalStatus& status : goals_.statuses())
    all.push_back(json_of(status));
  return all;
}

Result Door::status() const {
  const situation::Situation now = mind_.situation(mind_.newest_cycle(), false);
  std::string text = situation::driver(now);
  if (const std::string trouble = situation::trouble(now); !trouble.empty())
    text += "\n" + trouble;
  Json value{{"robot", node_.options().robot},
             {"drive", situation::driver(now)},
             {"trouble", situation::trouble(now)},
             {"goals", goals()}};
  if (const v1::RobotState* const robot = mind_.robot()) {
    value["pose_in_odom"] = {{"x", robot->pose_in_odom().x()},
                             {"y", robot->pose_in_odom().y()},
                             {"heading", robot->pose_in_odom().th()}};
    value["velocity"] = robot->velocity();
    value["battery"] = robot->battery();
  }
  return {text, value, false};
}

bool Door::moves() const {
  const v1::RobotState* const robot = mind_.robot();
  return robot != nullptr &&
         (std::abs(robot->velocity()) > kStill || std::abs(robot->rotation_velocity()) > kStill);
}

void Door::close() {
  for (const v1::GoalId& id : own_)
    goals_.cancel(id);
  if (!own_.empty())
    goals_.delivered(1000);
}

}  // namespace saphira::mcp
