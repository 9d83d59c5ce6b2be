#pragma once

#include <string>
#include <utility>
#include <vector>

namespace saphira {

/// One line of a program's log, from a core: the shell adds time and name.
struct Note {
  enum class Level { info, warning, error };
  Level level = Level::info;
  std::string text;

  friend bool operator==(const Note&, const Note&) = default;
};

/// One entry of the audit (docs/security.md), from who decided it.
struct AuditEntry {
  enum class Act { drove, stopped, reset, asked, changed, canceled, refused, let_in };
  Act act = Act::drove;
  std::string who;   ///< as named() in identity.hpp: the checked identity, and the door
  std::string text;  ///< what was asked, or why it was refused

  friend bool operator==(const AuditEntry&, const AuditEntry&) = default;
};

/// The log messages of one step of a core, in order, and its entries of the audit.
class Notes {
 public:
  void info(std::string text) { lines_.push_back({Note::Level::info, std::move(text)}); }
  void warn(std::string text) { lines_.push_back({Note::Level::warning, std::move(text)}); }
  void error(std::string text) { lines_.push_back({Note::Level::error, std::move(text)}); }
  void audit(AuditEntry entry) { audit_.push_back(std::move(entry)); }

  const std::vector<AuditEntry>& audit() const { return audit_; }
  const std::vector<Note>& lines() const { return lines_; }
  bool empty() const { return lines_.empty(); }
  bool operator==(const Notes&) const = default;

 private:
  std::vector<Note> lines_;
  std::vector<AuditEntry> audit_;
};

}  // namespace saphira
