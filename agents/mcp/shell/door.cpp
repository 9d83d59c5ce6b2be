#include "door.hpp"

#include <algorithm>

#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/cli/talk_words.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::mcp {

namespace {

using std::chrono::milliseconds;

constexpr double kDeadline = 600.0;     // [s] of a goal without one
constexpr std::size_t kMostGoals = 4;   // underway at once
constexpr double kNews = 1e-6;          // of progress, for new words alone
constexpr std::size_t kMostNoted = 20;  // lines of the log in a second
constexpr std::size_t kLongestNote = 160;
constexpr double kReply = 10.0;  // [s] for the robot's or an agent's reply

milliseconds seconds_of(double seconds) {
  return milliseconds(static_cast<int>(1000 * seconds));
}

v1::Argument argument(const std::string& name, const Json& value) {
  if (value.is_boolean())
    return bus::truth(name, value.get<bool>());
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
  Json json{{"goal", bus::describe(status.id())},
            {"what", status.functor()},
            {"asked_by", status.requester()},
            {"state", bus::describe(status.state())},
            {"step", status.step()},
            {"reason", status.reason()},
            {"progress", status.progress()}};
  if (status.waits_for().writer() != 0)
    json["waits_for"] = bus::describe(status.waits_for());
  return json;
}

Json json_of(const v1::Argument& argument) {
  switch (argument.kind()) {
    case v1::ARGUMENT_NUMBER:
      return argument.number();
    case v1::ARGUMENT_TEXT:
      return argument.text();
    case v1::ARGUMENT_POINT:
      return {{"x", argument.point().x()},
              {"y", argument.point().y()},
              {"heading", argument.point().th()},
              {"frame", argument.frame() == v1::FRAME_MAP    ? "map"
                        : argument.frame() == v1::FRAME_ODOM ? "odom"
                                                             : "robot"}};
    case v1::ARGUMENT_TRUTH:
      return argument.number() != 0.0;
    case v1::ARGUMENT_UNBOUND:
      break;
  }
  return nullptr;
}

/// The first line of a text for the log, without control characters.
std::string first_line(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  if (line.size() > kLongestNote) {
    std::size_t end = kLongestNote;
    while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80U)
      --end;  // not within a letter
    line = line.substr(0, end) + "...";
  }
  std::replace_if(
      line.begin(), line.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == '\x7f'; }, ' ');
  return line;
}

/// The answer of an agent. Several results of one name are a list.
Result result_of(const v1::Answer& answer) {
  Json value = Json::object();
  for (const v1::Argument& result : answer.results()) {
    Json& place = value[result.name()];
    if (place.is_null())
      place = json_of(result);
    else if (place.is_array())
      place.push_back(json_of(result));
    else
      place = Json::array({place, json_of(result)});
  }
  return {cli::line_of(answer), std::move(value), !bus::well(answer.code())};
}

}  // namespace

Door::Door(bus::Node& node, const Robot& robot, Session& session, const std::string& who)
    : node_(node),
      robot_(robot),
      session_(session),
      who_(who),
      goals_(node, who),
      requests_(node, bus::topics::kSolve, who),
      said_reader_(node.reader(bus::topics::kSaid)),
      heard_writer_(node.writer(bus::topics::kHeard)),
      stop_writer_(node.writer(bus::topics::kDriveEstop)) {
  session_.wait_for_tools(!robot_.knows_tools());
  session_.set_tools(robot_.tools());
}

/// Takes sentences of the robot and answers of agents.
void Door::hear() {
  goals_.poll();
  for (const auto& sample : said_reader_.take())
    for (auto& [number, waiting] : waiting_)
      if (waiting.what == Waiting::For::words &&
          sample.data.answers().writer() == node_.instance() &&
          sample.data.answers().number() == waiting.number) {
        waiting.said += (waiting.said.empty() ? "" : "\n") + sample.data.text();
        if (sample.data.end())
          waiting.until = Clock::now();
      }
  for (const v1::Answer& answer : requests_.poll())
    for (auto& [number, waiting] : waiting_)
      if (waiting.what == Waiting::For::request && waiting.number == answer.number() &&
          bus::ended(answer.code()))
        waiting.result = result_of(answer);
}

