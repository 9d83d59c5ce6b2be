#include "saphira/interpretation/interpretation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "only.hpp"
#include "saphira/base/random.hpp"

namespace saphira::interpretation {
namespace {

using lps::Percept;
using lps::PointType;
using lps::Side;

constexpr double kSpeed = 0.03;  // [m] a cycle

/// A robot with one sonar to each side in a corridor along x. The two functions give the ranges at
/// the robot's x; no echo where they are not positive.
class Corridor {
 public:
  using Range = std::function<double(double x)>;
  Corridor(Range left, Range right, ProcessTable* table = nullptr)
      : left_(std::move(left)), right_(std::move(right)), table_(table) {
    Settings settings;
    settings.sonars = {{0, {0.0, 0.0, kPi / 2.0}}, {6, {0.0, 0.0, -kPi / 2.0}}};
    if (table != nullptr)
      tasks_.emplace(*table);
    interpretation_.emplace(settings, tasks_ ? &*tasks_ : nullptr);
  }

  const Output& drive(double to) {
    const Output* output = &interpretation_->step({cycle_, {x_, 0.0, 0.0}, {}});
    while (x_ < to) {
      x_ += kSpeed;
      ++cycle_;
      if (table_ != nullptr)
        table_->step(cycle_);
      std::vector<lps::SonarReading> readings;
      // One reading of each sonar in three cycles.
      if (cycle_ % 3 == 0)
        readings = {reading(0, left_(x_)), reading(6, right_(x_))};
      output = &interpretation_->step({cycle_, {x_, 0.0, 0.0}, readings});
      for (const Percept& percept : output->percepts)
        ids_.insert(percept.id);
    }
    return *output;
  }
  std::uint64_t cycle() const { return cycle_; }
  const std::set<std::uint32_t>& ids() const { return ids_; }
  Interpretation& interpretation() { return *interpretation_; }

