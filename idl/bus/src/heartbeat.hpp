#pragma once

#include "saphira/base/heartbeat.hpp"

namespace saphira::bus::internal {

/// Sends it to the supervisor; without one it does nothing. Never waits.
void send(const Heartbeat& beat);

}  // namespace saphira::bus::internal
