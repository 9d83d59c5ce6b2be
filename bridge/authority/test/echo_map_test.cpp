#include "saphira/authority/echo_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "saphira/authority/robot.hpp"

namespace saphira::authority {
namespace {

const Pose kAhead{0.16, 0.0, 0.0};
const Pose kAskew{0.16, 0.03, radians(10.0)};

bool any_near(const std::vector<Vec2>& spots, const Vec2& place, double within = 0.07) {
  return std::any_of(spots.begin(), spots.end(),
                     [&](const Vec2& spot) { return (spot - place).norm() <= within; });
}

Reading echo(const Pose& sonar_in_robot, double range) {
  return {0, sonar_in_robot, range};
}
Reading silence(const Pose& sonar_in_robot) {
  return {0, sonar_in_robot, std::nullopt};
}

TEST(EchoMap, TakesAnEchoForAnArc) {
  EchoMap map;
  map.update(1, {}, {echo(kAskew, 1.0)});
  for (const double off : {-11.0, 0.0, 11.0}) {
    const double bearing = radians(10.0 + off);
    EXPECT_TRUE(any_near(map.spots(), {0.16 + std::cos(bearing), 0.03 + std::sin(bearing)})) << off;
  }
  // So an object straight ahead is in the lane, whichever of the two sonars beside it hears it.
  EXPECT_TRUE(any_near(map.spots(), {1.16, 0.01}));
}

TEST(EchoMap, KeepsSpotsInTheFrameOfDeadReckoning) {
  EchoMap map;
  map.update(1, {}, {echo(kAhead, 1.0)});
  map.update(2, {0.5, 0.0, 0.0}, {});
  EXPECT_TRUE(any_near(map.spots(), {0.66, 0.0}));
  map.update(3, {0.0, 0.0, kPi / 2}, {});
  EXPECT_TRUE(any_near(map.spots(), {0.0, -1.16}));
}

TEST(EchoMap, KnowsWhichSonarHeardASpotAndWhen) {
  EchoMap map;
  map.update(1, {}, {{3, kAhead, 1.0}});
  map.update(2, {}, {{4, kAskew, 2.0}});
  const auto of = [&](const Vec2& spot) {
    const auto found = map.heard(spot);
    return found ? std::to_string(found->sonar) + ", " + std::to_string(found->ago) : "nothing";
  };
  for (const Vec2& spot : map.spots())
    EXPECT_EQ(of(spot), spot.norm() < 1.5 ? "3, 1" : "4, 0");
  EXPECT_EQ(of({0.66, 0.0}), "nothing") << "before the arc";
  EXPECT_EQ(of({0.0, 1.0}), "nothing") << "beside the cone";
  map.update(5, {0.5, 0.0, 0.0}, {{3, kAhead, 0.5}});
  EXPECT_EQ(of({0.66, 0.0}), "3, 0") << "the newest one counts, wherever the robot was then";
  map.clear();
  EXPECT_EQ(of({0.66, 0.0}), "nothing");
}

TEST(EchoMap, LooksThatHearNothingThereDeleteASpot) {
  EchoMap map;
  map.update(1, {}, {echo(kAhead, 1.0)});
  map.update(2, {}, {echo(kAhead, 1.0)});
  map.update(4, {}, {echo(kAhead, 2.0)});
  EXPECT_TRUE(any_near(map.spots(), {1.16, 0.0})) << "one look may have missed it";
  for (std::uint64_t cycle = 7; cycle < 22; cycle += 3)
    map.update(cycle, {}, {echo(kAhead, 2.0)});
  EXPECT_FALSE(any_near(map.spots(), {1.16, 0.0}));
}

TEST(EchoMap, ForgetsNothingAtRestWhereNoBeamLooks) {
  EchoMap map;
  map.update(1, {}, {echo(kAskew, 0.5)});
  for (std::uint64_t cycle = 2; cycle < 3000; ++cycle)
    map.update(cycle, {}, {silence({-0.16, 0.0, kPi})});
  EXPECT_FALSE(map.spots().empty()) << "five minutes later";
  for (std::uint64_t i = 0; i < 100; ++i)
    map.update(3000 + i, {-0.03 * static_cast<double>(i), 0.0, 0.0}, {});
  EXPECT_TRUE(map.spots().empty()) << "three metres off";
}

TEST(EchoMap, AnEchoAtTheDistanceOfAKnownEdgeIsTheEdges) {
  const std::vector<Edge> wall{{{1.16, -2.0}, {1.16, 2.0}}};
  const auto spots = [&](double range, const std::vector<Edge>& edges) {
    EchoMap map;
    map.update(1, {}, {echo(kAhead, range)}, edges);
    EXPECT_NE(map.spots().empty(), map.edges().empty());
    return map.spots().size();
  };
  EXPECT_EQ(spots(1.0, wall), 0U);
  EXPECT_EQ(spots(0.9, wall), 0U) << "the robot's place on its map is not exact";
  EXPECT_GT(spots(0.8, wall), 0U) << "something stands before the wall";
  EXPECT_GT(spots(1.2, wall), 0U) << "the wall is not there";
  EXPECT_GT(spots(1.0, {}), 0U);
  EXPECT_EQ(spots(1.0, {{{1.16, 0.2}, {1.16, 0.2}}}), 0U) << "a door post";
  EXPECT_GT(spots(1.0, {{{0.7, 0.8}, {0.7, 0.8}}}), 0U) << "the beam passes that one";
}

TEST(EchoMap, ABeamThatReachesTheWallFindsNobodyBeforeIt) {
  const std::vector<Edge> wall{{{1.16, -2.0}, {1.16, 2.0}}};
  EchoMap map;
  map.update(1, {}, {echo(kAhead, 0.6)}, wall);
  ASSERT_TRUE(any_near(map.spots(), {0.76, 0.0}));
  for (std::uint64_t cycle = 2; cycle < 8; ++cycle)
    map.update(cycle, {}, {echo(kAhead, 1.0)}, wall);
  EXPECT_FALSE(any_near(map.spots(), {0.76, 0.0}));
}

TEST(EchoMap, SilenceSaysNothingOfWhatIsFar) {
  EchoMap map;
  map.update(1, {}, {echo(kAhead, 1.4)});
  for (std::uint64_t cycle = 2; cycle < 30; ++cycle)
    map.update(cycle, {}, {silence(kAhead)});
  EXPECT_TRUE(any_near(map.spots(), {1.56, 0.0}));
}

TEST(EchoMap, RemembersWhatEntersABlindSector) {
  // Between the sonars at 50 and 90 degrees a P3 hears nothing.
  const Pose at_50{0.114, 0.119, radians(50.0)};
  EchoMap map;
  map.update(1, {}, {echo(at_50, 0.6)});
  map.update(4, {}, {echo(at_50, 0.6)});
  const Vec2 thing(0.114 + 0.6 * std::cos(radians(50.0)), 0.119 + 0.6 * std::sin(radians(50.0)));
  // The robot drives on: the object falls back to 70 degrees, beside the sonar's beam.
  const Pose robot{0.25, 0.0, 0.0};
  for (std::uint64_t cycle = 5; cycle < 40; ++cycle)
    map.update(cycle, robot, {echo(at_50, 2.0)});
  EXPECT_TRUE(any_near(map.spots(), thing - robot.position()));
}

TEST(EchoMap, LeavesOutWhatIsTooFarToMatter) {
  EchoMap map;
  map.update(1, {}, {echo(kAhead, 2.8)});
  EXPECT_TRUE(map.spots().empty());
}

TEST(EchoMap, OfAShortRangeIsFine) {
  for (int i = 0; i < 20; ++i) {
    EchoMap map(0.06);
    const Pose robot{0.013 * i, 0.007 * i, 0.0};
    map.update(1, robot, {echo({0.025, 0.006, radians(10.0)}, 0.03)});
    ASSERT_FALSE(map.spots().empty()) << i;
    EXPECT_TRUE(any_near(map.spots(), {0.055, 0.011}, 0.01)) << i;
  }
}

TEST(EchoMap, KnowsWhereSonarsLook) {
  EchoMap map;
  EXPECT_TRUE(map.sees(10, true)) << "they have not had their turn";
  EXPECT_FALSE(map.sees(11, true));
  map.update(11, {}, {silence({0.13, 0.0, 0.2}), silence({0.1, 0.1, kPi / 2})});
  EXPECT_TRUE(map.sees(21, true));
  EXPECT_FALSE(map.sees(22, true));
  EXPECT_FALSE(map.sees(21, false));
  map.update(30, {}, {echo({-0.1, 0.0, kPi}, 1.0)});
  EXPECT_TRUE(map.sees(30, false));
  EXPECT_FALSE(map.sees(30, true));
}

TEST(Robot, ReadingsOfAPacket) {
  protocol::RobotParameters parameters{.sonars = {{0, {0.1, 0.1, kPi / 2}}, {3, {0.13, 0.0, 0.0}}}};
  const auto readings = readings_of({{3, 1.0, true}, {0, 5.0, false}, {9, 1.0, true}}, parameters);
  ASSERT_EQ(readings.size(), 2U) << "a sonar that no file places is left out";
  EXPECT_EQ(readings[0].sonar, 3);
  EXPECT_EQ(readings[0].range, 1.0);
  EXPECT_EQ(readings[1].sonar_in_robot, (Pose{0.1, 0.1, kPi / 2}));
  EXPECT_FALSE(readings[1].range);
}

TEST(Robot, ReactsAfterHalfARoundOfItsSonars) {
  protocol::RobotParameters parameters;
  parameters.sonars.resize(16);
  parameters.sonar_arrays = 2;
  parameters.sonar_period = 0.04;
  EXPECT_NEAR(body_of(parameters).reaction, 0.36, 1e-9);
}

// The first echo of a person who steps in is believed, however long the space was free.
TEST(EchoMap, BelievesTheFirstEchoInSpaceThatWasFree) {
  EchoMap map;
  for (std::uint64_t cycle = 0; cycle < 100; ++cycle)
    map.update(cycle, {}, {echo(kAhead, 2.4)});
  map.update(100, {}, {echo(kAhead, 0.8)});
  EXPECT_TRUE(any_near(map.spots(), {0.96, 0.0}));
}

}  // namespace
}  // namespace saphira::authority
