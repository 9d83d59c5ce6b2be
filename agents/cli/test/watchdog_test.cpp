#include "saphira/cli/watchdog.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A bridge (0) and two services (1, 2) of one robot, and a service of another robot (3), second by
/// second.
class WatchdogTest : public testing::Test {
 protected:
  static constexpr std::uint64_t kWaits = Heartbeat::kWaitsForRobot;

  void beat(std::size_t child, std::uint64_t cycle, std::uint64_t flags = 0) {
    Heartbeat beat;
    beat.instance = 100 + child;
    beat.cycle = cycle;
    beat.flags = flags | (child == 0 ? std::uint64_t{Heartbeat::kWritesRobot} : 0);
    dog_.hear(child, beat, now_);
  }
  void second(std::uint64_t flags_of_1 = 0, std::uint64_t flags_of_2 = 0) {
    now_ += seconds(1);
    beat(0, ++cycle_);
    beat(1, flags_of_1 == 0 ? cycle_ : 0, flags_of_1);
    beat(2, flags_of_2 == 0 ? cycle_ : 0, flags_of_2);
  }
  void pass(int times, std::uint64_t flags_of_1 = 0, std::uint64_t flags_of_2 = 0) {
    for (int i = 0; i < times; ++i)
      second(flags_of_1, flags_of_2);
  }
  /// "deaf" or "mute" or "hung"; empty: no error.
  std::string trouble(std::size_t child) const {
    const std::string text = dog_.trouble(child, now_).value_or("");
    for (const char* word : {"deaf", "mute", "hung"})
      if (text.find(word) != std::string::npos)
        return word;
    return text;
  }

  Watchdog dog_{{"a", "a", "a", "b"}};
  Watchdog::Time now_{seconds(1000)};
  std::uint64_t cycle_ = 10;
};

constexpr int kDeaf = Watchdog::kDeaf.count();
constexpr int kMute = Watchdog::kMute.count();
constexpr int kAllDeaf = Watchdog::kAllDeaf.count();

TEST_F(WatchdogTest, NodeWithoutAProcessorDoesNotHang) {
  pass(10);
  for (int i = 0; i < 60; ++i) {
    now_ += seconds(1);
    dog_.starved(1, milliseconds(900), now_);
    dog_.starved(2, seconds(5), now_);
  }
  EXPECT_EQ(trouble(1), "") << "6 s of its own";
  EXPECT_EQ(trouble(2), "");
  EXPECT_EQ(trouble(0), "hung");
  now_ += seconds(4);
  EXPECT_EQ(trouble(1), "hung");
  EXPECT_EQ(trouble(2), "");
}

TEST_F(WatchdogTest, NodeThatFallsSilentHangs) {
  pass(10);
  const auto last = now_;
  EXPECT_FALSE(dog_.trouble(1, last + Watchdog::kSilent - milliseconds(1)));
  const auto trouble = dog_.trouble(1, last + Watchdog::kSilent);
  ASSERT_TRUE(trouble);
  EXPECT_NE(trouble->find("hung"), std::string::npos);
  dog_.forget(1);
  EXPECT_FALSE(dog_.trouble(1, last + seconds(100)));
}

TEST_F(WatchdogTest, ProgramThatSaysNothingOrNothingRegularIsNotJudged) {
  beat(3, 1);
  beat(3, 1);
  EXPECT_FALSE(dog_.trouble(3, now_ + seconds(1000)));
  EXPECT_FALSE(dog_.trouble(1, now_ + seconds(1000)));
}

TEST_F(WatchdogTest, NodeThatEndsInGoodOrderDoesNotHang) {
  pass(10);
  beat(1, 0, Heartbeat::kEnds);
  EXPECT_FALSE(dog_.trouble(1, now_ + seconds(1000)));
}

