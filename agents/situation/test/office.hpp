#pragma once

#include <string>

#include "saphira/situation/situation.hpp"

/// A robot in an office, for tests: the samples of its programs in normal operation.
namespace saphira::situation::test {

v1::GoalId id(std::uint64_t number);
v1::RuleState rule(const std::string& name, double strength, v1::ControlAction action,
                   double value);
/// A program that has run for a minute, and was heard just now.
Program program(const std::string& name);
/// The status of goal 2, go_to (3, 1).
v1::GoalStatus goal_status(v1::GoalState state, const std::string& reason = {});

/// Cycle 1000 of a drive to (3, 1) past an obstacle on the right: KeepOff (1) steers left, GoToPos
/// (3) drives on.
Situation driving();
/// The same robot at rest: no goal was ever asked for.
Situation resting();
/// The robot stands without a driver: `reason` is the bridge's.
void stand(Situation& situation, const std::string& reason = "nothing asks the robot to move");
/// A person drives by keyboard: [m/s], [rad/s].
void by_keyboard(Situation& situation, double velocity, double rotation);
/// The guard beside the robot lets it drive at that speed, for that reason.
void guard(Situation& situation, v1::GuardAction action, const std::string& reason,
           double velocity);
/// Somebody has suspended execute-intentions in that cycle.
void suspend(Situation& situation, std::uint64_t cycle);
/// The program is not on the bus any more.
void remove(Situation& situation, const std::string& program);
Program& find(Situation& situation, const std::string& program);

}  // namespace saphira::situation::test
