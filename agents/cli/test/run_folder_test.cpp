// Other users of the machine may put files where this user's programs look for its own.
#include "run_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "process.hpp"
#include "saphira/base/archive.hpp"

namespace saphira::cli {
namespace {

namespace fs = std::filesystem;

/// A user without a home of its own, by root alone: there is nobody else to be.
class RunFolders : public testing::Test {
 protected:
  static constexpr uid_t kStranger = 60001;

  void SetUp() override {
    if (geteuid() != 0)
      GTEST_SKIP() << "other users are made by root alone";
    ASSERT_FALSE(fs::exists(folder_)) << folder_;
    setenv("SAPHIRA_RUN", chosen_.path("run").c_str(), 1);
    ASSERT_EQ(setreuid(user_, 0), 0);
  }
  void TearDown() override {
    if (geteuid() == 0) {
      EXPECT_EQ(setreuid(0, 0), 0);
    }
    unsetenv("SAPHIRA_RUN");
    fs::remove_all(folder_);
  }
  /// A file with that content, which a program holds.
  static int held(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
    const int lock = open(file.c_str(), O_RDWR | O_CLOEXEC);
    EXPECT_EQ(flock(lock, LOCK_EX), 0);
    return lock;
  }
  void give(uid_t owner, const fs::path& path) const {
    EXPECT_EQ(lchown(path.c_str(), owner, owner), 0) << path;
  }
  /// The names of this user's deployments that are found, and the robots of its buses.
  static std::string found() {
    std::string all;
    for (const Running& one : running_deployments())
      all += one.name + " " + std::to_string(one.pid) + " ";
    for (const RunningBus& bus : running_buses())
      if (bus.robot == "there")
        all += bus.robot;
    return all;
  }

  const uid_t user_ = 61000 + static_cast<uid_t>(getpid()) % 1000;
  const fs::path folder_ = "/tmp/saphira-" + std::to_string(user_);
  const test::TempDir chosen_;
};

TEST_F(RunFolders, WhatAnotherUserPutsInTheTemporaryFolderIsNotFound) {
  const fs::path lock = folder_ / "demo-there-0" / "lock";
  const fs::path bus = folder_ / "buses" / "there-0-1";
  const RunningBus there{"the demo", "there", 0, "host", {}, "", false};
  const int locks[]{held(lock, "4321 0 there"), held(bus, saved(there) + "\n")};
  const auto own = [&](uid_t owner) {
    for (const fs::path& path : {folder_, lock.parent_path(), lock, bus.parent_path(), bus})
      give(owner, path);
  };
  own(kStranger);
  EXPECT_EQ(found(), "");
  own(user_);
  EXPECT_EQ(found(), "demo-there-0 4321 there");
  for (const fs::path& path : {lock, bus})
    give(kStranger, path);
  EXPECT_EQ(found(), "") << "in an own folder that others may write to";
  own(user_);
  for (const fs::path& path : {lock.parent_path(), bus.parent_path()})
    give(kStranger, path);
  EXPECT_EQ(found(), "");
  own(user_);
  const fs::path moved = chosen_.path("moved");
  fs::rename(folder_, moved);
  fs::create_directory_symlink(moved, folder_);
  give(kStranger, folder_);
  EXPECT_EQ(found(), "") << "a link to a folder of this user";
  for (const int each : locks)
    close(each);
}

TEST_F(RunFolders, NothingIsKeptInAFolderOfAnotherUser) {
  setenv("SAPHIRA_RUN", folder_.c_str(), 1);
  fs::create_directory(folder_);
  fs::permissions(folder_, fs::perms::all);
  give(kStranger, folder_);
  EXPECT_NE(test::trouble_of<std::runtime_error>([] { RunFolder temporary; }), "");
  EXPECT_NE(test::trouble_of<std::runtime_error>([] { RunFolder named("demo-a-0", "a", 0); }), "");
  EXPECT_TRUE(fs::is_empty(folder_));
  give(user_, folder_);
  EXPECT_EQ(test::trouble_of<std::runtime_error>([] { RunFolder temporary; }), "");
}

}  // namespace
}  // namespace saphira::cli
