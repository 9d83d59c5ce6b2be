#include "saphira/authority/age.hpp"

#include <cmath>

#include "saphira/base/age.hpp"
#include "saphira/base/format.hpp"

namespace saphira::authority {

Guarded slow_for_age(Guarded guarded, double age, double fresh) {
  const double limit = speed_for_age(age - fresh);
  if (std::abs(guarded.velocity) <= limit)
    return guarded;
  // The stronger limit gives the reason.
  if (guarded.action <= GuardAction::limit) {
    guarded.reason =
        format("%.2f m/s cut to %.2f: the command answers what the robot said %.1f s ago",
               guarded.velocity, limit, age);
    guarded.action = GuardAction::limit;
  }
  guarded.velocity = std::copysign(limit, guarded.velocity);
  return guarded;
}

}  // namespace saphira::authority
