#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "process.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/sonar.hpp"
#include "saphira/sim/world.hpp"

// The behaviors at work: the executive drives the simulated Pioneer, with the noise of its sonars
// and its dead reckoning, through worlds for a reactive robot. Ten seeds each.
namespace saphira::behaviors {
namespace {

struct Drive {
  Vec2 goal_in_odom{0.0, 0.0};  ///< odom begins at the start, looking along the start's heading
  std::vector<Intended> behaviors;
  double radius = 0.15;        ///< [m] near enough
  std::uint64_t limit = 1500;  ///< [cycles]
  std::uint64_t seed = 1;
  sim::SonarModel sonar = {};
  std::size_t late = 0;  ///< [cycles] delay of each command
};

struct DriveResult {
  bool arrived = false;
  std::uint64_t cycles = 0;
  int contacts = 0;
  double min_clearance = 1e9;  ///< [m]
  double path = 0.0;           ///< [m]
  int swings = 0;              ///< turns of more than 5 degrees, one way and then the other
  Pose end_in_world;
};

using Watch =
    std::function<void(const sim::Robot&, const Inputs&, const Output&, const Executive&)>;

/// AvoidCollision over KeepOff over GoToPos, as the functor go_to intends them.
std::vector<Intended> go_to(const Vec2& goal_in_odom, double speed = 0.3, double radius = 0.15) {
  return {{"avoid", "AvoidCollision", 0, true, {}},
          {"keep off", "KeepOff", 1, true, {}},
          {"go",
           "GoToPos",
           2,
           true,
           {{"goal", PlacedPoint{{goal_in_odom.x(), goal_in_odom.y(), 0.0}, Frame::odom}},
            {"speed", speed},
            {"radius", radius}}},
          {"stop", "Stop", 3, true, {}}};
}

DriveResult drive(const sim::World& world, const protocol::RobotParameters& parameters,
                  const Pose& start_in_world, const Drive& what, const Watch& watch = {}) {
  sim::Scene scene(world);
  sim::Robot& robot = scene.add_robot(parameters, start_in_world, what.seed);
  sim::Sonars sonars(scene, robot.number(), parameters, what.sonar, what.seed);
  Executive executive(predefined(), model_of(parameters));
  DriveResult run;
  std::vector<lps::SonarReading> readings;
  Intent intent{0, true, what.behaviors};
  struct Command {
    bool active;
    double speed;
    double heading;
  };
  std::deque<Command> on_the_way;
  double heading = 0.0;  // the newest heading setpoint
  double swing = 0.0;    // [rad] turned since it last changed sides
  Pose last = robot.pose_in_world();
  while (run.cycles < what.limit) {
    ++run.cycles;
    for (int tick = 0; tick < 10; ++tick) {
      robot.tick();
      if (const auto echo = sonars.tick(robot.pose_in_world()))
        readings.push_back({echo->number, echo->range.value_or(5.0), echo->range.has_value()});
    }
    run.min_clearance = std::min(run.min_clearance, robot.clearance());
    const Pose& pose = robot.pose_in_world();
    run.path += (pose.position() - last.position()).norm();
    const double turned = norm2_angle(pose.th - last.th);
    if (swing * turned < 0.0) {
      if (std::abs(swing) > radians(5.0))
        ++run.swings;
      swing = 0.0;
    }
    swing += turned;
    last = pose;

    intent.cycle = run.cycles - 1;
    Inputs inputs{run.cycles,
                  {robot.pose_in_odom(), robot.velocity(), robot.rotation_velocity()},
                  std::exchange(readings, {}),
                  &intent};
    inputs.robot.target_heading_in_odom = heading;
    inputs.delay = 0.1 * static_cast<double>(what.late);
    const Output output = executive.step(inputs);
    if (watch)
      watch(robot, inputs, output, executive);
    if ((robot.pose_in_odom().position() - what.goal_in_odom).norm() <= what.radius) {
      run.arrived = true;
      break;
    }
    on_the_way.push_back({output.active, output.speed, output.heading_in_odom});
    if (on_the_way.size() <= what.late)
      continue;
    const Command now = on_the_way.front();
    on_the_way.pop_front();
    // Whole millimetres and degrees, as in the robot's commands.
    robot.set_velocity(now.active ? std::round(now.speed * 1000.0) / 1000.0 : 0.0);
    if (now.active) {
      heading = radians(std::round(degrees(now.heading)));
      robot.set_heading(heading);
    }
  }
  run.contacts = robot.contacts();
  run.end_in_world = robot.pose_in_world();
  return run;
}

constexpr std::uint64_t kSeeds = 10;

const protocol::RobotParameters& pioneer() {
  static const protocol::RobotParameters parameters =
      protocol::load_parameters(test::source("config/robots/pioneer.p"));
  return parameters;
}

/// A rectangle in the form of a world file; centre and sides in mm, angle in degrees.
std::string box(double x, double y, double angle, double width, double height) {
  const auto number = [](double v) { return std::to_string(v) + " "; };
  const double xs[] = {-width / 2, width / 2, width / 2, -width / 2};
  const double ys[] = {-height / 2, -height / 2, height / 2, height / 2};
  std::string text = "push " + number(x) + number(y) + number(angle) + "\n";
  for (int i = 0; i < 4; ++i)
    text +=
        number(xs[i]) + number(ys[i]) + number(xs[(i + 1) % 4]) + number(ys[(i + 1) % 4]) + "\n";
  return text + "pop\n";
}

/// A hall of 20 by 20 m with objects.
sim::World hall(const std::string& things) {
  return sim::parse_world(
      "width 20000 height 20000\n"
      "0 0 20000 0\n20000 0 20000 20000\n20000 20000 0 20000\n0 20000 0 0\n" +
          things,
      "hall");
}

/// Twelve boxes in the middle of the hall, of different sizes and askew, with at least a metre
/// between neighbours.
sim::World field(std::uint64_t seed) {
  Random random(seed);
  std::string things;
  std::vector<Vec2> places;
  for (int i = 0; i < 400 && places.size() < 12; ++i) {
    const Vec2 place(random.uniform(4, 12), random.uniform(6, 14));
    const double size = random.uniform(0.3, 0.9);
    const double angle = random.uniform(0, 90);
    bool free = true;
    for (const Vec2& other : places)
      free = free && (other - place).norm() >= 2.3;
    if (!free)
      continue;
    places.push_back(place);
    things += box(place.x() * 1e3, place.y() * 1e3, angle, size * 1e3, size * 1e3);
  }
  return hall(things);
}

struct Expected {
  double clearance = 0.04;  ///< [m]
  double detour = 1.4;      ///< path over the straight line, at the most, on average
  double swings = 12.0;     ///< on average
  double speed = 0.3;
  int late = 0;           ///< runs that may not arrive within two and a half minutes
  std::size_t delay = 0;  ///< [cycles] of the commands
};

void expect_arrivals(const sim::World& world, const Pose& start, const Vec2& goal,
                     const Expected& expected = {}) {
  double path = 0.0;
  double swings = 0.0;
  int late = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Drive what{.goal_in_odom = goal,
               .behaviors = go_to(goal, expected.speed),
               .seed = seed,
               .late = expected.delay};
    const DriveResult run = drive(world, pioneer(), start, what);
    late += run.arrived ? 0 : 1;
    EXPECT_LE(late, expected.late)
        << "seed " << seed << " ended at " << run.end_in_world.x << ", " << run.end_in_world.y;
    EXPECT_EQ(run.contacts, 0) << "seed " << seed;
    EXPECT_GE(run.min_clearance, expected.clearance) << "seed " << seed;
    path += run.path / kSeeds;
    swings += static_cast<double>(run.swings) / kSeeds;
  }
  EXPECT_LE(path, expected.detour * goal.norm());
  EXPECT_LE(swings, expected.swings);
}

TEST(Drive, InTheOpen) {
  expect_arrivals(hall(""), {2, 10, 0}, {8, 3}, {.clearance = 1.0, .detour = 1.05, .swings = 2});
}

TEST(Drive, TurnsRoundAndDoesNotOrbitTheGoal) {
  expect_arrivals(hall(""), {5, 10, 0}, {-2, 0.3}, {.clearance = 1.0, .detour = 1.05, .swings = 2});
  expect_arrivals(hall(""), {5, 10, 0}, {0, 0.5}, {.clearance = 1.0, .detour = 1.3, .swings = 2});
}

TEST(Drive, AroundABoxStraightAhead) {
  expect_arrivals(hall(box(6000, 10000, 0, 600, 600)), {3, 10, 0}, {6, 0});
}

TEST(Drive, AroundAWideBoxStraightAhead) {
  expect_arrivals(hall(box(6000, 10000, 0, 1000, 2400)), {3, 10, 0}, {6, 0});
}

TEST(Drive, AroundACornerStraightAhead) {
  expect_arrivals(hall(box(6000, 10000, 45, 800, 800)), {3, 10, 0}, {6, 0});
}

TEST(Drive, AroundAWall) {
  expect_arrivals(hall(box(6000, 10000, 0, 200, 4000)), {3, 10, 0}, {6, 0.5}, {.detour = 1.7});
}

// The behaviors on another machine, and a quarter of a second each way to it.
TEST(Drive, OverASlowNetwork) {
  const Expected slow{.swings = 20, .delay = 5};
  expect_arrivals(hall(""), {2, 10, 0}, {8, 3}, slow);
  expect_arrivals(hall(box(6000, 10000, 0, 600, 600)), {3, 10, 0}, {6, 0}, slow);
  expect_arrivals(hall(box(6000, 10000, 45, 800, 800)), {3, 10, 0}, {6, 0}, slow);
  expect_arrivals(field(1), {1.5, 10, 0}, {13, 0}, slow);
}

TEST(Drive, AlongASlantingWall) {
  expect_arrivals(hall(box(7000, 10000, 30, 5000, 200)), {3, 10, 0}, {8, -1}, {.swings = 26});
}

TEST(Drive, ThroughAGapOfAMetre) {
  expect_arrivals(hall(box(6000, 7500, 0, 200, 4000) + box(6000, 12500, 0, 200, 4000)), {3, 10, 0},
                  {6, 0}, {.detour = 1.1});
}

TEST(Drive, ThroughACorridorOfAMetre) {
  expect_arrivals(hall(box(7000, 9400, 0, 6000, 200) + box(7000, 10600, 0, 6000, 200)), {2, 10, 0},
                  {10, 0}, {.detour = 1.1});
}

// Its walls are mirrors to the sonars: at times the robot forgets them, and goes in again. The
// edges of its sides are heard only within 8 degrees of an axis, so that the robot passes them
// nearer than other objects.
TEST(Drive, OutOfAPocket) {
  expect_arrivals(hall(box(7000, 10000, 0, 200, 2000) + box(6500, 11000, 0, 1200, 200) +
                       box(6500, 9000, 0, 1200, 200)),
                  {3, 10, 0}, {6, 0}, {.clearance = 0.03, .detour = 2.8, .swings = 30, .late = 3});
}

// KeepOff's berth makes it wind more than past the cupboards alone: 16 swings, where it is 14 with
// 28 cm.
TEST(Drive, ThroughTheOffice) {
  expect_arrivals(sim::load_world(test::source("config/worlds/office.wld")), {1.5, 7, 0}, {16, 1},
                  {.swings = 17});
}

TEST(Drive, AtFullSpeed) {
  expect_arrivals(sim::load_world(test::source("config/worlds/office.wld")), {1.5, 7, 0}, {16, 1},
                  {.swings = 17, .speed = 0.4});
}

class Field : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Field, OfBoxes) {
  expect_arrivals(field(GetParam()), {2, 10, 0}, {12, 0}, {.swings = 16});
}

