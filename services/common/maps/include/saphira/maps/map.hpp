#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/artifact.hpp"

namespace saphira::maps {

/// The rule of a zone.
enum class ZoneRule {
  keep_out,  ///< the robot does not drive in
  slow,      ///< no faster than the zone's speed
  one_way,   ///< routes go only along its heading
  preferred  ///< routes go there rather than elsewhere
};

/// Its word in a map file: "keep-out".
std::string_view word(ZoneRule rule);
std::optional<ZoneRule> zone_rule(std::string_view word);

/// One line of a map: an artifact with its place in the frame `map`.
struct Feature {
  lps::PointType type = lps::PointType::position;
  /// Positive and unique in its map; 0 for a wall from a file, where it has none (manual 6.9.1): an
  /// Editor gives it one.
  std::uint32_t id = 0;
  /// The middle. The heading is along a corridor, lane, wall, junction, office or object; of a door
  /// or break it is the normal, from the room out into the corridor.
  Pose pose_in_map;
  double length = 0.0;  ///< [m] along the heading; 0 where the type has none
  double width = 0.0;   ///< [m] across the heading; 0 where the type has none
  std::string name;     ///< of a room, and of its doors; empty: none
  /// The robot has added it itself; its own walls and breaks are removed when they are not seen any
  /// more. In a file: the word learned at the end of the line.
  bool learned = false;
  ZoneRule rule = ZoneRule::keep_out;  ///< of a zone
  double speed = 0.0;                  ///< [m/s] of a slow zone; 0: the artifact is none

  bool operator==(const Feature&) const = default;
};

/// A map file (manual 6.9.1) in SI units.
struct Map {
  std::vector<Feature> features;  ///< in the order of the file

  bool operator==(const Map&) const = default;
};

/// Reads the text of a map file; `file` names it in errors. FileError where it is wrong.
Map parse_map(std::string_view text, const std::string& file);

/// The same for a whole file of a person. Its last line must have a line break, or end with a name:
/// half a number would read as a whole one. FileError also for an unlikely map: no artifact, all of
/// them smaller than a robot (in metres, not mm?), or one name for two places.
Map check_map(std::string_view text, const std::string& file);
/// check_map() of a file.
Map load_map(const std::string& path);

/// The text of a map file that reads as this map, to a micrometre and a millionth of a degree.
/// Walls lose their ids. std::invalid_argument where no file could hold it: an id twice, a size
/// that is not positive, a name with a quotation mark or a control character.
std::string to_text(const Map& map);

/// For people: "door 1265 (EJ-265)".
std::string describe(const Feature& feature);

/// The feature of that id; nullptr where there is none.
const Feature* find(const Map& map, std::uint32_t id);

/// Every feature of that type and name, in the order of the file.
std::vector<const Feature*> named(const Map& map, lps::PointType type, std::string_view name);

/// The rectangle of a corridor, lane, junction, office, object or zone.
class Rectangle {
 public:
  explicit Rectangle(const Feature& feature);
  bool contains(const Vec2& position_in_map) const;
  /// [m] to its nearest point; 0 inside.
  double distance(const Vec2& position_in_map) const;

 private:
  ToFrame to_feature_;
  Vec2 half_;
};
bool contains(const Feature& feature, const Vec2& position_in_map);

}  // namespace saphira::maps
