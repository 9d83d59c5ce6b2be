// A robot's bus is recorded, and played on another one. Both are in memory.
#include "recorder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "live.hpp"
#include "node_options.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/authority.hpp"

namespace saphira::recorder {
namespace {

v1::RobotState state(std::uint64_t cycle) {
  return {.stamp = {7, cycle},
          .velocity = 0.1 * static_cast<double>(cycle),
          .battery = std::numeric_limits<double>::quiet_NaN()};
}

v1::Drawing drawing(std::uint64_t number) {
  return {.instance = 5, .number = number};
}

class Recorded : public testing::Test {
 protected:
  /// A refused goal, three states, two drawings of which one is withdrawn, and a command.
  void record(const std::vector<std::string>& only = {}) {
    bus::Node node(test::memory_options("robot"), bus::make_memory_bus());
    auto states = node.writer(bus::topics::kRobotState);
    auto drawings = node.writer(bus::topics::kDrawings);
    auto commands = node.writer(bus::topics::kDriveDirect);
    auto goals = node.writer(bus::topics::kGoalStatus);
    v1::GoalStatus refused{.code = v1::CODE_NO_ROBOT};
    goals.write(refused);
    Writer writer(file_);
    Recorder recorder(node, writer, recorded_topics(only));
    EXPECT_TRUE(recorder.refused().empty());
    for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) {
      states.write(state(cycle));
      if (cycle == 1) {
        drawings.write(drawing(1));
        drawings.write(drawing(2));
        commands.write({});
      } else if (cycle == 2) {
        drawings.dispose(drawing(2));
      }
      recorder.poll(static_cast<std::int64_t>(cycle) * 100'000'000);
    }
    EXPECT_TRUE(recorder.has_heard());
    EXPECT_TRUE(writer.close());
  }
  Contents contents() const {
    std::istringstream in(file_.str());
    return contents_of(in);
  }

  std::ostringstream file_;
};

TEST_F(Recorded, IsPlayedAsItWasSaidButNothingDrives) {
  record();
  std::istringstream in(file_.str());
  Reader reader(in);
  bus::Node node(test::memory_options("replay"), bus::make_memory_bus());
  auto states = node.reader(bus::topics::kRobotState);
  auto drawings = node.reader(bus::topics::kDrawings);
  auto commands = node.reader(bus::topics::kDriveDirect);
  auto goals = node.reader(bus::topics::kGoalStatus);
  Player player(node, reader, contents(), {});
  EXPECT_EQ(player.left_out(),
            (std::set<std::string>{"drive/direct", "viewer/pose", "viewer/transforms"}));
  EXPECT_TRUE(player.poll(0.05));
  auto came = states.take();
  ASSERT_EQ(came.size(), 1U);
  EXPECT_EQ(came[0].data.stamp.cycle, 1U);
  EXPECT_TRUE(std::isnan(came[0].data.battery));
  EXPECT_EQ(drawings.take().size(), 2U);
  EXPECT_TRUE(player.poll(0.05));
  const auto changed = drawings.take();
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_TRUE(changed[0].info.disposed);
  EXPECT_EQ(changed[0].data.number, 2U);
  EXPECT_FALSE(player.poll(10.0)) << "the end";
  came = states.take();
  ASSERT_FALSE(came.empty());
  EXPECT_EQ(came.back().data.stamp.cycle, 3U);
  EXPECT_DOUBLE_EQ(came.back().data.velocity, 0.3);
  EXPECT_EQ(player.written(), 7U);
  const auto refused = goals.take();
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0].data.code, v1::CODE_NO_ROBOT) << "a number whose values have names";
  EXPECT_TRUE(commands.take().empty());
}

