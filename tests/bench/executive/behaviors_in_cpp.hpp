#pragma once

#include "saphira/behaviors/behavior.hpp"

// Two of the predefined behaviors written in C++, to the last bits what config/behaviors has: what
// the behavior language is measured against.
namespace saphira::bench {

behaviors::Schema avoid_collision_in_cpp();
behaviors::Schema go_to_pos_in_cpp();

}  // namespace saphira::bench
