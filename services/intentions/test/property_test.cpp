#include <gtest/gtest.h>

#include <set>

#include "bench.hpp"
#include "saphira/base/random.hpp"

namespace saphira::intentions {
namespace {

constexpr const char* kFunctors[] = {"go_to", "drive", "turn_to", "stop", "fly"};

Arguments random_arguments(Random& random, const std::string& functor) {
  if (random.chance(0.1))
    return {number("nonsense", random.uniform(-9, 9))};
  if (functor == "drive")
    return {number("speed", random.uniform(-0.4, 0.6))};
  if (functor == "go_to")
    return {point("position", {random.uniform(-3, 3), random.uniform(-3, 3), 0.0},
                  random.chance(0.5) ? Frame::robot : Frame::odom),
            number("patience", 3.0)};
  if (functor == "turn_to")
    return {number("heading", random.uniform(-3, 3))};
  return {};
}

/// Under random inputs at most one goal is underway, and all intentions serve it. An end is final
/// and has a reason. Every goal ends once no more inputs come.
TEST(ExecutorProperty, HoldsForRandomGoals) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    Bench bench;
    std::map<std::uint64_t, GoalStatus> ends;
    std::uint64_t last = 0;
    const auto check = [&] {
      int underway = 0;
      GoalId serving;
      for (const auto& [id, status] : bench.statuses) {
        if (status.state == v1::GOAL_UNDERWAY) {
          ++underway;
          serving = status.id;
        }
        if (!ended(status.state)) {
          ASSERT_EQ(ends.count(id), 0U) << "seed " << seed << ": goal " << id << " rose again";
          continue;
        }
        ASSERT_FALSE(status.reason.empty());
        const auto known = ends.emplace(id, status).first;
        ASSERT_EQ(known->second, status) << "seed " << seed;
      }
      ASSERT_LE(underway, 1) << "seed " << seed << " cycle " << bench.cycle;
      if (underway == 0) {
        ASSERT_TRUE(bench.out.behaviors.empty());
      }
      std::set<std::string> names;
      std::set<std::uint32_t> nodes = {0};
      for (const IntentionNode& node : bench.out.nodes) {
        ASSERT_TRUE(nodes.contains(node.parent)) << "parents come before children";
        ASSERT_TRUE(nodes.insert(node.id).second);
      }
      for (const IntendedBehavior& behavior : bench.out.behaviors) {
        ASSERT_TRUE(names.insert(behavior.name).second);
        ASSERT_TRUE(nodes.contains(behavior.intention));
      }
      for (const IntentionNode& node : bench.out.nodes) {
        if (node.parent != 0) {
          ASSERT_EQ(node.goal, serving);
        }
      }
    };
    for (int i = 0; i < 600; ++i) {
      if (random.chance(0.1)) {
        const std::string functor = kFunctors[random.next() % 5];
        Goal goal = Bench::goal(++last, functor, random_arguments(random, functor),
                                static_cast<int>(random.next() % 3));
        if (random.chance(0.3))
          goal.deadline = random.uniform(0.0, 20.0);
        if (random.chance(0.3))
          goal.writer_lost = v1::WRITER_LOST_KEEP;
        bench.write(goal);
      }
      const std::uint64_t some = 1 + random.next() % (last + 1);
      if (random.chance(0.03))
        bench.dispose(some);
      if (random.chance(0.03))
        bench.lose_writer(some);
      if (random.chance(0.05) && last > 0) {  // also for goals that have ended
        const std::string functor = kFunctors[random.next() % 5];
        bench.ask(1 + random.next() % last, functor, random_arguments(random, functor),
                  static_cast<int>(random.next() % 3));
      }
      if (random.chance(0.1))
        bench.world.held = !bench.world.held;
      if (random.chance(0.01))
        bench.executor.lose_robot();
      if (random.chance(0.01))
        bench.world.robot.connected = !bench.world.robot.connected;
      if (random.chance(0.005)) {
        ++bench.epoch;
        bench.cycle = 0;
        bench.world.robot.odom += random.next() % 2;
      }
      if (random.chance(0.2))
        bench.hear();
      bench.step();
      check();
      if (HasFatalFailure())
        return;
    }
    bench.world.held = false;
    bench.world.robot.connected = true;
    for (std::uint64_t id = 1; id <= last; ++id) {
      if (bench.statuses.contains(id) && bench.status(id).functor == "drive")
        bench.dispose(id);
    }
    for (int i = 0; i < 3000; ++i) {
      bench.step();
      check();
      if (HasFatalFailure())
        return;
    }
    EXPECT_TRUE(bench.out.nodes.empty()) << "seed " << seed;
    EXPECT_TRUE(bench.statuses.empty()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace saphira::intentions
