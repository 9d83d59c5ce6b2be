#pragma once

#include <string_view>

namespace saphira::viewer {

/// The JSON Schema of every type of idl/*.idl.
std::string_view contract();

}  // namespace saphira::viewer
