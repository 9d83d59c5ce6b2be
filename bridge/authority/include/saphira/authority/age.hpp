#pragma once

#include "saphira/authority/guard.hpp"

namespace saphira::authority {

/// Limits the speed by the age [s] of the command: the robot moves no further than kUnseenWay on a
/// decision from an old state. Up to `fresh` [s] a command counts as new, since it holds until the
/// next cycle's command comes.
Guarded slow_for_age(Guarded guarded, double age, double fresh);

}  // namespace saphira::authority
