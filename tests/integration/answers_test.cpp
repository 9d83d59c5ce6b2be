// The answers of the command line that need no bus.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "cli_fixture.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/introspect.hpp"

namespace saphira {
namespace {

using test::has;
using test::Outcome;

class Answers : public test::CliFixture {};

TEST_F(Answers, WithoutArgumentsItHelps) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.code, 0);
  for (const char* name :
       {"demo", "up", "status", "list", "echo", "log", "goal", "drive", "estop", "bench"})
    EXPECT_TRUE(has(outcome.text, name)) << name;
}

// The script shows this file where nothing is built yet.
TEST_F(Answers, HelpIsWhatTheScriptShowsOfAFreshClone) {
  const Outcome outcome = run({"help"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.text, read_file(test::source("agents/cli/help.txt")))
      << "write it anew: saphira help > agents/cli/help.txt";
  EXPECT_TRUE(has(run({"help", "goal"}).text, "Send a goal and follow it to its end"));
  EXPECT_TRUE(has(run({"--version"}).text, "saphira "));
  for (const auto& words : {std::vector<std::string>{"help", "console"}, {"console", "--help"}})
    EXPECT_TRUE(has(run(words).text, "--screenshot TEXT")) << "of the program that it starts";
}

TEST_F(Answers, OutputThatCannotBeWrittenIsAFailure) {
  for (const char* const words :
       {"", "help", "--help", "--version", "goal --help", "complete go", "check demo"}) {
    const Outcome outcome =
        test::run({"/bin/sh", "-c", "exec \"$0\" " + std::string(words) + " >/dev/full",
                   test::program("saphira")});
    EXPECT_EQ(outcome.code, 3) << words << ": " << outcome.text;
    EXPECT_TRUE(has(outcome.text, "saphira: could not write the output: No space left on device"))
        << words << ": " << outcome.text;
  }
}

/// The names in the help's list of commands, a line each.
std::string commands_of(const std::string& help) {
  std::istringstream lines(help.substr(help.find("Subcommands:\n")));
  std::string names;
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line) && line.starts_with("  ");)
    names += line.substr(2, line.find(' ', 2) - 2) + "\n";
  return names;
}

TEST_F(Answers, CompletionListsWhatMayComeNext) {
  std::string all_topics;
  std::string of_robot;
  for (const bus::TopicEntry& topic : bus::known_topics()) {
    all_topics += topic.name + "\n";
    if (topic.name.starts_with("robot/"))
      of_robot += topic.name + "\n";
  }
  const std::string commands = commands_of(run({"help"}).text);
  ASSERT_TRUE(has(commands, "demo\n") && has(commands, "help\n")) << commands;
  ASSERT_TRUE(has(of_robot, "robot/state\n")) << of_robot;
  const std::string deployments =
      "demo\nlaptop\noffice\npioneer\nrobot\nseeing\nseeing-office\ntwo-robots\n";
  const std::vector<std::pair<std::vector<std::string>, std::string>> begun{
      {{""}, commands},
      {{"go"}, "goal\n"},
      {{"st"}, "stop\nstatus\n"},
      {{"--robot", "drive", "go"}, "goal\n"},
      {{"help", "dem"}, "demo\n"},
      {{"up", ""}, deployments},
      {{"stop", "seeing"}, "seeing\nseeing-office\n"},
      {{"echo", ""}, all_topics},
      {{"write", "robot/"}, of_robot},
      {{"goal", "--priority", "2", ""}, "go\ndrive\nturn\nstop\nlist\ncancel\nactivities\n"},
      {{"goal", "go", ""}, ""},
      {{"beliefs", ""}, "set\nunset\n"},
      {{"estop", ""}, "reset\n"},
      {{"ask", "--js"}, "--json\n"},
      {{"--prof"}, "--profile\n"},
      {{"ask", "--he"}, "--help\n"},
      {{"fly", "to", "mo"}, "move\n"}};
  for (const auto& [words, expected] : begun) {
    std::vector<std::string> line{"complete"};
    line.insert(line.end(), words.begin(), words.end());
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(words);
    EXPECT_EQ(outcome.text, expected) << testing::PrintToString(words);
  }
  EXPECT_TRUE(has(run({"complete", "--"}).text, "--domain\n"));
}

TEST_F(Answers, UpGivesARobotEachOfItsProgramsOnce) {
  const std::string programs =
      "programs:\n"
      "  - {name: behaviors, program: sh, arguments: [-c, exec sleep 600]}\n";
  const std::string first = write("first.yaml", programs);
  const std::string second = write("second.yaml", programs);
  test::Process up(command({"up", first}), folder_.path("up"));
  ASSERT_TRUE(test::wait_until([&] { return has(up.output(), "1 program of"); })) << up.output();
  const Outcome other = run({"up", second});
  EXPECT_NE(other.code, 0);
  EXPECT_TRUE(has(other.text, "behaviors of robot " + robot_)) << other.text;
  EXPECT_TRUE(has(other.text, "started by " + first)) << other.text;
  up.signal(SIGTERM);
  EXPECT_EQ(up.wait(), 0);
}

TEST_F(Answers, UpInTheBackgroundIsRefusedASecondTime) {
  const std::string file =
      write("twice.yaml",
            "programs:\n"
            "  - {name: a, program: sh, bus: false, arguments: [-c, exec sleep 600]}\n");
  expect({"up", file, "-d"}, 0);
  expect({"up", file, "-d"}, 3, {"saphira: this deployment is running already: "});
  const std::string other = "other-" + robot_;
  const Outcome spared = test::run({"saphira", "--robot", other, "stop"});
  EXPECT_EQ(spared.code, 1) << spared.text;
  EXPECT_TRUE(has(spared.text, "saphira: no deployment of robot " + other)) << spared.text;
  EXPECT_TRUE(has(spared.text, " runs; there are: ")) << spared.text;
  EXPECT_TRUE(has(spared.text, "twice-" + robot_)) << spared.text;
  expect({"stop"}, 0);
}

