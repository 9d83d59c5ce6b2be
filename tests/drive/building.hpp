#pragma once

#include <cstdint>
#include <functional>
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
  /// `each` is called after each of them.
  void run(std::uint64_t limit, const std::function<void()>& each = {});
  bool done() const { return whole.status(goal_).state == v1::GOAL_SUCCEEDED; }
  std::string reason() const { return whole.status(goal_).reason; }
  /// The built map, moved and turned as a whole for the best fit of its way to the true one: its
  /// origin and direction are the builder's choice.
  maps::Map aligned_map() const;
  /// A picture and the map, into the folder of the environment variable SAPHIRA_DRAW_TO.
  void draw(const std::string& name) const;

  Whole whole;
  double worst = 0.0;  ///< [m] the estimated pose against the true one
  int closures = 0;    ///< loops that were closed

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

/// A built map compared with the hand-drawn one.
struct MapScore {
  int corridors = 0;        ///< of the reference
  int corridors_found = 0;  ///< with the length to 3 %
  int corridors_false = 0;
  int doors = 0;  ///< of the reference
  int doors_found = 0;
  int doors_false = 0;
  double worst_length = 0.0;  ///< share of the length
  std::string text;           ///< missing and wrong artifacts
};

/// A door is found, or real, as in tests/bench/perception: within 0.3 m, 15 degrees and 0.4 m of
/// width. At a corner of two corridors either may have the corner's square: ends are compared
/// without it.
MapScore score(const maps::Map& built, const maps::Map& reference);

}  // namespace saphira::test
