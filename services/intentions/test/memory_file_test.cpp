#include "intentions/shell/memory_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "process.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

const Ending kEnding{{1, 2}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "arrived"};

std::string line(const Ending& ending) {
  return sealed(saved(ending));
}

TEST(MemoryFile, WithoutAPathNothingIsRemembered) {
  MemoryFile memory("");
  EXPECT_TRUE(memory.append({kEnding}));
  EXPECT_EQ(memory.memory(), Memory{});
  EXPECT_EQ(memory.memory().condition, Memory::Condition::kNone);
}

TEST(MemoryFile, RemembersOverARestart) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  {
    MemoryFile memory(path);
    EXPECT_EQ(memory.memory().condition, Memory::Condition::kNone);
    Ending ending = kEnding;
    ending.reason = "two\nlines";
    EXPECT_TRUE(memory.append({kEnding, ending}));
  }
  const MemoryFile memory(path);
  EXPECT_EQ(memory.memory().condition, Memory::Condition::kWhole);
  ASSERT_EQ(memory.memory().endings.size(), 2U);
  EXPECT_EQ(memory.memory().endings[1].reason, "two\nlines");
}

TEST(MemoryFile, OneThatWasCutIsDamaged) {
  const auto after = [](const std::function<void(const std::string& path)>& cut) {
    const test::TempDir dir;
    const std::string path = dir.path("goals.memory");
    {
      MemoryFile memory(path);
      for (std::uint64_t i = 1; i <= 4; ++i)
        memory.append({{{1, i}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "there"}});
      memory.keep({.ended = GoalId{1, 4}});
    }
    cut(path);
    const MemoryFile memory(path);
    EXPECT_EQ(memory.memory().condition == Memory::Condition::kDamaged, !memory.troubles().empty());
    return std::pair(memory.memory().condition, memory.memory().endings.size());
  };
  using Condition = Memory::Condition;
  EXPECT_EQ(after([](const std::string&) {}), std::pair(Condition::kWhole, std::size_t{4}));
  const auto keep = [](double part) {
    return [part](const std::string& path) {
      const std::string content = read_file(path);
      std::ofstream(path) << content.substr(
          0, static_cast<std::size_t>(part * static_cast<double>(content.size())));
    };
  };
  // Between two lines, and within one.
  EXPECT_EQ(after(keep(0.5)), std::pair(Condition::kDamaged, std::size_t{2}));
  EXPECT_EQ(after(keep(0.4)), std::pair(Condition::kDamaged, std::size_t{1}));
  EXPECT_EQ(after(keep(0.0)), std::pair(Condition::kDamaged, std::size_t{0}));
  EXPECT_EQ(after([](const std::string& path) { std::filesystem::remove(path); }),
            std::pair(Condition::kDamaged, std::size_t{0}));
  EXPECT_EQ(after([](const std::string& path) {
              for (const char* const end : {"", ".work"})
                std::filesystem::remove(path + end);
            }),
            std::pair(Condition::kNone, std::size_t{0}));
}

TEST(MemoryFile, GoesOnAfterATornLine) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  std::ofstream(path) << line(kEnding) << line(kEnding).substr(0, 40);
  Ending next = kEnding;
  next.id.number = 4;
  EXPECT_TRUE(MemoryFile(path).append({next}));
  EXPECT_EQ(MemoryFile(path).memory().endings, (std::vector{kEnding, next}));
}

// A disk that is full for a while: here a limit on the size of files.
TEST(MemoryFile, WhatIsWrittenHalfIsTakenBack) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  Ending next = kEnding;
  next.id.number = 4;
  MemoryFile memory(path);
  ASSERT_TRUE(memory.append({kEnding}));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit full = before;
  full.rlim_cur = line(kEnding).size() + 10;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  const bool written = memory.append({next});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(written);
  EXPECT_EQ(read_file(path), line(kEnding));
  next.id.number = 5;
  EXPECT_TRUE(memory.append({next}));
  EXPECT_EQ(MemoryFile(path).memory().endings, (std::vector{kEnding, next}));
}

