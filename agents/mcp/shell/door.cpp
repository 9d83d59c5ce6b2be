#include "door.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "saphira/base/base64.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/cli/talk_words.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::mcp {

namespace {

using security::DoorRight;

constexpr double kStopPatience = 10.0;  // [s]
constexpr const char* kNotConfirmed =
    "NOT CONFIRMED: no bridge has answered; the robot has a switch of its own";
constexpr double kDeadline = 600.0;     // [s] of a goal or an action
constexpr std::size_t kMostGoals = 4;   // underway at once
constexpr double kNews = 1e-6;          // of progress, for new words alone
constexpr std::size_t kMostNoted = 20;  // lines of the log in a second
constexpr std::size_t kLongestNote = 160;
constexpr double kPicture = 2.0;       // [s] for a camera that was off
constexpr double kReply = 10.0;        // [s] for the robot's or an agent's reply
constexpr double kGrace = 15.0;        // [s] after the deadline, for the last word about a task
constexpr double kStop = 5.0;          // [s] for a robot to stand
constexpr double kSettles = 0.5;       // [s] for the last command to reach the wheels
constexpr std::size_t kMostKept = 64;  // actions that are remembered
constexpr double kOld = 60.0;          // [s] after which the dialogue does not act on words

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

/// The end of a request that no program has given.
bool is_unheard(const v1::Answer& answer) {
  return answer.service.empty() &&
         (answer.code == v1::ANSWER_NOBODY || answer.code == v1::ANSWER_TOO_LATE);
}

/// The first line of a text for the log.
std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  const std::string_view begin = first_letters(line, kLongestNote);
  return one_line(std::string(begin)) + (begin.size() < line.size() ? "..." : "");
}

}  // namespace

Door::Door(bus::Node& node, const Robot& robot, Session& session, const std::string& who,
           const std::optional<security::DoorKey>& person)
    : node_(node),
      robot_(robot),
      session_(session),
      who_(who),
      right_(person ? person->right : DoorRight::operate),
      person_(person ? v1::Person{person->name, security::role_of(person->right)} : v1::Person{}),
      goals_(node, who),
      requests_(node, bus::topics::kSolve, who),
      stops_(node, bus::topics::kDriveStop, who) {
  try {
    if (right_ == DoorRight::operate)
      approvals_.emplace(node, bus::topics::kProcessRequest, who);
  } catch (const std::invalid_argument&) {
    approvals_.reset();  // the role file does not let this program approve
  }
  session_.wait_for_tools(!robot_.knows_tools());
  session_.set_tools(robot_.tools());
}

void Door::hear_reply(const v1::Utterance& reply) {
  const std::uint64_t answers = reply.answers.number;
  for (auto& [number, waiting] : waiting_)
    if (waiting.what == Waiting::For::words && waiting.number == answers) {
      waiting.said += (waiting.said.empty() ? "" : "\n") + reply.text;
      if (reply.end)
        waiting.until = now_;
    }
  if (reply.end)
    words_.erase(answers);
  else if (const auto words = words_.find(answers);
           words != words_.end() && !std::exchange(words->second.acts, true) && left_)
    take_back_words();
}

/// The goal waits for a person's approval, and nobody has withdrawn it.
bool Door::needs_approval(const Own& own) const {
  const auto known = goals_.status(own.id);
  return known && !own.withdrawn && known->code == v1::CODE_APPROVAL && !bus::ended(known->state);
}

