#include "saphira/intentions/core.hpp"

#include <algorithm>
#include <utility>

#include "saphira/base/archive.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/language.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

constexpr std::size_t kMostAnswers = 256;  // of agents, stored
constexpr std::uint64_t kGone = 10;        // [cycles] without a sample
/// [s] Without a cycle for this long there is no robot, live.
constexpr double kSilence = 1.0;
/// [s] in which goals of before the start come. Later the clocks of other machines would decide
/// about their age.
constexpr double kStarting = 10.0;
constexpr int kMostOfAgents = 100;   // priority; operators have the last word
constexpr double kClockError = 1.0;  // [s] between two machines
/// [s] A goal from so shortly before the start was meant for this run: programs of a deployment
/// start together.
constexpr double kStartsTogether = 3.0;
constexpr std::size_t kMostEdges = 32;       // of the contract
constexpr double kOnward = 0.1;              // [m] of the robot, after which others may be nearer
constexpr std::uint64_t kAskFeatures = 200;  // [cycles] between requests to let the map grow...
constexpr double kFeaturesLease = 60.0;      // [s] ...and their duration
constexpr std::uint64_t kVisionLease = 10;   // [cycles] an older result counts as missing

/// Why goals that drive wait: a person drives, or has not handed the robot back.
std::string why_to_wait(const Core::Received::Grant& grant) {
  if (!grant.person.empty())
    return grant.person + " drives: goes on when the robot is handed back";
  if (grant.waits_for_hand_back && !grant.pressed)
    return "autonomy waits: goes on when the robot is handed back (saphira drive hand-back)";
  return {};
}

}  // namespace

Core::Core(Settings settings)
    : lockstep_(settings.lockstep),
      approval_(std::move(settings.approval)),
      remembers_(settings.memory.condition == Memory::Condition::kWhole),
      memory_damaged_(settings.memory.condition == Memory::Condition::kDamaged),
      executor_(
          std::move(settings.registry), settings.memory,
          {.remembers_work = settings.remembers_work, .functions = std::move(settings.functions)}) {
}

Core::Outputs Core::step(Inputs inputs) {
  Outputs outputs;
  learn(inputs.received, outputs.notes);
  robot_here_ = true;
  intentions::Inputs now;
  now.epoch = inputs.stamp.epoch;
  now.cycle = inputs.stamp.cycle;
  now.robot = inputs.robot;
  look_around(inputs, now.around);
  now.behaviors = std::move(inputs.behaviors);
  now.troubles = std::move(inputs.troubles);
  now.behaviors_cycle = inputs.behaviors_cycle;
  now.intent_age = inputs.intent_age;
  now.claims = claims_of(inputs.received);
  note_grants(inputs.received.grants);
  now.estop = estop_;
  if (newest_grant_) {
    now.stop = newest_grant_->stop;
    now.stop_source = newest_grant_->stop_source;
  }
  now.confirms_stops = !lockstep_;
  if (!execution_.works())
    now.hold = execution_.name() + " is suspended";
  if (!lockstep_)
    now.person = newest_grant_ ? why_to_wait(*newest_grant_) : std::string();

  now.events = events_of(inputs.received, outputs);
  std::string gone = who_is_gone(inputs);
  if (gone.empty() && !lockstep_)
    gone = newest_grant_ ? newest_grant_->refusal : std::string();
  outputs.intended = executor_.step(now);
  if (outputs.intended.stop)
    executor_.heed(inputs.own_stop);
  if (!gone.empty())
    for (GoalStatus& status : outputs.intended.updates.changed)
      if (status.state == v1::GOAL_FAILED)
        status.reason += "; " + gone;
  outputs.limit = limit_of(now, outputs.intended);
  ask_for_features(now, outputs.intended.requests);
  outputs.edges = edges_near(now);
  if (estop_.empty() && centering_.works())
    outputs.look = gaze_.step({now.robot, now.around, executor_.beliefs(), 0});
  nodes_ = outputs.intended.nodes;
  outputs.way = look_for_way(now);
  report(outputs.intended.updates, outputs.notes);
  for (const SpokenText& said : outputs.intended.said)
    outputs.notes.info("says: " + said.text);
  outputs.degraded = disk_trouble_;
  if (std::exchange(told_trouble_, disk_trouble_).empty() && !disk_trouble_.empty())
    outputs.notes.warn(disk_trouble_);
  if (const std::uint64_t revision = executor_.beliefs().revision();
      revision != beliefs_revision_) {
    beliefs_revision_ = revision;
    outputs.beliefs = executor_.beliefs().all();
  }
  return outputs;
}

