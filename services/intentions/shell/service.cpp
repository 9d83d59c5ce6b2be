#include "intentions/shell/service.hpp"

#include <algorithm>
#include <utility>

#include "intentions/shell/convert.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/sender.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::intentions {
namespace {

constexpr double kReply = 3600.0;         // [s] for agents: an activity has a limit of its own
constexpr std::size_t kMostGoals = 1024;  // of GoalStatusSet.goals

}  // namespace

Service::Service(runtime::Ports& ports, const Options& options)
    : ports_(ports),
      behaviors_(ports.cycle(bus::topics::kBehaviors)),
      registration_(options.registration ? &ports.cycle(bus::topics::kRegistration) : nullptr),
      perception_(options.interpretation ? &ports.cycle(bus::topics::kPerception) : nullptr),
      vision_(options.vision ? &ports.cycle(bus::topics::kVision) : nullptr),
      maps_(ports.events(bus::topics::kMap)),
      behavior_schemas_(ports.newest(bus::topics::kBehaviorSchemas)),
      claims_(ports.events(bus::topics::kBeliefClaims)),
      goals_(ports.events(bus::topics::kGoals)),
      grants_(ports.events(bus::topics::kGrant)),
      intentions_(ports.each_cycle(bus::topics::kIntentions)),
      recall_(ports.recall(bus::topics::kRecallIntentions)),
      goal_recall_(ports.recall(bus::topics::kRecallGoals)),
      statuses_(ports.changes(bus::topics::kGoalStatus)),
      schemas_(ports.changes(bus::topics::kActivitySchemas)),
      beliefs_(ports.changes(bus::topics::kBeliefs)),
      messages_(ports.changes(bus::topics::kMessages)),
      drawings_(ports.changes(bus::topics::kDrawings)),
      audit_(ports.changes(bus::topics::kAudit)),
      map_requests_(ports.asker(bus::topics::kRegistrationRequest)),
      servo_(ports.asker(bus::topics::kServo)),
      stops_(ports.asker(bus::topics::kDriveStop)),
      agents_(ports.client(bus::topics::kSolve)),
      memory_(options.memory_file, kMostEndings, ports.files()),
      functions_(all_functions()),
      folders_({activities_folder(), options.folder}, functions_, built_in()),
      settings_{built_in(),       memory_.memory(), memory_.keeps(),
                ports.lockstep(), options.approval, functions_} {
  Notes notes;
  for (const std::string& trouble : memory_.troubles())
    notes.warn(trouble);
  if (const auto behaviors = ports.lockstep() ? std::nullopt : new_behaviors())
    settings_.registry.know_behaviors(*behaviors);
  // Warnings about the shipped files are not logged.
  const ActivityFolders::Reload found = folders_.reload();
  for (const std::string& error : found.errors)
    notes.error(error);
  for (const Schema& schema : found.taken)
    settings_.registry.add(schema);
  core_.emplace(settings_);
  settings_.memory = {};
  ports_.say(notes.lines());
  tell_activities();
  if (!options.vision && !ports.lockstep())
    unasked_vision_.emplace(ports.newest(bus::topics::kVision));
  ports.gate([this](const v1::RobotState&) { return missing(); });
}

void Service::restore(std::string_view state) {
  settings_.registry = core_->executor().registry();
  renew(core_, state, settings_);
}

/// In lockstep every run has, from the first cycle on, the same schemas of behaviors, the same map
/// as registration, and a registration that takes requests.
std::string Service::missing() {
  if (!knows_behaviors_)
    learn_behaviors();
  if (!knows_behaviors_)
    return bus::topics::kBehaviorSchemas.name;
  // A request to an undiscovered registration would be lost.
  if (registration_ != nullptr && !map_requests_.is_taken())
    return std::string("registration, for ") + bus::topics::kRegistrationRequest.name;
  // The robot of the first step says that it has a head; nothing asks for it before the second.
  if (robot_turns_head_ && !servo_.is_taken())
    return std::string("bridge, for ") + bus::topics::kServo.name;
  take_maps();
  const v1::Registration* const registration =
      registration_ == nullptr ? nullptr : registration_->value();
  if (registration == nullptr || (map_revision_ && *map_revision_ >= registration->map_revision))
    return {};
  return std::string(bus::topics::kMap.name) + " of revision " +
         std::to_string(registration->map_revision);
}

