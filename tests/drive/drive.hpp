#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/authority/echo_map.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/sonar.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::test {

struct DriveOptions {
  std::string world = "office-floor";            ///< a name of config/worlds
  std::shared_ptr<const sim::World> made_world;  ///< instead of it
  std::string robot = "pioneer";                 ///< a name of config/robots
  std::uint64_t seed = 1;
  double errors = 1.0;  ///< factor on the robot's dead-reckoning errors (manual Table 3-1)
  std::optional<Pose> start_in_world;  ///< else the world's own
  sim::SonarModel sonar;
  bool guard = false;  ///< beside the robot, as in the bridge: it makes drives slower
  /// Else the predefined ones.
  std::optional<behaviors::Registry> behaviors;
};

/// What one cycle brings, and the truth beside it.
struct Seen {
  std::uint64_t cycle = 0;
  Pose pose_in_odom;  ///< (0, 0, 0) at the start
  double velocity = 0.0;
  double rotation_velocity = 0.0;
  std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
  Pose true_pose_in_world;
  bool left_stalled = false;
  bool right_stalled = false;
};

/// A robot in a world that drives towards points with AvoidCollision, KeepOff and GoToPos, as the
/// functor go_to does; cycle by cycle, repeatable to the last bit.
class Drive {
 public:
  explicit Drive(const DriveOptions& options);
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  /// Moves the world by one cycle under what was asked for last.
  const Seen& advance();

  /// What is asked for from the next cycle on.
  void go_to(const Vec2& goal_in_odom, double speed = 0.3, double radius = 0.15);
  void turn_to(double heading_in_odom);
  void stop();
  /// By hand, without behaviors: [m/s], and the heading in odom [rad].
  void drive(double speed, double heading_in_odom);
  /// These behaviors, as intentions would intend them.
  void intend(std::vector<behaviors::Intended> intended, bool control = true);

  /// What the behaviors made of it in the newest cycle.
  const behaviors::Output& output() const { return output_; }
  behaviors::Executive& executive() { return executive_; }

  const Seen& seen() const { return seen_; }
  const sim::World& world() const { return world_; }
  const protocol::RobotParameters& parameters() const { return parameters_; }
  std::vector<lps::SonarMount> mounts() const;
  /// What the guard made of it in the newest cycle.
  const authority::Guarded& guarded() const { return guarded_; }
  sim::Scene& scene() { return scene_; }
  sim::Robot& robot() { return *robot_; }
  int contacts() const;

 private:
  double guard(double speed);

  protocol::RobotParameters parameters_;
  sim::World world_;
  sim::Scene scene_;
  sim::Robot* robot_;
  sim::Sonars sonars_;
  behaviors::Executive executive_;
  behaviors::Intent intent_;
  behaviors::Output output_;
  std::vector<behaviors::Intended> intended_;
  bool has_guard_;
  authority::Body body_;
  authority::EchoMap echoes_;
  authority::Guarded guarded_;
  bool control_ = true;
  bool by_hand_ = false;
  double speed_ = 0.0;
  double heading_ = 0.0;
  Seen seen_;
};

/// Settings of a service that listens to the robot's sonars.
template <class Settings>
Settings with_sonars(const Drive& drive, Settings settings = {}) {
  settings.sonars = drive.mounts();
  return settings;
}

/// Drives through points one after the other, over and over where `loop` is set: go_to each, the
/// next one when it is nearer than `radius`. The points are in the map; the caller says each cycle
/// where the robot believes to be, or is.
class Tour {
 public:
  Tour(std::vector<Vec2> points_in_map, bool loop, double radius = 0.5, double speed = 0.3)
      : points_(std::move(points_in_map)), loop_(loop), radius_(radius), speed_(speed) {}

  /// False when the last point is reached; the robot is told to stop then.
  bool act(Drive& drive, const Pose& pose_in_map);
  std::size_t reached() const { return reached_; }
  /// Gives up the present point for the next one.
  void skip() { ++at_; }

 private:
  std::vector<Vec2> points_;
  bool loop_;
  double radius_;
  double speed_;
  std::size_t at_ = 0;
  std::size_t reached_ = 0;
};

}  // namespace saphira::test
