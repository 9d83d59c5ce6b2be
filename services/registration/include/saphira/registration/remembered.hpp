#pragma once

#include <cstdint>
#include <set>
#include <string>

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

}  // namespace saphira::registration
