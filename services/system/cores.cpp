#include "system/cores.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace saphira::system {
namespace {

constexpr std::uint64_t kEpoch = 1;

behaviors::Intent intent_of(const intentions::Core::Outputs& said) {
  const intentions::Outputs& wanted = said.intended;
  behaviors::Intent intent{0, wanted.behavior_control, {}, said.limit.speed, said.limit.reason};
  for (const intentions::IntendedBehavior& behavior : wanted.behaviors) {
    behaviors::Intended& intended = intent.behaviors.emplace_back();
    intended.name = behavior.name;
    intended.schema = behavior.schema;
    intended.priority = behavior.priority;
    intended.running = behavior.running;
    intended.parameters = behavior.parameters;
  }
  return intent;
}

void tell_behaviors(const behaviors::Output& output, intentions::Core::Inputs& inputs) {
  for (const behaviors::BehaviorState& state : output.behaviors) {
    const behaviors::Activity& activity = state.blended.evaluation.activity;
    inputs.behaviors.push_back({state.name, activity.goal, activity.progress});
  }
  for (const behaviors::Missing& missing : output.missing)
    inputs.troubles.push_back({missing.name, missing.reason});
  inputs.intent_age =
      static_cast<std::uint64_t>(std::max(1LL, std::llround(output.input_age / intentions::kTick)));
}

}  // namespace

std::vector<intentions::BehaviorSignature> signatures_of(const behaviors::Registry& behaviors) {
  std::vector<intentions::BehaviorSignature> signatures;
  for (const std::string& name : behaviors.names()) {
    signatures.push_back({name, {}});
    for (const behaviors::ParameterSpec& spec : behaviors.find(name)->parameters) {
      intentions::Parameter& parameter = signatures.back().parameters.emplace_back();
      parameter.name = spec.name;
      parameter.kind = spec.kind;
      parameter.low = spec.low;
      parameter.high = spec.high;
      parameter.required = spec.required;
    }
  }
  return signatures;
}

Cores::Cores(Settings settings) : settings_(std::move(settings)) {
  behaviors_.registry() = settings_.behaviors;
  if (settings_.interpretation)
    interpretation_.emplace();
  if (settings_.registration)
    registration_.emplace(*settings_.registration);
  if (!settings_.intentions)
    return;
  settings_.intentions->lockstep = true;
  intentions_.emplace(*settings_.intentions);
  intentions_->know_behaviors(signatures_of(settings_.behaviors));
  know_map();
}

/// Latched: intentions has every map before the step that uses it.
void Cores::know_map() {
  if (!intentions_ || !registration_ || known_map_ == registration_->map_revision())
    return;
  known_map_ = registration_->map_revision();
  intentions_->know_map({known_map_, std::make_shared<const maps::Map>(registration_->map())});
}

const Cores::Said& Cores::step(const RobotCycle& robot) {
  behaviors_.processes().step(robot.cycle);
  if (interpretation_)
    interpretation_->processes().step(robot.cycle);
  if (registration_)
    registration_->processes().step(robot.cycle);
  if (intentions_)
    intentions_->processes().step(robot.cycle);
  Said now;
  now.cycle = robot.cycle;
  now.pose_in_odom = robot.pose_in_odom;
  now.behaviors = step_behaviors(robot);
  if (intentions_)
    now.intentions = step_intentions(robot);
  if (registration_)
    step_registration(robot, now);
  if (interpretation_)
    step_interpretation(robot, now);
  said_ = std::move(now);
  know_map();
  return said_;
}

behaviors::Core::Outputs Cores::step_behaviors(const RobotCycle& robot) {
  behaviors::Core::Inputs inputs;
  inputs.cycle = robot.cycle;
  inputs.new_robot = first() ? &settings_.robot : nullptr;
  // Commands take effect at once here: the heading setpoint is not needed.
  inputs.robot = {robot.pose_in_odom,    robot.velocity,     robot.rotation_velocity,
                  robot.pose_in_odom.th, robot.left_stalled, robot.right_stalled};
  inputs.sonars = robot.readings;
  if (!intentions_)
    inputs.intent = intent_;
  else if (!first())
    inputs.intent = intent_of(said_.intentions);
  if (inputs.intent)
    inputs.intent->cycle = robot.cycle - 1;
  return behaviors_.step(inputs);
}