/// Asks the client's person for goals that need an approval, where key and role may give it. The
/// page and the command line can approve them, too.
void Door::ask_for_approval() {
  if (!approvals_)
    return;
  approvals_->poll(now_);
  for (Own& each : own_) {
    if (!needs_approval(each)) {
      session_.take_back(each.question);
    } else if (each.question == 0) {
      const auto call = std::ranges::find_if(
          waiting_, [&](const auto& waiting) { return waiting.second.goal == each.id; });
      const std::uint64_t number = call == waiting_.end() ? 0 : call->first;
      each.question = session_.ask_person(
          "The model wants the robot to do this: " + each.text + ". May it begin?", number);
      if (each.question != 0 && !session_.is_open(number))
        waiting_.erase(number);
    }
  }
  for (const auto& [question, yes] : session_.take_consents()) {
    const auto of = [number = question](const Own& each) { return each.question == number; };
    const auto found = std::ranges::find_if(own_, of);
    if (found == own_.end())
      continue;
    if (yes)
      approvals_->send(
          bus::request("resume", {bus::text("process", bus::describe(found->id))}, "intentions"));
    else
      withdraw(*found, "the person at " + who_ + " did not approve it");
  }
}

/// Takes sentences of the robot, and events and answers of agents.
void Door::hear() {
  goals_.poll();
  ask_for_approval();
  picture_ = picture_reader_ ? picture_reader_->take_newest() : std::nullopt;
  for (const auto& sample : said_reader_.take())
    if (sample.data.answers.writer == node_.instance())
      hear_reply(sample.data);
  if (!said_reader_.take_lost().empty() && has_words_underway()) {
    take_back_words();  // the tasks of a program end with the dialogue
    words_.clear();
  }
  std::erase_if(words_, [this](const auto& each) {
    return !each.second.acts && now_ - each.second.since > kOld;
  });
  for (const auto& sample : event_reader_.take())
    for (auto& [number, waiting] : waiting_)
      if (waiting.what == Waiting::For::event && !waiting.result &&
          (waiting.name.empty() || waiting.name == sample.data.functor)) {
        const Json arguments = values_of(sample.data.arguments);
        waiting.result = Result{sample.data.functor + " " +
                                    arguments.dump(-1, ' ', false, Json::error_handler_t::replace) +
                                    ", reported by " + sample.data.source,
                                {{"happened", true},
                                 {"event", sample.data.functor},
                                 {"source", sample.data.source},
                                 {"arguments", arguments}},
                                false};
      }
  requests_.poll(now_);
  stops_.poll(now_);
}

void Door::turn(double now) {
  now_ = now;
  session_.turn(now, unix_time());
  session_.set_tools(robot_.tools());
  session_.wait_for_tools(!robot_.knows_tools());
  hear();
  for (const std::uint64_t number : session_.take_given_up()) {
    std::erase_if(early_, [&](const Call& call) { return call.number == number; });
    if (const auto found = waiting_.find(number); found != waiting_.end()) {
      if (found->second.what == Waiting::For::goal)
        if (Own* const own_goal = own(*found->second.goal))
          withdraw(*own_goal);
      if (found->second.what == Waiting::For::words)
        take_back_words();
      found->second.still = now_ + kStop;
      if (!found->second.is_task)
        waiting_.erase(found);
    }
  }
  std::vector<Call> calls = std::exchange(early_, {});
  for (Call& call : session_.take_calls())
    calls.push_back(std::move(call));
  for (const Call& call : calls) {
    try {
      if (robot_.is_early(call))
        early_.push_back(call);
      else
        begin(call);
    } catch (const std::exception& error) {  // the bus did not take it
      session_.answer(call.number, {std::string("not done: ") + error.what(), nullptr, true});
    }
  }
  if (std::ranges::any_of(waiting_,
                          [](const auto& each) { return each.second.what == Waiting::For::estop; }))
    press();
  for (auto each = waiting_.begin(); each != waiting_.end();)
    each = is_over(each->first, each->second) ? waiting_.erase(each) : std::next(each);
  // The camera is off while nobody reads.
  if (std::ranges::none_of(
          waiting_, [](const auto& each) { return each.second.what == Waiting::For::picture; }))
    picture_reader_.reset();
  note();
}

/// Logs each call that has ended.
void Door::note() {
  if (now_ - noted_since_ >= 1.0) {
    noted_since_ = now_;
    noted_ = 0;
  }
  for (const Outcome& outcome : session_.take_outcomes())
    if (++noted_ <= kMostNoted)
      node_.info(who_ + ": " + outcome.tool + (outcome.is_error ? " (error): " : ": ") +
                 first_line(outcome.text));
}

