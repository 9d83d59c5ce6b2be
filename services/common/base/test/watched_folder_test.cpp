#include "saphira/base/watched_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "process.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

TEST(WatchedFolder, SaysWhatCameChangedAndWent) {
  const test::TempDir temporary;
  WatchedFolder folder(temporary.path(), ".act");
  EXPECT_FALSE(folder.poll().any());
  std::ofstream(temporary.path("a.act")) << "one";
  std::ofstream(temporary.path("b.txt")) << "other";
  std::ofstream(temporary.path("._a.act")) << "hidden";
  EXPECT_EQ(folder.poll().changed, Names{"a.act"});
  EXPECT_FALSE(folder.poll().any());
  std::ofstream(temporary.path("a.act")) << "longer";
  EXPECT_EQ(folder.poll().changed, Names{"a.act"});
  fs::remove(temporary.path("a.act"));
  EXPECT_EQ(folder.poll().gone, Names{"a.act"});
  fs::remove_all(temporary.path());
  EXPECT_TRUE(folder.poll().missing);
}

TEST(WatchedFolder, ABackupOfTheSameLengthAndTimeIsAnotherFile) {
  const test::TempDir temporary;
  const fs::path file = temporary.path("a.act");
  const fs::path backup = temporary.path("a.bak");
  std::ofstream(file) << "new";
  std::ofstream(backup) << "old";
  fs::last_write_time(backup, fs::last_write_time(file));
  WatchedFolder folder(temporary.path(), ".act");
  folder.poll();
  fs::rename(backup, file);
  EXPECT_EQ(folder.poll().changed, Names{"a.act"});
}

}  // namespace
}  // namespace saphira
