#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::authority {

/// One sonar reading that came back with an echo.
struct Echo {
  int sonar = 0;
  Pose robot_in_odom;  ///< when the packet with the reading was made
  Pose sonar_in_robot;
  double range = 0.0;  ///< [m] along the sonar's axis
};

/// One that fired without an echo.
struct Silence {
  int sonar = 0;
  Pose sonar_in_robot;
};

/// The body that is guarded.
struct Body {
  double radius = 0.0;                 ///< [m] of the hull, a circle
  double max_velocity = 0.0;           ///< [m/s]
  double max_rotation_velocity = 0.0;  ///< [rad/s]
  double deceleration = 0.0;           ///< [m/s2] of a stop
  bool sees_behind = false;            ///< some sonar within 60 degrees of straight back fires
  bool sees_ahead = true;              ///< the same of straight ahead
};

/// What the guard does for one role. The defaults make it the last resort: at 0.3 m/s it acts
/// inside 0.2 m ahead of the hull, well within what AvoidCollision steers around, and never for
/// what stands beside the path.
struct GuardSettings {
  bool enabled = true;
  double max_velocity = 0.0;           ///< [m/s]; 0: the robot's own
  double max_blind_velocity = 0.15;    ///< [m/s] to where no sonar sees; 0: the robot's own
  double max_rotation_velocity = 0.0;  ///< [rad/s]; 0: the robot's own
  double margin = 0.06;       ///< [m] the hull is to stand at least so far from what is ahead
  double side_margin = 0.01;  ///< [m] by which the path is wider than the hull, each side
  double reaction = 0.3;      ///< [s] until a stop takes effect: sonar cycle, link, server
  double max_contact_velocity = 0.15;  ///< [m/s] of a driver who means contact; 0: never
  double slow_distance = 0.0;          ///< [m] below which slow_velocity holds; 0: none
  double slow_velocity = 0.15;         ///< [m/s]
};

enum class GuardAction { none, limit, slow, stop };

struct Guarded {
  double velocity = 0.0;           ///< [m/s]
  double rotation_velocity = 0.0;  ///< [rad/s]
  GuardAction action = GuardAction::none;
  std::string reason;
};

/// The newest echo of each sonar, in odom, for as long as it says something about now.
class Echoes {
 public:
  /// A packet came, with these new readings. Twice in a row without an echo means that what a sonar
  /// saw is gone (once happens to a slanted wall). Older than `kept_cycles` is forgotten.
  void update(std::uint64_t cycle, const std::vector<Echo>& echoes,
              const std::vector<Silence>& silent);
  void clear() { *this = {}; }
  /// Whether sonars look to where the robot goes: some fired within `kept_cycles`.
  bool sees(std::uint64_t cycle, bool ahead) const;
  /// The points, in the robot's frame at `robot_in_odom`.
  std::vector<Vec2> seen_from(const Pose& robot_in_odom) const;

  /// A Pioneer's sonars fire every third cycle; a second of silence means that polling is off.
  std::uint64_t kept_cycles = 10;

 private:
  struct Point {
    Vec2 in_odom;
    std::uint64_t cycle;
    int missed;
  };
  void fired(std::uint64_t cycle, const Pose& sonar_in_robot);

  std::map<int, Point> newest_;
  /// The newest cycle in which one fired that points ahead, or back. 0 at the beginning: sonars
  /// that have not had their turn may yet fire.
  std::uint64_t fired_ahead_ = 0;
  std::uint64_t fired_behind_ = 0;
};

/// Free distance [m] of the hull along its straight path (forward, or backward) until the first of
/// `points` (robot frame) comes within the hull and its side margin; infinity where none does.
double free_distance(const std::vector<Vec2>& points, double radius, double side_margin,
                     bool forward);

/// Cuts a wanted motion to what is safe now. Pure. Not for the emergency stop: that only stops.
/// Rotation on the spot is never stopped: the hull is round, and turning is the way out.
/// `contact_speed`: the driver means to touch what is ahead, forward and at no more than this
/// [m/s]; 0: it does not.
Guarded guard(const GuardSettings& settings, const Body& body, const std::vector<Vec2>& points,
              double velocity, double rotation_velocity, double contact_speed = 0.0);

}  // namespace saphira::authority