void Door::refuse(const Call& call, const std::string& why) {
  session_.answer(call.number, {why, nullptr, true});
}

/// True where the key allows the call: with a key to watch, reading and stopping. Otherwise the
/// call is answered.
bool Door::is_allowed(const Call& call) {
  const auto& tools = robot_.tools();
  const auto tool = std::ranges::find(tools, call.tool, &Tool::name);
  if (right_ >= DoorRight::drive || (tool != tools.end() && (tool->reads || tool->always)))
    return true;
  refuse(call, "not done: the key of " + person_.name +
                   " is to watch; this needs one to drive (saphira keys)");
  return false;
}

void Door::begin(const Call& call) {
  if (!is_allowed(call))
    return;
  if (call.question != 0) {
    const auto asked = std::ranges::find(own_, call.question, &Own::question);
    return asked == own_.end() ? refuse(call, "not done: the goal has ended")
                               : await(call, asked->id);
  }
  if (call.tool == "stop") {
    v1::Request stop = bus::request("stop");
    stop.person = person_;
    return send(call, stops_, std::move(stop), kStopPatience, [this](const v1::Answer& answer) {
      const bool well = bus::well(answer.code);
      const bool unconfirmed =
          answer.code == v1::ANSWER_NOBODY || answer.code == v1::ANSWER_TOO_LATE;
      return Result{unconfirmed ? kNotConfirmed : answer.text,
                    {{"stopped", well}, {"moves", robot_.moves()}},
                    !well};
    });
  }
  if (const v1::ActivitySchema* const activity = robot_.activity(call.tool)) {
    ask(call, *activity);
  } else if (const v1::Capability* const capability = robot_.capability(call.tool)) {
    request(call, *capability);
  } else if (call.tool == "emergency_stop") {
    waiting_[call.number] = {.what = Waiting::For::estop, .until = now_ + 10.0};
  } else if (call.tool == "cancel") {
    cancel(call);
  } else if (call.tool == "say") {
    say(call);
  } else if (call.tool == "wait_for") {
    wait_for(call);
  } else if (call.tool == "goal") {
    const auto id = bus::parse_goal_id(call.arguments.value("goal", ""));
    if (!id || !status(*id))
      return refuse(call, "nothing is known of this goal; the tool goals lists them");
    waiting_[call.number] = {.goal = id, .until = now_ + call.arguments.value("wait_s", kWait)};
  } else if (call.tool == "goals") {
    session_.answer(call.number, {goals().dump(-1, ' ', false, Json::error_handler_t::replace),
                                  {{"goals", goals()}},
                                  false});
  } else if (call.tool == "robot_status") {
    Result result = robot_.status();
    result.value["goals"] = goals();
    session_.answer(call.number, result);
  } else if (call.tool == "why") {
    session_.answer(call.number, robot_.why());
  } else if (call.tool == "map") {
    session_.answer(call.number, robot_.map());
  } else if (call.tool == "look") {
    if (call.as_text || !situation::is_heard(robot_.mind().processes().all(), "camera"))
      return session_.answer(call.number, robot_.view());
    waiting_[call.number] = {.what = Waiting::For::picture, .until = now_ + kPicture};
    if (!picture_reader_)
      picture_reader_.emplace(node_.reader(bus::topics::kCameraPictures));
  } else if (call.tool == "knows") {
    session_.answer(call.number, robot_.facts());
  } else {  // removed between the call and now
    refuse(call, "not done: nobody offers this tool now");
  }
}

void Door::say(const Call& call) {
  if (!may_begin(call))
    return;
  v1::Utterance utterance = situation::typed(node_.instance(), bus::next_request_number(), who_,
                                             call.arguments.value("text", ""), unix_time());
  utterance.means = v1::UTTERANCE_PROGRAM;
  utterance.person = person_;
  heard_writer_.write(utterance);
  words_[utterance.id.number] = {now_};
  waiting_[call.number] = {
      .what = Waiting::For::words, .number = utterance.id.number, .until = now_ + kReply};
}

