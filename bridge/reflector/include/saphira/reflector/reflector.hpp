#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/reflector/channels.hpp"
#include "saphira/reflector/devices.hpp"
#include "saphira/reflector/motion.hpp"
#include "saphira/reflector/odometry.hpp"

namespace saphira::reflector {

/// The newest reading of one sonar (manual 6.3.2).
struct Bucket {
  protocol::Sonar reading;
  std::uint64_t cycle = 0;  ///< of the packet that it came with
  Pose pose_in_odom;        ///< of the robot, by that packet
  /// [m] the place of the reading on the sonar's axis, in the frame of the robot at that packet;
  /// meaningless without an echo.
  Vec2 point = Vec2::Zero();
};

/// The robot as its newest packet shows it (manual Tables 5-5 and 6-2).
struct State {
  std::uint64_t cycle = 0;  ///< packets since the connection was opened
  std::uint64_t odom = 0;
  Pose pose_in_odom;
  protocol::Information information;
  double target_velocity = 0.0;         ///< [m/s] sent last
  double target_heading_in_odom = 0.0;  ///< [rad] the server's own heading setpoint
  unsigned motor_packets_per_s = 0;
  unsigned sonar_readings_per_s = 0;
  std::vector<Bucket> buckets;  ///< by sonar; those that have fired in this odom frame
};

/// The state reflector (manual 6.3): information packets in, the robot's state out; setpoints in,
/// command packets out, until the state shows them. Knows no clock: every call gets the time in
/// seconds (the steady clock live, cycles x 0.1 s in lockstep).
class Reflector {
 public:
  void configure(const protocol::RobotParameters& parameters);
  const protocol::RobotParameters& parameters() const { return parameters_; }
  /// Takes a robot whose generation is assumed for one of ARCOS where its packet has fields that
  /// ARCOS alone sends. True where it did so now.
  bool recognize(const protocol::InformationPacket& packet);

  /// The server was opened. `memory`: of the odom frame before, if any; `fresh`: the number of a
  /// new frame. Zero setpoints are due at once.
  void open(double now, std::optional<OdometryMemory> memory, std::uint64_t fresh,
            const Slack& slack = {});
  /// The robot's greatest way while unheard, from now until its own watchdog stops it.
  Slack slack() const;

  /// A packet. `fresh`: the number of the odom frame that begins where continuity is lost.
  const State& packet(const protocol::InformationPacket& packet, double now, std::uint64_t fresh);
  const State& state() const { return state_; }
  const OdometryMemory& odometry() const { return odometry_.memory(); }

  /// Direct motion control: the driver's wish. It is not sent as it is: see hold().
  void set(const Motion& motion) { motion_.set(motion, state_.pose_in_odom); }
  void stop() { motion_.stop(); }
  const DirectMotion& motion() const { return motion_; }
  /// Zero setpoints are due at once, whatever was sent before: another client may have used the
  /// server meanwhile.
  void zero_first() {
    motion_.stop();
    channels_.connect();
  }

  /// The setpoints that the server is to hold: motion() after the guard.
  void hold(const Setpoints& setpoints);
  /// The hardest stop that the server has, instead of setpoints, until hold() is called again.
  void emergency_stop();
  /// Requests to the devices, and their results.
  void request(const Request& request) { devices_.request(request, parameters_); }
  Devices& devices() { return devices_; }

  /// The commands to be sent now. Includes a PULSE where nothing else was sent for half a second.
  /// `room` [bytes]: the line's room for requests to the devices.
  std::vector<protocol::Command> due(double now, std::size_t room = SIZE_MAX);
  bool pending(double now) const { return channels_.pending(now) || devices_.pending(now); }
  double sent_velocity() const { return channels_.sent_velocity(); }

  SAPHIRA_ARCHIVE(parameters_, odometry_, motion_, channels_, devices_, state_, last_packet_,
                  last_sent_, packet_times_, sonar_times_)

 private:
  void fill_buckets();

  protocol::RobotParameters parameters_;
  Odometry odometry_;
  DirectMotion motion_;
  Channels channels_;
  Devices devices_;
  State state_;
  double last_packet_ = 0.0;
  double last_sent_ = 0.0;
  std::deque<double> packet_times_;
  std::deque<std::pair<double, std::size_t>> sonar_times_;
};

}  // namespace saphira::reflector
