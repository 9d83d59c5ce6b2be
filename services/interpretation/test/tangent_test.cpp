#include "saphira/interpretation/tangent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "saphira/base/random.hpp"

namespace saphira::interpretation {
namespace {

/// The reading of a sonar at `at` that looks to the left, askew by `tilt`, for the wall y = offset
/// + x tan(slope).
Return heard(const Vec2& at, double offset, double slope, double tilt, double noise = 0.0) {
  Return firing;
  firing.sonar = at;
  firing.axis = {-std::sin(tilt), std::cos(tilt)};
  firing.range = std::cos(slope) * (offset + at.x() * std::tan(slope) - at.y()) + noise;
  firing.echo = true;
  firing.travelled = at.x();
  return firing;
}

std::vector<const Return*> all(const std::vector<Return>& firings) {
  std::vector<const Return*> echoes(firings.size());
  std::transform(firings.begin(), firings.end(), echoes.begin(),
                 [](const Return& firing) { return &firing; });
  return echoes;
}

TEST(Tangent, TouchesBothCirclesOnTheSideThatTheSonarsLookTo) {
  const double slope = radians(7.0);
  const auto line =
      tangent(heard({0.0, 0.1}, 1.0, slope, 0.1), heard({0.5, -0.2}, 1.0, slope, 0.2));
  ASSERT_TRUE(line);
  EXPECT_NEAR(std::atan2(line->along().y(), line->along().x()), norm2_angle(slope + kPi), 1e-9);
  EXPECT_NEAR(line->distance({0.0, 1.0}), 0.0, 1e-9);
  EXPECT_NEAR(line->distance({1.0, 1.0 + std::tan(slope)}), 0.0, 1e-9);
}

TEST(Tangent, NoneWhereOneCircleIsInTheOther) {
  EXPECT_FALSE(tangent(heard({0.0, 0.0}, 1.0, 0.0, 0.0), heard({0.1, 0.0}, 2.0, 0.0, 0.0)));
}

// Driving askew, the points on the axes would be off by r (1 - cos tilt): 60 mm here.
TEST(Fit, IsRightForSonarsThatLookAskewAndKnowsHowSureItIs) {
  const double slope = radians(-4.0);
  Random random(1);
  int within = 0;
  int runs = 0;
  for (; runs < 200; ++runs) {
    std::vector<Return> firings;
    firings.reserve(25);
    for (int i = 0; i < 25; ++i)
      firings.push_back(heard({0.08 * i, 0.01 * i}, 1.0, slope, radians(20.0),
                              random.normal(0.0, EchoError{}.noise)));
    const LineFit fit = fit_line(all(firings), {{0.0, 1.0}, 1.0}, {});
    const double heading = std::atan2(-fit.line.along().y(), -fit.line.along().x());
    EXPECT_NEAR(heading, slope, radians(1.5));
    EXPECT_LT(fit.sigma_heading, radians(1.0));
    within += std::abs(heading - slope) < 2.0 * fit.sigma_heading ? 1 : 0;
  }
  EXPECT_GT(within, 0.9 * runs);
}

TEST(Fit, FollowsTheNewestEchoesWhereDeadReckoningHasTurned) {
  std::vector<Return> firings;
  firings.reserve(37);
  // The robot's heading drifts by 3 degrees while it turns by 0.5 rad at x = 2.
  for (int i = 0; i < 25; ++i)
    firings.push_back(heard({0.08 * i, 0.0}, 1.0, 0.0, 0.0));
  for (int i = 0; i < 12; ++i) {
    Return firing =
        heard({2.0 + 0.08 * i, 0.0}, 1.0 - 2.0 * std::tan(radians(3.0)), radians(3.0), 0.0);
    firing.turned = 0.5;
    firings.push_back(firing);
  }
  const LineFit fit = fit_line(all(firings), {{0.0, 1.0}, 1.0}, {});
  const double heading = std::atan2(-fit.line.along().y(), -fit.line.along().x());
  EXPECT_NEAR(heading, radians(3.0), radians(1.5));
  EXPECT_NEAR(heading, radians(3.0), 2.0 * fit.sigma_heading);
}

}  // namespace
}  // namespace saphira::interpretation
