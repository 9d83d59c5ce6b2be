#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "saphira/maps/map.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::registration {

/// State that outlives the service: the pose, and the map as it has become.
struct Remembered {
  Memory memory;
  std::string option;    ///< the map that the service was started with
  std::string source;    ///< where this map came from: that one, or another that was loaded since
  bool changed = false;  ///< since it came from there
  maps::Map map;
  std::set<std::uint32_t> closed_doors;
};

/// With its sum. std::invalid_argument where the map is none that a file holds.
std::string to_text(const Remembered& remembered);
/// FileError with line and column where the text is none of ours.
Remembered parse_remembered(std::string_view text, const std::string& file);

}  // namespace saphira::registration