void Service::say(const Notes& notes, const std::vector<v1::AuditEntry>& audit) {
  ports_.say(notes.lines());
  for (const v1::AuditEntry& entry : audit)
    audit_.write(bus::timed(entry));
}

void Service::step(const runtime::Turn& turn) {
  const Core::Outputs outputs = core_->step(inputs_of(turn));
  remember(outputs.intended.updates);
  if (const auto& by = outputs.intended.stop)
    stops_.ask({"stop", {{"by", *by}}}, std::exchange(next_stop_, bus::next_request_number()));
  if (!outputs.degraded.empty())
    ports_.degrade(outputs.degraded);
  publish(outputs);
  publish(outputs.intended.updates);
  if (outputs.beliefs)
    beliefs_.write(to_bus(*outputs.beliefs, core_->executor()));
  if (outputs.way)
    draw_way(*outputs.way);
  if (outputs.look)
    servo_.ask({"look", {{"angle", *outputs.look}}});
  say(outputs.notes, outputs.audit);
}

void Service::between(double silence) {
  Core::Received received;
  take_goals(received);
  step_between(received, silence);
}

void Service::step_between(const Core::Received& received, double silence) {
  const Core::BetweenOutputs told = core_->between(received, silence);
  remember(told.updates);
  publish(told.updates);
  say(told.notes, told.audit);
}

Core::Inputs Service::inputs_of(const runtime::Turn& turn) {
  Core::Inputs inputs;
  inputs.stamp = turn.stamp;
  if (turn.new_robot) {
    robot_ = lps::settings_from_bus(turn.description);
    inputs.new_robot = &robot_;
  }
  inputs.robot_radius = turn.description.radius;
  inputs.deceleration = turn.description.deceleration;
  inputs.head_reach = turn.description.head_reach;
  robot_turns_head_ = inputs.head_reach > 0.0;
  inputs.new_frame = turn.new_frame;
  inputs.robot = from_bus(turn.robot);
  inputs.readings = lps::sonars_from_bus(turn.robot);
  const std::uint64_t cycle = turn.stamp.cycle;
  if (const v1::BehaviorSet* const behaviors = behaviors_.value()) {
    inputs.behaviors = from_bus(*behaviors);
    inputs.troubles = behaviors->missing;
    inputs.behaviors_cycle = behaviors->stamp.cycle;
    inputs.intent_age = intent_age_from_bus(*behaviors);
  }
  if (const v1::Registration* const registration =
          registration_ == nullptr ? nullptr : registration_->value()) {
    inputs.robot.odom_in_map = odom_in_map_from_bus(*registration, cycle, inputs.robot.odom);
    inputs.registered = registered_from_bus(*registration, cycle);
    inputs.map_revision = registration->map_revision;
  }
  if (const v1::Perception* const perception =
          perception_ == nullptr ? nullptr : perception_->value())
    inputs.percepts = percepts_from_bus(*perception, cycle, inputs.robot.odom);
  inputs.vision = vision();
  take_maps();
  inputs.maps = std::exchange(new_maps_, {});
  take_goals(inputs.received);
  take_claims(inputs.received);
  take_grants(inputs.received);
  agents_.poll(seconds_of(++steps_));
  inputs.received.answers = std::exchange(answers_, {});
  inputs.own_stop = {ports_.instance(), next_stop_};
  return inputs;
}

std::optional<Core::Vision> Service::vision() {
  if (unasked_vision_)
    if (auto sample = unasked_vision_->take_newest())
      newest_vision_ = std::move(sample);
  const v1::Vision* const sample = vision_ != nullptr ? vision_->value()
                                   : newest_vision_   ? &*newest_vision_
                                                      : nullptr;
  if (sample == nullptr)
    return std::nullopt;
  return from_bus(*sample);
}

void Service::take_maps() {
  for (const v1::FloorMap& map : maps_.take()) {
    map_revision_ = map.revision;
    new_maps_.push_back({map.revision, std::make_shared<const maps::Map>(maps::from_bus(map))});
  }
}

/// The behaviors that there are, where they are other ones now.
std::optional<std::vector<BehaviorSignature>> Service::new_behaviors() {
  const auto sample = behavior_schemas_.take_newest();
  knows_behaviors_ = knows_behaviors_ || sample;
  if (!sample || sample->schemas.empty())  // no evaluator of behaviors has none
    return std::nullopt;
  std::vector<BehaviorSignature> behaviors = from_bus(*sample);
  folders_.know_behaviors(behaviors);
  return behaviors;
}

