#pragma once

#include <optional>
#include <string>

#include "saphira/base/notes.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus {

v1::AuditEntry to_bus(const AuditEntry& entry);
AuditEntry from_bus(const v1::AuditEntry& entry);

/// A program's side of the audit, which the bridge keeps.
class Audit {
 public:
  explicit Audit(Node& node) : writer_(node.writer(topics::kAudit)) {}

  void write(const AuditEntry& entry) { writer_.write(to_bus(entry)); }
  /// Somebody came with a key that nobody has. One entry a minute at most, with their number.
  /// now: [s] of a clock that never goes back.
  void wrong_key(const std::string& door, double now);

 private:
  Writer<v1::AuditEntry> writer_;
  std::size_t wrong_keys_ = 0;
  std::optional<double> told_;  ///< [s] of wrong keys
};

}  // namespace saphira::bus
