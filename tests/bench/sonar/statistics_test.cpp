#include "statistics.hpp"

#include <gtest/gtest.h>

#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"
#include "simulated.hpp"

namespace saphira::bench {
namespace {

TEST(Data, IsReadAndMistakesAreNamed) {
  const auto readings =
      parse_calibration(",time,range,sonar1\n0,0.1,0.5,0.51\n1,0.2,0.6,9\n", "sonar1", "c.csv");
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_DOUBLE_EQ(readings[0].truth, 0.5);
  EXPECT_DOUBLE_EQ(readings[0].reading, 0.51);
  try {
    parse_calibration(",range,sonar1\n0,0.5,x\n", "sonar1", "c.csv");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_EQ(error.column(), 7);
  }
  EXPECT_THROW(parse_calibration("range\n", "sonar1", "c.csv"), FileError);

  const auto records = parse_corridor("5 1000 2 3 4 5 6 7 5110\n", "5 100 -200 3595\n", "d");
  ASSERT_EQ(records.size(), 1U);
  EXPECT_DOUBLE_EQ(records[0].pose_in_odom.y, -0.2);
  EXPECT_NEAR(records[0].pose_in_odom.th, radians(-0.5), 1e-12);
  EXPECT_DOUBLE_EQ(records[0].ranges[7], 5.11);
  EXPECT_THROW(parse_corridor("5 1 2 3 4 5 6 7 8\n", "6 0 0 0\n", "d"), FileError);
  EXPECT_THROW(parse_corridor("5 1 2 3 4 5 6 7\n", "5 0 0 0\n", "d"), FileError);
}

TEST(Statistics, FindTheNoiseThatIsThere) {
  Random random(1);
  std::vector<Calibration> readings;
  for (int i = 0; i < 20000; ++i) {
    const double truth = random.uniform(0.0, 3.0);
    double reading = truth + 0.01 + 0.01 * truth + random.normal(0.0, 0.002 + 0.003 * truth);
    if (random.chance(0.1))
      reading = 9.0;
    readings.push_back({truth, reading});
  }
  for (const RangeBin& bin : range_bins(readings)) {
    EXPECT_NEAR(bin.bias, 0.01 + 0.01 * bin.range, 0.002);
    EXPECT_NEAR(bin.deviation, 0.002 + 0.003 * bin.range, 0.001);
    EXPECT_NEAR(bin.outliers, 0.1, 0.02);
  }
}

// Records of a corridor 2 m wide with posts at known places, heard within 10 degrees.
class MadeUpCorridor : public ::testing::Test {
 protected:
  MadeUpCorridor() {
    truth_.right.offset = -1.0;
    truth_.left.offset = 1.0;
    for (const double x : {2.5, 4.0, 5.5, 7.0})
      truth_.posts.emplace_back(x, -1.0);
    truth_.posts.emplace_back(5.0, 1.0);
    for (int i = 1; i < 80; ++i)
      poses_.push_back({{0.1 * i, 0.0, 0.0}, {}});
  }
  Corridor truth_;
  std::vector<CorridorRecord> poses_;
};

TEST_F(MadeUpCorridor, ItsWallsAndPostsAreFound) {
  sim::SonarModel exact;
  exact.noise = exact.relative_noise = exact.dropout = exact.roughness = 0.0;
  const auto records = simulate(poses_, truth_, exact, 1);
  const Corridor found = fit_corridor(straight_part(records));
  EXPECT_NEAR(found.right.offset, -1.0, 0.02);
  EXPECT_NEAR(found.left.offset, 1.0, 0.02);
  ASSERT_EQ(found.posts.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR((found.posts[i] - truth_.posts[i]).norm(), 0.0, 0.08) << i;
  const auto statistics = corridor_statistics(records, found);
  EXPECT_EQ(statistics.side_none, 0.0);
  EXPECT_LT(statistics.side_rms, 0.04);
  EXPECT_LT(statistics.oblique_wall + statistics.oblique_other, 0.05);
  EXPECT_GT(statistics.oblique_post, 0.1);
  EXPECT_NEAR(degrees(statistics.half_width), 10.0, 3.0);
}

TEST_F(MadeUpCorridor, PlainRaysHearTheSmoothWall) {
  const auto statistics = corridor_statistics(simulate(poses_, truth_, plain_rays(), 1), truth_);
  EXPECT_GT(statistics.oblique_wall, 0.3);
}

TEST(Statistics, ARingBesideAWall) {
  std::array<double, kRing> ring{};
  ring.fill(5.0);
  ring[3] = 0.5;
  ring[4] = 0.5 + kRingRadius * (1.0 - std::cos(radians(15.0)));
  ring[5] = (0.5 + kRingRadius * (1.0 - std::cos(radians(30.0)))) / std::cos(radians(30.0));
  const auto statistics = ring_statistics({ring, ring});
  EXPECT_EQ(statistics.rings, 2U);
  EXPECT_DOUBLE_EQ(statistics.beside[0].wall, 1.0);
  EXPECT_DOUBLE_EQ(statistics.beside[1].wall, 0.5);
  EXPECT_DOUBLE_EQ(statistics.beside[1].none, 0.5);
  EXPECT_DOUBLE_EQ(statistics.beside[2].axis, 0.5);
}

}  // namespace
}  // namespace saphira::bench
