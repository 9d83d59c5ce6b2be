#pragma once

#include <string>
#include <vector>

#include "saphira/idl/map.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::cli {

/// The verbs of `saphira map`.
std::vector<std::string> map_verbs();

/// Throws std::invalid_argument for words that are wrong without looking at the map.
void check_map_words(const std::vector<std::string>& words);

/// The request to registration for the words after `saphira map`. A map file is read here, so that
/// it may be on another machine than the service. std::invalid_argument gives the expected form;
/// FileError or std::runtime_error of a file.
Request parse_map_request(const std::vector<std::string>& words, const maps::Map& map);

/// Enumerators for people.
const char* name_of(v1::RegistrationState state);

/// One line: the state, the robot's pose, its uncertainty, and its region.
std::string describe(const v1::Registration& registration, const maps::Map& map);

}  // namespace saphira::cli
