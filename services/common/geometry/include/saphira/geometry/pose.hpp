#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "saphira/base/archived.hpp"

namespace saphira {

/// A position or displacement [m], x forward, y left (REP 103).
using Vec2 = Eigen::Vector2d;

/// [m2] Of two vectors: positive where b points to the left of a.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

inline constexpr double kPi = std::numbers::pi;

inline constexpr double radians(double degrees) {
  return degrees * kPi / 180.0;
}
inline constexpr double degrees(double radians) {
  return radians * 180.0 / kPi;
}

/// The same angle in [0, 2 pi). sfNormAngle of manual 6.6.3.1.
inline double norm_angle(double angle) {
  const double turned = angle - 2.0 * kPi * std::floor(angle / (2.0 * kPi));
  return turned >= 2.0 * kPi ? 0.0 : turned;
}

/// The same angle in (-pi, pi]. sfNorm2Angle of manual 6.6.3.1.
inline double norm2_angle(double angle) {
  const double turned = norm_angle(angle);
  return turned > kPi ? turned - 2.0 * kPi : turned;
}

/// The angle's line in [-pi/2, pi/2], mirrored at the X axis' normal: +100 degrees becomes +80.
/// sfNorm3Angle of manual 6.6.3.1.
inline double norm3_angle(double angle) {
  const double a = norm2_angle(angle);
  if (a > kPi / 2)
    return kPi - a;
  if (a < -kPi / 2)
    return -kPi - a;
  return a;
}

/// sfAddAngle, sfSubAngle: in [0, 2 pi).
inline double add_angle(double a, double b) {
  return norm_angle(a + b);
}
inline double sub_angle(double a, double b) {
  return norm_angle(a - b);
}
/// sfAdd2Angle, sfSub2Angle: in (-pi, pi].
inline double add2_angle(double a, double b) {
  return norm2_angle(a + b);
}
inline double sub2_angle(double a, double b) {
  return norm2_angle(a - b);
}

/// A directed point in a plane: position [m] and heading [rad, counter-clockwise]. Also the
/// transform from its own frame (`robot` in `pose_in_odom`) to its reference frame.
struct Pose {
  double x = 0.0;
  double y = 0.0;
  double th = 0.0;

  Vec2 position() const { return {x, y}; }
  /// The unit vector along the heading.
  Vec2 direction() const { return {std::cos(th), std::sin(th)}; }

  bool operator==(const Pose&) const = default;
};

/// A pose given in the frame of `frame`, expressed where `frame` is expressed. The heading is
/// normalized to (-pi, pi].
inline Pose compose(const Pose& frame, const Pose& inside) {
  const double c = std::cos(frame.th);
  const double s = std::sin(frame.th);
  return {frame.x + c * inside.x - s * inside.y, frame.y + s * inside.x + c * inside.y,
          norm2_angle(frame.th + inside.th)};
}

/// The inverse of compose: `pose` seen from `frame`. Manual 6.6.3.1, sfChangeVP.
inline Pose relative(const Pose& frame, const Pose& pose) {
  const double c = std::cos(frame.th);
  const double s = std::sin(frame.th);
  const double dx = pose.x - frame.x;
  const double dy = pose.y - frame.y;
  return {c * dx + s * dy, -s * dx + c * dy, norm2_angle(pose.th - frame.th)};
}

inline Vec2 transform(const Pose& frame, const Vec2& inside) {
  const double c = std::cos(frame.th);
  const double s = std::sin(frame.th);
  return {frame.x + c * inside.x() - s * inside.y(), frame.y + s * inside.x() + c * inside.y()};
}

/// The inverse of transform, for many positions seen from one frame.
class ToFrame {
 public:
  explicit ToFrame(const Pose& frame)
      : x_(frame.x), y_(frame.y), c_(std::cos(frame.th)), s_(std::sin(frame.th)) {}
  Vec2 operator()(const Vec2& outside) const {
    const double dx = outside.x() - x_;
    const double dy = outside.y() - y_;
    return {c_ * dx + s_ * dy, -s_ * dx + c_ * dy};
  }

  SAPHIRA_ARCHIVE(x_, y_, c_, s_)

 private:
  double x_;
  double y_;
  double c_;
  double s_;
};

/// The inverse of transform: a position seen from `frame`.
inline Vec2 to_frame(const Pose& frame, const Vec2& outside) {
  return ToFrame(frame)(outside);
}

}  // namespace saphira