/// The speed that the zones around the robot allow what is intended.
SpeedLimit Core::limit_of(const intentions::Inputs& now,
                          const intentions::Outputs& intended) const {
  if (intended.behaviors.empty())
    return {};
  const bool backwards = std::any_of(
      intended.behaviors.begin(), intended.behaviors.end(), [](const IntendedBehavior& each) {
        const Argument* const speed = find(each.parameters, "speed");
        return each.running && speed != nullptr && speed->number < 0.0;
      });
  return speed_limit({now.robot, now.around, executor_.beliefs(), 0}, backwards);
}

/// Registration lets the map grow for as long as an intention wants it: the request ends by itself
/// where this service is gone. Switched off by another, it stays off; a registration that was gone
/// is asked anew.
void Core::ask_for_features(const intentions::Inputs& now, std::vector<Request>& requests) {
  const bool heard = now.around.registration.state.has_value();
  const bool returned = heard && !hears_registration_;
  hears_registration_ = heard;
  const Belief* const belief = executor_.beliefs().stored(kGrowsMap);
  const bool wanted = belief != nullptr && belief->value.truthy();
  const bool again =
      wanted &&
      (returned || (now.around.registration.adds_features && now.cycle % kAskFeatures == 0));
  if (wanted != adds_features_ || again)
    requests.push_back(
        {"add_features", {truth("on", wanted), number("lease", wanted ? kFeaturesLease : 0.0)}});
  adds_features_ = wanted;
}

/// The nearest edges of the map, for the guard beside the robot. A map that is being built does not
/// tell people from walls that it lacks.
std::vector<Edge> Core::edges_near(const intentions::Inputs& now) {
  std::vector<Edge> edges;
  if (lines_ == nullptr || adds_features_ || now.around.registration.adds_features ||
      !now.robot.odom_in_map || now.around.registration.state != v1::REGISTRATION_TRACKING)
    return edges;
  const Vec2 robot_in_map = compose(*now.robot.odom_in_map, now.robot.pose_in_odom).position();
  if (near_.empty() || (near_of_ - robot_in_map).norm() > kOnward) {
    near_of_ = robot_in_map;
    near_ = lines_->edges_near(robot_in_map, kMostEdges);
  }
  const ToFrame to_odom(*now.robot.odom_in_map);
  edges.reserve(near_.size());
  for (const Edge& edge : near_)
    edges.push_back({to_odom(edge.from), to_odom(edge.to)});
  return edges;
}

/// The points of the path of a running follow-path intention, where they have changed.
std::optional<std::vector<Vec2>> Core::look_for_way(const intentions::Inputs& now) {
  std::vector<Vec2> way;
  for (const IntentionNode& node : nodes_)
    if (node.schema == "follow-path" && node.state == IntentionState::kRunning)
      if (const Value* const path = executor_.variable(node.id, "path"))
        way = way_points(now.around, *path);
  if (way == way_)
    return std::nullopt;
  way_ = way;
  if (!way.empty() && now.robot.odom_in_map)
    way.insert(way.begin(), compose(*now.robot.odom_in_map, now.robot.pose_in_odom).position());
  return way;
}

