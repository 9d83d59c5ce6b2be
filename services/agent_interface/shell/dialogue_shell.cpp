#include "agent_interface/shell/dialogue_shell.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "agent_interface/shell/convert.hpp"
#include "geometry/shell/convert.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/agent_interface/pointing.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/bus/namesakes.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira::agent_interface {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "dialogue";
constexpr double kConfirmsWithin = 2.0;   // [s] the bridge, a stop
constexpr std::size_t kLongestName = 31;  // [bytes] of a speaker

/// The source of a message of an activity has its service and its intention: "intentions: ask".
bool is_of_activity(const v1::Message& message) {
  return message.source.find(": ") != std::string::npos;
}

}  // namespace

DialogueShell::DialogueShell(bus::Node& node, const DialogueOptions& options)
    : node_(node),
      options_(options),
      folder_(folder_of(options.grammar), fs::path(options.grammar).extension()),
      dialogue_(Grammar(read_file(options.grammar), options.grammar)),
      agent_(node, kName, "what the robot was told"),
      goals_(node, kName),
      registration_(node, bus::topics::kRegistrationRequest, kName),
      stops_(node, bus::topics::kDriveStop, kName),
      solver_(node, bus::topics::kSolve, kName),
      audit_(node) {
  folder_.poll();
  if (!options_.memory.empty()) {
    const std::string trouble = read_or_set_aside(
        options_.memory,
        [&](const std::string& text) { restore(unsealed(text, options_.memory), dialogue_); },
        node_.options().files());
    if (!trouble.empty())
      node_.warn(trouble);
  }
}

void DialogueShell::begin() {
  node_.status().state = v1::SERVICE_DEGRADED;
  node_.status().reason = "no map has come: places have no names yet";
  for (const Claimed& one : dialogue_.claims())
    claim(one);
  for (const LastingGoal& goal : dialogue_.lasting()) {
    v1::GoalId id{.writer = goal.ref.first, .number = goal.ref.second};
    asked_[goal.tag] = id;
    if (!goal.sample.empty())
      orphans_[goal.tag] = goal.sample;
  }
  publish();
  announce();
}

void DialogueShell::announce() {
  agent_.can(bus::capability(
                 "place_of", "where a person may be, by what people said",
                 {bus::text_slot("person", "a name", true), bus::text_slot("place", "of the map")}),
             [this](const v1::Request& request) {
               return to_bus(dialogue_.place_of(bus::text_of(request.arguments, "person")));
             });
  agent_.can(bus::action("forget", "forgets advice",
                         {bus::number_slot("number", "of the advice (saphira knows)", true)}),
             [this](const v1::Request& request) {
               const Dialogue::Outputs out =
                   dialogue_.forget(bus::number_of(request.arguments, "number"));
               perform(out);
               return to_bus(out.answer);
             });
}

void DialogueShell::reload() {
  for (const std::string& name : folder_.poll().changed) {
    if (name != fs::path(options_.grammar).filename())
      continue;
    try {
      dialogue_.use(Grammar(read_file(options_.grammar), options_.grammar));
      node_.info("the grammar " + options_.grammar + " was read again");
    } catch (const std::runtime_error& error) {
      node_.error(std::string("the grammar stays as it was: ") + error.what());
    }
  }
}

/// The bridge ends whatever moves the robot, also where no other program works.
void DialogueShell::ask_to_stop(const WantedGoal& wanted) {
  v1::Request request = bus::request("stop", {bus::text("by", wanted.requester())});
  request.person = bus::to_bus(wanted.person);
  const auto confirmed = std::make_shared<std::string>();
  const auto hear = [this, tag = wanted.tag, confirmed](const v1::Answer& answer) {
    const bool silent = answer.code == v1::ANSWER_NOBODY || answer.code == v1::ANSWER_TOO_LATE;
    if (!bus::ended(answer.code)) {
      *confirmed = answer.text;
      return;
    }
    const std::string missing = confirmed->empty()
                                    ? "no bridge has confirmed the stop"
                                    : "the bridge has confirmed the stop (" + *confirmed +
                                          "), but the robot was not seen at rest";
    perform(dialogue_.ended({tag, bus::well(answer.code),
                             silent ? missing + ": press the robot's own switch" : answer.text}));
  };
  stops_.send(std::move(request), hear, kConfirmsWithin);
}

