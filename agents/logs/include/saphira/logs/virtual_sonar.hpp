#pragma once

#include <vector>

#include "saphira/logs/scan_matching.hpp"
#include "saphira/lps/local_perceptual_space.hpp"

namespace saphira::logs {

/// Sonar readings from the scans of a laser: the nearest surface in a sonar's cone that does not
/// deflect the sound.
struct SonarRing {
  std::vector<lps::SonarMount> mounts;
  double half_cone = radians(12.5);
  double incidence = radians(25.0);  ///< largest angle off a surface's normal with an echo
  double max_range = 5.0;            ///< [m]
};

/// The sonars of config/robots/pioneer.p.
std::vector<lps::SonarMount> pioneer_sonars();

/// The sonars of a B21's 24 with cones within a scan of 180 degrees: 13, from the left to the
/// right.
std::vector<lps::SonarMount> front_of_b21();

std::vector<lps::SonarReading> hear(const Scan& scan, const SonarRing& ring);

}  // namespace saphira::logs
