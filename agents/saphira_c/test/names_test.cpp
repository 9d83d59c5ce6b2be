// docs/c-api.md has exactly the names of saphira.h, and every name in the manual is in one of the
// two.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "printed.hpp"

namespace saphira {
namespace {

std::string read(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::set<std::string> all(const std::string& text, const std::string& pattern) {
  std::set<std::string> found;
  const std::regex expression(pattern);
  for (auto it = std::sregex_iterator(text.begin(), text.end(), expression);
       it != std::sregex_iterator(); ++it)
    found.insert((*it)[1]);
  return found;
}

std::string header() {
  const std::string text = read(test::source("agents/saphira_c/include/saphira.h"));
  return std::regex_replace(text, std::regex(R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)"), " ");
}

TEST(Names, EachOfTheHeaderIsInTheTable) {
  const std::set<std::string> named =
      all(read(test::source("docs/c-api.md")), "`(?:struct )?(\\w+)`");
  ASSERT_GT(named.size(), 250U);
  const std::string text = header();
  for (const char* const pattern :
       {R"(\b(sf[A-Z]\w*|sf_\w+)\b)", R"((\w+)\([^()]*\)(?: SF_LIKE_PRINTF)?;)",
        R"(\b([A-Z][A-Z_]+(?:MODE|COM|COLLISION)|STATUS_\w+)\b)"})
    for (const std::string& name : all(text, pattern))
      EXPECT_TRUE(named.contains(name)) << name << " is not in docs/c-api.md";
}

TEST(Names, EachOfTheTableIsInTheHeader) {
  const std::string page = read(test::source("docs/c-api.md"));
  const std::string table = page.substr(0, page.find("## What differs"));
  const std::set<std::string> there = all(header(), R"(\b(\w+)\b)");
  for (const std::string& name : all(table.substr(table.find("## Names")), "`(?:struct )?(\\w+)`"))
    EXPECT_TRUE(there.contains(name)) << name << " is not in saphira.h";
}

TEST(Names, EachOfTheManualIsInTheHeaderOrDiffers) {
  const std::string manual = test::manual();
  if (manual.empty())
    GTEST_SKIP() << "the manual is not there (SAPHIRA_MANUAL, ../shared/seeds)";
  std::set<std::string> there = all(header(), R"(\b(\w+)\b)");
  there.merge(all(read(test::source("docs/c-api.md")), "`(\\w+)`"));
  std::set<std::string> named = all(manual, R"(\b(sf[A-Za-z0-9_]+)\b)");
  named.merge(all(manual, R"(\b([A-Za-z][A-Za-z0-9]*_\w+)\b)"));
  // Chapter 12: a prototype begins a line, or the text between two tags.
  const std::string reference = manual.substr(manual.rfind("12. Saphira API Reference"));
  named.merge(all(
      reference,
      R"((?:^|\n|>)(?:void|int|float|process \*|point \*|BEHCLOSURE|char \*|behavior \*|wall) ?\*?(\w+)\()"));
  ASSERT_GT(named.size(), 150U);
  // The program's own names, and errors of the scan that no name begins with.
  for (const char* const own : {"myButtonFn", "myKeyFn", "siBehaviorOff", "siBehaviorOn"})
    named.erase(own);
  // Of the examples, of the makefiles, of the servers and of the behavior grammar of chapter 11.
  for (const char* const other : {"CHECK_CORRIDOR",
                                  "FOLLOW_CORRIDOR",
                                  "WAIT_REMOVE",
                                  "FD_DISPLAY",
                                  "FD_FIND",
                                  "find_doors",
                                  "follow_target",
                                  "found_one",
                                  "goal_pt",
                                  "near_goal",
                                  "too_left",
                                  "too_right",
                                  "test_control_proc",
                                  "ROBOT_SOCKET",
                                  "SERVER_NAME",
                                  "b_0",
                                  "b_1",
                                  "b_3",
                                  "calc_chksum",
                                  "line_bottom_row",
                                  "line_min_mass",
                                  "line_num_slices",
                                  "line_slice_size",
                                  "pioneer_X_mode",
                                  "ACT_STMTS",
                                  "C_STMTS",
                                  "FUZZY_EXP",
                                  "PARAM_STMTS",
                                  "RULE_STMTS"})
    named.erase(other);
  for (const std::string& name : named) {
    const bool slip = name.starts_with("si");
    EXPECT_TRUE(there.contains(name) || slip) << name;
  }
}

}  // namespace
}  // namespace saphira
