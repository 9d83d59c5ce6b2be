#include "saphira/vision/arms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "saphira/vision/vision.hpp"
#include "seen.hpp"

namespace saphira::vision {
namespace {

const Pose kRobot{2.0, 3.0, 0.0};
// Walls 2 m apart along the robot's way, each with a doorway.
const std::string kCorridor =
    "0 2000 3500 2000 4400 2000 10000 2000 0 4000 4500 4000 5400 4000 10000 4000 ";

std::string millimetres(double metres) {
  return std::to_string(std::lround(1000.0 * metres));
}

std::string at(double away, double aside) {
  return millimetres(kRobot.x + away) + " " + millimetres(kRobot.y + aside) + " ";
}

std::string pointing(double degrees) {
  return "point " + std::to_string(std::lround(degrees)) + " 1000 ";
}

// The people of one picture, each with the direction of an arm in the world.
std::vector<std::optional<double>> arms_in(const std::string& things, double heading,
                                           std::uint32_t seed = 5) {
  const sim::World world = room(things);
  sim::Scene scene(world);
  scene.add_robot({}, {kRobot.x, kRobot.y, heading}, 1);
  Random random(seed);
  Census census;
  const StereoPicture pair = picture(scene, random);
  const auto [first, last] = torso_rows(pair.rig, pair.rows);
  const DisparityMap& map = census.match(pair.left(), pair.right(), first, last);
  std::vector<std::optional<double>> arms;
  for (const Sight& person : find_people(bands_of(map, pair.rig, pair.rows))) {
    const auto arm = arm_of(person, map, pair.rig, pair.rows);
    arms.push_back(arm ? std::optional(heading + *arm) : std::nullopt);
  }
  return arms;
}

struct Rates {
  int pictures = 0;
  int right = 0;       // the side that she points to
  int wrong = 0;       // the other one
  double worst = 0.0;  // [rad] error of the direction
};

// One person before the robot, at distances and directions, as the robot looks at her.
Rates rates(const std::string& walls, const std::vector<double>& distances,
            const std::vector<double>& angles, double heights) {
  Rates sum;
  for (const double away : distances)
    for (const double angle : angles)
      for (const double heading : {-4.0, 0.0, 4.0}) {
        ++sum.pictures;
        for (const auto& arm : arms_in(walls + "person ann " + at(away, 0.0) + pointing(angle) +
                                           "tall " + millimetres(heights),
                                       radians(heading))) {
          if (!arm)
            continue;
          const double off = std::abs(norm2_angle(*arm - radians(angle)));
          ++(off < radians(90.0) ? sum.right : sum.wrong);
          sum.worst = std::max(sum.worst, off);
        }
      }
  std::cout << sum.right << " of " << sum.pictures << ", wrong side " << sum.wrong << ", worst "
            << degrees(sum.worst) << " degrees\n";
  return sum;
}

TEST(Arms, TheirSideIsSeenInSinglePictures) {
  for (const double tall : {1.6, 1.75, 1.9}) {
    const Rates near = rates("", {1.2, 1.5}, {90.0, -90.0, 60.0, -60.0}, tall);
    EXPECT_EQ(near.wrong, 0) << tall;
    EXPECT_GE(near.right, 0.75 * near.pictures) << tall;
    const Rates far =
        rates("", {2.0, 2.5, 3.0, 3.5}, {90.0, -90.0, 60.0, -60.0, 120.0, -120.0}, tall);
    EXPECT_EQ(far.wrong, 0) << tall;
    EXPECT_GE(far.right, 0.85 * far.pictures) << tall;
    EXPECT_LT(far.worst, radians(20.0)) << tall;
  }
}

TEST(Arms, TheirSideIsSeenBetweenTheWallsOfACorridor) {
  const Rates seen = rates(kCorridor, {1.5, 2.0, 2.5, 3.0, 3.5}, {90.0, -90.0, 70.0, -110.0}, 1.75);
  EXPECT_EQ(seen.wrong, 0);
  EXPECT_GE(seen.right, 0.9 * seen.pictures);
  EXPECT_LT(seen.worst, radians(20.0));
}

// An arm towards the camera or away from it is on no side.
TEST(Arms, AlongTheLineOfSightIsNoSide) {
  for (const double away : {1.5, 2.5, 3.5})
    for (const double angle : {0.0, 20.0, 160.0, 180.0})
      for (const auto& arm : arms_in("person ann " + at(away, 0.0) + pointing(angle), 0.0))
        EXPECT_FALSE(arm) << away << " m, " << angle << " degrees";
}

TEST(Arms, WhoDoesNotPointHasNone) {
  const std::string things[] = {
      "",
      "person ben " + at(2.5, 0.6),
      "person ben " + at(2.2, -0.6) + "tall 1500 person carl " + at(2.8, 0.6) + "tall 1900",
      "person ben " + at(3.2, 0.4),
      "box cupboard " + at(2.6, 0.7) + "10 400 600 50 tall 1400",
      "box cupboard " + at(2.9, -0.6) + "0 300 500 50 tall 1500",
      "post pillar " + at(2.5, 0.5) + "60 tall 2200",
      "post lamp " + at(2.4, -0.6) + "30 tall 1450",
      at(0.0, 0.5) + at(4.0, 0.5),   // a wall beside her
      at(2.5, 0.35) + at(2.5, 2.0),  // a door post
      "door d " + at(2.4, 0.4) + at(2.4, 1.3) + "-90",
      kCorridor,
  };
  int people = 0;
  for (const std::string& each : things)
    for (const double heading : {-8.0, 0.0, 8.0})
      for (const auto& arm : arms_in("person ann " + at(2.5, 0.0) + each, radians(heading))) {
        EXPECT_FALSE(arm) << each << ", heading " << heading;
        ++people;
      }
  EXPECT_GT(people, 25);
}

// By chance: people, posts, boxes and walls of any height at her side.
TEST(Arms, ThingsBesideAPersonAreNone) {
  int people = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    Random random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * random.next() * 0x1p-32;
    };
    const double away = between(1.2, 3.8);
    const double aside = between(-0.4, 0.4);
    std::string things = "person ann " + at(away, aside) + "tall " + millimetres(between(1.6, 1.9));
    for (const char* const name : {"one", "two", "three"}) {
      const double side = between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
      const double x = away + between(-0.5, 1.5);
      const double y = aside + side * between(0.45, 1.3);
      const double what = between(0.0, 1.0);
      const std::string named = std::string(name) + " " + at(x, y);
      if (what < 0.4)
        things += " person " + named + "tall " + millimetres(between(1.2, 1.95));
      else if (what < 0.6)
        things += " post " + named + millimetres(between(0.03, 0.15)) + " tall " +
                  millimetres(between(0.8, 2.2));
      else if (what < 0.85)
        things += " box " + named + std::to_string(std::lround(between(0.0, 90.0))) + " " +
                  millimetres(between(0.2, 0.5)) + " " + millimetres(between(0.2, 0.8)) +
                  " 50 tall " + millimetres(between(0.8, 2.0));
      else
        things += " " + at(x, y) + at(x + between(-0.5, 1.0), y + side * between(0.1, 1.0));
    }
    try {
      for (const auto& arm : arms_in(things, radians(between(-8.0, 8.0)), seed)) {
        EXPECT_FALSE(arm) << things;
        ++people;
      }
    } catch (const FileError&) {
      // A person in a box, or the like.
    }
  }
  std::cout << "people " << people << "\n";
  EXPECT_GT(people, 120);
}

