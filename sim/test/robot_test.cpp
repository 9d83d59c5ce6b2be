#include "saphira/sim/robot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "saphira/base/random.hpp"
#include "saphira/sim/scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

const char* const kEmpty = "width 100000 height 100000";

/// A robot without another.
struct Alone {
  explicit Alone(const RobotParameters& parameters = {}, const Pose& start = {},
                 std::uint64_t seed = 1)
      : world(parse_world(kEmpty, "test.wld")),
        scene(world),
        robot(scene.add_robot(parameters, start, seed)) {}
  Robot* operator->() const { return &robot; }

  World world;
  Scene scene;
  Robot& robot;
};

void run(Robot& robot, int ticks) {
  for (int i = 0; i < ticks; ++i)
    robot.tick();
}
void run(const Alone& alone, int ticks) {
  run(alone.robot, ticks);
}
void turn_to(const Alone& alone, double heading, int ticks) {
  alone->set_heading(heading);
  run(alone, ticks);
}

// Manual Figure 5-2.
TEST(Robot, TurnsByATrapezoid) {
  RobotParameters parameters;
  const Alone robot(parameters);
  robot->set_heading(radians(170.0));
  std::vector<double> speeds;
  for (int i = 0; i < 400; ++i) {
    robot->tick();
    speeds.push_back(robot->rotation_velocity());
    ASSERT_LE(robot->pose_in_odom().th, radians(170.0) + 0.002) << "overshoot";
  }
  EXPECT_NEAR(robot->pose_in_odom().th, radians(170.0), 0.002);
  EXPECT_FALSE(robot->moving());
  const double top = *std::ranges::max_element(speeds);
  EXPECT_NEAR(top, parameters.max_rotation_velocity, 1e-9);
  const double step = parameters.rotation_acceleration * kTick;
  EXPECT_NEAR(speeds[9], 10 * step, 1e-9);  // the rising side
  for (std::size_t i = 1; i < speeds.size(); ++i)
    ASSERT_LE(std::abs(speeds[i] - speeds[i - 1]), step + 1e-9);
  // 170 degrees at 100 deg/s with both ramps of 1/3 s: 1.7 + 1/3 s.
  const auto done = std::find(speeds.begin() + 10, speeds.end(), 0.0) - speeds.begin();
  EXPECT_NEAR(static_cast<double>(done) * kTick, 2.03, 0.1);
}

// The time of the fastest motion straight on or on the spot.
double wheel_limit(const RobotParameters& p) {
  return std::max(p.max_velocity, p.max_rotation_velocity / p.rotation_per_difference);
}

TEST(Robot, BeyondTheWheelsLimitItStaysOnTheArc) {
  const RobotParameters parameters;
  for (const double forward : {0.4, -0.4})
    for (const double turn : {radians(100.0), radians(-40.0)}) {
      const Alone robot(parameters);
      robot->set_velocity(forward);
      robot->set_rotation_velocity(turn);
      run(robot, 300);
      EXPECT_NEAR(robot->rotation_velocity() / robot->velocity(), turn / forward, 1e-9);
      const double faster =
          std::max(std::abs(robot->left_velocity()), std::abs(robot->right_velocity()));
      EXPECT_NEAR(faster, wheel_limit(parameters), 1e-9);
    }
}

TEST(Robot, WheelVelocitiesBeyondTheLimitKeepTheirRatio) {
  const RobotParameters parameters;
  const std::vector<std::pair<double, double>> asked{{2.0, 0.1}, {0.1, -2.0}, {0.5, 0.4},
                                                     {1.0, 1.0}, {-0.6, 0.6}, {0.52, 0.25}};
  for (const auto& [left, right] : asked) {
    const Alone robot(parameters);
    robot->set_wheel_velocities(left, right);
    run(robot, 300);
    EXPECT_NEAR(robot->left_velocity() * right, robot->right_velocity() * left, 1e-9);
    EXPECT_GT(std::abs(robot->left_velocity()) + std::abs(robot->right_velocity()), 0.5);
    EXPECT_LE(std::abs(robot->left_velocity()), wheel_limit(parameters) + 1e-9);
    EXPECT_LE(std::abs(robot->right_velocity()), wheel_limit(parameters) + 1e-9);
  }
}