/// The services that have fallen silent, in words: the reason for a goal that fails then.
std::string Core::who_is_gone(const Inputs& inputs) {
  const std::uint64_t now = inputs.stamp.cycle;
  if (inputs.stamp.epoch != heard_epoch_) {
    heard_epoch_ = inputs.stamp.epoch;
    registration_heard_ = 0;
  }
  if (inputs.registered.state)
    registration_heard_ = now;
  std::string text;
  const auto add = [&](const char* name, std::uint64_t heard) {
    if (heard != 0 && heard + kGone <= now)
      text += (text.empty() ? "" : "; ") + std::string(name) + " has not been heard for " +
              plain(seconds_of(now - heard)) + " s";
  };
  add("behaviors", inputs.behaviors_cycle);
  add("registration", registration_heard_);
  return text;
}

Core::BetweenOutputs Core::between(const Received& received, double silence) {
  BetweenOutputs told;
  learn(received, told.notes);
  // A single-stepped simulator may stand still for any time.
  if (robot_here_ && !lockstep_ && silence > kSilence) {
    robot_here_ = false;
    executor_.lose_robot();
  }
  told.updates = executor_.take_events(events_of(received, told));
  report(told.updates, told.notes);
  return told;
}

/// Knowledge beside the robot's state, from the inputs of the cycle before.
void Core::look_around(const Inputs& inputs, Surroundings& around) {
  if (inputs.new_robot != nullptr)
    lps_.emplace(*inputs.new_robot);
  else if (inputs.new_frame && lps_)
    lps_->reset();
  if (lps_) {
    readings_ = inputs.readings;
    lps_->update(inputs.robot.pose_in_odom, readings_, inputs.stamp.cycle);
    around.readings = &readings_;
    around.lps = &*lps_;
  }
  percepts_ = inputs.percepts;
  if (percepts_)
    around.percepts = &*percepts_;
  around.cycle = inputs.stamp.cycle;
  const std::optional<Vision>& vision = inputs.vision;
  if (vision && vision->sees && vision->stamp.epoch == inputs.stamp.epoch &&
      vision->stamp.cycle + kVisionLease >= inputs.stamp.cycle) {
    things_.clear();
    if (vision->odom == inputs.robot.odom)
      things_ = vision->things;
    around.things = &things_;
    around.sees_colors = vision->sees_colors;
  }
  around.registration = inputs.registered;
  newer_maps_.insert(newer_maps_.end(), inputs.maps.begin(), inputs.maps.end());
  take_maps(inputs.map_revision);
  around.topology = topology_;
  around.map = map_;
  around.robot_radius = inputs.robot_radius;
  around.deceleration = inputs.deceleration;
  around.head_reach = inputs.head_reach;
  around.map_revision = places_revision_;
  for (const auto& [question, answer] : inputs.received.answers)
    answers_[question] = answer;
  while (answers_.size() > kMostAnswers)
    answers_.erase(answers_.begin());
  around.answers = &answers_;
  if (!lockstep_ && newest_grant_)
    around.other_driver = newest_grant_->driver;
}

/// Maps do not come with the cyclic topics. In lockstep the map is the one that registration used
/// in the cycle before: a newer one waits.
void Core::take_maps(std::optional<std::uint64_t> revision) {
  const bool exact = lockstep_ && revision;
  while (!newer_maps_.empty() &&
         (!exact || newer_maps_.front().revision <= *revision || topology_ == nullptr)) {
    NewMap& next = newer_maps_.front();
    // An added or removed object leaves plans as they are.
    if (topology_ == nullptr || !maps::same_places(*map_, *next.map)) {
      places_ = next.map;
      places_revision_ = next.revision;
      topology_ = std::make_shared<const maps::Topology>(*places_);
      executor_.know_places(topology_);
    }
    map_ = std::move(next.map);
    lines_ = std::make_shared<const maps::LineMap>(*map_);
    near_.clear();
    newer_maps_.pop_front();
  }
}

