// One byte in a hundred of the serial line is damaged, lost or doubled, both ways: the robot still
// arrives, without a contact.
#include "noise.hpp"

#include <gtest/gtest.h>

#include "system.hpp"

namespace saphira::test {
namespace {

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
  const v1::GoalId goal = system.go_to(3.0, 0.3);
  const std::optional<v1::GoalStatus> status = system.wait_end(goal);
  ASSERT_TRUE(status.has_value()) << system.output();
  EXPECT_EQ(status->state(), v1::GOAL_SUCCEEDED) << status->reason() << system.output();
  EXPECT_EQ(system.truth().contacts, 0);
  EXPECT_GT(line.hurt(), 40U);
}

}  // namespace
}  // namespace saphira::test
