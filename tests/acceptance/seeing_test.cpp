// A person who walks through a world is seen in the pictures of its cameras and followed, over the
// bus and in lockstep: simulator, bridge, vision, perception, registration, behaviors, intentions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "lockstep.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

// Ann waits, walks away before the robot, and turns around a corner.
class Walker : public LockstepSystem {
 public:
  Walker()
      : LockstepSystem({.world = read_file(source("config/worlds/office-floor.wld")) +
                                 "\nperson ann 17500 10500 color red\n"
                                 "  wait 10  walk 17500 7000 300  walk 24000 7000 300  wait 100\n",
                        .robot = "pioneer-head",
                        .map = "office-floor",
                        .vision = true}) {}

  v1::GoalId follow() { return ask(goal("follow-person", {bus::number("seconds", 40.0)})); }

  bus::Reader<v1::Vision> visions = node.reader(bus::topics::kVision);
};

// A run in lockstep with cameras is also the same to the last bit, with the way of its head.
TEST(SeeingAcceptance, InLockstepItIsTheSameEachTime) {
  const auto run = [] {
    constexpr std::uint64_t kCycles = 200;
    Walker system;
    bus::Reader<v1::RobotState> states = system.node.reader(bus::topics::kRobotState);
    std::map<std::uint64_t, double> heads;
    system.follow();
    system.permit(kCycles);
    EXPECT_TRUE(wait_until(
        [&] {
          for (const auto& sample : states.take())
            heads[sample.data.stamp.cycle] = sample.data.head;
          system.node.wait(std::chrono::milliseconds(50));
          const auto newest = system.visions.take_newest();
          return newest && newest->stamp.cycle >= kCycles;
        },
        std::chrono::minutes(2)))
        << system.output();
    const std::string trace = system.end();
    EXPECT_GE(std::count(trace.begin(), trace.end(), '\n'), static_cast<long>(kCycles));
    return std::pair(trace.substr(0, trace.find("\n" + std::to_string(kCycles) + ",")), heads);
  };
  const auto first = run();
  EXPECT_EQ(first.second.size(), 200U);
  EXPECT_TRUE(std::any_of(first.second.begin(), first.second.end(), [](const auto& one) {
    return std::abs(one.second) > radians(5.0);
  })) << "the head kept still";
  EXPECT_EQ(first, run());
}

}  // namespace
}  // namespace saphira::test
