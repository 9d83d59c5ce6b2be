// Programs in C with errors, or with an end while the robot drives.

#include "programs.hpp"

namespace saphira {
namespace {

using test::Process;
class Mistakes : public test::Programs {};

constexpr const char* kDrives = R"(
static void connected(void) { sfInitBasicProcs(); sfSetVelocity(300); TASK }
int main(void) { sfOnConnectFn(connected); sfStartup(0); return 0; }
)";

std::string driving(const std::string& before, const std::string& task) {
  std::string text = kDrives;
  text.replace(text.find("TASK"), 4, task);
  return before + text;
}

TEST_F(Mistakes, AMicroTaskThatHangsStopsTheRobot) {
  simulate();
  Process program = start(written(
      driving("static void hang(void) { static volatile int n; if (++n > 20) for (;;) ++n; }",
              "sfInitProcess(hang, \"hangs\");")));
  ASSERT_TRUE(test::wait_until([this] { return moves(); })) << program.output();
  ASSERT_TRUE(test::wait_until([this] { return stands(); })) << program.output();
  EXPECT_TRUE(test::wait_until([&] {
    return program.output().find("micro-task \"hangs\"") != std::string::npos;
  })) << program.output();
  // One signal ends it, as `timeout` and service managers send it.
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), std::optional<int>(128 + SIGTERM)) << program.output();
  EXPECT_TRUE(stands());
}

TEST_F(Mistakes, ExitInACallbackStopsTheRobot) {
  simulate();
  Process program =
      start(written(driving("static void leave(void) { static int n; if (++n > 20) exit(7); }",
                            "sfInitProcess(leave, \"leaves\");")));
  EXPECT_EQ(program.wait(), std::optional<int>(7)) << program.output();
  EXPECT_TRUE(test::wait_until([this] { return stands(); }));
}

TEST_F(Mistakes, KilledWhileDrivingTheRobotStands) {
  simulate();
  Process program = start(written(driving("", "")));
  ASSERT_TRUE(test::wait_until([this] { return moves(); })) << program.output();
  program.signal(SIGKILL);
  program.wait();
  const std::size_t killed = truth().size();
  ASSERT_TRUE(test::wait_until([this] { return stands(); }));
  const auto rows = truth();
  std::size_t stood = killed;
  while (stood < rows.size() && rows[stood].velocity != 0.0)
    ++stood;
  // Within half a second of the robot's own cycles.
  EXPECT_LE(stood, killed + 5);
}

TEST_F(Mistakes, WrongCallsAreNamedAndDoNothing) {
  simulate();
  Process program = start(written(driving("", R"(
    sfInitProcess(NULL, "x"); sfSetProcessState(NULL, sfSUSPEND); sfKillBehavior(NULL);
    sfInitBehavior(NULL, 0, 0, sfEND);
    sfInitBehavior(sfKeepOff, 0, sfON, sfFLOAT, 100.0, sfEND);
    sfInitBehavior(sfKeepOff, 0, sfON, sfFLOAT, 100.0, sfFLOAT, 0.5, 12345);
    sfInitBehavior(sfGoToPos, 0, sfON, sfFLOAT, 100.0, sfFLOAT, 1.0, sfFLOAT, 1.0, sfEND);
    sfPointDist(NULL); sfAddPoint(NULL); sfLoadMapFile("no such map"); sfMessage(NULL);
    sfRobotComInt(sfCOMVEL, 100); sfOccBox(99, 0, 0, 0, 0); intend_beh(NULL, "x", 0, NULL, 0);
    sfFindProcess(NULL); sfFindBehavior(NULL); sfSonarRange(-1); sfSonarRange(1000);
    sfMessage("done"); exit(0);)")));
  EXPECT_EQ(program.wait(), std::optional<int>(0));
  const std::string said = program.output();
  for (const char* const part :
       {"sfInitProcess: the function is NULL", "sfSetProcessState: the process is NULL",
        "sfKillBehavior: the behavior is NULL", "sfInitBehavior: the behavior is NULL",
        "expected 2 parameters, not 1", "is sfEND missing?", "parameter 2: expected sfPTR",
        "sfPointDist: a point is NULL", "sfLoadMapFile: no \"no such map\"",
        "would drive the robot beside the state reflector", "intend_beh: the behavior is NULL",
        "done"})
    EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
}

}  // namespace
}  // namespace saphira
