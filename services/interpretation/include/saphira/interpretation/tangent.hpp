#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/percept.hpp"

namespace saphira::interpretation {

/// One firing of a sonar, with its place.
struct Return {
  Vec2 sonar{0.0, 0.0};  ///< [m] in odom
  Vec2 axis{1.0, 0.0};   ///< of the beam, a unit vector in odom
  double range = 0.0;    ///< [m]; meaningless without an echo
  bool echo = false;
  bool steady = true;  ///< false: the turn was too fast for a certain bearing
  lps::ReadingId id;
  double travelled = 0.0;  ///< [m] the robot's way so far...
  double turned = 0.0;     ///< [rad] ...and turned, to and fro
  std::uint32_t line = 0;  ///< the line of its echo; 0: none
};

/// The points p with normal * p = offset. The normal points away from the robot's side.
struct Line {
  Vec2 normal{1.0, 0.0};
  double offset = 0.0;

  Vec2 along() const { return {-normal.y(), normal.x()}; }
  Vec2 at(double u) const { return offset * normal + u * along(); }
  /// From the sonar to the line [m], positive on the robot's side.
  double distance(const Vec2& sonar) const { return offset - normal.dot(sonar); }
  /// The foot of the perpendicular along it [m].
  double u(const Vec2& sonar) const { return along().dot(sonar); }
};

struct LineFit {
  Line line;
  double rms = 0.0;            ///< [m] of the ranges about it, by weight
  double u_mean = 0.0;         ///< [m] the place of least error
  double sigma_offset = 0.0;   ///< [m] at u_mean
  double sigma_heading = 0.0;  ///< [rad]
};

/// The line that touches the circles of two echoes, on the side that the sonars look to. A sonar
/// hears a smooth surface where its beam meets it at a right angle, not on its axis. So an echo
/// stands for a circle about the sonar, and a wall is a line that touches many circles. Nothing
/// where one circle lies in the other.
std::optional<Line> tangent(const Return& a, const Return& b);

/// The errors of an echo, and of dead reckoning since.
struct EchoError {
  double noise = 0.008;  ///< [m] of one echo
  double drift = 0.004;  ///< [rad/m] of the heading with the way...
  double jitter = 0.03;  ///< [rad, one sigma] ...and with a turn of 1 rad
  /// [rad^2] of the heading after that way and turn.
  double heading_variance(double way, double turn) const {
    return drift * drift * way * way + jitter * jitter * turn;
  }
  /// [m^2] of an echo, seen from the robot's later place.
  double variance(double way, double turn) const {
    return noise * noise + way * way * heading_variance(way, turn);
  }
};

/// The line that touches the circles best (weighted least squares of the normal distances),
/// starting from a near one. It is relative to the place of its newest echo: the heading of a wall
/// comes from its last two metres, its length from the farther ones.
LineFit fit_line(const std::vector<const Return*>& echoes, const Line& near,
                 const EchoError& error);

}  // namespace saphira::interpretation
