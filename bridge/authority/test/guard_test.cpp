#include "saphira/authority/guard.hpp"

#include <gtest/gtest.h>

#include "lines.hpp"
#include "saphira/base/age.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/random.hpp"

namespace saphira::authority {
namespace {

const Body kPioneer{0.22, 0.4, radians(100.0), 2.0};

/// The cases of guard.txt.
class Guards : public test::LinePlayer {
 public:
  Guards() {
    events_ = {
      ON("points", points_ = places(in)),
      ON("edges", edges_ = places(in)),
      {"body",
       [this](auto& in) {
         const auto name = read<std::string>(in);
         const auto value = read<double>(in);
         if (name.starts_with("max"))
           (name == "max_velocity" ? body_.max_velocity : body_.max_rotation_velocity) = value;
         else
           body_.*kSenses().at(name) = value != 0.0;
       }},
      {"setting",
       [this](auto& in) {
         const auto name = read<std::string>(in);
         if (name == "enabled")
           settings_.enabled = read<bool>(in);
         else
           settings_.*kSettings().at(name) = read<double>(in);
       }},
      {"drive",
       [this](auto& in) {
         double wanted[4] = {};
         for (double& one : wanted)
           in >> one;
         guarded_ =
             guard(settings_, body_, points_, wanted[0], wanted[1], wanted[2], wanted[3], edges_);
       }},
      ON("late", const auto velocity = read<double>(in);
         guarded_ = slow_for_age({velocity, 0.5, GuardAction::none, {}}, read<double>(in), 0.1)),
      ON("says", expect_like(guarded_.reason, rest(in)))
    };
    values_ = {IS("velocity", guarded_.velocity), IS("turn", guarded_.rotation_velocity),
               IS("towards", guarded_.velocity * points_.at(0).x() / points_.at(0).norm())};
    facts_ = {IS("action", kActions[static_cast<int>(guarded_.action)]),
              IS("reason", guarded_.reason),
              IS("silent", yes(guarded_.reason.empty())),
              {"obstacle", [this] {
                 const Vec2 at = guarded_.obstacle.value();
                 return format("%.2f %.2f", at.x(), at.y());
               }}};
  }

 private:
  static constexpr const char* kActions[]{"none", "limit", "slow", "stop"};
  static const std::map<std::string, bool Body::*>& kSenses() {
    static const std::map<std::string, bool Body::*> all{{"sees_behind", &Body::sees_behind},
                                                         {"sees_ahead", &Body::sees_ahead},
                                                         {"knows_edges", &Body::knows_edges}};
    return all;
  }
  static const std::map<std::string, double GuardSettings::*>& kSettings() {
    static const std::map<std::string, double GuardSettings::*> all{
        {"max_velocity", &GuardSettings::max_velocity},
        {"max_rotation_velocity", &GuardSettings::max_rotation_velocity},
        {"max_contact_velocity", &GuardSettings::max_contact_velocity},
        {"slow_distance", &GuardSettings::slow_distance}};
    return all;
  }
  /// Of "0.2 0.35, 0.2 -0.35".
  static std::vector<Vec2> places(std::istringstream& in) {
    std::vector<Vec2> all;
    double x = 0.0;
    double y = 0.0;
    for (char comma = ','; comma == ',' && in >> x >> y;) {
      all.emplace_back(x, y);
      if (!(in >> comma))
        break;
    }
    return all;
  }
  Body body_ = kPioneer;
  GuardSettings settings_;
  std::vector<Vec2> points_;
  std::vector<Vec2> edges_;
  Guarded guarded_;
};

TEST(Guard, DoesAsWritten) {
  EXPECT_EQ(test::play<Guards>("bridge/authority/test/guard.txt"), 14);
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

Guarded wanted(double velocity) {
  return {velocity, 0.5, GuardAction::none, {}};
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
