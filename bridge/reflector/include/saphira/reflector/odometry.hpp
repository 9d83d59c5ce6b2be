#pragma once

#include <cstdint>
#include <optional>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::reflector {

/// The server's dead reckoning as it comes: position counters of 15 bits that roll over (manual
/// 5.5.1), heading.
struct RawPose {
  std::uint16_t x = 0;  ///< 15 bits
  std::uint16_t y = 0;  ///< 15 bits
  double th = 0.0;      ///< [rad] in the server's own frame

  template <class Archive>
  void archive(Archive& a) {
    a.members(*this);
    a.expect(x <= 0x7FFF && y <= 0x7FFF, "15 bits");
  }
};

/// The state by which an odom frame continues later: over a reconnection, or a restart of the
/// bridge.
struct OdometryMemory {
  std::uint64_t odom = 0;    ///< the frame's number
  RawPose raw = {};          ///< of the newest packet
  Pose raw_unwrapped = {};   ///< the same without the roll-over [m, rad], server's frame
  Pose server_in_odom = {};  ///< pose of the server's frame in odom
};

/// The greatest way of an unheard robot.
struct Slack {
  double distance = 0.0;  ///< [m]
  double angle = 0.0;     ///< [rad]
};

/// Unwraps the position counters and gives their odom frame.
class Odometry {
 public:
  struct Settings {
    double distance_unit = 0.001;            ///< [m] of one count
    double near_distance = 0.3;              ///< [m] nearer: the robot was not carried away
    double near_angle = 20.0 * kPi / 180.0;  ///< [rad]
    double max_velocity = 1.0;               ///< [m/s] a faster motion is a jump of the counters
    double max_rotation_velocity = kPi;      ///< [rad/s] a faster turn is a jump of the heading
  };

  Odometry() = default;
  explicit Odometry(Settings settings) : settings_(settings) {}
  void configure(Settings settings) { settings_ = settings; }

  /// A connection begins. The first packet after it goes on with the remembered frame when its raw
  /// pose is near the remembered one, and is not the exact (0, 0, 0) of a power-up; otherwise it
  /// begins frame `fresh` at (0, 0, 0). `slack` makes "near" wider, as far as the counters allow.
  void connect(std::optional<OdometryMemory> memory, std::uint64_t fresh, const Slack& slack = {});
  /// A packet, `dt` seconds after the last. An impossible jump begins frame `fresh`. True where a
  /// frame began.
  bool update(const RawPose& raw, double dt, std::uint64_t fresh);

  std::uint64_t odom() const { return memory_.odom; }
  const Pose& pose_in_odom() const { return pose_; }
  /// The rotation from the server's frame to odom [rad]: heading_in_odom = heading + this.
  double rotation() const { return memory_.server_in_odom.th; }
  const OdometryMemory& memory() const { return memory_; }
  /// The last packet's way along the robot's own heading [m].
  double advance() const { return advance_; }

  SAPHIRA_ARCHIVE(settings_, first_, remembered_, fresh_, slack_, memory_, pose_, advance_)

 private:
  void begin(const RawPose& raw, std::uint64_t odom);

  Settings settings_;
  bool first_ = true;
  std::optional<OdometryMemory> remembered_;
  std::uint64_t fresh_ = 0;
  Slack slack_;
  OdometryMemory memory_;
  Pose pose_;
  double advance_ = 0.0;
};

}  // namespace saphira::reflector
