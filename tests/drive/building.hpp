#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "drive/whole.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::test {

/// A simulated robot that builds the map of its floor from nothing (the activity build-map).
class Building {
 public:
  explicit Building(const DriveOptions& options, bool snap_to_right_angle_grid = true);

  /// Until the map is built, or for so many cycles.
  void run(std::uint64_t limit);
  bool done() const { return whole.status(goal_).state == intentions::GoalState::kSucceeded; }
  std::string reason() const { return whole.status(goal_).reason; }
  /// The map as built, moved and turned as a whole so that the way lies best on the true one: where
  /// it begins and which way it is turned are the builder's choice.
  maps::Map aligned_map() const;
  /// A picture and the map, into the folder of the environment variable SAPHIRA_DRAW_TO.
  void draw(const std::string& name) const;

  Whole whole;
  double worst = 0.0;  ///< [m] the believed pose against the true one
  int closures = 0;    ///< loops that were closed

 private:
  void note();

  /// Of the graph when it was looked at last: where the robot believed to have been, and was.
  struct Way {
    std::vector<Vec2> believed;
    std::vector<Vec2> truth;
  };

  intentions::GoalId goal_;
  std::vector<std::pair<Pose, Vec2>> odom_and_truth_;  ///< of each cycle
  Way way_;
};

/// A built map against the one that was drawn by hand.
struct MapScore {
  int corridors = 0;        ///< of the reference
  int corridors_found = 0;  ///< with the length to 3 %
  int corridors_false = 0;
  int doors = 0;  ///< of the reference
  int doors_found = 0;
  int doors_false = 0;
  double worst_length = 0.0;  ///< share of the length
  std::string text;           ///< what is missing or wrong
};

/// A door is found, or real, as in tests/bench/perception: within 0.3 m, 15 degrees and 0.4 m of
/// width. At a corner of two corridors, whether the one or the other has the corner's square is a
/// matter of taste: ends are compared without it.
MapScore score(const maps::Map& built, const maps::Map& reference);

}  // namespace saphira::test
