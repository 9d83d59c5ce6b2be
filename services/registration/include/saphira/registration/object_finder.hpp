#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/line_map.hpp"
#include "saphira/registration/look.hpp"

namespace saphira::registration {

struct ObjectFinderSettings {
  double range = 1.6;           ///< [m] the farthest echo: beyond it the cone is too wide
  double beam = radians(10.0);  ///< [rad] half of the cone
  double off = 0.3;             ///< [m] from all features of the map
  double same = 0.5;            ///< [m] distance of echoes of one object
  LookSpacing spacing;
  std::size_t looks = 6;    ///< number of looks that have met it...
  double span = 0.4;        ///< [m] ...one at this distance from the first
  std::uint64_t time = 60;  ///< [cycles] ...over at least this time: a passing person is no object
  double least = 0.2;       ///< [m] least size of an object
  double most = 1.5;
  double clearer = 0.1;           ///< [m] change of an object that makes news
  std::size_t kept = 40;          ///< looks at each
  std::size_t candidates = 50;    ///< the most
  std::uint64_t patience = 3000;  ///< [cycles] for which a few echoes wait for more
};

/// Objects that are not on the map: obstacles met by several readings from several places, as an
/// OBJECT. A pure function of its inputs' history.
class ObjectFinder {
 public:
  explicit ObjectFinder(ObjectFinderSettings settings = {}) : settings_(settings) {}

  /// Objects for the map: new ones (id 0), and known ones with a better outline (with their id,
  /// which tells the finder that they are on the map).
  std::vector<maps::Feature> step(const maps::Map& map, const Field& field, std::uint64_t cycle,
                                  const std::vector<Look>& looks);

  SAPHIRA_ARCHIVE(candidates_)

 private:
  struct Candidate {
    std::vector<Look> met;
    std::vector<Pose> from;  ///< their places, without repetitions
    std::size_t through = 0;
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::optional<maps::Feature> told;  ///< id 0: not on the map yet
  };
  void follow_map(const maps::Map& map);
  Candidate* candidate_at(const Vec2& position);
  bool is_explained(const maps::Map& map, const Field& field, const Look& look,
                    std::uint32_t own) const;
  void look_through(const Look& look, const Candidate* met);
  bool is_thing(const Candidate& candidate) const;
  maps::Feature outline(const Candidate& candidate, const Field& field) const;

  ObjectFinderSettings settings_;
  std::vector<Candidate> candidates_;
};

}  // namespace saphira::registration
