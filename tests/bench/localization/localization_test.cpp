#include <gtest/gtest.h>

#include "localization/patrol.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/random.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/maps/topology.hpp"
#include "support/quantile.hpp"

namespace saphira::test {
namespace {

using Output = registration::Core::Outputs;
using registration::Core;

maps::Map office() {
  return maps::load_map(config_folder() + "/maps/office-floor.map");
}

DriveOptions doubled(std::uint64_t seed) {
  return DriveOptions{.seed = seed, .errors = 2.0};
}

/// The robot's start, facing south.
const Pose kStart{17.5, 14.0, -kPi / 2};

/// With registration on the map of the office, from the true start on.
DriveOptions on_office(DriveOptions options) {
  return registered_on(office(), std::move(options));
}

TEST(Localization, OnPatrolThePoseStaysWithinAHandOfTheTruth) {
  Drive robot(on_office(doubled(1)));
  const PatrolResult result = patrol(robot, office_tour(), 9000);
  EXPECT_GT(result.way, 200.0);
  EXPECT_EQ(result.not_tracking, 0);
  EXPECT_LT(quantile(result.registered.position, 0.95), 0.3);
  EXPECT_LT(quantile(result.registered.heading, 0.95), radians(5.0));
  EXPECT_GT(quantile(result.reckoned.position, 0.95), 1.0);
}

TEST(Localization, DeadReckoningThatTurnsByAConstantTooMuchDoesNotLoseIt) {
  // As much as that of the robot of a public log (Intel Research Lab).
  for (const double turn : {radians(3.4), radians(-3.4)}) {
    DriveOptions options = on_office(doubled(4));
    options.bend = turn;
    Drive robot(options);
    const PatrolResult result = patrol(robot, office_tour(), 4500);
    EXPECT_GT(result.way, 100.0);
    EXPECT_LT(result.not_tracking, 450);
    EXPECT_LT(quantile(result.registered.position, 0.95), 0.5);
    EXPECT_LT((robot.believed().position() - robot.truth().position()).norm(), 0.5);
  }
}

TEST(Localization, AWrongInitialPoseIsCorrected) {
  Random random(5);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const double way = random.uniform(-kPi, kPi);
    const Pose wrong{kStart.x + 0.5 * std::cos(way), kStart.y + 0.5 * std::sin(way),
                     kStart.th + radians(seed % 2 == 0 ? 15.0 : -15.0)};
    DriveOptions options = registered_on(office(), doubled(seed), false);
    options.registration->start = wrong;
    Drive robot(options);
    const PatrolResult result = patrol(robot, office_tour(), 1800);
    // The worst error is detected and corrected: the robot reports that it is lost meanwhile.
    EXPECT_LT(result.not_tracking, 300) << "seed " << seed;
    EXPECT_LT(quantile(result.registered.position, 0.5), 0.2) << "seed " << seed;
    EXPECT_LT((robot.believed().position() - robot.truth().position()).norm(), 0.4)
        << "seed " << seed;
  }
}

TEST(Localization, WithoutAPoseItFindsItAndSaysNothingBefore) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    DriveOptions options = doubled(seed);
    std::vector<Vec2> points = office_tour();
    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(4 * seed),
                points.end());
    const Vec2 ahead = points[1] - points[0];
    options.start_in_world = Pose{points[0].x(), points[0].y(), std::atan2(ahead.y(), ahead.x())};
    points.erase(points.begin());
    Drive robot(registered_on(office(), options, false));
    EXPECT_EQ(robot.registered().state, v1::REGISTRATION_UNPLACED);
    Tour tour(points, true);
    bool found = false;
    for (int i = 0; i < 3000; ++i) {
      tour.act(robot, robot.truth());
      robot.advance();
      if (robot.registered().state == v1::REGISTRATION_TRACKING) {
        found = true;
        ASSERT_LT((robot.believed().position() - robot.truth().position()).norm(), 0.5)
            << "seed " << seed << " cycle " << i;
      }
    }
    EXPECT_TRUE(found) << "seed " << seed;
    EXPECT_EQ(robot.registered().state, v1::REGISTRATION_TRACKING);
  }
}

TEST(Localization, WhoIsCarriedAwaySaysThatHeIsLostAndFindsHimselfAgain) {
  Drive robot(on_office(doubled(1)));
  patrol(robot, office_tour(), 1200);
  ASSERT_EQ(robot.registered().state, v1::REGISTRATION_TRACKING);
  ASSERT_TRUE(robot.robot().place({25.6, 12.0, kPi / 2}));
  Tour tour({{25.6, 24.0}, {24.0, 25.0}, {17.5, 25.0}, {17.5, 9.0}}, true);
  bool lost = false;
  for (int i = 0; i < 1800; ++i) {
    tour.act(robot, robot.truth());
    robot.advance();
    lost = robot.registered().state == v1::REGISTRATION_LOST || lost;
  }
  EXPECT_TRUE(lost);
  EXPECT_EQ(robot.registered().state, v1::REGISTRATION_TRACKING);
  EXPECT_LT((robot.believed().position() - robot.truth().position()).norm(), 0.3);
}

