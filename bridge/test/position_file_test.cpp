#include "position_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "small_disk.hpp"
#include "trouble.hpp"

namespace saphira::bridge {
namespace {

TEST(PositionFile, IsReadByTheNextOne) {
  const test::TempDir folder;
  reflector::OdometryMemory memory{
      .odom = 7, .raw = {100, 200, 0.5}, .server_in_odom = {1.0, -2.0, 0.25}};
  {
    PositionFile file(folder.path("state"));
    EXPECT_FALSE(file.found());
    memory.odom = 6;
    EXPECT_EQ(file.write(memory), "");
    memory.odom = 7;
    EXPECT_EQ(file.write(memory), "");
  }
  EXPECT_EQ(read_file(folder.path("state")).size(), 510U) << "one line of one size";
  const auto back = PositionFile(folder.path("state")).found();
  ASSERT_TRUE(back);
  EXPECT_EQ(back->odom, 7U);
  EXPECT_EQ(back->raw.y, 200);
  EXPECT_EQ(back->server_in_odom, memory.server_in_odom);
}

TEST(PositionFile, WhatIsDamagedIsSetAsideAndNotTakenForAnother) {
  const test::TempDir folder;
  const std::string path = folder.path("state");
  reflector::OdometryMemory memory{.odom = 7, .raw = {100, 200, 0.5}};
  EXPECT_EQ(PositionFile(path).write(memory), "");
  const std::string whole = read_file(path);
  const std::size_t end = whole.find("  ");  // the padding does not count
  for (std::size_t i = 0; i < end; ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      std::ofstream(path) << damaged;
      const PositionFile file(path);
      EXPECT_FALSE(file.found()) << i << " " << bit;
      EXPECT_NE(file.trouble().find("state.damaged"), std::string::npos) << file.trouble();
      EXPECT_EQ(read_bytes(path + ".damaged"), damaged);
    }
    std::ofstream(path) << whole.substr(0, i);
    EXPECT_FALSE(PositionFile(path).found()) << i;
  }
  std::ofstream(path) << whole;
  EXPECT_TRUE(PositionFile(path).found());
}

TEST(PositionFile, AnotherFileIsRefusedAndStays) {
  const test::TempDir folder;
  const std::string path = folder.path("notes.txt");
  std::ofstream(path) << "my notes\n";
  for (const Files files : {Files::kChange, Files::kStay})
    EXPECT_THROW(PositionFile(path, files), std::invalid_argument);
  EXPECT_EQ(read_file(path), "my notes\n");
  // A dry run makes no file either.
  EXPECT_FALSE(PositionFile(folder.path("state"), Files::kStay).found());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(PositionFile, WithoutAPathNothingIsKept) {
  PositionFile file("");
  EXPECT_FALSE(file.found());
  EXPECT_EQ(file.write({}), "");
}

TEST(PositionFile, NamesTheOptionWhereItCannotBeOpened) {
  const test::TempDir folder;
  const std::string path = folder.path("nowhere/state");
  EXPECT_EQ(test::trouble_of<std::invalid_argument>([&] { const PositionFile file(path); }),
            "--state " + path + ": No such file or directory");
}

TEST(PositionFile, SaysOnceWhyNothingCanBeKept) {
  PositionFile file("/dev/full");
  EXPECT_EQ(file.write({}), "/dev/full: No space left on device");
  EXPECT_EQ(file.write({}), "");
}

TEST(PositionFile, BeginsWhenAFullDiskHasRoom) {
  const test::TempDir folder;
  const test::SmallDisk disk(folder.path());
  if (!disk.works())
    GTEST_SKIP() << "no disk can be made here";
  disk.fill();
  PositionFile file(disk.path("state"));
  EXPECT_NE(file.write({}), "");
  EXPECT_EQ(file.write({}), "") << "said already";
  disk.make_room();
  EXPECT_EQ(file.write({}), "");
  EXPECT_TRUE(PositionFile(disk.path("state")).found());
}

}  // namespace
}  // namespace saphira::bridge
