#include "report.hpp"

namespace saphira::bench {

void Report::heading(const std::string& text) {
  std::printf("\n%s\n", text.c_str());
  markdown_ += "\n## " + text + "\n";
}

void Report::columns(const std::vector<std::string>& names) {
  std::printf("\n  %-36s", "");
  markdown_ += "\n| ";
  std::string rule = "|---";
  for (const std::string& name : names) {
    std::printf(" %s;", name.c_str());
    markdown_ += " | " + name;
    rule += "|---";
  }
  std::printf("\n");
  markdown_ += " |\n" + rule + "|\n";
}

void Report::row(const std::string& what, const std::vector<std::string>& cells) {
  std::printf("  %-36s", what.c_str());
  markdown_ += "| " + what;
  for (const std::string& cell : cells) {
    std::printf(" %s ", cell.c_str());
    markdown_ += " | " + cell;
  }
  std::printf("\n");
  std::fflush(stdout);
  markdown_ += " |\n";
}

void Report::note(const std::string& text) {
  std::printf("  %s\n", text.c_str());
  std::fflush(stdout);
  notes_ += "- " + text + "\n";
}

void Report::picture(const std::string& title, const std::string& path) {
  notes_ += "\n![" + title + "](" + path + ")\n";
}

void Report::end_of_set() {
  markdown_ += "\n" + notes_;
  notes_.clear();
}

}  // namespace saphira::bench
