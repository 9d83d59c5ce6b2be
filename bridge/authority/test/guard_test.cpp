#include "saphira/authority/guard.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saphira/base/random.hpp"

namespace saphira::authority {
namespace {

const Body kPioneer{0.22, 0.4, radians(100.0), 2.0, false};

TEST(Guard, LeavesNormalDrivingAlone) {
  const GuardSettings settings;
  // Boxes at 0.3 m clearance on both sides, a wall 0.5 m ahead of the hull.
  const std::vector<Vec2> points{{0.0, 0.52}, {0.3, -0.52}, {0.2, 0.52}, {0.72, 0.0}};
  const Guarded out = guard(settings, kPioneer, points, 0.3, 0.5);
  EXPECT_EQ(out.action, GuardAction::none);
  EXPECT_DOUBLE_EQ(out.velocity, 0.3);
  EXPECT_DOUBLE_EQ(out.rotation_velocity, 0.5);
  EXPECT_EQ(out.reason, "");
}

TEST(Guard, StopsBeforeWhatIsAhead) {
  const Guarded out = guard({}, kPioneer, {{0.27, 0.0}}, 0.3, 0.4);
  EXPECT_EQ(out.action, GuardAction::stop);
  EXPECT_EQ(out.velocity, 0.0);
  EXPECT_DOUBLE_EQ(out.rotation_velocity, 0.4) << "turning is the way out";
  EXPECT_NE(out.reason.find("0.05 m ahead"), std::string::npos) << out.reason;
}

TEST(Guard, SlowsOnTheApproach) {
  const Guarded out = guard({}, kPioneer, {{0.35, 0.05}}, 0.4, 0.0);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_GT(out.velocity, 0.05);
  EXPECT_LT(out.velocity, 0.4);
}

TEST(Guard, LeavingIsFree) {
  EXPECT_EQ(guard({}, kPioneer, {{-0.23, 0.0}}, 0.3, 0.0).action, GuardAction::none);
  EXPECT_EQ(guard({}, kPioneer, {{0.23, 0.0}}, -0.1, 0.0).action, GuardAction::none);
  EXPECT_EQ(guard({}, kPioneer, {{0.02, 0.225}}, 0.3, 0.0).action, GuardAction::none)
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
  out = guard({}, body, {{-0.25, 0.0}}, -0.3, 0.0);
  EXPECT_EQ(out.action, GuardAction::stop);
}

TEST(Guard, IsSlowWhereNoSonarLooksAhead) {
  Body body = kPioneer;
  body.sees_ahead = false;
  const Guarded out = guard({}, body, {}, 0.3, 0.0);
  EXPECT_EQ(out.action, GuardAction::limit);
  EXPECT_DOUBLE_EQ(out.velocity, 0.15);
  EXPECT_EQ(out.reason, "0.30 m/s cut to 0.15: no sonar looks ahead");
}

TEST(Echoes, KnowWhereSonarsLook) {
  Echoes echoes;
  EXPECT_TRUE(echoes.sees(10, true)) << "they have not had their turn";
  EXPECT_FALSE(echoes.sees(11, true));
  echoes.update(11, {}, {{3, {0.13, 0.0, 0.2}}, {0, {0.1, 0.1, kPi / 2}}});
  EXPECT_TRUE(echoes.sees(21, true));
  EXPECT_FALSE(echoes.sees(22, true));
  EXPECT_FALSE(echoes.sees(21, false));
  echoes.update(30, {{8, {}, {-0.1, 0.0, kPi}, 1.0}}, {});
  EXPECT_TRUE(echoes.sees(30, false));
  EXPECT_FALSE(echoes.sees(30, true));
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

TEST(Guard, SlowZone) {
  GuardSettings settings;
  settings.slow_distance = 0.6;
  const Guarded out = guard(settings, kPioneer, {{0.7, 0.0}}, 0.4, 0.0);
  EXPECT_EQ(out.action, GuardAction::slow);
  EXPECT_DOUBLE_EQ(out.velocity, 0.15);
}

// A robot that obeys at once, with the reaction time and the deceleration that the guard assumes,
// stands before the margin is used up, from any speed and distance.
TEST(Guard, BrakesInTime) {
  Random random(3);
  for (int run = 0; run < 500; ++run) {
    double x = 0.0;
    double v = random.uniform(0.0, 0.4);
    const double wall = 0.22 + 0.06 + random.uniform(0.16, 1.0);
    double seen = wall;  // as of the newest reading, which comes every 0.3 s
    for (int tick = 0; tick < 2000; ++tick) {
      if (tick % 30 == 0)
        seen = wall;
      const double wanted = guard({}, kPioneer, {{seen - x, 0.0}}, 0.4, 0.0).velocity;
      v += std::clamp(wanted - v, -2.0 * 0.01, 0.5 * 0.01);
      x += v * 0.01;
    }
    ASSERT_LT(x + 0.22, wall - 0.05) << run;
    ASSERT_GT(x + 0.22, wall - 0.15) << "stopped needlessly early, run " << run;
  }
}

TEST(Echoes, StayWhereTheyWereWhileTheRobotMoves) {
  Echoes echoes;
  echoes.update(1, {{3, {0, 0, 0}, {0.13, 0, 0}, 1.0}}, {});
  auto points = echoes.seen_from({0.5, 0, 0});
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].x(), 0.63, 1e-12);
  points = echoes.seen_from({0, 0, kPi / 2});
  EXPECT_NEAR(points[0].y(), -1.13, 1e-12);
}

TEST(Echoes, AreForgotten) {
  Echoes echoes;
  echoes.update(1, {{3, {}, {0.13, 0, 0}, 1.0}, {4, {}, {0.13, 0, 0}, 1.0}}, {});
  echoes.update(2, {}, {{3, {}}});
  EXPECT_EQ(echoes.seen_from({}).size(), 2U) << "one dropout";
  echoes.update(3, {}, {{3, {}}});
  EXPECT_EQ(echoes.seen_from({}).size(), 1U);
  echoes.update(11, {}, {});
  EXPECT_EQ(echoes.seen_from({}).size(), 1U);
  echoes.update(12, {}, {});
  EXPECT_EQ(echoes.seen_from({}).size(), 0U) << "too old";
}

// Contact that is meant: slower than stopping would be, and only forward.
TEST(Guard, LetsADriverTouchWhoMeansIt) {
  GuardSettings settings;
  Body body;
  body.radius = 0.22;
  body.deceleration = 2.0;
  body.sees_behind = true;
  const auto at = [&](double distance, double velocity, double contact) {
    return guard(settings, body, {{body.radius + distance, 0.0}, {-body.radius - distance, 0.0}},
                 velocity, 0.0, contact);
  };
  EXPECT_DOUBLE_EQ(at(0.03, 0.2, 0.0).velocity, 0.0) << "nothing is meant";
  EXPECT_DOUBLE_EQ(at(0.03, 0.2, 0.1).velocity, 0.1);
  EXPECT_EQ(at(0.03, 0.2, 0.1).action, GuardAction::slow);
  EXPECT_NE(at(0.03, 0.2, 0.1).reason.find("contact is meant"), std::string::npos);
  EXPECT_DOUBLE_EQ(at(0.0, 0.05, 0.1).velocity, 0.05) << "slower than allowed";
  EXPECT_DOUBLE_EQ(at(0.0, 0.5, 5.0).velocity, settings.max_contact_velocity);
  EXPECT_DOUBLE_EQ(at(0.03, -0.2, 0.1).velocity, 0.0) << "backward nobody looks";
  EXPECT_DOUBLE_EQ(at(0.3, 0.2, 0.1).velocity, at(0.3, 0.2, 0.0).velocity)
      << "far off it makes no difference";
  settings.max_contact_velocity = 0.0;
  EXPECT_DOUBLE_EQ(at(0.03, 0.2, 0.1).velocity, 0.0) << "never, by option";
}

}  // namespace
}  // namespace saphira::authority
