#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace saphira::cli {

/// The figures of a drive, from the simulator's trace. The trace is the ground truth: true poses,
/// not the robot's estimates.
struct Track {
  std::uint64_t cycles = 0;    ///< of the last connection, until the cut
  double path = 0.0;           ///< [m] that the robot's center moved
  double min_clearance = 0.0;  ///< [m] from the hull to the nearest obstacle; NaN without a cycle
  std::uint64_t contacts = 0;
  std::string hash;  ///< FNV-1a 64 of the lines, as 16 hexadecimal digits
};

/// Evaluates the text of a trace (saphira-sim --trace) up to and with `last_cycle` of its last
/// connection; each connection begins with a header line. A last line without its end is left out:
/// the simulator was still writing it. FileError for any other line.
Track evaluate_trace(std::string_view text, std::uint64_t last_cycle, const std::string& file);

/// The result of a demo.
struct Summary {
  bool arrived = false;
  double time = 0.0;  ///< [s] of robot time from the goal's acceptance to its end
  Track track;
  std::uint64_t late_cycles = 0;  ///< of all services together
  double speed_factor = 0.0;      ///< robot time / wall time
};

/// One JSON object on one line with the keys arrived, time_s, path_m, min_clearance_m, contacts,
/// cycles, late_cycles, trajectory_hash, speed_factor.
std::string to_json(const Summary& summary);
/// For people; ends with a line break.
std::string to_text(const Summary& summary);

}  // namespace saphira::cli
