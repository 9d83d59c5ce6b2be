#include "last_minute.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "node_options.hpp"
#include "recorder.hpp"

namespace saphira::recorder {
namespace {

constexpr std::int64_t kNow = 1'000'000'000'000;

class LastMinuteTest : public testing::Test {
 protected:
  /// The topic, time before now [s] and content of each sample of the recording.
  struct Row {
    std::string topic;
    double before;
    std::string json;
  };
  std::vector<Row> record() {
    LastMinute minute(node);
    minute.poll(kNow);
    std::ostringstream out;
    Writer writer(out);
    is_written = minute.write(node, writer);
    EXPECT_TRUE(writer.close());
    std::istringstream in(out.str());
    Reader reader(in);
    std::vector<Row> rows;
    while (const auto sample = reader.next()) {
      const std::string& topic = reader.channel(sample->channel).topic;
      if (!topic.starts_with("viewer/"))
        rows.push_back({topic, static_cast<double>(kNow - sample->time_ns) / 1e9, sample->json});
    }
    return rows;
  }

  bus::Node node{test::memory_options("robot"), bus::make_memory_bus()};
  bus::Writer<v1::RobotState> states = node.writer(bus::topics::kRecallRobot);
  bus::Writer<v1::RobotState> live = node.writer(bus::topics::kRobotState);
  bus::Writer<v1::GoalStatusSet> goals = node.writer(bus::topics::kRecallGoals);
  bus::Writer<v1::FloorMap> maps = node.writer(bus::topics::kMap);
  bool is_written = false;
};

TEST_F(LastMinuteTest, HasWhatWasKeptUnderItsLiveTopicsAtItsTimes) {
  for (std::uint64_t cycle = 100; cycle <= 102; ++cycle) {
    states.write({.stamp = {7, cycle}});
    live.write({.stamp = {7, cycle}});
  }
  maps.write({.stamp = {7, 3}, .source = "office"});
  v1::GoalStatus goal{.stamp = {7, 101}, .state = v1::GOAL_FAILED};
  goals.write({.stamp = {7, 101}, .goals = {goal}});
  const auto rows = record();
  EXPECT_TRUE(is_written);
  std::string all;
  for (const Row& row : rows)
    all += row.topic + " " + std::to_string(std::lround(row.before * 10)) + "\n";
  EXPECT_EQ(all,
            "map 2\nrobot/state 2\n"
            "robot/state 1\ngoals/status 1\n"
            "robot/state 0\n");
  EXPECT_NE(rows[3].json.find("GOAL_FAILED"), std::string::npos);
}

TEST_F(LastMinuteTest, AnEarlierEpochIsBeforeAll) {
  states.write({.stamp = {6, 9000}});
  states.write({.stamp = {7, 5}});
  states.write({.stamp = {7, 6}});
  const auto rows = record();
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_NE(rows[0].json.find("9000"), std::string::npos);
  EXPECT_DOUBLE_EQ(rows[0].before, 0.1);
  EXPECT_DOUBLE_EQ(rows[2].before, 0.0);
}

TEST_F(LastMinuteTest, WithoutARobotThereIsNone) {
  maps.write({.stamp = {7, 3}});
  record();
  EXPECT_FALSE(is_written);
}

}  // namespace
}  // namespace saphira::recorder
