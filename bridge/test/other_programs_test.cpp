#include "other_programs.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "node_options.hpp"

namespace saphira::bridge {
namespace {

class NamesakesTest : public testing::Test {
 protected:
  /// Publishes a status of `node` with that state.
  void say(bus::Node& node, v1::ServiceState state) {
    v1::ServiceStatus status = node.status();
    status.state = state;
    status.host = "the attic";
    status.pid = 12;
    said_ = node.writer(bus::topics::kStatus);
    said_->write(status);
    programs.take();
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node own{test::memory_options("bridge"), memory};
  bus::Node other{test::memory_options("bridge"), memory};
  OtherPrograms programs{own};

 private:
  std::optional<bus::Writer<v1::ServiceStatus>> said_;
};

TEST_F(NamesakesTest, AreBridgesThatServe) {
  EXPECT_FALSE(programs.has_namesake());
  say(other, v1::SERVICE_WAITING);
  EXPECT_FALSE(programs.has_namesake()) << "it has no robot";
  say(other, v1::SERVICE_RUNNING);
  ASSERT_TRUE(programs.has_namesake());
  EXPECT_EQ(programs.namesake(), "process 12 at the attic");
}

TEST_F(NamesakesTest, AreNotThisOneAndNoOtherService) {
  say(own, v1::SERVICE_RUNNING);
  EXPECT_FALSE(programs.has_namesake());
  bus::Node behaviors{test::memory_options("behaviors"), memory};
  say(behaviors, v1::SERVICE_RUNNING);
  EXPECT_FALSE(programs.has_namesake());
}

TEST_F(NamesakesTest, AreNoMoreWhenTheirProgramIsGone) {
  {
    auto status = other.status();
    auto writer = other.writer(bus::topics::kStatus);
    status.state = v1::SERVICE_DEGRADED;
    writer.write(status);
    programs.take();
    EXPECT_TRUE(programs.has_namesake());
  }
  programs.take();
  EXPECT_FALSE(programs.has_namesake());
}

// ---- Detection of a mute bridge, by the status of the programs that follow its robot.

class AudienceTest : public testing::Test {
 protected:
  void waits(std::uint8_t program, const std::string& what = "state of cycle 7") {
    v1::ServiceStatus status{
        .state = v1::SERVICE_WAITING, .reason = "waits for robot/" + what, .stamp = {.cycle = 6}};
    audience_.update({program}, status, now_);
  }
  void steps(std::uint8_t program) {
    v1::ServiceStatus status{.stamp = {.cycle = ++cycle_}};
    status.state = v1::SERVICE_RUNNING;
    audience_.update({program}, status, now_);
  }
  bool after(double seconds) {
    now_ += seconds;
    return audience_.begins_anew(now_);
  }

  Audience audience_;
  double now_ = 1000.0;
  std::uint64_t cycle_ = 10;
};

TEST_F(AudienceTest, ABridgeThatNobodyHearsIsMute) {
  EXPECT_FALSE(after(100.0)) << "nobody follows the robot";
  waits(1);
  waits(2, "description");
  EXPECT_FALSE(after(Audience::kMute - 0.1));
  waits(1);
  waits(2);
  EXPECT_TRUE(after(0.1));
}

TEST_F(AudienceTest, ItBeginsAnewOnceInAWhile) {
  waits(1);
  EXPECT_TRUE(after(Audience::kMute));
  EXPECT_FALSE(after(Audience::kAgain - 0.1));
  EXPECT_TRUE(after(0.1));
}

TEST_F(AudienceTest, OneThatHearsItIsEnough) {
  waits(1);
  steps(2);
  now_ += Audience::kMute;
  steps(2);
  waits(1);
  EXPECT_FALSE(after(0.0)) << "it is the first program that is deaf";
  audience_.lose({2});
  EXPECT_TRUE(after(0.0));
}

TEST_F(AudienceTest, WhatIsGoneOrStandsStillSaysNothing) {
  waits(1);
  audience_.lose({1});
  EXPECT_FALSE(after(Audience::kMute));
  steps(2);
  steps(2);
  waits(1);
  // No more status of the second one: it hangs, or waits for another cause.
  v1::ServiceStatus status{.stamp = {.cycle = cycle_}};
  audience_.update({2}, status, now_);
  EXPECT_TRUE(after(Audience::kMute));
}

TEST_F(AudienceTest, WhatHasHeardTheRobotAgainHasTimeAnew) {
  waits(1);
  now_ += Audience::kMute - 1.0;
  steps(1);
  waits(1);
  EXPECT_FALSE(after(1.0));
}

}  // namespace
}  // namespace saphira::bridge