INSTANTIATE_TEST_SUITE_P(Worlds, Field, ::testing::Range<std::uint64_t>(100, 106));

/// AvoidCollision by itself, as the functor `drive` intends it: when the front is blocked it stops,
/// turns in place until there is a way, and goes on.
TEST(Drive, WandersOnAvoidCollisionAlone) {
  const sim::World world = field(100);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Drive what{.goal_in_odom = {1e6, 0.0},
               .behaviors = {{"avoid", "AvoidCollision", 0, true, {}},
                             {"go", "ConstantVelocity", 2, true, {{"speed", 0.3}}}},
               .limit = 2000,
               .seed = seed};
    const DriveResult run = drive(world, pioneer(), {2, 10, 0}, what);
    EXPECT_EQ(run.contacts, 0);
    EXPECT_GE(run.min_clearance, 0.04);
    EXPECT_GE(run.path, 45.0);  // of 60 m at full speed: it never stays stuck
  }
}

/// StopCollision does not turn: it stops before a wall.
TEST(Drive, StopCollisionStandsBeforeAWall) {
  const sim::World world = hall(box(6000, 10000, 0, 200, 4000));
  Drive what{.goal_in_odom = {1e6, 0.0},
             .behaviors = {{"halt", "StopCollision", 0, true, {}},
                           {"go", "ConstantVelocity", 2, true, {{"speed", 0.4}}}},
             .limit = 200};
  const DriveResult run = drive(world, pioneer(), {3, 10, 0}, what);
  EXPECT_EQ(run.contacts, 0);
  EXPECT_NEAR(run.end_in_world.x, 5.9 - 0.22 - 0.1, 0.1);
  EXPECT_LT(run.path, 2.8);
}