void Core::archive(Archive& a) {
  a("processes", processes_)("executor", executor_)("remembers", remembers_)(
      "memory_damaged", memory_damaged_)("gaze", gaze_)("adds_features", adds_features_)(
      "hears_registration", hears_registration_)("estop", estop_)("newest_grant", newest_grant_)(
      "lps", lps_)("percepts", percepts_)("things", things_)("readings", readings_)("map", map_)(
      "places", places_)("near_of", near_of_)("near", near_)("places_revision", places_revision_)(
      "newer_maps", newer_maps_)("requesters", requesters_)("owners", owners_)("answers", answers_)(
      "claimants", claimants_)("logged", logged_)("nodes", nodes_)("way", way_)(
      "beliefs_revision", beliefs_revision_)("robot_here", robot_here_)(
      "heard_epoch", heard_epoch_)("registration_heard", registration_heard_);
  if (!a.restores())
    return;
  topology_ = places_ ? std::make_shared<const maps::Topology>(*places_) : nullptr;
  lines_ = map_ ? std::make_shared<const maps::LineMap>(*map_) : nullptr;
  executor_.know_places(topology_);
}

void Core::know_saved(const std::vector<Ending>& unsaved, const std::string& trouble) {
  disk_trouble_ = trouble.empty() ? "" : trouble + "; a restart may do finished work again";
  if (!trouble.empty())
    executor_.not_saved(unsaved);
}

void Core::learn(const Received& received, Notes& notes) {
  if (received.behaviors) {
    executor_.registry().know_behaviors(*received.behaviors);
    for (const Diagnostic& trouble : check_references(executor_.registry()))
      notes.warn(trouble.text());
  }
  if (received.activities)
    know(*received.activities, notes);
}

void Core::know(const ActivityFolders::Reload& reload, Notes& notes) {
  for (const std::string& error : reload.errors)
    notes.error(error);
  for (const std::string& warning : reload.warnings)
    notes.warn(warning);
  for (const std::string& name : reload.removed) {
    executor_.registry().remove(name);
    notes.info(name + " is gone: no file gives it any more");
  }
  for (const Schema& schema : reload.taken) {
    executor_.registry().add(schema);
    notes.info("took " + schema.name + " of " + schema.source);
  }
}

std::optional<std::string> Core::ask(const std::string& name, ProcessAction action,
                                     std::uint32_t cycles) {
  const auto goal = std::find_if(logged_.begin(), logged_.end(),
                                 [&](const auto& each) { return describe(each.first) == name; });
  if (goal != logged_.end() && action == ProcessAction::resume && executor_.approve(goal->first))
    return "";
  auto node = std::find_if(nodes_.begin(), nodes_.end(), [&](const IntentionNode& one) {
    return one.name == name || std::to_string(one.id) == name ||
           "I" + std::to_string(one.id) == name;
  });
  if (node == nodes_.end()) {
    // By people's name for it: its schema, where that is unambiguous.
    const auto alike = [&](const IntentionNode& one) { return one.schema == name; };
    node = std::find_if(nodes_.begin(), nodes_.end(), alike);
    if (node == nodes_.end())
      return std::nullopt;
    std::string ids = "I" + std::to_string(node->id);
    for (auto other = std::find_if(node + 1, nodes_.end(), alike); other != nodes_.end();
         other = std::find_if(other + 1, nodes_.end(), alike))
      ids += ", I" + std::to_string(other->id);
    if (ids.find(',') != std::string::npos)
      return "several intentions are " + name + ": say which one, " + ids;
  }
  if (cycles > 0)
    return "an intention is interrupted until it is resumed, not for some cycles";
  if (action == ProcessAction::resume)
    return executor_.resume(node->id) ? "" : name + " was not interrupted";
  return executor_.interrupt(node->id) ? "" : name + " is not an intention any more";
}