void DialogueShell::want(const WantedGoal& wanted) {
  if (wanted.functor == "stop" && !node_.options().lockstep)
    return ask_to_stop(wanted);
  v1::Goal goal{.requester = wanted.requester(),
                .functor = wanted.functor,
                .arguments = to_bus(wanted.arguments),
                .priority = wanted.priority,
                .deadline = wanted.deadline};
  goal.person = bus::to_bus(wanted.person);
  const bool lasting = wanted.lasting && !options_.memory.empty();
  goal.writer_lost = lasting ? v1::WRITER_LOST_KEEP : v1::WRITER_LOST_CANCEL;
  const v1::GoalId id = goals_.ask(goal);
  asked_[wanted.tag] = id;
  if (lasting)
    dialogue_.asked(wanted.tag, {id.writer, id.number}, bus::type_of<v1::Goal>().json(&goal, ""));
}

void DialogueShell::claim(const Claimed& claim) {
  const auto known = claimed_.find(claim.name);
  if (claim.value.empty()) {
    if (known != claimed_.end()) {
      claims_.dispose(known->second);
      claimed_.erase(known);
    }
    return;
  }
  v1::BeliefClaim sample{
      .id = {node_.instance(),
             known == claimed_.end() ? ++number_ : std::uint64_t{known->second.id.number}},
      .source = claim.source,
      .name = claim.name,
      .value = literal(claim),
      .writer_lost = v1::WRITER_LOST_CANCEL};
  claimed_[claim.name] = sample;
  claims_.write(sample);
}

void DialogueShell::perform(const Dialogue::Outputs& out) {
  for (const Said& said : out.said) {
    said_.write({.id = {node_.instance(), bus::next_request_number()},
                 .answers = {said.answers.first, said.answers.second},
                 .listener = said.listener,
                 .text = said.text,
                 .confidence = 1.0,
                 .refused = said.refused,
                 .end = said.end});
  }
  for (const std::uint64_t tag : out.canceled)
    if (const auto goal = asked_.find(tag); goal != asked_.end()) {
      goals_.cancel(goal->second, out.why);
      asked_.erase(goal);
    }
  for (const WantedGoal& goal : out.goals)
    want(goal);
  for (const Claimed& one : out.claims)
    claim(one);
  for (const OpenQuestion& one : out.asks)
    solver_.send(
        to_bus(one.request),
        [this, one](const v1::Answer& answer) {
          if (bus::ended(answer.code))
            perform(
                dialogue_.answered_by(one, answer.service, saphira::from_bus(answer), situation_));
        },
        kAgentsPatience);
  for (const maps::Feature& feature : out.namings)
    registration_.send(to_bus(put_on_map(feature)));
  if (!out.note.empty())
    node_.info(out.note);
  if (!out.denied.text.empty())
    audit_.write(out.denied);
  if (out.changed) {
    remember();
    publish();
  }
}

void DialogueShell::remember() {
  if (node_.options().files() == Files::kChange && !options_.memory.empty() &&
      !replace_file(options_.memory, sealed(saved(dialogue_))))
    node_.warn("the robot's knowledge cannot be saved: " + cannot_be(options_.memory, "written"));
}

void DialogueShell::publish() {
  v1::Knowledge sample;
  for (const Advice& advice : dialogue_.knowledge().all())
    sample.known.push_back(to_bus(advice));
  knows_.write(sample);
}

