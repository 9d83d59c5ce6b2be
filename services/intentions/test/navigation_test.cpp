#include "saphira/intentions/navigation.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "language_bench.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {
namespace {

// A corridor along x with a room on each side, and a second corridor that crosses its east end.
const char* const kMap = R"(
CORRIDOR (1) 5000, 0, 0, 10000, 2000 "hall"
CORRIDOR (2) 10000, 0, 90, 12000, 2000 "cross"
OFFICE (11) 3000, 3000, 90, 4000, 4000 "north"
DOOR (111) 3000, 1000, -90, 900 "north"
OFFICE (12) 3000, -3000, 90, 4000, 4000 "south"
DOOR (112) 3000, -1000, 90, 900 "south"
DOOR (113) 4500, -1000, 90, 900 "south"
POS (20) 8000, 0, 0 "corner"
)";

class Navigation : public testing::Test {
 protected:
  Navigation() {
    add_navigation(functions);
    around.map = std::make_shared<const maps::Map>(maps::parse_map(kMap, "test.map"));
    around.topology = std::make_shared<const maps::Topology>(*around.map);
    around.map_revision = 1;
    around.registration.state = v1::REGISTRATION_TRACKING;
    robot.connected = true;
    be_at({1.0, 0.0, 0.0});
  }

  /// Odom is the map's frame here.
  void be_at(const Pose& pose) {
    robot.pose_in_odom = pose;
    robot.odom_in_map = Pose{};
    around.registration.pose_in_map = pose;
  }
  /// Nothing but these echoes [m] of three sonars ahead.
  void hear(const std::array<double, 3>& echoes) {
    lps::LpsSettings settings;
    settings.sonars = {{0, {0.1, 0.1, 0.2}}, {1, {0.1, 0.0, 0.0}}, {2, {0.1, -0.1, -0.2}}};
    heard = std::make_unique<lps::LocalPerceptualSpace>(settings);
    around.lps = heard.get();
    for (std::uint64_t cycle = 1; cycle < 10; ++cycle)
      heard->update(robot.pose_in_odom,
                    {{0, echoes[0], true}, {1, echoes[1], true}, {2, echoes[2], true}}, cycle);
  }
  World world() { return {robot, around, beliefs, now}; }
  Value call(const std::string& name, const std::vector<Value>& arguments) {
    const Function* const function = functions.function(name);
    EXPECT_NE(function, nullptr) << name;
    return function->call(world(), arguments);
  }
  Value path(const std::string& to) { return call("find-path", {condition("*cur-region*"), to}); }
  Value condition(const std::string& name) { return functions.condition(name)->value(world()); }
  std::string words(const Value& path) { return spoken(call("path-text", {path})); }

  std::unique_ptr<lps::LocalPerceptualSpace> heard;
  Functions functions = core_functions();
  Beliefs beliefs{&functions};
  Robot robot;
  Surroundings around;
  Ticks now = 1000;
};

TEST_F(Navigation, APathIsRegionsAndTheWaysBetween) {
  const Value north = path("north");
  EXPECT_EQ(words(north), "corridor 1 (hall), door 111 (north), room 11 (north)");
  EXPECT_EQ(north.list().size(), 3U);
  EXPECT_EQ(call("leg", {north}), Value("corridor-to-door"));
  EXPECT_EQ(call("leg", {path("corner")}), Value("corridor-to-point"));
  EXPECT_EQ(call("leg", {path("cross")}), Value("corridor-to-junction"));
  EXPECT_TRUE(path("nowhere").nil());
  EXPECT_EQ(spoken(call("why-no-path", {Value(), "nowhere"})),
            "the map has no place \"nowhere\": it has hall, cross, north, south, corner");
  EXPECT_EQ(spoken(call("why-no-place", {"nrth"})),
            "the map has no place \"nrth\": did you mean north?");
}

TEST_F(Navigation, OutOfARoomThroughItsDoor) {
  be_at({3.0, 3.0, 0.0});
  const Value south = path("south");
  EXPECT_EQ(call("leg", {south}), Value("room-to-door"));
  const Value door = south.list()[1];
  const Value hall = south.list()[2];
  EXPECT_EQ(call("door-direction", {door, hall}), Value("out"));
  EXPECT_EQ(call("door-direction", {door, south.list()[0]}), Value("in"));
}

