#include "saphira/vision/tracker.hpp"

#include <gtest/gtest.h>

#include "seen.hpp"

namespace saphira::vision {
namespace {

using Kind = lps::SeenThing::Kind;

Sight person_at(double x, double y) {
  return Sight{.place_in_robot = {x, y}};
}

bool everywhere(const Vec2&) {
  return true;
}
bool nowhere(const Vec2&) {
  return false;
}

TEST(Tracker, AnIdStaysAndTheVelocityIsLearned) {
  Tracker tracker;
  Random random(3);
  std::uint32_t id = 0;
  for (std::uint64_t cycle = 1; cycle <= 60; ++cycle) {
    const double x = 2.0 + 0.05 * static_cast<double>(cycle);
    tracker.see(Kind::person, cycle, {},
                {person_at(x + 0.05 * random.normal(), 0.5 + 0.05 * random.normal())}, everywhere);
    const auto things = tracker.things(cycle, {});
    ASSERT_EQ(things.size(), cycle < 3 ? 0U : 1U) << cycle;
    if (cycle == 3)
      id = things[0].id;
    if (cycle > 3) {
      EXPECT_EQ(things[0].id, id);
    }
  }
  const auto things = tracker.things(60, {});
  EXPECT_NEAR(things[0].pose_in_odom.x, 5.0, 0.15);
  EXPECT_NEAR(things[0].velocity_in_odom.x(), 0.5, 0.2);
  EXPECT_NEAR(things[0].velocity_in_odom.y(), 0.0, 0.2);
  EXPECT_GT(things[0].confidence, 0.9);
  EXPECT_EQ(things[0].since, 1U);
  EXPECT_EQ(things[0].seen, 60U);
}

TEST(Tracker, TwoWhoPassEachOtherKeepTheirIds) {
  Tracker tracker;
  for (std::uint64_t cycle = 1; cycle <= 40; ++cycle) {
    const double t = 0.1 * static_cast<double>(cycle);
    tracker.see(Kind::person, cycle, {},
                {person_at(3.0, -1.0 + 0.5 * t), person_at(3.4, 1.0 - 0.5 * t)}, everywhere);
  }
  const auto things = tracker.things(40, {});
  ASSERT_EQ(things.size(), 2U);
  EXPECT_EQ(things[0].id, 1U);
  EXPECT_NEAR(things[0].pose_in_odom.y, 1.0, 0.1);
  EXPECT_EQ(things[1].id, 2U);
  EXPECT_NEAR(things[1].pose_in_odom.y, -1.0, 0.1);
}

TEST(Tracker, WhoIsHiddenGoesOnAndIsFoundAgain) {
  Tracker tracker;
  std::uint64_t cycle = 1;
  for (; cycle <= 30; ++cycle)
    tracker.see(Kind::person, cycle, {}, {person_at(3.0, -1.0 + 0.05 * static_cast<double>(cycle))},
                everywhere);
  const std::uint32_t id = tracker.things(cycle, {}).at(0).id;
  for (; cycle <= 45; ++cycle)
    tracker.see(Kind::person, cycle, {}, {}, nowhere);
  // As if it had continued for a second and a half.
  EXPECT_NEAR(tracker.things(45, {}).at(0).pose_in_odom.y, -1.0 + 0.05 * 45.0, 0.3);
  tracker.see(Kind::person, 46, {}, {person_at(3.1, 1.4)}, everywhere);
  ASSERT_EQ(tracker.things(46, {}).size(), 1U);
  EXPECT_EQ(tracker.things(46, {})[0].id, id);
  EXPECT_EQ(tracker.things(46, {})[0].seen, 46U);
}

// He comes up to the robot until he is too near for the cameras.
TEST(Tracker, WhoWalksUpToTheRobotStaysBeforeIt) {
  Tracker tracker;
  std::uint64_t cycle = 1;
  for (; cycle <= 20; ++cycle)
    tracker.see(Kind::person, cycle, {}, {person_at(2.8 - 0.1 * static_cast<double>(cycle), 0.1)},
                everywhere);
  for (; cycle <= 60; ++cycle)
    tracker.see(Kind::person, cycle, {}, {}, nowhere);
  const auto things = tracker.things(cycle, {});
  ASSERT_EQ(things.size(), 1U);
  EXPECT_GT(things[0].pose_in_odom.position().norm(), 0.44);
  EXPECT_LT(things[0].pose_in_odom.position().norm(), 0.7);
  EXPECT_GT(things[0].pose_in_odom.x, 0.3);
}

// Somebody has been out of sight for long, and could be anywhere by now; another is seen all the
// time and turns around.
TEST(Tracker, WhoIsInSightKeepsHisIdFromWhoIsLost) {
  Tracker tracker;
  std::uint64_t cycle = 1;
  const auto other = [&] { return person_at(3.5 + 0.08 * static_cast<double>(cycle % 2), 1.0); };
  for (; cycle <= 20; ++cycle)
    tracker.see(Kind::person, cycle, {}, {person_at(3.0, -1.0), other()}, everywhere);
  for (; cycle <= 80; ++cycle)
    tracker.see(Kind::person, cycle, {}, {other()}, nowhere);
  // As far as that he is not quite where he was expected.
  tracker.see(Kind::person, cycle, {}, {person_at(3.4, 0.8)}, nowhere);
  for (const lps::SeenThing& thing : tracker.things(cycle, {}))
    EXPECT_EQ(thing.seen, thing.id == 2 ? cycle : 20U) << thing.id;
}

TEST(Tracker, WhoIsNotWhereHeShouldBeSeenIsForgotten) {
  Tracker tracker;
  std::uint64_t cycle = 1;
  for (; cycle <= 10; ++cycle)
    tracker.see(Kind::person, cycle, {}, {person_at(3.0, 0.0)}, everywhere);
  for (; cycle <= 25; ++cycle)
    tracker.see(Kind::person, cycle, {}, {}, everywhere);
  EXPECT_EQ(tracker.things(25, {}).size(), 1U);
  for (; cycle <= 35; ++cycle)
    tracker.see(Kind::person, cycle, {}, {}, everywhere);
  EXPECT_TRUE(tracker.things(35, {}).empty());
  // And the next one is another.
  for (; cycle <= 40; ++cycle)
    tracker.see(Kind::person, cycle, {}, {person_at(3.0, 0.0)}, everywhere);
  EXPECT_EQ(tracker.things(40, {}).at(0).id, 2U);
}

TEST(Tracker, WithoutPicturesNobodyIsLeftInTheEnd) {
  Tracker tracker;
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle)
    tracker.see(Kind::person, cycle, {}, {person_at(3.0, 0.0)}, everywhere);
  EXPECT_EQ(tracker.things(100, {}).size(), 1U);
  EXPECT_TRUE(tracker.things(200, {}).empty());
}

TEST(Tracker, OneSightIsNobody) {
  Tracker tracker;
  tracker.see(Kind::person, 1, {}, {person_at(3.0, 0.0)}, everywhere);
  tracker.see(Kind::person, 2, {}, {}, everywhere);
  tracker.see(Kind::person, 9, {}, {person_at(3.0, 0.0)}, everywhere);
  EXPECT_TRUE(tracker.things(9, {}).empty());
}

TEST(Tracker, AnArmPointsOnceItHasHeld) {
  Tracker tracker;
  const Pose robot(1.0, 2.0, radians(90.0));
  std::uint64_t cycle = 0;
  const auto see = [&](std::optional<double> points) {
    Sight sight = person_at(2.0, 0.0);
    sight.points = points;
    tracker.see(Kind::person, ++cycle, robot, {sight}, everywhere);
    const auto things = tracker.things(cycle, robot);
    return things.empty() ? lps::SeenThing{} : things[0];
  };
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(see(std::nullopt).pointed, 0U);
  // Now on this side, now on that: nothing holds.
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(see(radians(i % 2 == 0 ? 80.0 : -80.0)).pointed, 0U);
  see(std::nullopt);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(see(radians(80.0)).pointed, 0U) << i;
  lps::SeenThing thing = see(radians(84.0));
  EXPECT_EQ(thing.pointed, cycle);
  EXPECT_NEAR(degrees(thing.points_in_odom), 172.0, 4.0);
  const std::uint64_t last = cycle;
  EXPECT_EQ(see(std::nullopt).pointed, last);  // a single miss
  EXPECT_EQ(see(radians(80.0)).pointed, cycle);
  for (int i = 0; i < 20; ++i)
    thing = see(std::nullopt);
  EXPECT_EQ(thing.pointed, last + 2);
}

// An object that is seen from two places in two directions has a range.
TEST(Tracker, DirectionsFromSeveralPlacesMakeAPlace) {
  Tracker tracker;
  const Vec2 blob(3.0, 1.0);
  bool known_at_once = true;
  for (std::uint64_t cycle = 1; cycle <= 60; ++cycle) {
    const Pose robot(0.03 * static_cast<double>(cycle), -0.5, 0.1);
    const Vec2 at = to_frame(robot, blob);
    Sight sight = person_at(0.0, 0.0);
    sight.kind = Kind::blob;
    sight.channel = 0;
    sight.place_in_robot = 2.0 * at.normalized();
    sight.range_known = false;
    sight.sigma_range = 2.0;
    sight.sigma_across = 0.04;
    tracker.see(Kind::blob, cycle, robot, {sight}, everywhere);
    if (cycle == 4)
      known_at_once = tracker.things(4, robot).at(0).range_known;
  }
  EXPECT_FALSE(known_at_once);
  const Pose robot(1.8, -0.5, 0.1);
  const auto things = tracker.things(60, robot);
  ASSERT_EQ(things.size(), 1U);
  EXPECT_EQ(things[0].id, 1U);
  EXPECT_TRUE(things[0].range_known);
  EXPECT_NEAR((things[0].pose_in_odom.position() - blob).norm(), 0.0, 0.3);
}

// The whole chain: a person walks across a room, the robot turns after her.
TEST(Tracker, AWalkerIsOnePerson) {
  const sim::World world =
      room("person ann 5000 1500 walk 5000 4500 700 walk 6500 3000 700 walk 4000 3000 700");
  sim::Scene scene(world);
  scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
  Random random(5);
  Census census;
  Tracker tracker;
  int lost = 0;
  int wrong = 0;
  double worst = 0.0;
  for (std::uint64_t cycle = 1; cycle <= 90; ++cycle) {
    for (int tick = 0; tick < 10; ++tick)
      scene.tick();
    const Pose pose = scene.robot(0).pose_in_world();
    const Bands seen = bands(census, picture(scene, random, cycle));
    tracker.see(Kind::person, cycle, pose, find_people(seen),
                [&](const Vec2& place) { return in_view(seen, place); });
    const auto things = tracker.things(cycle, pose);
    lost += cycle > 5 && things.empty();
    for (const lps::SeenThing& thing : things) {
      const double off = (thing.pose_in_odom.position() - scene.persons()[0].at).norm();
      wrong += thing.id != 1 || off > 0.6;
      worst = std::max(worst, off);
    }
  }
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(wrong, 0) << "worst " << worst << " m";
}

}  // namespace
}  // namespace saphira::vision
