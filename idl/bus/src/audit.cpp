#include "saphira/bus/audit.hpp"

#include <stdexcept>
#include <utility>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {
namespace {

constexpr double kMinute = 60.0;  // [s]

}  // namespace

v1::AuditEntry timed(v1::AuditEntry entry) {
  entry.time_ns = unix_nanoseconds();
  return entry;
}

Audit::Audit(Node& node) {
  try {
    writer_.emplace(node.writer(topics::kAudit));
  } catch (const std::invalid_argument& refusal) {
    node.warn(std::string("the audit has nothing of this program: ") + refusal.what());
  }
}

void Audit::write(const v1::AuditEntry& entry) {
  if (writer_)
    writer_->write(timed(entry));
}

void Audit::wrong_key(const std::string& door, double now, const std::string& ended) {
  door_ = door;
  if (!ended.empty())
    ended_ = ended;
  ++wrong_keys_;
  tend(now);
}

void Audit::tend(double now) {
  if (wrong_keys_ == 0 || (told_ && now - *told_ < kMinute))
    return;
  told_ = now;
  const std::string ended = std::exchange(ended_, {});
  write({.act = v1::AUDIT_REFUSED,
         .who = "somebody at " + door_,
         .text = counted(std::exchange(wrong_keys_, 0), "wrong key") +
                 (ended.empty() ? "" : ", with that of " + ended + ", which has ended")});
}

}  // namespace saphira::bus
