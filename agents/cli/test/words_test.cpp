#include "saphira/cli/words.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "trouble.hpp"

namespace saphira::cli {
namespace {

SeenProcess process(const std::string& name, double age) {
  SeenProcess seen;
  seen.status.name = name;
  seen.status.state = v1::SERVICE_RUNNING;
  seen.status.late_cycles = 7;
  seen.status.pid = 42;
  seen.age = age;
  return seen;
}

TEST(Table, AlignsColumns) {
  EXPECT_EQ(table({{"NAME", "N", "WHY"}, {"a", "100", "x"}, {"long name", "7", ""}}),
            "NAME       N    WHY\n"
            "a          100  x\n"
            "long name    7\n");
}

TEST(Words, ALongTextTakesTwoLines) {
  using Lines = std::array<std::string, 2>;
  EXPECT_EQ(two_lines("it stands", 9), (Lines{"it stands", ""}));
  EXPECT_EQ(two_lines("it stands now", 9), (Lines{"it stands", "now"}));
  EXPECT_EQ(two_lines("it stands now", 8), (Lines{"it", "stands n"}));
  EXPECT_EQ(two_lines("abcdefgh", 3), (Lines{"abc", "def"}));
}

TEST(StatusTable, SaysWhoIsLost) {
  const std::string text = status_table({process("intentions", 0.5), process("behaviors", 3.5)});
  const std::size_t behaviors = text.find("behaviors");
  const std::size_t intentions = text.find("intentions");
  ASSERT_NE(behaviors, std::string::npos);
  ASSERT_NE(intentions, std::string::npos);
  EXPECT_LT(behaviors, intentions);
  EXPECT_LT(behaviors, text.find("lost"));
  EXPECT_LT(text.find("lost"), intentions);
  EXPECT_EQ(text.find("lost", intentions), std::string::npos);
  EXPECT_NE(text.find("running", intentions), std::string::npos);
}

TEST(StatusTable, HasARowForWhoIsMissed) {
  const std::string text =
      status_table({process("intentions", 3.5)}, {"intentions", "registration"});
  EXPECT_TRUE(text.ends_with("\nregistration  not heard\n")) << text;
  EXPECT_EQ(text.find("intentions"), text.rfind("intentions")) << text;
}

TEST(Ending, IsThatOfTheContent) {
  EXPECT_NO_THROW(expect_ending("floor.svg", ".svg"));
  EXPECT_EQ(test::trouble_of<std::invalid_argument>([] { expect_ending("floor.txt", ".svg"); }),
            "floor.txt: expected a name that ends with .svg, the kind of file that this writes");
}

}  // namespace
}  // namespace saphira::cli