void Door::turn() {
  session_.set_time(std::chrono::duration<double>(Clock::now().time_since_epoch()).count());
  session_.set_tools(robot_.tools());
  session_.wait_for_tools(!robot_.knows_tools());
  hear();
  for (const std::uint64_t number : session_.take_given_up())
    if (const auto found = waiting_.find(number); found != waiting_.end()) {
      if (found->second.what == Waiting::For::goal && found->second.goal)
        goals_.cancel(*found->second.goal);
      waiting_.erase(found);
    }
  for (const Call& call : session_.take_calls()) {
    try {
      begin(call);
    } catch (const std::exception& error) {  // the bus did not take it
      session_.answer(call.number, {std::string("not done: ") + error.what(), nullptr, true});
    }
  }
  if (std::any_of(waiting_.begin(), waiting_.end(),
                  [](const auto& each) { return each.second.what == Waiting::For::stop; }))
    press();
  for (auto each = waiting_.begin(); each != waiting_.end();)
    each = is_over(each->first, each->second) ? waiting_.erase(each) : std::next(each);
  note();
}

/// Logs each call that has ended.
void Door::note() {
  if (const auto now = Clock::now(); now - noted_since_ >= std::chrono::seconds(1)) {
    noted_since_ = now;
    noted_ = 0;
  }
  for (const Outcome& outcome : session_.take_outcomes())
    if (++noted_ <= kMostNoted)
      node_.info(who_ + ": " + outcome.tool + (outcome.is_error ? " (error): " : ": ") +
                 first_line(outcome.text));
}

void Door::begin(const Call& call) {
  const auto now = Clock::now();
  if (const v1::ActivitySchema* const activity = robot_.activity(call.tool)) {
    ask(call, *activity);
  } else if (const v1::Capability* const capability = robot_.capability(call.tool)) {
    request(call, *capability);
  } else if (call.tool == "emergency_stop") {
    waiting_[call.number] = {.what = Waiting::For::stop, .until = now + std::chrono::seconds(10)};
  } else if (call.tool == "cancel") {
    cancel(call);
  } else if (call.tool == "say") {
    say(call);
  } else if (call.tool == "goal") {
    const auto id = bus::parse_goal_id(call.arguments.value("goal", ""));
    if (!id || !goals_.status(*id))
      return session_.answer(
          call.number, {"nothing is known of this goal; the tool goals lists them", nullptr, true});
    waiting_[call.number] = {.goal = id,
                             .until = now + seconds_of(call.arguments.value("wait_s", kWait))};
  } else if (call.tool == "goals") {
    session_.answer(call.number, {goals().dump(), {{"goals", goals()}}, false});
  } else if (call.tool == "robot_status") {
    Result result = robot_.status();
    result.value["goals"] = goals();
    session_.answer(call.number, result);
  } else if (call.tool == "why") {
    session_.answer(call.number, robot_.why());
  } else if (call.tool == "map") {
    session_.answer(call.number, robot_.map());
  } else if (call.tool == "look") {
    session_.answer(call.number, robot_.view());
  } else if (call.tool == "knows") {
    session_.answer(call.number, robot_.facts());
  } else {  // removed between the call and now
    session_.answer(call.number, {"not done: nobody offers this tool now", nullptr, true});
  }
}

void Door::say(const Call& call) {
  const v1::Utterance utterance =
      situation::typed(node_.instance(), bus::next_request_number(), who_,
                       call.arguments.value("text", ""), unix_time());
  heard_writer_.write(utterance);
  waiting_[call.number] = {.what = Waiting::For::words,
                           .number = utterance.id().number(),
                           .until = Clock::now() + seconds_of(kReply)};
}

