// The answer to a newcomer's mistake at the command line gives the error and advice.
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "process.hpp"

namespace saphira {
namespace {

/// A mistake in a newcomer's command.
struct Mistake {
  std::vector<std::string> words;  ///< after `saphira`
  std::vector<std::string> said;   ///< parts of the answer: the error, and the advice
  int code = 2;
};

const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> all{
      // Commands
      {{"statsu"}, {"statsu", "did you mean status?"}},
      {{"gaol", "go", "3", "1"}, {"gaol", "did you mean goal?"}},
      {{"ech", "robot/state"}, {"ech", "did you mean echo?"}},
      {{"fly"}, {"fly"}},
      {{"help", "staus"}, {"no command \"staus\"", "did you mean status?"}},
      {{"status", "now"}, {"now"}},
      {{"status", "--jsn"}, {"--jsn", "--json"}},
      {{"status", "--json", "--watch"}, {"--json", "--watch"}},
      {{"--versoin"}, {"did you mean --version?"}},
      {{"--profile", "wifi", "status"},
       {"saphira: --profile: expected host, lan or wan, found wifi\n"}},
      {{"--profile", "hots", "status"}, {"did you mean host?"}},
      {{"--interface", "lo", "status"}, {"--interface: expected an IPv4 address", "found lo"}},
      {{"security"}, {"security: expected a command (init, add,", "found none"}},
      {{"--domain", "300", "status"}, {"300", "231"}},
      {{"--robot", "*", "drive"},
       {"saphira: every robot (*) is reached by list, status, agents, ask, goal stop and estop "
        "alone: --robot NAME; saphira list names them\n"}},
      {{"--robot", "*", "goal", "go", "1", "0"}, {"every robot (*) is reached by"}},
      {{"--robot", "*", "estop", "reset"}, {"every robot (*) is reached by"}},
      {{"--robot", "*", "status", "--json"}, {"--watch and --json are of one robot"}},
      {{"--robot", "m?st", "move", "0.1"}, {"expected the name of one robot", "found \"m?st\""}},
      {{"stop", "nothing"}, {"no deployment"}, 1},
      {{"bench", "nothing"}, {"no benchmark", "nothing"}},
      // echo and log
      {{"echo"}, {"saphira: topic: expected a value (such as robot/state), found none\n"}},
      {{"echo", "robot/stat"}, {"no topic \"robot/stat\"", "did you mean robot/state?"}},
      {{"echo", "xyz"}, {"no topic \"xyz\"", "robot/state"}},
      {{"echo", "robot/state", "-n", "0"}, {"expected more than 0, found 0"}},
      {{"echo", "robot/state", "--timeout", "-1"}, {"expected more than 0, found -1"}},
      {{"echo", "robot/state", "--timeout", "2m"}, {"--timeout: expected a number in s, found 2m"}},
      {{"echo", "robot/state", "--once", "-n", "3"}, {"--once", "--count"}},
      {{"log", "-n", "-3"}, {"-n"}},
      // goals
      {{"goal"}, {"expected a goal, such as go 3 1"}},
      {{"goal", "go"}, {"expected go X Y [m, in odom] or go PLACE, found 0 words after go"}},
      {{"goal", "go", "3"}, {"expected go X Y [m, in odom] or go PLACE, found 1 word after go"}},
      {{"goal", "go", "3", "x"}, {"expected go X Y", "found \"x\""}},
      {{"goal", "drive"}, {"expected drive SPEED [m/s], found 0 words after drive"}},
      {{"goal", "drive", "fast"}, {"expected drive SPEED [m/s], found \"fast\""}},
      {{"goal", "turn"}, {"expected turn to DEGREES (a heading in odom), found 0 words"}},
      {{"goal", "turn", "left"}, {"expected turn to DEGREES", "found \"left\""}},
      {{"goal", "turn", "90"}, {"found turn 90; saphira turn 90 turns by an angle"}},
      {{"goal", "activitis"}, {"did you mean activities?"}},
      {{"goal", "list"}, {"no goals; no program is on the bus"}, 1},
      {{"agents"}, {"no agents; no program is on the bus"}, 1},
      {{"echo", "robot/state", "--once"}, {"no program is on the bus", "saphira: given up"}, 1},
      {{"goal", "go_to", "position"}, {"expected name=value, found \"position\""}},
      {{"goal", "go_to", "position=3,x"}, {"expected a point x,y", "\"x\" is not a number"}},
      {{"goal", "go_to", "position=3,1@moon"}, {"\"moon\" is not a frame (odom, robot or map)"}},
      {{"goal", "go_to", "position=1,2", "position=3,4"}, {"\"position\" is there twice"}},
      {{"goal", "go", "3", "1", "--deadline", "-1"},
       {"--deadline", "expected 0 or more, found -1"}},
      {{"goal", "go", "3", "1", "--level", "2"}, {"--level", "2", "1"}},
      {{"goal", "go", "3", "1", "--level", "nan"},
       {"--level: expected a number between 0 and 1, found nan"}},
      {{"goal", "go", "3", "1", "--deadline", "inf"}, {"--deadline", "found inf"}},
      {{"goal", "go", "3", "1", "--priority", "high"}, {"--priority", "high"}},
      {{"goal", "cancel"}, {"cancel"}},
      {{"goal", "cancel", "xyz"}, {"expected goal cancel ID", "found \"xyz\""}},
      {{"goal", "activities", "a", "b"}, {"expected goal activities [ACTIVITY]"}},
      // why
      {{"why", "not"}, {"expected why, or why not turn left"}},
      {{"why", "not", "fly"}, {"expected why, or why not turn left"}},
      {{"why", "turn", "left"}, {"expected why, or why not turn left"}},
      {{"why", "--cycle", "now"}, {"--cycle", "now"}},
      // deployments
      {{"up"}, {"deployment: expected a value", "such as demo", "found none"}},
      {{"up", "dmeo"}, {"no \"dmeo\"", "did you mean demo?"}},
      {{"demo", "--seed", "x"},
       {"saphira: --seed: expected a whole number of 0 or more, found x\n"}},
      {{"demo", "--seed", "-3"},
       {"--seed: expected a whole number between 0 and 18446744073709551615, found -3"}},
      {{"scenario", "--seed", "-3"},
       {"--seed: expected a whole number between 0 and 18446744073709551615, found -3"}},
      {{"scenario", "--rate", "nan"}, {"--rate: expected a number between 0.1 and 20, found nan"}},
      {{"scenario", "--rate", "21"}, {"--rate: expected a number between 0.1 and 20, found 21"}},
      {{"scenario", "--time-limit", "nan"}, {"--time-limit", "found nan"}},
      {{"processes", "suspend", "a", "b", "--cycles", "-1"},
       {"--cycles: expected a whole number between 0 and 4294967295, found -1"}},
      {{"map", "show", "x.svg", "--seconds", "nan"}, {"--seconds", "found nan"}},
      {{"demo", "--headless", "--trace", "/proc/t.csv"},
       {"saphira: /proc/t.csv: cannot be written: No such file or directory"}},
      {{"demo", "--headless", "--base", "nix"},
       {"no \"nix\"", "saphira: sim does not take what it is given"}},
      {{"up", "demo", "--set", "base=nix"}, {"saphira: sim does not take what", "no \"nix\""}},
      {{"check", "demo", "--set", "world=/tmp"},
       {"/tmp: expected a file, found a folder", "1 of its programs does not take"}},
      {{"check", "demo", "--set", "activities=/nonexist"},
       {"/nonexist: expected a folder of activity files", "1 of its programs would not run"}},
      {{"demo", "--goal", "1"}, {"--goal: expected 2 values", "found 1"}},
      {{"demo", "--time-limit", "-1"}, {"--time-limit", "-1"}},
      {{"up", "demo", "--set", "x"}, {"\"x\" sets nothing", "world="}},
      {{"up", "demo", "--set", "nothing=1"}, {"nothing"}},
      {{"up", "demo", "-d", "--set", "nothing=1"}, {"nothing"}},
      // map
      {{"map", "place", "1", "2"}, {"expected place X Y TH", "found 2 words"}},
      {{"map", "show"}, {"expected show FILE.svg"}},
      {{"map", "show", "nope.txt"}, {"nope.txt: expected a name that ends with .svg"}},
      {{"record", "/nowhere/x.mcap", "--for", "1"},
       {"/nowhere/x.mcap: cannot be written: No such file or directory"}},
      {{"record", "notes.txt", "--for", "1"}, {"notes.txt: expected a name that ends with .mcap"}},
      {{"record", "--for", "nan"}, {"--for: expected a number above 0, found nan"}},
      {{"replay", "/nowhere/x.mcap", "--rate", "1e300"},
       {"--rate: expected a number between 0 and 1000, found 1e300"}},
      {{"replay", "/nowhere/x.mcap"},
       {"/nowhere/x.mcap: cannot be read: No such file or directory"}},
      {{"map", "build", "/nowhere/x.map"},
       {"/nowhere/x.map: cannot be written: No such file or directory"}},
      {{"map", "save"}, {"expected save FILE"}},
      {{"map", "load", "nowhere"}, {"nowhere", "office"}},
      // driving
      {{"drive"}, {"drive needs a terminal"}},
      {{"move"}, {"value: expected a value (METERS, below 0: back), found none"}},
      {{"move", "0"}, {"expected meters from -100 to 100 and not 0, found 0"}},
      {{"move", "far"}, {"value: expected a number in m, found far"}},
      {{"move", "90deg"}, {"value: expected a number in m, found 90deg"}},
      {{"move", "1m", "--speed", "0.2s"}, {"--speed: expected a number in m/s, found 0.2s"}},
      {{"turn", "1m"}, {"value: expected a number in deg, found 1m"}},
      {{"goal", "drive", "90deg"}, {"expected drive SPEED [m/s], found \"90deg\""}},
      {{"turn", "400"}, {"expected degrees from -180 to 180 and not 0, found 400"}},
      {{"speed", "9"}, {"expected meters a second from -5 to 5, found 9"}},
      // writing
      {{"write"}, {"topic: expected a value", "found none"}},
      {{"write", "drive/direct"}, {"json: expected a value", "found none"}},
      {{"write", "drive/dirct", "{}"}, {"no topic", "did you mean drive/direct?"}},
      {{"write", "drive/direct", "{velocity: 1}"}, {"this is not JSON, at character 2"}},
      {{"write", "drive/direct", R"({"velocty": 1})"},
       {"no member \"velocty\"", "did you mean velocity?"}},
      {{"write", "drive/direct", R"({"velocity": "fast"})"},
       {"velocity: expected a number, found \"fast\""}},
      {{"write", "drive/direct", R"({"rotation": "LEFT"})"},
       {"rotation: expected one of ROTATION_NONE", "found \"LEFT\""}},
      {{"write", "device/servo", R"({"arguments": [{"number": true}]})"},
       {"arguments[0].number: expected a number, found true"}},
      {{"write", "drive/direct", R"({"velocity": 1e999})"},
       {"drive/direct: expected a finite number, found 1e999\n"}},
      {{"write", "device/servo", R"({"arguments": [{"name": "a"}, {"number": -1e999}]})"},
       {"device/servo: expected a finite number, found -1e999\n"}},
      // processes, beliefs, devices
      {{"processes", "interrupt"}, {"expected processes, or processes interrupt"}},
      {{"processes", "stop", "a", "b"}, {"expected processes, or processes interrupt"}},
      {{"beliefs", "set", "door-open"}, {"expected beliefs set NAME VALUE"}},
      {{"device", "servo"}, {"expected a pulse width [us]"}},
      {{"device", "motor"}, {"found \"motor\": did you mean motors?"}},
      {{"map", "sho"}, {"found \"sho\": did you mean show?"}},
      {{"processes", "interupt"}, {"found interupt: did you mean interrupt?"}},
  };
  return all;
}

/// The answer of `saphira` to those words, with an empty input.
struct Answer {
  std::optional<int> code;
  std::string said;
};
Answer answer_to(const std::vector<std::string>& typed) {
  const test::TempDir folder;
  std::vector<std::string> words{"/bin/sh", "-c", "exec \"$0\" \"$@\" </dev/null",
                                 test::program("saphira")};
  words.insert(words.end(), typed.begin(), typed.end());
  test::Process process(words, folder.path("said"), {{"SAPHIRA_ROBOT", test::unique_robot()}});
  const std::optional<int> code = process.wait();
  return {code, process.output()};
}

/// The words of the parser, which no answer repeats.
void expect_our_words(const Answer& answer, const std::string& typed) {
  for (const char* const raw : {" is required", " not in {", " requires ", " excludes ",
                                "File does not exist", "Run with --help", "RequiredError"})
    EXPECT_EQ(answer.said.find(raw), std::string::npos) << typed << ": " << answer.said;
}

class Mistakes : public testing::TestWithParam<std::size_t> {};

TEST_P(Mistakes, AreAnsweredWithWhatWasWrongAndWhatToDo) {
  const Mistake& mistake = mistakes()[GetParam()];
  const Answer answer = answer_to(mistake.words);
  const auto& [code, said] = answer;
  expect_our_words(answer, testing::PrintToString(mistake.words));
  const std::string typed = testing::PrintToString(mistake.words);
  EXPECT_EQ(code, mistake.code) << typed << ": " << said;
  for (const std::string& part : mistake.said)
    EXPECT_NE(said.find(part), std::string::npos) << typed << ": " << said;
  // The answer names the mistake, and does not list all valid forms.
  EXPECT_LT(said.size(), 2000U) << typed;
  EXPECT_EQ(said.find("terminate"), std::string::npos) << typed << ": " << said;
}

/// A file that a program is given and cannot use.
struct WrongFile {
  std::vector<std::string> words;  ///< FOLDER is the test's folder
  std::string said;
  bool tried_dry = true;
};

// In a dry run and live alike, the code is that of a mistake of use.
TEST(EachProgram, RefusesAFileThatItCannotUseWithOneCode) {
  const test::TempDir folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path(name)) << text;
  };
  const std::string latin = "; caf\xE9\n";
  write("empty", "");
  write("notes", "mine\n");
  for (const char* const ending : {"map", "wld", "p", "grammar", "people", "yaml"})
    write(std::string("latin.") + ending, latin);
  write("silent.people", "PERSON alice EJ-247\n");
  write("lost.people", "PERSON alice moon\nSAYS alice Flakey, stop\n");
  write("metres.map", "WALL 0, 0, 0, 38\nWALL 0, 0, 90, 27\nWALL 0, 27, 0, 38\n");
  const std::string no_text = ":1:6: expected a text in UTF-8, found the byte 0xE9";
  const std::string other = "found another file, which stays as it is";
  const std::vector<WrongFile> all{
      {{"saphira-bridge", "--robots", "/nowhere"}, "--robots /nowhere: expected a folder"},
      {{"saphira-bridge", "--robot-file", "/nowhere/x.p"}, "/nowhere/x.p: there is no such file"},
      {{"saphira-bridge", "--robot-file", "FOLDER/latin.p", "--dry-run"}, no_text, false},
      {{"saphira-bridge", "--state", "FOLDER/notes"}, other},
      {{"saphira-bridge", "--robot-port", "unix:FOLDER/notes"}, "expected a local socket, found a"},
      {{"saphira-behaviors", "--plugin", "/nowhere/x.so"}, "expected a plug-in of behaviors"},
      {{"saphira-behaviors", "--plugin", "FOLDER/notes"}, "expected a plug-in of behaviors"},
      {{"saphira-registration", "--map", "/nowhere/x.map"}, "there is no such file"},
      {{"saphira-registration", "--map", "FOLDER/latin.map"}, no_text},
      {{"saphira-registration", "--map-memory", "FOLDER/notes"}, other},
      {{"saphira-intentions", "--memory", "FOLDER/notes"}, other},
      {{"saphira-intentions", "--memory", "/nowhere/memory"}, "/nowhere/memory", false},
      {{"saphira-facilitator", "--memory", "FOLDER/notes"}, other},
      {{"saphira-dialogue", "--memory", "FOLDER/notes"}, other},
      {{"saphira-dialogue", "--grammar", "FOLDER/latin.grammar"}, no_text},
      {{"saphira-sim", "--world", "/nowhere/x.wld"}, "/nowhere/x.wld: there is no such file"},
      {{"saphira-sim", "--world", "FOLDER/latin.wld"}, no_text},
      {{"saphira-sim", "--robot", "FOLDER/latin.p"}, no_text},
      {{"saphira-sim", "--socket", "FOLDER/notes"},
       "expected a new name, or a socket; found a file"},
      {{"saphira-console", "--certificate", "FOLDER/empty", "--certificate-key", "FOLDER/empty"},
       "/empty: expected a certificate in PEM"},
      {{"saphira-console", "--dial-authority", "/nowhere/x.pem"},
       "--dial-authority: /nowhere/x.pem: cannot be read: No such file or directory; give the "
       "certificate (PEM)"},
      {{"saphira-relay", "--dial-port", "1", "--robots", "FOLDER/notes", "--certificate",
        "FOLDER/empty", "--certificate-key", "FOLDER/empty"},
       "/empty: expected a certificate in PEM",
       false},
      {{"saphira", "check", "FOLDER/latin.yaml"}, no_text, false},
      {{"saphira", "map", "load", "FOLDER/latin.map"}, no_text, false},
      {{"saphira", "scenario", "--cast", "FOLDER/latin.people"}, no_text, false},
      {{"saphira", "scenario", "--cast", "FOLDER/silent.people"}, "expected a line SAYS", false},
      {{"saphira", "scenario", "--cast", "FOLDER/lost.people"},
       "lost.people:1:14: expected a place of the map, found \"moon\"",
       false},
      {{"saphira-registration", "--map", "FOLDER/metres.map"}, "is it in metres?"},
      {{"saphira-registration", "--map", "FOLDER/empty"}, "expected a line for each artifact"},
      {{"saphira", "wiring", "--draw", "/nowhere/x.svg"},
       "/nowhere/x.svg: cannot be written",
       false},
  };
  for (const WrongFile& wrong : all)
    for (const bool dry : {false, true}) {
      if (dry && !wrong.tried_dry)
        continue;
      std::vector<std::string> words;
      for (std::string word : wrong.words) {
        if (const std::size_t at = word.find("FOLDER"); at != std::string::npos)
          word.replace(at, 6, folder.path());
        words.push_back(word);
      }
      if (dry)
        words.emplace_back("--dry-run");
      const test::Outcome outcome = test::run(words, {{"SAPHIRA_ROBOT", test::unique_robot()}});
      const std::string typed = testing::PrintToString(words);
      EXPECT_EQ(outcome.code, 2) << typed << ": " << outcome.text;
      EXPECT_TRUE(test::has(outcome.text, wrong.said)) << typed << ": " << outcome.text;
    }
  std::string mine;
  std::getline(std::ifstream(folder.path("notes")), mine);
  EXPECT_EQ(mine, "mine");
}