// The whole chain, while the robot turns: an arm is reported after some pictures, and gets old.
TEST(Arms, AreReportedWhileTheyHold) {
  const sim::World world = room("person ann " + at(2.2, 0.3) + "wait 1 point 90 2 wait 100");
  sim::Scene scene(world);
  scene.add_robot({}, kRobot, 1);
  Random random(5);
  Vision vision;
  for (std::uint64_t cycle = 1; cycle <= 60; ++cycle) {
    for (int tick = 0; tick < 10; ++tick)
      scene.tick();
    // Dead reckoning knows the turn, in another frame than the world's.
    const Pose in_odom(0.5, -0.2, radians(30.0 + 0.1 * static_cast<double>(cycle)));
    ASSERT_TRUE(scene.robot(0).place({kRobot.x, kRobot.y, in_odom.th - radians(30.0)}));
    vision.see(picture(scene, random, cycle), in_odom);
    const auto things = vision.things(cycle, in_odom);
    if (cycle < 5)
      continue;
    ASSERT_EQ(things.size(), 1U) << cycle;
    if (cycle <= 12) {
      EXPECT_EQ(things[0].pointed, 0U) << cycle;
    } else if (cycle >= 15 && cycle < 30) {
      EXPECT_EQ(things[0].pointed, cycle);
      EXPECT_NEAR(degrees(things[0].points_in_odom), 120.0, 15.0) << cycle;
    } else if (cycle > 30) {
      EXPECT_LE(things[0].pointed, 30U) << cycle;
    }
  }
}

}  // namespace
}  // namespace saphira::vision
