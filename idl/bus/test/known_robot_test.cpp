#include "saphira/bus/known_robot.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include <thread>

#include "harness.hpp"

namespace saphira::bus::test {
namespace {

using Knowledge = KnownRobot::Knowledge;

NodeOptions named(const std::string& name, bool lockstep) {
  NodeOptions options;
  options.name = name;
  options.lockstep = lockstep;
  return options;
}

/// A stop that comes when a test would wait for ever.
class Patience {
 public:
  Patience()
      : guard_([this] {
          pollfd fd{over_.fd(), POLLIN, 0};
          if (poll(&fd, 1, 20000) == 0)
            stop_.request();
        }) {}
  ~Patience() {
    over_.request();
    guard_.join();
  }
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;

  const Stop& stop() const { return stop_; }

 private:
  Stop stop_;
  Stop over_;
  std::thread guard_;
};

class KnownRobots : public testing::Test {
 protected:
  void describe(std::uint64_t epoch) {
    v1::RobotDescription description;
    description.stamp(stamp(epoch, 0));
    descriptions_.write(description);
  }

  std::shared_ptr<MemoryBus> bus_ = make_memory_bus();
  Node bridge_{named("bridge", true), bus_};
  Writer<v1::RobotDescription> descriptions_{bridge_.writer(topics::kRobotDescription)};
  Patience patience_;
};

TEST_F(KnownRobots, LiveThereIsNoneBeforeItHasCome) {
  Node node(named("service", false), bus_);
  KnownRobot robot(node);
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::none);
  EXPECT_EQ(node.status().state(), v1::SERVICE_WAITING);
  describe(7);
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::fresh);
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::same);
  EXPECT_EQ(node.status().state(), v1::SERVICE_RUNNING);
}

TEST_F(KnownRobots, InLockstepItIsWaitedFor) {
  Node node(named("service", true), bus_);
  KnownRobot robot(node);
  describe(6);  // of the epoch before: no news
  std::thread later([&] { describe(7); });
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::fresh);
  later.join();
  EXPECT_EQ(robot.description().stamp().epoch(), 7U);
}

TEST_F(KnownRobots, InLockstepNobodyWaitsForWhatWasReplaced) {
  Node node(named("service", true), bus_);
  KnownRobot robot(node);
  describe(8);  // the robot came again before this service was there
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::none);
  EXPECT_FALSE(patience_.stop().requested());
  EXPECT_EQ(robot.of(8, patience_.stop()), Knowledge::fresh);
}

TEST_F(KnownRobots, TwoThatCameBetweenTwoLooksAreBothKnown) {
  Node node(named("service", false), bus_);
  KnownRobot robot(node);
  describe(7);
  describe(8);
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::fresh);
  EXPECT_EQ(robot.of(8, patience_.stop()), Knowledge::fresh);
}

TEST_F(KnownRobots, InLockstepTheWaitEndsWhenAnotherEpochBegins) {
  Node node(named("service", true), bus_);
  KnownRobot robot(node);
  std::thread later([&] { describe(8); });
  EXPECT_EQ(robot.of(7, patience_.stop()), Knowledge::none);
  later.join();
  EXPECT_FALSE(patience_.stop().requested());
}

}  // namespace
}  // namespace saphira::bus::test