void Cores::step_interpretation(const RobotCycle& robot, Said& now) {
  interpretation::Core::Inputs inputs;
  inputs.cycle = robot.cycle;
  inputs.new_robot = first() ? &settings_.robot.lps.sonars : nullptr;
  inputs.pose_in_odom = robot.pose_in_odom;
  inputs.readings = robot.readings;
  now.percepts = interpretation_->step(inputs).output->percepts;
}

void Cores::step_registration(const RobotCycle& robot, Said& now) {
  registration::Core::Inputs inputs;
  inputs.cycle = robot.cycle;
  inputs.new_robot = first() ? &settings_.robot.lps.sonars : nullptr;
  inputs.odom = robot.odom;
  inputs.pose_in_odom = robot.pose_in_odom;
  inputs.percepts = said_.percepts;
  inputs.readings = robot.readings;
  for (const Request& request : asked_)
    registration_->act(request);
  // As in lockstep: a request of the last cycle counts in the next one.
  asked_ = said_.intentions.intended.requests;
  now.registration = registration_->step(inputs);
  now.map_revision = registration_->map_revision();
  now.adds_features = registration_->adds_features();
}

intentions::Core::Outputs Cores::step_intentions(const RobotCycle& robot) {
  intentions::Core::Inputs inputs;
  inputs.stamp = {kEpoch, robot.cycle};
  inputs.new_robot = first() ? &settings_.robot.lps : nullptr;
  inputs.robot.connected = true;
  inputs.robot.odom = robot.odom;
  inputs.robot.pose_in_odom = robot.pose_in_odom;
  inputs.robot.velocity = robot.velocity;
  inputs.robot.rotation_velocity = robot.rotation_velocity;
  inputs.robot.head = robot.head;
  inputs.head_reach = settings_.head_reach;
  inputs.robot.left_stalled = robot.left_stalled;
  inputs.robot.right_stalled = robot.right_stalled;
  inputs.readings = robot.readings;
  inputs.heard = std::exchange(heard_, {});
  if (!first()) {
    tell_behaviors(said_.behaviors.output, inputs);
    inputs.behaviors_cycle = said_.cycle;
    if (interpretation_)
      inputs.percepts = said_.percepts;
    if (said_.things)
      inputs.vision = {{kEpoch, said_.cycle}, robot.odom, true, *said_.things};
  }
  if (!first() && registration_) {
    const registration::Core::Outputs& told = said_.registration;
    if (told.state == v1::REGISTRATION_TRACKING || told.state == v1::REGISTRATION_OFF)
      inputs.robot.odom_in_map = compose(told.pose_in_map, relative(said_.pose_in_odom, Pose{}));
    inputs.registered.state = told.state;
    inputs.registered.pose_in_map = told.pose_in_map;
    inputs.registered.confidence = told.confidence;
    inputs.registered.environment = told.environment;
    inputs.registered.adds_features = said_.adds_features;
    inputs.registered.closed_doors.insert(told.closed_doors.begin(), told.closed_doors.end());
    inputs.map_revision = said_.map_revision;
  }
  return intentions_->step(std::move(inputs));
}

void Cores::intend(std::vector<behaviors::Intended> behaviors, bool control) {
  intent_ = {0, control, std::move(behaviors)};
}

void Cores::set_control(bool control) {
  if (intent_)
    intent_->control = control;
}

void Cores::hear(intentions::GoalEvent goal) {
  heard_.goals.push_back({std::move(goal), {}});
}

void Cores::hear(intentions::ClaimEvent claim) {
  heard_.claims.push_back({std::move(claim), {}, false});
}

}  // namespace saphira::system
