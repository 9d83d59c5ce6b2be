#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/protocol/parameters.hpp"
#include "saphira/ros2/messages.hpp"
#include "saphira/sim/server.hpp"

namespace saphira::ros2 {

/// The nearest object in the sector of each sonar, from the rays of a laser (REP 117): a sector is
/// half of the angle to the next sonar to either side, 8 degrees at least and 15 at most. A sonar
/// without a ray that is good has no reading.
std::vector<sim::SonarEcho> echoes(const LaserScan& scan, const Eigen::Isometry3d& laser_in_robot,
                                   const protocol::RobotParameters& robot);

/// A robot that only speaks ROS 2, as a robot server of the packet protocol: the simulator's, whose
/// motors are cmd_vel, and whose body is elsewhere. Times are seconds of a clock that does not
/// jump.
///
/// It begins with cmd_vel of no motion: the program before it may have been killed.
/// While its odometry or its ranges are too old, or nobody takes cmd_vel, the robot is silent for
/// its client, and is told to stand.
class Base {
 public:
  /// [s] Older messages do not count.
  static constexpr double kLost = 0.5;
  /// [s] from one cmd_vel to the next.
  static constexpr double kPeriod = 0.05;

  /// laser_in_robot: of every scan; none: as tf_static says.
  Base(const protocol::RobotParameters& robot, const std::optional<Pose>& laser_in_robot,
       double now);

  // ---- Messages. False where the numbers cannot be: as if it had not come.

  bool take(const Odometry& odometry, double now);
  bool take(const LaserScan& scan, double now);
  bool take(const Range& range, double now);
  void take(const TFMessage& transforms);
  void take(const BatteryState& battery);
  /// True: cmd_vel has a reader.
  void heard(bool is_heard) { is_heard_ = is_heard; }

  // ---- The client.

  void receive(protocol::ByteView bytes);
  /// The client is gone: the robot is told to stand at once.
  void disconnect();

  struct Output {
    protocol::Bytes to_client;
    std::optional<Twist> cmd_vel;
  };
  /// Lets time pass, up to now; every 10 ms or so.
  Output advance(double now);

  /// The reason why the robot is silent; empty: it is not.
  std::string trouble(double now) const;
  /// The frame of the robot's odometry that moves with it.
  const std::string& frame() const { return frame_; }

 private:
  struct Stream {
    std::optional<double> came;
    Time stamp;
    bool is_new(const Time& of, double now);
    bool lives(double now) const { return came && now - *came <= kLost; }
  };
  struct Fixed {
    std::string parent;
    Eigen::Isometry3d in_parent;
  };
  bool hear(const LaserScan& scan, const std::optional<Eigen::Isometry3d>& in_robot, Stream& stream,
            double now);
  std::optional<Eigen::Isometry3d> place(std::string frame) const;

  protocol::RobotParameters robot_;
  std::optional<Eigen::Isometry3d> laser_in_robot_;
  sim::World world_;
  sim::Scene scene_;
  sim::Server server_;
  sim::Measured body_;
  std::string frame_ = "base_link";
  std::map<std::string, Fixed> fixed_;  // by frame
  Stream odometry_, scan_;
  std::map<std::string, Stream> ranges_;  // by frame
  std::string bad_ranges_;                // the reason why readings do not count
  bool is_heard_ = false;
  double began_;
  std::int64_t ticks_ = 0;
  double wrote_;
  Twist written_;
  int rests_;  // to be written, at the begin and after the last motion
};

}  // namespace saphira::ros2
