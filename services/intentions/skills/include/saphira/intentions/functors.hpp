#pragma once

#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// The belief that the map is to grow: registration is asked for it while it holds.
inline constexpr const char* kGrowsMap = "grows-map";

/// The built-in functors:
///
///   go_to(position, [speed], [radius], [patience])   drives to a point, around obstacles
///   drive(speed, [patience])                         goes on until its deadline or its withdrawal
///   turn_to(heading | position, [angle], [turn_speed], [patience])
///   stop()                                           ends all earlier goals that drive, and halts
Registry built_in();

}  // namespace saphira::intentions
