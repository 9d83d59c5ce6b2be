#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::test {

/// A generated floor of offices: a world, its true map, and a way through its corridors. All
/// lengths in metres, in the frame of the world, which is that of the map.
struct Floor {
  std::string world;  ///< text of a world file
  std::string map;    ///< text of a map file: every corridor, room and door
  /// The same without closed or ajar doors.
  std::string open_doors;
  /// Only the doors that stand back from the corridor's wall by 0.15 m or more, open or closed;
  /// none that is ajar.
  std::string recessed_doors;
  /// All that a sonar can notice: open doors, and the closed ones that stand back.
  std::string noticeable_doors;
  std::vector<Vec2> tour;  ///< along all corridors; consecutive points see each other
};

/// The same seed gives the same floor. A spine with branches, some of them slanted, some joined to
/// a loop; a hall at the end of some. Widths, doors, reveals, leaves and furniture are drawn from
/// measurements in office buildings: corridors 1.2 to 2.4 m, door openings 0.8 to 1.2 m, reveals 0
/// to 0.35 m, every other one with a frame or niche that is wider than the door in its back wall of
/// 0.10 to 0.15 m; leaves closed, ajar, open at 90 and at 170 degrees (building codes ADA 404 and
/// DIN 18040; maps of ActivMedia's and SRI's offices).
Floor make_floor(std::uint64_t seed);

}  // namespace saphira::test
