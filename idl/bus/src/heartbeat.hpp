#pragma once

#include "saphira/base/heartbeat.hpp"

namespace saphira::bus::internal {

/// Sends a heartbeat to the supervisor, if there is one. Never waits.
void send(const Heartbeat& beat);

}  // namespace saphira::bus::internal
