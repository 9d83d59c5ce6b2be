#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "perception/score.hpp"

// The percepts of interpretation in simulated worlds, against the ground truth. The limits are the
// required ones; the measured figures are in the README.
namespace saphira::test {
namespace {

struct Total {
  Count walls;
  Count doors;
  Count ends;
  int passed = 0;
  int found = 0;

  void add(const Score& score) {
    for (auto [sum, count] : {std::pair{&walls, score.walls()}, std::pair{&doors, score.doors()},
                              std::pair{&ends, score.count(lps::PointType::breach)}}) {
      sum->reported += count.reported;
      sum->real += count.real;
    }
    passed += score.doors_passed();
    found += score.doors_found();
  }
};

using Act = std::function<void(Drive&)>;

/// Steps `cycles` and counts the percepts.
void run(Drive& drive, const std::string& world, std::uint64_t cycles, const Act& act,
         Total& total) {
  Score score(drive, map_of(world));
  while (drive.seen().cycle < cycles) {
    act(drive);
    drive.advance();
    score.look(drive);
  }
  total.add(score);
}

/// Follows a tour like a robot with activities: it backs off when blocked, and gives up an
/// unreachable point. Behaviors alone would press on against a person whom no sonar hears, and
/// would not leave a room into which they have dodged people.
class Walk {
 public:
  explicit Walk(const std::string& world) : tour_(patrol(world), true) {}

  void act(Drive& drive) {
    const Pose& pose = drive.seen().true_pose_in_world;
    if ((pose.position() - last_).norm() > 0.1) {
      last_ = pose.position();
      held_up_ = 0;
    }
    if (tour_.reached() != reached_) {
      reached_ = tour_.reached();
      under_way_ = 0;
    }
    ++held_up_;
    if (++under_way_ % kLongest == 0)
      tour_.skip();
    if (held_up_ > kPatience && held_up_ % kPatience < kBack)
      drive.drive(-0.2, drive.seen().pose_in_odom.th);
    else
      tour_.act(drive, pose);
  }

 private:
  // [cycles]
  static constexpr int kPatience = 100;
  static constexpr int kBack = 15;
  static constexpr int kLongest = 1200;

  Tour tour_;
  Vec2 last_{0.0, 0.0};
  std::size_t reached_ = 0;
  int held_up_ = 0;
  int under_way_ = 0;
};

Total tours(const std::string& world, int seeds, std::uint64_t cycles) {
  Total total;
  for (int seed = 1; seed <= seeds; ++seed) {
    Drive drive({.world = world,
                 .seed = static_cast<std::uint64_t>(seed),
                 .errors = 2.0,
                 .interpretation = true});
    Walk walk(world);
    run(
        drive, world, cycles, [&](Drive& d) { walk.act(d); }, total);
  }
  return total;
}

/// With so many walls and doors reported, and so many doors passed by.
void expect_true_and_complete(const Total& total, int walls, int doors, int passed) {
  EXPECT_GT(total.walls.reported, walls);
  EXPECT_GE(total.walls.precision(), 0.98);
  EXPECT_GT(total.doors.reported, doors);
  EXPECT_GE(total.doors.precision(), 0.98);
  EXPECT_GT(total.passed, passed);
  EXPECT_GE(total.found, 0.8 * total.passed);
}

// Patrols with the errors of dead reckoning doubled; dodging cupboards, round corners and back.
TEST(Perception, OfTheOfficeFloorIsTrueAndComplete) {
  const Total total = tours("office-floor", 4, 9000);
  expect_true_and_complete(total, 400, 250, 250);
  EXPECT_GE(total.ends.precision(), 0.98);
}

// Its outer wall has closed doors, 0.1 m back.
TEST(Perception, OfTheLoopIsTrueAndComplete) {
  expect_true_and_complete(tours("loop", 2, 9000), 150, 50, 50);
}

// In a narrow hall, round a cupboard; every way is oblique.
TEST(Perception, OfASmallOfficeIsTrueAndComplete) {
  expect_true_and_complete(tours("small-office", 2, 9000), 300, 0, 100);
}

// Two people who walk about, a door that opens and closes, boxes.
TEST(Perception, PeopleAreNoDoors) {
  const Total total = tours("visitors", 4, 9000);
  EXPECT_GT(total.walls.reported, 80);
  EXPECT_GE(total.walls.precision(), 0.98);
  EXPECT_GE(total.doors.precision(), 0.98);
}

// No corridor, no door: furniture at all angles.
TEST(Perception, FurnitureIsNoDoor) {
  const Total total = tours("cluttered", 6, 9000);
  EXPECT_LE(total.doors.reported, 3);
  EXPECT_GE(total.walls.precision(), 0.95);
}

// The lower corridor, to and fro at 12 degrees across it.
TEST(Perception, DrivingObliquelyIsNoHindrance) {
  Total total;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Drive drive({.seed = seed,
                 .errors = 2.0,
                 .start_in_world = Pose{13.0, 7.0, 0.0},
                 .interpretation = true});
    double across = 12.0;
    run(
        drive, "office-floor", 700,
        [&](Drive& d) {
          const Pose& at = d.seen().true_pose_in_world;
          if (std::abs(at.y - 7.0) > 0.35)
            across = at.y > 7.0 ? -12.0 : 12.0;
          // By its true heading: that of dead reckoning drifts.
          const double error = norm2_angle(radians(across) - at.th);
          d.drive(0.3, d.seen().pose_in_odom.th + error);
        },
        total);
    EXPECT_EQ(drive.contacts(), 0);
  }
  EXPECT_GT(total.walls.reported, 20);
  EXPECT_GE(total.walls.precision(), 0.98);
  EXPECT_GE(total.doors.precision(), 0.98);
  EXPECT_GE(total.passed, 6);
  EXPECT_GE(total.found, 0.8 * total.passed);
}

}  // namespace
}  // namespace saphira::test
