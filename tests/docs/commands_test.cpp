// The commands in documents and comments can be typed as shown.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "pages.hpp"
#include "process.hpp"
#include "saphira/agent_interface/grammar.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/topics.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/map_words.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_with_commands() {
  std::vector<fs::path> files;
  for (const char* const folder : {"docs", "config", "services", "agents", "bridge", "sim", "idl"})
    for (const auto& entry : fs::recursive_directory_iterator(test::source(folder)))
      if (entry.path().extension() == ".md" || entry.path().extension() == ".yaml")
        files.push_back(entry.path());
  files.emplace_back(test::source("README.md"));
  files.emplace_back(test::source("CONTRIBUTING.md"));
  std::sort(files.begin(), files.end());
  return files;
}

/// The subcommands, from the help.
std::set<std::string> commands() {
  std::set<std::string> names{"test", "complete", "package"};
  std::istringstream help(read_file(test::source("agents/cli/help.txt")));
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (listed && line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
      names.insert(line.substr(2, line.find(' ', 2) - 2));
    listed = listed || line.starts_with("Subcommands:");
  }
  return names;
}

struct Shown {
  std::string file;
  std::string program;
  std::vector<std::string> words;  ///< behind the program
};

/// The words of a line as a shell takes them, up to what belongs to another command.
std::vector<std::string> words_in(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t at = line.find_first_not_of(" \n"); at < line.size();
       at = line.find_first_not_of(" \n", at)) {
    const bool quoted = line[at] == '"' || line[at] == '\'';
    const std::size_t end =
        std::min(quoted ? line.find(line[at], at + 1) : line.find_first_of(" \n", at), line.size());
    const std::string word = line.substr(at + (quoted ? 1 : 0), end - at - (quoted ? 1 : 0));
    if (!quoted && (word == "|" || word == "&&" || word == ">" || word == "&" || word[0] == '#'))
      break;
    const bool last = !quoted && word.ends_with(';');
    words.push_back(last ? word.substr(0, word.size() - 1) : word);
    if (last)
      break;
    at = end + (quoted ? 1 : 0);
  }
  return words;
}

/// The commands of our programs: in `...`, in an indented line, in a line of a fence, or in a
/// comment of a deployment.
std::vector<Shown> shown() {
  const std::string program = "(?:[.]/|build/release/bin/)?(saphira(?:-[a-z]+)?) ";
  const std::regex quoted("`" + program + "([^`]+)`");
  const std::regex line_of_its_own("^(?:#?\\s+|[$] )?(?:sudo (?:-u \\w+ )?)?" + program + "(.*)");
  std::vector<Shown> all;
  for (const fs::path& file : files_with_commands()) {
    const std::string text = test::replaced(read_file(file.string()), "\\\n", "");
    for (auto it = std::sregex_iterator(text.begin(), text.end(), quoted);
         it != std::sregex_iterator(); ++it)
      all.push_back({file.string(), (*it)[1], words_in((*it)[2])});
    std::istringstream lines(text);
    std::smatch found;
    for (std::string line; std::getline(lines, line);)
      if (std::regex_search(line, found, line_of_its_own))
        all.push_back({file.string(), found[1], words_in(found[2])});
  }
  std::erase_if(all, [](const Shown& one) { return one.words.empty(); });
  return all;
}

/// Those of `saphira COMMAND`.
std::vector<Shown> shown(const std::string& command) {
  std::vector<Shown> all = shown();
  std::erase_if(all, [&](const Shown& one) {
    return one.program != "saphira" || one.words.front() != command;
  });
  return all;
}

/// True for NAME, N, FILE.svg, [-d] and ..., which a person replaces.
bool is_example(const std::string& word) {
  return std::any_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; }) ||
         word.find_first_of("[<|") != std::string::npos || word.find("...") != std::string::npos;
}

/// True for a word that is nothing but that: NAME, map=FILE, name=value and ...
bool is_form(const std::string& word) {
  return std::regex_match(word, std::regex("(.*=)?[A-Z]+|name=value|.*[.][.][.].*"));
}

TEST(ShownCommands, AreThere) {
  const std::set<std::string> known = commands();
  ASSERT_GT(known.size(), 15U);
  int checked = 0;
  for (const Shown& one : shown()) {
    const std::string& command = one.words.front();
    if (one.program != "saphira" || is_example(command) || command.starts_with("-"))
      continue;
    ++checked;
    EXPECT_TRUE(known.contains(command)) << one.file << ": saphira " << command;
  }
  EXPECT_GT(checked, 50);
}

