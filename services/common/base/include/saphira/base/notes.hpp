#pragma once

#include <string>
#include <utility>
#include <vector>

#include "saphira/base/archived.hpp"

namespace saphira {

/// One line of a program's log, from a core: the shell adds time and name.
struct Note {
  enum class Level { info, warning, error };
  Level level = Level::info;
  std::string text;

  friend bool operator==(const Note&, const Note&) = default;
};

/// The log messages of one step of a core, in order.
class Notes {
 public:
  void info(std::string text) { lines_.push_back({Note::Level::info, std::move(text)}); }
  void warn(std::string text) { lines_.push_back({Note::Level::warning, std::move(text)}); }
  void error(std::string text) { lines_.push_back({Note::Level::error, std::move(text)}); }

  const std::vector<Note>& lines() const { return lines_; }
  bool empty() const { return lines_.empty(); }
  bool operator==(const Notes&) const = default;

  SAPHIRA_ARCHIVE(lines_)

 private:
  std::vector<Note> lines_;
};

}  // namespace saphira
