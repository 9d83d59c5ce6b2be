// The same programs in C as one of the programs on the bus, beside all services (SAPHIRA_ROBOT).

#include <algorithm>
#include <fstream>
#include <map>

#include "printed.hpp"
#include "programs.hpp"
#include "saphira/bus/request_client.hpp"
#include "system.hpp"

namespace saphira {
namespace {

using test::has;
using test::Process;
using test::wait_until;

constexpr std::chrono::seconds kPatience{60};

class OnBus : public testing::Test {
 protected:
  OnBus()
      : grants_(system_.node().reader(bus::topics::kGrant)),
        tasks_(system_.node().reader(bus::topics::kProcesses)),
        messages_(system_.node().reader(bus::topics::kMessages)) {
    system_.start_all();
  }
  Process start(const std::string& program) {
    return Process({program}, system_.folder().path("out"), {{"SAPHIRA_ROBOT", system_.robot()}});
  }
  Process example(const std::string& name) {
    return start(test::compiled(test::source("agents/saphira_c/examples/" + name + ".c"),
                                system_.folder(), false));
  }
  Process written(const std::string& text) {
    const std::string path = system_.folder().path("written.c");
    std::ofstream(path) << "#include \"saphira.h\"\n" << text;
    return start(test::compiled(path, system_.folder(), false));
  }
  bool drives(const std::string& source) {
    return wait_until(
        [&] {
          const auto grant = grants_.take_newest();
          return grant && grant->role == v1::ROLE_DIRECT && grant->source == source;
        },
        kPatience);
  }
  /// Waits for the state of a program's micro-task, as shown to others.
  bool shows(const std::string& service, const std::string& name, v1::ProcessState state) {
    return wait_until(
        [&] {
          for (const auto& sample : tasks_.take())
            shown_[sample.data.service] = sample.data.processes;
          const std::vector<v1::Process>& processes = shown_[service];
          return std::ranges::any_of(processes, [&](const v1::Process& one) {
            return one.name == name && one.state == state;
          });
        },
        kPatience);
  }
  /// The output of a command of `saphira`.
  std::string cli(const std::vector<std::string>& words) {
    return test::saphira(words, {{"SAPHIRA_ROBOT", system_.robot()}}).text;
  }
  v1::AnswerCode ask(const std::string& functor, const std::string& service,
                     const std::string& process) {
    bus::RequestClient client(system_.node(), bus::topics::kProcessRequest, "test");
    return client.ask(bus::request(functor, {bus::text("process", process)}, service), 20.0).code;
  }

