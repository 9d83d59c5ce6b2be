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
  explicit Building(const DriveOptions& options);

  /// Runs until the map is built, for that number of cycles at most.
  void run(std::uint64_t limit);
  bool done() const { return whole.status(goal_).state == intentions::GoalState::kSucceeded; }
  std::string reason() const { return whole.status(goal_).reason; }
  /// The built map, moved and turned as a whole for the best fit of its way to the true one: its
  /// origin and direction are the builder's choice.
  maps::Map aligned_map() const;
  /// A picture and the map, into the folder of the environment variable SAPHIRA_DRAW_TO.
  void draw(const std::string& name) const;

  Whole whole;

 private:
  void note();

  /// The way at the last check of the graph: estimated and true places.
  struct Way {
    std::vector<Vec2> believed;
    std::vector<Vec2> truth;
  };

  intentions::GoalId goal_;
  std::vector<std::pair<Pose, Vec2>> odom_and_truth_;  ///< of each cycle
  Way way_;
};

/// The doors of a built map compared with those of the true one.
struct MapScore {
  int doors = 0;  ///< of the reference
  int doors_found = 0;
  int doors_false = 0;
};

/// A door is found, or real, as in tests/bench/perception: within 0.3 m, 15 degrees and 0.4 m of
/// width.
MapScore score(const maps::Map& built, const maps::Map& reference);

}  // namespace saphira::test
