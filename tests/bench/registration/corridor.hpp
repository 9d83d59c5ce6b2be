#pragma once

#include <optional>
#include <vector>

#include "../sonar/data.hpp"
#include "saphira/lps/percept.hpp"

namespace saphira::bench {

/// The findings of interpretation from the readings of a real robot. It drives along one corridor,
/// round a corner and along a second one. A fit to all readings at once gives the truth about the
/// second one: its walls are parallel and 2.14 m apart, and the left one has a gap of 0.73 m (its
/// middle at y = -6.24 m).
struct CorridorFindings {
  std::size_t walls = 0;     ///< along the corridor's walls
  double left_offset = 0.0;  ///< [m] of the longest along each, from the fit at its middle
  double right_offset = 0.0;
  std::optional<double> width;  ///< [m] of the corridor with the width nearest to the fit
  std::size_t corridors = 0;
  bool gap_found = false;
  double gap_centre_error = 0.0;       ///< [m] along the wall
  double gap_width_error = 0.0;        ///< [m]
  std::size_t gap_ends = 0;            ///< single ends within 0.3 m of one of its ends
  std::size_t other_openings = 0;      ///< doors and junctions elsewhere
  std::vector<lps::Percept> percepts;  ///< each in its last state
};

CorridorFindings interpret_corridor(const std::vector<CorridorRecord>& records);

}  // namespace saphira::bench
