#pragma once

#include <deque>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

/// The content of the terminal's picture, in odom: the walls of the map, the sonars' echoes, and
/// the robot's way, pose and goal. After the local perceptual space of manual 2.3.3.
class Picture {
 public:
  void set_radius(double radius) { radius_ = radius; }
  void set_goal(const Vec2& goal) { goal_ = goal; }
  void move_robot(const Pose& pose);
  /// Adds an echo; echoes in the same 5 cm are one.
  void add_echo(const Vec2& point);
  /// Walls and the sides of rooms and corridors, from point to point, of the map; shown within the
  /// range of the other contents.
  void set_walls(std::vector<std::pair<Vec2, Vec2>> walls) { walls_ = std::move(walls); }
  /// The meaning of each character and color.
  static std::string legend(bool utf8);

  /// Lines of `columns` characters with colors (ANSI), `rows` of them, x of odom to the right.
  /// utf8: Braille dots, eight a character; else one letter a character.
  std::vector<std::string> draw(int columns, int rows, bool utf8) const;

 private:
  Pose robot_;
  double radius_ = 0.22;
  std::optional<Vec2> goal_;
  std::vector<std::pair<Vec2, Vec2>> walls_;
  std::vector<Vec2> wake_;
  std::set<std::pair<int, int>> echoes_;  ///< in cells
  std::deque<std::pair<int, int>> order_;
};

}  // namespace saphira::cli
