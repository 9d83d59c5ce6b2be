#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "floor_plan.hpp"
#include "saphira/base/places.hpp"

namespace saphira {
namespace {

using lps::PointType;
using maps::Feature;
using maps::Map;
using sim::World;

constexpr double kPioneer = 0.22;   // [m] radius, config/robots/pioneer.p
constexpr double kMargin = 0.05;    // [m] its distance from everything
constexpr double kOnWall = 0.02;    // [m] objects this near to a segment lie on it
constexpr double kBesides = 0.5;    // [m] in front of a door and behind it
constexpr double kWellBuilt = 0.9;  // share of a corridor's sides: wall, or an opening of the map

constexpr double kFurnished = 0.9;  // share of a room outside of its furniture

bool is_opening(const Feature& feature) {
  return feature.type == PointType::door || feature.type == PointType::breach;
}

bool is_room(const Feature& feature) {
  return feature.type == PointType::office;
}

bool is_way(const Feature& feature) {
  return feature.type == PointType::corridor || feature.type == PointType::junction;
}

class ShippedWorld : public ::testing::TestWithParam<std::string> {
 protected:
  const World world = sim::load_world(test::source("config/worlds/" + GetParam() + ".wld"));
  const Map map = maps::load_map(test::source("config/maps/" + GetParam() + ".map"));
};

INSTANTIATE_TEST_SUITE_P(Worlds, ShippedWorld,
                         ::testing::ValuesIn(names_in(test::source("config/worlds"), ".wld")),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(ShippedFiles, EveryWorldHasAMapAndEveryMapAWorld) {
  EXPECT_EQ(names_in(test::source("config/worlds"), ".wld"),
            names_in(test::source("config/maps"), ".map"));
  EXPECT_GE(names_in(test::source("config/worlds"), ".wld").size(), 7U);
}

TEST(ShippedFiles, TheOfficeFloorHasWhatAFloorHas) {
  const Map map = maps::load_map(test::source("config/maps/office-floor.map"));
  const auto count = [&](PointType type) {
    return std::count_if(map.features.begin(), map.features.end(),
                         [&](const Feature& f) { return f.type == type; });
  };
  EXPECT_GE(count(PointType::corridor), 3);
  EXPECT_GE(count(PointType::office), 10);
  EXPECT_GE(count(PointType::door), 10);
  EXPECT_GE(count(PointType::junction), 1);
  EXPECT_GE(maps::named(map, PointType::office, "library").size(), 1U);
  for (const char* name : {"EJ-231", "EJ-233", "EJ-235", "EJ-237", "EJ-239"}) {
    EXPECT_EQ(maps::named(map, PointType::office, name).size(), 1U) << name;
    EXPECT_EQ(maps::named(map, PointType::door, name).size(), 1U) << name;
  }
}

// The segments of the manual's chapter 11 are all there.
TEST(ShippedFiles, TheOfficeFloorContinuesTheManualsSample) {
  const World floor = sim::load_world(test::source("config/worlds/office-floor.wld"));
  const World sample = sim::load_world(test::source("sim/test/data/manual-sample.wld"));
  EXPECT_EQ(floor.width, sample.width);
  EXPECT_EQ(floor.height, sample.height);
  EXPECT_EQ(floor.start, sample.start);
  for (const sim::Segment& printed : sample.segments)
    EXPECT_TRUE(
        std::any_of(floor.segments.begin(), floor.segments.end(),
                    [&](const auto& s) { return s.from == printed.from && s.to == printed.to; }))
        << printed.from.transpose() << " to " << printed.to.transpose();
}

TEST_P(ShippedWorld, StartsWhereTheRobotHasRoom) {
  ASSERT_TRUE(world.start);
  EXPECT_GT(sim::distance(world.segments, world.start->position()), kPioneer + kMargin);
  const Feature* start = nullptr;
  for (const Feature& feature : map.features)
    if (feature.type == PointType::position && feature.name == "start")
      start = &feature;
  ASSERT_NE(start, nullptr);
  EXPECT_NEAR((start->pose_in_map.position() - world.start->position()).norm(), 0.0, 1e-9);
  EXPECT_NEAR(sub2_angle(start->pose_in_map.th, world.start->th), 0.0, 1e-9);
}

TEST_P(ShippedWorld, EverythingIsInside) {
  for (const sim::Segment& segment : world.segments)
    for (const Vec2& end : {segment.from, segment.to}) {
      EXPECT_TRUE(end.x() > -1e-9 && end.x() < world.width + 1e-9) << end.transpose();
      EXPECT_TRUE(end.y() > -1e-9 && end.y() < world.height + 1e-9) << end.transpose();
    }
}

TEST_P(ShippedWorld, IsClosed) {
  // A robot that drives on never reaches the border.
  const test::Reach reach(world, kPioneer);
  for (double t = 0.0; t <= 1.0; t += 0.001)
    for (const Vec2& at : {Vec2(t * world.width, 0.0), Vec2(t * world.width, world.height),
                           Vec2(0.0, t * world.height), Vec2(world.width, t * world.height)})
      ASSERT_FALSE(reach.at(at)) << at.transpose();
}

// Straight through the middle of each; both sides can be reached from the start.
TEST_P(ShippedWorld, EveryDoorIsPassable) {
  const test::Reach reach(world, kPioneer + kMargin);
  for (const Feature& door : map.features) {
    if (!is_opening(door))
      continue;
    for (double x = -kBesides; x <= kBesides; x += 0.01)
      ASSERT_GT(sim::distance(world.segments, transform(door.pose_in_map, {x, 0.0})),
                kPioneer + kMargin)
          << "opening " << door.id << " at " << x;
    EXPECT_TRUE(reach.at(transform(door.pose_in_map, {kBesides, 0.0}))) << door.id;
    EXPECT_TRUE(reach.at(transform(door.pose_in_map, {-kBesides, 0.0}))) << door.id;
  }
}

// All of it except the insides of furniture.
TEST_P(ShippedWorld, EveryRoomIsReachable) {
  const test::Reach reach(world, kPioneer + kMargin);
  for (const Feature& room : map.features)
    if (is_room(room) || is_way(room)) {
      EXPECT_GT(reach.share_of(room), kFurnished) << room.id << " " << room.name;
    }
}

// A door of the map is an opening of the world: a jamb on each side, nothing between them, the room
// of its name behind it, and another place before it.
TEST_P(ShippedWorld, DoorsOfTheMapAreThere) {
  for (const Feature& door : map.features) {
    if (!is_opening(door))
      continue;
    const double half = door.width / 2;
    for (const double side : {half, -half})
      EXPECT_LT(sim::distance(world.segments, transform(door.pose_in_map, {0.0, side})), kOnWall)
          << door.id;
    const Vec2 from = transform(door.pose_in_map, {0.0, -half + kOnWall});
    const Vec2 to = transform(door.pose_in_map, {0.0, half - kOnWall});
    EXPECT_FALSE(sim::cast_ray(world.segments, from, (to - from).normalized(), (to - from).norm()))
        << door.id;
    const Vec2 out = transform(door.pose_in_map, {kBesides, 0.0});
    const Vec2 in = transform(door.pose_in_map, {-kBesides, 0.0});
    bool room_behind = door.name.empty();
    bool place_before = false;
    for (const Feature& feature : map.features) {
      room_behind |= is_room(feature) && feature.name == door.name && maps::contains(feature, in);
      place_before |= (is_way(feature) || (is_room(feature) && feature.name != door.name)) &&
                      maps::contains(feature, out);
    }
    EXPECT_TRUE(room_behind) << door.id;
    EXPECT_TRUE(place_before) << door.id;
  }
}

TEST_P(ShippedWorld, EveryRoomHasADoor) {
  for (const Feature& room : map.features)
    if (is_room(room)) {
      EXPECT_TRUE(
          std::any_of(map.features.begin(), map.features.end(),
                      [&](const Feature& f) {
                        return is_opening(f) &&
                               (f.name == room.name ||
                                (f.name.empty() &&
                                 maps::contains(room, transform(f.pose_in_map, {kBesides, 0.0}))) ||
                                (f.name.empty() &&
                                 maps::contains(room, transform(f.pose_in_map, {-kBesides, 0.0}))));
                      }))
          << room.id << " " << room.name;
    }
}

TEST_P(ShippedWorld, WallsOfTheMapAreThere) {
  for (const Feature& wall : map.features) {
    if (wall.type != PointType::wall)
      continue;
    const Vec2 from = transform(wall.pose_in_map, {-wall.length / 2, 0.0});
    const Vec2 to = transform(wall.pose_in_map, {wall.length / 2, 0.0});
    EXPECT_GT(test::covered(world, from, to, kOnWall, [](const Vec2&) { return false; }), 0.99)
        << wall.pose_in_map.x << " " << wall.pose_in_map.y;
  }
}

// The sides of a corridor are walls, except for doors, breaks, junctions and other corridors.
TEST_P(ShippedWorld, CorridorsOfTheMapAreThere) {
  for (const Feature& corridor : map.features) {
    if (corridor.type != PointType::corridor)
      continue;
    const auto open = [&](const Vec2& at) {
      return std::any_of(map.features.begin(), map.features.end(), [&](const Feature& f) {
        if (&f == &corridor)
          return false;
        if (is_opening(f)) {
          const Vec2 inside = to_frame(f.pose_in_map, at);
          return std::abs(inside.x()) < kOnWall && std::abs(inside.y()) <= f.width / 2;
        }
        return is_way(f) && maps::contains(f, at);
      });
    };
    for (const double side : {corridor.width / 2, -corridor.width / 2}) {
      const Vec2 from = transform(corridor.pose_in_map, {-corridor.length / 2, side});
      const Vec2 to = transform(corridor.pose_in_map, {corridor.length / 2, side});
      EXPECT_GT(test::covered(world, from, to, kOnWall, open), kWellBuilt)
          << corridor.id << (side > 0 ? " left" : " right");
    }
    // ...and no wall runs across it.
    const Vec2 from = transform(corridor.pose_in_map, {-corridor.length / 2 + 0.1, 0.0});
    const Vec2 to = transform(corridor.pose_in_map, {corridor.length / 2 - 0.1, 0.0});
    EXPECT_FALSE(sim::cast_ray(world.segments, from, (to - from).normalized(), (to - from).norm()))
        << corridor.id;
  }
}

TEST_P(ShippedWorld, ObjectsOfTheMapAreThere) {
  for (const Feature& object : map.features) {
    if (object.type != PointType::object)
      continue;
    for (const Vec2& side : {Vec2(object.length / 2, 0.0), Vec2(-object.length / 2, 0.0),
                             Vec2(0.0, object.width / 2), Vec2(0.0, -object.width / 2)})
      EXPECT_LT(sim::distance(world.segments, transform(object.pose_in_map, side)), kOnWall)
          << object.id;
  }
}

}  // namespace
}  // namespace saphira