/// The help of a program, or of a command of `saphira`.
std::string help_of(const Shown& one) {
  static std::map<std::vector<std::string>, std::string> said;
  const std::regex plain("[a-z][a-z0-9-]*");
  std::vector<std::string> argv{one.program};
  if (one.program == "saphira")
    for (std::size_t i = 0; i < 2 && i < one.words.size(); ++i) {
      if (!std::regex_match(one.words[i], plain))
        break;
      argv.push_back(one.words[i]);
    }
  argv.emplace_back("--help");
  std::string& text = said[argv];
  if (text.empty()) {
    const test::TempDir folder;
    test::Process help(argv, folder.path("said"));
    EXPECT_EQ(help.wait(), 0) << one.file << ": " << testing::PrintToString(argv);
    text = help.output();
  }
  return text;
}

/// The programs and options of the settings that two pages show for other files.
std::vector<Shown> shown_settings() {
  const std::regex program("saphira-[a-z]+");
  const std::regex option("--[a-z-]+");
  std::vector<Shown> all;
  for (const char* const page : {"README.md", "docs/deploy.md"})
    for (const test::Block& block : test::blocks_of(page)) {
      std::smatch found;
      if ((block.language != "json" && block.language != "yaml") ||
          !std::regex_search(block.text, found, program))
        continue;
      all.push_back({page, found[0], {}});
      for (auto it = std::sregex_iterator(block.text.begin(), block.text.end(), option);
           it != std::sregex_iterator(); ++it)
        all.back().words.push_back((*it)[0]);
    }
  return all;
}

TEST(ShownCommands, HaveTheirOptions) {
  const std::set<std::string> of_the_script{"test", "package", "bench"};
  const std::regex is_option(R"(\[?(--?[a-z][a-z-]*)(=.*)?\]?)");
  std::vector<Shown> all = shown_settings();
  EXPECT_EQ(all.size(), 1U);
  const std::vector<Shown> typed = shown();
  all.insert(all.end(), typed.begin(), typed.end());
  const std::string of_all = help_of({"help", "saphira", {"--robot"}});
  int checked = 0;
  for (const Shown& one : all) {
    if (of_the_script.contains(one.words[0]) || !fs::exists(test::program(one.program)))
      continue;
    for (const std::string& word : one.words) {
      std::smatch option;
      if (!std::regex_match(word, option, is_option))
        continue;
      ++checked;
      const std::string help = help_of(one) + (one.program == "saphira" ? of_all : "");
      EXPECT_TRUE(std::regex_search(help, std::regex("[^a-z-]" + option[1].str() + "($|[^a-z-])")))
          << one.file << ": " << one.program << " " << testing::PrintToString(one.words) << ": "
          << option[1];
    }
  }
  EXPECT_GT(checked, 80);
}

// Where the help lists what may follow a command, it lists what the pages show.
TEST(ShownCommands, HaveTheirWords) {
  std::set<std::string> topics;
  bus::for_each_topic([&](const auto& topic) { topics.insert(topic.name); });
  int checked = 0;
  for (const Shown& one : shown()) {
    if (one.program != "saphira" || one.words.size() < 2 || is_example(one.words[1]) ||
        one.words[1].starts_with("-"))
      continue;
    const std::string& command = one.words[0];
    const std::string what = one.file + ": " + testing::PrintToString(one.words);
    if (command == "echo" || command == "write")
      EXPECT_TRUE(topics.contains(one.words[1]) || one.words[1] == "spin") << what;
    else if (command == "map" && one.words.size() > 2 &&
             std::none_of(one.words.begin(), one.words.end(), is_form))
      EXPECT_NO_THROW(cli::check_map_words({one.words.begin() + 1, one.words.end()})) << what;
    else if (std::set<std::string>{"beliefs", "device", "drive", "estop", "knows", "map",
                                   "processes", "security"}
                 .contains(command))
      EXPECT_TRUE(std::regex_search(help_of({one.file, "saphira", {command}}),
                                    std::regex("\\b" + one.words[1] + "\\b")))
          << what;
    else
      continue;
    ++checked;
  }
  EXPECT_GT(checked, 30);
}

