// Stops: by a goal, by the emergency stop, and by the end of the program that asked for motion.
#include <gtest/gtest.h>
#include <signal.h>

#include "system.hpp"

namespace saphira::test {
namespace {

Process command_line(const System& system, const std::vector<std::string>& words) {
  std::vector<std::string> argv{"saphira", "--robot", system.robot(), "--domain", domain()};
  argv.insert(argv.end(), words.begin(), words.end());
  return {argv, system.folder().path("cli." + words.back())};
}

/// True where the robot stays still for that number of its cycles.
bool stays_still(const System& system, std::uint64_t cycles) {
  const std::uint64_t begin = system.truth().cycle;
  bool still = true;
  const bool passed = wait_until([&] {
    still = still && system.still();
    return system.truth().cycle >= begin + cycles;
  });
  return passed && still;
}

TEST(Stop, EndsAGoalOfAnyPriority) {
  System system;
  system.start_all();
  v1::Goal wanted = test::goal("go_to", {bus::point("position", 8.0, 0.0, 0.0, v1::FRAME_ODOM)});
  wanted.priority = 1000;
  const v1::GoalId goal = system.goals().ask(wanted);
  ASSERT_TRUE(system.wait_moving()) << system.output();
  Process stop = command_line(system, {"goal", "stop"});
  EXPECT_EQ(stop.wait(), 0) << stop.output();
  const auto status = system.wait_end(goal);
  ASSERT_TRUE(status) << system.output();
  EXPECT_EQ(status->state, v1::GOAL_CANCELED);
  EXPECT_EQ(status->code, v1::CODE_STOPPED) << status->reason;
  EXPECT_TRUE(stays_still(system, 20)) << system.output();
}

// It ends itself, as any program in the role direct that hears of the stop.
TEST(Stop, EndsAProgramThatDrives) {
  System system;
  system.start("saphira-sim");
  system.start("saphira-bridge");
  Process program = command_line(system, {"speed", "0.3"});
  ASSERT_TRUE(system.wait_moving()) << program.output() << system.output();
  Process stop = command_line(system, {"goal", "stop"});
  EXPECT_EQ(stop.wait(), 0) << stop.output();
  EXPECT_TRUE(system.still()) << "it says that it is done once the robot is at rest";
  EXPECT_EQ(program.wait(), 1) << program.output();
  EXPECT_TRUE(stays_still(system, 20)) << system.output();
  Process again = command_line(system, {"move", "0.3"});
  EXPECT_EQ(again.wait(), 0) << again.output();
}

TEST(Stop, AnEmergencyStopEndsGoalsAndOnlyANewOneDrives) {
  System system;
  system.start_all();
  const v1::GoalId goal = system.go_to(8.0, 0.0);
  ASSERT_TRUE(system.wait_moving()) << system.output();
  Process estop = command_line(system, {"estop"});
  EXPECT_EQ(estop.wait(), 0) << estop.output();
  ASSERT_TRUE(system.wait_still()) << system.output();
  const auto status = system.wait_end(goal);
  ASSERT_TRUE(status) << system.output();
  EXPECT_EQ(status->state, v1::GOAL_CANCELED);
  EXPECT_EQ(status->reason.find("emergency stop, pressed by"), 0U) << status->reason;

  // While it is latched, no goal drives.
  const v1::GoalId meanwhile = system.go_to(8.0, 0.0);
  ASSERT_TRUE(system.wait_end(meanwhile)) << system.output();
  EXPECT_TRUE(stays_still(system, 10)) << system.output();

  Process reset = command_line(system, {"estop", "reset"});
  EXPECT_EQ(reset.wait(), 0) << reset.output();
  EXPECT_TRUE(stays_still(system, 20)) << system.output();

  const v1::GoalId again = system.go_to(8.0, 0.0);
  EXPECT_TRUE(system.wait_moving()) << system.output();
  system.goals().cancel(again);
  EXPECT_TRUE(system.wait_still());
}

}  // namespace
}  // namespace saphira::test
