#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/maps/map.hpp"
#include "saphira/registration/line_map.hpp"
#include "saphira/registration/look.hpp"

namespace saphira::registration {

struct ObjectFinderSettings {
  double range = 1.6;           ///< [m] the farthest echo: farther off the cone is too wide
  double beam = radians(10.0);  ///< [rad] half of the cone
  double off = 0.3;             ///< [m] from all that the map has
  double same = 0.5;            ///< [m] echoes so near to one another are of one thing
  LookSpacing spacing;
  std::size_t looks = 6;    ///< that must have met it...
  double span = 0.4;        ///< [m] ...one from so far off the first
  std::uint64_t time = 60;  ///< [cycles] ...in no less than this: who walks past is no thing
  double least = 0.2;       ///< [m] sizes of things
  double most = 1.5;
  double clearer = 0.1;           ///< [m] by which a thing must look different to be told again
  std::size_t kept = 40;          ///< looks at each
  std::size_t candidates = 50;    ///< the most
  std::uint64_t patience = 3000;  ///< [cycles] so long a few echoes wait for more

  bool operator==(const ObjectFinderSettings&) const = default;
};

/// Things that stand where the map has nothing: what several readings from several places have met,
/// as an OBJECT. A pure function of its inputs' history.
class ObjectFinder {
 public:
  explicit ObjectFinder(ObjectFinderSettings settings = {}) : settings_(settings) {}

  /// Objects to put on the map, new ones (id 0) and ones that are seen more clearly now (with their
  /// id): that is how the finder knows that it is there.
  std::vector<maps::Feature> step(const maps::Map& map, const Field& field, std::uint64_t cycle,
                                  const std::vector<Look>& looks);

  bool operator==(const ObjectFinder&) const = default;

 private:
  struct Candidate {
    std::vector<Look> met;
    std::vector<Pose> from;  ///< of those, where they do not repeat one another
    std::size_t through = 0;
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::optional<maps::Feature> told;  ///< id 0: not on the map yet

    bool operator==(const Candidate&) const = default;
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
