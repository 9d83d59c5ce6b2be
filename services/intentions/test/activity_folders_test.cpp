#include "saphira/intentions/activity_folders.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/functors.hpp"

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

}  // namespace
}  // namespace saphira::intentions
