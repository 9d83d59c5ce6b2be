#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/explore/explorer.hpp"
#include "saphira/interpretation/interpretation.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/map_builder.hpp"

namespace saphira::test {

/// A simulated robot that explores: what it sees, the map that it builds, and where it goes next.
class Building {
 public:
  Building(const DriveOptions& options, registration::MapBuilderSettings building = {});

  /// One cycle. False when the explorer has done.
  bool advance();
  /// Until it has done, or for so many cycles.
  void run(std::uint64_t limit, const std::function<void(Building&)>& each = {});
  /// Drives to a point of the built map, without exploring. False when it is not there in time.
  bool drive_to(const Vec2& point_in_map, std::uint64_t limit);
  /// The map as built, moved and turned as a whole so that the way lies best on the true one: where
  /// it begins and which way it is turned are the builder's choice.
  maps::Map aligned_map() const;
  /// A picture and the map, into the folder of the environment variable SAPHIRA_DRAW_TO.
  void draw(const std::string& name) const;

  Drive drive;
  interpretation::Interpretation interpretation;
  registration::MapBuilder builder;
  explore::Explorer explorer;
  double worst = 0.0;  ///< [m] the believed pose against the true one
  std::vector<Vec2> true_way;

 private:
  void perceive();

  std::vector<Vec2> true_nodes_;  ///< where the robot was at each node of the builder's way
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