template <class Out>
std::vector<GoalEvent> Core::events_of(const Received& received, Out& out) {
  std::vector<GoalEvent> events;
  for (const Received::Goal& goal : received.goals) {
    GoalEvent event = goal.event;
    const double before_start = received.running < kStarting ? goal.age - received.running : 0.0;
    if (!take_person(goal, before_start > 0.0, event, out))
      continue;
    if (event.kind == GoalEvent::Kind::kDisposed && event.by.empty()) {
      const auto asked = requesters_.find(event.goal.id);
      const bool is_known = asked != requesters_.end();
      if (!is_known || asked->second != goal.writer)
        event.by = goal.person ? goal.person->name : is_known ? "another program" : "a program";
      else if (event.why.empty())
        event.by = "the program that asked for it";
    }
    // A goal that another person changes still ends with the program that asked for it.
    if (event.kind == GoalEvent::Kind::kWritten && event.by.empty())
      requesters_[event.goal.id] = goal.writer;
    if (!remembers_ && !lockstep_ && before_start > kStartsTogether)
      event.forgotten =
          "was asked for " + plain(before_start) + " s before intentions started, " +
          (memory_damaged_ ? "whose memory is damaged" : "which has no memory of the time before") +
          ": it may have been done already. Ask again to have it done";
    if (event.kind == GoalEvent::Kind::kWritten) {
      Surroundings map;
      map.topology = topology_;
      map.map = map_;
      event.forbidden = why_refused({Robot(), map, executor_.beliefs(), 0}, event.goal.functor,
                                    event.goal.arguments);
    }
    events.push_back(std::move(event));
  }
  for (const Writer& lost : received.lost_requesters) {
    for (const auto& [id, writer] : requesters_) {
      if (writer != lost)
        continue;
      GoalEvent event;
      event.kind = GoalEvent::Kind::kWriterLost;
      event.goal.id = id;
      events.push_back(std::move(event));
    }
    // A program that comes back has another writer.
    std::erase_if(requesters_, [&](const auto& asked) { return asked.second == lost; });
  }
  return events;
}

/// True where the person may do that to the goal: the owner, who asked for it first, and operators.
/// Names the person in the event, where it is not the owner. is_old: written before this start.
template <class Out>
bool Core::take_person(const Received::Goal& goal, bool is_old, GoalEvent& event, Out& out) {
  const GoalId& id = event.goal.id;
  const bool writes = event.kind == GoalEvent::Kind::kWritten;
  const std::string says = event.goal.requester;
  std::string who = named(says, goal.person);
  event.goal.requester = who;
  if (goal.person && goal.person->role == "agent")
    event.goal.priority = std::min(event.goal.priority, kMostOfAgents);
  event.needs_approval = writes && needs_approval(says, goal.person);
  const auto note = [&](v1::AuditAct act, const std::string& text) {
    if (!is_old)
      out.audit.push_back({.act = act,
                           .who = who,
                           .text = "goal " + describe(id) + (text.empty() ? "" : ", " + text)});
  };
  auto found = owners_.find(id);
  if (found == owners_.end() && goal.person)
    if (const Goal* const known = executor_.goal(id))
      found = owners_.insert({id, {Identity{}, *known}}).first;
  if (found == owners_.end()) {
    if (writes) {
      owners_[id] = {goal.person, event.goal};
      note(v1::AUDIT_ASKED, describe(Request{event.goal.functor, event.goal.arguments}));
    }
    return true;
  }
  Owner& owner = found->second;
  // From before a restart: its name says whose it is.
  if (owner.person == Identity{} && goal.person && !goal.person->name.empty() &&
      (owner.goal.requester == goal.person->text() ||
       named(owner.goal.requester, goal.person) == owner.goal.requester))
    owner.person = goal.person;
  const auto asked = requesters_.find(id);
  const bool by_its_program = !writes && goal.event.why.empty() && asked != requesters_.end() &&
                              asked->second == goal.writer;  // which knows for whom
  if (by_its_program)
    who = owner.goal.requester;
  if (!by_its_program && !may_end(goal.person, owner.person)) {
    const std::string why = "goal " + describe(id) + " of " + quoted(owner.goal.requester) + ": " +
                            (goal.person->name.empty() ? "a stranger" : goal.person->name) +
                            " may not " + (writes ? "change" : "cancel") +
                            " it; its owner may, or an operator";
    if (!std::exchange(owner.told, true)) {
      out.notes.warn(why);
      note(v1::AUDIT_REFUSED, std::string("to ") + (writes ? "change" : "cancel") + " it");
    }
    return false;
  }
  if (goal.person && owner.person && goal.person->name != owner.person->name && !by_its_program) {
    event.by = goal.person->name.empty() ? "a stranger" : goal.person->name;
    event.needs_approval = false;
    event.goal.requester = owner.goal.requester;
  }
  const auto logged = logged_.find(id);
  if (!writes && (logged == logged_.end() || !ended(logged->second)))
    note(v1::AUDIT_CANCELED, event.why);
  else if (writes && event.goal != owner.goal)
    note(v1::AUDIT_CHANGED, describe(Request{event.goal.functor, event.goal.arguments}));
  if (writes)
    owner.goal = event.goal;
  return true;
}

