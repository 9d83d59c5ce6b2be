#include "drive/whole.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"
#include "saphira/maps/edit.hpp"

namespace saphira::test {
namespace {

constexpr std::uint64_t kEpoch = 1;
constexpr std::uint64_t kOdom = 1;

behaviors::Frame frame_of(intentions::Frame frame) {
  return frame == intentions::Frame::kRobot ? behaviors::Frame::robot
         : frame == intentions::Frame::kMap ? behaviors::Frame::map
                                            : behaviors::Frame::odom;
}

behaviors::Argument argument_of(const intentions::Argument& argument) {
  switch (argument.kind) {
    case intentions::ArgumentKind::kNumber:
      return {argument.name, argument.number};
    case intentions::ArgumentKind::kText:
      return {argument.name, argument.text};
    case intentions::ArgumentKind::kPoint:
      break;
  }
  return {argument.name, behaviors::PlacedPoint{argument.point, frame_of(argument.frame)}};
}

std::vector<behaviors::Intended> intended_of(
    const std::vector<intentions::IntendedBehavior>& wanted) {
  std::vector<behaviors::Intended> intended;
  for (const intentions::IntendedBehavior& behavior : wanted) {
    intended.push_back({behavior.name, behavior.schema, behavior.priority, behavior.running, {}});
    for (const intentions::Argument& parameter : behavior.parameters)
      intended.back().parameters.push_back(argument_of(parameter));
  }
  return intended;
}

std::vector<intentions::BehaviorLevel> levels_of(const behaviors::Output& output) {
  std::vector<intentions::BehaviorLevel> levels;
  for (const behaviors::BehaviorState& state : output.behaviors)
    levels.push_back({state.name, state.blended.evaluation.activity.goal,
                      state.blended.evaluation.activity.progress});
  return levels;
}

intentions::Parameter parameter_of(const behaviors::ParameterSpec& spec) {
  intentions::Parameter parameter;
  parameter.name = spec.name;
  parameter.kind = spec.kind == behaviors::Kind::number ? intentions::ArgumentKind::kNumber
                   : spec.kind == behaviors::Kind::text ? intentions::ArgumentKind::kText
                                                        : intentions::ArgumentKind::kPoint;
  parameter.low = spec.low;
  parameter.high = spec.high;
  parameter.required = spec.required;
  return parameter;
}

intentions::Localization localization_of(registration::State state) {
  switch (state) {
    case registration::State::off:
      return intentions::Localization::kOff;
    case registration::State::unplaced:
      return intentions::Localization::kUnplaced;
    case registration::State::lost:
      return intentions::Localization::kLost;
    case registration::State::tracking:
      break;
  }
  return intentions::Localization::kTracking;
}

intentions::ExecutorOptions options_of(
    const std::shared_ptr<const intentions::Functions>& functions) {
  intentions::ExecutorOptions options;
  options.functions = functions;
  return options;
}

}  // namespace

intentions::Registry shipped_schemas(const behaviors::Registry& behaviors) {
  intentions::Registry registry = intentions::built_in();
  std::vector<intentions::BehaviorSignature> signatures;
  for (const std::string& name : behaviors.names()) {
    signatures.push_back({name, {}});
    for (const behaviors::ParameterSpec& spec : behaviors.find(name)->parameters)
      signatures.back().parameters.push_back(parameter_of(spec));
  }
  registry.know_behaviors(std::move(signatures));
  const intentions::ActivityFolders::News news =
      intentions::ActivityFolders({intentions::activities_folder()}, intentions::all_functions(),
                                  registry)
          .look();
  if (!news.errors.empty())
    throw std::runtime_error(news.errors.front());
  for (const intentions::Schema& schema : news.taken)
    registry.add(schema);
  return registry;
}

Whole::Whole(const WholeOptions& options)
    : drive_(options.drive),
      map_(maps::load_map(find_file(config_folder() + "/maps",
                                    options.map.empty() ? options.drive.world : options.map,
                                    ".map"))),
      topology_(std::make_shared<const maps::Topology>(map_)),
      interpretation_(with_sonars<interpretation::Settings>(drive_)),
      registration_(
          with_sonars<registration::Settings>(drive_), map_,
          options.knows_pose ? std::optional(drive_.seen().true_pose_in_world) : std::nullopt),
      adds_objects_(options.adds_objects),
      executor_(options.schemas.value_or(
                    shipped_schemas(options.drive.behaviors.value_or(behaviors::predefined()))),
                {}, options_of(intentions::all_functions())),
      sees_(options.sees) {}

void Whole::advance() {
  // What the others said in the cycle before.
  const behaviors::Output behaved = drive_.output();
  const std::vector<lps::Percept> seen_before = percepts_;
  registration::Output registered = registration_.output();
  const std::set<std::uint32_t> closed_doors = registration_.closed_doors();
  if (builder_) {
    registered.state = registration::State::tracking;
    registered.pose_in_map = builder_->pose_in_map();
  }
  const Pose was_in_odom = drive_.seen().pose_in_odom;

  const Seen& seen = drive_.advance();
  intentions::Inputs inputs;
  inputs.epoch = kEpoch;
  inputs.cycle = seen.cycle;
  inputs.robot.connected = true;
  inputs.robot.odom = kOdom;
  inputs.robot.pose_in_odom = seen.pose_in_odom;
  inputs.robot.velocity = seen.velocity;
  inputs.robot.rotation_velocity = seen.rotation_velocity;
  if (registered.state == registration::State::tracking ||
      registered.state == registration::State::off)
    inputs.robot.odom_in_map = compose(registered.pose_in_map, relative(was_in_odom, Pose{}));
  inputs.robot.left_stalled = seen.left_stalled;
  inputs.robot.right_stalled = seen.right_stalled;
  inputs.around.lps = &drive_.executive().lps();
  inputs.around.percepts = &seen_before;
  if (sees_)
    inputs.around.things = &things_;
  inputs.around.cycle = seen.cycle;
  inputs.around.topology = topology_;
  inputs.around.map = std::shared_ptr<const maps::Map>(std::shared_ptr<void>(), &map_);
  inputs.around.map_revision = map_revision_;
  inputs.around.readings = &seen.readings;
  inputs.around.registration.adds_features = builder_.has_value();
  inputs.around.registration.state = localization_of(registered.state);
  inputs.around.registration.pose_in_map = registered.pose_in_map;
  inputs.around.registration.confidence = registered.confidence;
  inputs.around.registration.closed_doors = closed_doors;
  if (registered.environment && !builder_)
    inputs.around.registration.environment = map_.features[*registered.environment].id;
  inputs.behaviors = levels_of(behaved);
  inputs.behaviors_cycle = seen.cycle - 1;
  inputs.events = std::exchange(events_, {});
  inputs.claims = std::exchange(claims_, {});
  if (!behaved.trouble.empty())
    trouble_ = behaved.trouble;
  intentions_ = executor_.step(inputs);
  for (const intentions::GoalStatus& status : intentions_.news.changed)
    statuses_[status.id] = status;
  for (const intentions::Said& each : intentions_.said)
    said_.push_back(each.text);
  drive_.intend(intended_of(intentions_.behaviors), intentions_.behavior_control);

  if (!builder_)
    amend(registration_.step(
        {seen.cycle, kOdom, seen.pose_in_odom, seen_before, seen.readings, adds_objects_}));
  else if (builder_->step({seen.cycle, kOdom, seen.pose_in_odom, seen_before, seen.readings, {}}))
    set_map(builder_->map());
  for (const intentions::MapRequest request : intentions_.map_requests)
    obey(request);
  percepts_ = interpretation_.step({seen.cycle, seen.pose_in_odom, seen.readings}).percepts;
  if (sees_)
    things_ = sees_(drive_);
  note_transitions();
}

void Whole::set_map(maps::Map map) {
  if (!maps::same_places(map_, map)) {
    topology_ = std::make_shared<const maps::Topology>(map);
    ++map_revision_;
  }
  map_ = std::move(map);
}

/// What is gone is taken from the map, what is new is put onto it.
void Whole::amend(const registration::Output& output) {
  if (output.presence.gone.empty() && output.objects.empty())
    return;
  maps::Editor editor(map_);
  for (const std::uint32_t id : output.presence.gone)
    editor.remove(id);
  for (const maps::Feature& object : output.objects)
    editor.put(object);
  set_map(editor.map());
  registration_.set_map(map_);
}

/// As the registration service does it, as far as a map is built from nothing.
void Whole::obey(intentions::MapRequest request) {
  using intentions::MapRequest;
  if (request == MapRequest::kForget) {
    set_map({});
    registration_.set_map(map_);
  } else if (request == MapRequest::kAddFeatures && map_.features.empty()) {
    auto settings = with_sonars<registration::MapBuilderSettings>(drive_);
    builder_.emplace(settings, map_, registration_.output().pose_in_map);
  } else if (request == MapRequest::kKeep && builder_) {
    registration_.set_map(map_);
    registration_.set_pose(builder_->pose_in_map());
    registration::Memory here = registration_.save();
    here.pose_in_odom = drive_.seen().pose_in_odom;
    registration_.restore(here);
    builder_.reset();
  }
}

bool Whole::advance_until(const std::function<bool()>& done, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    if (done())
      return true;
    advance();
  }
  return done();
}

