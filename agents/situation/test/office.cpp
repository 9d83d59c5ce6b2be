#include "office.hpp"

#include <stdexcept>

#include "saphira/geometry/pose.hpp"

namespace saphira::situation::test {
namespace {

constexpr std::uint64_t kCycle = 1000;

v1::BehaviorState keep_off() {
  v1::BehaviorState state{
      .name = "KeepOff",
      .schema = "KeepOff",
      .priority = 1,
      .running = true,
      .turn_activity = 0.7,
      .turn_weight = 0.7,
      .recommends_turn = true,
      .turn = radians(20.0),
      .rules = {rule("Obstacle-Right", 1.0, v1::CONTROL_TURN_LEFT, radians(20.0)),
                rule("Obstacle-Left", 0.0, v1::CONTROL_TURN_RIGHT, radians(20.0))}};
  v1::FuzzyVariable variable{.name = "front_right", .value = 1.0};
  state.variables.push_back(variable);
  variable.name = "front_left";
  variable.value = 0.0;
  state.variables.push_back(variable);
  return state;
}

v1::BehaviorState go_to_pos() {
  return {.name = "GoToPos",
          .schema = "GoToPos",
          .priority = 3,
          .running = true,
          .turn_activity = 1.0,
          .speed_activity = 1.0,
          .turn_weight = 0.3,
          .speed_weight = 1.0,
          .recommends_turn = true,
          .turn = radians(-10.0),
          .recommends_speed = true,
          .speed = 0.3,
          .rules = {rule("Right", 1.0, v1::CONTROL_TURN_RIGHT, radians(10.0)),
                    rule("Left", 0.0, v1::CONTROL_TURN_LEFT, radians(10.0)),
                    rule("Fast", 1.0, v1::CONTROL_SPEED, 0.3)}};
}

v1::Intentions intentions() {
  v1::Intentions all{.stamp = {7, kCycle - 1}, .behavior_control = true};
  v1::IntentionNode node{.id = 5,
                         .name = "go_to1",
                         .schema = "go_to",
                         .step = "driving to (3.00, 1.00)",
                         .goal = id(2)};
  all.nodes = {node};
  for (const char* name : {"KeepOff", "GoToPos"}) {
    all.behaviors.push_back({.name = name, .schema = name, .running = true, .intention = 5});
  }
  return all;
}

v1::Goal go_to() {
  v1::Goal goal{.id = id(2)};
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
  v1::BehaviorSchema schema{.name = "KeepOff"};
  v1::RuleText text{.name = "Obstacle-Right", .antecedent = "front_right And Not front_left"};
  schema.rules.push_back(text);
  text.name = "Obstacle-Left";
  text.antecedent = "front_left";
  schema.rules.push_back(text);
  return schema;
}

}  // namespace

v1::GoalId id(std::uint64_t number) {
  return {.writer = 0xabc, .number = number};
}

v1::RuleState rule(const std::string& name, double strength, v1::ControlAction action,
                   double value) {
  return {.name = name, .strength = strength, .action = action, .value = value};
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
  return {.id = id(2),
          .stamp = {7, kCycle - 10},
          .requester = "saphira goal",
          .functor = "go_to",
          .state = state,
          .reason = reason};
}

Situation driving() {
  Situation now;
  now.cycle = now.now = kCycle;
  now.listened = 3.0;
  v1::RobotState robot{.stamp = {7, kCycle}, .velocity = 0.3};
  now.robot = robot;

  v1::Grant grant{.stamp = {7, kCycle + 1},
                  .role = v1::ROLE_BEHAVIORS,
                  .source = "behaviors",
                  .reason = "no stronger driver sends commands",
                  .guard = v1::GUARD_NONE,
                  .asked_velocity = 0.3,
                  .velocity = 0.3,
                  .rotation = v1::ROTATION_HEADING,
                  .heading = radians(11.0),
                  .answers = robot.stamp};
  now.grant = grant;

  v1::BehaviorSet behaviors{.stamp = robot.stamp,
                            .control = true,
                            .behaviors = {keep_off(), go_to_pos()},
                            .turning = true,
                            .turn = radians(11.0),
                            .moving = true,
                            .speed = 0.3};
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
  v1::Process process{.name = "execute-intentions", .state = v1::PROCESS_SUSPENDED, .since = cycle};
  v1::ProcessSet service{.service = "intentions", .processes = {process}};
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