TEST(Drive, TurnToTurnsTheShortWayOnTheSpot) {
  for (const double bearing : {170.0, -170.0, 90.0, -20.0}) {
    Drive what{.goal_in_odom = {1e6, 0.0},
               .behaviors = {{"turn",
                              "TurnTo",
                              2,
                              true,
                              {{"goal", PlacedPoint{{5.0 * std::cos(radians(bearing)),
                                                     5.0 * std::sin(radians(bearing)), 0.0},
                                                    Frame::odom}},
                               {"success_angle", 0.05}}},
                             {"stop", "Stop", 3, true, {}}},
               .limit = 60};
    double goal = 0.0;
    double turned = 0.0;
    double last = 0.0;
    const DriveResult run =
        drive(hall(""), pioneer(), {10, 10, 0}, what,
              [&](const sim::Robot& robot, const Inputs&, const Output& output, const Executive&) {
                turned += norm2_angle(robot.pose_in_odom().th - last);
                last = robot.pose_in_odom().th;
                goal = output.behaviors[0].blended.evaluation.activity.goal;
              });
    EXPECT_NEAR(degrees(turned), bearing, degrees(0.05));
    EXPECT_EQ(goal, 1.0);
    EXPECT_LT(run.path, 0.01);
  }
}

Argument point_argument(std::string name, const Pose& in_odom) {
  return {std::move(name), PlacedPoint{in_odom, Frame::odom}};
}

