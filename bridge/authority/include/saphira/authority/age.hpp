#pragma once

#include "saphira/authority/guard.hpp"

namespace saphira::authority {

/// Cuts the speed to what the age [s] of the command allows: the robot moves no further than
/// kUnseenWay while it does what was decided by an old state of it. Up to `fresh` [s] a command is
/// as young as it can be: it holds until the next cycle's comes.
Guarded slow_for_age(Guarded guarded, double age, double fresh);

}  // namespace saphira::authority
