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

/// Walls, doors (DOOR) and other passages (BREAK) as drawn by a person, complete in the rectangles
/// that are offices with the name "covered". In the frame of the log's corrected poses.
///
/// The reference beside a log, as `reference.map`; else ours by the log's name. Nothing without
/// one.
std::optional<maps::Map> load_reference(const std::string& log_folder, const std::string& name);

/// The share of the reference's walls that the laser sees, too. A value far below 1 means another
/// log, or another frame.
double agreement(const maps::Map& reference, const LaserCells& cells);

/// The scores of a drive's percepts: against the reference by hand, and against the laser.
struct PerceptRun {
  /// Against the reference, within its covered area.
  std::optional<test::Score> by_hand;
  /// Against the laser's occupied cells, everywhere: a real wall has parallel cells along it; a
  /// real door or junction has cells at both ends and none between.
  test::Score by_laser;
};

/// `poses_in_map`: the robot's poses at the drive's stamps.
PerceptRun run_percepts(const logs::SonarDrive& drive, const std::vector<Pose>& poses_in_map,
                        const std::optional<maps::Map>& reference, const LaserCells& cells);

/// MURIEL's grid and the cone model's, from the same readings at these poses, against the laser's
/// cells.
std::array<test::GridScore, 2> run_grids(const logs::SonarDrive& drive,
                                         const std::vector<Pose>& poses_in_map,
                                         const std::optional<maps::Map>& reference,
                                         const LaserCells& cells);

}  // namespace saphira::bench