/// AvoidCollision and KeepOff over `task`.
std::vector<Intended> guarded(Intended task) {
  return {{"avoid", "AvoidCollision", 0, true, {}},
          {"keep off", "KeepOff", 1, true, {}},
          std::move(task),
          {"stop", "Stop", 3, true, {}}};
}

double goal_of(const Output& output, const std::string& name) {
  for (const BehaviorState& state : output.behaviors)
    if (state.name == name)
      return state.blended.evaluation.activity.goal;
  return -1.0;
}

/// Drives until the task reports that its goal is reached; returns the cycles, 0 where it never
/// does.
std::uint64_t drive_until_done(const sim::World& world, const Pose& start, Drive what,
                               const std::string& task, DriveResult& run) {
  std::uint64_t done = 0;
  what.goal_in_odom = {1e6, 0.0};
  run = drive(world, pioneer(), start, what,
              [&](const sim::Robot&, const Inputs& inputs, const Output& output, const Executive&) {
                if (done == 0 && goal_of(output, task) >= 0.99)
                  done = inputs.cycle;
              });
  return done;
}

TEST(Drive, FollowsALaneToItsGoalFromBesideAndAgainstIt) {
  for (const double goal_x : {6.0, -6.0}) {
    Drive what{.behaviors = guarded({"follow",
                                     "Follow",
                                     2,
                                     true,
                                     {point_argument("lane", {0.0, 1.0, 0.0}),
                                      point_argument("goal", {goal_x, 1.0, 0.0})}}),
               .limit = 450};
    DriveResult run;
    const std::uint64_t done =
        drive_until_done(hall(""), {10, 10, radians(40)}, what, "follow", run);
    // The lane's frame is odom's, which begins at the start, turned by 40 degrees.
    const Pose end = relative({10, 10, radians(40)}, run.end_in_world);
    EXPECT_GT(done, 0U);
    EXPECT_NEAR(end.x, goal_x, 0.4);
    EXPECT_NEAR(end.y, 1.0, 0.3);  // in the lane, by a dead reckoning that drifts
    EXPECT_LT(run.path, 9.0);
  }
}

/// Along odom's x axis, `aside` [m] to its left, up to x = `far` [m].
Drive along_a_corridor(std::uint64_t seed, double width, double aside, double far) {
  Drive what;
  what.seed = seed;
  what.behaviors = guarded({"corridor",
                            "FollowCorridor",
                            2,
                            true,
                            {point_argument("corridor", {3.0, aside, 0.0}),
                             point_argument("goal", {far, aside, 0.0}),
                             {"width", width}}});
  what.limit = 500;
  return what;
}

