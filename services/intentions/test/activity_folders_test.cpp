#include "saphira/intentions/activity_folders.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/journal.hpp"

namespace saphira::intentions {
namespace {

namespace fs = std::filesystem;

class ActivityFoldersTest : public ::testing::Test {
 protected:
  ActivityFoldersTest() {
    fs::create_directories(shipped);
    fs::create_directories(own);
  }

  /// Each write of a test has its own time: two writes within a tick of the file system's clock
  /// would look like one.
  void write(const fs::path& path, const std::string& content) {
    std::ofstream(path) << content;
    fs::last_write_time(path, fs::file_time_type(std::chrono::seconds(++time)));
  }
  static std::string activity(const std::string& name, const std::string& goals) {
    return "(defintention :" + name + "\n  :goals '(" + goals + "))\n";
  }
  std::vector<std::string> look() {
    reload = folders->reload();
    std::vector<std::string> names;
    for (const Schema& schema : reload.taken)
      names.push_back(schema.name);
    return names;
  }
  using Names = std::vector<std::string>;

  const test::TempDir root;
  const fs::path shipped = root.path("shipped");
  const fs::path own = root.path("own");
  int time = 1000000;
  std::optional<ActivityFolders> folders{std::in_place, Names{shipped.string(), own.string()},
                                         std::make_shared<const Functions>(core_functions()),
                                         built_in()};
  ActivityFolders::Reload reload;
};

TEST_F(ActivityFoldersTest, AChangedFileIsTakenAndNothingElse) {
  write(shipped / "a.act", activity("one", "(WAIT-FOR nil :timeout 1s)"));
  write(shipped / "b.act", activity("two", "(INTEND :one ())"));
  EXPECT_EQ(look(), (Names{"one", "two"}));
  EXPECT_FALSE(folders->reload().changed);
  write(shipped / "a.act", activity("one", "(WAIT-FOR nil :timeout 2s)"));
  EXPECT_EQ(look(), Names{"one"});
  fs::remove(shipped / "b.act");
  EXPECT_EQ(look(), Names{});
  EXPECT_EQ(reload.removed, Names{"two"});
}

TEST_F(ActivityFoldersTest, ABrokenFileLeavesWhatItGaveBefore) {
  write(shipped / "a.act", activity("one", "(WAIT-FOR nil :timeout 1s)"));
  write(shipped / "b.act", activity("two", "(INTEND :one ())"));
  look();
  write(shipped / "a.act", activity("one", "(WAIT-FOR (nonsense) :timeout 1s"));
  EXPECT_EQ(look(), Names{});
  EXPECT_EQ(reload.removed, Names{});
  ASSERT_FALSE(reload.errors.empty());
  EXPECT_NE(reload.errors[0].find((shipped / "a.act").string() + ":"), std::string::npos);
  EXPECT_NE(reload.errors[0].find("What this file gave before stays in use."), std::string::npos);
  EXPECT_NE(folders->trouble().find("a.act"), std::string::npos);
  // A file that uses definitions of the broken one is not wrong for that.
  EXPECT_EQ(folders->trouble().find("b.act"), std::string::npos);
  write(shipped / "a.act", activity("one", "(WAIT-FOR nil :timeout 3s)"));
  EXPECT_EQ(look(), Names{"one"});
  EXPECT_EQ(folders->trouble(), "");
}

TEST_F(ActivityFoldersTest, AFileIsTriedAgainWhenItsBehaviorHasCome) {
  folders->know_behaviors({});
  write(own / "spin.act", activity("spin", "(INTEND :Spin ())"));
  EXPECT_EQ(look(), Names{});
  ASSERT_EQ(reload.errors.size(), 1U);
  EXPECT_EQ(reload.errors[0].find("stays in use"), std::string::npos) << "it gave nothing";
  BehaviorSignature spin;
  spin.name = "Spin";
  folders->know_behaviors({spin});
  EXPECT_EQ(look(), Names{"spin"});
  EXPECT_EQ(folders->trouble(), "");
  EXPECT_FALSE(folders->reload().changed);
}

// Some editors empty a file before they write it.
TEST_F(ActivityFoldersTest, AFileThatIsEmptiedKeepsWhatItGave) {
  write(shipped / "a.act", activity("one", "(SUCCEED)"));
  look();
  write(shipped / "a.act", "");
  EXPECT_EQ(look(), Names{});
  EXPECT_TRUE(reload.removed.empty());
  ASSERT_EQ(reload.errors.size(), 1U);
  EXPECT_NE(folders->trouble().find("there is no activity in this file"), std::string::npos);
  write(shipped / "a.act", activity("one", "(FAIL)"));
  EXPECT_EQ(look(), Names{"one"});
  EXPECT_EQ(folders->trouble(), "");
}

TEST_F(ActivityFoldersTest, ALaterFolderCoversAnEarlierOne) {
  write(shipped / "a.act", activity("one", "(WAIT-FOR nil :timeout 1s)"));
  write(own / "mine.act", activity("one", "(WAIT-FOR nil :timeout 9s)"));
  EXPECT_EQ(look(), Names{"one"});
  EXPECT_EQ(reload.taken[0].source, (own / "mine.act").string());
  fs::remove(own / "mine.act");
  EXPECT_EQ(look(), Names{"one"});
  EXPECT_EQ(reload.taken[0].source, (shipped / "a.act").string());
}

TEST_F(ActivityFoldersTest, WhatIsBuiltInIsNotCovered) {
  write(own / "mine.act", activity("go_to", "(WAIT-FOR nil :timeout 9s)"));
  EXPECT_EQ(look(), Names{});
  ASSERT_EQ(reload.errors.size(), 1U);
  EXPECT_NE(reload.errors[0].find("built in"), std::string::npos);
}

TEST_F(ActivityFoldersTest, AFolderThatIsNotThereIsSaid) {
  fs::remove_all(own);
  look();
  EXPECT_NE(folders->trouble().find("expected a folder"), std::string::npos);
  fs::create_directories(own);
  look();
  EXPECT_EQ(folders->trouble(), "");
}

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
