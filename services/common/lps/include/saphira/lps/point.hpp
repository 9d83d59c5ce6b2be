#pragma once

#include <cmath>

#include "saphira/geometry/pose.hpp"

// Points and lines of manual 6.6.3.1. A point is a Pose: position and direction, in the LPS (the
// robot's frame) unless stated otherwise. Each function names its original. The results that the
// manual's functions write through their last argument are returned here.
namespace saphira::lps {

/// sfPointPhi: the bearing of the point from the robot [rad], (-pi, pi].
inline double phi(const Pose& p) {
  return std::atan2(p.y, p.x);
}

/// sfPointDist: from the robot to the point [m].
inline double distance(const Pose& p) {
  return std::hypot(p.x, p.y);
}

/// sfPointDistPoint [m].
inline double distance(const Pose& p, const Pose& q) {
  return std::hypot(p.x - q.x, p.y - q.y);
}

/// sfPointXoPoint: the x of `q` in the coordinate system of `p` [m].
inline double xo(const Pose& p, const Pose& q) {
  return relative(p, q).x;
}

/// sfPointYoPoint: the y of `q` in the coordinate system of `p` [m].
inline double yo(const Pose& p, const Pose& q) {
  return relative(p, q).y;
}

/// sfPointXo: the x of the robot in the coordinate system of `p` [m].
inline double xo(const Pose& p) {
  return xo(p, Pose{});
}

/// sfPointYo: the y of the robot in the coordinate system of `p` [m].
inline double yo(const Pose& p) {
  return yo(p, Pose{});
}

/// sfPointNormalDistPoint: from `q` to the line through `p` along its direction [m], not negative;
/// yo tells the side.
inline double normal_distance(const Pose& p, const Pose& q) {
  return std::abs(yo(p, q));
}

/// sfPointNormalDist: from the robot to the line through `p` along its direction [m].
inline double normal_distance(const Pose& p) {
  return normal_distance(p, Pose{});
}

/// sfPointBaricenter: midway between two points. The manual does not define its direction; here it
/// is halfway on the smaller turn from `p` to `q`.
inline Pose baricenter(const Pose& p, const Pose& q) {
  return {(p.x + q.x) / 2.0, (p.y + q.y) / 2.0, norm2_angle(p.th + norm2_angle(q.th - p.th) / 2.0)};
}

/// sfChangeVP: `q`, given in the LPS, in the coordinate system of `p`.
inline Pose change_vp(const Pose& p, const Pose& q) {
  return relative(p, q);
}

/// sfUnchangeVP: `q`, given in the coordinate system of `p`, in the LPS.
inline Pose unchange_vp(const Pose& p, const Pose& q) {
  return compose(p, q);
}

/// sfPointMove: `p` moved by (dx, dy) in its own coordinate system [m].
inline Pose move(const Pose& p, double dx, double dy) {
  return compose(p, {dx, dy, 0.0});
}

}  // namespace saphira::lps