TEST(MemoryFile, DoesNotGrowForEver) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  MemoryFile memory(path, 10);
  std::size_t longest = 0;
  for (std::uint64_t i = 1; i <= 200; ++i) {
    ASSERT_TRUE(memory.append({{{1, i}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "arrived"}}));
    longest = std::max(longest, read_file(path).size());
  }
  EXPECT_LT(longest, 23 * line(kEnding).size() + 60);
  const Memory kept = MemoryFile(path, 10).memory();
  EXPECT_EQ(kept.endings.size(), 10U);
  EXPECT_EQ(kept.endings.back().id.number, 200U);
}

TEST(MemoryFile, WhatIsDamagedIsSetAsideAndTheRestCounts) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  const std::string content = line(kEnding) + "something else\n";
  std::ofstream(path) << content;
  const MemoryFile memory(path);
  EXPECT_EQ(memory.memory().endings, std::vector{kEnding});
  ASSERT_EQ(memory.troubles().size(), 1U);
  EXPECT_NE(memory.troubles()[0].find("goals.memory.damaged"), std::string::npos)
      << memory.troubles()[0];
  EXPECT_EQ(read_file(path + ".damaged"), content);
  EXPECT_EQ(read_file(path), line(kEnding));
  EXPECT_TRUE(MemoryFile(path).troubles().empty());
  EXPECT_THROW(MemoryFile{dir.path("no/such/folder")}, std::invalid_argument);
}

// Each bit of a line flipped: no remaining entry is wrong.
TEST(MemoryFile, AWrongBitIsToldAndTheRestCounts) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  const std::string whole = line(kEnding) + line(kEnding);
  for (std::size_t i = line(kEnding).size(); i < whole.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      std::string content = whole;
      content[i] = static_cast<char>(content[i] ^ (1 << bit));
      std::ofstream(path) << content;
      const MemoryFile memory(path);
      EXPECT_EQ(memory.memory().endings, std::vector{kEnding}) << i << " " << bit;
      EXPECT_EQ(memory.troubles().size(), 1U) << i << " " << bit;
    }
}

TEST(MemoryFile, ADryRunChangesNoFile) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  const std::string content = line(kEnding) + "something else\n";
  std::ofstream(path) << content;
  MemoryFile memory(path, kMostEndings, Files::kStay);
  EXPECT_EQ(memory.troubles().size(), 1U);
  EXPECT_TRUE(memory.append({kEnding}));
  EXPECT_TRUE(memory.keep({}));
  EXPECT_EQ(read_file(path), content);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
  EXPECT_THROW(MemoryFile(dir.path("no/such/folder"), kMostEndings, Files::kStay),
               std::invalid_argument);
}

TEST(MemoryFile, AnotherFileIsRefusedAndStays) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.txt");
  std::ofstream(path) << "my goals\n";
  for (const Files files : {Files::kChange, Files::kStay})
    EXPECT_THROW(MemoryFile(path, kMostEndings, files), std::invalid_argument);
  EXPECT_EQ(read_file(path), "my goals\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

TEST(MemoryFile, RemembersTheWorkAndSetsAsideWhatIsDamagedOfIt) {
  const test::TempDir dir;
  const std::string path = dir.path("goals.memory");
  Work work{.epoch = 0xfedcba9876543210ULL, .now = 77};
  work.goals[{0xfedcba9876543210ULL, 7}].tree = {"[1.5,\"a b\"]"};
  work.beliefs = {{"*speed*", Value(0.3), "patrol", -4}};
  EXPECT_TRUE(MemoryFile(path).keep(work));
  EXPECT_EQ(MemoryFile(path).memory().work, work);
  const std::string whole = read_file(path + ".work");
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int bit : {0, 3, 6}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      std::ofstream(path + ".work") << damaged;
      const MemoryFile memory(path);
      EXPECT_EQ(memory.memory().work, Work{}) << i << " " << bit;
      EXPECT_EQ(memory.troubles().size(), 1U) << i << " " << bit;
    }
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::ofstream(path + ".work") << whole.substr(0, length);
    EXPECT_EQ(MemoryFile(path).memory().work, Work{}) << length;
  }
}

}  // namespace
}  // namespace saphira::intentions
