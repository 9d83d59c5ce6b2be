#include "handshakes.hpp"

namespace saphira::bus::internal {

bool Handshakes::announced(const Program& program, Time now) {
  const auto found = pending_.find(program);
  if (found == pending_.end() || now - found->second.last < kApart)
    return false;
  Pending& pending = found->second;
  pending.last = now;
  if (++pending.announcements < kPatience)
    return false;
  pending.announcements = 0;
  return true;
}

}  // namespace saphira::bus::internal
