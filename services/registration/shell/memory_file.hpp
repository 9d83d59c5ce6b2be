#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "saphira/maps/map.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::registration {

/// What outlives the service: the pose, and the map as it has become.
struct Remembered {
  Memory memory;
  std::string source;  ///< where the map came from before it was changed
  maps::Map map;
};

std::string to_text(const Remembered& remembered);
/// FileError with line and column where the text is none of ours.
Remembered parse_remembered(std::string_view text, const std::string& file);

/// Nothing where there is no such file. FileError as above.
std::optional<Remembered> load_remembered(const std::string& path);
/// Replaces the file in one go: a reader finds the old one or the new one. False where it cannot.
bool save_remembered(const std::string& path, const Remembered& remembered);

}  // namespace saphira::registration
