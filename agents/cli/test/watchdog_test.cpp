#include "saphira/cli/watchdog.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A bridge (0), a service (1) of one robot, and one of another robot (2), second by second.
class WatchdogTest : public testing::Test {
 protected:
  void beat(std::size_t child, std::uint64_t cycle, std::uint64_t flags = 0) {
    Heartbeat beat;
    beat.instance = 100 + child;
    beat.cycle = cycle;
    beat.flags = flags;
    dog_.hear(child, beat, now_);
  }
  void second(std::uint64_t flags_of_service = 0) {
    now_ += seconds(1);
    beat(0, ++cycle_);
    beat(1, flags_of_service == 0 ? cycle_ : 7, flags_of_service);
  }

  Watchdog dog_{{"a", "a", "b"}};
  Watchdog::Time now_{seconds(1000)};
  std::uint64_t cycle_ = 10;
};

TEST_F(WatchdogTest, NodeThatFallsSilentHangs) {
  for (int i = 0; i < 10; ++i)
    second();
  const auto last = now_;
  EXPECT_FALSE(dog_.trouble(1, last + Watchdog::kSilent - milliseconds(1)));
  const auto trouble = dog_.trouble(1, last + Watchdog::kSilent);
  ASSERT_TRUE(trouble);
  EXPECT_NE(trouble->find("hung"), std::string::npos);
  dog_.forget(1);
  EXPECT_FALSE(dog_.trouble(1, last + seconds(100)));
}

TEST_F(WatchdogTest, ProgramThatSaysNothingOrNothingRegularIsNotJudged) {
  beat(2, 1);
  beat(2, 1);
  EXPECT_FALSE(dog_.trouble(2, now_ + seconds(1000)));
  EXPECT_FALSE(dog_.trouble(1, now_ + seconds(1000)));
}

TEST_F(WatchdogTest, NodeThatEndsInGoodOrderDoesNotHang) {
  for (int i = 0; i < 10; ++i)
    second();
  beat(1, 0, Heartbeat::kEnds);
  EXPECT_FALSE(dog_.trouble(1, now_ + seconds(1000)));
}

TEST_F(WatchdogTest, NodeThatHearsNoRobotWhileOthersDoIsDeaf) {
  for (int i = 0; i < 10; ++i)
    second();
  second(Heartbeat::kWaitsForRobot);
  for (int i = 0; i < Watchdog::kDeaf.count() - 1; ++i) {
    second(Heartbeat::kWaitsForRobot);
    EXPECT_FALSE(dog_.trouble(1, now_));
  }
  second(Heartbeat::kWaitsForRobot);
  const auto trouble = dog_.trouble(1, now_);
  ASSERT_TRUE(trouble);
  EXPECT_NE(trouble->find("deaf"), std::string::npos);
  EXPECT_FALSE(dog_.trouble(0, now_));
}

TEST_F(WatchdogTest, WhereNobodyHearsTheRobotNobodyIsDeaf) {
  for (int i = 0; i < 100; ++i) {
    now_ += seconds(1);
    beat(0, 5);
    beat(1, 5, Heartbeat::kWaitsForRobot);
    beat(2, static_cast<std::uint64_t>(i));  // another robot's
    EXPECT_FALSE(dog_.trouble(1, now_));
  }
}

TEST_F(WatchdogTest, AfterASleepOfItsOwnEverybodyHasTimeAnew) {
  for (int i = 0; i < 10; ++i)
    second();
  second(Heartbeat::kWaitsForRobot);
  now_ += seconds(100);
  dog_.slept(now_);
  EXPECT_FALSE(dog_.trouble(1, now_));
  EXPECT_FALSE(dog_.trouble(1, now_ + Watchdog::kSilent - milliseconds(1)));
  EXPECT_TRUE(dog_.trouble(1, now_ + Watchdog::kSilent));
}

}  // namespace
}  // namespace saphira::cli
