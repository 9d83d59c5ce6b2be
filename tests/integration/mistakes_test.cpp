// The answer to a newcomer's mistake at the command line gives the error and advice.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

/// A mistake in a newcomer's command.
struct Mistake {
  std::string words;              ///< after `saphira`, for a shell
  std::vector<std::string> said;  ///< parts of the answer: the error, and the advice
  int code = 2;
};

/// The mistakes of mistakes.txt.
std::vector<Mistake> mistakes() {
  std::vector<Mistake> all;
  test::each_line("tests/integration/mistakes.txt", '#', [&](std::string line) {
    const std::size_t arrow = line.find(" => ");
    ASSERT_NE(arrow, std::string::npos) << "expected \"words => answer\"";
    Mistake& mistake = all.emplace_back();
    mistake.words = line.substr(0, arrow);
    line.erase(0, arrow + 4);
    if (line.starts_with("[1] ")) {
      mistake.code = 1;
      line.erase(0, 4);
    }
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t end = std::min(line.find(" ... ", at), line.size());
      std::string part = line.substr(at, end - at);
      if (part.back() == '$')
        part.back() = '\n';
      mistake.said.push_back(part);
      at = end + 5;
    }
  });
  return all;
}

/// The answer of `saphira` to those words, with an empty input.
struct Answer {
  std::optional<int> code;
  std::string said;
};
Answer answer_to(const std::string& words) {
  const test::TempDir folder;
  test::Process process(
      {"/bin/sh", "-c", "exec \"$0\" " + words + " </dev/null", test::program("saphira")},
      folder.path("said"), {{"SAPHIRA_ROBOT", test::unique_robot()}});
  const std::optional<int> code = process.wait();
  return {code, process.output()};
}

/// The words of the parser, which no answer repeats.
void expect_our_words(const Answer& answer, const std::string& typed) {
  for (const char* const raw : {" is required", " not in {", " requires ", " excludes ",
                                "File does not exist", "Run with --help", "RequiredError"})
    EXPECT_EQ(answer.said.find(raw), std::string::npos) << typed << ": " << answer.said;
}

// In parts, so that they run side by side.
constexpr std::size_t kParts = 8;
class Mistakes : public testing::TestWithParam<std::size_t> {};

TEST_P(Mistakes, AreAnsweredWithWhatWasWrongAndWhatToDo) {
  const std::vector<Mistake> all = mistakes();
  EXPECT_GT(all.size(), 100U);
  for (std::size_t i = GetParam(); i < all.size(); i += kParts) {
    const auto& [typed, parts, expected] = all[i];
    const Answer answer = answer_to(typed);
    expect_our_words(answer, typed);
    EXPECT_FALSE(parts.empty()) << typed;
    EXPECT_EQ(answer.code, expected) << typed << ": " << answer.said;
    for (const std::string& part : parts)
      EXPECT_TRUE(test::has(answer.said, part)) << typed << ": " << answer.said;
    // The answer names the mistake, and does not list all valid forms.
    EXPECT_LT(answer.said.size(), 2000U) << typed;
    EXPECT_FALSE(test::has(answer.said, "terminate")) << typed << ": " << answer.said;
  }
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
  std::istringstream help(answer_to("help").said);
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
    const Answer answer = answer_to(command + " --nonsense");
    EXPECT_EQ(answer.code, 2) << command << ": " << answer.said;
    EXPECT_TRUE(answer.said.find("\"--nonsense\" is not understood") != std::string::npos ||
                answer.said.find(": expected ") != std::string::npos)
        << command << ": " << answer.said;
    expect_our_words(answer, command);
  }
  EXPECT_GT(commands, 30U);
}

INSTANTIATE_TEST_SUITE_P(Each, Mistakes, testing::Range<std::size_t>(0, kParts));

}  // namespace
}  // namespace saphira
