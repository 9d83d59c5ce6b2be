// The whole system behind a bad serial line: the robot arrives as without the line.
#include <gtest/gtest.h>

#include "noise.hpp"
#include "serial_line.hpp"
#include "system.hpp"

namespace saphira::test {
namespace {

void arrives(System& system) {
  const std::optional<v1::GoalStatus> status = system.wait_end(system.go_to(1.6, 0.2));
  ASSERT_TRUE(status.has_value()) << system.output();
  EXPECT_EQ(status->state, v1::GOAL_SUCCEEDED) << status->reason << system.output();
  EXPECT_EQ(system.truth().contacts, 0);
}

// One byte in a hundred is damaged, lost or doubled, both ways.
TEST(NoisyLine, TheRobotArrivesAtOnePercent) {
  const TempDir folder;
  System system("unix:" + folder.path("line"));
  system.start("saphira-sim");
  ASSERT_TRUE(wait_until(
      [&] { return system["saphira-sim"].output().find("listening") != std::string::npos; }));
  NoisyLine line(folder.path("line"), system.simulator_socket(), 7);
  system["saphira-sim"].expect_violations();
  line.set_probability(0.01, 0.01);
  for (const char* name : {"saphira-bridge", "saphira-behaviors", "saphira-intentions"})
    system.start(name);
  arrives(system);
  EXPECT_GT(line.hurt(), 15U);
}

// As slow as a real one.
TEST(SerialLine, TheRobotArrivesAtNinetySixHundredBaud) {
  const TempDir folder;
  System system("serial:" + folder.path("tty") + "@9600");
  const SerialLine line(folder.path("tty"), system.simulator_socket(), 9600);
  system.start_all();
  arrives(system);
  EXPECT_GT(line.from_robot(), 1000U);
  EXPECT_LT(line.to_robot(), line.from_robot()) << "commands that wait are old";
}

}  // namespace
}  // namespace saphira::test
