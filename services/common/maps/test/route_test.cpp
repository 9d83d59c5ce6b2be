#include "saphira/maps/route.hpp"

#include <gtest/gtest.h>

#include "saphira/base/places.hpp"
#include "saphira/maps/zones.hpp"

namespace saphira::maps {
namespace {

const Topology& floor() {
  static const Topology topology(load_map(config_folder() + "/maps/office-floor.map"));
  return topology;
}

TEST(Route, ASequenceOfRegionsWithThePointsToDriveThrough) {
  const RouteResult found = find_route(floor(), Vec2(17.6, 14.0), "EJ-265");
  const std::optional<Route>& route = found.route;
  ASSERT_TRUE(route) << found.reason;
  EXPECT_EQ(text(floor(), *route),
            "corridor 2 (central corridor), junction 12, corridor 3 (lower corridor), door 1265, "
            "room 265 (EJ-265)");
  // Down to the junction, along to the door, square through it.
  EXPECT_NEAR(route->length, 7.0 + 1.35 + 1.0 + 0.7, 0.5);
  const auto points = route->points();
  EXPECT_NEAR((points.back() - Vec2(16.15, 5.3)).norm(), 0.0, 1e-9);
  for (const Leg& leg : route->legs)
    EXPECT_FALSE(leg.points.empty());
  // Every point is free ground, in the corridors a door's width from the wall.
  for (const Vec2& point : points)
    EXPECT_FALSE(floor().at(point).empty() && (point - Vec2(16.15, 6.0)).norm() > 1e-9)
        << point.transpose();
}

// Lanes lead over a free floor (explore::FreeFloor): the robot may stand beside them.
TEST(Route, FromBesideALaneUnlessAWallIsBetween) {
  const Topology room(
      parse_map("LANE (1) 3000, 1000, 0, 6000, 1400\n"
                "POS (2) 5000, 1000, 0 \"place-1\"\n"
                "WALL 3000, -500, 0, 6000\n",
                "room.map"));
  const RouteResult beside = find_route(room, Vec2(1.0, 2.9), "place-1");
  ASSERT_TRUE(beside.route) << beside.reason;
  EXPECT_EQ(text(room, *beside.route), "lane 1");
  EXPECT_EQ(beside.route->points().front(), Vec2(1.0, 1.0));
  EXPECT_TRUE(find_route(room, Vec2(1.0, 1.0), Vec2(4.0, 2.9)).route);
  EXPECT_EQ(find_route(room, Vec2(1.0, 3.8), "place-1").reason,
            "the start, (1000, 3800) mm, is in no corridor, junction or room of the map");
  EXPECT_FALSE(find_route(room, Vec2(1.0, -1.4), "place-1").route);
}

TEST(Route, AWideRobotIsNotSentThroughANarrowDoor) {
  RouteSettings settings;
  settings.needs_width = 0.85;  // the doors of this floor are 0.9 m wide
  EXPECT_TRUE(find_route(floor(), Vec2(17.6, 14.0), "EJ-265", settings).route);
  settings.needs_width = 1.1;
  const auto none = find_route(floor(), Vec2(17.6, 14.0), "EJ-265", settings);
  EXPECT_FALSE(none.route);
  EXPECT_EQ(none.reason,
            "no way from corridor 2 (central corridor) to room 265 (EJ-265) is wide enough: door "
            "1265 is 0.90 m "
            "wide, and the robot needs 1.10 m");
  // Corridors have a width as well; openings are wider than doors.
  EXPECT_TRUE(find_route(floor(), Vec2(17.6, 14.0), "library", settings).route);
  settings.needs_width = 3.5;
  EXPECT_NE(find_route(floor(), Vec2(17.6, 14.0), "library", settings).reason.find("corridor"),
            std::string::npos);
  // Without any way, the width is not the reason.
  settings.needs_width = 1.1;
  settings.blocked = {1265};
  EXPECT_EQ(find_route(floor(), Vec2(17.6, 14.0), "EJ-265", settings).reason.find("wide"),
            std::string::npos);
}

TEST(Route, TheShortestOfSeveral) {
  // From the upper corridor's middle to EJ-271 the east corridor is nearer than the central one.
  const auto by_east = find_route(floor(), Vec2(22.0, 25.0), "EJ-271");
  ASSERT_TRUE(by_east.route) << by_east.reason;
  EXPECT_EQ(text(floor(), *by_east.route),
            "corridor 1 (upper corridor), junction 14, corridor 4 (east corridor), junction 13, "
            "corridor 3 (lower corridor), door 1271, room 271 (EJ-271)");
  // Its nearer door is closed: through the other one.
  RouteSettings settings;
  settings.blocked = {1271};
  const auto other = find_route(floor(), Vec2(22.0, 25.0), "EJ-271", settings);
  ASSERT_TRUE(other.route);
  EXPECT_NE(text(floor(), *other.route).find("door 2271"), std::string::npos);
  // Also where it was closed when last seen...
  settings.blocked.clear();
  settings.closed = {1271};
  const auto doubtful = find_route(floor(), Vec2(22.0, 25.0), "EJ-271", settings);
  ASSERT_TRUE(doubtful.route);
  EXPECT_EQ(text(floor(), *doubtful.route), text(floor(), *other.route));
  // ...but without a better one it is tried.
  settings.closed = {1271, 2271};
  const auto tried = find_route(floor(), Vec2(22.0, 25.0), "EJ-271", settings);
  ASSERT_TRUE(tried.route);
  EXPECT_EQ(text(floor(), *tried.route), text(floor(), *by_east.route));
  EXPECT_DOUBLE_EQ(tried.route->length, by_east.route->length);
  // And around the region of the east corridor.
  settings.blocked = {4};
  const auto around = find_route(floor(), Vec2(22.0, 25.0), "EJ-271", settings);
  ASSERT_TRUE(around.route);
  EXPECT_NE(text(floor(), *around.route).find("corridor 2"), std::string::npos);
  EXPECT_GT(around.route->length, by_east.route->length);
}

TEST(Route, FromPlaceToPlaceAndToAPosition) {
  const auto rooms = find_route(floor(), Vec2(14.0, 22.0), "EJ-242");
  ASSERT_TRUE(rooms.route) << rooms.reason;
  EXPECT_EQ(text(floor(), *rooms.route),
            "room 241 (EJ-241), door 1241, corridor 2 (central corridor), door 1242, room 242 "
            "(EJ-242)");
  const auto library = find_route(floor(), Vec2(6.0, 10.0), "EJ-231");
  ASSERT_TRUE(library.route) << library.reason;
  const auto point = find_route(floor(), Vec2(17.5, 14.0), Vec2(30.0, 7.2));
  ASSERT_TRUE(point.route);
  EXPECT_NEAR((point.route->points().back() - Vec2(30.0, 7.2)).norm(), 0.0, 1e-9);
  const auto start = find_route(floor(), Vec2(17.5, 9.0), "start");
  ASSERT_TRUE(start.route);
  EXPECT_EQ(start.route->legs.size(), 1U);
  EXPECT_NEAR(start.route->length, 5.0, 1e-9);
}

TEST(Route, BeingThereIsARoute) {
  const auto there = find_route(floor(), Vec2(14.0, 22.0), "EJ-241");
  ASSERT_TRUE(there.route);
  EXPECT_EQ(there.route->legs.size(), 1U);
  EXPECT_NEAR(there.route->length, 0.0, 1e-9);
}

TEST(Route, SaysWhyThereIsNone) {
  EXPECT_EQ(find_route(floor(), Vec2(17.5, 14.0), "EJ-999").reason,
            "the map has no place \"EJ-999\": did you mean EJ-239?");
  EXPECT_EQ(find_route(floor(), Vec2(-7.0, 14.0), "EJ-231").reason,
            "the start, (-7000, 14000) mm, is in no corridor, junction or room of the map");
  RouteSettings closed;
  closed.blocked = {1231};
  EXPECT_EQ(find_route(floor(), Vec2(17.5, 14.0), "EJ-231", closed).reason,
            "no way from corridor 2 (central corridor) to room 231 (EJ-231) that is known and not "
            "closed");
  EXPECT_EQ(find_route(floor(), Vec2(17.5, 14.0), Vec2(-5.0, 0.0)).reason,
            "the goal, (-5000, 0) mm, is in no corridor, junction or room of the map");
  EXPECT_FALSE(find_route(Topology(), Vec2(0.0, 0.0), "x").route);
}

TEST(Route, ADoorWithNothingBehindItIsAPlaceAndNoWay) {
  const Topology t(
      parse_map("CORRIDOR (1) 0, 0, 0, 10000, 2000\nDOOR (3) 1000, 1000, -90, 900\n", "test.map"));
  const auto door = find_route(t, Vec2(-4.0, 0.0), "3");
  ASSERT_TRUE(door.route) << door.reason;
  EXPECT_NEAR((door.route->points().back() - Vec2(1.0, 0.4)).norm(), 0.0, 1e-9);
}

/// The route to a place of the floor with these lines of zones.
RouteResult with_zones(const std::string& lines, const Vec2& from, const std::string& to,
                       const std::string& advice = {}, const std::string& said_by = {}) {
  RouteSettings settings;
  settings.needs_width = 0.6;
  settings.zones = all_zones(parse_map(lines, "zones.map"), floor(), advice, said_by);
  return find_route(floor(), from, to, settings);
}

const Vec2 kUpper(22.0, 25.0);  // nearer to the east corridor than to the central one
constexpr const char* kByEast =
    "corridor 1 (upper corridor), junction 14, corridor 4 (east corridor), junction 13, "
    "corridor 3 (lower corridor), door 1271, room 271 (EJ-271)";
constexpr const char* kByCentral =
    "corridor 1 (upper corridor), junction 11, corridor 2 (central corridor), junction 12, "
    "corridor 3 (lower corridor), door 1271, room 271 (EJ-271)";

void expect_way(const RouteResult& found, const std::string& way, const std::string& remark = "") {
  ASSERT_TRUE(found.route) << found.reason;
  EXPECT_EQ(text(floor(), *found.route), way);
  EXPECT_EQ(found.remark(), remark);
}

TEST(Zones, AWayDoesNotEnterAKeepOut) {
  expect_way(
      with_zones("ZONE (900) 26000, 16000, 0, 3000, 1000 keep-out \"lab\"", kUpper, "EJ-271"),
      kByCentral, "around keep-out zone \"lab\"");
  // One that is not on the way does not matter.
  expect_way(with_zones("ZONE (900) 3000, 16000, 0, 3000, 1000 keep-out", kUpper, "EJ-271"),
             kByEast);
}

TEST(Zones, AGoalInAKeepOutHasNoRoute) {
  EXPECT_EQ(with_zones("ZONE (900) 16150, 4000, 0, 5000, 5000 keep-out \"lab\"", Vec2(17.6, 14.0),
                       "EJ-265")
                .reason,
            "room 265 (EJ-265) is in keep-out zone \"lab\"");
  RouteSettings settings;
  settings.zones =
      all_zones(parse_map("ZONE (7) 17600, 10000, 0, 1000, 1000 keep-out", "m"), floor());
  const RouteResult point = find_route(floor(), Vec2(17.6, 14.0), Vec2(17.6, 10.2), settings);
  EXPECT_EQ(point.reason, "the goal, (17600, 10200) mm, is in keep-out zone 7");
  // All the ways in.
  const std::string none = with_zones("ZONE (901) 20000, 12000, 0, 50000, 1000 keep-out \"wet\"",
                                      Vec2(17.6, 14.0), "EJ-265")
                               .reason;
  EXPECT_EQ(none,
            "no way to room 265 (EJ-265) keeps the rules of the zones: keep-out zone \"wet\"");
}

TEST(Zones, TheRobotMayLeaveAKeepOut) {
  EXPECT_TRUE(
      with_zones("ZONE (900) 17600, 14000, 0, 3000, 3000 keep-out", Vec2(17.6, 14.0), "EJ-265")
          .route);
  // Beside it the robot does not count as in it.
  const RouteResult beside =
      with_zones("ZONE (900) 17600, 12400, 0, 4000, 3000 keep-out", Vec2(17.6, 14.0), "EJ-265");
  ASSERT_TRUE(beside.route) << beside.reason;
  EXPECT_NE(text(floor(), *beside.route).find("east corridor"), std::string::npos);
}

TEST(Zones, ASlowZoneIsLonger) {
  expect_way(with_zones("ZONE (900) 26000, 16000, 0, 3000, 12000 slow 50", kUpper, "EJ-271"),
             kByCentral, "around slow zone 900");
  expect_way(with_zones("ZONE (900) 26000, 16000, 0, 3000, 500 slow 150 \"k\"", kUpper, "EJ-271"),
             kByEast, "through slow zone \"k\"");
}

TEST(Zones, OneWayHoldsAlongItsHeading) {
  expect_way(with_zones("ZONE (900) 26000, 16000, -90, 2000, 3000 one-way", kUpper, "EJ-271"),
             kByEast);
  expect_way(with_zones("ZONE (900) 26000, 16000, 90, 2000, 3000 one-way", kUpper, "EJ-271"),
             kByCentral, "around one-way zone 900");
}

TEST(Zones, APreferredWayCountsHalf) {
  expect_way(
      with_zones("ZONE (900) 17600, 16000, 0, 3000, 17000 preferred", Vec2(20.5, 25.0), "EJ-271"),
      kByCentral, "through preferred zone 900");
}

TEST(Zones, ByAdviceTheyAreRegions) {
  expect_way(with_zones("", kUpper, "EJ-271", "keep-out at east corridor",
                        "Charlie said \"keep out of the east corridor\""),
             kByCentral, "around east corridor, which Charlie told me to keep out of");
  EXPECT_EQ(with_zones("", kUpper, "EJ-271", "leak at lab; keep-out at EJ-271",
                       "Karen said \"x\"; Charlie said \"y\"")
                .reason,
            "room 271 (EJ-271) is in a place that Charlie told me to keep out of");
  EXPECT_EQ(with_zones("", kUpper, "EJ-271", "water leak at EJ-271").reason,
            "room 271 (EJ-271) is where people warn of: water leak at EJ-271");
  expect_way(
      with_zones("", kUpper, "EJ-271", "preferred at central corridor; slow at east corridor"),
      kByCentral,
      "around east corridor, where people told me to go slowly, and through central "
      "corridor, which people told me to prefer");
  const RouteResult found =
      with_zones("", Vec2(17.6, 14.0), "EJ-265", "wet floor at central corridor");
  ASSERT_TRUE(found.route) << found.reason;
  EXPECT_EQ(found.remark(), "through wet floor at central corridor");
}

}  // namespace
}  // namespace saphira::maps
