#pragma once

#include "saphira/behaviors/behavior.hpp"

// Two of the predefined behaviors in C++, equal to config/behaviors up to the last bits: the
// reference for the behavior language.
namespace saphira::bench {

behaviors::Schema avoid_collision_in_cpp();
behaviors::Schema go_to_pos_in_cpp();

}  // namespace saphira::bench
