#include "office.hpp"

#include <algorithm>
#include <stdexcept>

#include "saphira/geometry/pose.hpp"

namespace saphira::situation::test {
namespace {

constexpr std::uint64_t kCycle = 1000;

v1::BehaviorState keep_off() {
  v1::BehaviorState state;
  state.name = "KeepOff";
  state.schema = "KeepOff";
  state.priority = 1;
  state.running = true;
  state.turn_activity = 0.7;
  state.turn_weight = 0.7;
  state.recommends_turn = true;
  state.turn = radians(20.0);
  state.rules = {rule("Obstacle-Right", 1.0, v1::CONTROL_TURN_LEFT, radians(20.0)),
                 rule("Obstacle-Left", 0.0, v1::CONTROL_TURN_RIGHT, radians(20.0))};
  v1::FuzzyVariable variable;
  variable.name = "front_right";
  variable.value = 1.0;
  state.variables.push_back(variable);
  variable.name = "front_left";
  variable.value = 0.0;
  state.variables.push_back(variable);
  return state;
}

v1::BehaviorState go_to_pos() {
  v1::BehaviorState state;
  state.name = "GoToPos";
  state.schema = "GoToPos";
  state.priority = 3;
  state.running = true;
  state.turn_activity = 1.0;
  state.turn_weight = 0.3;
  state.speed_activity = 1.0;
  state.speed_weight = 1.0;
  state.recommends_turn = true;
  state.turn = radians(-10.0);
  state.recommends_speed = true;
  state.speed = 0.3;
  state.rules = {rule("Right", 1.0, v1::CONTROL_TURN_RIGHT, radians(10.0)),
                 rule("Left", 0.0, v1::CONTROL_TURN_LEFT, radians(10.0)),
                 rule("Fast", 1.0, v1::CONTROL_SPEED, 0.3)};
  return state;
}

v1::Intentions intentions() {
  v1::Intentions all;
  all.stamp.epoch = 7;
  all.stamp.cycle = kCycle - 1;
  all.behavior_control = true;
  v1::IntentionNode node;
  node.id = 5;
  node.name = "go_to1";
  node.schema = "go_to";
  node.step = "driving to (3.00, 1.00)";
  node.goal = id(2);
  all.nodes = {node};
  for (const char* name : {"KeepOff", "GoToPos"}) {
    v1::IntendedBehavior intended;
    intended.name = name;
    intended.schema = name;
    intended.running = true;
    intended.intention = 5;
    all.behaviors.push_back(intended);
  }
  return all;
}

v1::Goal go_to() {
  v1::Goal goal;
  goal.id = id(2);
  goal.requester = "saphira goal";
  goal.functor = "go_to";
  v1::Argument position;
  position.name = "position";
  position.kind = v1::ARGUMENT_POINT;
  position.point.x = 3.0;
  position.point.y = 1.0;
  position.frame = v1::FRAME_ODOM;
  goal.arguments = {position};
  return goal;
}

v1::BehaviorSchema keep_off_schema() {
  v1::BehaviorSchema schema;
  schema.name = "KeepOff";
  v1::RuleText text;
  text.name = "Obstacle-Right";
  text.antecedent = "front_right And Not front_left";
  schema.rules.push_back(text);
  text.name = "Obstacle-Left";
  text.antecedent = "front_left";
  schema.rules.push_back(text);
  return schema;
}

}  // namespace

v1::GoalId id(std::uint64_t number) {
  v1::GoalId result;
  result.writer = 0xabc;
  result.number = number;
  return result;
}

v1::RuleState rule(const std::string& name, double strength, v1::ControlAction action,
                   double value) {
  v1::RuleState result;
  result.name = name;
  result.strength = strength;
  result.action = action;
  result.value = value;
  return result;
}

Program program(const std::string& name) {
  Program result;
  result.status.name = name;
  result.status.state = v1::SERVICE_RUNNING;
  result.status.stamp.epoch = 7;
  result.status.stamp.cycle = kCycle;
  result.status.uptime = 60.0;
  result.age = 0.4;
  return result;
}

v1::GoalStatus goal_status(v1::GoalState state, const std::string& reason) {
  v1::GoalStatus status;
  status.id = id(2);
  status.stamp.epoch = 7;
  status.stamp.cycle = kCycle - 10;
  status.functor = "go_to";
  status.requester = "saphira goal";
  status.state = state;
  status.reason = reason;
  return status;
}

Situation driving() {
  Situation now;
  now.cycle = now.now = kCycle;
  now.listened = 3.0;
  v1::RobotState robot;
  robot.stamp.epoch = 7;
  robot.stamp.cycle = kCycle;
  robot.velocity = 0.3;
  now.robot = robot;

  v1::Grant grant;
  grant.stamp.epoch = 7;
  grant.stamp.cycle = kCycle + 1;
  grant.role = v1::ROLE_BEHAVIORS;
  grant.source = "behaviors";
  grant.reason = "no stronger driver sends commands";
  grant.guard = v1::GUARD_NONE;
  grant.asked_velocity = 0.3;
  grant.velocity = 0.3;
  grant.rotation = v1::ROTATION_HEADING;
  grant.heading = radians(11.0);
  grant.answers = robot.stamp;
  now.grant = grant;

  v1::BehaviorSet behaviors;
  behaviors.stamp = robot.stamp;
  behaviors.control = true;
  behaviors.behaviors = {keep_off(), go_to_pos()};
  behaviors.turning = true;
  behaviors.turn = radians(11.0);
  behaviors.moving = true;
  behaviors.speed = 0.3;
  now.behaviors = behaviors;
  now.intentions = intentions();
  now.behaviors_known = {kCycle - 20, kCycle};
  now.intentions_known = {kCycle - 20, kCycle};
  now.goals = {go_to()};
  now.statuses = {goal_status(v1::GOAL_UNDERWAY)};
  now.statuses_known = true;
  now.schemas = {keep_off_schema()};
  for (const char* name : {"bridge", "behaviors", "intentions", "interpretation", "registration"})
    now.programs.push_back(program(name));
  return now;
}

Situation resting() {
  Situation now = driving();
  stand(now);
  now.goals.clear();
  now.statuses.clear();
  now.intentions->nodes.clear();
  now.intentions->behaviors.clear();
  now.behaviors->behaviors.clear();
  return now;
}

void stand(Situation& situation, const std::string& reason) {
  situation.robot->velocity = 0.0;
  v1::Grant& grant = *situation.grant;
  grant.role = v1::ROLE_NONE;
  grant.source = "";
  grant.reason = reason;
  grant.velocity = 0.0;
  grant.asked_velocity = 0.0;
  grant.rotation = v1::ROTATION_VELOCITY;
  grant.rotation_velocity = 0.0;
  situation.behaviors->moving = false;
  situation.behaviors->turning = false;
  situation.behaviors->speed = 0.0;
}

void by_keyboard(Situation& situation, double velocity, double rotation) {
  situation.robot->velocity = velocity;
  situation.robot->rotation_velocity = rotation;
  v1::Grant& grant = *situation.grant;
  grant.role = v1::ROLE_TELEOP;
  grant.source = "keyboard of ann";
  grant.reason = "no stronger driver sends commands";
  grant.velocity = velocity;
  grant.asked_velocity = velocity;
  grant.rotation = v1::ROTATION_VELOCITY;
  grant.rotation_velocity = rotation;
}

void guard(Situation& situation, v1::GuardAction action, const std::string& reason,
           double velocity) {
  situation.grant->guard = action;
  situation.grant->guard_reason = reason;
  situation.grant->velocity = velocity;
  situation.robot->velocity = velocity;
}

void suspend(Situation& situation, std::uint64_t cycle) {
  v1::Process process;
  process.name = "execute-intentions";
  process.state = v1::PROCESS_SUSPENDED;
  process.since = cycle;
  v1::ProcessSet service;
  service.service = "intentions";
  service.processes = {process};
  situation.processes = {service};
}

void remove(Situation& situation, const std::string& name) {
  std::erase_if(situation.programs, [&](const Program& one) { return one.status.name == name; });
}

Program& find(Situation& situation, const std::string& name) {
  for (Program& one : situation.programs)
    if (one.status.name == name)
      return one;
  throw std::invalid_argument("no program " + name);
}

}  // namespace saphira::situation::test
