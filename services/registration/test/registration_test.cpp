#include "saphira/registration/registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "saphira/base/archive.hpp"
#include "saphira/base/random.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/registration/state.hpp"

namespace saphira::registration {
namespace {

using lps::PointType;

const maps::Map kMap = maps::parse_map(
    "CORRIDOR (1) 10000, 0, 0, 20000, 2000\n"
    "DOOR (2) 3000, 1000, -90, 900\n"
    "DOOR (3) 6000, 1000, -90, 900\n"
    "DOOR (4) 9000, -1000, 90, 900\n"
    "OBJECT (5) 14000, 700, 0, 400, 400\n",
    "test");
constexpr int kSonars = 16;

Settings settings() {
  Settings result;
  for (int i = 0; i < kSonars; ++i)
    result.sonars.push_back({i, {0.0, 0.0, norm2_angle(2.0 * kPi * i / kSonars)}});
  return result;
}

lps::Percept percept(std::uint32_t id, PointType type, const Pose& pose, std::uint64_t cycle) {
  return lps::Percept{.id = id,
                      .type = type,
                      .pose_in_odom = pose,
                      .length = type == PointType::wall ? 1.5 : 0.0,
                      .width = type == PointType::wall ? 0.0 : 0.9,
                      .sigma_along = 0.03,
                      .sigma_across = 0.03,
                      .sigma_heading = radians(1.0),
                      .confidence = 1.0,
                      .seen = cycle,
                      .readings = {{cycle, static_cast<int>(id % kSonars)}}};
}

/// Drives along the corridor, turns at times, and hears walls, doors and objects that are not on
/// the map.
class Robot {
 public:
  explicit Robot(std::uint64_t seed) : random_(seed) {}

  const Output& step(Registration& registration) {
    ++cycle_;
    const double turn = cycle_ % 90 < 12 ? radians(cycle_ % 180 < 90 ? 7.0 : -7.0) : 0.0;
    const double way = turn == 0.0 ? 0.03 : 0.0;
    truth_ = compose(truth_, {way, 0.0, turn});
    if (truth_.x > 17.0 || truth_.x < 2.0)
      truth_.th = norm2_angle(kPi - truth_.th);
    truth_.y = std::clamp(truth_.y, -0.5, 0.5);
    // Dead reckoning errs a little.
    odom_ = compose(odom_, {way * random_.normal(1.0, 0.05), 0.0, turn + random_.normal(0, 0.002)});
    readings_.clear();
    for (int sonar = 0; sonar < kSonars; ++sonar)
      hear(sonar);
    percepts_.clear();
    // Percepts of walls and doors come some cycles after their readings, at the place of that time.
    if (cycle_ % 5 == 0)
      see(PointType::wall, {std::round(truth_.x), 1.0, 0.0});
    for (const double x : {3.0, 6.0})
      if (std::abs(truth_.x - x) < 0.5 && cycle_ % 3 == 0)
        see(PointType::door, {x, 1.0, -kPi / 2});
    return registration.step({cycle_, odom_number_, odom_, percepts_, readings_, true});
  }
  /// Dead reckoning begins anew.
  void restart() { ++odom_number_; }

 private:
  void hear(int sonar) {
    const double heading = truth_.th + 2.0 * kPi * sonar / kSonars;
    const double across = std::sin(heading);
    const double wall = (across > 0 ? 1.0 - truth_.y : 1.0 + truth_.y) / std::abs(across);
    lps::SonarReading reading;
    reading.sonar = sonar;
    reading.echo = std::abs(across) > 0.95 || random_.chance(0.05);
    reading.range = reading.echo ? std::min(4.9, wall * random_.normal(1.0, 0.01)) : 5.0;
    readings_.push_back(reading);
  }
  void see(PointType type, const Pose& there) {
    const Pose seen = compose(odom_, relative(truth_, there));
    percepts_.push_back(
        percept(++last_id_, type, seen, cycle_ - std::min<std::uint64_t>(cycle_, 6)));
    percepts_.back().seen = cycle_;
  }

