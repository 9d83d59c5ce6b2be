#include "saphira/bus/gateway.hpp"

#include "harness.hpp"

namespace saphira::bus::test {
namespace {

NodeOptions named(const std::string& name) {
  return node_options(name, robot("gateway"));
}

/// A service on a bus within the process, and a person's program on the DDS bus.
class GatewayTest : public testing::Test {
 protected:
  template <class Condition>
  bool carried(Condition&& condition) {
    return eventually(person_, [&] {
      gateway_.carry();
      return condition();
    });
  }

  std::shared_ptr<MemoryBus> memory_ = make_memory_bus();
  Node service_{named("service"), memory_};
  Writer<v1::RobotState> states_{service_.writer(topics::kRobotState)};
  Writer<v1::BeliefSet> beliefs_{service_.writer(topics::kBeliefs)};
  Writer<v1::Goal> own_goals_{service_.writer(topics::kGoals)};
  Reader<v1::Goal> goals_{service_.reader(topics::kGoals)};
  Reader<v1::RobotState> own_states_{service_.reader(topics::kRobotState)};
  Node outside_{named("gateway")};
  Gateway gateway_{outside_, memory_};
  Node person_{named("person")};
};

TEST_F(GatewayTest, WhatIsWrittenInsideIsReadOutside) {
  Reader<v1::RobotState> states(person_.reader(topics::kRobotState));
  std::uint64_t cycle = 0;
  std::optional<v1::RobotState> seen;
  EXPECT_TRUE(carried([&] {
    states_.write(robot_state(1, ++cycle));
    seen = states.take_newest();
    return seen.has_value();
  }));
  EXPECT_EQ(seen->stamp.epoch, 1U);
}

TEST_F(GatewayTest, WhatIsKeptIsThereForWhoComesLate) {
  beliefs_.write({.stamp = {.cycle = 5}});
  gateway_.carry();
  Reader<v1::BeliefSet> beliefs(person_.reader(topics::kBeliefs));
  EXPECT_TRUE(carried([&] {
    const auto seen = beliefs.take_newest();
    return seen && seen->stamp.cycle == 5;
  }));
}

TEST_F(GatewayTest, GoalsComeInOnceAndGoWithTheirWriter) {
  std::vector<Sample<v1::Goal>> heard;
  const auto hear = [&] {
    for (auto& sample : goals_.take())
      heard.push_back(std::move(sample));
  };
  {
    Node asker(named("asker"));
    Writer<v1::Goal> goals(asker.writer(topics::kGoals));
    ASSERT_TRUE(carried([&] { return goals.matched() > 0; }));
    goals.write(goal(3));
    EXPECT_TRUE(carried([&] {
      hear();
      return !heard.empty();
    }));
    ASSERT_EQ(heard.size(), 1U);
    EXPECT_EQ(heard[0].data.id.number, 3U);
    goals.dispose(goal(3));
    EXPECT_TRUE(carried([&] {
      hear();
      return heard.size() == 2;
    }));
    EXPECT_TRUE(heard.back().info.disposed);
    EXPECT_EQ(heard.back().info.writer, heard.front().info.writer);
  }
  EXPECT_TRUE(carried([&] {
    const auto lost = goals_.take_lost();
    return !lost.empty() && lost[0] == heard.front().info.writer;
  }));
}

// It goes out, and is not taken for another program's when it is heard there.
TEST_F(GatewayTest, WhatIsAskedInsideIsNotHeardTwice) {
  Reader<v1::Goal> goals(person_.reader(topics::kGoals));
  ASSERT_TRUE(carried([&] { return goals.matched() > 0; }));
  own_goals_.write(goal(4));
  EXPECT_TRUE(carried([&] { return !goals.take().empty(); }));
  for (int i = 0; i < 5; ++i) {
    outside_.wait(milliseconds(20));
    gateway_.carry();
  }
  EXPECT_EQ(goals_.take().size(), 1U);
}

// RobotState has a single source in each cycle.
TEST_F(GatewayTest, StatesOfOthersDoNotComeIn) {
  Writer<v1::RobotState> states(person_.writer(topics::kRobotState));
  for (int i = 0; i < 5; ++i) {
    states.write(robot_state(9, 9));
    person_.wait(milliseconds(20));
    gateway_.carry();
  }
  EXPECT_TRUE(own_states_.take().empty());
}

}  // namespace
}  // namespace saphira::bus::test
