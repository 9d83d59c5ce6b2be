#include "intentions/shell/memory_file.hpp"

#include <gtest/gtest.h>

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
