#include "saphira/reflector/odometry.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "saphira/base/archive.hpp"
#include "saphira/base/random.hpp"

namespace saphira::reflector {
namespace {

constexpr double kUnit = 0.079e-3;  // m a count, the manual's Pioneer (section 10)

Odometry::Settings settings() {
  return Odometry::Settings{.distance_unit = kUnit, .max_velocity = 0.4};
}

/// The packet of a server for a pose in its own frame.
RawPose raw_of(const Pose& pose) {
  const auto counts = [](double m) {
    return static_cast<std::uint16_t>(static_cast<long long>(std::floor(m / kUnit + 0.5)) & 0x7FFF);
  };
  return {counts(pose.x), counts(pose.y), pose.th};
}

TEST(Odometry, BeginsAtZeroWhereverTheServerIs) {
  Odometry odometry(settings());
  odometry.connect({}, 5);
  EXPECT_TRUE(odometry.update(raw_of({1.0, 2.0, 0.5}), 0.0, 6));
  EXPECT_EQ(odometry.odom(), 5U);
  EXPECT_EQ(odometry.pose_in_odom(), Pose{});
}

// A long drive in all directions: the unwrapped pose follows the true one over many roll-overs.
TEST(Odometry, UnwrapsTheRollOver) {
  Random random(11);
  Odometry odometry(settings());
  Pose truth{0.4, 2.5, 0.3};  // near the roll-over of 32768 counts = 2.59 m
  odometry.connect({}, 1);
  odometry.update(raw_of(truth), 0.0, 2);
  const Pose start = truth;
  double farthest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    truth = compose(truth, {0.04, 0.0, random.uniform(-0.05, 0.052)});
    ASSERT_FALSE(odometry.update(raw_of(truth), 0.1, 2)) << i;
    ASSERT_NEAR(odometry.advance(), 0.04, 3 * kUnit);
    const Pose expected = relative(start, truth);
    ASSERT_NEAR(odometry.pose_in_odom().x, expected.x, 3 * kUnit);
    ASSERT_NEAR(odometry.pose_in_odom().y, expected.y, 3 * kUnit);
    ASSERT_NEAR(norm2_angle(odometry.pose_in_odom().th - expected.th), 0.0, 1e-9);
    farthest = std::max(farthest, std::hypot(expected.x, expected.y));
  }
  EXPECT_GT(farthest, 10.0) << "it never left the first roll-over";
}

TEST(Odometry, BeginsAnewWhereTheHeadingJumps) {
  Odometry odometry({.distance_unit = kUnit, .max_rotation_velocity = 1.0});
  odometry.connect({}, 1);
  odometry.update(raw_of({0.0, 0.0, 3.0}), 0.0, 2);
  EXPECT_FALSE(odometry.update(raw_of({0.0, 0.0, -3.0}), 0.1, 2)) << "0.28 rad";
  EXPECT_TRUE(odometry.update(raw_of({0.0, 0.0, -2.0}), 0.1, 2));
  EXPECT_EQ(odometry.odom(), 2U);
  EXPECT_EQ(odometry.pose_in_odom(), Pose{});
  EXPECT_FALSE(odometry.update(raw_of({0.0, 0.0, -1.0}), 0.5, 3)) << "after a silence";
}

TEST(Odometry, GoesOnAfterAReconnectionNearby) {
  Odometry odometry(settings());
  odometry.connect({}, 1);
  odometry.update(raw_of({0.0, 0.0, 0.0}), 0.0, 9);
  for (int i = 1; i <= 100; ++i)
    odometry.update(raw_of({0.03 * i, 0.0, 0.1}), 0.1, 9);
  const Pose before = odometry.pose_in_odom();
  EXPECT_NEAR(before.x, 3.0, 1e-3);

  Odometry restarted(settings());
  restarted.connect(restored<OdometryMemory>(saved(odometry.memory())), 2);
  EXPECT_FALSE(restarted.update(raw_of({3.05, 0.0, 0.15}), 0.0, 9));
  EXPECT_EQ(restarted.odom(), 1U);
  EXPECT_NEAR(restarted.pose_in_odom().x, 3.05, 1e-3);
  EXPECT_NEAR(restarted.pose_in_odom().th, 0.15, 1e-9);
}

TEST(Odometry, BeginsAnewWhereTheRobotWasCarriedOrSwitchedOff) {
  Odometry odometry(settings());
  odometry.connect({}, 1);
  odometry.update(raw_of({0.1, 0.1, 0.0}), 0.0, 9);
  const OdometryMemory memory = odometry.memory();
  const struct {
    Pose pose;
    bool fresh;
  } cases[] = {{{0.1, 0.1, 0.0}, false}, {{0.35, 0.1, 0.0}, false}, {{0.45, 0.1, 0.0}, true},
               {{0.1, 0.1, 0.3}, false}, {{0.1, 0.1, 0.4}, true},   {{0.0, 0.0, 0.0}, true}};
  for (const auto& c : cases) {
    Odometry again(settings());
    again.connect(memory, 2);
    EXPECT_EQ(again.update(raw_of(c.pose), 0.0, 9), c.fresh) << c.pose.x << " " << c.pose.th;
    EXPECT_EQ(again.odom(), c.fresh ? 2U : 1U);
    if (c.fresh) {
      EXPECT_EQ(again.pose_in_odom(), Pose{});
    }
  }
}

TEST(Odometry, ARobotThatDroveOnWhileItWasNotHeardWasNotCarried) {
  Odometry odometry(settings());
  odometry.connect({}, 1);
  odometry.update(raw_of({0.1, 0.1, 0.0}), 0.0, 9);
  const OdometryMemory memory = odometry.memory();
  const Slack slack{0.5, 0.5};
  const struct {
    Pose pose;
    bool fresh;
  } cases[] = {{{0.75, 0.1, 0.0}, false},
               {{1.0, 0.1, 0.0}, true},
               {{0.1, 0.1, 0.8}, false},
               {{0.1, 0.1, 0.9}, true},
               {{0.0, 0.0, 0.0}, true}};
  for (const auto& c : cases) {
    Odometry again(settings());
    again.connect(memory, 2, slack);
    EXPECT_EQ(again.update(raw_of(c.pose), 0.0, 9), c.fresh) << c.pose.x << " " << c.pose.th;
  }
  Odometry far(settings());
  far.connect(memory, 2, {5.0, 0.0});
  EXPECT_TRUE(far.update(raw_of({0.1 + 0.45 * 32768 * kUnit, 0.1, 0.0}), 0.0, 9))
      << "more than the counters can tell from a way back";
}

TEST(Odometry, AJumpOfTheCountersIsNoMotion) {
  Odometry odometry(settings());
  odometry.connect({}, 1);
  odometry.update(raw_of({1.2, 0.0, 0.0}), 0.0, 9);
  odometry.update(raw_of({1.21, 0.0, 0.0}), 0.1, 9);
  EXPECT_TRUE(odometry.update(raw_of({0.0, 0.0, 0.0}), 0.1, 7));
  EXPECT_EQ(odometry.odom(), 7U);
  EXPECT_EQ(odometry.pose_in_odom(), Pose{});
  // After two seconds without a packet, most of a meter is a motion.
  EXPECT_FALSE(odometry.update(raw_of({0.8, 0.0, 0.0}), 2.0, 8));
}

TEST(Odometry, ImpossibleCountersAreNotRestored) {
  OdometryMemory memory;
  memory.raw.y = 0x8000;
  EXPECT_THROW(restored<OdometryMemory>(saved(memory)), std::runtime_error);
}

}  // namespace
}  // namespace saphira::reflector
