// The watcher on a bus in memory. The test writes the programs' samples.
#include <gtest/gtest.h>

#include "node_options.hpp"
#include "saphira/watch/mind.hpp"

namespace saphira::watch {
namespace {

class Watch : public testing::Test {
 protected:
  void program(std::uint64_t instance, const std::string& name, const std::string& reason = {}) {
    statuses.write({.instance = instance,
                    .name = name,
                    .state = reason.empty() ? v1::SERVICE_RUNNING : v1::SERVICE_DEGRADED,
                    .reason = reason});
  }
  /// One cycle of a robot that behaviors drive.
  void cycle(const v1::Stamp& stamp) {
    robots.write({.stamp = stamp, .velocity = 0.2});
    grants.write({.stamp = stamp, .role = v1::ROLE_BEHAVIORS, .source = "behaviors"});
    behaviors.write({.stamp = stamp, .control = true});
    intentions.write({.stamp = stamp});
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node other{test::memory_options("robot"), memory};
  bus::Node node{test::memory_options("watcher"), memory};
  bus::Writer<v1::ServiceStatus> statuses = other.writer(bus::topics::kStatus);
  bus::Writer<v1::RobotState> robots = other.writer(bus::topics::kRobotState);
  bus::Writer<v1::Grant> grants = other.writer(bus::topics::kGrant);
  bus::Writer<v1::BehaviorSet> behaviors = other.writer(bus::topics::kBehaviors);
  bus::Writer<v1::Intentions> intentions = other.writer(bus::topics::kIntentions);
  bus::Writer<v1::Registration> registrations = other.writer(bus::topics::kRegistration);
};

TEST_F(Watch, WhoIsThereNamesThePrograms) {
  Processes processes(node);
  const std::string where = "(robot " + node.options().robot + ", domain 0, profile host)";
  EXPECT_TRUE(who_is_there(processes).starts_with("no program is on the bus " +
                                                  where.substr(0, where.size() - 1)))
      << who_is_there(processes);
  EXPECT_FALSE(processes.heard_any());
  const std::size_t before = processes.news();
  program(1, "bridge");
  program(2, "intentions");
  program(3, "behaviors");
  program(4, "behaviors");
  processes.poll();
  EXPECT_EQ(processes.news(), before + 4);
  EXPECT_EQ(who_is_there(processes), "behaviors, bridge and intentions are on the bus " + where);
  program(3, "behaviors", "runs without perception");
  processes.poll();
  EXPECT_EQ(processes.news(), before + 4) << "it was heard before";
  EXPECT_EQ(who_is_there(processes), "behaviors is degraded: runs without perception");
}

TEST_F(Watch, NewestKeepsOneSample) {
  Newest<v1::RobotState> newest(node, bus::topics::kRobotState);
  EXPECT_FALSE(newest.poll());
  EXPECT_EQ(newest.get(), nullptr);
  robots.write({.stamp = {1, 1}});
  robots.write({.stamp = {1, 2}});
  EXPECT_TRUE(newest.poll());
  EXPECT_FALSE(newest.poll());
  EXPECT_EQ(newest->stamp.cycle, 2U);
  EXPECT_EQ(newest.matched(), 1U);
}

TEST(Pace, IsThatOfTheNewestSeconds) {
  Pace pace;
  pace.note({7, 100}, 2.0);
  pace.note({7, 103}, 2.1);
  EXPECT_DOUBLE_EQ(pace.get(), 0.0) << "too short a time";
  pace.note({7, 130}, 3.0);
  EXPECT_DOUBLE_EQ(pace.get(), 30.0);
  pace.note({7, 500}, 12.5);
  EXPECT_DOUBLE_EQ(pace.get(), 30.0) << "measured anew";
  pace.note({7, 505}, 13.5);
  EXPECT_DOUBLE_EQ(pace.get(), 5.0);
  pace.note({8, 1}, 14.0);
  pace.note({8, 21}, 16.0);
  EXPECT_DOUBLE_EQ(pace.get(), 10.0) << "of another bridge";
}

TEST_F(Watch, TheMindIsThatOfTheNewestWholeCycle) {
  Mind mind(node, false);
  mind.poll();
  EXPECT_EQ(mind.newest_cycle(), 0U);
  const std::size_t before = mind.news();
  for (std::uint64_t n = 1; n <= 5; ++n) {
    cycle({7, n});
    mind.poll();
  }
  robots.write({.stamp = {7, 6}});
  mind.poll();
  EXPECT_EQ(mind.news(), before + 3) << "robot, behaviors and intentions are heard";
  EXPECT_EQ(mind.newest_cycle(), 4U) << "the grant of 5 says what became of the command of 4";
  const situation::Situation now = mind.situation();
  EXPECT_EQ(now.cycle, 4U);
  EXPECT_EQ(now.now, 6U);
  EXPECT_EQ(now.robot.value().stamp.cycle, 4U);
  EXPECT_EQ(now.grant.value().stamp.cycle, 5U);
  EXPECT_EQ(now.behaviors.value().stamp.cycle, 4U);
  EXPECT_EQ(now.intentions.value().stamp.cycle, 3U);
  EXPECT_EQ(now.behaviors_known.newest, 5U);
  EXPECT_EQ(now.behaviors_drove, 5U);
  EXPECT_EQ(mind.known(), (std::pair<std::uint64_t, std::uint64_t>{1, 6}));
}

TEST_F(Watch, ANewEpochEndsThePast) {
  Mind mind(node, false);
  cycle({7, 1});
  cycle({8, 3});
  robots.write({.stamp = {7, 2}});  // of the old bridge
  mind.poll();
  EXPECT_EQ(mind.robot()->stamp, (v1::Stamp{8, 3}));
  EXPECT_EQ(mind.known(), (std::pair<std::uint64_t, std::uint64_t>{3, 3}));
}

// The bridge tells of an emergency stop without a robot, and between two steps of a simulator.
TEST_F(Watch, AGrantWithoutANewCycleCounts) {
  Mind mind(node, false);
  for (const v1::Stamp& lost : {v1::Stamp{}, v1::Stamp{7, 2}}) {
    cycle({7, 1});
    cycle({7, 2});
    grants.write({.stamp = lost});
    mind.poll();
    EXPECT_FALSE(mind.held());
    grants.write({.stamp = lost, .estopped = true});
    mind.poll();
    EXPECT_TRUE(mind.held());
    EXPECT_TRUE(mind.grant()->estopped);
    EXPECT_TRUE(mind.situation().grant.value().estopped) << lost.cycle;
  }
}

TEST_F(Watch, AnEmergencyStopWithoutARobotIsKnown) {
  Mind mind(node, false);
  grants.write({.estopped = true});
  mind.poll();
  EXPECT_TRUE(mind.situation().grant.value().estopped);
}

TEST_F(Watch, ADoubtfulPlaceHasItsBeginning) {
  Mind mind(node, false);
  cycle({7, 10});
  const auto placed = [&](std::uint64_t cycle, double confidence) {
    registrations.write({.stamp = {7, cycle},
                         .state = v1::REGISTRATION_TRACKING,
                         .confidence = static_cast<float>(confidence)});
    mind.poll();
  };
  placed(8, 0.3);
  EXPECT_EQ(mind.situation().doubtful_since, 0U) << "it was so before we came";
  placed(9, 0.9);
  placed(10, 0.3);
  EXPECT_EQ(mind.situation().doubtful_since, 10U);
  placed(11, 0.9);
  EXPECT_EQ(mind.situation().doubtful_since, 0U);
  ASSERT_NE(mind.registration(), nullptr);
}

}  // namespace
}  // namespace saphira::watch
