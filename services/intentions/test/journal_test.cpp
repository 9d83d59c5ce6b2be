#include "saphira/intentions/journal.hpp"

#include <gtest/gtest.h>

#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

const Ending kEnding{{0xfedcba9876543210ULL, 7},
                     GoalState::kFailed,
                     GoalCode::kBlocked,
                     "no nearer; 1.2 m from  the point"};
const Placement kPlacement{
    {3, 4}, 0x8000000000000001ULL, 12, 2, {{"position", {2.0, 0.1, 0.0}, {1.0 / 3.0, -4.5, 3.0}}}};

TEST(Journal, ReadsWhatItWrote) {
  const Memory memory = read_journal("memory", write_line(kPlacement) + write_line(kEnding));
  EXPECT_EQ(memory.endings, std::vector{kEnding});
  EXPECT_EQ(memory.placements, std::vector{kPlacement});
}

TEST(Journal, ReadsEveryStateAndCodeThatAGoalCanEndWith) {
  const auto known = [](const char* name) { return name != std::string("?"); };
  int states = 0;
  for (int i = 0; known(name_of(static_cast<GoalState>(i))); ++i) {
    Ending ending = kEnding;
    ending.state = static_cast<GoalState>(i);
    if (!ended(ending.state)) {
      EXPECT_THROW(read_journal("memory", write_line(ending)), FileError) << i;
      continue;
    }
    EXPECT_EQ(read_journal("memory", write_line(ending)).endings, std::vector{ending});
    ++states;
  }
  EXPECT_EQ(states, 4);
  int codes = 0;
  for (; known(name_of(static_cast<GoalCode>(codes))); ++codes) {
    Ending ending = kEnding;
    ending.code = static_cast<GoalCode>(codes);
    EXPECT_EQ(read_journal("memory", write_line(ending)).endings, std::vector{ending});
  }
  EXPECT_EQ(codes, static_cast<int>(GoalCode::kPreempted) + 1);
}

// A goal that is over, or was placed anew, is not to keep the service from its start.
TEST(Journal, WhatHasBeenSupersededNeedNotBeReadable) {
  const std::string bad = "placed 3 4 1 12 2 position nan 0 0 0 0 1e13\n";
  EXPECT_THROW(read_journal("memory", bad), FileError);
  EXPECT_THROW(read_journal("memory", bad + write_line(kEnding)), FileError);
  EXPECT_EQ(read_journal("memory", bad + write_line(kPlacement)).placements,
            std::vector{kPlacement});
  EXPECT_THROW(read_journal("memory", write_line(kPlacement) + bad), FileError);
  Ending ending = kEnding;
  ending.id = kPlacement.id;
  EXPECT_EQ(read_journal("memory", bad + write_line(ending)).endings, std::vector{ending});
}

TEST(Journal, TheNewestPlacementCountsAndAnEndingEndsIt) {
  Placement again = kPlacement;
  again.cycle = 90;
  Memory memory = read_journal("memory", write_line(kPlacement) + write_line(again));
  EXPECT_EQ(memory.placements, std::vector{again});
  Ending ending = kEnding;
  ending.id = kPlacement.id;
  memory = read_journal("memory", write_line(kPlacement) + write_line(ending));
  EXPECT_TRUE(memory.placements.empty());
}

TEST(Journal, ALineBreakInAReasonIsNotOneInTheFile) {
  Ending ending = kEnding;
  ending.reason = "two\nlines";
  const Memory memory = read_journal("memory", write_line(ending) + write_line(kEnding));
  ASSERT_EQ(memory.endings.size(), 2U);
  EXPECT_EQ(memory.endings[0].reason, "two lines");
}

TEST(Journal, SkipsATornLastLine) {
  const std::string whole = write_line(kEnding);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Memory memory = read_journal("memory", whole + whole.substr(0, length));
    EXPECT_EQ(memory.endings.size(), 1U) << length;
  }
}

TEST(Journal, SaysWhereItCannotBeRead) {
  try {
    read_journal("memory", "ended 1f 2 succeeded none fine\nended 1f 2 done none fine\n");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_EQ(error.column(), 12);
    EXPECT_NE(std::string(error.what()).find("expected the state"), std::string::npos);
  }
  EXPECT_THROW(read_journal("memory", "begun 1 2\n"), FileError);
  EXPECT_THROW(read_journal("memory", "ended xyz 2 failed none no\n"), FileError);
  EXPECT_THROW(read_journal("memory", "placed 1 2 3 4 5 position 1 2\n"), FileError);
}

}  // namespace
}  // namespace saphira::intentions