TEST(Robot, TheWheelsLimitChangesNothingThatItDoesNotReach) {
  const World world = parse_world(kEmpty, "empty.wld");
  RobotParameters parameters;
  RobotParameters faster = parameters;
  faster.max_velocity = 10.0;
  Scene scene(world);
  Robot& robot = scene.add_robot(parameters, {}, 1);
  Robot& other = scene.add_robot(faster, {20.0, 0.0, 0.0}, 1);
  const double turn = 0.99 * (wheel_limit(parameters) - 0.3) * parameters.rotation_per_difference;
  for (Robot* each : {&robot, &other}) {
    each->set_velocity(0.3);
    each->set_rotation_velocity(turn);
    run(*each, 100);
    each->set_wheel_velocities(0.25, 0.52);
    run(*each, 100);
    each->set_velocity(0.0);
    each->set_heading(1.0);
    run(*each, 200);
  }
  EXPECT_EQ(robot.pose_in_odom(), other.pose_in_odom());
}

// A random command of a client; true for an emergency stop.
bool command_at_random(Robot& robot, const RobotParameters& p, Random& random) {
  const double v = random.uniform(-1.5, 1.5) * p.max_velocity;
  const double w = random.uniform(-1.5, 1.5) * p.max_rotation_velocity;
  switch (random.next() % 8) {
    case 0:
      robot.set_velocity(v);
      break;
    case 1:
      robot.set_rotation_velocity(w);
      break;
    case 2:
      robot.set_heading(w);
      break;
    case 3:
      robot.move_by(v);
      break;
    case 4:
      robot.set_wheel_velocities(v, random.uniform(-1.5, 1.5) * p.max_velocity);
      break;
    case 5:
      robot.emergency_stop();
      return true;
    case 6:
      robot.brake(random.chance(0.3));
      break;
    default:
      robot.set_velocity(v);
      robot.set_rotation_velocity(w);
  }
  return false;
}

TEST(Robot, NoWheelIsEverFasterThanItsLimitAndNoSpeedJumps) {
  RobotParameters slow_to_turn;
  slow_to_turn.max_velocity = 2.2;
  slow_to_turn.max_rotation_velocity = radians(500.0);
  slow_to_turn.rotation_per_difference = 5.6;
  slow_to_turn.acceleration = slow_to_turn.deceleration = 3.0;
  slow_to_turn.rotation_acceleration = slow_to_turn.rotation_deceleration = radians(100.0);
  RobotParameters slow_to_drive = slow_to_turn;
  slow_to_drive.acceleration = slow_to_drive.deceleration = 0.3;
  slow_to_drive.rotation_acceleration = slow_to_drive.rotation_deceleration = radians(1000.0);
  for (const RobotParameters& p : {RobotParameters{}, slow_to_turn, slow_to_drive}) {
    const Alone robot(p);
    Random random(7, 0);
    bool emergency = false;  // until it stands
    double at_limit = 0.0;   // [s]
    double forward = 0.0;
    double turn = 0.0;
    for (int i = 0; i < 1000; ++i) {
      emergency |= command_at_random(robot.robot, p, random);
      for (auto ticks = random.next() % 200; ticks > 0; --ticks) {
        robot->tick();
        const double left = robot->left_velocity();
        const double right = robot->right_velocity();
        const double faster = std::max(std::abs(left), std::abs(right));
        ASSERT_LE(faster, wheel_limit(p) + 1e-9);
        at_limit += faster > wheel_limit(p) - 1e-6 ? kTick : 0.0;
        const double most = std::max({p.acceleration, p.deceleration, emergency ? 6.0 : 0.0});
        ASSERT_LE(std::abs((left + right) / 2.0 - forward), most * kTick + 1e-9);
        const double most_turn = std::max(p.rotation_acceleration, p.rotation_deceleration);
        ASSERT_LE(std::abs(robot->rotation_velocity() - turn), most_turn * kTick + 1e-9);
        forward = (left + right) / 2.0;
        turn = robot->rotation_velocity();
        emergency = emergency && robot->moving();
      }
    }
    EXPECT_GT(at_limit, 1.0);
  }
}

