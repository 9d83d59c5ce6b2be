#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/maps/map.hpp"

namespace saphira::maps {

/// Why a feature cannot be part of a map, in words; none where it can.
std::optional<std::string> problem(const Feature& feature);

/// Why nothing can be there on a map, in words; none where something can.
std::optional<std::string> problem(const Pose& pose_in_map);

/// How near two features must be to be the same thing.
struct Sameness {
  double distance = 0.5;         ///< [m] across a line, or between two points
  double angle = radians(15.0);  ///< of headings
};

/// True where two features of one type stand for the same thing: walls and corridors by their
/// lines, which must overlap (a stretch of a corridor is the same as the whole), all else by its
/// middle.
bool same(const Feature& a, const Feature& b, const Sameness& sameness = {});

/// A map that changes while it is used. Every feature has an id as long as the editor lives, walls
/// too (whose ids a file does not hold), and the id of what was removed is not given again.
class Editor {
 public:
  explicit Editor(Map map = {});

  const Map& map() const { return map_; }
  /// Goes up with every change.
  std::uint64_t revision() const { return revision_; }

  /// Takes a new feature, under its id where it has one that is free and was never used, else under
  /// a new one, which is returned. std::invalid_argument where `problem` finds one.
  std::uint32_t add(Feature feature);
  /// Replaces the feature of that id, which stays; its type must be the same. False where there is
  /// none. std::invalid_argument where `problem` finds one.
  bool change(std::uint32_t id, Feature feature);
  /// Changes the feature of its id, or adds it where there is none; its id.
  std::uint32_t put(const Feature& feature) {
    return change(feature.id, feature) ? feature.id : add(feature);
  }
  bool remove(std::uint32_t id);
  /// Another map instead of this one. What is in both by id keeps its id.
  void replace(Map map);

 private:
  std::size_t index_of(std::uint32_t id) const;
  void number();

  Map map_;
  std::uint32_t last_id_ = 0;     ///< the highest ever given
  std::set<std::uint32_t> gone_;  ///< given once, and not to be given again
  std::uint64_t revision_ = 0;
};

}  // namespace saphira::maps
