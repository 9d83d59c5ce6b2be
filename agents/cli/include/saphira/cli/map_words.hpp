#pragma once

#include <string>
#include <vector>

#include "map.h"
#include "saphira/maps/map.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::cli {

/// The request to registration for the words after `saphira map`. A map file is read here, so that
/// it may be on another machine than the service. std::invalid_argument that says what was
/// expected; FileError or std::runtime_error of a file.
/// Throws std::invalid_argument where the words can be seen to be wrong without the map.
void check_map_words(const std::vector<std::string>& words);

Request parse_map_request(const std::vector<std::string>& words, const maps::Map& map);

/// Enumerators as people read them.
const char* name_of(v1::RegistrationState state);

/// One line: the state, where the robot is, how sure that is, and in what it is.
std::string describe(const v1::Registration& registration, const maps::Map& map);

}  // namespace saphira::cli
