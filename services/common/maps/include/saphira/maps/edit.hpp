#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::maps {

/// The reason why a feature cannot be part of a map, in words; none where it can.
std::optional<std::string> problem(const Feature& feature);

/// The reason why a pose is impossible on a map, in words; none where it is possible.
std::optional<std::string> problem(const Pose& pose_in_map);

/// The tolerance for two features to be the same object.
struct Sameness {
  double distance = 0.5;         ///< [m] across a line, or between two points
  double angle = radians(15.0);  ///< of headings
};

/// True where two features of one type are the same object: walls and corridors by their lines,
/// which must overlap (a stretch of a corridor is the same as the whole), others by their middle.
bool same(const Feature& a, const Feature& b, const Sameness& sameness = {});

/// A map that changes while in use. Every feature has an id for the editor's life, walls too (whose
/// ids a file does not hold), and the id of a removed feature is not used again.
class Editor {
 public:
  explicit Editor(Map map = {});

  const Map& map() const { return map_; }
  /// Goes up with every change.
  std::uint64_t revision() const { return revision_; }

  /// Adds a feature, under its id if that is free and was never used, otherwise under a new one,
  /// which is returned. std::invalid_argument where `problem` finds an error.
  std::uint32_t add(Feature feature);
  /// Replaces the feature with that id, which stays; its type must be the same. False: no such
  /// feature. std::invalid_argument where `problem` finds an error.
  bool change(std::uint32_t id, Feature feature);
  /// Changes the feature with its id, or adds it; returns its id.
  std::uint32_t put(const Feature& feature) {
    return change(feature.id, feature) ? feature.id : add(feature);
  }
  bool remove(std::uint32_t id);
  /// Replaces the map. Features with the same id in both keep it.
  void replace(Map map);

  SAPHIRA_ARCHIVE(map_, last_id_, gone_, revision_)

 private:
  std::size_t index_of(std::uint32_t id) const;
  void number();

  Map map_;
  std::uint32_t last_id_ = 0;     ///< the highest ever given
  std::set<std::uint32_t> gone_;  ///< used once, and not to be used again
  std::uint64_t revision_ = 0;
};

}  // namespace saphira::maps
