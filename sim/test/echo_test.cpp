// Echoes of thin, round and clothed things.
#include <gtest/gtest.h>

#include <string>

#include "process.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/sonar.hpp"
#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

RobotParameters p3dx() {
  return protocol::load_parameters(test::source("config/robots/p3dx.p"));
}

World world_with(const std::string& what) {
  return parse_world("width 20000 height 20000\n" + what, "w.wld");
}

std::string post(double x, double y, double radius) {
  return "post it " + std::to_string(1000.0 * x) + " " + std::to_string(1000.0 * y) + " " +
         std::to_string(1000.0 * radius) + " ";
}

// The largest whole degree off the axis at which a post is heard, with its surface at this
// distance.
int widest(double radius, double gap, double strength, const std::string& more) {
  WorldScene scene(world_with(post(10.0 + gap + radius, 10.0, radius) + more));
  Sonars sonars(scene, kNobody, one_sonar(), exact(strength), 1);
  int found = -1;
  for (int off = 0; off <= 40; ++off)
    if (sonars.fire(0, {10.0, 10.0, radians(off)}).range)
      found = off;
  return found;
}

TEST(Echo, PostsAreHeardWithinTheMainLobe) {
  EXPECT_NEAR(widest(0.015, 0.3, 40.0, ""), 10, 1);
  EXPECT_NEAR(widest(0.015, 3.0, 40.0, ""), 8, 1);
  EXPECT_NEAR(widest(0.05, 1.0, 40.0, ""), 10, 1);
  EXPECT_NEAR(widest(0.05, 1.0, 40.0, "cloth 8"), 9, 1);
  EXPECT_NEAR(widest(0.15, 0.3, 40.0, ""), 17, 1);  // by the first lobe beside it
  EXPECT_NEAR(widest(0.15, 2.0, 40.0, "cloth 8"), 9, 1);
  EXPECT_GT(widest(0.05, 1.0, 46.0, ""), widest(0.05, 1.0, 37.0, ""));
  EXPECT_EQ(widest(0.015, 1.0, 16.0, ""), -1);
}

// Between two sonars of a P3 ring, straight ahead, no thin object is heard at any distance.
TEST(Echo, StraightAheadOfAP3IsASlot) {
  const RobotParameters parameters = p3dx();
  const auto first_heard = [&](double aside, double strength) {
    WorldScene scene(world_with(post(10.0, 10.0, 0.05)));
    Sonars sonars(scene, kNobody, parameters, exact(strength), 1);
    for (double gap = 3.5; gap > 0.3; gap -= 0.01)
      for (std::uint8_t i = 0; i < 8; ++i)
        if (sonars.fire(i, {10.0 - 0.05 - gap - parameters.radius, 10.0 - aside, 0.0}).range)
          return gap;
    return 0.0;
  };
  for (const double strength : {40.0, 42.0})
    EXPECT_LT(first_heard(0.0, strength), 0.3) << strength;
  EXPECT_GT(first_heard(0.06, 40.0), 1.5);
  EXPECT_GT(first_heard(-0.15, 40.0), 2.5);
}

// A standing person is two legs: heard more and more as the robot comes near, but at a distance
// only by chance.
TEST(Echo, APersonIsTwoLegs) {
  const RobotParameters parameters = p3dx();
  WorldScene scene(world_with("person ann 10000 10000"));
  SonarModel model;
  model.roughness = model.dropout = 0.0;
  model.cloth = 8.0;
  Sonars sonars(scene, kNobody, parameters, model, 1);
  const auto share = [&](double gap, double aside) {
    constexpr int kRings = 1000;
    int heard = 0;
    for (int ring = 0; ring < kRings; ++ring) {
      bool any = false;
      for (std::uint8_t i = 0; i < 8; ++i) {
        const auto echo =
            sonars.fire(i, {10.0 - 0.06 - gap - parameters.radius, 10.0 - aside, 0.0});
        any |= echo.range.has_value();
      }
      heard += any ? 1 : 0;
    }
    return static_cast<double>(heard) / kRings;
  };
  double worst_near = 1.0;
  double worst_far = 1.0;
  for (double aside = -0.25; aside <= 0.25; aside += 0.05) {
    worst_near = std::min(worst_near, share(1.0, aside));
    worst_far = std::min(worst_far, share(3.0, aside));
  }
  EXPECT_GT(worst_near, 0.95);
  EXPECT_LT(worst_far, 0.7);
  EXPECT_GT(worst_far, 0.05);
}