// With security: the shipped roles, of an observer.
TEST(SecuredBus, TopicsThatTheRoleMayNotReadAreLeftOutAndNamed) {
  const test::TempDir folder;
  const std::string roles = test::source("config/security/roles.yaml");
  bus::NodeOptions options = test::node_options("record", test::unique_robot());
  options.security = security::Authority::make(folder.path("authority"), "office", read_file(roles),
                                               roles, unix_seconds())
                         .add("karen", {"observer"}, "", 365, unix_seconds());
  bus::Node node(options);
  const std::string denied =
      "robot/serial: karen (observer) may not read the topic robot/serial: that is for agent, "
      "operator, recorder, robot, services";

  std::ostringstream file;
  Writer writer(file);
  const Recorder recorder(node, writer, recorded_topics({"robot/state", "robot/serial"}));
  EXPECT_EQ(recorder.refused(), std::vector{denied});

  viewer::Live live(node);
  for (std::size_t channel = 0; channel < live.channels().size(); ++channel) {
    const std::string& topic = live.channels()[channel].topic;
    if (topic == "robot/state" || topic == "robot/serial") {
      EXPECT_EQ(live.subscribe(channel), topic == "robot/serial" ? denied : "");
    }
  }
}

TEST_F(Recorded, SaysWhatItHolds) {
  record();
  const Contents all = contents();
  EXPECT_EQ(all.samples.at("robot/state"), 3U);
  EXPECT_EQ(all.samples.at("drawings"), 3U);
  EXPECT_EQ(all.samples.at("drive/direct"), 1U);
  EXPECT_EQ(all.robot, test::memory_options("robot").robot);
  EXPECT_EQ(all.first_ns, 100'000'000);
  EXPECT_DOUBLE_EQ(all.seconds, 0.2);
  EXPECT_EQ(all.samples.at("viewer/pose"), 3U);
  EXPECT_FALSE(all.cut_off);
}

/// The cycles of the states in a recording whose samples have these times [s].
std::vector<std::uint64_t> played(const std::vector<double>& times, const Player::Options& options,
                                  double seconds, std::vector<double>* steps = nullptr) {
  std::ostringstream file;
  Writer writer(file);
  const auto channel = writer.add_channel({"robot/state", "saphira::v1::RobotState", "r"}, "{}");
  for (std::size_t i = 0; i < times.size(); ++i)
    writer.add({channel, static_cast<std::int64_t>(times[i] * 1e9),
                R"({"stamp":{"epoch":1,"cycle":)" + std::to_string(i + 1) + "}}"});
  EXPECT_TRUE(writer.close());
  std::istringstream in(file.str());
  const Contents contents = contents_of(in);
  std::istringstream again(file.str());
  Reader reader(again);
  bus::Node node(test::memory_options("replay"), bus::make_memory_bus());
  auto states = node.reader(bus::topics::kRobotState);
  Player player(node, reader, contents, options);
  player.poll(seconds);
  if (steps != nullptr)
    for (const Player::Gap& gap : player.take_gaps())
      steps->push_back(gap.step);
  std::vector<std::uint64_t> cycles;
  states.visit([&](const v1::RobotState& each, const bus::SampleInfo&) {
    cycles.push_back(each.stamp.cycle);
  });
  return cycles;
}

TEST(Player, ClockThatStepsDelaysNothing) {
  std::vector<double> steps;
  EXPECT_EQ(played({1.0, 300'000.0, 2.0, 2.1}, {}, 0.35, &steps),
            (std::vector<std::uint64_t>{1, 2, 3, 4}));
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_NEAR(steps[0], 299'999.0, 1e-6);
  EXPECT_NEAR(steps[1], -299'998.0, 1e-6);
}

TEST(Player, BeginsWhereItIsTold) {
  EXPECT_EQ(played({0.0, 1.0, 2.0, 3.0}, {{}, 1.5}, 0.6), std::vector<std::uint64_t>{3});
  EXPECT_EQ(played({0.0, 1.0}, {{"map"}, 0.0}, 5.0), std::vector<std::uint64_t>{});
  EXPECT_EQ(played({0.0, 1.0}, {{}, 1.0}, 5.0), std::vector<std::uint64_t>{2});
  EXPECT_THROW(played({0.0, 1.0}, {{}, 1.1}, 5.0), std::invalid_argument);
}

TEST_F(Recorded, HasTheTopicsThatOneNames) {
  record({"drawings"});
  EXPECT_EQ(contents().samples.size(), 1U);
  EXPECT_THROW(recorded_topics({"robot/stat"}), std::invalid_argument);
  for (const bus::TopicEntry& topic : recorded_topics({}))
    EXPECT_NE(topic.qos, "recall") << topic.name;
}

}  // namespace
}  // namespace saphira::recorder
