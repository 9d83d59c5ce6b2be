#include "saphira/lps/sonar_buffer.hpp"

#include <gtest/gtest.h>

#include "saphira/lps/local_perceptual_space.hpp"

namespace saphira::lps {
namespace {

/// The Pioneer 1's sonars, all at the centre: only their directions count here.
LpsSettings pioneer() {
  LpsSettings settings;
  const double bearings[] = {90, 30, 15, 0, -15, -30, -90};
  for (int i = 0; i < 7; ++i)
    settings.sonars.push_back({i, {0.0, 0.0, radians(bearings[i])}});
  settings.front_buffer = 4;
  settings.side_buffer = 3;
  return settings;
}

std::size_t valid(const SonarBuffer& buffer) {
  std::size_t n = 0;
  for (const SonarEntry& entry : buffer.entries())
    n += entry.valid ? 1 : 0;
  return n;
}

TEST(SonarBuffer, NewReplacesOldest) {
  SonarBuffer buffer(3);
  for (int i = 0; i < 5; ++i)
    buffer.add({static_cast<double>(i), 0.0}, {});
  ASSERT_EQ(buffer.entries().size(), 3U);
  const std::vector<SonarEntry> ordered = buffer.in_order();
  EXPECT_EQ(ordered[0].in_robot.x(), 2.0);
  EXPECT_EQ(ordered[2].in_robot.x(), 4.0);
}

TEST(SonarBuffer, SizeZeroClearsAndKeepsTheLimit) {
  SonarBuffer buffer(3);
  buffer.add({1.0, 0.0}, {});
  buffer.set_limit(0);
  EXPECT_TRUE(buffer.entries().empty());
  EXPECT_EQ(buffer.limit(), 3U);
}

TEST(SonarBuffer, AnotherLimitKeepsTheNewest) {
  SonarBuffer buffer(4);
  for (int i = 0; i < 6; ++i)
    buffer.add({static_cast<double>(i), 0.0}, {});
  buffer.set_limit(2);
  EXPECT_EQ(buffer.in_order().front().in_robot.x(), 4.0);
  buffer.set_limit(3);
  buffer.add({6.0, 0.0}, {});
  buffer.add({7.0, 0.0}, {});
  ASSERT_EQ(buffer.entries().size(), 3U);
  EXPECT_EQ(buffer.in_order().front().in_robot.x(), 5.0);
}

TEST(SonarBuffer, EntriesStayRegistered) {
  SonarBuffer buffer(3);
  buffer.add({2.0, 0.0}, {});
  buffer.move_to({1.0, 0.0, kPi / 2});
  EXPECT_NEAR(buffer.entries()[0].in_robot.x(), 0.0, 1e-12);
  EXPECT_NEAR(buffer.entries()[0].in_robot.y(), -1.0, 1e-12);
}

TEST(Feeds, ByWhereTheSonarLooks) {
  const auto at = [](double bearing) { return feeds({0.0, 0.0, radians(bearing)}); };
  EXPECT_EQ(at(0), Feeds::front);
  EXPECT_EQ(at(-30), Feeds::front);
  EXPECT_EQ(at(60), Feeds::front);
  EXPECT_EQ(at(90), Feeds::left);
  EXPECT_EQ(at(-90), Feeds::right);
  EXPECT_EQ(at(-110), Feeds::right);
  EXPECT_EQ(at(180), Feeds::none);
}

TEST(FrontBuffer, TakesEveryFiring) {
  LocalPerceptualSpace lps(pioneer());
  lps.update({}, {{3, 1.0, true}, {2, 1.0, true}, {3, 5.0, false}}, 1);
  EXPECT_EQ(lps.front().entries().size(), 3U);
  EXPECT_EQ(valid(lps.front()), 2U);
  // Without echoes the buffer is clear after as many firings as its length.
  lps.update({}, {{3, 5.0, false}, {3, 5.0, false}, {3, 5.0, false}, {3, 5.0, false}}, 2);
  EXPECT_EQ(valid(lps.front()), 0U);
}

TEST(FrontBuffer, FartherThanItsRangeIsAMiss) {
  LocalPerceptualSpace lps(pioneer());
  lps.update({}, {{3, 2.6, true}}, 1);
  EXPECT_EQ(lps.front().entries().size(), 1U);
  EXPECT_EQ(valid(lps.front()), 0U);
  lps.set_front_max_range(3.0);
  lps.update({}, {{3, 2.6, true}}, 2);
  EXPECT_EQ(valid(lps.front()), 1U);
}

TEST(SonarBuffers, AreAsLongAsTheyAreSet) {
  LocalPerceptualSpace lps(pioneer());
  lps.set_front_buffer(2);
  lps.set_side_buffer(1);
  lps.update({}, {{3, 1.0, true}, {3, 1.1, true}, {3, 1.2, true}}, 1);
  lps.update({}, {{0, 1.0, true}, {0, 1.1, true}, {6, 1.0, true}, {6, 1.1, true}}, 2);
  EXPECT_EQ(lps.front().entries().size(), 2U);
  EXPECT_EQ(lps.left().entries().size(), 1U);
  EXPECT_EQ(lps.right().entries().size(), 1U);
  // Settings are kept over a reset.
  lps.reset();
  EXPECT_TRUE(lps.front().entries().empty());
  EXPECT_EQ(lps.front().limit(), 2U);
  EXPECT_EQ(lps.left().limit(), 1U);
  EXPECT_EQ(lps.right().limit(), 1U);
}

TEST(SideBuffers, TakeOnlyEchoesOfTheirSide) {
  LocalPerceptualSpace lps(pioneer());
  lps.update({}, {{0, 1.5, true}, {0, 5.0, false}, {6, 0.5, true}}, 1);
  ASSERT_EQ(lps.left().entries().size(), 1U);
  ASSERT_EQ(lps.right().entries().size(), 1U);
  EXPECT_NEAR(lps.left().entries()[0].in_robot.y(), 1.5, 1e-12);
  EXPECT_NEAR(lps.right().entries()[0].in_robot.y(), -0.5, 1e-12);
  EXPECT_TRUE(lps.front().entries().empty());
}

TEST(Lps, ReadingsArePlacedOnTheWayOfTheCycle) {
  LocalPerceptualSpace lps(pioneer());
  lps.update({0.0, 0.0, 0.0}, {}, 1);
  // Half a metre in this cycle; the first of two readings was taken halfway.
  lps.update({0.5, 0.0, 0.0}, {{3, 1.0, true}, {3, 1.0, true}}, 2);
  EXPECT_NEAR(lps.front().entries()[0].in_robot.x(), 0.75, 1e-12);
  EXPECT_NEAR(lps.front().entries()[1].in_robot.x(), 1.0, 1e-12);
}

TEST(Lps, OccupancyBySource) {
  LocalPerceptualSpace lps(pioneer());
  lps.update({}, {{3, 1.0, true}, {0, 0.6, true}}, 1);
  EXPECT_NEAR(lps.plane(Direction::front, Source::front, 0.0, 1.0, 1.0).distance, 1.0, 1e-12);
  EXPECT_EQ(lps.plane(Direction::front, Source::sides, 0.1, 1.0, 1.0).distance, 5.0);
  EXPECT_NEAR(lps.plane(Direction::left, Source::all, 0.1, 1.0, 1.0).distance, 0.6, 1e-12);
  EXPECT_NEAR(lps.box(Axis::sides, 0.0, 0.5, 1.0, 1.0).distance, 0.6, 1e-12);
  EXPECT_NEAR(lps.box(Axis::front, 1.0, 0.0, 1.0, 1.0, Source::remembered).distance, 1.0, 0.1);
}

TEST(Lps, UnknownSonarIsLeftOut) {
  LocalPerceptualSpace lps(pioneer());
  lps.update({}, {{42, 1.0, true}}, 1);
  EXPECT_TRUE(lps.points(Source::all).empty());
  EXPECT_TRUE(lps.obstacles().empty());
}

TEST(Lps, ResetForgets) {
  LpsSettings settings;
  settings.sonars = {{0, {}}};
  LocalPerceptualSpace lps(settings);
  lps.update({5.0, 0.0, 0.0}, {{0, 1.0, true}}, 7);
  lps.reset();
  EXPECT_TRUE(lps.front().entries().empty());
  EXPECT_TRUE(lps.obstacles().empty());
}

}  // namespace
}  // namespace saphira::lps