  Random random_;
  std::uint64_t cycle_ = 0;
  std::uint64_t odom_number_ = 1;
  std::uint32_t last_id_ = 0;
  Pose truth_{3.5, 0.0, 0.0};
  Pose odom_;
  std::vector<lps::SonarReading> readings_;
  std::vector<lps::Percept> percepts_;
};

/// The match of a wall whose readings are older than a turn of 60 degrees.
std::size_t matches_after_a_turn(const std::function<void(Registration&)>& then) {
  Registration registration(settings(), kMap, Pose{10.0, 0.0, 0.0});
  Pose odom;
  std::uint64_t cycle = 0;
  for (; cycle < 12; ++cycle) {
    odom.th = radians(5.0) * static_cast<double>(cycle);
    registration.step({cycle, 1, odom, {}, {}});
  }
  then(registration);
  lps::Percept wall = percept(1, PointType::wall, {0.0, 1.0, 0.0}, 1);
  wall.seen = cycle;
  return registration.step({cycle, 1, odom, {wall}, {}}).matches.size();
}

TEST(Registration, AnEditOfTheMapForgetsNoTurn) {
  EXPECT_EQ(matches_after_a_turn([](Registration&) {}), 0U);
  EXPECT_EQ(matches_after_a_turn([](Registration& registration) {
              maps::Editor editor(registration.map());
              editor.remove(5);
              registration.set_map(editor.map());
            }),
            0U);
}

void expect_no_difference(std::uint64_t seed, std::optional<Pose> start) {
  Registration a(settings(), kMap, start);
  Registration b(settings(), kMap, start);
  Robot robot_a(seed);
  Robot robot_b(seed);
  Random random(seed + 100);
  int searched = 0;
  for (int i = 0; i < 700; ++i) {
    if (i == 400) {
      robot_a.restart();
      robot_b.restart();
    }
    robot_a.step(a);
    robot_b.step(b);
    ASSERT_EQ(a.output(), b.output()) << i;
    ASSERT_EQ(saved(a.save()), saved(b.save())) << i;
    searched += a.state().search.hypotheses.empty() ? 0 : 1;
    if (random.chance(0.2))
      b.set_map(kMap);
  }
  EXPECT_GT(searched, 0);
}

TEST(Registration, TheSameMapOnceMoreChangesNothing) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const std::optional<Pose> start :
         {std::optional<Pose>({3.5, 0.0, 0.0}), std::optional<Pose>()})
      expect_no_difference(seed, start);
}

/// Drives straight along the corridor with a wall on both sides.
class Straight {
 public:
  Straight(Registration& registration, const Pose& start)
      : registration_(registration), start_(start) {}

  void to(double x, std::vector<lps::Percept> seen = {}) {
    do {
      way_ += 0.01;
      std::vector<lps::SonarReading> readings = around(1.0);
      for (lps::SonarReading& reading : readings)
        reading.echo = reading.sonar == kSonars / 4 || reading.sonar == 3 * kSonars / 4;
      step(seen, readings);
      seen.clear();
    } while (start_.x + way_ < x);
  }
  /// It stands, and hears something at this range all around.
  void stand(double range, int cycles) {
    for (int i = 0; i < cycles; ++i)
      step({}, around(range));
  }
  /// A door on the left is seen.
  void see_door(std::uint32_t id, double x) {
    to(0.0, {percept(id, PointType::door, {x - start_.x, 1.0, -kPi / 2}, cycle_)});
  }

 private:
  static std::vector<lps::SonarReading> around(double range) {
    std::vector<lps::SonarReading> readings(kSonars, {0, range, true});
    for (int sonar = 0; sonar < kSonars; ++sonar)
      readings[static_cast<std::size_t>(sonar)].sonar = sonar;
    return readings;
  }
  void step(const std::vector<lps::Percept>& seen, const std::vector<lps::SonarReading>& readings) {
    registration_.step({++cycle_, 1, {way_, 0.0, 0.0}, seen, readings});
  }

  Registration& registration_;
  Pose start_;
  double way_ = 0.0;  ///< [m]
  std::uint64_t cycle_ = 0;
};

/// A door where the map has none makes the robot unsure, a third one lost. The good readings of the
/// way before do not outweigh them, and the walls of the way after take nothing away: they are the
/// same in any other corridor.
TEST(Registration, DoorsThatTheMapDoesNotHaveRefuteThePlace) {
  const Pose start{10.0, 0.0, 0.0};
  Registration registration(settings(), kMap, start);
  Straight robot(registration, start);
  robot.to(13.0);
  EXPECT_EQ(registration.output().confidence, 1.0);
  robot.see_door(1, 13.0);
  robot.to(15.0);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_TRACKING);
  EXPECT_LT(registration.output().confidence, 0.9) << "no goal succeeds";
  robot.see_door(2, 15.0);
  EXPECT_LT(registration.output().confidence, 0.5);
  robot.see_door(3, 17.0);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_LOST);
}

/// People have closed a door or two; a third one in a row is more likely wall of another corridor,
/// until an open one is where the map has it.
TEST(Registration, ARunOfClosedDoorsMakesItUnsure) {
  const Pose start{2.0, 0.0, 0.0};
  Registration registration(settings(),
                            maps::parse_map("CORRIDOR (1) 15000, 0, 0, 30000, 2000\n"
                                            "DOOR (2) 8000, 1000, -90, 900\n"
                                            "DOOR (3) 12000, 1000, -90, 900\n"
                                            "DOOR (4) 16000, 1000, -90, 900\n"
                                            "DOOR (5) 20000, 1000, -90, 900\n",
                                            "test"),
                            start);
  registration.set_pose(start, {0.05, radians(1.0)});
  Straight robot(registration, start);
  robot.to(11.0);
  EXPECT_EQ(registration.closed_doors(), std::set<std::uint32_t>{2});
  EXPECT_GE(registration.output().confidence, 0.9);
  robot.to(17.0);
  EXPECT_EQ(registration.closed_doors(), (std::set<std::uint32_t>{2, 3, 4}));
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_TRACKING);
  EXPECT_LT(registration.output().confidence, 0.9) << "no goal succeeds";
  robot.see_door(1, 20.0);
  EXPECT_GE(registration.output().confidence, 0.9);
}

