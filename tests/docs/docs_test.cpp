#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <tuple>

#include "pages.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/behaviors/folder.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

fs::path source() {
  return test::source("");
}

std::vector<fs::path> documents() {
  std::vector<fs::path> files{source() / "README.md", source() / "CONTRIBUTING.md"};
  for (const auto& entry : fs::directory_iterator(source() / "docs"))
    if (entry.path().extension() == ".md")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Docs, LinksLeadToFilesThatAreThere) {
  const std::regex link(R"(\]\(([^)#:]+)[^):]*\))");
  int links = 0;
  for (const fs::path& file : documents()) {
    const std::string text = read_file(file.string());
    for (auto it = std::sregex_iterator(text.begin(), text.end(), link);
         it != std::sregex_iterator(); ++it, ++links)
      EXPECT_TRUE(fs::exists(file.parent_path() / (*it)[1].str())) << file << ": " << (*it)[1];
  }
  EXPECT_GT(links, 10);
}

// In `...`: paths from the root that are neither examples nor topics.
TEST(Docs, PathsAreThere) {
  const std::regex example(
      "services/spin|idl/spin|/(NAME|SUBCLASS|SUBJECT)[.]|^agents/"
      "(request|answers|solve|solved|events)$");
  const std::regex path(
      R"(`((?:services|idl|bridge|sim|agents|config|tests|docs)/[A-Za-z0-9_./-]+)`)");
  int paths = 0;
  for (const fs::path& file : documents()) {
    const std::string text = read_file(file.string());
    for (auto it = std::sregex_iterator(text.begin(), text.end(), path);
         it != std::sregex_iterator(); ++it, ++paths) {
      const std::string name = (*it)[1];
      if (std::regex_search(name, example))
        continue;
      EXPECT_TRUE(fs::exists(source() / name)) << file << ": " << name;
    }
  }
  EXPECT_GT(paths, 10);
}

TEST(Docs, TheBehaviorsOfTheDocumentAreTaken) {
  const test::TempDir folder;
  std::ofstream(folder.path("slow-down.beh")) << test::block_of("docs/add-a-behavior.md", "");
  std::ofstream(folder.path("keep-middle.beh")) << test::block_of("docs/add-a-behavior.md", "c");
  behaviors::Registry registry = behaviors::load_behaviors(folder.path());
  EXPECT_NE(registry.find("SlowDown"), nullptr);
  EXPECT_NE(registry.find("KeepMiddle"), nullptr);
}

TEST(Docs, TheConfigurationsOfHostsStartTheServer) {
  int hosts = 0;
  for (const test::Block& block : test::blocks_of("docs/language-models.md")) {
    if (block.language != "json")
      continue;
    ++hosts;
    const auto json = nlohmann::json::parse(block.text, nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << block.text;
    const auto& server = json.front().at("saphira");
    EXPECT_EQ(server.contains("url") ? server["url"] : server["args"].back(),
              server.contains("url") ? "http://127.0.0.1:8791/mcp" : "mcp");
  }
  EXPECT_EQ(hosts, 4);
}

/// The name of the only activity in a text.
std::string taken(const std::string& text) {
  const test::TempDir folder;
  std::ofstream(folder.path("one.act")) << text;
  intentions::ActivityFolders folders({folder.path()}, intentions::all_functions(),
                                      intentions::built_in());
  const intentions::ActivityFolders::Reload reload = folders.reload();
  EXPECT_TRUE(reload.errors.empty()) << reload.errors.front();
  return reload.taken.size() == 1 ? reload.taken[0].name : "";
}

TEST(Docs, TheActivitiesOfTheDocumentsAreTaken) {
  EXPECT_EQ(taken(test::block_of("docs/add-an-activity.md", "lisp")), "greet");
  EXPECT_EQ(taken(test::block_of("docs/add-a-behavior.md", "lisp")), "keep-middle");
  const std::string page = read_file(source() / "docs/add-a-behavior.md");
  std::smatch intends;
  ASSERT_TRUE(std::regex_search(page, intends, std::regex(R"(`(\(INTEND :SlowDown [^`]*)`)")));
  EXPECT_EQ(taken("(defintention :slow :goals '(" + intends[1].str() + "))"), "slow");
}

/// All sources and tests; a literal on several lines is one.
std::string sources() {
  std::string all;
  for (const char* const folder : {"agents", "bridge", "idl", "services", "sim"})
    for (const auto& entry : fs::recursive_directory_iterator(source() / folder)) {
      // The texts of tests have whole messages.
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".txt")
        continue;
      std::string text = read_file(entry.path().string());
      for (std::size_t at = text.find("\"\n"); at != std::string::npos;
           at = text.find("\"\n", at)) {
        const std::size_t next = text.find_first_not_of(" \n", at + 1);
        if (next != std::string::npos && text[next] == '"')
          text.erase(at, next + 1 - at);
        else
          at = next;
      }
      all += text;
    }
  return all;
}

// In the tables of troubles; "..." and numbers stand for something, and ": " joins two texts.
TEST(Docs, MessagesAreSaid) {
  const std::string all = sources();
  const std::regex message("`([^`]+)`");
  const std::regex gap(R"([.][.][.]|: |[0-9]+([.][0-9]+)?)");
  int pieces = 0;
  for (const auto& [page, head, column] :
       {std::tuple{"README.md", "| you see |", 1},
        std::tuple{"docs/robots-of-others.md", "| the robot, or the line |", 2}}) {
    const std::string text = read_file((source() / page).string());
    ASSERT_NE(text.find(head), std::string::npos) << page;
    std::istringstream rows(text.substr(text.find(head)));
    for (std::string row; std::getline(rows, row) && row.starts_with("|");) {
      std::istringstream cells(row);
      std::string cell;
      for (int i = 0; i <= column; ++i)
        std::getline(cells, cell, '|');
      for (auto it = std::sregex_iterator(cell.begin(), cell.end(), message);
           it != std::sregex_iterator(); ++it) {
        const std::string said = (*it)[1];
        for (auto piece = std::sregex_token_iterator(said.begin(), said.end(), gap, -1);
             piece != std::sregex_token_iterator(); ++piece, ++pieces) {
          std::string words = piece->str();
          words.erase(0, words.find_first_not_of(' '));
          words.erase(words.find_last_not_of(' ') + 1);
          EXPECT_NE(all.find(words), std::string::npos) << page << ": " << said << ": " << words;
        }
      }
    }
  }
  EXPECT_GT(pieces, 20);
}

}  // namespace
}  // namespace saphira
