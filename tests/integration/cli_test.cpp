// The command line as a person uses it, with a scripted node in place of the services.

#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include "cli_fixture.hpp"
#include "node_options.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/node.hpp"
#include "small_disk.hpp"

namespace saphira {
namespace {

using std::chrono::milliseconds;
using test::has;
using test::Outcome;
namespace topics = bus::topics;

/// A bridge of a standing robot and an intentions service that answers each goal by its functor: in
/// a thread, for the object's life.
class Scripted {
 public:
  explicit Scripted(const std::string& robot) : options_(test::node_options("bridge", robot)) {
    thread_ = std::thread([this] { run(); });
    while (!up_)
      std::this_thread::yield();
  }
  ~Scripted() {
    stop_.request();
    thread_.join();
  }

  const bus::NodeOptions& options() const { return options_; }
  std::vector<v1::MotorCommand> teleop() {
    const std::scoped_lock lock(mutex_);
    return teleop_;
  }
  v1::MotorCommand newest() {
    const auto all = teleop();
    return all.empty() ? v1::MotorCommand() : all.back();
  }
  int withdrawn() const { return withdrawn_; }

 private:
  void run() {
    bus::Node node(options_);
    auto robots = node.writer(topics::kRobotState);
    auto grants = node.writer(topics::kGrant);
    auto statuses = node.writer(topics::kGoalStatus);
    auto goals = node.reader(topics::kGoals);
    auto commands = node.reader(topics::kDriveTeleop);
    up_ = true;
    v1::Stamp stamp{.epoch = 7};
    while (!stop_.requested()) {
      node.wait(milliseconds(20), &stop_);
      stamp.cycle = stamp.cycle + 1;
      robots.write({.stamp = stamp, .battery = 12.5});
      grants.write({.stamp = stamp, .reason = "nobody asked"});
      node.status().state = v1::SERVICE_RUNNING;
      node.status().stamp = stamp;
      node.publish_status();
      for (const auto& sample : goals.take())
        answer(sample, stamp, statuses);
      const std::scoped_lock lock(mutex_);
      for (const auto& sample : commands.take())
        if (!sample.info.disposed)
          teleop_.push_back(sample.data);
    }
  }

  void answer(const bus::Sample<v1::Goal>& goal, const v1::Stamp& stamp,
              bus::Writer<v1::GoalStatus>& statuses) {
    v1::GoalStatus status{.id = goal.data.id,
                          .stamp = stamp,
                          .functor = goal.data.functor,
                          .state = v1::GOAL_UNDERWAY,
                          .step = "on the way"};
    if (goal.info.disposed) {
      ++withdrawn_;
      status.state = v1::GOAL_CANCELED;
      status.reason = "withdrawn by the scripted service";
    } else if (goal.data.functor == "go_to") {
      statuses.write(status);
      status.state = v1::GOAL_SUCCEEDED;
      status.reason = "it is there";
    } else if (goal.data.functor == "fly") {
      status.state = v1::GOAL_REFUSED;
      status.reason = "no wings";
    } else if (goal.data.functor == "go-to-place") {
      const bool known = bus::text_of(goal.data.arguments, "place") == "N2";
      status.state = known ? v1::GOAL_SUCCEEDED : v1::GOAL_FAILED;
      status.reason = known ? "it is there" : "the map has no such place";
    }
    statuses.write(status);
  }

