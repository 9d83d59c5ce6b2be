#include "saphira/bus/audit.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "saphira/base/enum_pairs.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {
namespace {

using Act = AuditEntry::Act;

constexpr EnumPairs<Act, v1::AuditAct, 8> kActs{{{
    {Act::drove, v1::AUDIT_DROVE},
    {Act::stopped, v1::AUDIT_STOPPED},
    {Act::reset, v1::AUDIT_RESET},
    {Act::asked, v1::AUDIT_ASKED},
    {Act::changed, v1::AUDIT_CHANGED},
    {Act::canceled, v1::AUDIT_CANCELED},
    {Act::refused, v1::AUDIT_REFUSED},
    {Act::let_in, v1::AUDIT_LET_IN},
}}};

constexpr double kMinute = 60.0;  // [s]

}  // namespace

v1::AuditEntry to_bus(const AuditEntry& entry) {
  v1::AuditEntry result;
  result.time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  result.act = kActs.theirs(entry.act);
  result.who = entry.who;
  result.text = entry.text;
  return result;
}

AuditEntry from_bus(const v1::AuditEntry& entry) {
  return {kActs.ours(entry.act, Act::refused), entry.who, entry.text};
}

Audit::Audit(Node& node) {
  try {
    writer_.emplace(node.writer(topics::kAudit));
  } catch (const std::invalid_argument& refusal) {
    node.warn(std::string("the audit has nothing of this program: ") + refusal.what());
  }
}

void Audit::write(const AuditEntry& entry) {
  if (writer_)
    writer_->write(to_bus(entry));
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
  write({Act::refused, "somebody at " + door_,
         counted(std::exchange(wrong_keys_, 0), "wrong key") +
             (ended.empty() ? "" : ", with that of " + ended + ", which has ended")});
}

}  // namespace saphira::bus