/// A goal of before a restart has no writer any more. While it is still known it gets a new one, or
/// a restart of its service would end it without a word.
void DialogueShell::adopt(std::uint64_t tag, const v1::GoalId& id) {
  const auto orphan = orphans_.find(tag);
  if (orphan == orphans_.end())
    return;
  try {
    v1::Goal goal;
    bus::from_json(orphan->second, goal);
    goals_.adopt(id, goal);
  } catch (const std::exception& error) {
    node_.warn("a goal of before the restart cannot be kept: " + std::string(error.what()));
  }
  orphans_.erase(orphan);
}

void DialogueShell::take_goals(double seconds) {
  goals_.poll();
  for (const auto& sample : wanted_.take())
    if (sample.info.disposed)
      withdrawn_.push_back(sample.data.id);
    else if (sample.data.id.writer != node_.instance())
      others_[sample.data.id] = sample.data;
  // The status tells of the end for a while, without the arguments.
  std::erase_if(withdrawn_, [&](const v1::GoalId& id) {
    const bool over = !goals_.status(id);
    if (over)
      others_.erase(id);
    return over;
  });
  std::vector<Outcome> ended;
  std::vector<std::uint64_t> without_status;
  for (const auto& [tag, id] : asked_) {
    const auto status = goals_.status(id);
    if (!status)
      without_status.push_back(tag);
    else if (bus::ended(status->state))
      ended.push_back({tag, status->state == v1::GOAL_SUCCEEDED, status->reason});
    else
      adopt(tag, id);
  }
  for (const Outcome& outcome : ended) {
    asked_.erase(outcome.tag);
    perform(dialogue_.ended(outcome));
  }
  perform(dialogue_.without_status(without_status, seconds));
  situation_.goals = known_goals();
}

void DialogueShell::take_beliefs() {
  auto sets = beliefs_.take();
  std::erase_if(sets, [](const auto& sample) { return sample.info.disposed; });
  if (sets.empty())
    return;
  // The first sample may be of before a restart. The age is by the clocks of two machines.
  const double age =
      std::exchange(knows_beliefs_, true) || node_.options().lockstep ? 0.0 : sets.back().info.age;
  perform(dialogue_.found(heed(sets.back().data, age, situation_), situation_.now));
}

/// The facts that other programs announce.
void DialogueShell::take_agents() {
  for (const auto& sample : agents_.take())
    if (sample.info.disposed)
      known_agents_.erase(sample.info.writer);
    else if (sample.data.name != kName)
      known_agents_[sample.info.writer] = sample.data;
  for (const bus::WriterId& writer : agents_.take_lost())
    known_agents_.erase(writer);
  situation_.agents.clear();
  for (const auto& [writer, agent] : known_agents_)
    for (const v1::Capability& one : agent.capabilities)
      if (!one.acts) {
        std::string& names = situation_.agents[one.functor];
        names += (names.empty() ? "" : " and ") + agent.name;
      }
}

/// Of the robot, and of a person who points.
void DialogueShell::take_places() {
  if (const auto robot = robots_.take_newest())
    situation_.turns_cameras = robot->head_reach > 0.0;
  if (auto vision = visions_.take_newest())
    seen_ = std::move(*vision);
  const auto registration = registrations_.take_newest();
  if (!registration)
    return;
  situation_.pose_in_map.reset();
  situation_.pointing_in_map.reset();
  if (registration->state != v1::REGISTRATION_TRACKING)
    return;
  situation_.pose_in_map = saphira::from_bus(registration->pose_in_map);
  if (seen_.stamp.epoch != registration->stamp.epoch || seen_.odom != registration->odom)
    return;
  std::vector<lps::SeenThing> things;
  for (const v1::SeenThing& thing : seen_.things)
    things.push_back(lps::from_bus(thing));
  situation_.pointing_in_map =
      pointing(things, std::max(seen_.stamp.cycle, registration->stamp.cycle),
               saphira::from_bus(registration->odom_in_map), situation_.pose_in_map->position());
}