/// Waits for an event, or for another value of a belief.
void Door::wait_for(const Call& call) {
  const bool has_belief = call.arguments.contains("belief");
  Waiting waiting{.what = has_belief ? Waiting::For::belief : Waiting::For::event,
                  .until = now_ + call.arguments.value("wait_s", kWait),
                  .name = call.arguments.value(has_belief ? "belief" : "event", "")};
  if (has_belief) {
    const std::optional<std::string> known = robot_.belief(waiting.name);
    if (!known)
      return refuse(call, "not done: the robot has no such belief, but: " + robot_.beliefs());
    waiting.before = *known;
    if (call.arguments.contains("value"))
      waiting.value = call.arguments.value("value", "");
  }
  waiting_[call.number] = waiting;
}

/// Sends a request to any capable agent. The answer fills missing parameters. An action gets an id
/// as a goal has.
void Door::request(const Call& call, const v1::Capability& capability) {
  if (capability.acts && !has_room(call))
    return;
  v1::Request request{.source = who_,
                      .functor = capability.functor,
                      .deadline = capability.acts ? kDeadline : kReply,
                      .person = person_};
  for (const v1::CapabilityParameter& parameter : capability.parameters)
    request.arguments.push_back(call.arguments.contains(parameter.name)
                                    ? argument(parameter.name, call.arguments[parameter.name])
                                    : bus::open(parameter.name));
  if (!capability.acts)
    return send(call, requests_, std::move(request), kReply + 1.0,
                [declared = capability.parameters](const v1::Answer& answer) {
                  return is_unheard(answer)
                     ? Result{"no answer: saphira-facilitator may not run (robot_status says more)",
                              nullptr, true}
                     : Result{cli::line_of(answer), values_of(answer.results, declared),
                              !bus::well(answer.code)};
                });
  for (auto each = actions_.begin(); each != actions_.end() && actions_.size() >= kMostKept;)
    each = bus::ended(each->second.status.state) ? actions_.erase(each) : std::next(each);
  const auto answered = [this, declared = capability.parameters](const v1::Answer& answer) {
    Action& asked = actions_.at(answer.number);
    const Own* const mine = own(asked.status.id);
    take_answer(asked, answer, mine != nullptr && mine->withdrawn, declared);
  };
  const v1::GoalId id{.writer = node_.instance(),
                      .number = requests_.send(request, answered, request.deadline + kReply)};
  actions_.emplace(id.number, action_of(id, request));
  follow(call, id);
}

/// Sends a request. Its end is the result of the call, unless the client has given that up.
void Door::send(const Call& call, bus::RequestClient& client, v1::Request request, double patience,
                std::function<Result(const v1::Answer&)> result) {
  client.send(
      std::move(request),
      [this, number = call.number, result = std::move(result)](const v1::Answer& answer) {
        if (bus::ended(answer.code) && waiting_.erase(number) > 0)
          session_.answer(number, result(answer));
      },
      patience);
  waiting_[call.number] = {.what = Waiting::For::answer};
}

/// A goal or an action that the client has just asked for.
void Door::follow(const Call& call, const v1::GoalId& id) {
  Json asked = call.arguments;
  asked.erase("wait_s");
  own_.push_back(
      {.id = id,
       .text = call.tool + " " + asked.dump(-1, ' ', false, Json::error_handler_t::replace)});
  await(call, id);
}

/// Answers the call at the end of its goal or action, or after `wait_s`. A task is one at once.
void Door::await(const Call& call, const v1::GoalId& id) {
  const double wait = call.as_task ? kDeadline + kGrace : call.arguments.value("wait_s", kWait);
  waiting_[call.number] = {.goal = id, .until = now_ + wait, .is_task = call.as_task};
  if (call.as_task)
    session_.begin_task(call.number, bus::describe(id), outcome(id).text);
}

