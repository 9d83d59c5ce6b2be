#include "saphira/console/board.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>

#include "lines.hpp"

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

/// The cases of board.txt: `topic NAME [MOST]`, `put TOPIC KEY JSON [OWNER]`, `withdraw TOPIC KEY`,
/// `lose TOPIC OWNER`, `at SECONDS`, `acknowledge FRAME`; "news" are the items of a viewer's next
/// frame, which it acknowledges, and "frame" says if there is one, which it does not.
class Told : public test::LinePlayer {
 public:
  Told() {
    events_ = {
        {"topic",
         [this](auto& in) {
           const auto name = read<std::string>(in);
           std::size_t most = 1;
           in >> most;
           topics_[name] = board_.topic(name, most);
         }},
        {"put",
         [this](auto& in) {
           const int topic = topics_.at(read<std::string>(in));
           const auto key = read<std::string>(in);
           const auto json = read<std::string>(in);
           std::string owner;
           in >> owner;
           board_.put(topic, key, json, now_, owner);
         }},
        {"withdraw",
         [this](auto& in) {
           const int topic = topics_.at(read<std::string>(in));
           board_.withdraw(topic, rest(in));
         }},
        {"lose",
         [this](auto& in) {
           const int topic = topics_.at(read<std::string>(in));
           board_.lose(topic, rest(in));
         }},
        {"at", [this](auto& in) { now_ = read<double>(in); }},
        {"acknowledge", [this](auto& in) { Board::seen(viewer_, read<std::uint64_t>(in), now_); }}};
    facts_ = {{"news",
               [this] {
                 const Json json = console::read(board_, viewer_, now_);
                 return json.is_null() ? "none" : json.at("items").dump();
               }},
              {"frame", [this] { return yes(board_.frame(viewer_, now_).has_value()); }},
              {"size", [this] { return std::to_string(board_.size()); }}};
  }

 private:
  Board board_;
  Viewer viewer_;
  std::map<std::string, int> topics_;
  double now_ = 0.0;
};

TEST(Board, IsAsWritten) {
  EXPECT_EQ(test::play<Told>("agents/console/test/board.txt"), 6);
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

TEST(Board, TextsAreQuoted) {
  EXPECT_EQ(Json::parse(quoted("a \"b\" \\ \n\x01")).get<std::string>(), "a \"b\" \\ \n\x01");
}

}  // namespace
}  // namespace saphira::console