std::vector<KnownGoal> DialogueShell::known_goals() const {
  std::vector<KnownGoal> goals;
  for (const v1::GoalStatus& status : goals_.statuses()) {
    const bool held = status.waits_for == v1::GoalId{} &&
                      (status.state == v1::GOAL_WAITING || status.state == v1::GOAL_SUSPENDED);
    KnownGoal& goal = goals.emplace_back(KnownGoal{.functor = status.functor,
                                                   .asker = {},
                                                   .state = status.state,
                                                   .reason = status.reason,
                                                   .tag = 0,
                                                   .note = status.note,
                                                   .step = status.step,
                                                   .elapsed = status.elapsed,
                                                   .queued = !held});
    if (const auto asked = others_.find(status.id); asked != others_.end()) {
      goal.arguments = saphira::from_bus(asked->second.arguments);
      goal.priority = asked->second.priority;
    }
    const auto mine =
        std::ranges::find_if(asked_, [&](const auto& one) { return one.second == status.id; });
    if (mine != asked_.end())
      goal.tag = mine->first;
    else if (status.id.writer != node_.instance())
      goal.asker = status.requester.empty() ? "somebody" : status.requester;
  }
  return goals;
}

void DialogueShell::take_utterances() {
  // Before the utterances: then none of a lost writer comes after its loss.
  const std::vector<bus::WriterId> lost = heard_.take_lost();
  for (const auto& sample : heard_.take()) {
    if (sample.info.disposed)
      continue;
    Utterance utterance;
    utterance.text = sample.data.text;
    utterance.confidence = sample.data.confidence;
    utterance.time = sample.data.time;
    utterance.id = {sample.data.id.writer, sample.data.id.number};
    utterance.person = bus::asker_of(sample.info, sample.data.person);
    const bool unnamed = sample.data.speaker.empty() && utterance.person;
    utterance.speaker =
        first_letters(unnamed ? utterance.person->name : sample.data.speaker, kLongestName);
    if (sample.data.means == v1::UTTERANCE_PROGRAM)
      utterance.program = sample.info.writer;
    perform(dialogue_.hear(utterance, situation_));
  }
  for (const bus::WriterId& writer : lost)
    perform(dialogue_.left(writer));
}

void DialogueShell::step(double seconds, double now) {
  situation_.now = now;
  if (!std::exchange(begun_, true))
    begin();
  if (const auto maps = maps_.take(); !maps.empty()) {
    situation_.map = maps::from_bus(maps.back());
    node_.status().state = v1::SERVICE_RUNNING;
    node_.status().reason = "";
  }
  take_places();
  take_agents();
  if (!grants_.take_lost().empty())
    situation_.estop.clear();
  if (const auto grant = grants_.take_newest()) {
    heed(*grant, situation_);
    perform(dialogue_.granted(*grant, node_.instance()));
  }
  registration_.poll(seconds);
  take_beliefs();
  for (const auto& sample : messages_.take())
    if (!sample.info.disposed && is_of_activity(sample.data))
      perform(dialogue_.says(sample.data.text, {sample.data.stamp.epoch, sample.data.stamp.cycle}));
  take_goals(seconds);
  perform(dialogue_.come_due(situation_));
  stops_.poll(seconds);
  solver_.poll(seconds);
  take_utterances();
  agent_.poll();
}

void DialogueShell::run(const bus::Stop& stop) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kPollPeriod{450};
  const auto seconds = [] {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  };
  bus::Namesakes others(node_);
  double looked = seconds();
  while (!stop.requested() && !others.superseded()) {
    node_.wait(kPollPeriod, &stop);
    if (!others.poll() && !others.superseded()) {
      others.act();
      step(seconds(), unix_time());
      if (seconds() - looked > 1.0) {
        reload();
        looked = seconds();
      }
    }
    node_.publish_status();
  }
}

}  // namespace saphira::agent_interface
