#include "saphira/bus/audit.hpp"

#include <chrono>
#include <utility>

#include "saphira/base/enum_pairs.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {
namespace {

using Act = AuditEntry::Act;

constexpr double kMinute = 60.0;  // [s]
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

void Audit::wrong_key(const std::string& door, double now) {
  ++wrong_keys_;
  if (told_ && now - *told_ < kMinute)
    return;
  told_ = now;
  write({Act::refused, "somebody at " + door, counted(std::exchange(wrong_keys_, 0), "wrong key")});
}

}  // namespace saphira::bus
