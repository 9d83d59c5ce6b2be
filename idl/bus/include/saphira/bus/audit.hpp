#pragma once

#include <optional>
#include <string>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// With the time of now.
v1::AuditEntry timed(v1::AuditEntry entry);

/// A program's side of the audit, which the bridge keeps. Without the right to write it a warning
/// says so, and nothing is written.
class Audit {
 public:
  explicit Audit(Node& node);

  void write(const v1::AuditEntry& entry);
  /// Somebody came with a key that nobody has; `ended`: the person whose key it was [empty: none].
  /// One entry a minute at most, with their number. now: [s] of a clock that never goes back.
  void wrong_key(const std::string& door, double now, const std::string& ended = {});
  /// Tells of the wrong keys that came within that minute. Now and then.
  void tend(double now);

 private:
  std::optional<Writer<v1::AuditEntry>> writer_;
  std::string door_;  ///< of the wrong keys
  std::string ended_;
  std::size_t wrong_keys_ = 0;
  std::optional<double> told_;  ///< [s] of wrong keys
};

}  // namespace saphira::bus
