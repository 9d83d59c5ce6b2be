#pragma once

#include <optional>
#include <string>

#include "saphira/intentions/functions.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {

/// The nearest visible person, blob or blob of a channel ("person", "blob", "blob-a", "blob-b",
/// "blob-c"), as a reference, or nil. None for an unknown kind in `what`. Near the robot, or near
/// that place in odom.
std::optional<Value> nearest_seen(const World& world, const std::string& what,
                                  const std::optional<Pose>& place = {});

/// [s] since a person or blob was seen last.
double seconds_unseen(const World& world, const lps::SeenThing& thing);

/// Functions about people and colours that a camera sees.
void add_seeing(Functions& functions);

}  // namespace saphira::intentions
