#include "saphira/sim/acoustics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saphira::sim {
namespace {

TEST(Acoustics, TheBeamFallsOffTheAxis) {
  EXPECT_DOUBLE_EQ(beam_loss(0.0), 0.0);
  EXPECT_NEAR(beam_loss(radians(7.5)), 6.3, 1e-9);
  EXPECT_NEAR(beam_loss(radians(-9.5)), (9.8 + 12.9) / 2.0, 1e-9);
  EXPECT_NEAR(beam_loss(radians(90.0)), 60.0, 1e-9);
  EXPECT_GT(beam_loss(radians(170.0)), 60.0);
}

TEST(Acoustics, TheGainMakesUpForThreeMetres) {
  EXPECT_EQ(way_loss(2.9), 0.0);
  EXPECT_NEAR(way_loss(3.0001), 0.0, 0.01);
  EXPECT_NEAR(way_loss(5.0), 20.0 * std::log10(5.0 / 3.0) + 6.6, 1e-9);
}

// The remaining margin of 40 dB on the axis, of rods and bins at 0.3 m and at 3 m.
TEST(Acoustics, RoundThingsScatter) {
  EXPECT_NEAR(40.0 - round_loss(0.015, 0.3), 27.0, 0.5);
  EXPECT_NEAR(40.0 - round_loss(0.015, 3.0), 17.0, 0.5);
  EXPECT_NEAR(40.0 - round_loss(0.05, 0.3), 32.0, 0.5);
  EXPECT_NEAR(40.0 - round_loss(0.15, 3.0), 27.0, 0.5);
  EXPECT_NEAR(round_loss(0.005, 1.0), 23.0, 0.1);  // an edge
}

TEST(Acoustics, NarrowStripsAreWeakerAndWider) {
  EXPECT_DOUBLE_EQ(strip_loss(0.3, 1.0), 0.0);
  EXPECT_NEAR(strip_loss(0.04, 1.0), 6.4, 0.1);
  EXPECT_NEAR(strip_lobe_loss(0.04, 0.0), 0.0, 1e-9);
  EXPECT_NEAR(strip_lobe_loss(0.04, radians(2.5)), 3.9, 0.2);
  EXPECT_TRUE(std::isinf(strip_lobe_loss(0.04, radians(5.0))));
}

TEST(Acoustics, WeakEchoesAreLate) {
  EXPECT_NEAR(lateness(20.0), 0.002, 0.0005);
  EXPECT_NEAR(lateness(6.0), 0.012, 0.0005);
  EXPECT_NEAR(lateness(2.0), 0.027, 0.0005);
  EXPECT_DOUBLE_EQ(lateness(0.0), 0.056);
}

}  // namespace
}  // namespace saphira::sim