TEST(Drive, FollowsACorridor) {
  const sim::World world = hall(box(9000, 9000, 0, 12000, 200) + box(9000, 11000, 0, 12000, 200));
  double swings = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Drive what = along_a_corridor(seed, 1.8, 0.3, 9.0);
    DriveResult run;
    EXPECT_GT(drive_until_done(world, {4, 9.7, radians(0)}, what, "corridor", run), 0U);
    EXPECT_EQ(run.contacts, 0);
    EXPECT_GE(run.min_clearance, 0.2);
    swings += static_cast<double>(run.swings) / kSeeds;
  }
  EXPECT_LE(swings, 3.5);
}

/// A cupboard narrows a corridor to 1.5 m: the robot drives in the middle of the gap.
TEST(Drive, FollowsACorridorPastACupboard) {
  const sim::World world = hall(box(9000, 8900, 0, 12000, 200) + box(9000, 11100, 0, 12000, 200) +
                                box(7000, 9225, 0, 900, 450));
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Drive what = along_a_corridor(seed, 2.0, 0.0, 7.0);
    DriveResult run;
    EXPECT_GT(drive_until_done(world, {4, 10, radians(0)}, what, "corridor", run), 0U);
    EXPECT_EQ(run.contacts, 0);
    EXPECT_GE(run.min_clearance, 0.4) << "seed " << seed;
  }
}

/// A wall with a door in it, beside a corridor; the robot comes along the corridor.
TEST(Drive, FollowsADoorInAndOut) {
  const sim::World world = hall(box(10000, 9000, 0, 12000, 200) +  // the corridor's far wall
                                box(6550, 11000, 0, 6000, 200) + box(13450, 11000, 0, 6000, 200));
  // The doorway is 900 mm wide, its middle (10, 11) in the world; out is towards -y.
  const Pose door{10, 11, radians(-90)};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    for (const Pose& start :
         {Pose{9.3, 10, 0}, Pose{10.8, 10.0, kPi}, Pose{9.8, 12.8, radians(-90)}}) {
      const bool in = start.y < 11;
      Drive what;
      what.seed = seed;
      what.behaviors = guarded({"door",
                                "FollowDoor",
                                2,
                                true,
                                {point_argument("door", relative(start, door)),
                                 {"direction", std::string(in ? "in" : "out")}}});
      what.limit = 300;
      DriveResult run;
      EXPECT_GT(drive_until_done(world, start, what, "door", run), 0U)
          << "seed " << seed << " from " << start.x << ", " << start.y << " to "
          << run.end_in_world.x << ", " << run.end_in_world.y;
      EXPECT_EQ(run.contacts, 0);
      EXPECT_GE(run.min_clearance, 0.04);
    }
}

TEST(Drive, AttendsAtAPosition) {
  Drive what{.behaviors = guarded({"attend",
                                   "AttendAtPos",
                                   2,
                                   true,
                                   {point_argument("goal", {-3.0, 2.0, 0.0}), {"radius", 1.0}}}),
             .limit = 300};
  DriveResult run;
  EXPECT_GT(drive_until_done(hall(""), {10, 10, 0}, what, "attend", run), 0U);
  const Pose goal = relative(run.end_in_world, {7, 12, 0});
  EXPECT_NEAR(std::hypot(goal.x, goal.y), 0.9, 0.15);
  EXPECT_NEAR(std::atan2(goal.y, goal.x), 0.0, 0.1);
}

/// The example of manual 7.2, from its file. As printed it turns away from obstacles beside it, and
/// runs into obstacles straight ahead.
TEST(Drive, TheManualsExample) {
  struct Case {
    const char* schema;
    double radius;
    Vec2 goal;
    bool arrives;
  };
  for (const Case& one :
       {Case{"myGoto", 400.0, {4.0, 0.0}, true}, Case{"myGoto", 400.0, {3.0, 3.0}, false},
        Case{"myGotoCorrected", 0.4, {3.0, 3.0}, true},
        Case{"myGotoCorrected", 0.4, {-3.0, 0.5}, true}}) {
    Drive what;
    what.goal_in_odom = one.goal;
    what.radius = 0.81;  // where near_goal is a half the speed is none
    what.limit = 500;
    what.behaviors = {
        {"go",
         one.schema,
         2,
         true,
         {point_argument("goal_pt", {one.goal.x(), one.goal.y(), 0.0}), {"radius", one.radius}}},
        {"stop", "Stop", 3, true, {}}};
    const DriveResult run = drive(hall(""), pioneer(), {10, 10, 0}, what);
    EXPECT_EQ(run.arrived, one.arrives) << one.schema << " to " << one.goal.transpose();
  }
}

}  // namespace
}  // namespace saphira::behaviors
