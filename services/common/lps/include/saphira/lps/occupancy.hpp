#pragma once

#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::lps {

/// The result of the occupancy functions without a reading: 5000 mm in manual 6.6.2.
inline constexpr double kNothing = 5.0;

/// The result of an occupancy function.
struct Occupancy {
  double distance = kNothing;  ///< [m] along the axis, from the robot's centre; never < 0
  std::optional<Vec2> point;   ///< in the robot's frame: the reading
};

/// The axis of a box's distance: sfFRONT is X, sfSIDES is Y.
enum class Axis { front, sides };

/// The direction of a plane.
enum class Direction { front, back, left, right };

/// The nearest of `points` (robot frame) in a rectangle, measured along `axis`. The centre is (cx,
/// cy); `h` is its extent along X and `w` its extent along Y, all [m]. Only this reading gives both
/// worked examples of manual 6.6.2 (LPS pictures have X upwards, hence height and width).
///
/// The manual prints the signature sfOccBox(xy, cx, cy, h, w) and calls it with a sixth argument, 1
/// or 0, without explanation. The signature is taken as right.
Occupancy occupancy_box(const std::vector<Vec2>& points, Axis axis, double cx, double cy, double h,
                        double w);

/// The nearest of `points` (robot frame) in the half-infinite strip that begins at distance `d`
/// from the robot's centre towards `direction`. The strip's sides are at `s1` and `s2` [m] from the
/// axis: for front and back `s1` is to the left (+Y) and `s2` to the right (manual Figure 6-3); for
/// left and right `s1` is ahead (+X) and `s2` behind, which the manual leaves open.
Occupancy occupancy_plane(const std::vector<Vec2>& points, Direction direction, double d, double s1,
                          double s2);

}  // namespace saphira::lps
