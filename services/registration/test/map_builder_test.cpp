#include "saphira/registration/map_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saphira/base/random.hpp"

namespace saphira::registration {
namespace {

using lps::Percept;
using lps::PointType;
using lps::Side;

/// A robot that drives along a way, with dead reckoning that turns a little too far. A test gives
/// the visible objects.
class Driven {
 public:
  explicit Driven(MapBuilderSettings settings = {}, maps::Map known = {}, Pose start = {})
      : builder(std::move(settings), std::move(known), start), pose(start) {}

  /// Straight on [m], seeing these things of the map while they are beside the robot.
  void drive(double way, double drift = 0.0) {
    const int cycles = static_cast<int>(std::round(way / 0.03));
    for (int i = 0; i < cycles; ++i)
      move({0.03, 0.0, 0.0}, {0.03, 0.0, 0.03 * drift});
  }
  void turn(double angle) {
    for (int i = 0; i < 30; ++i)
      move({0.0, 0.0, angle / 30}, {0.0, 0.0, angle / 30});
  }

  /// A wall between two points of the map; visible within 2.5 m of the robot, up to 4 m back.
  struct Wall {
    Vec2 from;
    Vec2 to;
  };
  std::vector<Wall> walls;
  std::vector<maps::Feature> doors;
  bool believe = false;  ///< hand over the true pose, as registration would

  MapBuilder builder;
  Pose pose;     ///< in the map
  Pose in_odom;  ///< by dead reckoning

 private:
  void move(const Pose& step, const Pose& counted) {
    pose = compose(pose, step);
    in_odom = compose(in_odom, counted);
    ++cycle;
    std::vector<Percept> percepts;
    const auto put = [&](Percept percept, const Pose& in_map, std::uint32_t id) {
      percept.id = id;
      percept.pose_in_odom = compose(in_odom, relative(pose, in_map));
      percept.sigma_along = percept.sigma_across = 0.03;
      percept.sigma_heading = radians(1.0);
      percept.confidence = 0.9;
      percept.since = percept.seen = cycle;
      percepts.push_back(percept);
    };
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const Vec2 along = (walls[i].to - walls[i].from).normalized();
      const double heading = std::atan2(along.y(), along.x());
      const Pose frame{walls[i].from.x(), walls[i].from.y(), heading};
      const Pose in = relative(frame, pose);
      const double from = std::max(0.0, in.x - 4.0);
      const double to = std::min((walls[i].to - walls[i].from).norm(), in.x);
      if (std::abs(in.y) > 2.5 || to - from < 0.7 || std::abs(norm3_angle(in.th)) > radians(20.0)) {
        wall_ids.erase(i);
        continue;
      }
      if (!wall_ids.contains(i))
        wall_ids[i] = ++last_id;
      Percept percept;
      percept.type = PointType::wall;
      percept.length = to - from;
      const bool forth = std::abs(in.th) < kPi / 2;
      percept.side = (in.y < 0.0) == forth ? Side::left : Side::right;
      const Vec2 middle = transform(frame, {(from + to) / 2, 0.0});
      put(percept, {middle.x(), middle.y(), norm2_angle(heading + (forth ? 0.0 : kPi))},
          wall_ids[i]);
    }
    for (std::size_t i = 0; i < doors.size(); ++i) {
      const Pose in = relative(doors[i].pose_in_map, pose);
      const bool beside = in.x > 0.0 && in.x < 2.5 && std::abs(in.y) < 2.5;
      if (!beside) {
        door_ids.erase(i);
        continue;
      }
      if (!door_ids.contains(i) && std::abs(in.y) > 1.0)
        continue;
      if (!door_ids.contains(i))
        door_ids[i] = ++last_id;
      Percept percept;
      percept.type = PointType::door;
      percept.width = doors[i].width;
      put(percept, doors[i].pose_in_map, door_ids[i]);
    }
    builder.step({cycle, 1, in_odom, percepts, {}, believe ? std::optional(pose) : std::nullopt});
  }

