#include "saphira/registration/particle_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saphira::registration {
namespace {

Eigen::Matrix3d covariance(double position, double heading) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  result.diagonal() << position * position, position * position, heading * heading;
  return result;
}

TEST(ParticleCloud, BeginsAsItIsTold) {
  ParticleCloud cloud({.particles = 2000});
  EXPECT_TRUE(cloud.empty());
  cloud.begin({1.0, 2.0, 3.1}, covariance(0.3, radians(8.0)), 0.01, 0.005);
  const auto seen = cloud.estimate();
  EXPECT_NEAR(seen.pose.x, 1.0, 0.03);
  EXPECT_NEAR(seen.pose.y, 2.0, 0.03);
  EXPECT_NEAR(norm2_angle(seen.pose.th - 3.1), 0.0, radians(1.0));
  EXPECT_NEAR(std::sqrt(seen.covariance(0, 0)), 0.3, 0.03);
  EXPECT_NEAR(std::sqrt(seen.covariance(2, 2)), radians(8.0), radians(0.8));
  EXPECT_NEAR(seen.drift, 0.01, 0.001);
}

// A robot goes straight on between two walls 2 m apart, and dead reckoning turns by 3 degrees a
// metre.
TEST(ParticleCloud, HoldsAndLearnsADriftThatNoFilterMayAssume) {
  constexpr double kDrift = radians(3.0);
  ParticleCloud cloud({});
  cloud.begin({}, covariance(0.1, radians(3.0)), 0.0, CloudSettings{}.drift);
  for (int i = 0; i < 400; ++i) {
    cloud.move({0.05, 0.0, kDrift * 0.05});
    if (i % 2 == 0)
      continue;
    for (const double bearing : {kPi / 2, -kPi / 2, kPi / 3, -kPi / 3})
      cloud.weigh({0.1, 0.0, bearing}, [&](const Vec2& sensor, const Vec2& ahead) {
        const double heard = 1.0 / std::abs(std::sin(bearing));
        const double there =
            (ahead.y() > 0.0 ? 1.0 - sensor.y() : 1.0 + sensor.y()) / std::abs(ahead.y());
        const double off = (heard - there) / 0.1;
        return 0.3 * std::max(-0.5 * off * off, -4.0);
      });
    cloud.select();
  }
  const auto seen = cloud.estimate();
  EXPECT_NEAR(seen.pose.y, 0.0, 0.1);
  EXPECT_NEAR(seen.pose.th, 0.0, radians(5.0));
  EXPECT_NEAR(seen.pose.x, 20.0, 1.0);
  EXPECT_NEAR(seen.drift, kDrift, radians(0.7));
}

TEST(ParticleCloud, LearnsWhatAFilterLearnt) {
  ParticleCloud cloud({.particles = 3000});
  const Pose before{5.0, 5.0, 0.0};
  cloud.begin(before, covariance(0.4, radians(5.0)), 0.0, 0.01);
  // A door along x: the filter now knows x to 0.1 m, and y and the heading as before.
  const Eigen::Matrix3d wide = cloud.estimate().covariance;
  Eigen::Matrix3d narrow = wide;
  narrow.row(0).setZero();
  narrow.col(0).setZero();
  narrow(0, 0) = 0.01;
  cloud.learn(before, wide, {5.3, 5.0, 0.0}, narrow);
  const auto seen = cloud.estimate();
  EXPECT_NEAR(seen.pose.x, 5.3, 0.05);
  // The match may be wrong: a few stay where they were.
  EXPECT_NEAR(std::sqrt(seen.covariance(0, 0)), 0.13, 0.04);
  EXPECT_NEAR(std::sqrt(seen.covariance(1, 1)), std::sqrt(wide(1, 1)), 0.05);
}

TEST(ParticleCloud, ARobotThatStandsKeepsIts) {
  ParticleCloud cloud({});
  cloud.begin({}, covariance(0.2, 0.1), 0.0, 0.01);
  const auto before = cloud.estimate();
  cloud.move({});
  EXPECT_EQ(cloud.estimate().pose, before.pose);
  EXPECT_EQ(cloud.estimate().covariance, before.covariance);
}

}  // namespace
}  // namespace saphira::registration