TEST_F(Navigation, AClosedWayIsLeftOutAndForgottenAfterFiveMinutes) {
  const Value first = path("south");
  EXPECT_EQ(words(first), "corridor 1 (hall), door 112 (south), room 12 (south)");
  beliefs.set("*closed-ways*", call("closed-ways-with", {first.list()[1]}), "test", now);
  const Value second = path("south");
  EXPECT_EQ(words(second), "corridor 1 (hall), door 113 (south), room 12 (south)");
  beliefs.set("*closed-ways*", call("closed-ways-with", {second.list()[1]}), "test", now);
  EXPECT_TRUE(path("south").nil());
  EXPECT_NE(spoken(call("why-no-path", {Value(), "south"})).find("not closed"), std::string::npos);
  now += 3001;
  EXPECT_FALSE(path("south").nil());
  EXPECT_TRUE(call("why-no-path", {Value(), "south"}).nil());
}

TEST_F(Navigation, WhereThePathEndsTheRobotIsAtThePlace) {
  be_at({3.0, 4.8, 0.0});
  EXPECT_TRUE(call("at-place", {"north"}).truthy());
  be_at({3.0, 5.3, 0.0});  // beside the room, and in no other
  EXPECT_EQ(call("leg", {path("north")}), Value("done"));
  EXPECT_TRUE(call("at-place", {"north"}).truthy());
  be_at({3.0, 0.9, 0.0});  // before its door
  EXPECT_TRUE(call("at-place", {"north"}).nil());
}

TEST_F(Navigation, ANearPointInTheSameRegionNeedsNoPath) {
  const auto beside = [&](double x, double y, Frame frame) {
    return call("beside", {Point{{x, y, 0.0}, frame}}).truthy();
  };
  EXPECT_TRUE(beside(3.5, 0.5, Frame::map));
  EXPECT_TRUE(beside(-0.5, 0.0, Frame::robot));
  EXPECT_FALSE(beside(4.5, 0.0, Frame::map));  // far
  EXPECT_FALSE(beside(3.0, 2.0, Frame::map));  // behind a wall
  EXPECT_TRUE(call("beside", {"hall"}).nil());
  EXPECT_EQ(spoken(call("arrival", {Point{{0.0, -0.12, 0.0}, Frame::robot}})),
            "arrived, 0.12 m from the point");
  EXPECT_EQ(spoken(call("arrival", {"hall"})), "the robot is at corridor 1 (hall)");
  robot.odom_in_map.reset();
  EXPECT_FALSE(beside(0.5, 0.0, Frame::robot));
}

TEST_F(Navigation, NobodyIsAskedToOpenAWayThatIsOpen) {
  const auto reason_after = [&](const std::string& ending) {
    Stage stage(read_file(std::getenv("SAPHIRA_SOURCE_DIR") +
                          std::string("/config/activities/navigation.act")) +
                    "(defintention :plan-and-execute :params (dest)"
                    " :goals '((EXECUTE (say \"I try\")) " +
                    ending + "))",
                functions);
    stage.inputs.around = around;
    stage.inputs.robot = robot;
    stage.inputs.robot.odom = 1;
    stage.ask(1, "go_to_place", {text("place", "north")});
    stage.step(60);
    EXPECT_EQ(stage.messages, std::vector<std::string>(4, "I try"));
    EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
    return stage.status(1).reason;
  };
  EXPECT_EQ(reason_after("(FAIL \"a behavior is missing\")"),
            "it has not come to north, though it knows a way: a behavior is missing");
  EXPECT_EQ(reason_after("(SUCCEED \"at the end of the path\")"),
            "it has not come to north, though it knows a way: its path ended elsewhere");
}

TEST_F(Navigation, PeopleCanOpenADoorAndNotMakeItWider) {
  around.robot_radius = 0.25;
  const Value north = path("north");
  ASSERT_FALSE(north.nil());
  const Value here = condition("*cur-region*");
  beliefs.set("*closed-ways*", call("closed-ways-with", {north.list()[1]}), "test", now);
  EXPECT_TRUE(path("north").nil());
  EXPECT_TRUE(call("could-be-opened", {here, "north"}).truthy());
  beliefs.unset("*closed-ways*");
  around.robot_radius = 0.6;
  EXPECT_TRUE(path("north").nil());
  EXPECT_FALSE(call("could-be-opened", {here, "north"}).truthy());
  EXPECT_NE(spoken(call("why-no-path", {here, "north"})).find("the robot needs 1.36 m"),
            std::string::npos);
}

