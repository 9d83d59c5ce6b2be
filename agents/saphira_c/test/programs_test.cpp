// Programs in C, built with the system's compiler as C and as C++ against the installed library,
// and the simulator's true state while they drive.

#include "programs.hpp"

#include <filesystem>

namespace saphira {
namespace {

using test::Process;
using test::Programs;

TEST_F(Programs, DirectDrivesTwoMetresToAndFro) {
  simulate();
  Process program = start(example("direct"));
  ASSERT_TRUE(test::wait_until([&] { return farthest() > 1.85; }, std::chrono::seconds(60)))
      << farthest() << program.output();
  ASSERT_TRUE(test::wait_until(
      [&] {
        const auto rows = truth();
        return rows.back().pose_in_world.x < rows[0].pose_in_world.x + 0.2;
      },
      std::chrono::seconds(60)));
  EXPECT_LT(farthest(), 2.15);
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), std::optional<int>(128 + SIGTERM));
  EXPECT_TRUE(test::wait_until([this] { return stands(); }));
}

TEST_F(Programs, AsyncTurnsAndDrives) {
  simulate("17500 14000 0", "simple", "", "1");  // it pauses by its own clock
  Process program = start(example("async"));
  ASSERT_EQ(program.wait(), std::optional<int>(0)) << program.output();
  const sim::TraceRow end = truth().back();
  EXPECT_NEAR(end.pose_in_world.th, radians(135.0), radians(8.0));
  EXPECT_NEAR(farthest(), 0.4, 0.15);
  EXPECT_EQ(end.velocity, 0.0);
}

TEST_F(Programs, PacketIsServedWithoutTheOs) {
  simulate();
  Process program = start(example("packet"));
  ASSERT_EQ(program.wait(), std::optional<int>(0)) << program.output();
  EXPECT_NE(program.output().find("30 packets"), std::string::npos);
  EXPECT_NEAR(farthest(), 0.6, 0.15);
  EXPECT_TRUE(test::wait_until([this] { return stands(); }));
}

TEST_F(Programs, FiveMicroTasksInterruptEachOther) {
  simulate();
  Process program = start(example("five_tasks"));
  ASSERT_EQ(program.wait(), std::optional<int>(0)) << program.output();
  const std::string said = program.output();
  for (const char* const name : {"one", "two", "three", "four", "five"})
    EXPECT_NE(said.find(std::string(name) + " puts its work away after 3 cycles"),
              std::string::npos)
        << said;
  EXPECT_EQ(said.find("one puts its work away after 9"), std::string::npos);
}

TEST_F(Programs, AWallIsFollowedByABehaviorInC) {
  simulate("5000 9000 0", "office-floor");
  Process program = start(example("wall_follower"));
  EXPECT_TRUE(test::wait_until([&] { return farthest() > 2.0; }, std::chrono::seconds(60)))
      << program.output();
  for (const sim::TraceRow& row : truth())
    EXPECT_EQ(row.contacts, 0);
}

TEST_F(Programs, ArtifactsAreNamed) {
  simulate();
  Process program = start(example("name_artifacts"));
  EXPECT_TRUE(test::wait_until(
      [&] { return program.output().find("passed the goal") != std::string::npos; },
      std::chrono::seconds(60)))
      << program.output();
}

TEST_F(Programs, ABlobIsSearchedForAndApproached) {
  simulate("17500 14000 90", "office-floor", "post can 17800 10500 80 color red tall 400");
  Process program = start(example("find_blob"));
  EXPECT_TRUE(test::wait_until(
      [&] { return program.output().find("the search has ended") != std::string::npos; },
      std::chrono::seconds(90)))
      << program.output();
  EXPECT_NE(program.output().find("at the blob"), std::string::npos) << program.output();
  const Vec2 end = truth().back().pose_in_world.position();
  EXPECT_LT((end - Vec2(17.8, 10.5)).norm(), 1.2);
  EXPECT_EQ(truth().back().contacts, 0);
}

// As in other projects: by CMake's find_package, by pkg-config's folder and the manual's -lsf.
TEST(Installed, IsFoundByCMakeAndUnderBothNamesOfTheManual) {
  const test::TempDir dir;
  const std::string installed = dir.path("installed");
  ASSERT_EQ(test::install_build(installed, "dev"), "");
  const std::string example = test::source("agents/saphira_c/examples/direct.c");
  std::ofstream(dir.path("CMakeLists.txt")) << "cmake_minimum_required(VERSION 3.25)\n"
                                               "project(direct C CXX)\n"
                                               "find_package(saphira REQUIRED COMPONENTS c)\n"
                                               "add_executable(direct " +
                                                   example +
                                                   ")\n"
                                                   "target_link_libraries(direct saphira::sfx)\n";
  Process make({"/bin/sh", "-c",
                "cd '" + dir.path("") + "' && cmake -G Ninja -DCMAKE_PREFIX_PATH='" + installed +
                    "' -B made . && cmake --build made && ls made/direct && cc" +
                    test::sanitized() + " '" + example + "' -o old -I'" + installed +
                    "/include' -L$(dirname $(find '" + installed + "/lib' -name libsf.so)) -lsf"},
               dir.path("make"));
  EXPECT_EQ(make.wait(std::chrono::minutes(2)), std::optional<int>(0)) << make.output();
}

// As in the manual's makefiles (4.2.2): by the folders handler/include and handler/obj.
TEST(Installed, IsFoundByMakefilesInTheManualsShape) {
  const test::TempDir dir;
  std::filesystem::copy_file(test::source("agents/saphira_c/examples/packet.c"),
                             dir.path("packet.c"));
  std::ofstream(dir.path("Makefile"))
      << "SRCD = ./\nOBJD = ./\nBIND = ./\n"
         "INCD = $(SAPHIRA)/handler/include/\nLIBD = $(SAPHIRA)/handler/obj/\n"
         "include $(SAPHIRA)/handler/include/os.h\n"
         "CFLAGS = -g -D$(CONFIG)" +
             test::sanitized() +
             "\nCC = gcc\nINCLUDE = -I$(INCD) -I$(X11D)include\n"
             "all: $(BIND)packet\n\ttouch all\n"
             "$(OBJD)packet.o: $(SRCD)packet.c $(INCD)saphira.h\n"
             "\t$(CC) $(CFLAGS) -c $(SRCD)packet.c $(INCLUDE) -o $(OBJD)packet.o\n"
             "$(BIND)packet: $(LIBD)libsf.a $(OBJD)packet.o\n"
             "\t$(CC) $(CFLAGS) $(OBJD)packet.o -o $(BIND)packet -L$(MOTIFD)lib "
             "-L$(OBJD) -L$(LIBD) -lsf $(LLIBS) -lc -lm\n";
  Process make(
      {"/bin/sh", "-c",
       "cd '" + dir.path("") + "' && make && unset LD_LIBRARY_PATH && SAPHIRA_ROBOT=r ./packet"},
      dir.path("log"), {{"SAPHIRA", test::prefix() + "/share/saphira"}});
  make.wait();
  EXPECT_TRUE(std::filesystem::exists(dir.path("all"))) << make.output();
  EXPECT_NE(make.output().find("there are no packets on the bus"), std::string::npos)
      << make.output();
}

}  // namespace
}  // namespace saphira
