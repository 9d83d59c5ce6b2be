#include "saphira/authority/guard.hpp"

#include <gtest/gtest.h>

#include "saphira/base/age.hpp"
#include "saphira/base/random.hpp"

namespace saphira::authority {
namespace {

const Body kPioneer{0.22, 0.4, radians(100.0), 2.0};

TEST(Guard, LeavesNormalDrivingAlone) {
  const GuardSettings settings;
  // Boxes at 0.3 m clearance on both sides, a wall 0.65 m ahead of the hull.
  const std::vector<Vec2> points{{0.0, 0.52}, {0.3, -0.52}, {0.2, 0.52}, {0.87, 0.0}};
  const Guarded out = guard(settings, kPioneer, points, 0.3, 0.5);
  EXPECT_EQ(out.action, GuardAction::none);
  EXPECT_DOUBLE_EQ(out.velocity, 0.3);
  EXPECT_DOUBLE_EQ(out.rotation_velocity, 0.5);
  EXPECT_EQ(out.reason, "");
}

TEST(Guard, StopsBeforeWhatIsAhead) {
  const Guarded out = guard({}, kPioneer, {{0.45, 0.0}}, 0.3, 0.4);
  EXPECT_EQ(out.action, GuardAction::stop);
  EXPECT_EQ(out.velocity, 0.0);
  EXPECT_DOUBLE_EQ(out.rotation_velocity, 0.4) << "turning is the way out";
  EXPECT_EQ(out.reason, "something 0.23 m ahead; it lets go beyond 0.26 m");
  EXPECT_EQ(out.obstacle, Vec2(0.45, 0.0));
}

TEST(Guard, SlowsOnTheApproach) {
  const Guarded out = guard({}, kPioneer, {{0.7, 0.05}}, 0.4, 0.0);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_GT(out.velocity, 0.05);
  EXPECT_LT(out.velocity, 0.4);
}

TEST(Guard, LeavingIsFree) {
  EXPECT_EQ(guard({}, kPioneer, {{-0.23, 0.0}}, 0.3, 0.0).action, GuardAction::none);
  EXPECT_EQ(guard({}, kPioneer, {{0.23, 0.0}}, -0.1, 0.0).action, GuardAction::none);
  EXPECT_EQ(guard({}, kPioneer, {}, 0.3, 0.0, 0.0, 0.0, {{-0.02, 0.225}}).action, GuardAction::none)
      << "along a wall";
}

TEST(Guard, IsBlindBehindSoItIsSlowThere) {
  Guarded out = guard({}, kPioneer, {}, -0.3, 0.0);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_DOUBLE_EQ(out.velocity, -0.15);
  Body body = kPioneer;
  body.sees_behind = true;
  out = guard({}, body, {}, -0.3, 0.0);
  EXPECT_DOUBLE_EQ(out.velocity, -0.3);
  out = guard({}, body, {{-0.40, 0.0}}, -0.3, 0.0);
  EXPECT_EQ(out.action, GuardAction::stop);
  EXPECT_EQ(out.reason, "something 0.18 m behind; it lets go beyond 0.26 m");
}

TEST(Guard, IsSlowWhereNoSonarLooksAhead) {
  Body body = kPioneer;
  body.sees_ahead = false;
  const Guarded out = guard({}, body, {}, 0.3, 0.0);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_DOUBLE_EQ(out.velocity, 0.15);
  EXPECT_EQ(out.reason, "0.30 m/s cut to 0.15: no sonar looks ahead");
}

TEST(Guard, LimitsToTheRobotAndTheRole) {
  GuardSettings settings;
  Guarded out = guard(settings, kPioneer, {}, 2.0, -5.0);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_DOUBLE_EQ(out.velocity, 0.4);
  EXPECT_DOUBLE_EQ(out.rotation_velocity, -radians(100.0));
  settings.max_velocity = 0.2;
  settings.max_rotation_velocity = 0.3;
  out = guard(settings, kPioneer, {}, -2.0, 5.0);
  EXPECT_DOUBLE_EQ(out.velocity, -0.15);
  EXPECT_DOUBLE_EQ(out.rotation_velocity, 0.3);
  settings.enabled = false;
  EXPECT_DOUBLE_EQ(guard(settings, kPioneer, {{0.2, 0.0}}, 2.0, 0.0).velocity, 2.0);
}

TEST(Guard, ApproachesSlowlyWhereAPersonMayReachIntoThePath) {
  // A shin 12 cm beside the path: the person is wider than the shin.
  const Vec2 shin(0.15, 0.32);
  const Guarded out = guard({}, kPioneer, {shin}, 0.4, 0.0);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_NEAR(out.velocity * shin.x() / shin.norm(), GuardSettings{}.anything.touch_velocity, 1e-9)
      << "towards it";
  EXPECT_NE(out.reason.find("beside the path"), std::string::npos) << out.reason;
  EXPECT_EQ(guard({}, kPioneer, {{0.15, 0.66}}, 0.4, 0.0).action, GuardAction::none);
  EXPECT_EQ(guard({}, kPioneer, {{-0.05, 0.34}}, 0.4, 0.0).action, GuardAction::none) << "passed";
}

TEST(Guard, DoesNotCreepIntoWhatIsHeardAtAnyAngle) {
  Body body = kPioneer;
  body.sees_behind = true;
  for (const double bearing : {0.0, 30.0, 60.0, 83.0, 89.0}) {
    const Vec2 way(std::cos(radians(bearing)), std::sin(radians(bearing)));
    const Vec2 near = 0.31 * way;
    EXPECT_EQ(guard({}, body, {near}, 0.1, 0.0).velocity, 0.0) << bearing;
    EXPECT_EQ(guard({}, body, {-near}, -0.1, 0.0).velocity, 0.0) << bearing << " behind";
    EXPECT_EQ(guard({}, body, {-near}, 0.1, 0.0).action, GuardAction::none) << bearing << " left";
    EXPECT_EQ(guard({}, body, {near}, 0.0, 0.5).rotation_velocity, 0.5) << "turning is the way out";
  }
}

TEST(Guard, PassesEdgesOfTheMapCloserThanPeople) {
  // The posts of a door, 13 cm beside the hull on both sides.
  const std::vector<Vec2> posts{{0.2, 0.35}, {0.2, -0.35}};
  Body body = kPioneer;
  body.knows_edges = true;
  EXPECT_LT(guard({}, body, posts, 0.3, 0.0).velocity, 0.03);
  EXPECT_GT(guard({}, body, {}, 0.3, 0.0, 0.0, 0.0, posts).velocity, 0.06);
  EXPECT_GT(guard({}, kPioneer, posts, 0.3, 0.0).velocity, 0.06) << "without a map";
  EXPECT_EQ(guard({}, kPioneer, {}, 0.3, 0.0, 0.0, 0.0, {{0.45, 0.0}}).velocity, 0.0)
      << "ahead it is a wall";
}

TEST(Guard, KeepsAPersonsReach) {
  Body body = kPioneer;
  body.knows_edges = true;
  for (const double bearing : {0.0, 30.0, 60.0, 70.0}) {
    const Vec2 way(std::cos(radians(bearing)), std::sin(radians(bearing)));
    EXPECT_EQ(guard({}, body, {0.46 * way}, 0.3, 0.0).velocity, 0.0) << bearing;
    EXPECT_EQ(guard({}, body, {-0.46 * way}, 0.3, 0.0).action, GuardAction::none) << bearing;
  }
  // The path passes at 23 cm.
  const Vec2 abreast(0.1, 0.45);
  const double past = guard({}, body, {abreast}, 0.3, 0.0).velocity;
  EXPECT_NEAR(past * abreast.x() / abreast.norm(), GuardSettings{}.person.touch_velocity, 1e-9);
}

// A wide person reaches 24 cm beyond the echo of the shin. The place of an echo is off by up to 3
// cm.
TEST(Guard, DoesNotConvergeOnAPersonWithinTheErrorOfTheEcho) {
  Body body = kPioneer;
  body.knows_edges = true;
  const GuardSettings settings;
  const Vec2 shin(0.10, 0.485);  // the path passes it at 26.5 cm
  const double past = guard(settings, body, {shin}, 0.3, 0.0).velocity;
  EXPECT_NEAR(past * shin.x() / shin.norm(), settings.person.touch_velocity, 1e-9);
  EXPECT_EQ(guard(settings, body, {{0.15, 0.51}}, 0.3, 0.0).action, GuardAction::none)
      << "at 29 cm";
  // Along a cupboard the hull comes no nearer than it is.
  std::vector<Vec2> side;
  for (double x = -0.5; x < 0.8; x += 0.05)
    side.emplace_back(x, 0.49);
  EXPECT_DOUBLE_EQ(guard(settings, body, side, 0.15, 0.0).velocity, 0.15);
}

TEST(Guard, LeavesAPersonUntouched) {
  Random random(7);
  Body body = kPioneer;
  body.knows_edges = true;
  const double least = body.radius + GuardSettings{}.person.least;
  for (int run = 0; run < 100; ++run) {
    const Vec2 shin(random.uniform(0.8, 2.0), random.uniform(-0.6, 0.6));
    double x = 0.0;
    double v = random.uniform(0.0, 0.4);
    double command = v;
    for (int tick = 0; tick < 3000; ++tick) {
      if (tick % 10 == 0)
        command = guard({}, body, {{shin.x() - x, shin.y()}}, 0.4, 0.0).velocity;
      v += std::clamp(command - v, -body.deceleration * 0.01, 0.5 * 0.01);
      x += v * 0.01;
      ASSERT_GT(std::hypot(shin.x() - x, shin.y()), least - 0.002) << run;
    }
  }
}

// An object that reaches 0.14 m beyond its echo is never touched faster than allowed, at any place
// and from any speed of the robot.
TEST(Guard, TouchesNobodyFasterThanAllowed) {
  Random random(5);
  for (int run = 0; run < 50; ++run) {
    const Vec2 shin(random.uniform(0.8, 2.0), random.uniform(-0.5, 0.5));
    Body body = kPioneer;
    body.deceleration = random.uniform(0.3, 2.0);
    double x = 0.0;
    double v = random.uniform(0.0, 0.4);
    double command = v;
    for (int tick = 0; tick < 3000; ++tick) {
      if (tick % 10 == 0)
        command = guard({}, body, {{shin.x() - x, shin.y()}}, 0.4, 0.0).velocity;
      v += std::clamp(command - v, -body.deceleration * 0.01, 0.5 * 0.01);
      x += v * 0.01;
      const Vec2 way(shin.x() - x, shin.y());
      if (way.norm() - body.radius < 0.14) {
        ASSERT_LE(v * way.x() / way.norm(), GuardSettings{}.anything.touch_velocity + 1e-4)
            << run << ": " << shin.transpose();
      }
    }
  }
}

TEST(Guard, TakesNoMoreForFreeThanSonarsCanHear) {
  Body slow_brakes = kPioneer;
  slow_brakes.max_velocity = 2.0;
  slow_brakes.deceleration = 0.3;
  const Guarded out = guard({}, slow_brakes, {}, 1.5, 0.0);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_NEAR(out.velocity, approach_speed(1.25, 0.0, 0.3, 0.3), 1e-9);
  EXPECT_LT(out.velocity * 0.3 + out.velocity * out.velocity / 0.6, 1.2501);
  // The sonars of a Khepera have a range of 60 mm.
  const Body khepera{0.028, 0.4, 3.0, 2.0, 0.36, 0.06};
  const double v = guard({}, khepera, {}, 0.4, 0.0).velocity;
  EXPECT_GT(v, 0.05);
  EXPECT_LT(v * 0.36 + v * v / 4.0, 0.06);
}

TEST(Guard, LooksWhereTheRobotTurnsTo) {
  const std::vector<Vec2> points{{0.4, 0.36}};
  const double straight = guard({}, kPioneer, points, 0.4, 0.0, 0.0).velocity;
  EXPECT_LT(guard({}, kPioneer, points, 0.4, 1.5, 1.5).velocity, 0.5 * straight);
}

TEST(Guard, SlowZone) {
  GuardSettings settings{.slow_distance = 0.9};
  const Guarded out = guard(settings, kPioneer, {{1.0, 0.0}}, 0.4, 0.0);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_DOUBLE_EQ(out.velocity, 0.15);
}

// A robot that obeys at once, with the reaction time and the deceleration that the guard assumes,
// stops before the margin is used up, from any speed and distance.
TEST(Guard, BrakesInTime) {
  Random random(3);
  for (int run = 0; run < 500; ++run) {
    double x = 0.0;
    double v = random.uniform(0.0, 0.4);
    const double wall = 0.22 + 0.25 + random.uniform(0.16, 1.0);
    double seen = wall;  // by the newest reading, which comes every 0.3 s
    for (int tick = 0; tick < 2000; ++tick) {
      if (tick % 30 == 0)
        seen = wall;
      const double wanted = guard({}, kPioneer, {{seen - x, 0.0}}, 0.4, 0.0).velocity;
      v += std::clamp(wanted - v, -2.0 * 0.01, 0.5 * 0.01);
      x += v * 0.01;
    }
    ASSERT_LT(x + 0.22, wall - 0.24) << run;
    ASSERT_GT(x + 0.22, wall - 0.34) << "stopped needlessly early, run " << run;
  }
}

// Wanted contact: slower than a stop would need, and only forward.
TEST(Guard, LetsADriverTouchWhoMeansIt) {
  GuardSettings settings;
  Body body{.radius = 0.22, .deceleration = 2.0, .sees_behind = true};
  const auto at = [&](double distance, double velocity, double contact) {
    return guard(settings, body, {{body.radius + distance, 0.0}, {-body.radius - distance, 0.0}},
                 velocity, 0.0, 0.0, contact);
  };
  EXPECT_DOUBLE_EQ(at(0.03, 0.2, 0.0).velocity, 0.0) << "nothing is meant";
  EXPECT_DOUBLE_EQ(at(0.03, 0.2, 0.1).velocity, 0.1);
  EXPECT_EQ(at(0.03, 0.2, 0.1).action, GuardAction::slow);
  EXPECT_NE(at(0.03, 0.2, 0.1).reason.find("contact is meant"), std::string::npos);
  EXPECT_DOUBLE_EQ(at(0.0, 0.05, 0.1).velocity, 0.05) << "slower than allowed";
  EXPECT_DOUBLE_EQ(at(0.0, 0.5, 5.0).velocity, settings.max_contact_velocity);
  EXPECT_DOUBLE_EQ(at(0.03, -0.2, 0.1).velocity, 0.0) << "backward nobody looks";
  EXPECT_DOUBLE_EQ(at(0.6, 0.2, 0.1).velocity, at(0.6, 0.2, 0.0).velocity)
      << "far off it makes no difference";
  settings.max_contact_velocity = 0.0;
  EXPECT_DOUBLE_EQ(at(0.03, 0.2, 0.1).velocity, 0.0) << "never, by option";
}

Guarded wanted(double velocity) {
  return {velocity, 0.5, GuardAction::none, {}};
}

TEST(SlowForAge, AFreshCommandPassesAsItIs) {
  for (const double velocity : {0.0, 0.4, -0.2, 2.0}) {
    const Guarded out = slow_for_age(wanted(velocity), 0.1, 0.1);
    EXPECT_EQ(out.velocity, velocity);
    EXPECT_EQ(out.action, GuardAction::none);
  }
}

TEST(SlowForAge, TheOlderTheSlowerAheadAndBack) {
  double before = 10.0;
  for (double age = 0.3; age < 3.0; age += 0.1) {
    const Guarded out = slow_for_age(wanted(2.0), age, 0.1);
    EXPECT_LT(out.velocity, before);
    EXPECT_NEAR(out.velocity * (age - 0.1), kUnseenWay, 1e-9);
    EXPECT_EQ(out.rotation_velocity, 0.5);
    EXPECT_EQ(slow_for_age(wanted(-2.0), age, 0.1).velocity, -out.velocity);
    before = out.velocity;
  }
  EXPECT_EQ(slow_for_age(wanted(0.4), 4.0, 0.1).velocity, 0.0);
}

TEST(SlowForAge, SaysHowOldTheCommandIs) {
  const Guarded out = slow_for_age(wanted(0.4), 0.6, 0.1);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_EQ(out.reason, "0.40 m/s cut to 0.30: the command answers the robot's state of 0.6 s ago");
}

TEST(SlowForAge, WhatTheGuardSaysStands) {
  Guarded guarded = wanted(0.35);
  guarded.action = GuardAction::slow;
  guarded.reason = "something ahead";
  const Guarded out = slow_for_age(guarded, 0.6, 0.1);
  EXPECT_NEAR(out.velocity, 0.3, 1e-9);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_EQ(out.reason, "something ahead");
}

}  // namespace
}  // namespace saphira::authority
