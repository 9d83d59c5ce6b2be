// The commands in documents and comments can be typed as shown.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/deployment.hpp"
#include "saphira/cli/goal_words.hpp"

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
  std::vector<std::string> words;  ///< behind `saphira`
};

/// The commands that begin with saphira: in `...`, in an indented line, in a line of a fence, or in
/// a comment of a deployment.
std::vector<Shown> shown() {
  const std::regex quoted(R"(`(?:\./)?saphira ([^`]+)`)");
  const std::regex line_of_its_own(R"(^(?:#?\s+|\$ )?(?:\./)?saphira ([a-z][^#]*))");
  std::vector<Shown> all;
  for (const fs::path& file : files_with_commands()) {
    const std::string text = read_file(file.string());
    const auto add = [&](const std::string& command) {
      Shown one{file.string(), {}};
      std::istringstream words(command);
      for (std::string word; words >> word && word != "|" && word != "&&" && word != ">";)
        one.words.push_back(word);
      all.push_back(std::move(one));
    };
    for (auto it = std::sregex_iterator(text.begin(), text.end(), quoted);
         it != std::sregex_iterator(); ++it)
      add((*it)[1]);
    std::istringstream lines(text);
    std::smatch found;
    for (std::string line; std::getline(lines, line);)
      if (std::regex_search(line, found, line_of_its_own))
        add(found[1]);
  }
  return all;
}

/// True for NAME, N, FILE.svg, [-d] and ..., which a person replaces.
bool is_example(const std::string& word) {
  return std::any_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; }) ||
         word.find_first_of("[<|") != std::string::npos || word.find("...") != std::string::npos;
}

bool has_example(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), is_example);
}

TEST(ShownCommands, AreThere) {
  const std::set<std::string> known = commands();
  ASSERT_GT(known.size(), 15U);
  int checked = 0;
  for (const Shown& one : shown()) {
    const std::string& command = one.words.front();
    if (is_example(command) || command.starts_with("-"))
      continue;
    ++checked;
    EXPECT_TRUE(known.contains(command)) << one.file << ": saphira " << command;
  }
  EXPECT_GT(checked, 50);
}

TEST(ShownCommands, OfDeploymentsHaveTheirSettings) {
  cli::Places places;
  places.bin = test::source("saphira");
  places.config = test::source("config");
  places.run = "/tmp/run";
  int checked = 0;
  for (const Shown& one : shown()) {
    if (one.words.front() != "up" || one.words.size() < 2 || is_example(one.words[1]))
      continue;
    std::vector<std::string> set;
    for (std::size_t i = 2; i + 1 < one.words.size(); ++i)
      if (one.words[i] == "--set" && one.words[i + 1].find('=') != std::string::npos)
        set.push_back(one.words[i + 1].substr(0, one.words[i + 1].find('=')));
    const std::string file = test::source("config/deployments/" + one.words[1] + ".yaml");
    ASSERT_TRUE(fs::exists(file)) << one.file << ": saphira up " << one.words[1];
    const cli::Deployment deployment = cli::load_deployment(file);
    for (const std::string& setting : set)
      EXPECT_TRUE(deployment.settings.contains(setting))
          << one.file << ": " << one.words[1] << " has no setting " << setting;
    ++checked;
  }
  EXPECT_GT(checked, 5);
}

TEST(ShownCommands, OfGoalsAreGoals) {
  const std::set<std::string> others{"list", "cancel", "activities"};
  int checked = 0;
  for (const Shown& one : shown()) {
    if (one.words.front() != "goal" || one.words.size() < 2 || others.contains(one.words[1]))
      continue;
    std::vector<std::string> words;
    for (std::size_t i = 1; i < one.words.size() && !one.words[i].starts_with("--"); ++i)
      words.push_back(one.words[i]);
    if (has_example(words) || words.empty())
      continue;
    ++checked;
    EXPECT_NO_THROW(cli::parse_request(words)) << one.file << ": goal " << words.front();
  }
  EXPECT_GT(checked, 3);
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
  EXPECT_GT(checked, 20);
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