/// A robot that was carried along a corridor hears wall where its map has doors. Where it really is
/// those doors are as they were.
TEST(Registration, DoorsThatSeemedClosedFromAWrongPlaceAreAsBefore) {
  const maps::Map map = maps::parse_map(
      "CORRIDOR (1) 15000, 0, 0, 30000, 2000\n"
      "DOOR (2) 8000, 1000, -90, 900\n"
      "DOOR (3) 12000, 1000, -90, 900\n",
      "test");
  const Pose start{2.0, 0.0, 0.0};
  Registration registration(settings(), map, start);
  registration.set_pose(start, {0.05, radians(1.0)});
  registration.recall_closed({3});
  Straight robot(registration, start);
  robot.to(11.0);
  EXPECT_EQ(registration.closed_doors(), (std::set<std::uint32_t>{2, 3}));
  registration.set_pose({16.0, 0.0, 0.0});
  EXPECT_EQ(registration.closed_doors(), std::set<std::uint32_t>{3});
  Registration same(settings(), map, start);
  Straight other(same, start);
  same.set_pose(start, {0.05, radians(1.0)});
  other.to(11.0);
  same.set_pose({11.3, 0.0, 0.0});
  EXPECT_EQ(same.closed_doors(), std::set<std::uint32_t>{2}) << "its place was right";
}

/// Walls bring the state back after some metres, but only a door of the map makes it sure again.
TEST(Registration, WhoWasCarriedIsSureAgainByAnOpening) {
  const Pose start{4.0, 0.0, 0.0};
  const maps::Map with_door = maps::parse_map(
      "CORRIDOR (1) 15000, 0, 0, 30000, 2000\nDOOR (2) 12000, 1000, -90, 900\n", "test");
  Registration registration(settings(), with_door, start);
  Straight robot(registration, start);
  robot.to(6.0);
  EXPECT_EQ(registration.output().confidence, 1.0);
  robot.stand(1.0, 6);
  robot.stand(2.0, 2);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_TRACKING);
  robot.stand(2.0, 1);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_LOST);
  robot.to(10.0);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_TRACKING);
  EXPECT_EQ(registration.output().confidence, 0.5) << "no goal succeeds";
  EXPECT_TRUE(registration.output().reason.starts_with("it was carried"));
  Registration again(settings(), with_door);
  again.restore(registration.save());
  EXPECT_TRUE(again.save().carried) << "over a restart";
  robot.see_door(1, 12.0);
  EXPECT_EQ(registration.output().confidence, 1.0);
  EXPECT_FALSE(registration.save().carried);
}

/// As after the building of a map: the ranges of the place before are no evidence.
TEST(Registration, ThePlaceOfARobotThatIsPlacedIsNotComparedWithTheOldOne) {
  const Pose start{4.0, 0.0, 0.0};
  const maps::Map map = maps::parse_map("CORRIDOR (1) 15000, 0, 0, 30000, 2000\n", "test");
  Registration registration(settings(), map, start);
  Straight robot(registration, start);
  robot.to(6.0);
  robot.stand(1.0, 6);
  registration.restore(registration.save());
  robot.stand(2.0, 5);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_TRACKING);
}

TEST(Registration, OnAMapWithoutOpeningsWallsMakeItSureAgain) {
  const Pose start{4.0, 0.0, 0.0};
  Registration registration(
      settings(), maps::parse_map("CORRIDOR (1) 15000, 0, 0, 30000, 2000\n", "test"), start);
  Straight robot(registration, start);
  robot.stand(1.0, 6);
  robot.stand(2.0, 3);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_LOST);
  robot.to(10.0);
  EXPECT_EQ(registration.output().state, v1::REGISTRATION_TRACKING);
  EXPECT_EQ(registration.output().confidence, 1.0);
}

TEST(Registration, OnAMapOfSomewhereElseThePlacesOfTheOldOneAreForgotten) {
  Registration registration(settings(), kMap);
  Robot robot(1);
  for (int i = 0; i < 700 && registration.state().search.hypotheses.empty(); ++i)
    robot.step(registration);
  ASSERT_FALSE(registration.state().search.hypotheses.empty());
  maps::Editor editor(kMap);
  editor.remove(5);
  registration.set_map(editor.map());
  EXPECT_FALSE(registration.state().search.hypotheses.empty());
  registration.set_map(maps::parse_map("CORRIDOR (1) 0, 5000, 0, 10000, 3000\n", "test"));
  EXPECT_TRUE(registration.state().search.hypotheses.empty());
}

}  // namespace
}  // namespace saphira::registration