void Service::learn_behaviors() {
  Core::Received received;
  received.behaviors = new_behaviors();
  if (received.behaviors)
    step_between(received);
}

void Service::take_goals(Core::Received& received) {
  received.lost_requesters = goals_.take_lost();
  received.running =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  for (const auto& sample : goals_.take())
    received.goals.push_back(from_bus(sample));
}

void Service::take_claims(Core::Received& received) {
  received.lost_claimants = claims_.take_lost();
  Notes notes;
  for (auto& sample : claims_.take()) {
    sample.data.source = named(sample.data.source, bus::asker_of(sample.info));
    try {
      received.claims.push_back(
          {from_bus(sample.data,
                    sample.info.disposed ? ClaimEvent::Kind::kWithdrawn : ClaimEvent::Kind::kSaid),
           sample.info.writer, sample.data.writer_lost == v1::WRITER_LOST_CANCEL, sample.info.age});
    } catch (const FileError& error) {
      notes.warn("a claim of " + saphira::quoted(sample.data.source) + ": " + error.what());
    }
  }
  ports_.say(notes.lines());
}

void Service::take_grants(Core::Received& received) {
  for (const auto& sample : grants_.take())
    if (!sample.info.disposed)
      received.grants.push_back(from_bus(sample.data));
}

void Service::check_files() {
  if (knows_behaviors_ || !ports_.lockstep())
    learn_behaviors();
  ActivityFolders::Reload reload = folders_.reload();
  if (!reload.changed)
    return;
  Core::Received received;
  received.activities = std::move(reload);
  step_between(received);
  tell_activities();
}

void Service::tell_activities() {
  schemas_.write({.schemas = converted(core_->executor().registry().all(),
                                       [](const Schema* schema) { return to_bus(*schema); }),
                  .trouble = folders_.trouble()});
}

void Service::remember(const GoalUpdates& updates) {
  if (updates.endings.empty() && !updates.work)
    return;
  const bool ends = memory_.append(updates.endings);
  // It names the newest ending.
  const bool all = ends && (!updates.work || memory_.keep(*updates.work));
  core_->know_saved(ends ? std::vector<Ending>() : updates.endings,
                    all ? "" : cannot_be("the memory file", "written"));
}

void Service::publish(const GoalUpdates& updates) {
  Notes notes;
  for (const GoalStatus& status : updates.changed) {
    v1::GoalStatus sample = status;
    sample.stamp = ports_.stamp();
    if (!statuses_.write(sample))
      notes.warn("the status of goal " + describe(status.id) + " did not get onto the bus");
    told_[status.id] = sample;
  }
  for (const GoalId& id : updates.withdrawn) {
    statuses_.dispose({.id = id, .stamp = ports_.stamp()});
    told_.erase(id);
  }
  if (!updates.changed.empty() || !updates.withdrawn.empty()) {
    goal_recall_.write({.goals = converted(
                            told_, [](const auto& told) { return told.second; }, kMostGoals)});
  }
  ports_.say(notes.lines());
}

void Service::publish(const Core::Outputs& said) {
  const intentions::Outputs& outputs = said.intended;
  for (const Request& request : outputs.requests)
    map_requests_.ask(request);
  for (const Request& question : outputs.questions) {
    v1::Request asked = to_bus(question);
    asked.stamp = ports_.stamp();
    const auto hear = [this, number = question.number](const v1::Answer& answer) {
      if (!bus::ended(answer.code))
        return;
      answers_.emplace_back(number, saphira::from_bus(answer));
      answers_.back().second.results.push_back(text("agent", answer.service));
    };
    agents_.send(std::move(asked), hear, kReply, kReply);
  }
  v1::Intentions sample = to_bus(said, core_->executor());
  intentions_.write(sample);
  recall_.write(sample);
  for (const SpokenText& one : outputs.said) {
    messages_.write({.source = ports_.name() + ": " + one.schema, .text = one.text});
  }
}

void Service::draw_way(const std::vector<Vec2>& way) {
  v1::Drawing drawing = drawing_of(way);
  drawing.instance = ports_.instance();
  drawing.source = ports_.name();
  if (way.empty())
    drawings_.dispose(std::move(drawing));
  else
    drawings_.write(std::move(drawing));
}

}  // namespace saphira::intentions
