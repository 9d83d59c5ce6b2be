#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <set>

#include "drive/building.hpp"
#include "drive/drive.hpp"
#include "floors/floor.hpp"
#include "localization/patrol.hpp"
#include "perception/score.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/topology.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::test {
namespace {

class Floors : public testing::TestWithParam<std::uint64_t> {
 protected:
  const Floor floor_ = make_floor(GetParam());
  const sim::World world_ = sim::parse_world(floor_.world, "floor.wld");
  const maps::Map map_ = maps::parse_map(floor_.map, "floor.map");
};

INSTANTIATE_TEST_SUITE_P(Seeds, Floors, testing::Range<std::uint64_t>(1, 41));

TEST_P(Floors, SameSeedMakesTheSameFloor) {
  const Floor again = make_floor(GetParam());
  EXPECT_EQ(floor_.world, again.world);
  EXPECT_EQ(floor_.map, again.map);
  EXPECT_NE(floor_.world, make_floor(GetParam() + 1).world);
}

TEST_P(Floors, TheTourIsFree) {
  ASSERT_GE(floor_.tour.size(), 4U);
  for (std::size_t i = 1; i < floor_.tour.size(); ++i) {
    const Vec2 from = floor_.tour[i - 1];
    const Vec2 to = floor_.tour[i];
    const sim::Segment way{from, to};
    for (const sim::Segment& wall : world_.segments)
      EXPECT_FALSE(sim::intersect(way, wall))
          << from.transpose() << " to " << to.transpose() << " meets " << wall.from.transpose()
          << " to " << wall.to.transpose();
    EXPECT_GT(sim::distance(world_.segments, to), 0.5);
  }
}

TEST_P(Floors, DoorsAreOpenings) {
  int doors = 0;
  int closed = 0;
  const maps::Map open = maps::parse_map(floor_.open_doors, "open.map");
  for (const maps::Feature& door : map_.features) {
    if (door.type != lps::PointType::door)
      continue;
    ++doors;
    // From the corridor into the room.
    const sim::Segment way{transform(door.pose_in_map, {0.5, 0.0}),
                           transform(door.pose_in_map, {-0.7, 0.0})};
    const bool blocked =
        std::any_of(world_.segments.begin(), world_.segments.end(),
                    [&](const sim::Segment& wall) { return sim::intersect(way, wall); });
    const bool is_open = maps::find(open, door.id) != nullptr;
    EXPECT_NE(is_open, blocked) << maps::describe(door);
    closed += is_open ? 0 : 1;
    // Beside it there is a wall.
    for (const double side : {-1.0, 1.0}) {
      const Vec2 beside = transform(door.pose_in_map, {0.0, side * (door.width / 2 + 0.1)});
      EXPECT_LT(sim::distance(world_.segments, beside), 0.12) << maps::describe(door);
    }
  }
  EXPECT_GE(doors, 3);
  EXPECT_LT(closed, doors);
  for (const maps::Feature& door :
       maps::parse_map(floor_.recessed_doors, "recessed.map").features) {
    EXPECT_NE(maps::find(map_, door.id), nullptr);
    if (maps::find(open, door.id) != nullptr)
      continue;
    // Flat, and at that depth.
    const double back = sim::distance(world_.segments, transform(door.pose_in_map, Vec2(0.0, 0.0)));
    EXPECT_GT(back, 0.149) << maps::describe(door);
    EXPECT_LT(back, 0.351) << maps::describe(door);
  }
}

TEST_P(Floors, TheMapHangsTogether) {
  const maps::Topology topology(map_);
  const auto start = topology.region_at(floor_.tour.front());
  ASSERT_TRUE(start);
  std::set<std::size_t> reached{*start};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const maps::Link& link : topology.links())
      if (link.b && (reached.contains(link.a) || reached.contains(*link.b)))
        reached.insert({link.a, *link.b});
  }
  for (std::size_t i = 0; i < topology.regions().size(); ++i)
    EXPECT_TRUE(reached.contains(i)) << topology.text(i);
}

