#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "laser_cells.hpp"
#include "perception/score.hpp"
#include "saphira/logs/sonar_run.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::bench {

/// Walls, doors (DOOR) and other passages (BREAK) as a person saw them, complete in the rectangles
/// that are offices by the name "covered". In the frame of the log's corrected poses.
///
/// The one beside a log, as `reference.map`; else that of ours by the log's name. Nothing where
/// there is none.
std::optional<maps::Map> load_reference(const std::string& log_folder, const std::string& name);

/// The share of the reference's walls that the laser sees, too. Much less than 1: it is of another
/// log, or in another frame.
double agreement(const maps::Map& reference, const LaserCells& cells);

/// The scores of a drive's percepts: against the reference by hand, and against the laser.
struct PerceptRun {
  /// Against the reference, within what it covers.
  std::optional<test::Score> by_hand;
  /// Against the laser's occupied cells, everywhere: a wall has them along it, parallel; a door or
  /// junction has them at both ends and nothing between.
  test::Score by_laser;
};

/// `poses_in_map`: where the robot was at the drive's stamps.
PerceptRun run_percepts(const logs::SonarDrive& drive, const std::vector<Pose>& poses_in_map,
                        const std::optional<maps::Map>& reference, const LaserCells& cells);

/// MURIEL's grid and the cone model's, from the same readings at these poses, against the laser's
/// cells.
std::array<test::GridScore, 2> run_grids(const logs::SonarDrive& drive,
                                         const std::vector<Pose>& poses_in_map,
                                         const std::optional<maps::Map>& reference,
                                         const LaserCells& cells);

}  // namespace saphira::bench