 private:
  lps::SonarReading reading(int sonar, double range) {
    return range > 0.0 ? lps::SonarReading{sonar, range + random_.normal(0.0, 0.004), true}
                       : lps::SonarReading{sonar, 5.0, false};
  }
  Range left_;
  Range right_;
  ProcessTable* table_;
  std::optional<Tasks> tasks_;
  Random random_{1};
  double x_ = 0.0;
  std::uint64_t cycle_ = 0;
  std::optional<Interpretation> interpretation_;
  std::set<std::uint32_t> ids_;
};

double nothing(double) {
  return 0.0;
}

double wall(double) {
  return 1.0;
}

/// A smooth wall with an opening: its corners are heard within 9.5 degrees.
Corridor::Range opening(double from, double to) {
  return [=](double x) {
    const double past = std::tan(radians(9.5));
    if (x <= from || x >= to)
      return 1.0;
    if (x - from < past)
      return std::hypot(1.0, x - from);
    if (to - x < past)
      return std::hypot(1.0, to - x);
    return 0.0;
  };
}

/// The same with a closed door in it, which stands back.
Corridor::Range recess(double from, double to, double depth) {
  return [=, open = opening(from, to)](double x) {
    const double range = open(x);
    return range == 0.0 ? 1.0 + depth : range;
  };
}

/// A gap in the wall with an open door in its back, `depth` behind the wall.
Corridor::Range niche(double from, double to, double depth, double door_from, double door_to) {
  return [=, gap = recess(from, to, depth)](double x) {
    const double back = 1.0 + depth;
    const double seen = std::min(x - door_from, door_to - x);
    if (gap(x) != back || seen <= 0.0)
      return gap(x);
    return seen < back * std::tan(radians(9.5)) ? std::hypot(back, seen) : 0.0;
  };
}

std::vector<Percept> of(const Output& output, PointType type) {
  std::vector<Percept> found;
  std::copy_if(output.percepts.begin(), output.percepts.end(), std::back_inserter(found),
               [&](const Percept& percept) { return percept.type == type; });
  return found;
}

TEST(Interpretation, SeesAWallBesideTheRobot) {
  Corridor corridor(wall, nothing);
  const Output output = corridor.drive(3.0);
  ASSERT_EQ(output.percepts.size(), 1U);
  const Percept& percept = output.percepts[0];
  EXPECT_EQ(percept.type, PointType::wall);
  EXPECT_EQ(percept.side, Side::left);
  EXPECT_NEAR(percept.pose_in_odom.y, 1.0, 0.01);
  EXPECT_NEAR(percept.pose_in_odom.th, 0.0, radians(1.0));
  EXPECT_NEAR(percept.length, 2.9, 0.15);
  EXPECT_GT(percept.confidence, 0.9);
  EXPECT_GT(percept.readings.size(), 25U);
  EXPECT_GT(percept.since, 10U);
  EXPECT_GT(percept.seen, corridor.cycle() - 4);
  ASSERT_TRUE(output.left_wall);
  EXPECT_EQ(output.left_wall->id, percept.id);
  EXPECT_FALSE(output.right_wall);
}

// It bends away from 2.5 m on, in an arc of 30 m.
TEST(Interpretation, AWallThatBendsIsNoLongerThanItIsStraight) {
  const auto arc = [](double x) { return 31.0 - std::sqrt(900.0 - x * x); };
  const auto there = [&](double x) { return x < 2.5 ? 1.0 : arc(x - 2.5); };
  Corridor corridor(there, nothing);
  double most = 0.0;
  for (double x = 2.5; x < 6.5; x += 0.1)
    for (const Percept& percept : of(corridor.drive(x), PointType::wall))
      for (const double end : {-0.5, 0.5}) {
        const Vec2 at = transform(percept.pose_in_odom, Vec2(end * percept.length, 0.0));
        most = std::max(most, std::abs(at.y() - there(at.x())));
      }
  EXPECT_LT(most, 0.05);
}

TEST(Interpretation, AClosedDoorThatStandsBackIsADoor) {
  for (const double depth : {0.15, 0.2, 0.26, 0.35}) {
    Corridor corridor(recess(2.0, 2.9, depth), nothing);
    const auto found = test::only(of(corridor.drive(4.5), PointType::door));
    EXPECT_TRUE(found.is_closed());
    EXPECT_NEAR(found.length, depth, 0.02);
    EXPECT_NEAR(found.pose_in_odom.x, 2.45, 0.06);
    EXPECT_NEAR(found.pose_in_odom.y, 1.0, 0.02);
    EXPECT_NEAR(found.width, 0.9, 0.1);
    // The place is no end of a wall.
    EXPECT_TRUE(of(corridor.drive(4.6), PointType::breach).empty());
  }
}

TEST(Interpretation, SeesAnOpenDoorInItsFrameOrNiche) {
  struct Case {
    double to, depth, door_from, door_to;
  };
  for (const Case& each :
       {Case{2.9, 0.2, 2.05, 2.85}, Case{3.3, 0.25, 2.1, 3.0}, Case{3.6, 0.15, 2.6, 3.5}}) {
    Corridor corridor(niche(2.0, each.to, each.depth, each.door_from, each.door_to), nothing);
    const Output output = corridor.drive(5.5);
    const auto found = test::only(of(output, PointType::door));
    EXPECT_FALSE(found.is_closed());
    EXPECT_NEAR(found.pose_in_odom.x, (each.door_from + each.door_to) / 2, 0.06) << each.to;
    EXPECT_NEAR(found.pose_in_odom.y, 1.0, 0.02);
    EXPECT_NEAR(found.width, each.door_to - each.door_from, 0.1) << each.to;
    EXPECT_TRUE(of(output, PointType::breach).empty());
    EXPECT_TRUE(of(output, PointType::junction).empty());
  }
}

TEST(Interpretation, AFrameOrANicheIsNoDoor) {
  // A door flush with the wall but for its frame; a niche too wide, too narrow, too uneven.
  for (const auto& range : {recess(2.0, 2.9, 0.06), recess(2.0, 4.0, 0.2), recess(2.0, 2.45, 0.2),
                            Corridor::Range([flat = recess(2.0, 2.9, 0.2)](double x) {
                              return flat(x) > 1.15 ? flat(x) + 0.3 * (x - 2.45) : flat(x);
                            })}) {
    Corridor corridor(range, nothing);
    EXPECT_TRUE(of(corridor.drive(5.5), PointType::door).empty());
  }
}

TEST(Interpretation, SeesOneEndAtOnceAndTheDoorWhenItIsPassed) {
  Corridor corridor(opening(2.0, 2.9), nothing);
  const Output early = corridor.drive(2.6);
  EXPECT_TRUE(of(early, PointType::door).empty());
  const auto end = test::only(of(early, PointType::breach));
  EXPECT_NEAR(end.pose_in_odom.x, 2.0, 0.1);
  // The normal, towards the robot.
  EXPECT_NEAR(end.pose_in_odom.th, -kPi / 2.0, radians(1.0));

  const Output late = corridor.drive(4.0);
  const auto found = test::only(of(late, PointType::door));
  EXPECT_NEAR(found.pose_in_odom.x, 2.45, 0.06);
  EXPECT_NEAR(found.pose_in_odom.y, 1.0, 0.02);
  EXPECT_NEAR(found.pose_in_odom.th, -kPi / 2.0, radians(1.0));
  EXPECT_NEAR(found.width, 0.9, 0.1);
  EXPECT_EQ(found.side, Side::left);
  EXPECT_TRUE(of(late, PointType::breach).empty());
  EXPECT_EQ(of(late, PointType::wall).size(), 2U);
}

TEST(Interpretation, AWiderOpeningIsAJunction) {
  Corridor corridor(nothing, opening(2.0, 4.0));
  const auto found = test::only(of(corridor.drive(5.2), PointType::junction));
  EXPECT_NEAR(found.width, 2.0, 0.1);
  EXPECT_NEAR(found.pose_in_odom.th, kPi / 2.0, radians(1.0));
  EXPECT_EQ(found.side, Side::right);
}

TEST(Interpretation, TwoParallelWallsAreACorridor) {
  Corridor corridor(wall, [](double) { return 0.8; });
  const auto found = test::only(of(corridor.drive(3.5), PointType::corridor));
  EXPECT_NEAR(found.pose_in_odom.y, 0.1, 0.01);
  EXPECT_NEAR(found.width, 1.8, 0.02);
  EXPECT_TRUE(found.is_hypothesis());
}

// A box before the wall, or a person: the wall there is unseen.
TEST(Interpretation, WhatHidesAWallIsNoOpening) {
  Corridor corridor([](double x) { return x > 2.0 && x < 2.9 ? 0.5 : 1.0; }, nothing);
  const Output& output = corridor.drive(4.5);
  EXPECT_TRUE(of(output, PointType::door).empty());
  EXPECT_TRUE(of(output, PointType::breach).empty());
}

TEST(Interpretation, AClosedDoorInItsFrameIsNoOpening) {
  Corridor corridor([](double x) { return x > 2.0 && x < 2.9 ? 1.1 : 1.0; }, nothing);
  const Output& output = corridor.drive(4.5);
  EXPECT_TRUE(of(output, PointType::door).empty());
  EXPECT_TRUE(of(output, PointType::breach).empty());
}

TEST(Interpretation, ALostEchoIsNoOpening) {
  Corridor corridor([](double x) { return std::fmod(x, 0.9) < 0.09 ? 0.0 : 1.0; }, nothing);
  const Output& output = corridor.drive(4.5);
  EXPECT_TRUE(of(output, PointType::door).empty());
  EXPECT_EQ(of(output, PointType::wall).size(), 1U);
}

// The corner of a table, two metres off: heard for 0.7 m of the way at nearly the same range.
TEST(Interpretation, ACornerIsNoWall) {
  Corridor corridor(
      [](double x) { return std::abs(x - 2.0) < 0.36 ? std::hypot(2.0, x - 2.0) : 0.0; }, nothing);
  corridor.drive(4.0);
  EXPECT_TRUE(corridor.ids().empty());
}

TEST(Interpretation, IsSilentAmongClutter) {
  Random random(3);
  Corridor corridor([&](double) { return random.uniform(0.5, 2.5); },
                    [&](double) { return random.chance(0.4) ? 0.0 : random.uniform(0.5, 3.0); });
  corridor.drive(60.0);
  EXPECT_LE(corridor.ids().size(), 1U);
}

TEST(Interpretation, IdsStayWhileTheSameThingIsSeenAndEndWithTheAperture) {
  Corridor corridor(opening(2.0, 2.9), nothing);
  const auto door = of(corridor.drive(4.0), PointType::door);
  ASSERT_EQ(door.size(), 1U);
  const auto same = test::only(of(corridor.drive(6.0), PointType::door));
  EXPECT_EQ(same.id, door[0].id);
  EXPECT_EQ(same.since, door[0].since);
  const Output far = corridor.drive(9.0);
  EXPECT_TRUE(of(far, PointType::door).empty());
  // One wall before it, one behind it, an end and the door.
  EXPECT_LE(corridor.ids().size(), 5U);
}

TEST(Interpretation, ForgetsEverythingButItsIds) {
  Corridor corridor(wall, nothing);
  const std::uint32_t id = corridor.drive(3.0).percepts.at(0).id;
  corridor.interpretation().reset();
  const Output output = corridor.drive(3.02);
  EXPECT_TRUE(output.percepts.empty());
  EXPECT_FALSE(output.left_wall);
  EXPECT_FALSE(output.dropped_tiles.empty());
  EXPECT_GT(corridor.drive(6.0).percepts.at(0).id, id);
}

TEST(InterpretationTasks, ChangeNothingWhileAllWork) {
  ProcessTable table;
  Corridor with(opening(2.0, 2.9), wall, &table);
  Corridor without(opening(2.0, 2.9), wall);
  for (double x = 0.5; x < 6.0; x += 0.5) {
    const Output& one = with.drive(x);
    const Output& other = without.drive(x);
    ASSERT_EQ(one.percepts, other.percepts);
    EXPECT_EQ(one.changed_tiles.size(), other.changed_tiles.size());
  }
  EXPECT_EQ(with.ids(), without.ids());
}

TEST(InterpretationTasks, WhatASuspendedOneFoundIsGoneUntilItIsResumed) {
  ProcessTable table;
  Corridor corridor(opening(2.0, 2.9), wall, &table);
  double x = 4.5;
  const auto seen = [&](PointType type) {
    x += 0.04;
    return of(corridor.drive(x), type).size();
  };
  EXPECT_EQ(seen(PointType::door), 1U);
  EXPECT_GE(seen(PointType::wall), 2U);
  EXPECT_EQ(seen(PointType::corridor), 1U);
  EXPECT_EQ(table.request("test-wall-break", ProcessAction::interrupt), "");
  EXPECT_EQ(seen(PointType::door), 0U);
  EXPECT_GE(seen(PointType::wall), 2U);
  EXPECT_EQ(table.request("test-wall", ProcessAction::suspend), "");
  EXPECT_EQ(seen(PointType::wall), 0U);
  EXPECT_EQ(seen(PointType::corridor), 1U);
  EXPECT_FALSE(corridor.drive(x += 0.04).right_wall);
  EXPECT_EQ(table.request("corridor", ProcessAction::suspend), "");
  EXPECT_TRUE(corridor.drive(x += 0.04).percepts.empty());
  for (const char* name : {"test-wall-break", "test-wall", "corridor"})
    EXPECT_EQ(table.request(name, ProcessAction::resume), "");
  EXPECT_EQ(seen(PointType::door), 1U);
  EXPECT_GE(seen(PointType::wall), 2U);
  EXPECT_EQ(seen(PointType::corridor), 1U);
}

TEST(InterpretationTasks, WithoutSideSegmentsItSeesNothingAndThenBeginsAnew) {
  ProcessTable table;
  Corridor corridor(wall, wall, &table);
  EXPECT_FALSE(corridor.drive(4.0).percepts.empty());
  EXPECT_EQ(table.request("side-segment", ProcessAction::suspend), "");
  EXPECT_TRUE(corridor.drive(4.04).percepts.empty());
  EXPECT_TRUE(corridor.drive(6.0).percepts.empty());
  EXPECT_EQ(table.request("side-segment", ProcessAction::resume), "");
  EXPECT_TRUE(corridor.drive(6.1).percepts.empty());
  const Output& output = corridor.drive(9.0);
  ASSERT_FALSE(of(output, PointType::wall).empty());
  for (const Percept& percept : of(output, PointType::wall))
    EXPECT_LT(percept.length, 3.5);
}

TEST(InterpretationTasks, ASuspendedGridStaysAsItWas) {
  ProcessTable table;
  Corridor corridor(wall, wall, &table);
  EXPECT_FALSE(corridor.drive(2.0).percepts.empty());
  const std::uint64_t updates = corridor.interpretation().grid().updates();
  EXPECT_EQ(table.request("occgrid", ProcessAction::interrupt), "");
  EXPECT_TRUE(corridor.drive(4.0).changed_tiles.empty());
  EXPECT_EQ(corridor.interpretation().grid().updates(), updates);
  EXPECT_EQ(table.request("occgrid", ProcessAction::resume), "");
  corridor.drive(4.5);
  EXPECT_GT(corridor.interpretation().grid().updates(), updates);
}

TEST(Interpretation, KnowsNothingOfSonarsThatTheRobotDoesNotHave) {
  Interpretation interpretation({});
  const Output& output = interpretation.step({1, {}, {{3, 1.0, true}}});
  EXPECT_TRUE(output.percepts.empty());
  EXPECT_TRUE(output.changed_tiles.empty());
}

}  // namespace
}  // namespace saphira::interpretation
