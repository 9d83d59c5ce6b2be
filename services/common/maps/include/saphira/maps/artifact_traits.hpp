#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "saphira/base/enumerators.hpp"
#include "saphira/lps/artifact.hpp"

namespace saphira::maps {

enum class RegionKind { corridor, junction, room };

/// The properties of the artifact types that a map and registration need, in one place. Maps, their
/// files, pictures and routes, and registration follow this table.
struct ArtifactTraits {
  lps::PointType type;
  std::string_view word;  ///< in a map file; empty: no map has it

  // Its fields in a map file.
  bool id = false;
  bool length = false;
  bool width = false;

  std::optional<RegionKind> region = {};  ///< kind of region on the floor
  /// Where the robot is in several regions, the largest number counts (manual 8.1.2).
  int environment = 0;
  bool gate = false;      ///< an opening in a wall, a way from one region into another
  bool straight = false;  ///< continues along its heading, the same from either end

  /// The consequence of an artifact that is not seen any more (paper 3.2.2).
  enum class Missing {
    stays,    ///< it is never looked for
    learned,  ///< only the robot's own artifacts are checked; a person's stay
    watched   ///< checked: a gate may be closed, any other artifact is gone
  };
  Missing missing = Missing::stays;

  /// The order of matching: the percepts that constrain the pose most come first (paper 3.2).
  int match_order = 4;

  // As an area of a picture; empty: no area, or drawn in its own way.
  std::string_view area = {};
  int layer = 0;  ///< areas of larger ones are drawn later
};

// CORRIDOR, DOOR and WALL are the manual's lines of a map file (6.9.1); the others have the names
// of its point types (6.6.3.1), in the same form.
inline constexpr std::array<ArtifactTraits, 11> kArtifactTraits{{
    {.type = lps::PointType::corridor,
     .word = "CORRIDOR",
     .id = true,
     .length = true,
     .width = true,
     .region = RegionKind::corridor,
     .environment = 2,
     .straight = true,
     .match_order = 0,
     .area = R"(fill="#56b4e9" fill-opacity="0.25" stroke="#0072b2" stroke-width="0.05")",
     .layer = 1},
    {.type = lps::PointType::door,
     .word = "DOOR",
     .id = true,
     .width = true,
     .gate = true,
     .missing = ArtifactTraits::Missing::watched,
     .match_order = 3},
    {.type = lps::PointType::wall,
     .word = "WALL",
     .length = true,
     .straight = true,
     .missing = ArtifactTraits::Missing::learned,
     .match_order = 1},
    {.type = lps::PointType::lane,
     .word = "LANE",
     .id = true,
     .length = true,
     .width = true,
     .region = RegionKind::corridor,
     .environment = 1,
     .straight = true,
     .area = R"(fill="#56b4e9" fill-opacity="0.25" stroke="#0072b2" stroke-width="0.05")",
     .layer = 1},
    {.type = lps::PointType::junction,
     .word = "JUNCTION",
     .id = true,
     .length = true,
     .width = true,
     .region = RegionKind::junction,
     .environment = 3,
     .match_order = 2,
     .area = R"(fill="#f0e442" fill-opacity="0.5" stroke="#a89c00" stroke-width="0.04")",
     .layer = 2},
    {.type = lps::PointType::office,
     .word = "OFFICE",
     .id = true,
     .length = true,
     .width = true,
     .region = RegionKind::room,
     .area = R"(fill="#fdf3dc" fill-opacity="0.6" stroke="#d8c9a0" stroke-width="0.04")"},
    {.type = lps::PointType::breach,
     .word = "BREAK",
     .id = true,
     .width = true,
     .gate = true,
     .missing = ArtifactTraits::Missing::learned},
    {.type = lps::PointType::object,
     .word = "OBJECT",
     .id = true,
     .length = true,
     .width = true,
     .missing = ArtifactTraits::Missing::watched},
    {.type = lps::PointType::zone, .word = "ZONE", .id = true, .length = true, .width = true},
    {.type = lps::PointType::position, .word = "POS", .id = true},
    {.type = lps::PointType::invalid, .word = ""},
}};

constexpr const ArtifactTraits& traits(lps::PointType type) {
  for (const ArtifactTraits& each : kArtifactTraits)
    if (each.type == type)
      return each;
  return kArtifactTraits.back();
}

static_assert(std::all_of(kEnumerators<lps::PointType>.begin(), kEnumerators<lps::PointType>.end(),
                          [](lps::PointType type) { return traits(type).type == type; }),
              "a type of artifacts has no traits");

}  // namespace saphira::maps
