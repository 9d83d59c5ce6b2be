#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "saphira/behaviors/executive.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/sonar.hpp"
#include "saphira/sim/world.hpp"

// The executive and the simulated robot in one loop, without packets: the quality of the behaviors.
namespace saphira::behaviors {

struct Drive {
  Vec2 goal_in_odom{0.0, 0.0};  ///< odom begins at the start, looking along the start's heading
  std::vector<Intended> behaviors;
  double radius = 0.15;        ///< [m] near enough
  std::uint64_t limit = 1500;  ///< [cycles]
  std::uint64_t seed = 1;
  sim::SonarModel sonar;
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
inline std::vector<Intended> go_to(const Vec2& goal_in_odom, double speed = 0.3,
                                   double radius = 0.15) {
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

inline DriveResult drive(const sim::World& world, const protocol::RobotParameters& parameters,
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

}  // namespace saphira::behaviors