/// The result of a line of a shell, with the project's programs in front of the path.
int in_shell(const std::string& line, std::string& said) {
  const test::TempDir folder;
  const std::string bin = fs::path(test::program("saphira")).parent_path().string();
  test::Process shell({"/bin/sh", "-c", "PATH=" + bin + ":$PATH; " + line}, folder.path("said"));
  const int code = shell.wait().value_or(-1);
  said = shell.output();
  return code;
}

// With the files that a person has by then.
TEST(ShownCommands, OfDeploymentsWouldStart) {
  const test::TempDir own;
  for (const char* const folder : {"my-behaviors", "my-activities", "mine"})
    fs::create_directory(own.path(folder));
  for (const char* const map : {"floor.map", "my-floor.map"})
    fs::copy_file(test::source("config/maps/office-floor.map"), own.path(map));
  fs::copy_file(test::source("config/robots/p3dx.p"), own.path("my-robot.p"));
  std::map<std::string, std::string> checks;
  for (const char* const command : {"up", "check"})
    for (const Shown& one : shown(command)) {
      if (one.words.size() < 2 || std::any_of(one.words.begin(), one.words.end(), is_form))
        continue;
      std::string line = "saphira check " + one.words[1];
      for (std::size_t i = 2; i + 1 < one.words.size(); ++i)
        if (one.words[i] == "--set")
          line += " --set " + one.words[i + 1];
      checks[line] = one.file;
    }
  EXPECT_GT(checks.size(), 10U);
  std::string said;
  for (const auto& [line, file] : checks)
    EXPECT_EQ(in_shell("cd " + own.path() + "; " + line, said), 0) << file << ": " << line << "\n"
                                                                   << said;
}

TEST(ShownCommands, OfGoalsAreGoals) {
  std::string files;
  std::vector<maps::Topology> floors;
  for (const char* const folder : {"config/activities", "config/maps", "docs"})
    for (const auto& entry : fs::directory_iterator(test::source(folder))) {
      if (entry.is_regular_file())
        files += read_file(entry.path().string());
      if (entry.path().extension() == ".map")
        floors.emplace_back(maps::load_map(entry.path().string()));
    }
  const auto on_a_map = [&](const std::string& place) {
    return std::any_of(floors.begin(), floors.end(),
                       [&](const maps::Topology& floor) { return floor.place(place).has_value(); });
  };
  const std::set<std::string> built_in{"go_to", "turn_to", "drive", "stop"};
  const std::set<std::string> others{"list", "cancel", "activities"};
  int checked = 0;
  for (const Shown& one : shown("goal")) {
    if (one.words.size() < 2 || others.contains(one.words[1]))
      continue;
    std::vector<std::string> words;
    for (std::size_t i = 1; i < one.words.size() && !one.words[i].starts_with("--"); ++i)
      words.push_back(one.words[i]);
    if (words.empty() || std::any_of(words.begin(), words.end(), is_form))
      continue;
    ++checked;
    v1::Goal goal;
    ASSERT_NO_THROW(goal = cli::parse_request(words)) << one.file << ": goal " << words.front();
    EXPECT_TRUE(built_in.contains(goal.functor) ||
                std::regex_search(files, std::regex("[(]defintention :" + goal.functor + "\\s")))
        << one.file << ": goal " << goal.functor;
    for (const v1::Argument& argument : goal.arguments)
      EXPECT_TRUE(argument.name != "place" || argument.kind != v1::ARGUMENT_TEXT ||
                  argument.text == "nowhere" ||
                  files.find('"' + argument.text + '"') != std::string::npos ||
                  on_a_map(argument.text))
          << one.file << ": no map has " << argument.text;
  }
  EXPECT_GT(checked, 10);
}

TEST(ShownCommands, OfSpeechAreUnderstood) {
  const std::string file = test::source("config/grammars/flakey.grammar");
  const agent_interface::Grammar grammar(read_file(file), file);
  int checked = 0;
  for (const Shown& one : shown("say")) {
    if (one.words.size() != 2 || is_example(one.words[0]))
      continue;
    ++checked;
    const agent_interface::Grammar::Understood understood = grammar.understand(one.words[1]);
    EXPECT_TRUE(understood.addressed && understood.meanings.size() == 1)
        << one.file << ": " << one.words[1];
  }
  EXPECT_GT(checked, 5);
}

