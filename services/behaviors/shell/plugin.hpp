#pragma once

#include <string>
#include <vector>

#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

/// Loads the plug-in (plugin.hpp) of a file into `registry` and returns the names of its schemas.
/// It stays loaded. std::runtime_error that names the file where it is no plug-in, or has another
/// version.
std::vector<std::string> load_plugin(const std::string& path, Registry& registry);

}  // namespace saphira::behaviors
