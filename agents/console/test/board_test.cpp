#include "saphira/console/board.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>

namespace saphira::console {
namespace {

using Json = nlohmann::json;

/// The content of the next frame, acknowledged at once; null without one.
Json read(const Board& board, Viewer& viewer, double now) {
  const auto frame = board.frame(viewer, now);
  if (!frame)
    return {};
  Json json = Json::parse(*frame);
  Board::seen(viewer, json.at("seq").get<std::uint64_t>(), now);
  return json;
}

TEST(Board, ANewViewerGetsAllAndThenWhatChanged) {
  Board board;
  const int robot = board.topic("robot/state");
  const int map = board.topic("map");
  board.put(map, "", R"({"doors":2})", 1.0);
  board.put(robot, "", R"({"x":1})", 2.0);
  Viewer viewer;
  const Json all = read(board, viewer, 2.5);
  ASSERT_EQ(all.at("items").size(), 2U);
  // In the order of the topics, with their age.
  EXPECT_EQ(all["items"][0], Json::parse(R"({"t":"robot/state","k":"","a":500,"d":{"x":1}})"));
  EXPECT_EQ(all["items"][1]["a"], 1500);
  EXPECT_TRUE(read(board, viewer, 2.6).is_null());
  board.put(robot, "", R"({"x":2})", 2.7);
  const Json news = read(board, viewer, 2.7);
  ASSERT_EQ(news.at("items").size(), 1U);
  EXPECT_EQ(news["items"][0]["d"]["x"], 2);
}

TEST(Board, ItsItemsAreToldWhateverAViewerHas) {
  Board board;
  const int robot = board.topic("robot/state");
  const int map = board.topic("map");
  const int grant = board.topic("drive/grant");
  board.put(map, "", R"({"doors":2})", 1.0);
  board.put(robot, "", R"({"x":1})", 2.0);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(
        Json::parse("{" + board.members({robot, grant}, 2.5) + "}"),
        Json::parse(R"({"now":2.5,"items":[{"t":"robot/state","k":"","a":500,"d":{"x":1}}]})"));
}

TEST(Board, ASlowViewerGetsTheNewestAndNothingQueuesUp) {
  Board board;
  const int robot = board.topic("robot/state");
  Viewer slow;
  Viewer quick;
  int frames = 0;
  for (int i = 0; i < 100; ++i) {
    board.put(robot, "", std::to_string(i), 0.1 * i);
    frames += board.frame(slow, 0.1 * i).has_value() ? 1 : 0;
    EXPECT_EQ(read(board, quick, 0.1 * i).at("items")[0]["d"], i);
  }
  EXPECT_EQ(frames, 2);  // on their way, until the viewer acknowledges them
  Board::seen(slow, 2, 10.0);
  EXPECT_EQ(read(board, slow, 10.0).at("items")[0]["d"], 99);
}

/// A link on which a frame needs `transfer` seconds, one after the other, and its acknowledgement
/// comes `trip` seconds later. The robot and its percepts change ten times a second for 20 s.
struct Carried {
  Carried(double transfer, double trip) {
    Board board;
    const int robot = board.topic("robot/state");
    board.urgent_so_far();
    const int percepts = board.topic("perception");
    Viewer viewer;
    std::deque<std::pair<double, std::uint64_t>> answers;
    double free = 0.0;
    for (int cycle = 0; cycle < 200; ++cycle) {
      const double now = 0.1 * cycle;
      for (; !answers.empty() && answers.front().first <= now; answers.pop_front())
        Board::seen(viewer, answers.front().second, now);
      board.put(robot, "", std::to_string(cycle), now);
      board.put(percepts, "", std::to_string(cycle), now);
      most = std::max(most, viewer.under_way.size());
      const auto frame = board.frame(viewer, now);
      if (!frame)
        continue;
      const Json json = Json::parse(*frame);
      free = std::max(free, now) + transfer;
      answers.emplace_back(free + trip, json.at("seq").get<std::uint64_t>());
      robots += 1;
      wholes += json["items"].size() > 1 ? 1 : 0;
    }
  }
  int robots = 0;
  int wholes = 0;
  std::size_t most = 0;  ///< frames under way
};

TEST(Board, OverALongDelayTheUrgentTopicsComeEachCycle) {
  const Carried far(0.0, 0.95);
  EXPECT_EQ(far.robots, 200);
  EXPECT_LE(far.wholes, 40 + 2);
  EXPECT_GE(far.wholes, 30);
}

TEST(Board, OnAFullLinkNothingIsAddedToTheWholeFrames) {
  const Carried thin(0.5, 0.1);
  EXPECT_LE(thin.robots, 40 + 12);  // two a second, and those before the delay was known
  EXPECT_LE(thin.most, 12U);
  EXPECT_GE(thin.wholes, 25);
}

TEST(Board, WhatIsSeenBeforeItWasSentCountsForNothing) {
  Board board;
  const int robot = board.topic("robot/state");
  Viewer viewer;
  Board::seen(viewer, 1'000'000, 0.0);
  int frames = 0;
  for (int i = 0; i < 10; ++i) {
    board.put(robot, "", std::to_string(i), i);
    frames += board.frame(viewer, i).has_value() ? 1 : 0;
  }
  EXPECT_EQ(frames, 2);
}

TEST(Board, AWithdrawnItemIsToldOnce) {
  Board board;
  const int goals = board.topic("goals", 10);
  board.put(goals, "a", "1", 0.0);
  board.put(goals, "b", "2", 0.0);
  Viewer viewer;
  EXPECT_EQ(read(board, viewer, 0.0).at("items").size(), 2U);
  board.withdraw(goals, "a");
  board.withdraw(goals, "never there");
  const Json news = read(board, viewer, 0.1);
  ASSERT_EQ(news.at("items").size(), 1U);
  EXPECT_EQ(news["items"][0]["k"], "a");
  EXPECT_TRUE(news["items"][0]["d"].is_null());
  EXPECT_TRUE(read(board, viewer, 0.2).is_null());
}

TEST(Board, TheItemsOfALostOwnerAreWithdrawn) {
  Board board;
  const int tasks = board.topic("system/processes", 10);
  const int goals = board.topic("goals", 10);
  board.put(tasks, "a", "1", 0.0, "one");
  board.put(tasks, "b", "2", 0.0, "one");
  board.put(tasks, "c", "3", 0.0, "two");
  board.put(goals, "a", "4", 0.0, "one");
  Viewer viewer;
  read(board, viewer, 0.0);
  board.lose(tasks, "one");
  EXPECT_EQ(board.size(), 2U);
  const Json gone = read(board, viewer, 1.0);
  ASSERT_EQ(gone.at("items").size(), 2U);
  EXPECT_TRUE(gone["items"][0]["d"].is_null());
  EXPECT_TRUE(gone["items"][1]["d"].is_null());
}

TEST(Board, OfManyItemsTheNewestAreKept) {
  Board board;
  const int log = board.topic("log", 3);
  const int other = board.topic("other");
  board.put(other, "", "0", 0.0);
  for (int i = 0; i < 10; ++i)
    board.put(log, "line " + std::to_string(i), std::to_string(i), 0.0);
  EXPECT_EQ(board.size(), 4U);
  Viewer viewer;
  const Json all = read(board, viewer, 0.0);
  EXPECT_EQ(all.at("items")[0]["d"], 7);
  EXPECT_EQ(all.at("items")[2]["d"], 9);
}

TEST(Board, ALargeBoardComesInPartsWithTheFirstTopicsFirst) {
  Board board({.frame_bytes = 1000});
  const int robot = board.topic("robot/state");
  const int grid = board.topic("grid", 100);
  const std::string tile = '"' + std::string(300, 'x') + '"';
  for (int i = 0; i < 20; ++i)
    board.put(grid, std::to_string(i), tile, 0.0);
  Viewer viewer;
  std::size_t tiles = 0;
  int frames = 0;
  while (tiles < 20 && frames < 100) {
    board.put(robot, "", std::to_string(frames), 0.1 * frames);
    const auto frame = board.frame(viewer, 0.1 * frames);
    ASSERT_TRUE(frame);
    EXPECT_LT(frame->size(), 2000U);
    const Json json = Json::parse(*frame);
    EXPECT_EQ(json["items"][0]["d"], frames);  // the robot is in each
    tiles += json["items"].size() - 1;
    Board::seen(viewer, json["seq"].get<std::uint64_t>(), 0.1 * frames);
    ++frames;
  }
  EXPECT_EQ(tiles, 20U);
  EXPECT_GT(frames, 5);
}

TEST(Board, SilenceIsTold) {
  const Board board;
  Viewer viewer;
  EXPECT_FALSE(read(board, viewer, 0.0).is_null());
  EXPECT_TRUE(read(board, viewer, 0.4).is_null());
  EXPECT_TRUE(read(board, viewer, 0.6).at("items").empty());
}

TEST(Board, TextsAreQuoted) {
  EXPECT_EQ(Json::parse(quoted("a \"b\" \\ \n\x01")).get<std::string>(), "a \"b\" \\ \n\x01");
}

}  // namespace
}  // namespace saphira::console