// From the first command to the programs of the laptop that have the person's rights.
TEST(ShownCommands, OfSecurityMakeCredentials) {
  for (const char* const page : {"README.md", "docs/security.md"}) {
    const test::TempDir folder;
    fs::create_directories(folder.path("laptop/.config/saphira"));
    fs::create_directory(folder.path("robot"));
    std::string said;
    const auto run = [&](const std::string& home, const std::string& line) {
      return in_shell("unset SAPHIRA_SECURITY XDG_CONFIG_HOME; HOME=" + folder.path(home) +
                          "; export HOME; " + line,
                      said);
    };
    int made = 0;
    for (std::string command : test::commands_of(page)) {
      if (command.starts_with("scp -r ~")) {
        command = test::replaced(command, "scp", "cp");
        command = test::replaced(command, " laptop:", " " + folder.path("laptop/"));
        command = test::replaced(command, " robot:", " " + folder.path("robot/"));
      } else if (command.find("saphira security ") == std::string::npos) {
        continue;
      }
      ++made;
      EXPECT_EQ(run("", test::replaced(command, "./saphira", "saphira")), 0)
          << page << ": " << command << "\n"
          << said;
    }
    EXPECT_GE(made, 3) << page;
    if (page == std::string("README.md"))
      continue;
    EXPECT_EQ(run("laptop", "saphira security check --program console"), 0) << said;
    EXPECT_TRUE(fs::exists(folder.path("robot/credentials/bridge")));
  }
}

/// The command of a fresh clone that has the lists of sources and no sources: it can build nothing.
class EmptyClone : public testing::Test {
 protected:
  EmptyClone() {
    fs::copy_file(test::source("saphira"), dir_.path("saphira"));
    for (const auto& entry : fs::recursive_directory_iterator(test::source("tests/bench")))
      if (entry.path().filename() == "CMakeLists.txt") {
        const fs::path to =
            dir_.path("tests/bench") / fs::relative(entry.path(), test::source("tests/bench"));
        fs::create_directories(to.parent_path());
        fs::copy_file(entry.path(), to);
      }
    fs::create_directories(dir_.path("agents/cli"));
    fs::copy_file(test::source("agents/cli/help.txt"), dir_.path("agents/cli/help.txt"));
  }
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), dir_.path("saphira"));
    test::Process command(std::move(words), dir_.path("out"));
    const int code = command.wait().value_or(-1);
    said_ = command.output();
    return code;
  }

  test::TempDir dir_;
  std::string said_;
};

TEST_F(EmptyClone, NamesTheBenchmarksThatTheDocumentsName) {
  ASSERT_EQ(run({"bench"}), 0) << said_;
  std::set<std::string> names;
  std::istringstream lines(said_);
  for (std::string line; std::getline(lines, line);)
    names.insert(line);
  const std::string text = read_file(test::source("tests/README.md"));
  const std::size_t row = text.find("| `bench` |");
  ASSERT_NE(row, std::string::npos);
  const std::string told = text.substr(row + 11, text.find('\n', row) - row - 11);
  const std::regex name("`([a-z-]+)`");
  int checked = 0;
  for (auto it = std::sregex_iterator(told.begin(), told.end(), name); it != std::sregex_iterator();
       ++it, ++checked)
    EXPECT_TRUE(names.contains((*it)[1])) << (*it)[1];
  EXPECT_GT(checked, 8);
  for (const Shown& one : shown("bench"))
    EXPECT_TRUE(one.words.size() < 2 || is_example(one.words[1]) || names.contains(one.words[1]))
        << one.file << ": bench " << one.words[1];
}

TEST_F(EmptyClone, AnUnknownBenchmarkIsRefusedBeforeAnythingIsBuilt) {
  EXPECT_EQ(run({"bench", "poeple"}), 2) << said_;
  EXPECT_NE(said_.find("no benchmark \"poeple\": did you mean people? expected one of agents"),
            std::string::npos)
      << said_;
  EXPECT_EQ(run({"bench", "xyzzy"}), 2) << said_;
  EXPECT_NE(said_.find("no benchmark \"xyzzy\": expected one of agents"), std::string::npos)
      << said_;
}

}  // namespace
}  // namespace saphira