TEST_F(Navigation, WhatPeopleWarnOfIsNotOnThePath) {
  const Value before = path("south");
  ASSERT_FALSE(before.nil());
  EXPECT_TRUE(call("hazard-on", {before}).nil());
  beliefs.set("hazards", "spill at nowhere; water leak at south", "test", now);
  EXPECT_EQ(spoken(call("hazard-on", {before})), "water leak at south");
  EXPECT_TRUE(path("south").nil());
  EXPECT_FALSE(path("north").nil());
  const std::string why = spoken(call("why-no-path", {Value(), "south"}));
  EXPECT_TRUE(why.ends_with("people warn of: water leak at south")) << why;
  // The robot may leave its own region.
  be_at({3.0, -3.0, 0.0});
  EXPECT_FALSE(path("north").nil());
  beliefs.unset("hazards");
  be_at({1.0, 0.0, 0.0});
  EXPECT_FALSE(path("south").nil());
}

TEST_F(Navigation, ZonesOfTheMapForbidAndSlowDown) {
  const auto with = [&](const std::string& line) {
    around.map = std::make_shared<const maps::Map>(maps::parse_map(kMap + line, "test.map"));
  };
  around.robot_radius = 0.25;
  const Value south = path("south");
  with("ZONE (900) 3000, -3000, 90, 4000, 4000 keep-out \"lab\"");
  EXPECT_TRUE(path("south").nil());
  EXPECT_EQ(spoken(call("why-no-path", {Value(), "south"})),
            "room 12 (south) is in keep-out zone \"lab\"");
  EXPECT_EQ(spoken(call("hazard-on", {south})), "keep-out zone \"lab\"");
  const Value here = condition("*cur-region*");
  EXPECT_FALSE(call("could-be-opened", {here, "south"}).truthy()) << "people cannot open it";
  EXPECT_FALSE(path("north").nil());
  // In the doorway, about to enter.
  be_at({4.5, -0.3, -kPi / 2});
  EXPECT_EQ(spoken(call("hazard-on", {south})), "keep-out zone \"lab\"");
  EXPECT_TRUE(call("keep-out-ahead", {}).nil());
  EXPECT_LT(speed_limit(world(), false).speed, 0.4);
  be_at({4.5, -0.7, -kPi / 2});
  EXPECT_EQ(spoken(call("keep-out-ahead", {})), "keep-out zone \"lab\"");
  EXPECT_EQ(speed_limit(world(), false).speed, 0.0);
  EXPECT_EQ(speed_limit(world(), false).reason, "keep-out zone \"lab\" is ahead");
  EXPECT_LT(speed_limit(world(), true).speed, 0.0);
  be_at({4.5, -0.7, kPi / 2});
  EXPECT_LT(speed_limit(world(), false).speed, 0.0);
  EXPECT_EQ(speed_limit(world(), true).speed, 0.0);

  beliefs.set("pace", "slow", "test", now);
  EXPECT_DOUBLE_EQ(speed_limit(world(), false).speed, 0.15);
  EXPECT_EQ(speed_limit(world(), false).reason, "told to go slowly");
  be_at({4.5, -0.7, -kPi / 2});
  EXPECT_EQ(speed_limit(world(), false).speed, 0.0) << "the zone ahead allows less";
  beliefs.unset("pace");

  be_at({1.0, 0.0, 0.0});
  with(
      "ZONE (900) 2000, 0, 0, 3000, 2000 slow 150 \"k\"\nZONE (901) 1000, 0, 0, 1000, 1000 slow "
      "80");
  EXPECT_DOUBLE_EQ(speed_limit(world(), false).speed, 0.08);
  EXPECT_EQ(speed_limit(world(), false).reason, "slow zone 901");
  EXPECT_EQ(spoken(call("zones-on", {path("cross")})), "through slow zone \"k\" and slow zone 901");
  // The hull counts.
  be_at({0.3, 0.0, 0.0});
  EXPECT_EQ(speed_limit(world(), false).reason, "slow zone 901");
  be_at({0.2, 0.0, 0.0});
  EXPECT_LT(speed_limit(world(), false).speed, 0.0);
  beliefs.set("hazards", "slow at hall", "test", now);
  be_at({6.0, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(speed_limit(world(), false).speed, 0.15);
  EXPECT_EQ(speed_limit(world(), false).reason, "hall, where people told me to go slowly");
}

TEST_F(Navigation, APathOfAnotherRevisionOfTheMapIsNoMoreOne) {
  const Value north = path("north");
  EXPECT_TRUE(call("path-current", {north}).truthy());
  around.map_revision = 2;
  EXPECT_TRUE(call("path-current", {north}).nil());
  EXPECT_THROW(call("leg", {north}), ActivityError);
}

TEST_F(Navigation, WithoutAPositionThereIsNoRegionAndNoPath) {
  robot.odom_in_map.reset();
  EXPECT_TRUE(condition("*cur-region*").nil());
  EXPECT_TRUE(path("north").nil());
  EXPECT_TRUE(call("next-to-explore", {Value()}).nil());
}

// Manual 8.1.3: aligned_in_lane(e, &follow_target, 80.0, 110.0).
TEST_F(Navigation, AlignedIsWhoLooksAlongTheLaneTowardsTheTarget) {
  const Value lane = Point{{5.0, 0.0, kPi}, Frame::map};
  const Value east = Point{{9.0, 0.0, 0.0}, Frame::map};
  const auto aligned = [&](double heading) {
    be_at({2.0, 0.0, radians(heading)});
    return *call("aligned-in-lane", {lane, east, radians(80.0), radians(110.0)}).number();
  };
  EXPECT_DOUBLE_EQ(aligned(0.0), 1.0);
  EXPECT_DOUBLE_EQ(aligned(-79.0), 1.0);
  EXPECT_NEAR(aligned(95.0), 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(aligned(180.0), 0.0);
}

TEST_F(Navigation, TheEndOfACorridorIsWhereTheRobotIsTurned) {
  const Value hall = condition("*corridor*");
  ASSERT_FALSE(hall.nil());
  EXPECT_NEAR(call("lane-end", {hall}).point()->pose.x, 9.0, 1e-9);
  be_at({1.0, 0.0, kPi});
  EXPECT_NEAR(call("lane-end", {hall}).point()->pose.x, 1.0, 1e-9);
}

TEST_F(Navigation, ADoorIsClosedWhereTheSonarsHaveSomethingAllAcross) {
  const Value door = path("north").list()[1];
  EXPECT_EQ(call("door-state", {door}), Value("unknown"));
  be_at({3.0, 0.0, kPi / 2});
  hear({0.92, 0.9, 0.92});
  EXPECT_EQ(call("door-state", {door}), Value("closed"));
  hear({3.0, 3.0, 3.0});
  EXPECT_EQ(call("door-state", {door}), Value("open"));
}

// A closed door and somebody in the doorway are told apart where the echoes allow it, or a camera.
TEST_F(Navigation, SomebodyInADoorwayIsNotItsLeaf) {
  const Value door = path("north").list()[1];
  be_at({3.0, 0.0, kPi / 2});
  hear({3.0, 0.9, 3.0});
  EXPECT_EQ(call("door-state", {door}), Value("barred"));
  std::vector<lps::SeenThing> things(1);
  things[0].pose_in_odom = {3.2, 1.1, 0.0};
  around.things = &things;
  EXPECT_EQ(call("door-state", {door}), Value("person"));
  things[0].pose_in_odom = {3.2, 2.0, 0.0};  // behind it, in the room
  EXPECT_EQ(call("door-state", {door}), Value("barred"));
  things[0].pose_in_odom = {3.2, 1.1, 0.0};
  around.cycle = 31;  // gone since
  EXPECT_EQ(call("door-state", {door}), Value("barred"));
}

TEST_F(Navigation, ExploringGoesToTheNearestEndFirstAndComesToAnEnd) {
  Value visited;
  double last = 0.0;
  int places = 0;
  for (; places < 20; ++places) {
    const Value next = call("next-to-explore", {visited});
    if (next.nil())
      break;
    const Pose at = next.point()->pose;
    if (places == 0)
      last = (at.position() - robot.pose_in_odom.position()).norm();
    visited = functions.function("cons")->call(world(), std::vector<Value>{next, visited});
  }
  // The robot is at the west end.
  EXPECT_EQ(places, 3);
  EXPECT_NEAR(last, 8.0, 0.1);
}

// Functions about the people and colours that a camera sees.

using lps::SeenThing;

class Seeing : public testing::Test {
 protected:
  Seeing() {
    add_navigation(functions);
    robot.connected = true;
    robot.pose_in_odom = {1.0, 0.0, 0.0};
    around.cycle = 100;
    around.things = &things;
    person(7, {4.0, 0.0, kPi}, 90);
    person(8, {1.0, 2.0, -kPi / 2}, 100);
    SeenThing blob;
    blob.id = 9;
    blob.kind = SeenThing::Kind::blob;
    blob.channel = 1;
    blob.pose_in_odom = {3.0, -2.0, 0.0};
    blob.range_known = false;
    blob.area = 0.02;
    blob.seen = 100;
    things.push_back(blob);
  }
  void person(std::uint32_t id, const Pose& pose, std::uint64_t seen) {
    SeenThing made;
    made.id = id;
    made.pose_in_odom = pose;
    made.velocity_in_odom = {0.3, 0.4};
    made.confidence = 0.9;
    made.seen = seen;
    things.push_back(made);
  }
  Value call(const std::string& name, const std::vector<Value>& arguments) {
    const Function* const function = functions.function(name);
    EXPECT_NE(function, nullptr) << name;
    return function->call({robot, around, beliefs, 1000}, arguments);
  }
  double number(const std::string& name, const std::vector<Value>& arguments) {
    const Value value = call(name, arguments);
    EXPECT_NE(value.number(), nullptr) << name << " gave " << to_text(value);
    return value.number() == nullptr ? 1e9 : *value.number();
  }

  Functions functions = core_functions();
  Beliefs beliefs{&functions};
  Robot robot;
  Surroundings around;
  std::vector<SeenThing> things;
};

TEST_F(Seeing, TheNearestOfItsKind) {
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 8 0)");
  EXPECT_EQ(to_text(call("seen", {"person", Value()})), "(thing 8 0)");
  EXPECT_EQ(to_text(call("seen", {"person", Point{{3.0, 0.0, 0.0}, Frame::robot}})), "(thing 7 0)");
  robot.pose_in_odom = {3.0, 0.0, 0.0};
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 7 0)");
  EXPECT_EQ(to_text(call("seen", {"blob"})), "(thing 9 0)");
  EXPECT_EQ(to_text(call("seen", {"blob-b"})), "(thing 9 0)");
  EXPECT_TRUE(call("seen", {"blob-a"}).nil());
  EXPECT_TRUE(call("seen", {"door"}).nil());
  EXPECT_THROW(call("seen", {"blob-d"}), ActivityError);
  EXPECT_THROW(call("seen", {"cat"}), ActivityError);
}

TEST_F(Seeing, WhoIsOutOfSightDoesNotHideWhoIsInSight) {
  robot.pose_in_odom = {3.0, 0.0, 0.0};
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 7 0)");
  around.cycle = 101;  // now it has not seen him for more than a second
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 8 0)");
  around.cycle = 120;  // and nobody
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 7 0)");
}

