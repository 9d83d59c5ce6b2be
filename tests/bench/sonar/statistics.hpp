#pragma once

#include <array>
#include <map>
#include <vector>

#include "data.hpp"
#include "saphira/sim/world.hpp"

/// The statistics of sonar readings, common to real and simulated ones.
namespace saphira::bench {

// ---- A plate, met head-on.

struct RangeBin {
  double range = 0.0;      ///< [m] middle of half a metre
  double bias = 0.0;       ///< [m] median of reading minus truth
  double deviation = 0.0;  ///< [m] of the readings about a line over the truth, by their median
  double outliers = 0.0;   ///< share of readings with an error above 0.1 m, or none
  std::size_t count = 0;
};

std::vector<RangeBin> range_bins(const std::vector<Calibration>& readings);

// ---- A corridor.

/// y = offset + slope * x, in the frame of the records.
struct Line {
  double offset = 0.0;
  double slope = 0.0;
  double rms = 0.0;  ///< [m] of its readings

  double distance(const Vec2& point) const;
  Vec2 at(double x) const { return {x, offset + slope * x}; }
};

/// The straight part of the corridor from the readings: its two walls from the side sonars, and on
/// them the places that the oblique sonars hear (door posts and the like).
struct Corridor {
  Line right;
  Line left;
  std::vector<Vec2> posts;
};

/// The records of the straight part.
std::vector<CorridorRecord> straight_part(const std::vector<CorridorRecord>& records);
Corridor fit_corridor(const std::vector<CorridorRecord>& straight);
/// The same corridor for the simulator: walls with posts of 40 mm.
sim::World to_world(const Corridor& corridor);
/// From the frame of the records to that of the world.
inline constexpr double kCorridorShift = 5.0;  // [m] in x and y

/// The rate of echoes from an object, by its angle off the sonar's axis [bin of 4 degrees].
struct Heard {
  int yes = 0;
  int no = 0;
  double share() const { return yes + no == 0 ? 0.0 : static_cast<double>(yes) / (yes + no); }
};

struct CorridorStatistics {
  double side_rms = 0.0;       ///< [m] of the side sonars about the walls
  double side_none = 0.0;      ///< share of their firings without an echo
  double oblique_none = 0.0;   ///< of the firings of the other six: no echo,
  double oblique_post = 0.0;   ///< a post,
  double oblique_wall = 0.0;   ///< the smooth wall, at the beam's intersection,
  double oblique_other = 0.0;  ///< another object
  std::map<int, Heard> lobe;   ///< posts, by [4 degrees] off axis
  double half_width = 0.0;     ///< [rad] off axis, with half of the posts heard
};

CorridorStatistics corridor_statistics(const std::vector<CorridorRecord>& straight,
                                       const Corridor& corridor);

// ---- A wall beside a ring of sonars.

/// Of the firings of the sonars at `offset` times 15 degrees beside the one nearest to an object:
struct RingShare {
  double wall = 0.0;  ///< heard the same wall, at its distance
  double axis = 0.0;  ///< read the intersection of their axis with that wall
  double none = 0.0;
  double other = 0.0;
};

struct RingStatistics {
  std::size_t rings = 0;
  std::array<RingShare, 5> beside{};  ///< by offset
  double deviation = 0.0;             ///< [m] of a reading, from second differences in time
};

/// [m] from the middle of that robot to its sonars (half its width of 0.58 m).
inline constexpr double kRingRadius = 0.29;
/// Only rings with their nearest reading in this range [m] are used: they stand at a wall.
inline constexpr double kRingNear = 0.3;
inline constexpr double kRingFar = 0.9;

RingStatistics ring_statistics(const std::vector<std::array<double, kRing>>& rings);

}  // namespace saphira::bench
