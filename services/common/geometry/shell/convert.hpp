#pragma once

#include "common.h"
#include "saphira/geometry/pose.hpp"

namespace saphira {

inline Pose from_bus(const v1::Pose2& pose) {
  return {pose.x(), pose.y(), pose.th()};
}

inline v1::Pose2 to_bus(const Pose& pose) {
  v1::Pose2 result;
  result.x(pose.x);
  result.y(pose.y);
  result.th(pose.th);
  return result;
}

}  // namespace saphira
