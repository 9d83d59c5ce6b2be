#pragma once

#include "saphira/behaviors/executive.hpp"

namespace saphira::behaviors {

/// With the sonars of a Pioneer 1.
inline RobotModel pioneer() {
  RobotModel model;
  const double bearings[] = {90, 30, 15, 0, -15, -30, -90};
  for (int i = 0; i < 7; ++i)
    model.lps.sonars.push_back({i, {0.1, 0.0, radians(bearings[i])}});
  return model;
}

}  // namespace saphira::behaviors