  std::uint64_t cycle = 0;
  std::uint32_t last_id = 0;
  std::map<std::size_t, std::uint32_t> wall_ids;
  std::map<std::size_t, std::uint32_t> door_ids;
};

std::vector<maps::Feature> of_type(const maps::Map& map, PointType type) {
  std::vector<maps::Feature> out;
  for (const maps::Feature& f : map.features)
    if (f.type == type)
      out.push_back(f);
  return out;
}

maps::Feature door(double x, double y, double th) {
  return {PointType::door, 0, {x, y, th}, 0.0, 0.9, ""};
}

TEST(MapBuilder, TwoWallsAreACorridorAndAnOpeningInOneIsADoor) {
  Driven d;
  d.walls = {{{0.0, 1.0}, {4.0, 1.0}}, {{4.9, 1.0}, {12.0, 1.0}}, {{0.0, -1.0}, {12.0, -1.0}}};
  d.doors = {door(4.45, 1.0, -kPi / 2)};
  d.drive(12.0);
  d.turn(kPi);
  d.drive(3.0);
  const auto corridors = of_type(d.builder.map(), PointType::corridor);
  ASSERT_EQ(corridors.size(), 1U) << maps::to_text(d.builder.map());
  EXPECT_NEAR(corridors[0].length, 12.0, 0.3);
  EXPECT_NEAR(corridors[0].width, 2.0, 0.02);
  EXPECT_NEAR(corridors[0].pose_in_map.y, 0.0, 0.02);
  const auto doors = of_type(d.builder.map(), PointType::door);
  ASSERT_EQ(doors.size(), 1U);
  EXPECT_NEAR(doors[0].pose_in_map.x, 4.45, 0.05);
  EXPECT_NEAR(doors[0].pose_in_map.y, 1.0, 0.02);
  EXPECT_NEAR(doors[0].pose_in_map.th, -kPi / 2, 0.02);
  EXPECT_TRUE(of_type(d.builder.map(), PointType::wall).empty()) << "they are the corridor's";
}

TEST(MapBuilder, WhatIsSeenAgainStaysWhatItWasWithItsId) {
  Driven d;
  d.walls = {{{0.0, 1.0}, {4.0, 1.0}}, {{4.9, 1.0}, {12.0, 1.0}}, {{0.0, -1.0}, {12.0, -1.0}}};
  d.doors = {door(4.45, 1.0, -kPi / 2)};
  d.drive(12.0);
  const maps::Map before = d.builder.map();
  d.turn(kPi);
  d.drive(11.0);
  d.turn(kPi);
  d.drive(11.0);
  const maps::Map& after = d.builder.map();
  ASSERT_EQ(after.features.size(), before.features.size()) << maps::to_text(after);
  for (const maps::Feature& f : before.features) {
    const maps::Feature* again = maps::find(after, f.id);
    ASSERT_NE(again, nullptr) << f.id;
    EXPECT_EQ(again->type, f.type);
  }
  EXPECT_TRUE(d.builder.closed().empty());
}

TEST(MapBuilder, TheRightAngleGridHoldsTheHeading) {
  // Dead reckoning turns by one degree a metre: 12 degrees in all.
  for (const bool snap : {true, false}) {
    MapBuilderSettings settings;
    settings.snap_to_right_angle_grid = snap;
    Driven d(settings);
    d.walls = {{{0.0, 1.0}, {12.0, 1.0}}, {{0.0, -1.0}, {12.0, -1.0}}};
    d.drive(12.0, radians(1.0));
    const auto corridors = of_type(d.builder.map(), PointType::corridor);
    ASSERT_EQ(corridors.size(), 1U) << maps::to_text(d.builder.map());
    EXPECT_LT(std::abs(norm3_angle(corridors[0].pose_in_map.th)), radians(snap ? 0.5 : 6.0));
    EXPECT_LT((d.builder.pose_in_map().position() - d.pose.position()).norm(), snap ? 0.15 : 1.3);
  }
}

TEST(MapBuilder, ADoorThatIsClosedLaterIsMarkedAndStays) {
  Driven d;
  d.walls = {{{0.0, 1.0}, {4.0, 1.0}}, {{4.9, 1.0}, {12.0, 1.0}}, {{0.0, -1.0}, {12.0, -1.0}}};
  d.doors = {door(4.45, 1.0, -kPi / 2)};
  d.drive(12.0);
  const auto id = of_type(d.builder.map(), PointType::door).at(0).id;
  d.doors.clear();
  d.turn(kPi);
  d.drive(11.5);
  EXPECT_TRUE(d.builder.closed().empty()) << "once may be an error";
  d.turn(kPi);
  d.drive(11.5);
  EXPECT_EQ(d.builder.closed(), std::vector<std::uint32_t>{id});
  EXPECT_EQ(of_type(d.builder.map(), PointType::door).size(), 1U);
  d.doors = {door(4.45, 1.0, -kPi / 2)};
  d.turn(kPi);
  d.drive(11.5);
  EXPECT_TRUE(d.builder.closed().empty()) << "open again";
}

TEST(MapBuilder, OnAKnownMapOnlyWhatIsNewIsAdded) {
  const maps::Map known = maps::parse_map(
      "CORRIDOR (1) 6000, 0, 0, 12000, 2000\nDOOR (2) 4450, 1000, -90, 900 \"EJ-231\"\n", "known");
  Driven d({}, known, {0.0, 0.0, 0.0});
  d.believe = true;
  d.walls = {{{0.0, 1.0}, {4.0, 1.0}}, {{4.9, 1.0}, {12.0, 1.0}}, {{0.0, -1.0}, {12.0, -1.0}}};
  d.doors = {door(4.45, 1.0, -kPi / 2), door(8.0, -1.0, kPi / 2)};
  d.drive(12.0, radians(0.3));
  const maps::Map& map = d.builder.map();
  ASSERT_EQ(map.features.size(), 3U) << maps::to_text(map);
  EXPECT_EQ(map.features[0], known.features[0]);
  EXPECT_EQ(map.features[1], known.features[1]);
  EXPECT_EQ(map.features[2].type, PointType::door);
  EXPECT_NEAR(map.features[2].pose_in_map.x, 8.0, 0.1);
  EXPECT_GT(map.features[2].id, 2U);
}

TEST(MapBuilder, WhatIsTakenFromTheMapComesBackWhenItIsSeenAgainAndThingsStay) {
  Driven d;
  d.walls = {{{0.0, 1.0}, {10.0, 1.0}}};
  d.doors = {door(11.0, 1.0, -kPi / 2)};
  d.drive(12.0);
  const auto walls = of_type(d.builder.map(), PointType::wall);
  const auto doors = of_type(d.builder.map(), PointType::breach).empty()
                         ? of_type(d.builder.map(), PointType::door)
                         : of_type(d.builder.map(), PointType::breach);
  ASSERT_EQ(walls.size(), 1U) << maps::to_text(d.builder.map());
  ASSERT_EQ(doors.size(), 1U);
  EXPECT_TRUE(walls[0].learned);
  EXPECT_TRUE(doors[0].learned);
  maps::Feature box;
  box.type = PointType::object;
  box.pose_in_map = {20.0, 0.8, 0.0};
  box.length = box.width = 0.4;
  const std::uint32_t thing = d.builder.put(box);
  const auto all = d.walls;
  d.walls.clear();
  d.doors.clear();
  EXPECT_TRUE(d.builder.remove(walls[0].id));
  EXPECT_TRUE(d.builder.remove(doors[0].id));
  EXPECT_FALSE(d.builder.remove(walls[0].id));
  // Percepts from another place: the map is rebuilt without them.
  d.walls = {{{14.0, 1.0}, {24.0, 1.0}}};
  d.drive(12.0);
  EXPECT_EQ(of_type(d.builder.map(), PointType::wall).size(), 1U);
  EXPECT_TRUE(of_type(d.builder.map(), doors[0].type).empty());
  EXPECT_NE(maps::find(d.builder.map(), thing), nullptr);
  d.walls = all;
  d.turn(kPi);
  d.drive(23.0);
  const auto again = of_type(d.builder.map(), PointType::wall);
  ASSERT_EQ(again.size(), 2U) << maps::to_text(d.builder.map());
  EXPECT_EQ(maps::find(d.builder.map(), walls[0].id), nullptr) << "an id is not given again";
}

TEST(MapBuilder, AnIdThatTheKnownMapGaveOnceIsNotGivenAgain) {
  maps::Feature box;
  box.type = PointType::object;
  box.length = box.width = 0.4;
  maps::Editor known;
  const std::uint32_t id = known.put(box);
  known.remove(id);
  MapBuilder builder({}, known.map());
  builder.take_ids(known);
  EXPECT_NE(builder.put(box), id);
}

TEST(FeatureGraph, ALoopThatClosesCorrectsTheWholeWay) {
  // Round a square of 10 m with a drifting heading; the first wall is seen again at the end.
  FeatureGraph graph;
  graph.settings.start_heading = 0.001;
  graph.lines.push_back({{5.0, 1.0}, kPi, 0.0, {}, true});
  Pose truth;
  Pose odom;
  const auto node = [&] { graph.nodes.push_back({odom, odom, false, false}); };
  const auto see = [&] {
    SeenLine seen{.node = graph.nodes.size() - 1, .in_node = relative(truth, {5.0, 1.0, kPi})};
    graph.lines[0].seen.push_back(seen);
  };
  node();
  see();
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < 20; ++i) {
      truth = compose(truth, {0.5, 0.0, 0.0});
      odom = compose(odom, {0.5, 0.0, 0.004});
      node();
    }
    truth = compose(truth, {0.0, 0.0, kPi / 2});
    odom = compose(odom, {0.0, 0.0, kPi / 2});
    node();
  }
  see();
  const double before = (odom.position() - truth.position()).norm();
  graph.optimize(10);
  const Pose& end = graph.nodes.back().in_map;
  EXPECT_GT(before, 0.8);
  EXPECT_LT(std::abs(end.y - truth.y), 0.1) << "a wall says nothing along itself";
  EXPECT_LT(std::abs(norm2_angle(end.th - truth.th)), radians(1.5));
  EXPECT_NEAR(graph.drift, 0.008, 0.003) << "[rad/m] of dead reckoning";
  EXPECT_GT(graph.covariance(2, 2), 0.0);
}

}  // namespace
}  // namespace saphira::registration