bool Core::needs_approval(const std::string& says, const Checked& who) const {
  return std::any_of(approval_.begin(), approval_.end(), [&](const std::string& one) {
    return !one.empty() && (says.starts_with(one) || (who && who->role == one));
  });
}

std::vector<ClaimEvent> Core::claims_of(const Received& received) {
  std::vector<ClaimEvent> events;
  for (const Received::Claim& claim : received.claims) {
    events.push_back(claim.event);
    // A claim of before a restart comes again, and answers no question that is asked anew.
    if (!lockstep_ && received.running < kStarting && claim.age > received.running + kClockError)
      events.back().age = static_cast<Ticks>(claim.age / kTick);
    if (claim.event.kind == ClaimEvent::Kind::kSaid && claim.ends_with_writer)
      claimants_[claim.event.id] = claim.writer;
    else
      claimants_.erase(claim.event.id);
  }
  for (const Writer& lost : received.lost_claimants) {
    for (auto claim = claimants_.begin(); claim != claimants_.end();) {
      if (claim->second != lost) {
        ++claim;
        continue;
      }
      ClaimEvent event;
      event.kind = ClaimEvent::Kind::kWithdrawn;
      event.id = claim->first;
      events.push_back(std::move(event));
      claim = claimants_.erase(claim);
    }
  }
  return events;
}

/// From any grant since the last time: a stop that was pressed and reset meanwhile counts as well.
/// In lockstep only stops are used, so that the time of arrival of a grant does not matter.
void Core::note_grants(const std::vector<Received::Grant>& grants) {
  bool pressed = false;
  for (const Received::Grant& grant : grants) {
    if (grant.pressed)
      estop_ = grant.source.empty() ? "a program without a name" : grant.source;
    else if (!pressed)
      estop_.clear();
    pressed = pressed || grant.pressed;
    newest_grant_ = grant;
  }
}

void Core::report(const GoalUpdates& updates, Notes& notes) {
  for (const GoalStatus& status : updates.changed) {
    const auto logged = logged_.find(status.id);
    if (logged != logged_.end() && logged->second == status.state)
      continue;
    logged_[status.id] = status.state;
    notes.info("goal " + describe(status.id) + ", " + quoted(status.functor) + " of " +
               quoted(status.requester) + ": " + word_of(status.state) +
               (status.reason.empty() ? "" : ": " + status.reason) +
               (status.note.empty() ? "" : "; it " + status.note));
  }
  for (const GoalId& id : updates.withdrawn) {
    requesters_.erase(id);
    owners_.erase(id);
    logged_.erase(id);
  }
}

}  // namespace saphira::intentions
