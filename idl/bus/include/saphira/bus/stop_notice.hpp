#pragma once

#include <optional>
#include <string>
#include <utility>

#include "saphira/idl/types.hpp"

namespace saphira::bus {

/// Notices stops (drive/stop) in the grants, for a program that drives the robot itself: it ends,
/// or lets go and begins anew.
class StopNotice {
 public:
  /// The person or program that has stopped the robot since the grant before; empty: nobody. A stop
  /// from before the first grant is none.
  std::string hear(const v1::Grant& grant) {
    const std::optional<v1::StopId> before = std::exchange(newest_, grant.stop);
    if (!before || *before == grant.stop)
      return {};
    return grant.stop_source.empty() ? "somebody" : grant.stop_source;
  }

 private:
  std::optional<v1::StopId> newest_;
};

}  // namespace saphira::bus
