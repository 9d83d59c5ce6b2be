#include "latch_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "process.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"
#include "small_disk.hpp"

namespace saphira::bridge {
namespace {

using authority::Latches;
using authority::Wait;

TEST(LatchFile, IsReadByTheNextOneAndGoneWithTheLatch) {
  const test::TempDir folder;
  const std::string path = folder.path("latched");
  EXPECT_EQ(LatchFile(path).read(), Latches{});
  const Latches latches{.estopped = true, .estop_source = "a button", .wait = Wait::driven};
  EXPECT_EQ(LatchFile(path).write(latches), "");
  EXPECT_EQ(LatchFile(path).read(), latches);
  EXPECT_EQ(LatchFile(path).write({}), "");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(LatchFile(path).write({}), "") << "twice is no trouble";
}

TEST(LatchFile, KeepsTheNewestStopAndWhomItHasStopped) {
  const test::TempDir folder;
  const std::string path = folder.path("latched");
  Latches latches{.stop = {7, 8}, .stop_source = "kate"};
  for (std::uint8_t i = 0; i < 24; ++i)
    latches.stopped.push_back(
        {authority::Role::direct, {i, 255, 255, 255, 255, 255, 255, 255, 255}});
  EXPECT_EQ(LatchFile(path).write(latches), "");
  EXPECT_EQ(LatchFile(path).read(), latches);
  EXPECT_LT(std::filesystem::file_size(path), 4096U) << "the room that is kept for it";
}

struct Former {
  bool estopped;
  std::string estop_source;
  Wait wait;
};

TEST(LatchFile, AFileOfAnEarlierVersionIsRead) {
  const test::TempDir folder;
  const std::string path = folder.path("latched");
  Former former{false, "", Wait::driven};
  std::ofstream(path) << sealed(saved(former));
  EXPECT_EQ(LatchFile(path).read(), Latches{.wait = Wait::driven});
}

TEST(LatchFile, OneThatCannotBeReadIsAnEmergencyStop) {
  const test::TempDir folder;
  const std::string path = folder.path("latched");
  std::ofstream(path).close();
  EXPECT_TRUE(LatchFile(path).read().estopped);
  std::ofstream(path) << "noise";
  EXPECT_TRUE(LatchFile(path).read().estopped);
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_TRUE(LatchFile(path).read().estopped);
}

TEST(LatchFile, NoDamageReleasesWhatIsLatched) {
  const test::TempDir folder;
  const std::string path = folder.path("latched");
  for (const Latches& latches :
       {Latches{.estopped = true, .estop_source = "a button", .wait = Wait::none},
        Latches{.estopped = true, .estop_source = "a button", .wait = Wait::driven},
        Latches{.estopped = false, .estop_source = "", .wait = Wait::driven},
        Latches{.estopped = false, .estop_source = "", .wait = Wait::reset}}) {
    ASSERT_EQ(LatchFile(path).write(latches), "");
    std::string whole;
    std::getline(std::ifstream(path), whole, '\0');
    const auto expect_latched = [&](const std::string& damaged) {
      std::ofstream(path) << damaged;
      const Latches read = LatchFile(path).read();
      EXPECT_TRUE(read.estopped || read == latches) << damaged;
    };
    for (std::size_t i = 0; i < whole.size(); ++i) {
      expect_latched(whole.substr(0, i));
      for (int bit = 0; bit < 8; ++bit) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
        expect_latched(damaged);
      }
    }
  }
}

TEST(LatchFile, SaysWhereItCannotBeWritten) {
  EXPECT_EQ(LatchFile("").write({.estopped = true, .estop_source = "a button"}), "");
  const std::string trouble =
      LatchFile("/nowhere/at/all").write({.estopped = true, .estop_source = "a button"});
  EXPECT_NE(trouble.find("/nowhere/at/all: No such file"), std::string::npos) << trouble;
}

TEST(LatchFile, AFullDiskKeepsAnEmergencyStop) {
  const test::TempDir folder;
  const test::SmallDisk disk(folder.path());
  if (!disk.works())
    GTEST_SKIP() << "no disk can be made here";
  const Latches latches{.estopped = true, .estop_source = "a button", .wait = Wait::driven};
  LatchFile file(disk.path("latched"));
  file.tend();
  disk.fill();
  EXPECT_EQ(file.write(latches), "") << "its room was kept";
  EXPECT_EQ(LatchFile(disk.path("latched")).read(), latches);
  const Latches other{.estopped = true, .estop_source = "another button", .wait = Wait::none};
  EXPECT_EQ(file.write(other), "") << "in its place";
  EXPECT_EQ(LatchFile(disk.path("latched")).read(), other);
  EXPECT_EQ(file.write({}), "");
  EXPECT_EQ(LatchFile(disk.path("latched")).read(), Latches{});
  disk.fill();
  EXPECT_NE(file.write(latches), "") << "there is no room";
  disk.make_room();
  file.tend();
  EXPECT_EQ(LatchFile(disk.path("latched")).read(), latches);
}

}  // namespace
}  // namespace saphira::bridge
