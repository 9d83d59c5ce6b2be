// The answer to a newcomer's mistake at the command line gives the error and advice.
#include <gtest/gtest.h>

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
      {{"--profile", "wifi", "status"}, {"wifi", "host"}},
      {{"--domain", "300", "status"}, {"300", "231"}},
      {{"stop", "nothing"}, {"no deployment"}, 1},
      {{"bench", "nothing"}, {"no benchmark", "nothing"}},
      // echo and log
      {{"echo"}, {"topic is required"}},
      {{"echo", "robot/stat"}, {"no topic \"robot/stat\"", "did you mean robot/state?"}},
      {{"echo", "xyz"}, {"no topic \"xyz\"", "robot/state"}},
      {{"echo", "robot/state", "-n", "0"}, {"expected more than 0, found 0"}},
      {{"echo", "robot/state", "-n", "few"}, {"few"}},
      {{"echo", "robot/state", "--timeout", "-1"}, {"expected more than 0, found -1"}},
      {{"echo", "robot/state", "--once", "-n", "3"}, {"--once", "--count"}},
      {{"log", "-n", "-3"}, {"-n"}},
      // goals
      {{"goal"}, {"expected a goal, such as go 3 1"}},
      {{"goal", "go"}, {"expected go X Y [m, in odom] or go PLACE, found 0 words after go"}},
      {{"goal", "go", "3"}, {"expected go X Y [m, in odom] or go PLACE, found 1 word after go"}},
      {{"goal", "go", "3", "x"}, {"expected go X Y", "found \"x\""}},
      {{"goal", "drive"}, {"expected drive SPEED [m/s], found 0 words after drive"}},
      {{"goal", "drive", "fast"}, {"expected drive SPEED [m/s], found \"fast\""}},
      {{"goal", "turn"}, {"expected turn DEGREES, found 0 words after turn"}},
      {{"goal", "turn", "left"}, {"expected turn DEGREES, found \"left\""}},
      {{"goal", "go_to", "position"}, {"expected name=value, found \"position\""}},
      {{"goal", "go_to", "position=3,x"}, {"expected a point x,y", "\"x\" is not a number"}},
      {{"goal", "go_to", "position=3,1@moon"}, {"\"moon\" is not a frame (odom, robot or map)"}},
      {{"goal", "go_to", "position=1,2", "position=3,4"}, {"\"position\" is there twice"}},
      {{"goal", "go", "3", "1", "--deadline", "-1"},
       {"--deadline", "expected 0 or more, found -1"}},
      {{"goal", "go", "3", "1", "--level", "2"}, {"--level", "2", "1"}},
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
      {{"up"}, {"deployment is required"}},
      {{"up", "dmeo"}, {"no \"dmeo\"", "did you mean demo?"}},
      {{"demo", "--seed", "x"},
       {"saphira: --seed: expected a whole number of 0 or more, found x\n"}},
      {{"demo", "--headless", "--trace", "/proc/t.csv"},
       {"saphira: /proc/t.csv: cannot be written: No such file or directory"}},
      {{"demo", "--headless", "--base", "nix"},
       {"no \"nix\"", "saphira: sim does not take what it is given"}},
      {{"up", "demo", "--set", "base=nix"}, {"saphira: sim does not take what", "no \"nix\""}},
      {{"check", "demo", "--set", "world=/tmp"},
       {"/tmp: expected a file, found a folder", "1 of its programs does not take"}},
      {{"check", "demo", "--set", "activities=/nonexist"},
       {"/nonexist: expected a folder of activity files", "1 of its programs would not run"}},
      {{"demo", "--goal", "1"}, {"--goal", "2 required"}},
      {{"demo", "--time-limit", "-1"}, {"--time-limit", "-1"}},
      {{"up", "demo", "--set", "x"}, {"\"x\" sets nothing", "world="}},
      {{"up", "demo", "--set", "nothing=1"}, {"nothing"}},
      {{"up", "demo", "-d", "--set", "nothing=1"}, {"nothing"}},
      // map
      {{"map", "frobnicate"}, {"frobnicate", "expected follow, list"}},
      {{"map", "place", "1", "2"}, {"expected place X Y TH", "found 2 words"}},
      {{"map", "place", "a", "b", "c"}, {"expected x [m], found \"a\""}},
      {{"map", "show"}, {"expected show FILE.svg"}},
      {{"map", "show", "nope.txt"}, {"nope.txt: expected a name that ends with .svg"}},
      {{"record", "/nowhere/x.mcap", "--for", "1"},
       {"/nowhere/x.mcap: cannot be written: No such file or directory"}},
      {{"replay", "/nowhere/x.mcap"},
       {"/nowhere/x.mcap: cannot be read: No such file or directory"}},
      {{"map", "build", "/nowhere/x.map"},
       {"/nowhere/x.map: cannot be written: No such file or directory"}},
      {{"map", "save"}, {"expected save FILE"}},
      {{"map", "load", "nowhere"}, {"nowhere", "office"}},
      {{"map", "put", "DOR (3) 1, 2, 3, 4"}, {"DOR"}},
      {{"map", "remove", "x"}, {"the id of an artifact, found \"x\""}},
      {{"map", "snap", "maybe"}, {"expected on or off, found \"maybe\""}},
      // driving
      {{"drive"}, {"drive needs a terminal"}},
      {{"move"}, {"value is required"}},
      {{"move", "0"}, {"expected meters from -100 to 100 and not 0, found 0"}},
      {{"move", "far"}, {"far"}},
      {{"turn", "400"}, {"expected degrees from -180 to 180 and not 0, found 400"}},
      {{"speed", "9"}, {"expected meters a second from -5 to 5, found 9"}},
      // writing
      {{"write"}, {"is required"}},
      {{"write", "drive/direct"}, {"json is required"}},
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
      // processes, beliefs, devices
      {{"processes", "interrupt"}, {"expected processes, or processes interrupt"}},
      {{"processes", "stop", "a", "b"}, {"expected processes, or processes interrupt"}},
      {{"beliefs", "set", "door-open"}, {"expected beliefs set NAME VALUE"}},
      {{"device", "servo"}, {"expected a pulse width [us]"}},
      {{"device", "gripper", "oepn"}, {"oepn"}},
  };
  return all;
}

class Mistakes : public testing::TestWithParam<std::size_t> {};

TEST_P(Mistakes, AreAnsweredWithWhatWasWrongAndWhatToDo) {
  const Mistake& mistake = mistakes()[GetParam()];
  const test::TempDir folder;
  std::vector<std::string> words{"saphira"};
  words.insert(words.end(), mistake.words.begin(), mistake.words.end());
  // Its input is empty.
  words.insert(words.begin(), {"/bin/sh", "-c", "exec \"$0\" \"$@\" </dev/null"});
  words[3] = test::program("saphira");
  test::Process process(words, folder.path("said"), {{"SAPHIRA_ROBOT", test::unique_robot()}});
  const std::optional<int> code = process.wait();
  const std::string said = process.output();
  const std::string typed = testing::PrintToString(mistake.words);
  EXPECT_EQ(code, mistake.code) << typed << ": " << said;
  for (const std::string& part : mistake.said)
    EXPECT_NE(said.find(part), std::string::npos) << typed << ": " << said;
  // The answer names the mistake, and does not list all valid forms.
  EXPECT_LT(said.size(), 2000U) << typed;
  EXPECT_EQ(said.find("terminate"), std::string::npos) << typed << ": " << said;
}

INSTANTIATE_TEST_SUITE_P(Each, Mistakes, testing::Range<std::size_t>(0, mistakes().size()));

}  // namespace
}  // namespace saphira
