#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace saphira::bench {

template <typename... Values>
std::string format(const char* how, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), how, values...);
  return text.data();
}

/// The results, printed to the terminal as they come and collected for a Markdown file.
class Report {
 public:
  void heading(const std::string& text);
  /// Begins a table.
  void columns(const std::vector<std::string>& names);
  void row(const std::string& what, const std::vector<std::string>& cells);
  /// Adds a note after the tables.
  void note(const std::string& text);
  void picture(const std::string& title, const std::string& path);
  void end_of_set();
  const std::string& markdown() const { return markdown_; }

 private:
  std::string markdown_;
  std::string notes_;
};

}  // namespace saphira::bench