TEST(Localization, PeopleClosedDoorsAndBoxesDoNotMisleadIt) {
  DriveOptions options = doubled(2);
  options.world =
      office_with("busy",
                  "person bob 17000 20000\n"
                  "  walk 17000 9000 900  wait 3  walk 17000 22000 900  wait 3  repeat\n"
                  "person ann 25100 11000\n"
                  "  walk 25100 22000 700  wait 5  walk 25100 11000 700  repeat\n"
                  "door a 16500 13100 16500 14000 90\n"
                  "door b 18500 16300 18500 17200 -90\n"
                  "door c 26600 12800 26600 11900 90\n"
                  "door d 16600 6000 15700 6000 90\n"
                  "door e 21800 6000 20900 6000 90\n"
                  "box crate 26300 19000 20 400 400 50\n"
                  "box chest 18200 10000 0 350 700 50\n");
  maps::Map map = office();
  // The map has an object that is no longer there.
  maps::Feature moved;
  moved.type = lps::PointType::object;
  moved.id = 9000;
  moved.pose_in_map = {18.2, 15.4, 0.0};
  moved.length = 0.4;
  moved.width = 0.6;
  map.features.push_back(moved);
  Drive robot(registered_on(map, options));
  const PatrolResult result = patrol(robot, office_tour(), 6000);
  EXPECT_GT(result.reached, 10U);
  EXPECT_EQ(result.not_tracking, 0);
  EXPECT_LT(quantile(result.registered.position, 0.95), 0.3);
}

// A cupboard, a printer and a water cooler stand in the corridors that the map does not have.
TEST(Localization, NothingIsMissedThatIsThereAndNothingPutWhereNothingStands) {
  DriveOptions options = on_office(doubled(1));
  options.registration->add_features = true;
  Drive robot(options);
  Tour tour(office_tour(), true);
  for (int i = 0; i < 6000; ++i) {
    tour.act(robot, i == 0 ? robot.truth() : robot.believed());
    robot.advance();
    for (const std::uint32_t door : robot.registered().closed_doors)
      ADD_FAILURE() << "door " << door << " is open, in cycle " << i;
  }
  const maps::Map& map = robot.registration().map();
  EXPECT_EQ(std::count_if(map.features.begin(), map.features.end(),
                          [](const maps::Feature& feature) { return !feature.learned; }),
            static_cast<std::ptrdiff_t>(office().features.size()))
      << "nothing of the map is gone";
  std::size_t found = 0;
  for (const maps::Feature& feature : map.features) {
    if (feature.type != lps::PointType::object || !feature.learned)
      continue;
    ++found;
    double nearest = 10.0;
    for (const Vec2& thing : {Vec2(20.6, 24.25), Vec2(11.5, 7.7), Vec2(26.4, 14.2)})
      nearest = std::min(nearest, maps::distance_to(feature, thing));
    EXPECT_LT(nearest, 0.5) << maps::to_text({{feature}});
  }
  EXPECT_GE(found, 2U);
}

TEST(Localization, AMapThatIsPartlyWrongDoesNotLoseIt) {
  maps::Map map = office();
  // Every fourth door is forgotten, some stand half a metre off, and a corridor is 15 cm too wide.
  std::size_t doors = 0;
  maps::Map wrong;
  for (maps::Feature feature : map.features) {
    if (feature.type == lps::PointType::door) {
      ++doors;
      if (doors % 4 == 0)
        continue;
      if (doors % 7 == 0)
        feature.pose_in_map.x += feature.pose_in_map.y < 8.0 ? 0.5 : 0.0;
    }
    if (feature.id == 4)
      feature.width += 0.15;
    wrong.features.push_back(feature);
  }
  Drive robot(registered_on(wrong, doubled(4)));
  const PatrolResult result = patrol(robot, office_tour(), 6000);
  EXPECT_EQ(result.not_tracking, 0);
  EXPECT_LT(quantile(result.registered.position, 0.95), 0.4);
}

/// A registration with the memory of one drive, in a robot that begins another. True where it has
/// found its pose, and has never reported tracking at an error above 0.6 m.
bool finds_itself(const registration::Remembered& remembered, const Pose& truth,
                  const std::vector<Vec2>& way, std::uint64_t cycles) {
  DriveOptions options = doubled(2);
  options.interpretation = true;
  options.start_in_world = truth;
  Drive robot(options);
  Core core({office(), "", kStart, false, true}, remembered);
  Tour tour(way, false);
  Output told;
  while (robot.seen().cycle < cycles) {
    tour.act(robot, robot.truth());
    const std::vector<lps::Percept> before = robot.percepts();
    const Seen& seen = robot.advance();
    core.processes().step(seen.cycle);
    told = core.step({seen.cycle, seen.cycle == 1 ? &robot.mounts() : nullptr, 2, seen.pose_in_odom,
                      before, seen.readings});
    EXPECT_TRUE(seen.cycle > 1 || told.state == v1::REGISTRATION_LOST) << "nothing was heard yet";
    const double off = (told.pose_in_map.position() - robot.truth().position()).norm();
    if (told.state == v1::REGISTRATION_TRACKING && off > 0.6) {
      ADD_FAILURE() << "tracks " << off << " m off in cycle " << seen.cycle;
      return false;
    }
  }
  return told.state == v1::REGISTRATION_TRACKING;
}

TEST(Localization, WhereDeadReckoningHasBegunAnewWhatIsRememberedIsAGuess) {
  Drive robot(on_office(doubled(1)));
  patrol(robot, office_tour(), 900);
  const auto remembered = robot.registration().remembered();
  ASSERT_TRUE(remembered);
  ASSERT_GT((robot.truth().position() - kStart.position()).norm(), 5.0);
  EXPECT_TRUE(finds_itself(*remembered, kStart, {{17.5, 8.0}}, 400))
      << "at the start of the deployment";
  EXPECT_TRUE(finds_itself(*remembered, robot.truth(), {{25.6, 7.0}}, 400)) << "where it was";
  EXPECT_TRUE(finds_itself(*remembered, {21.0, 25.0, kPi},
                           {{17.5, 25.0}, {17.5, 9.0}, {19.0, 7.0}, {25.6, 7.0}, {25.6, 20.0}},
                           1800))
      << "at neither";
}

}  // namespace
}  // namespace saphira::test
