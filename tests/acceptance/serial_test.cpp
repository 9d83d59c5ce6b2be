// The whole system with a serial line at 9600 baud before the robot, as slow as a real one: the
// robot arrives as without the line.
#include <gtest/gtest.h>

#include "serial_line.hpp"
#include "system.hpp"

namespace saphira::test {
namespace {

TEST(SerialLine, TheRobotArrivesAtNinetySixHundredBaud) {
  const TempDir folder;
  System system("serial:" + folder.path("tty") + "@9600");
  const SerialLine line(folder.path("tty"), system.simulator_socket(), 9600);
  system.start_all();
  const v1::GoalId goal = system.go_to(3.0, 0.3);
  const std::optional<v1::GoalStatus> status = system.wait_end(goal);
  ASSERT_TRUE(status.has_value()) << system.output();
  EXPECT_EQ(status->state(), v1::GOAL_SUCCEEDED) << status->reason() << system.output();
  EXPECT_EQ(system.truth().contacts, 0);
  EXPECT_GT(line.from_robot(), 2000U);
  EXPECT_LT(line.to_robot(), line.from_robot()) << "commands that wait are old";
}

}  // namespace
}  // namespace saphira::test
