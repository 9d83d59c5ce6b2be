#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/lps/local_perceptual_space.hpp"

namespace saphira::explore {

/// A straight free way on the floor, in the map.
struct Lane {
  Vec2 from{0.0, 0.0};
  Vec2 to{0.0, 0.0};
  double width = 0.0;  ///< [m]
};

/// The floor as the sonars have found it, in cells in the frame of the map: free, occupied or not
/// yet seen. The cells cover `kReach` to each side of the start.
class FreeFloor {
 public:
  /// [m] In a larger room the robot's drift would cost more than the farther floor is worth.
  static constexpr double kReach = 16.0;

  explicit FreeFloor(std::vector<lps::SonarMount> sonars = {});

  void add(const Pose& robot_in_map, const std::vector<lps::SonarReading>& readings);

  /// The way to the nearest place beside unseen floor, or (`sides`) beside something that the robot
  /// has not passed, that is not near one of `tried`: its corners, without the robot's place.
  /// Empty: none can be reached.
  std::vector<Vec2> way_to_look(const Vec2& from, const std::vector<Vec2>& tried, bool sides) const;
  /// The way to a place; empty: none.
  std::vector<Vec2> way_to(const Vec2& from, const Vec2& to) const;
  bool is_free(const Vec2& at) const;
  /// [m2] Of the free floor.
  double area() const;
  /// True where the free floor goes on beyond the cells.
  bool goes_on() const;

  /// Lanes to the widest place that is far from all lanes so far, from the nearest of them; of the
  /// first, from the robot's place. Empty: the lanes are near to all floor that can be reached.
  std::vector<Lane> next_lanes(const Vec2& from, const std::vector<Lane>& lanes) const;

  SAPHIRA_ARCHIVE(sonars_, corner_, evidence_, seen_, driven_, passed_)

 private:
  static constexpr double kCell = 0.1;                                  // [m]
  static constexpr long kSide = 2 * static_cast<long>(kReach / kCell);  // cells
  static constexpr auto kCells = static_cast<std::size_t>(kSide * kSide);

  using Accept = std::function<bool(std::size_t)>;

  std::optional<std::size_t> cell(const Vec2& at) const;
  Vec2 middle(std::size_t cell) const;
  bool is_free(std::size_t cell) const;
  bool is_edge(const Vec2& at) const;
  std::vector<float> clearance() const;
  std::vector<std::size_t> search(const std::vector<float>& clearance,
                                  const std::vector<std::size_t>& from, const Accept& accept) const;
  std::vector<Vec2> corners(const std::vector<float>& clearance,
                            const std::vector<std::size_t>& way) const;
  double narrowest(const std::vector<float>& clearance, const Vec2& from, const Vec2& to) const;

  std::vector<lps::SonarMount> sonars_;
  std::optional<Vec2> corner_;         // the lowest of the cells
  std::vector<std::int8_t> evidence_;  // above 0: occupied; below: free
  std::vector<bool> seen_;
  std::vector<bool> driven_;  // under the middle of the robot
  std::vector<bool> passed_;  // by the robot, near enough to notice a wall
};

}  // namespace saphira::explore