  bus::NodeOptions options_;
  bus::Stop stop_;
  std::atomic<bool> up_{false};
  std::atomic<int> withdrawn_{0};
  std::mutex mutex_;
  std::vector<v1::MotorCommand> teleop_;
  std::thread thread_;
};

class CliTest : public test::CliFixture {
 protected:
  /// `saphira drive` in that terminal of its own: its process, and below 0 where there is none.
  pid_t drive(int& terminal) const {
    winsize size{24, 100, 0, 0};
    const pid_t pid = forkpty(&terminal, nullptr, nullptr, &size);
    if (pid == 0) {
      const std::string program = test::program("saphira");
      execl(program.c_str(), program.c_str(), "--robot", robot_.c_str(), "--domain",
            test::domain().c_str(), "drive", static_cast<char*>(nullptr));
      _exit(127);
    }
    return pid;
  }
};

TEST_F(CliTest, CompletionKnowsTheGoalsAndRequestsThatProgramsDeclare) {
  bus::Node node(test::node_options("declarer", robot_));
  auto writer = node.writer(topics::kActivitySchemas);
  v1::ActivitySchemas schemas;
  schemas.schemas.resize(2);
  schemas.schemas[0].name = "go_to";
  schemas.schemas[1].name = "patrol";
  writer.write(schemas);
  bus::Agent agent(node, "calendar", "where people are");
  agent.can(bus::capability("place_of", "where a person is", {}),
            [](const v1::Request&) { return bus::done({}); });
  // On a machine at work an answer may come too late for a command line.
  std::string goals;
  EXPECT_TRUE(test::wait_until([&] {
    goals = run({"complete", "goal", "go"}).text;
    return goals == "go\ngo_to\n";
  })) << goals;
  std::string requests;
  EXPECT_TRUE(test::wait_until([&] {
    requests = run({"complete", "ask", ""}).text;
    return requests == "place_of\n";
  })) << requests;
}

TEST_F(CliTest, TriggersOfTwoShellsAreTwoAndTheListSaysWhoHoldsThem) {
  const std::vector<std::string> words{
      "write", "triggers", R"({"kind": "TRIGGER_TIME", "period": 5, "action": "note"})"};
  test::Process one(command(words), folder_.path("one"));
  test::Process two(command(words), folder_.path("two"));
  for (test::Process* const each : {&one, &two})
    ASSERT_TRUE(test::wait_until([&] { return has(each->output(), "holds it"); }))
        << each->output();
  const auto held_by = [](const test::Process& process) {
    return ", process " + std::to_string(process.pid());
  };
  std::string listed;
  EXPECT_TRUE(test::wait_until([&] {
    listed = run({"agents"}).text;
    return has(listed, held_by(one)) && has(listed, held_by(two));
  })) << listed;
  const std::size_t first = listed.find("every 5 s: note");
  EXPECT_NE(first, std::string::npos) << listed;
  EXPECT_NE(listed.find("every 5 s: note", first + 1), std::string::npos) << listed;
  EXPECT_TRUE(has(listed, " of saphira write")) << listed;
  one.signal(SIGINT);
  EXPECT_EQ(one.wait(), 0);
  EXPECT_TRUE(test::wait_until([&] {
    listed = run({"agents"}).text;
    return !has(listed, held_by(one)) && has(listed, held_by(two));
  })) << listed;
}

// A stop needs no keyword.
TEST_F(CliTest, TalkSaysEachLineWithTheKeywordAndPrintsWhatTheRobotSays) {
  bus::Node node(test::node_options("dialogue", robot_));
  auto heard = node.reader(topics::kHeard);
  auto said = node.writer(topics::kSaid);
  std::string line = "printf 'stop\\n\\nRobot, turn left\\nyes' |";
  std::vector<std::string> words = command({"talk", "--as", "Alice"});
  words.front() = test::program("saphira");
  for (const std::string& word : words)
    line += " '" + word + "'";
  test::Process talk({"/bin/sh", "-c", line}, folder_.path("talk"));
  std::vector<std::string> texts;
  EXPECT_TRUE(test::wait_until([&] {
    for (const auto& sample : heard.take()) {
      texts.push_back(sample.data.speaker + ": " + sample.data.text);
      said.write({.id = {node.instance(), texts.size()},
                  .answers = sample.data.id,
                  .text = "I heard " + sample.data.text,
                  .confidence = 1.0,
                  .end = true});
    }
    return texts.size() == 3;
  })) << talk.output();
  EXPECT_EQ(talk.wait(), 0) << talk.output();
  const std::vector<std::string> expected{"Alice: stop", "Alice: Robot, turn left",
                                          "Alice: flakey, yes"};
  EXPECT_EQ(texts, expected);
  for (const std::string& text : expected) {
    EXPECT_TRUE(has(talk.output(), text + "\n")) << talk.output();
    EXPECT_TRUE(has(talk.output(), robot_ + ": I heard " + text.substr(7) + "\n")) << talk.output();
  }
}

TEST_F(CliTest, TalkSaysThatNobodyListens) {
  expect({"talk", "--grammar", "nothing"}, 2);
  test::Process talk({"/bin/sh", "-c",
                      "echo stop | " + test::program("saphira") + " --robot " + robot_ +
                          " --domain " + test::domain() + " talk"},
                     folder_.path("talk"));
  EXPECT_EQ(talk.wait(), 1) << talk.output();
  EXPECT_TRUE(has(talk.output(), "nothing was answered: no program is on the bus"))
      << talk.output();
}

TEST_F(CliTest, AskForProgramsSaysThatNobodyAnswers) {
  const Outcome outcome = run({"ask", "place_of", "--json", "--deadline", "0.2"});
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_TRUE(has(outcome.text, R"({"agent":"","code":"nobody","text":"no program )"))
      << outcome.text;
}

TEST_F(CliTest, StatusShowsProcessesTheGrantAndWhatIsMissing) {
  const Scripted scripted(robot_);
  expect({"status"}, 0,
         {"bridge", "running", std::to_string(getpid()), "drive: nobody drives: nobody asked",
          "trouble: behaviors and intentions are not heard"});
}

TEST_F(CliTest, LogShowsWhatAProgramSays) {
  bus::Node node(test::node_options("speaker", robot_));
  node.warn("the kettle boils");
  expect({"log", "-n", "1"}, 0, {"warning  speaker  the kettle boils"});
}

TEST_F(CliTest, AGoalIsFollowedToItsEnd) {
  const Scripted scripted(robot_);
  expect({"goal", "go", "-3", "1"}, 0,
         {"go_to(position=(-3, 1) in odom)", "succeeded: it is there"});
  expect({"goal", "fly", "height=2"}, 1, {"refused: no wings"});
}

TEST_F(CliTest, CtrlCWithdrawsTheGoal) {
  const Scripted scripted(robot_);
  test::Process goal(command({"goal", "drive", "0.2"}), folder_.path("goal"));
  ASSERT_TRUE(test::wait_until([&] { return has(goal.output(), "underway"); })) << goal.output();
  goal.signal(SIGINT);
  EXPECT_EQ(goal.wait(), 1);
  EXPECT_TRUE(has(goal.output(), "canceled: withdrawn by the scripted service")) << goal.output();
  EXPECT_EQ(scripted.withdrawn(), 1);
}

TEST_F(CliTest, AGoalThatNobodyAnswersSaysWhoIsMissing) {
  test::Process goal(command({"goal", "stop"}), folder_.path("goal"));
  EXPECT_TRUE(test::wait_until([&] { return has(goal.output(), "no program is on the bus"); }))
      << goal.output();
  goal.signal(SIGINT);
  EXPECT_EQ(goal.wait(), 1);
}

/// A bridge that latches an emergency stop once it hears.
struct Button {
  explicit Button(const std::string& robot) : node(test::node_options("bridge", robot)) {}
  void turn() {
    node.wait(milliseconds(20));
    for (const auto& sample : presses.take())
      latched = latched || (hears && sample.data.active);
    grants.write({.estopped = latched});
  }
  bus::Node node;
  bus::Reader<v1::MotorCommand> presses = node.reader(topics::kDriveEstop);
  bus::Writer<v1::Grant> grants = node.writer(topics::kGrant);
  bool hears = true;
  bool latched = false;
};

TEST_F(CliTest, AnEmergencyStopIsConfirmedByEachBridgeOfItsRobotsName) {
  Button one(robot_);
  Button two(robot_);
  two.hears = false;
  test::Process estop(command({"estop"}), folder_.path("estop"));
  const auto says = [&](const std::string& part) {
    return test::wait_until([&] {
      one.turn();
      two.turn();
      return has(estop.output(), part);
    });
  };
  EXPECT_TRUE(says("NOT CONFIRMED by each bridge of 2 robots of this name")) << estop.output();
  EXPECT_TRUE(one.latched && estop.running());
  two.hears = true;
  EXPECT_TRUE(says("confirmed by the bridge of 2 robots of this name")) << estop.output();
  EXPECT_EQ(estop.wait(), 0);
}

TEST_F(CliTest, AnEmergencyStopOfEveryRobotIsConfirmedByEach) {
  Button one(robot_);
  Button two(robot_ + "-2");
  test::Process estop({"saphira", "--robot", "*", "--domain", test::domain(), "estop"},
                      folder_.path("estop"));
  EXPECT_TRUE(test::wait_until([&] {
    one.turn();
    two.turn();
    return !estop.running();
  }));
  EXPECT_TRUE(has(estop.output(), "every robot: EMERGENCY STOP")) << estop.output();
  EXPECT_TRUE(has(estop.output(), "confirmed by the bridge of 2 robots after")) << estop.output();
  EXPECT_TRUE(one.latched && two.latched);
  EXPECT_EQ(estop.wait(), 0);
}

TEST_F(CliTest, StatusShowsEachRobot) {
  const Scripted one(robot_);
  const Scripted two(robot_ + "-2");
  const Outcome outcome =
      test::run({"saphira", "status", "--domain", test::domain()}, {{"SAPHIRA_ROBOT", "*"}});
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const auto* scripted : {&one, &two}) {
    const std::size_t begins = outcome.text.find("robot " + scripted->options().robot + ":\n");
    ASSERT_NE(begins, std::string::npos) << outcome.text;
    EXPECT_TRUE(has(outcome.text.substr(begins), "drive: nobody drives: nobody asked"));
  }
}

TEST_F(CliTest, DriveIsADeadMan) {
  Scripted scripted(robot_);
  int terminal = -1;
  const pid_t pid = drive(terminal);
  ASSERT_GE(pid, 0);
  // The drawn text is checked at the end.
  std::string drawn;
  std::thread reader([&] {
    std::array<char, 4096> buffer{};
    while (true) {
      const ssize_t n = read(terminal, buffer.data(), buffer.size());
      if (n <= 0)
        break;
      drawn.append(buffer.data(), static_cast<std::size_t>(n));
    }
  });
  const auto press = [&](char key) { EXPECT_EQ(::write(terminal, &key, 1), 1); };
  // Until its first command is received: it starts and is discovered meanwhile.
  EXPECT_TRUE(test::wait_until([&] {
    press('i');
    std::this_thread::sleep_for(milliseconds(50));
    return scripted.newest().active && scripted.newest().velocity > 0.0;
  }));
  EXPECT_EQ(scripted.newest().stamp.epoch, 7U);
  EXPECT_GT(scripted.newest().stamp.cycle, 0U);
  // Without keys it releases the robot, and stops.
  EXPECT_TRUE(test::wait_until([&] { return !scripted.newest().active; }));
  EXPECT_EQ(scripted.newest().velocity, 0.0);
  // All numbers differ.
  std::uint64_t last = 0;
  for (const v1::MotorCommand& command : scripted.teleop()) {
    EXPECT_GT(command.number, last);
    last = command.number;
  }
  bus::Node bridge(test::node_options("bridge", robot_));
  auto stops = bridge.reader(bus::topics::kDriveStop);
  // Until one is received: the other side of the match may be later than this one.
  std::string asked;
  EXPECT_TRUE(test::wait_until([&] {
    press('k');
    std::this_thread::sleep_for(milliseconds(50));
    if (const auto request = stops.take_newest())
      asked = request->functor;
    return !asked.empty();
  }));
  EXPECT_EQ(asked, "stop");
  EXPECT_TRUE(test::wait_until([&] { return !scripted.newest().active; }));
  const auto handed_back = [&] {
    const auto all = scripted.teleop();
    return std::any_of(all.begin(), all.end(), [](const v1::MotorCommand& command) {
      return command.hand_back && !command.active;
    });
  };
  EXPECT_FALSE(handed_back()) << "a release alone hands nothing back";
  press('h');
  EXPECT_TRUE(test::wait_until(handed_back));
  press('q');
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_TRUE(test::wait_until([&] { return !scripted.newest().active; }));
  // The terminal has its earlier settings.
  termios after{};
  EXPECT_EQ(tcgetattr(terminal, &after), 0);
  EXPECT_NE(after.c_lflag & ICANON, 0U);
  EXPECT_NE(after.c_lflag & ECHO, 0U);
  // The reader ends by itself: the other side is closed.
  reader.join();
  close(terminal);
  EXPECT_TRUE(has(drawn, "12.5 V")) << drawn;
}

TEST_F(CliTest, AnEmergencyStopNeedsNoRoomOnTheDisk) {
  const test::TempDir folder;
  const test::SmallDisk disk(folder.path());
  if (!disk.works())
    GTEST_SKIP() << "no disk can be made here";
  const std::map<std::string, std::string> environment{{"SAPHIRA_RUN", disk.path("run")}};
  const auto ask = [&](const std::vector<std::string>& words) {
    return test::run(command(words), environment);
  };
  std::filesystem::create_directory(disk.path("run"));
  disk.fill();
  test::Process up(command({"up", "demo", "--set", "port=0"}), folder_.path("up"), environment);
  EXPECT_EQ(ask({"estop"}).code, 0) << up.output();
  EXPECT_TRUE(has(ask({"status"}).text, "EMERGENCY STOP"));
  EXPECT_FALSE(has(ask({"status"}).text, "intentions      running")) << "its memory has no room";
  disk.make_room();
  EXPECT_TRUE(test::wait_until([&] {
    return has(ask({"status"}).text, "intentions      running");
  })) << up.output();
  const Outcome reset = ask({"estop", "reset"});
  EXPECT_EQ(reset.code, 0);
  EXPECT_TRUE(has(reset.text, "the emergency stop is reset")) << reset.text;
  const Outcome audit = ask({"audit"});
  EXPECT_EQ(audit.code, 0) << audit.text;
  EXPECT_TRUE(has(audit.text, "\tstopped\t") && has(audit.text, "\treset\t")) << audit.text;
  EXPECT_EQ(ask({"stop"}).code, 0);
  EXPECT_EQ(up.wait(), 0) << up.output();
}

TEST_F(CliTest, RenewTakesInTheSupervisorAndTheSimulatorToo) {
  namespace fs = std::filesystem;
  const std::string bin = folder_.path("bin");
  fs::create_directory(bin);
  const auto install = [&] {
    for (const char* name : {"saphira", "saphira-sim"}) {
      fs::copy_file(test::program(name), bin + "/new");
      fs::rename(bin + "/new", bin + "/" + name);
    }
  };
  install();
  const std::string file =
      write("two.yaml",
            "programs:\n"
            "  - {name: sim, program: saphira-sim, bus: false,\n"
            "     arguments: [--socket, \"${run}/robot\", --resume, \"${run}/sim.state\"]}\n"
            "  - {name: b, program: sh, bus: false,\n"
            "     arguments: [-c, \"echo pid $$; while sleep 0.1; do echo beat; done\"]}\n");
  const std::map<std::string, std::string> environment{{"SAPHIRA_RUN", folder_.path("run")}};
  const auto words = [&](std::vector<std::string> given) {
    std::vector<std::string> all = command(given);
    all[0] = bin + "/saphira";
    return all;
  };
  test::Process up(words({"up", file}), folder_.path("up"), environment);
  ASSERT_TRUE(test::wait_until([&] {
    return has(up.output(), "listening on ") && has(up.output(), "| pid ");
  })) << up.output();
  const auto program_of = [](pid_t process) {
    return fs::read_symlink("/proc/" + std::to_string(process) + "/exe").string();
  };
  const std::string before = up.output();
  const int other = std::stoi(before.substr(before.find("| pid ") + 6));
  install();
  EXPECT_NE(program_of(up.pid()), bin + "/saphira") << "it is an old version now";
  EXPECT_EQ(test::run(words({"renew"}), environment).code, 0);
  ASSERT_TRUE(test::wait_until([&] {
    return has(up.output(), "the supervisor is the new version");
  })) << up.output();
  EXPECT_EQ(program_of(up.pid()), bin + "/saphira");
  EXPECT_TRUE(has(up.output(), "sim started again")) << up.output();
  EXPECT_FALSE(has(up.output(), "b started again")) << up.output();
  const std::size_t then = up.output().size();
  EXPECT_TRUE(test::wait_until([&] { return has(up.output().substr(then), "| beat"); }));
  EXPECT_EQ(kill(other, 0), 0);
  EXPECT_TRUE(has(test::run(words({"up", file}), environment).text, "running already"));
  EXPECT_EQ(test::run(words({"stop"}), environment).code, 0);
  EXPECT_EQ(up.wait(), 0) << up.output();
  EXPECT_NE(kill(other, 0), 0);
}

TEST_F(CliTest, AClosedTerminalEndsTheDemoInGoodOrder) {
  test::Process demo(command({"demo", "--headless"}), folder_.path("demo"));
  ASSERT_TRUE(test::wait_until([&] { return has(demo.output(), "m to go"); })) << demo.output();
  demo.signal(SIGHUP);
  EXPECT_EQ(demo.wait(), 1);
  EXPECT_TRUE(has(demo.output(), "did not arrive: interrupted")) << demo.output();
}

}  // namespace
}  // namespace saphira