TEST_F(WatchdogTest, NodeThatHearsNoRobotWhileAnotherOneDoesIsDeaf) {
  pass(10);
  second(kWaits);
  pass(kDeaf - 1, kWaits);
  EXPECT_EQ(trouble(1), "");
  second(kWaits);
  EXPECT_EQ(trouble(1), "deaf");
  EXPECT_EQ(trouble(0), "");
  EXPECT_EQ(trouble(2), "");
  pass(100, kWaits);
  EXPECT_EQ(trouble(0), "") << "it was not started again: it is still the service that is deaf";
}

TEST_F(WatchdogTest, WhereNoneHearsTheRobotTheBridgeIsMute) {
  pass(10);
  second(kWaits, kWaits);
  pass(kMute - 1, kWaits, kWaits);
  for (const std::size_t child : {0, 1, 2})
    EXPECT_EQ(trouble(child), "");
  second(kWaits, kWaits);
  EXPECT_EQ(trouble(0), "mute");
  EXPECT_EQ(trouble(1), "");
  EXPECT_EQ(trouble(2), "");
}

TEST_F(WatchdogTest, OneServiceThatHearsTheRobotIsEnough) {
  pass(10, kWaits);
  pass(100, kWaits);
  EXPECT_EQ(trouble(0), "");
}

TEST_F(WatchdogTest, ABridgeThatWasStartedAgainHasTimeAnew) {
  pass(10);
  pass(kMute + 1, kWaits, kWaits);
  ASSERT_EQ(trouble(0), "mute");
  dog_.forget(0);
  pass(kMute, kWaits, kWaits);
  EXPECT_EQ(trouble(0), "");
  second(kWaits, kWaits);
  EXPECT_EQ(trouble(0), "mute");
}

TEST_F(WatchdogTest, WhereTheNewBridgeIsNotHeardEitherAllAreStartedAgain) {
  pass(10);
  pass(kMute + 1, kWaits, kWaits);
  dog_.forget(0);
  pass(kAllDeaf - kMute - 1, kWaits, kWaits);
  EXPECT_EQ(trouble(1), "");
  second(kWaits, kWaits);
  EXPECT_EQ(trouble(1), "deaf");
  EXPECT_EQ(trouble(2), "deaf");
}

TEST_F(WatchdogTest, AChildThatStaysDeafInItsThirdLifeIsNotAtFault) {
  pass(10);
  for (int life = 0; life < 3; ++life) {
    EXPECT_EQ(trouble(0), "") << life;
    pass(kDeaf + 1, kWaits);
    EXPECT_EQ(trouble(1), "deaf");
    if (life == 2)
      break;
    dog_.forget(1);
  }
  EXPECT_EQ(trouble(0), "") << "in its first life it had heard the robot";
  dog_.forget(1);
  pass(kDeaf + 1, kWaits);
  EXPECT_EQ(trouble(0), "mute");
  dog_.forget(0);
  dog_.forget(1);
  pass(kMute + 1, kWaits);
  EXPECT_EQ(trouble(0), "") << "counted anew with the new bridge";
}

TEST_F(WatchdogTest, WhereTheBridgeHasNoRobotNobodyIsDeafAndNoneMute) {
  for (int i = 0; i < 100; ++i) {
    now_ += seconds(1);
    beat(0, 5);
    beat(1, 5, kWaits);
    beat(2, 5, kWaits);
    beat(3, static_cast<std::uint64_t>(i));  // another robot's
    for (const std::size_t child : {0, 1, 2, 3})
      EXPECT_EQ(trouble(child), "");
  }
}

TEST_F(WatchdogTest, AfterASleepOfItsOwnEverybodyHasTimeAnew) {
  pass(10);
  second(kWaits);
  now_ += seconds(100);
  dog_.slept(now_);
  EXPECT_FALSE(dog_.trouble(1, now_));
  EXPECT_FALSE(dog_.trouble(1, now_ + Watchdog::kSilent - milliseconds(1)));
  EXPECT_TRUE(dog_.trouble(1, now_ + Watchdog::kSilent));
}

}  // namespace
}  // namespace saphira::cli
