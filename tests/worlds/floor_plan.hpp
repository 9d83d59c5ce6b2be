#pragma once

#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/sim/world.hpp"

/// Helpers for tests of the shipped worlds and maps.
namespace saphira::test {

std::string source(const std::string& path);

/// The places that the middle of a robot can reach from the start of a world: a flood over a grid,
/// over the cells that are farther than `radius` [m] from every segment.
class Reach {
 public:
  static constexpr double kCell = 0.05;  // [m]

  Reach(const sim::World& world, double radius);

  /// True where the robot gets within a cell of `position`.
  bool at(const Vec2& position) const;
  /// The reachable share of the positions with room for the robot in the rectangle of `room`: 0 to
  /// 1; 0 without any room.
  double share_of(const maps::Feature& room) const;

 private:
  enum class Cell : char { kBlocked, kFree, kReached };
  std::size_t index(int column, int row) const;
  Vec2 middle(int column, int row) const { return {(column + 0.5) * kCell, (row + 0.5) * kCell}; }

  int columns_;
  int rows_;
  std::vector<Cell> cells_;
};

/// The share of the way from `from` to `to` along which a segment lies within `tolerance` [m], or
/// `also` is true.
template <class Also>
double covered(const sim::World& world, const Vec2& from, const Vec2& to, double tolerance,
               const Also& also) {
  constexpr int kSamples = 200;
  int hits = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec2 at = from + (i + 0.5) / kSamples * (to - from);
    hits += sim::distance(world.segments, at) <= tolerance || also(at) ? 1 : 0;
  }
  return static_cast<double>(hits) / kSamples;
}

}  // namespace saphira::test
