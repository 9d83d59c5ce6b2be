#pragma once

#include <optional>
#include <string>
#include <utility>

#include "saphira/idl/types.hpp"

namespace saphira::bus {

/// Notices stops and emergency stops in the grants, for a program that drives the robot itself: it
/// ends, or lets go and begins anew.
class StopNotice {
 public:
  /// The person or program that has stopped the robot since the grant before; empty: nobody. A stop
  /// from before the first grant is none.
  std::string hear(const v1::Grant& grant) {
    const std::optional<v1::StopId> before = std::exchange(newest_, grant.stop);
    const bool pressed = grant.estopped && !estopped_;
    estopped_ = grant.estopped;
    if (!before || (*before == grant.stop && !pressed))
      return {};
    return (grant.stop_source.empty() ? "somebody" : grant.stop_source) +
           (pressed ? ", by the emergency stop" : "");
  }

 private:
  std::optional<v1::StopId> newest_;
  bool estopped_ = false;
};

}  // namespace saphira::bus
