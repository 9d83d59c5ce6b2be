#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/look.hpp"

namespace saphira::registration {

struct PresenceSettings {
  double range = 2.5;  ///< [m] largest range of a check
  LookSpacing spacing;

  // Objects and walls.
  double inside = 0.1;    ///< [m] from an object's corners within which a beam surely meets it
  double behind = 0.4;    ///< [m] an echo this far behind it has passed through
  double near = 0.25;     ///< [m] distance of its own echo from its face
  std::size_t looks = 6;  ///< excess of looks through it over its own echoes: it is gone

  // Doors.
  double door_behind = 0.4;  ///< [m] as above
  double door_range = 1.5;   ///< [m] beyond this a post looks like a door
  LookSpacing door_spacing{0.1, radians(12.0)};
  double door_near = 0.2;          ///< [m] as above
  double beam = radians(14.0);     ///< [rad] half of the beam that must fit through the opening
  double facing = radians(20.0);   ///< [rad] largest angle of an echo from a door
  double slanted = radians(60.0);  ///< [rad] largest angle of an echo from behind it
  int door_looks = 3;              ///< looks that agree: closed, or open
  std::uint64_t again = 20;        ///< [cycles] after which a look from the same place counts again
};

/// Detects artifacts that should be seen and are not (paper 3.2.2), by kind. OBJECTs, which people
/// carry about, are gone where echoes come from behind them; likewise walls and breaks that the
/// robot itself has added. A person's artifacts stay, and so do corridors, junctions and rooms. A
/// door is not gone but closed, until it is seen open again. A pure function of its inputs'
/// history.
class Presence {
 public:
  explicit Presence(PresenceSettings settings = {}) : settings_(settings) {}

  struct Changes {
    std::vector<std::uint32_t> gone;    ///< to be removed from the map
    std::vector<std::uint32_t> closed;  ///< doors that have been found closed now...
    std::vector<std::uint32_t> opened;  ///< ...or open
    bool empty() const { return gone.empty() && closed.empty() && opened.empty(); }
    bool operator==(const Changes&) const = default;
  };

  /// Readings from a certain pose; `seen` are the artifacts that percepts of open doors matched.
  Changes step(const maps::Map& map, std::uint64_t cycle, const Vec2& robot_in_map,
               const std::vector<Look>& looks, const std::vector<std::uint32_t>& seen);

  /// Doors by id that were closed at their newest check.
  const std::set<std::uint32_t>& closed() const { return closed_; }
  /// Begins anew, with given closed doors.
  void recall(std::set<std::uint32_t> closed) {
    watched_.clear();
    closed_ = std::move(closed);
  }

  SAPHIRA_ARCHIVE(watched_, closed_)

 private:
  struct Watched {
    maps::Feature feature;
    std::vector<Pose> through;  ///< looks, that is, the sonar's poses
    std::vector<Pose> at;
    // Doors: the number of agreeing looks, above 0 where open; and those since they agree.
    int score = 0;
    std::uint64_t counted = 0;  ///< cycle
    std::vector<Pose> agreeing;
  };
  Watched& watch(const maps::Feature& feature);
  void look_at(Watched& watched, const Look& look, const maps::Map& map);
  void look_at_door(Watched& watched, const Look& look, std::uint64_t cycle);
  bool passed(const Watched& watched) const {
    return watched.through.size() >= watched.at.size() + settings_.looks;
  }

  PresenceSettings settings_;
  std::map<std::uint32_t, Watched> watched_;
  std::set<std::uint32_t> closed_;
};

}  // namespace saphira::registration