intentions::GoalId Whole::ask(std::string functor, intentions::Arguments arguments, int priority,
                              double deadline) {
  intentions::GoalEvent event;
  event.goal.id = {1, next_goal_++};
  event.goal.requester = "test";
  event.goal.functor = std::move(functor);
  event.goal.arguments = std::move(arguments);
  event.goal.priority = priority;
  event.goal.deadline = deadline;
  events_.push_back(event);
  return event.goal.id;
}

void Whole::claim(std::string name, intentions::Value value) {
  intentions::ClaimEvent event;
  event.id = {2, next_goal_++};
  event.source = "test";
  event.name = std::move(name);
  event.value = std::move(value);
  claims_.push_back(std::move(event));
}

const intentions::GoalStatus& Whole::status(const intentions::GoalId& goal) const {
  static const intentions::GoalStatus unheard;
  const auto found = statuses_.find(goal);
  return found == statuses_.end() ? unheard : found->second;
}

bool Whole::ended(const intentions::GoalId& goal) const {
  return intentions::ended(status(goal).state);
}

intentions::GoalStatus Whole::achieve(std::string functor, intentions::Arguments arguments,
                                      int cycles) {
  const intentions::GoalId goal = ask(std::move(functor), std::move(arguments));
  advance_until([&] { return ended(goal); }, cycles);
  return status(goal);
}

bool Whole::at_rest() const {
  return std::abs(drive_.seen().velocity) < 0.02 &&
         std::abs(drive_.seen().rotation_velocity) < radians(3.0);
}

/// The display of paper Figure 10, as it changes: nodes that come, that come to another state or
/// label, and that go. The names that the forest has given are left out, since they are numbers.
void Whole::note_transitions() {
  using intentions::IntentionNode;
  const auto line = [&](const IntentionNode& node, const std::string& what) {
    transitions_.push_back(std::to_string(cycle()) + " " + node.schema + " (" + node.name + ") " +
                           what);
  };
  std::map<std::uint32_t, IntentionNode> now;
  for (const IntentionNode& node : intentions_.nodes)
    now.emplace(node.id, node);
  for (const auto& [id, node] : nodes_)
    if (!now.contains(id))
      line(node, "gone");
  for (const auto& [id, node] : now) {
    const auto before = nodes_.find(id);
    if (before == nodes_.end())
      line(node, "begins, " + node.label);
    else if (before->second.label != node.label)
      line(node, node.label);
  }
  nodes_ = std::move(now);
}

}  // namespace saphira::test