  test::System system_;
  bus::Reader<v1::Grant> grants_;
  bus::Reader<v1::ProcessSet> tasks_;
  bus::Reader<v1::Message> messages_;
  /// By program, its newest published processes: they are published on change.
  std::map<std::string, std::vector<v1::Process>> shown_;
};

TEST_F(OnBus, AProgramDrivesAsDirectAndItsMicroTasksAreEverybodys) {
  Process program = example("direct");
  ASSERT_TRUE(drives("program")) << program.output();
  ASSERT_TRUE(system_.wait_moving()) << program.output();
  EXPECT_TRUE(shows("program", "patrol", v1::PROCESS_RUNNING));
  EXPECT_TRUE(wait_until([&] {
    const auto message = messages_.take_newest();
    return message && message->text == "patrols";
  })) << "sfMessage is seen by others";

  EXPECT_EQ(ask("suspend", "program", "patrol"), v1::ANSWER_DONE);
  EXPECT_TRUE(shows("program", "patrol", v1::PROCESS_SUSPENDED));
  EXPECT_EQ(ask("resume", "program", "patrol"), v1::ANSWER_DONE);
  // The library's tasks as well: without motor_proc nothing drives.
  EXPECT_EQ(ask("suspend", "program", "motor_proc"), v1::ANSWER_DONE);
  EXPECT_TRUE(shows("program", "motor_proc", v1::PROCESS_SUSPENDED));
  EXPECT_TRUE(system_.wait_still(kPatience));
  EXPECT_EQ(ask("resume", "program", "motor_proc"), v1::ANSWER_DONE);
  EXPECT_TRUE(system_.wait_moving(kPatience));

  // It is killed while it drives: the lease ends within 0.3 s, and the services have the robot
  // again.
  program.signal(SIGKILL);
  const long cycle = system_.truth().cycle;
  ASSERT_TRUE(system_.wait_still());
  EXPECT_LE(*system_.stood_still(cycle) - cycle, 8) << "0.3 s of lease, and the way to stop";
  const auto end = system_.wait_end(system_.go_to(1.0, 0.0));
  ASSERT_TRUE(end);
  EXPECT_EQ(end->state, v1::GOAL_SUCCEEDED) << end->reason;
  EXPECT_EQ(system_.truth().contacts, 0);
}

TEST_F(OnBus, AStoppedProgramDoesNotDriveOn) {
  Process program = example("direct");
  ASSERT_TRUE(drives("program")) << program.output();
  ASSERT_TRUE(system_.wait_moving()) << program.output();
  bus::RequestClient client(system_.node(), bus::topics::kDriveStop, "test");
  const v1::Answer answer = client.ask(bus::request("stop"), 10.0);
  EXPECT_EQ(answer.code, v1::ANSWER_DONE) << answer.text;
  EXPECT_EQ(answer.text, "stopped: program (direct); the robot is at rest");
  const std::uint64_t begin = system_.truth().cycle;
  bool still = true;
  EXPECT_TRUE(wait_until([&] {
    still = still && system_.still();
    return system_.truth().cycle >= begin + 40;
  }));
  EXPECT_TRUE(still) << "it commands on, and has not let go";
  EXPECT_NE(program.output().find("stopped by test"), std::string::npos) << program.output();
}

TEST_F(OnBus, AProgramBegunUnderAnEmergencyStopDrivesWhenTheRobotIsHandedBack) {
  cli({"estop"});
  Process program = example("direct");
  EXPECT_TRUE(wait_until(
      [&] {
        const auto grant = grants_.take_newest();
        return grant && grant->estopped && !grant->refused.empty();
      },
      kPatience))
      << program.output();
  cli({"estop", "reset"});
  EXPECT_TRUE(wait_until(
      [&] {
        const auto grant = grants_.take_newest();
        return grant && grant->waits_for_hand_back;
      },
      kPatience))
      << program.output();
  EXPECT_TRUE(system_.still());
  cli({"drive", "hand-back"});
  EXPECT_TRUE(drives("program")) << program.output();
}

TEST_F(OnBus, WhatSomebodyPointsOutIsAClick) {
  Process program = written(R"(
static int clicked(int x, int y, int b) {
  sfSMessage("button %d at %.0f %.0f", b, sfScreenToWorldX(x, y), sfScreenToWorldY(x, y));
  exit(0);
}
int main(void) { sfButtonProcFn(clicked); sfStartup(0); return 0; }
)");
  bus::Writer<v1::AgentEvent> events = system_.node().writer(bus::topics::kAgentEvents);
  v1::AgentEvent event{.functor = "pointed_out",
                       .arguments = {bus::point("position", 1.5, -0.5, 0.0, v1::FRAME_ODOM)}};
  EXPECT_TRUE(wait_until(
      [&] {
        events.write(event);
        system_.node().wait(std::chrono::milliseconds(100));
        return !program.running();
      },
      kPatience))
      << program.output();
  EXPECT_TRUE(has(program.output(), "button 1 at 1500 -500")) << program.output();
}

TEST_F(OnBus, TheMapAndWhereTheRobotIsAreThoseOfTheServices) {
  Process program = written(R"(
#include <stdlib.h>
static int n;
static void look(void) {
  point* door = sfFindArtifact(111);
  if (++n > 150 || (door != NULL && sfRobot.ax > 1000)) {
    sfSMessage("door %d at %.0f, robot at %.0f %.0f, wall %d", door != NULL, door ? door->ax : 0,
               sfRobot.ax, sfRobot.ay, sfLeftWallHyp.viewable);
    exit(0);
  }
}
static void connected(void) {
  sfInitBasicProcs();
  sfInitInterpretationProcs();
  sfInitRegistrationProcs();
  sfInitProcess(look, "look");
}
int main(void) { sfOnConnectFn(connected); sfStartup(0); return 0; }
)");
  EXPECT_EQ(program.wait(kPatience), std::optional<int>(0)) << program.output();
  const std::string said = program.output();
  EXPECT_NE(said.find("door 1 at 2450, robot at 1500 7000"), std::string::npos) << said;
}

// Manual 4.3.4, as printed: its suspended tasks are resumed from outside.
TEST_F(OnBus, ThePrintedSaphiraClientIsSwitchedOnByOthers) {
  if (test::manual().empty())
    GTEST_SKIP() << "the manual is not there (SAPHIRA_MANUAL, ../shared/seeds)";
  const std::string path = system_.folder().path("printed.c");
  std::ofstream(path) << test::printed_saphira();
  Process program = start(test::compiled(path, system_.folder(), false));
  ASSERT_TRUE(shows("program", "User Process", v1::PROCESS_SUSPENDED)) << program.output();
  ASSERT_TRUE(shows("program", "behavior sfConstantVelocity", v1::PROCESS_SUSPENDED));
  EXPECT_EQ(ask("resume", "program", "behavior sfAvoidCollision"), v1::ANSWER_DONE);
  EXPECT_EQ(ask("resume", "program", "behavior sfConstantVelocity"), v1::ANSWER_DONE);
  EXPECT_TRUE(system_.wait_moving(kPatience)) << program.output();
  EXPECT_TRUE(drives("program"));
  EXPECT_TRUE(wait_until([this] {
    return has(cli({"behaviors", "--once"}), "of the program program:\n");
  }));
  EXPECT_TRUE(wait_until([this] {
    return has(cli({"why"}),
               "sfConstantVelocity (ConstantVelocity) wants 0.30 m/s (rule go); "
               "behaviors of the program program");
  })) << cli({"why"});
  EXPECT_EQ(ask("suspend", "program", "behavior sfConstantVelocity"), v1::ANSWER_DONE);
  EXPECT_TRUE(system_.wait_still(kPatience)) << program.output();
  EXPECT_EQ(system_.truth().contacts, 0);
}

// Manual 8.1, as printed: its corridor comes from the registration service.
TEST_F(OnBus, ThePrintedIntentionFollowsTheCorridor) {
  if (test::manual().empty())
    GTEST_SKIP() << "the manual is not there (SAPHIRA_MANUAL, ../shared/seeds)";
  Process program = written(R"(
point follow_target;
#define CHECK_CORRIDOR 20
#define FOLLOW_CORRIDOR 10
#define WAIT_REMOVE 11
static void find_and_follow(void) {
  static process* p;
  static point* e;
  beh_params par;
)" + test::printed("8.1.2. Find a corridor", "8.2.", {{"convenience function */", ""}}) +
                            R"(
}
static void connected(void) {
  sfInitBasicProcs();
  sfInitControlProcs();
  sfInitRegistrationProcs();
  sfInitIntention(find_and_follow, "find and follow", 0, sfEND);
}
int main(void) { sfOnConnectFn(connected); sfStartup(0); return 0; }
)");
  EXPECT_TRUE(drives("program")) << program.output();
  EXPECT_TRUE(wait_until([&] { return system_.truth().pose_in_world.x > 3.5; }, kPatience))
      << system_.truth().pose_in_world.x << program.output();
  EXPECT_TRUE(shows("program", "find and follow", v1::PROCESS_RUNNING));
  EXPECT_TRUE(wait_until([this] {
    return has(cli({"intentions", "--once"}), "of the program program:\no find and follow");
  })) << cli({"intentions", "--once"});
  EXPECT_EQ(system_.truth().contacts, 0);
}

TEST_F(OnBus, APortOfTheBusIsAsGoodAsTheEnvironment) {
  const std::string path = system_.folder().path("written.c");
  std::ofstream(path) << "#include \"saphira.h\"\n"
                         "int main(void) {\n"
                         "  sfStartup(1);\n"
                         "  if (!sfConnectToRobot(sfBUSPORT, \""
                      << system_.robot()
                      << "\"))\n"
                         "    return 1;\n"
                         "  sfInitBasicProcs();\n"
                         "  sfSetVelocity(200);\n"
                         "  sfPause(20000);\n"
                         "  return 0;\n"
                         "}\n";
  Process program({test::compiled(path, system_.folder(), false)}, system_.folder().path("out"));
  EXPECT_TRUE(drives("program")) << program.output();
  EXPECT_TRUE(system_.wait_moving(kPatience)) << program.output();
}

TEST(OnBusAlone, AWildcardIsNoRobot) {
  const test::TempDir dir;
  Process program({test::compiled(test::source("agents/saphira_c/examples/async.c"), dir, false)},
                  dir.path("out"), {{"SAPHIRA_ROBOT", "*"}});
  EXPECT_TRUE(wait_until(
      [&] { return has(program.output(), "SAPHIRA_ROBOT: expected the name of one robot"); },
      kPatience))
      << program.output();
}

TEST(OnBusAlone, WithoutABridgeItSaysSo) {
  const test::TempDir dir;
  Process program({test::compiled(test::source("agents/saphira_c/examples/async.c"), dir, false)},
                  dir.path("out"), {{"SAPHIRA_ROBOT", test::unique_robot()}});
  EXPECT_TRUE(wait_until(
      [&] { return program.output().find("no bridge of robot") != std::string::npos; }, kPatience))
      << program.output();
}

}  // namespace
}  // namespace saphira
