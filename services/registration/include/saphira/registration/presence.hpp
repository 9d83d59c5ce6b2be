#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "saphira/maps/map.hpp"
#include "saphira/registration/look.hpp"

namespace saphira::registration {

struct PresenceSettings {
  double range = 2.5;  ///< [m] the farthest that is looked
  LookSpacing spacing;

  // Of things and walls.
  double inside = 0.1;    ///< [m] sound that meets something so far from its corners meets it
  double behind = 0.4;    ///< [m] an echo from so far behind it has passed through
  double near = 0.25;     ///< [m] an echo so near to its face is its own
  std::size_t looks = 6;  ///< so many more through it than at it: it is gone

  // Of doors.
  double door_behind = 0.4;  ///< [m] as above
  double door_range = 1.5;   ///< [m] from farther off a post seems to be a door
  LookSpacing door_spacing{0.1, radians(12.0)};
  double door_near = 0.2;          ///< [m] likewise
  double beam = radians(14.0);     ///< [rad] half of what must go through the opening
  double facing = radians(20.0);   ///< [rad] what is heard of a door is heard head-on
  double slanted = radians(60.0);  ///< [rad] and what is behind it not from more aside
  int door_looks = 3;              ///< that agree: it is closed, or open
  std::uint64_t again = 20;        ///< [cycles] then a look from the same place counts, too

  bool operator==(const PresenceSettings&) const = default;
};

/// Artifacts that should be seen and are not (paper 3.2.2), by kind. OBJECTs, which people carry
/// about, are gone where what is behind them is heard. So are walls and breaks that the robot has
/// put down itself; what a person wrote stays, and so do corridors, junctions and rooms. A door is
/// not gone but closed, until it is seen open again. A pure function of its inputs' history.
class Presence {
 public:
  explicit Presence(PresenceSettings settings = {}) : settings_(settings) {}

  struct News {
    std::vector<std::uint32_t> gone;    ///< to be taken from the map
    std::vector<std::uint32_t> closed;  ///< doors that have been found closed now...
    std::vector<std::uint32_t> opened;  ///< ...or open
    bool empty() const { return gone.empty() && closed.empty() && opened.empty(); }
    bool operator==(const News&) const = default;
  };

  /// Readings from a pose that is sure; `seen` are the artifacts that percepts of
  /// open doors have been matched to.
  News step(const maps::Map& map, std::uint64_t cycle, const Vec2& robot_in_map,
            const std::vector<Look>& looks, const std::vector<std::uint32_t>& seen);

  /// Doors by id that were closed when they were looked at last.
  const std::set<std::uint32_t>& closed() const { return closed_; }
  /// Begins anew, with what is known from elsewhere.
  void recall(std::set<std::uint32_t> closed) {
    watched_.clear();
    closed_ = std::move(closed);
  }

  bool operator==(const Presence&) const = default;

 private:
  struct Watched {
    maps::Feature feature;
    std::vector<Pose> through;  ///< looks, that is, the sonar's poses
    std::vector<Pose> at;
    // Of a door: how many looks agree, more than 0 where it is open; and those since they do.
    int score = 0;
    std::uint64_t counted = 0;  ///< cycle
    std::vector<Pose> agreeing;

    bool operator==(const Watched&) const = default;
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