/// False: others have too much underway, and the call is answered.
bool Door::may_begin(const Call& call) {
  if (!may_begin_)
    refuse(call,
           "not done: too many clients have goals underway; again when one "
           "of them has ended, and a stop is always taken");
  return may_begin_;
}

/// False: the client or others have too much underway, and the call is answered.
bool Door::has_room(const Call& call) {
  if (!may_begin(call))
    return false;
  std::erase_if(own_, [this](const Own& each) { return has_ended(each.id); });
  if (own_.size() < kMostGoals)
    return true;
  refuse(call, "not done: " + std::to_string(own_.size()) +
                   " goals of yours have not ended; cancel one, or wait");
  return false;
}

void Door::ask(const Call& call, const v1::ActivitySchema& schema) {
  if (!has_room(call))
    return;
  v1::Goal goal{.functor = schema.name};
  for (const auto& [name, value] : call.arguments.items())
    if (name != "wait_s")
      goal.arguments.push_back(argument(name, value));
  goal.deadline = kDeadline;
  goal.writer_lost = v1::WRITER_LOST_CANCEL;
  goal.person = person_;
  follow(call, goals_.ask(goal));
}

/// Null: this client has not asked for it, or it has ended.
Door::Own* Door::own(const v1::GoalId& id) {
  const auto found = std::ranges::find(own_, id, &Own::id);
  return found == own_.end() ? nullptr : &*found;
}

/// Null: the id is that of a goal.
const Action* Door::action(const v1::GoalId& id) const {
  const auto found = actions_.find(id.number);
  return found == actions_.end() || found->second.status.id != id ? nullptr : &found->second;
}

bool Door::has_ended(const v1::GoalId& id) const {
  const auto known = status(id);
  return known && bus::ended(known->state);
}

bool Door::has_words_underway() const {
  return std::ranges::any_of(words_, [](const auto& each) { return each.second.acts; });
}

bool Door::is_busy() const {
  return has_words_underway() ||
         !std::ranges::all_of(own_, [this](const Own& each) { return has_ended(each.id); });
}

bool Door::is_silent() const {
  return std::ranges::any_of(own_, [this](const Own& each) {
    return needs_approval(each) && session_.is_silent_for(each.question);
  });
}

/// The dialogue ends what a writer's words began when that writer is gone.
void Door::take_back_words() {
  if (words_.empty())
    return;
  heard_writer_ = node_.writer(bus::topics::kHeard);
  std::erase_if(words_, [](const auto& each) { return !each.second.acts; });
}

void Door::withdraw(Own& own, const std::string& why) {
  if (has_ended(own.id) || std::exchange(own.withdrawn, true))
    return;
  if (action(own.id) == nullptr)
    goals_.cancel(own.id, why);
  else
    requests_.withdraw(own.id.number);
}

/// The bus puts a checked identity before the client's name.
bool Door::is_mine(const v1::GoalStatus& status) const {
  return status.requester == who_ || status.requester.ends_with(", " + who_);
}

/// The goal of another client of this program, while it has not ended; nothing: it is none.
std::optional<v1::GoalStatus> Door::other(const v1::GoalId& id) const {
  auto known = goals_.status(id);
  if (known && (bus::ended(known->state) || id.writer != node_.instance() || is_mine(*known)))
    known.reset();
  return known;
}

/// Two clients are two persons: one ends the goal of the other after a question only.
void Door::cancel_other(const Call& call, const std::optional<v1::GoalId>& id) {
  const auto known = id ? other(*id) : std::nullopt;
  if (!known)
    return refuse(call,
                  "not done: this is no goal of yours that is underway; without a goal "
                  "the tool cancel ends all of yours, and what you began with say");
  if (right_ < DoorRight::operate)
    return refuse(call, "not done: this is " + known->functor + " of " + known->requester +
                            ", who may cancel it; a stop is anybody's");
  if (!call.arguments.value("sure", false))
    return refuse(
        call, "not done: this is " + known->functor + " of " + known->requester + ", " +
                  bus::describe(*known) +
                  ". Shall it end? Ask the person; after a yes call cancel again with sure: true");
  // On a secured bus the door may, which knows the keys of its persons; a person at it may not.
  goals_.cancel(*id, who_ + " was sure, after a question",
                node_.identity() ? v1::Person{} : person_);
  waiting_[call.number] = {.what = Waiting::For::cancel, .goal = id, .until = now_ + kStop};
}