// Manual Table 3-1 with the Pioneer's values, as a person would measure them: 10 m by dead
// reckoning, and one revolution by dead reckoning, against the true motion. The figures are those
// of sim/README.md.
TEST(Robot, TenMetresAndOneRevolution) {
  RobotParameters parameters;
  parameters.encode_jitter = 0.01;
  parameters.angle_jitter = 0.02;
  parameters.angle_drift = 0.003;
  constexpr int kRobots = 1000;
  double along = 0.0;
  double along_squares = 0.0;
  double aside = 0.0;
  double heading = 0.0;
  double turned = 0.0;
  double turned_squares = 0.0;
  int left = 0;  // of the robots
  for (int i = 0; i < kRobots; ++i) {
    const Alone robot(parameters, {50.0, 50.0, 0.0}, static_cast<std::uint64_t>(i) + 1);
    robot->set_heading(0.0);
    robot->move_by(10.0);
    run(robot, 2700);
    ASSERT_FALSE(robot->moving());
    ASSERT_NEAR(robot->left_way() + robot->right_way(), 20.0, 0.01);
    along += robot->pose_in_world().x - 60.0;
    along_squares += std::pow(robot->pose_in_world().x - 60.0, 2);
    aside += std::abs(robot->pose_in_world().y - 50.0);
    left += robot->pose_in_world().y > 50.0 ? 1 : 0;
    // The heading servo holds straight on by dead reckoning, within its deadband.
    heading += std::abs(robot->pose_in_world().th);
    const double before = norm2_angle(robot->pose_in_world().th - robot->pose_in_odom().th);
    for (const double target : {120.0, 240.0, 360.0}) {
      turn_to(robot, radians(target), 250);
    }
    const double error = norm2_angle(robot->pose_in_world().th - robot->pose_in_odom().th - before);
    turned += error;
    turned_squares += error * error;
  }
  EXPECT_NEAR(along / kRobots, 0.0, 0.005);
  EXPECT_NEAR(std::sqrt(along_squares / kRobots), 0.01 * std::sqrt(10.0), 0.003);  // 32 mm
  EXPECT_NEAR(aside / kRobots, 0.5 * 0.003 * 10.0 * 10.0, 0.010);                  // 15 cm
  EXPECT_NEAR(left, 0.5 * kRobots, 63) << "four standard errors";
  EXPECT_NEAR(heading / kRobots, 0.03, 0.002);
  EXPECT_NEAR(turned / kRobots, 0.0, 0.006);
  RecordProperty("along_mm", static_cast<int>(1000.0 * std::sqrt(along_squares / kRobots)));
  RecordProperty("aside_mm", static_cast<int>(1000.0 * aside / kRobots));
  RecordProperty("turn_mdeg",
                 static_cast<int>(1000.0 * degrees(std::sqrt(turned_squares / kRobots))));
  EXPECT_NEAR(std::sqrt(turned_squares / kRobots), 0.02 * std::sqrt(2.0 * kPi), 0.005);  // 2.9 deg
}

TEST(Robot, MovesAWayByATrapezoid) {
  const Alone robot;
  robot->move_by(1.0);
  double top = 0.0;
  double last = 0.0;
  for (int i = 0; i < 500; ++i) {
    robot->tick();
    top = std::max(top, robot->velocity());
    ASSERT_LE(robot->velocity() - last, 0.5 * kTick + 1e-9);
    ASSERT_LE(last - robot->velocity(), 2.0 * kTick + 1e-9);
    last = robot->velocity();
    ASSERT_LE(robot->pose_in_odom().x, 1.0005);
  }
  EXPECT_NEAR(robot->pose_in_odom().x, 1.0, 0.001);
  EXPECT_DOUBLE_EQ(top, 0.4);
  EXPECT_FALSE(robot->moving());
}

}  // namespace
}  // namespace saphira::sim
