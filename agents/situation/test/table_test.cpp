#include "table.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::situation::test {
namespace {

TEST(Situations, EachAnswerSaysWhatItMustAndNothingFalse) {
  for (const Case& one : all_cases())
    for (const std::string& fault : faults(one))
      ADD_FAILURE() << one.words << ", " << one.question << ": " << fault
                    << "\n  it says: " << answer(one);
}

TEST(Situations, TheTableInTheDocumentsIsOfNow) {
  const std::string path = saphira::test::source("docs/situations.md");
  const std::string table = to_markdown(all_cases());
  if (std::getenv("SAPHIRA_WRITE_TABLE") != nullptr)
    std::ofstream(path) << table;
  EXPECT_EQ(read_file(path), table)
      << "written anew by SAPHIRA_WRITE_TABLE=1 saphira_situation_test";
}

}  // namespace
}  // namespace saphira::situation::test
