#include "saphira/intentions/journal.hpp"

#include <gtest/gtest.h>

#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

const Ending kEnding{{0xfedcba9876543210ULL, 7},
                     v1::GOAL_FAILED,
                     v1::CODE_BLOCKED,
                     "no nearer; 1.2 m from  the point"};
const Placement kPlacement{
    {3, 4}, 0x8000000000000001ULL, 12, 2, {{"position", {2.0, 0.1, 0.0}, {1.0 / 3.0, -4.5, 3.0}}}};

/// Reads the content and expects no damage.
Memory read(const std::string& content) {
  std::vector<FileError> damaged;
  Memory memory = read_journal("memory", content, damaged);
  EXPECT_TRUE(damaged.empty()) << damaged.front().what();
  return memory;
}

TEST(Journal, ReadsWhatItWrote) {
  const Memory memory = read(write_line(kPlacement) + write_line(kEnding));
  EXPECT_EQ(memory.endings, std::vector{kEnding});
  EXPECT_EQ(memory.placements, std::vector{kPlacement});
}

TEST(Journal, TheNewestPlacementCountsAndAnEndingEndsIt) {
  Placement again = kPlacement;
  again.cycle = 90;
  Memory memory = read(write_line(kPlacement) + write_line(again));
  EXPECT_EQ(memory.placements, std::vector{again});
  Ending ending = kEnding;
  ending.id = kPlacement.id;
  memory = read(write_line(kPlacement) + write_line(ending));
  EXPECT_TRUE(memory.placements.empty());
}

TEST(Journal, ALineBreakInAReasonIsNotOneInTheFile) {
  Ending ending = kEnding;
  ending.reason = "two\nlines";
  EXPECT_EQ(read(write_line(ending) + write_line(kEnding)).endings, (std::vector{ending, kEnding}));
}

// Each bit of a file flipped, and the file cut off at each letter: no remaining entry is wrong.
TEST(Journal, WhatIsDamagedIsToldAndTheRestCounts) {
  const std::string first = write_line(kPlacement);
  const std::string second = write_line(kEnding);
  const std::string whole = first + second;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      std::string content = whole;
      content[i] = static_cast<char>(content[i] ^ (1 << bit));
      std::vector<FileError> damaged;
      const Memory memory = read_journal("memory", content, damaged);
      EXPECT_TRUE(memory.placements.empty() || memory.placements == std::vector{kPlacement});
      EXPECT_TRUE(memory.endings.empty() || memory.endings == std::vector{kEnding});
      EXPECT_FALSE(damaged.empty()) << i << " " << bit;
      if (i >= first.size()) {
        EXPECT_EQ(memory.placements, std::vector{kPlacement}) << i << " " << bit;
      }
    }
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    std::vector<FileError> damaged;
    const Memory memory = read_journal("memory", whole.substr(0, length), damaged);
    EXPECT_EQ(damaged.empty(), length == 0 || length == first.size() || length == whole.size());
    EXPECT_EQ(memory.placements.size(), length >= first.size() ? 1U : 0U);
    EXPECT_EQ(memory.endings.size(), length == whole.size() ? 1U : 0U);
  }
}

TEST(Journal, SaysWhereItIsDamaged) {
  std::vector<FileError> damaged;
  read_journal("memory", write_line(kEnding) + "ended 1f 2 done none fine\n", damaged);
  ASSERT_EQ(damaged.size(), 1U);
  EXPECT_EQ(damaged[0].line(), 2);
  EXPECT_NE(std::string(damaged[0].what()).find("sum is wrong"), std::string::npos);
}

}  // namespace
}  // namespace saphira::intentions