TEST_F(Seeing, AThingHasAPlaceADistanceAndABearing) {
  const Value ann = call("seen", {"person"});
  ASSERT_NE(call("place-of", {ann}).point(), nullptr);
  EXPECT_EQ(*call("place-of", {ann}).point(), (Point{{1.0, 2.0, -kPi / 2}, Frame::odom}));
  EXPECT_NEAR(number("distance-to", {ann}), 2.0, 1e-9);
  EXPECT_NEAR(number("bearing-of", {ann}), kPi / 2, 1e-9);
  EXPECT_NEAR(number("speed-of", {ann}), 0.5, 1e-9);
  EXPECT_NEAR(number("confidence-of", {ann}), 0.9, 1e-9);
  const Value later = call("predicted-place", {ann, 2.0});
  EXPECT_NEAR(later.point()->pose.x, 1.6, 1e-9);
  EXPECT_NEAR(later.point()->pose.y, 2.8, 1e-9);
}

TEST_F(Seeing, WhatWasSeenLastAndWhatIsForgotten) {
  robot.pose_in_odom = {3.0, 0.0, 0.0};
  const Value far = call("seen", {"person"});
  EXPECT_NEAR(number("seconds-unseen", {far}), 1.0, 1e-9);
  EXPECT_EQ(call("still-seen", {far}), far);
  things.clear();
  EXPECT_TRUE(call("still-seen", {far}).nil());
  EXPECT_TRUE(call("seconds-unseen", {far}).nil());
  EXPECT_TRUE(call("still-seen", {Value()}).nil());
  EXPECT_THROW(call("place-of", {far}), ActivityError);
  EXPECT_THROW(call("still-seen", {1.0}), ActivityError);
}

TEST_F(Seeing, OfABlobOnlyTheDirectionMayBeKnown) {
  const Value blob = call("seen", {"blob"});
  EXPECT_TRUE(call("range-known", {blob}).nil());
  EXPECT_TRUE(call("range-known", {call("seen", {"person"})}).truthy());
  EXPECT_NEAR(number("area-of", {blob}), 0.02, 1e-9);
  EXPECT_NEAR(number("bearing-of", {blob}), -kPi / 4, 1e-9);
}

TEST_F(Seeing, WithoutACameraNothingIsSeen) {
  const auto can_see = [&] {
    return functions.condition("can-see")->value({robot, around, beliefs, 1000}).truthy();
  };
  EXPECT_TRUE(can_see());
  around.things = nullptr;
  EXPECT_FALSE(can_see());
  EXPECT_TRUE(call("seen", {"person"}).nil());
}

TEST_F(Seeing, AReferenceReadsBack) {
  const Value ann = call("seen", {"person"});
  EXPECT_EQ(parse_value(to_text(ann)), ann);
}

}  // namespace
}  // namespace saphira::intentions