TEST_F(Answers, AnAuthorityThatIsNamedWinsOverTheOneOfTheEnvironment) {
  const std::map<std::string, std::string> environment{{"SAPHIRA_AUTHORITY", "/elsewhere"}};
  const auto said = [&](const std::vector<std::string>& words) {
    return test::run(command(words), environment).text;
  };
  const std::string named = said({"security", "revoke", "eve", "--authority", "/nothere"});
  EXPECT_TRUE(has(named, "/nothere holds no authority")) << named;
  const std::string other = said({"security", "revoke", "eve"});
  EXPECT_TRUE(has(other, "/elsewhere holds no authority")) << other;
}

TEST_F(Answers, RecordSparesAFileWithOtherContent) {
  const std::string file = write("notes.mcap", "notes");
  const Outcome outcome = run({"record", file, "--for", "0.1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.text, "saphira: " + file +
                              ": a file with other content is there; give a new name, such as "
                              "NAME.mcap\n");
  EXPECT_EQ(read_file(file), "notes");
}

TEST_F(Answers, UpNamesTheMistakeInADeployment) {
  const std::string file = write("bad.yaml", "programs:\n  - program: sh\n    argments: []\n");
  expect({"up", file}, 2, {"bad.yaml:3:5: unknown key \"argments\""});
}

TEST_F(Answers, UpEndsWhenAProgramDoesNotTakeItsOptions) {
  const std::string file =
      write("misused.yaml",
            "programs:\n"
            "  - {name: other, program: sh, bus: false, arguments: [-c, exec sleep 600]}\n"
            "  - {program: saphira-bridge, arguments: [--no-such-option]}\n");
  const Outcome outcome = run({"up", file});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(has(outcome.text, "saphira: bridge refuses the options of")) << outcome.text;
  EXPECT_FALSE(has(outcome.text, "started")) << outcome.text;
}

// The programs read the files that a deployment gives them, and nothing is started.
TEST_F(Answers, CheckSaysWhetherADeploymentWouldStart) {
  expect({"check", "office"}, 0, {"office.yaml would start"});

  const std::string map = write("wrong.map", "CORRIDOR (1) 0, 0, 0\n");
  const std::string grammar = write("wrong.grammar", "keyword: robot\ngo(\n");
  expect({"check", "office", "--set", "map=" + map, "--set", "grammar=" + grammar}, 2,
         {"wrong.map:1:", "wrong.grammar:2:", "would not start: 2 of its programs"});
  expect({"check", "demo", "--set", "world=nowhere"}, 2);
  const std::string robot = write("wrong.p", "Class Pioneer\nRobotRadus 250\n");
  expect({"check", "pioneer", "--set", "base=" + robot}, 2, {"did you mean RobotRadius?"});

  const Outcome speech = run({"check", "office", "--set", "speech=on", "--set",
                              "microphone=no-microphone", "--set", "loudspeaker=no-loudspeaker"});
  EXPECT_EQ(speech.code, 0) << speech.text;
  if (std::filesystem::exists(test::program("saphira-speech"))) {
    EXPECT_TRUE(has(speech.text, "the sound device \"no-microphone\" cannot be opened: "))
        << speech.text;
    EXPECT_TRUE(has(speech.text, "the sound device \"no-loudspeaker\" cannot be opened: "))
        << speech.text;
  } else {
    EXPECT_TRUE(has(speech.text, "speech is left out: ")) << speech.text;
  }
  EXPECT_EQ(run({"check", "office", "--set", "speech=perhaps"}).code, 2);
  expect({"check", "pioneer", "--set", "device=/dev/ttyNone"}, 0,
         {"/dev/ttyNone: cannot be opened: No such file"});

  // A mistake that a running program would only report.
  std::filesystem::create_directory(folder_.path("my"));
  write("my/wrong.beh", "BeginBehavior\n");
  expect({"check", "demo", "--set", "behaviors=" + folder_.path("my")}, 2, {"wrong.beh:"});
  std::filesystem::create_directory(folder_.path("plans"));
  write("plans/wrong.act", "(defintention :it :goals '((INTEND :GoToPoss ((goal . 1)))))\n");
  expect({"check", "office", "--set", "activities=" + folder_.path("plans")}, 2,
         {"wrong.act:1:", "unknown schema \"GoToPoss\"", "1 of its programs would not run"});

  // Of a program that lacks something the supervisor tries again; the others run on.
  std::filesystem::permissions(write("saphira-lacking", "#!/bin/sh\necho no model\nexit 3\n"),
                               std::filesystem::perms::owner_all);
  expect({"check", write("lacking.yaml", "programs: [{program: ./saphira-lacking}]\n")}, 2,
         {"no model", "would start, but 1 of its programs would not run"});
  EXPECT_EQ(run({"status"}).code, 1) << "nothing was started";
}

TEST_F(Answers, TheDemoSaysWhatIsWrongWithAWorld) {
  const std::string file = write("bad.wld", "wdith 3\n");
  expect({"demo", "--headless", "--world", file}, 2, {"bad.wld:1:1: expected"});
}

}  // namespace
}  // namespace saphira