void Door::cancel(const Call& call) {
  Waiting waiting{.what = Waiting::For::cancel, .until = now_ + kStop};
  if (call.arguments.contains("goal")) {
    const auto id = bus::parse_goal_id(call.arguments.value("goal", ""));
    Own* const own_goal = id ? own(*id) : nullptr;
    if (own_goal == nullptr)
      return cancel_other(call, id);
    waiting.goal = id;
    withdraw(*own_goal);
  } else {
    waiting.had_any = is_busy();
    for (Own& each : own_)
      withdraw(each);
    take_back_words();
    if (!waiting.had_any)
      waiting.until = now_;
  }
  waiting_[call.number] = waiting;
}

/// Answers a waiting call, if possible now.
bool Door::is_over(std::uint64_t number, Waiting& waiting) {
  const bool late = now_ >= waiting.until;
  switch (waiting.what) {
    case Waiting::For::goal: {
      const auto known = status(*waiting.goal);
      const bool ended = known && bus::ended(known->state);
      if (!late && (!ended || (now_ < waiting.still && robot_.moves()))) {
        if (!known)
          return false;
        const std::string news =
            bus::describe(known->state) + ("\n" + known->step + "\n" + known->reason);
        if (known->progress > waiting.told || news != waiting.words) {
          waiting.told = std::max(waiting.told + kNews, known->progress);
          waiting.words = news;
          session_.progress(number, waiting.told, words(*waiting.goal, *known));
        }
        return false;
      }
      session_.answer(number, outcome(*waiting.goal));
      return true;
    }
    case Waiting::For::cancel: {
      const bool ended = waiting.goal ? has_ended(*waiting.goal) : !is_busy();
      if (!ended || robot_.moves() || waiting.settled == 0.0)
        waiting.settled = now_ + kSettles;
      if (!late && now_ < waiting.settled)
        return false;
      const std::string robot =
          robot_.moves() ? "the robot still moves: somebody else may drive it, or it is stopping"
                         : "the robot stands";
      const std::string done = !waiting.had_any ? "nothing of yours is underway; "
                               : ended          ? "withdrawn; "
                                                : "withdrawn, and not heard to have ended; ";
      session_.answer(number,
                      {done + robot, {{"ended", ended}, {"moves", robot_.moves()}}, !ended});
      return true;
    }
    case Waiting::For::answer:
      return false;
    case Waiting::For::event:
      if (!late && !waiting.result)
        return false;
      session_.answer(number, waiting.result.value_or(Result{
                                  "nothing of that was reported", {{"happened", false}}, false}));
      return true;
    case Waiting::For::belief: {
      const std::string value = robot_.belief(waiting.name).value_or("nil");
      const bool happened = waiting.value ? value == *waiting.value : value != waiting.before;
      if (!late && !happened)
        return false;
      session_.answer(number, {"the belief " + waiting.name + " is " + value +
                                   (happened ? "" : ": the awaited value has not come"),
                               {{"happened", happened}, {"belief", waiting.name}, {"value", value}},
                               false});
      return true;
    }
    case Waiting::For::words:
      if (!late)
        return false;
      session_.answer(
          number,
          {!waiting.said.empty() ? waiting.said
           : !situation::is_heard(robot_.mind().processes().all(), "dialogue")
               ? "the robot said nothing: no saphira-dialogue is on the bus"
               : "the robot said nothing: a sentence for it begins with its keyword, such as "
                 "\"Flakey, stop\"",
           {{"said", waiting.said}},
           waiting.said.empty()});
      return true;
    case Waiting::For::picture: {
      if (!late && !picture_)
        return false;
      Result result = robot_.view();
      if (picture_)
        result.jpeg = base64(picture_->jpeg);
      else
        result.text += "\nThe camera has sent no picture: robot_status may say why.";
      session_.answer(number, result);
      return true;
    }
    case Waiting::For::estop: {
      const bool latched = robot_.mind().grant() != nullptr && robot_.mind().grant()->estopped;
      if (!late && !latched)
        return false;
      if (latched)
        press();  // releases, so that a person can reset it
      session_.answer(number, {latched ? "the emergency stop is latched, pressed by " +
                                             robot_.mind().grant()->estop_source +
                                             "; a person releases it: saphira estop reset"
                                       : kNotConfirmed,
                               {{"latched", latched}, {"moves", robot_.moves()}},
                               !latched});
      return true;
    }
  }
  return true;
}

