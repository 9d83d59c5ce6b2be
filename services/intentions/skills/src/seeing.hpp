#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "saphira/intentions/functions.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {

/// The nearest person, blob or blob of a channel ("person", "blob", "blob-a", "blob-b", "blob-c")
/// that is seen, as a reference, or nil. None where `what` names no such kind.
std::optional<Value> nearest_seen(const World& world, const std::string& what);

/// Functions about people and colours that a camera sees.
void add_seeing(Functions& functions);

}  // namespace saphira::intentions
