#pragma once

#include <vector>

#include "server.hpp"

namespace saphira::console {

/// The files of the page, embedded in the program.
std::vector<PageFile> page_files();

}  // namespace saphira::console
