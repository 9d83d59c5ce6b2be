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

// A program that is stopped by a signal, and hears nothing, does not drive on when it wakes.
TEST(Stop, HoldsForAProgramThatSleptMeanwhile) {
  System system;
  system.start("saphira-sim");
  system.start("saphira-bridge");
  bus::Writer<v1::MotorCommand> direct = system.node().writer(bus::topics::kDriveDirect);
  auto robots = system.node().reader(bus::topics::kRobotState);
  v1::MotorCommand command{.source = "a program that hears nothing",
                           .active = true,
                           .translation = v1::TRANSLATION_VELOCITY,
                           .velocity = 0.3};
  const auto drive = [&] {
    if (const auto robot = robots.take_newest())
      command.stamp = robot->stamp;
    command.number = command.number + 1;
    direct.write(command);
    system.node().wait(std::chrono::milliseconds(50));
  };
  ASSERT_TRUE(wait_until([&] {
    drive();
    return !system.still();
  }));
  Process stop = command_line(system, {"goal", "stop"});
  EXPECT_EQ(stop.wait(), 0) << stop.output();
  const std::uint64_t begin = system.truth().cycle;
  bool still = true;
  EXPECT_TRUE(wait_until([&] {
    drive();
    still = still && system.still();
    return system.truth().cycle >= begin + 30;
  }));
  EXPECT_TRUE(still);
  command.active = false;
  drive();
  command.active = true;
  EXPECT_TRUE(wait_until([&] {
    drive();
    return !system.still();
  })) << "it has let go";
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

// The goal's writer_lost is cancel. (saphira goal without --keep.)
TEST(Stop, TheEndOfAGoalsWriterIsNoticedBeforeTheRobotHasGoneFar) {
  System system;
  system.start_all();
  Process client = command_line(system, {"goal", "drive", "0.3"});
  ASSERT_TRUE(system.wait_moving()) << client.output() << system.output();
  const std::uint64_t lost = system.truth().cycle;
  client.signal(SIGKILL);
  ASSERT_TRUE(wait_until([&] { return system.stood_still(lost).has_value(); })) << system.output();
  const auto took = static_cast<long>(*system.stood_still(lost) - lost);
  std::printf("stood %ld cycles after the client was killed\n", took);
  RecordProperty("cycles_to_standstill", std::to_string(took));
  EXPECT_LE(took, 30) << "a second is meant; the participant's own lease would be ten or more";
  EXPECT_TRUE(stays_still(system, 20)) << system.output();
}

}  // namespace
}  // namespace saphira::test
