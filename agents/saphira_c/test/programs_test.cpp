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
  // In real time: four times as fast, a late cycle of the program costs 8 cm before a door post,
  // where the guard stops the robot and the program does not turn away.
  simulate("5000 9000 0", "office-floor", "", "1");
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

// In the manner of course work for Saphira 6: no sfInitBasicProcs, degrees, float results.
TEST_F(Programs, AProgramOfSaphira6GoesFromCornerToCorner) {
  simulate("19000 19000 0", "simple", "", "1");  // a loaded machine stops it late
  const std::string path = dir_.path("six.c");
  std::ofstream(path) << R"(
#include "saphira.h"
typedef struct { double x, y; } Corner;
static const Corner corners[] = {{1000, 0}, {1000, -500}};
static int current;
sfprocess* follower;

static int heading_to(Corner to) {
  return (int)sfRadToDeg(atan2(to.y - sfRobot.ay, to.x - sfRobot.ax));
}
static void follow(void) {
  float x, y;
  switch (process_state) {
    case sfINIT:
    case 20:
      sfSetHeading(heading_to(corners[current]));
      process_state = 24;
      break;
    case 24:
      if (!sfDoneHeading(3)) break;
      sfSetPosition((int)hypot(corners[current].y - sfRobot.ay, corners[current].x - sfRobot.ax));
      process_state = 28;
      break;
    case 28:
      if (!sfDonePosition(30)) break;
      process_state = ++current == 2 ? 32 : 20;
      break;
    case 32:
      sfOccPlaneRet(sfFRONT, sfFRONT, 400, 200, -200, &x, &y);
      sfSMessage("at %.0f %.0f, heading %.0f, found %d", sfRobot.ax, sfRobot.ay, sfRobot.ath,
                 sfFindProcess("follow") == follower);
      exit(0);
  }
}
static void begins(void) { sfInitProcess(sfRunEvaluator, "evaluator"); }
static void connects(void) {
  sfSetMaxVelocity(9000);
  follower = sfInitProcess(follow, "follow");
}
#ifdef IS_UNIX
void main(void)
#endif
{
  sfOnConnectFn(connects);
  sfOnStartupFn(begins);
  sfStartup(0);
}
)";
  Process program =
      start(test::compiled(path, dir_, false, "-I" + test::prefix() + "/include/saphira6"));
  EXPECT_EQ(program.wait(std::chrono::minutes(2)), std::optional<int>(0)) << program.output();
  double x = 0.0, y = 0.0, heading = 0.0;
  int found = 0;
  const std::string said = program.output();
  const std::size_t at = said.find("\nat ");
  ASSERT_NE(at, std::string::npos) << said;
  ASSERT_EQ(std::sscanf(said.c_str() + at, "\nat %lf %lf, heading %lf, found %d", &x, &y, &heading,
                        &found),
            4)
      << said;
  EXPECT_NEAR(x, 1000.0, 100.0);
  EXPECT_NEAR(y, -500.0, 100.0);
  EXPECT_NEAR(heading, -90.0, 8.0);
  EXPECT_EQ(found, 1);
  // The limit of the simulated Pioneer, and the guard's distance, are told.
  EXPECT_NE(said.find("sfSetMaxVelocity: the robot's limit is 400 mm/s, not 9000"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("the guard stops the robot 0.25 m before"), std::string::npos) << said;
}

// Without a map registration builds one: the robot stays where the program has put it.
TEST_F(Programs, TheRobotStaysWhereItWasMovedTo) {
  simulate();
  Process program = start(written(R"(
static int n;
static void look(void) {
  if (++n == 20) sfMoveRobot(2000.0F, 500.0F, 0.0F);
  if (n < 40) return;
  sfSMessage("at %.0f %.0f, radius %.0f", sfRobot.ax, sfRobot.ay, flakey_radius);
  exit(0);
}
static void connected(void) {
  sfInitProcess(motor_proc, "mine");
  sfInitBasicProcs();
  sfInitInterpretationProcs();
  sfInitRegistrationProcs();
  sfInitProcess(look, "look");
  if (sfFindProcess("mine") == NULL || sfFindProcess("motor_proc") != NULL) exit(1);
}
int main(void) { sfOnConnectFn(connected); sfStartup(0); return 0; }
)"));
  EXPECT_EQ(program.wait(), std::optional<int>(0)) << program.output();
  EXPECT_NE(program.output().find("at 2000 500, radius 220"), std::string::npos)
      << program.output();
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
