#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "saphira/maps/map.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::registration {

/// State that outlives the service: the pose, and the changed map.
struct Remembered {
  Memory memory;
  std::string option;    ///< the map at the start of the service
  std::string source;    ///< the origin of this map: that one, or another that was loaded later
  bool changed = false;  ///< since its origin
  maps::Map map;
  std::set<std::uint32_t> closed_doors;

  bool operator==(const Remembered&) const = default;
};

/// With its checksum. std::invalid_argument where no file can hold the map.
std::string to_text(const Remembered& remembered);
/// FileError with line and column for any other text.
Remembered parse_remembered(std::string_view text, const std::string& file);

}  // namespace saphira::registration
