#include "table.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::situation::test {
namespace {

std::vector<Case> cases_of(const std::string& name) {
  const std::string file = "agents/situation/test/" + name;
  return read_cases(read_file(saphira::test::source(file)), file);
}

TEST(Situations, EachAnswerSaysWhatItMustAndNothingFalse) {
  std::vector<Case> all = cases_of("situations.txt");
  EXPECT_GE(all.size(), 150U);
  for (const char* const name : {"why.txt", "conditions.txt"}) {
    const std::vector<Case> more = cases_of(name);
    EXPECT_GE(more.size(), 20U);
    all.insert(all.end(), more.begin(), more.end());
  }
  for (const Case& one : all) {
    const Faults found = faults(one);
    for (const std::string& part : found.lacks)
      ADD_FAILURE() << one.words << ", " << one.question << ": lacks " << part
                    << "\n  it says: " << answer(one);
    for (const std::string& part : found.says)
      ADD_FAILURE() << one.words << ", " << one.question << ": says " << part
                    << "\n  it says: " << answer(one);
  }
}

TEST(Situations, AWrongLineIsNamed) {
  const auto trouble = [](const std::string& text) {
    return saphira::test::trouble_of<std::invalid_argument>([&] { read_cases(text, "f"); });
  };
  EXPECT_EQ(trouble("situation a\nis driving\nask why\nmust drive\n"), "");
  EXPECT_TRUE(trouble("situation a\nis flying\n").starts_with("f:2: "));
  EXPECT_TRUE(trouble("situation a\nis driving\nwith wings 2\n").starts_with("f:3: "));
  EXPECT_TRUE(trouble("situation a\nis driving\nwith {\"robot\":{\"velocity\":\"num fast\"}}\n")
                  .starts_with("f:3: "));
  EXPECT_TRUE(trouble("situation a\nmust drive\n").starts_with("f:2: "));
}

TEST(Situations, TheTableInTheDocumentsIsOfNow) {
  const std::string path = saphira::test::source("docs/situations.md");
  const std::string table = to_markdown(cases_of("situations.txt"));
  if (std::getenv("SAPHIRA_WRITE_TABLE") != nullptr)
    std::ofstream(path) << table;
  EXPECT_EQ(read_file(path), table)
      << "written anew by SAPHIRA_WRITE_TABLE=1 saphira_situation_test";
}

}  // namespace
}  // namespace saphira::situation::test