/// Presses until the bridge has latched the stop, and then releases. The topic is best effort.
void Door::press() {
  const bool latched = robot_.mind().grant() != nullptr && robot_.mind().grant()->estopped;
  // A command has no person beside its source.
  v1::MotorCommand command{.source = person_.name.empty() ? who_ : person_.name + " at " + who_};
  for (int i = 0; i < 4; ++i) {
    command.number = bus::next_request_number();
    command.active = !latched;
    stop_writer_.write(command);
  }
}

/// Of a goal, or of an action of this client.
std::optional<v1::GoalStatus> Door::status(const v1::GoalId& id) const {
  const Action* const asked = action(id);
  return asked == nullptr ? goals_.status(id) : asked->status;
}

std::string Door::words(const v1::GoalId& id, const v1::GoalStatus& status) const {
  const Action* const asked = action(id);
  return asked == nullptr ? bus::describe(status) : words_of(*asked);
}

Result Door::outcome(const v1::GoalId& id) const {
  const auto known = status(id);
  if (!known)
    return {"goal " + bus::describe(id) +
                ": no answer yet; intentions may not run (robot_status says more)",
            {{"goal", bus::describe(id)}, {"state", "unknown"}},
            false};
  const bool bad = bus::ended(known->state) && known->state != v1::GOAL_SUCCEEDED;
  std::string text = "goal " + bus::describe(id) + ": " + words(id, *known);
  const auto mine = std::ranges::find(own_, id, &Own::id);
  if (mine != own_.end() && needs_approval(*mine))
    text += std::string(mine->question != 0 ? "; the person at this client is asked"
                                            : "; this client may not approve it: a person "
                                              "approves it in the robot's page or by the "
                                              "command line") +
            ". Then it begins; the tool goal follows it, and cancel withdraws it";
  else if (!bus::ended(known->state))
    text += "; it goes on: ask the tool goal for its end, or cancel it";
  if (other(known->waits_for))
    text += "; the tool cancel ends " + bus::describe(known->waits_for) +
            " in front of it, once its person was asked";
  const Action* const asked = action(id);
  return {text, asked == nullptr ? json_of(*known) : json_of(*asked), bad};
}

Json Door::goals() const {
  Json all = Json::array();
  for (const v1::GoalStatus& status : goals_.statuses()) {
    all.push_back(json_of(status));
    all.back()["yours"] = status.id.writer == node_.instance() && is_mine(status);
  }
  for (const auto& [number, action] : actions_) {
    all.push_back(json_of(action));
    all.back()["yours"] = true;
  }
  return all;
}

bool Door::leave() {
  if (!std::exchange(left_, true)) {
    close();
    for (auto& [number, waiting] : waiting_)
      if (waiting.goal && own(*waiting.goal) != nullptr)
        waiting.until = std::min(waiting.until, now_ + kStop);
  }
  return session_.leave();
}

void Door::close(const std::string& why) {
  for (Own& each : own_)
    withdraw(each, why);
  if (has_words_underway())
    take_back_words();
}

void Door::close_and_wait() {
  if (!left_)
    close();
  if (!own_.empty())
    goals_.delivered(1000);
}

}  // namespace saphira::mcp
