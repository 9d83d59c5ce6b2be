#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/logs/scan_matching.hpp"
#include "saphira/maps/drawing.hpp"

namespace saphira::bench {

/// A grid from laser scans: the cells of beams' ends, and those that beams passed. The reference
/// for the percepts and grids of sonars from the same drive.
class LaserCells {
 public:
  static constexpr double kCell = 0.05;  ///< [m]

  /// Scans with known poses. A scan does not contain the laser's place on the robot: the beams
  /// begin at the robot's middle.
  LaserCells(const std::vector<logs::Scan>& scans, const std::vector<Pose>& poses);

  bool occupied(const Vec2& at) const;
  /// True for a cell that beams passed, with no surface within 0.15 m.
  bool free(const Vec2& at) const;
  /// True where an occupied cell's middle is within that distance.
  bool near(const Vec2& at, double distance) const;
  /// The distance of the nearest occupied cell in a direction, or against it (negative).
  std::optional<double> beside(const Vec2& at, double direction, double reach) const;
  /// The middles of all occupied cells, by rows.
  std::vector<Vec2> surfaces() const;
  /// True where the line between the two points is free, up to 0.15 m before the second one.
  bool sees(const Vec2& from, const Vec2& to) const;
  /// For a picture.
  maps::Raster raster() const;

 private:
  struct Cell {
    std::uint16_t hits = 0;
    std::uint16_t passes = 0;
    bool occupied = false;
    bool near_occupied = false;
  };
  std::optional<std::size_t> index(const Vec2& at) const;
  Vec2 middle(std::size_t index) const;
  void pass(const Vec2& from, const Vec2& to);

  Vec2 low_{0.0, 0.0};
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<Cell> cells_;  // row by row
};

}  // namespace saphira::bench