TEST(Echo, ChanceLastsForAThirdOfASecond) {
  WorldScene scene(world_with(post(11.0, 10.0, 0.05)));
  SonarModel model = exact(18.2);  // half of the time
  model.spread = 5.0;
  RobotParameters parameters = one_sonar();
  Sonars sonars(scene, kNobody, parameters, model, 1);
  int heard = 0;
  int changes = 0;
  bool last = false;
  constexpr int kFirings = 10000;
  for (int i = 0; i < kFirings; ++i) {
    const bool now = sonars.fire(0, {10.0, 10.0, radians(5.0)}).range.has_value();
    heard += now ? 1 : 0;
    changes += now != last ? 1 : 0;
    last = now;
  }
  EXPECT_GT(heard, kFirings / 4);
  EXPECT_LT(heard, 3 * kFirings / 4);
  // New every 7.5 firings, and then with the other result half of the time.
  EXPECT_LT(changes, kFirings / 7.5 * 0.6);
  EXPECT_GT(changes, kFirings / 7.5 * 0.3);
}

TEST(Echo, WhoWalksHasALegThatAnswersHalfOfTheTime) {
  WorldScene scene(world_with("person ann 10000 10000 walk 10000 15000 1000"));
  EXPECT_EQ(scene.persons()[0].heading, kPi / 2.0);
  const auto before = shins(scene.persons()[0]);
  EXPECT_NEAR((before[0].disc.centre - Vec2(9.9, 10.0)).norm(), 0.0, 1e-9);  // his left one
  EXPECT_FALSE(before[0].swings || before[1].swings);
  Vec2 stood(0.0, 0.0);
  double most_ahead = 0.0;
  for (int i = 0; i < 300; ++i) {
    scene.tick();
    const Person& person = scene.persons()[0];
    const auto legs = shins(person);
    ASSERT_NE(legs[0].swings, legs[1].swings) << i;
    const Shin& standing = legs[legs[0].swings ? 1 : 0];
    const double moved = (standing.disc.centre - stood).norm();
    EXPECT_TRUE(moved < 1e-9 || moved > 0.1) << moved;  // stands, or is the other one
    stood = standing.disc.centre;
    for (const Shin& leg : legs)
      most_ahead = std::max(most_ahead, leg.disc.centre.y() - person.at.y());
  }
  EXPECT_NEAR(most_ahead, 0.3, 0.02);

  // A swinging leg, however strong its echo.
  const auto swinging = [&](std::uint64_t seed) {
    SonarModel model = exact(60.0);
    model.soft_spread = 5.0;
    const Person& person = scene.persons()[0];
    const auto legs = shins(person);
    const Vec2 leg = legs[legs[0].swings ? 0 : 1].disc.centre;
    const double side = leg.x() < person.at.x() ? -1.0 : 1.0;
    Sonars sonars(scene, kNobody, one_sonar(), model, seed);
    // From his side, so that it hides the other one.
    return sonars.fire(0, {leg.x() + 0.5 * side, leg.y(), side > 0.0 ? kPi : 0.0}).range;
  };
  int heard = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const auto range = swinging(seed);
    heard += range && *range < 0.55 ? 1 : 0;
  }
  EXPECT_NEAR(heard, 500, 60);
}

TEST(Echo, TheWorldSaysHowStrongEchoesAre) {
  SonarPlan plan = world_with("sonar strength 44.5 sonar cloth 9 sonar spread 1").sonar;
  SonarModel model = in_world({}, plan);
  EXPECT_EQ(model.strength, 44.5);
  EXPECT_EQ(model.cloth, 9.0);
  EXPECT_EQ(model.spread, 1.0);
  model = in_world({}, {});
  EXPECT_EQ(model.strength, 40.0);
  EXPECT_EQ(model.cloth, 5.0);

  const World clothed = world_with("person ann 11000 10000 cloth 7  person bob 9000 10000");
  EXPECT_EQ(clothed.movable.persons[0].look.cloth, 7.0);
  Scene scene(clothed);
  Echoes echoes;
  scene.add_echoes({10.0, 10.0}, 5.0, kNobody, 3.0, echoes);
  ASSERT_EQ(echoes.discs.size(), 4U);
  EXPECT_EQ(echoes.discs[0].loss, 7.0);
  EXPECT_EQ(echoes.discs[3].loss, 3.0);
  EXPECT_NE(echoes.discs[0].id, echoes.discs[1].id);
  EXPECT_THROW(world_with("sonar loud 3"), FileError);
  EXPECT_THROW(world_with("cloth 3"), FileError);
}

}  // namespace
}  // namespace saphira::sim
