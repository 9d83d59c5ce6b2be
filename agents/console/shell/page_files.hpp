#pragma once

#include <vector>

#include "server.hpp"

namespace saphira::console {

/// The page as it is built into the program.
std::vector<PageFile> page_files();

}  // namespace saphira::console
