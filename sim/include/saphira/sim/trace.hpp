#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

/// The true state at the end of one cycle.
struct TraceRow {
  bool first = false;       ///< the first since OPEN
  std::uint64_t cycle = 0;  ///< information packets since OPEN; counts on after a close
  Pose pose_in_world;
  double velocity = 0.0;               ///< [m/s]
  double rotation_velocity = 0.0;      ///< [rad/s]
  double set_velocity = 0.0;           ///< [m/s] in force; 0 after the watchdog
  double set_heading = 0.0;            ///< [rad] of dead reckoning; NaN while none is controlled
  double set_rotation_velocity = 0.0;  ///< [rad/s]; NaN while a heading is controlled
  double clearance = 0.0;              ///< [m] from the hull to the nearest segment
  int contacts = 0;                    ///< so far, since the simulator started
};

/// The first line of a trace file, and a line of it, both with the line break. A file holds a
/// header line for each connection.
std::string trace_header();
std::string to_csv(const TraceRow& row);

/// Reads a trace file; `file` names it in errors. FileError where it is wrong. A last line without
/// its line break is left out: the simulator may be writing it.
std::vector<TraceRow> parse_trace(std::string_view text, const std::string& file);

/// A picture (SVG) of a world and of the robot's way in it: its outline at the start, every five
/// seconds, and at the end, with the contacts marked.
std::string plot_svg(const World& world, const std::vector<TraceRow>& trace, double radius);

}  // namespace saphira::sim
