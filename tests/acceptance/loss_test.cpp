// The loss of any program while the robot drives stops the robot within half a second, and the
// system continues by itself when the program is back.
#include <gtest/gtest.h>
#include <signal.h>

#include "system.hpp"

namespace saphira::test {
namespace {

struct Loss {
  const char* name;
  int signal;
};

// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest looks for this name
void PrintTo(const Loss& loss, std::ostream* out) {
  *out << loss.name << " " << (loss.signal == SIGKILL ? "killed" : "stopped");
}

class LossTest : public testing::TestWithParam<Loss> {};

TEST_P(LossTest, TheRobotStandsWithinHalfASecondAndTheSystemGoesOn) {
  const Loss loss = GetParam();
  System system;
  system.start_all();
  const v1::GoalId goal = system.go_to(8.0, 0.0);
  ASSERT_TRUE(system.wait_moving()) << system.output();

  // By the robot's own cycles, whatever the load of this machine.
  const std::uint64_t lost = system.truth().cycle;
  system[loss.name].signal(loss.signal);
  ASSERT_TRUE(wait_until([&] { return system.stood_still(lost).has_value(); })) << system.output();
  const auto took = static_cast<long>(*system.stood_still(lost) - lost);
  EXPECT_LE(took, 5 + 1) << "0.5 s, and the cycle that had begun" << system.output();
  RecordProperty("cycles_to_standstill", std::to_string(took));
  std::printf("%s: stood %ld cycles later\n", loss.name, took);

  // The robot does not drive while the program is away.
  const std::uint64_t cycle = system.truth().cycle;
  if (std::string(loss.name) != "saphira-bridge") {
    ASSERT_TRUE(wait_until([&] { return system.truth().cycle > cycle + 10; })) << system.output();
  }
  EXPECT_TRUE(system.still()) << system.output();

  if (loss.signal == SIGKILL)
    system.start(loss.name);
  else
    system[loss.name].signal(SIGCONT);
  EXPECT_TRUE(system.wait_moving()) << system.output();
  EXPECT_EQ(system.truth().contacts, 0);
  system.goals().cancel(goal);
  EXPECT_TRUE(system.wait_still()) << system.output();
}

INSTANTIATE_TEST_SUITE_P(EveryProgram, LossTest,
                         testing::Values(Loss{"saphira-behaviors", SIGKILL},
                                         Loss{"saphira-behaviors", SIGSTOP},
                                         Loss{"saphira-intentions", SIGKILL},
                                         Loss{"saphira-intentions", SIGSTOP},
                                         Loss{"saphira-bridge", SIGKILL}),
                         [](const testing::TestParamInfo<Loss>& test) {
                           return std::string(test.param.name).substr(8) +
                                  (test.param.signal == SIGKILL ? "Killed" : "Stopped");
                         });

}  // namespace
}  // namespace saphira::test