TEST(EachProgram, SaysInADryRunOfWhatItWouldWarn) {
  const test::TempDir folder;
  std::ofstream(folder.path("zero.wld"))
      << "width 9000\nheight 9000\n1000 1000 1000 1000\nposition 4000 4000 0\n";
  const test::Outcome sim =
      test::run({"saphira-sim", "--world", folder.path("zero.wld"), "--dry-run"}, {});
  EXPECT_EQ(sim.code, 0) << sim.text;
  EXPECT_TRUE(test::has(sim.text, "zero.wld:3: a segment between a point and itself is left out"))
      << sim.text;
  std::ofstream(folder.path("mine.p"))
      << "AngleConvFactor 0.006\nDistConvFactor 1\nVelConvFactor 1\nRangeConvFactor 1\n"
         "RobotRadius 220\nSonarNum 0\nSonarUnit 0 100 0 0\n";
  const test::Outcome bridge =
      test::run({"saphira-bridge", "--robot-file", folder.path("mine.p"), "--dry-run"},
                {{"SAPHIRA_ROBOT", test::unique_robot()}});
  EXPECT_EQ(bridge.code, 0) << bridge.text;
  EXPECT_TRUE(test::has(bridge.text, "mine.p:7: SonarUnit 0 is left out: SonarNum is 0"))
      << bridge.text;
}