TEST_P(Floors, NobodyGetsOut) {
  // At every point of the tour, a ray meets a wall.
  for (const Vec2& at : floor_.tour)
    for (int i = 0; i < 720; ++i) {
      const Vec2 direction = transform(Pose{0.0, 0.0, i * kPi / 360}, {1.0, 0.0});
      EXPECT_TRUE(sim::cast_ray(world_.segments, at, direction, 60.0).has_value())
          << at.transpose() << " along " << direction.transpose();
    }
}

/// The doors that stand back from the corridor's wall, open and closed, on floors that the robot
/// was not tuned on.
TEST(RecessedDoors, AreNoticedInPassingAndMatched) {
  int passed = 0;
  int found = 0;
  int reported = 0;
  int real = 0;
  std::size_t on_map = 0;
  std::size_t all_matched = 0;
  for (std::uint64_t seed = 3001; seed < 3007; ++seed) {
    const Floor floor = make_floor(seed);
    const maps::Map map = maps::parse_map(floor.map, "floor.map");
    DriveOptions options;
    options.made_world = std::make_shared<sim::World>(sim::parse_world(floor.world, "floor.wld"));
    options.seed = seed;
    Drive robot(registered_on(map, options));
    const maps::Map standing_back = maps::parse_map(floor.recessed_doors, "recessed.map");
    std::set<std::uint32_t> matched;
    Score recessed(robot, standing_back);
    Score any(robot, map);
    Tour tour(floor.tour, true);
    for (int cycle = 0; cycle < 6000; ++cycle) {
      tour.act(robot, robot.truth());
      robot.advance();
      recessed.look(robot);
      any.look(robot);
      for (const v1::Match& match : robot.registered().matches)
        if (match.accepted && maps::find(standing_back, match.artifact) != nullptr)
          matched.insert(match.artifact);
    }
    on_map += standing_back.features.size();
    all_matched += matched.size();
    passed += recessed.doors_passed();
    found += recessed.doors_found();
    reported += any.doors().reported;
    real += any.doors().real;
  }
  EXPECT_GE(passed, 6);
  EXPECT_GE(found, 0.9 * passed);
  EXPECT_LE(reported - real, 6) << reported;  // one false door a floor, on average
  // On the map, most of them identify the robot's place.
  EXPECT_GE(5 * all_matched, 4 * on_map) << all_matched;
}

// A wing that stands aslant turns the robot away from the way that it heard (C4), or into the
// direction of its walls (C2, of whose mouth it hears one post).
TEST(Building, WingsThatStandAslantAreFollowedToTheirEnds) {
  const Floor floor = make_floor(9101);
  DriveOptions options;
  options.made_world = std::make_shared<sim::World>(sim::parse_world(floor.world, "floor.wld"));
  options.seed = 9101;
  Building building(options);
  building.run(15000);
  EXPECT_TRUE(building.done()) << building.reason();
  const maps::Map map = building.aligned_map();
  const maps::Map drawn = maps::parse_map(floor.map, "floor.map");
  for (const std::string name : {"C2", "C4"}) {
    const auto wing = std::find_if(drawn.features.begin(), drawn.features.end(),
                                   [&](const maps::Feature& f) { return f.name == name; });
    ASSERT_NE(wing, drawn.features.end());
    EXPECT_TRUE(std::any_of(map.features.begin(), map.features.end(),
                            [&](const maps::Feature& f) {
                              return f.type == lps::PointType::corridor &&
                                     maps::distance_to(f, wing->pose_in_map.position()) == 0.0 &&
                                     f.length > 0.9 * wing->length;
                            }))
        << name << maps::to_text(map);
  }
  EXPECT_EQ(building.whole.drive().contacts(), 0);
}

}  // namespace
}  // namespace saphira::test
