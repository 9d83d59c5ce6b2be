// Which of two programs of one name serves, and which hears the robot.
#include "neighbours.hpp"

#include <gtest/gtest.h>

#include "saphira/bus/status_words.hpp"

namespace saphira::bus::internal {
namespace {

using std::chrono::seconds;

v1::ServiceStatus program(std::uint64_t instance, double uptime, v1::ServiceState state,
                          const std::string& name = "behaviors") {
  return {.instance = instance,
          .name = name,
          .host = "attic",
          .pid = static_cast<std::uint32_t>(instance),
          .state = state,
          .uptime = uptime};
}

/// True where `own` yields, with that other one beside it.
bool yields(const v1::ServiceStatus& own, const v1::ServiceStatus& other) {
  Neighbours neighbours;
  neighbours.update({1}, other, {});
  return neighbours.serves_instead(own).has_value();
}

constexpr auto kRuns = v1::SERVICE_RUNNING;
constexpr auto kWaits = v1::SERVICE_WAITING;

TEST(Neighbours, TheOneThatServesGoesOn) {
  const auto old = program(9, 100.0, kRuns);
  for (const auto& late :
       {program(1, 0.1, kWaits), program(1, 0.1, kRuns), program(1, 50.0, kWaits)}) {
    EXPECT_TRUE(yields(late, old));
    EXPECT_FALSE(yields(old, late));
  }
}

TEST(Neighbours, OfTwoThatServeExactlyOneGoesOn) {
  for (const double uptime : {0.5, 100.0}) {
    EXPECT_TRUE(yields(program(9, uptime, kRuns), program(1, uptime, kRuns)));
    EXPECT_FALSE(yields(program(1, uptime, kRuns), program(9, uptime, kRuns)));
  }
}

TEST(Neighbours, NobodyYieldsToWhoDoesNotServe) {
  EXPECT_FALSE(yields(program(9, 9.0, kWaits), program(1, 9.0, kWaits)));
  EXPECT_FALSE(yields(program(9, 9.0, kRuns), program(1, 9.0, kRuns, "intentions")));
  EXPECT_FALSE(yields(program(9, 9.0, kWaits), program(9, 9.0, kRuns)));  // itself
}

TEST(Neighbours, WhoYieldsTakesOverWhenTheOtherIsGone) {
  Neighbours neighbours;
  const auto own = program(1, 50.0, kWaits);
  neighbours.update({1}, program(9, 100.0, kRuns), {});
  const auto words = neighbours.serves_instead(own);
  ASSERT_TRUE(words);
  EXPECT_EQ(*words,
            "another behaviors, process 9 at attic, serves this robot; waits until that is gone");
  auto status = own;
  EXPECT_FALSE(has_namesake(status));
  status.reason = *words;
  EXPECT_TRUE(has_namesake(status));
  neighbours.lose({1});
  EXPECT_FALSE(neighbours.serves_instead(own));
}

TEST(Neighbours, OneThatStepsWithoutABreakHearsTheRobot) {
  Neighbours neighbours;
  Neighbours::Time now{};
  auto status = program(9, 100.0, kRuns, "bridge");
  const auto begin = now + seconds(1);
  for (int i = 0; i < 12; ++i) {
    status.stamp.cycle = static_cast<std::uint64_t>(i);
    neighbours.update({1}, status, now += seconds(1));
  }
  EXPECT_TRUE(neighbours.stepping_since(begin, now));
  EXPECT_FALSE(neighbours.stepping_since(begin - seconds(1), now));
  EXPECT_FALSE(neighbours.stepping_since(begin, now + seconds(4)));
  // The program stood still for a while: earlier steps do not count.
  status.stamp.cycle = 100;
  neighbours.update({1}, status, now += seconds(5));
  EXPECT_FALSE(neighbours.stepping_since(begin, now));
  EXPECT_TRUE(neighbours.stepping_since(now, now));
}

}  // namespace
}  // namespace saphira::bus::internal