TEST(EachCommand, NamesAMistakeInAVariable) {
  const auto said = [](const std::string& variable, const std::string& value) {
    const test::Outcome outcome = test::run({"saphira", "status"}, {{variable, value}});
    EXPECT_EQ(outcome.code, 2) << variable << ": " << outcome.text;
    return outcome.text;
  };
  EXPECT_EQ(said("SAPHIRA_DOMAIN", "abc"),
            "saphira: SAPHIRA_DOMAIN: expected a whole number between 0 and 231, found abc\n");
  EXPECT_TRUE(
      said("SAPHIRA_ROBOT", "a b").starts_with("saphira: SAPHIRA_ROBOT: expected the name"));
  EXPECT_TRUE(said("SAPHIRA_PROFILE", "hots").starts_with("saphira: SAPHIRA_PROFILE: expected"));
  EXPECT_TRUE(said("SAPHIRA_INTERFACE", "lo").starts_with("saphira: SAPHIRA_INTERFACE: expected"));
}

TEST(EachCommand, NamesAnUnknownOptionInOurWords) {
  std::istringstream help(answer_to({"help"}).said);
  std::size_t commands = 0;
  bool below = false;
  for (std::string line; std::getline(help, line);) {
    below = below || line == "Subcommands:";
    if (!below || !line.starts_with("  ") || line[2] == ' ')
      continue;
    const std::string command = line.substr(2, line.find(' ', 2) - 2);
    ++commands;
    if (command == "bench")  // the options behind its name are not its own
      continue;
    const Answer answer = answer_to({command, "--nonsense"});
    EXPECT_EQ(answer.code, 2) << command << ": " << answer.said;
    EXPECT_TRUE(answer.said.find("\"--nonsense\" is not understood") != std::string::npos ||
                answer.said.find(": expected ") != std::string::npos)
        << command << ": " << answer.said;
    expect_our_words(answer, command);
  }
  EXPECT_GT(commands, 30U);
}

INSTANTIATE_TEST_SUITE_P(Each, Mistakes, testing::Range<std::size_t>(0, mistakes().size()));

}  // namespace
}  // namespace saphira