/// Sends a request to any capable agent. The answer fills missing parameters.
void Door::request(const Call& call, const v1::Capability& capability) {
  v1::Request request;
  request.functor(capability.functor());
  request.deadline(kReply);
  for (const v1::CapabilityParameter& parameter : capability.parameters())
    request.arguments().push_back(call.arguments.contains(parameter.name())
                                      ? argument(parameter.name(), call.arguments[parameter.name()])
                                      : bus::open(parameter.name()));
  waiting_[call.number] = {.what = Waiting::For::request,
                           .number = requests_.send(std::move(request)),
                           .until = Clock::now() + seconds_of(kReply + 1.0)};
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
      .goal = id, .until = Clock::now() + seconds_of(call.arguments.value("wait_s", kWait))};
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

/// Answers a waiting call, if possible now.
bool Door::is_over(std::uint64_t number, Waiting& waiting) {
  const bool late = Clock::now() >= waiting.until;
  switch (waiting.what) {
    case Waiting::For::goal: {
      const auto status = goals_.status(*waiting.goal);
      if (!late && !(status && bus::ended(status->state()))) {
        if (!status)
          return false;
        const std::string words =
            bus::describe(status->state()) + ("\n" + status->step() + "\n" + status->reason());
        if (status->progress() > waiting.told || words != waiting.words) {
          waiting.told = std::max(waiting.told + kNews, status->progress());
          waiting.words = words;
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
      if (!late && (!ended || robot_.moves()))
        return false;
      const std::string robot =
          robot_.moves() ? "the robot still moves: somebody else may drive it, or it is stopping"
                         : "the robot stands";
      session_.answer(
          number,
          {std::string(ended ? "withdrawn; " : "withdrawn, and not heard to have ended; ") + robot,
           {{"ended", ended}, {"moves", robot_.moves()}},
           !ended});
      return true;
    }
    case Waiting::For::request:
      if (!late && !waiting.result)
        return false;
      session_.answer(
          number, waiting.result.value_or(
                      Result{"no answer: saphira-facilitator may not run (robot_status says more)",
                             nullptr, true}));
      return true;
    case Waiting::For::words:
      if (!late)
        return false;
      session_.answer(
          number,
          {!waiting.said.empty() ? waiting.said
           : heard_writer_.matched() == 0
               ? "the robot said nothing: saphira-dialogue may not run"
               : "the robot said nothing: a sentence for it begins with its keyword, such as "
                 "\"Flakey, stop\"",
           {{"said", waiting.said}},
           waiting.said.empty()});
      return true;
    case Waiting::For::stop: {
      const bool latched = robot_.mind().grant() != nullptr && robot_.mind().grant()->estopped();
      if (!late && !latched)
        return false;
      if (latched)
        press();  // releases, so that a person can reset it
      session_.answer(
          number,
          {latched ? "the emergency stop is latched, pressed by " +
                         robot_.mind().grant()->estop_source() +
                         "; a person releases it: saphira estop reset"
                   : "NOT CONFIRMED: no bridge has answered; the robot has a switch of its own",
           {{"latched", latched}, {"moves", robot_.moves()}},
           !latched});
      return true;
    }
  }
  return true;
}

/// Presses until the bridge has latched the stop, and then releases. The topic is best effort.
void Door::press() {
  const bool latched = robot_.mind().grant() != nullptr && robot_.mind().grant()->estopped();
  v1::MotorCommand command;
  command.source(who_);
  for (int i = 0; i < 4; ++i) {
    command.number(bus::next_request_number());
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

void Door::close() {
  for (const v1::GoalId& id : own_)
    goals_.cancel(id);
}

void Door::close_and_wait() {
  close();
  if (!own_.empty())
    goals_.delivered(1000);
}

}  // namespace saphira::mcp
