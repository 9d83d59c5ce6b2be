#include "intentions/shell/memory_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

const Ending kEnding{{1, 2}, GoalState::kSucceeded, GoalCode::kNone, "arrived"};

TEST(MemoryFile, WithoutAPathNothingIsRemembered) {
  MemoryFile memory("");
  EXPECT_TRUE(memory.append("anything\n"));
  EXPECT_EQ(memory.memory(), Memory{});
}

TEST(MemoryFile, RemembersOverARestart) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  {
    MemoryFile memory(path);
    EXPECT_TRUE(memory.append(write_line(Placement{{1, 2}, 3, 4, 5, {}})));
    EXPECT_TRUE(memory.append(write_line(Placement{{6, 7}, 3, 4, 5, {}})));
    EXPECT_TRUE(memory.append(write_line(kEnding)));
  }
  {
    MemoryFile memory(path);
    EXPECT_EQ(memory.memory().endings, std::vector{kEnding});
    ASSERT_EQ(memory.memory().placements.size(), 1U);
    // What the ending superseded is not written again.
    EXPECT_EQ(read_file(path).find("placed 1 2"), std::string::npos);
  }
}

TEST(MemoryFile, GoesOnAfterATornLine) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  std::ofstream(path) << write_line(kEnding) << "ended 1 3 succ";
  Ending next = kEnding;
  next.id.number = 4;
  EXPECT_TRUE(MemoryFile(path).append(write_line(next)));
  EXPECT_EQ(MemoryFile(path).memory().endings, (std::vector{kEnding, next}));
}

// A disk that is full for a while: here a limit on the size of files.
TEST(MemoryFile, WhatIsWrittenHalfIsTakenBack) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  Ending next = kEnding;
  next.id.number = 4;
  MemoryFile memory(path);
  ASSERT_TRUE(memory.append(write_line(kEnding)));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit full = before;
  full.rlim_cur = write_line(kEnding).size() + 10;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  const bool written = memory.append(write_line(next));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(written);
  EXPECT_EQ(read_file(path), write_line(kEnding));
  next.id.number = 5;
  EXPECT_TRUE(memory.append(write_line(next)));
  EXPECT_EQ(MemoryFile(path).memory().endings, (std::vector{kEnding, next}));
}

TEST(MemoryFile, KeepsTheNewestEndings) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  {
    MemoryFile memory(path);
    for (std::uint64_t i = 1; i <= 5; ++i)
      memory.append(write_line(Ending{{1, i}, GoalState::kSucceeded, GoalCode::kNone, "arrived"}));
  }
  EXPECT_EQ(MemoryFile(path, 3).memory().endings.front().id.number, 3U);
  EXPECT_EQ(MemoryFile(path).memory().endings.size(), 3U);
}

TEST(MemoryFile, ABadFileIsAnErrorAndStaysAsItIs) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  std::ofstream(path) << "something else\n";
  EXPECT_THROW(MemoryFile{path}, FileError);
  EXPECT_EQ(read_file(path), "something else\n");
  EXPECT_THROW(MemoryFile{dir.path("no/such/folder")}, std::runtime_error);
}

}  // namespace
}  // namespace saphira::intentions
