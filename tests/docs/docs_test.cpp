#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>

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
  const char* const folder = std::getenv("SAPHIRA_SOURCE_DIR");
  if (folder == nullptr)
    throw std::runtime_error("SAPHIRA_SOURCE_DIR: expected the folder of the sources");
  return folder;
}

std::vector<fs::path> documents() {
  std::vector<fs::path> files{source() / "README.md", source() / "CONTRIBUTING.md"};
  for (const auto& entry : fs::directory_iterator(source() / "docs"))
    if (entry.path().extension() == ".md")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The lines of the fenced block that contains `word`, without their indent; empty: none.
std::string block_with(const fs::path& file, const std::string& word) {
  std::ifstream in(file);
  std::string block;
  std::size_t indent = 0;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const std::size_t fence = line.find("```");
    if (fence == std::string::npos) {
      if (inside)
        block += line.substr(std::min(indent, line.size())) + "\n";
      continue;
    }
    if (inside && block.find(word) != std::string::npos)
      return block;
    inside = !inside;
    indent = fence;
    block.clear();
  }
  return {};
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

TEST(Docs, TheBehaviorOfTheDocumentIsTaken) {
  const test::TempDir folder;
  const std::string text = block_with(source() / "docs/add-a-behavior.md", "BeginBehavior");
  ASSERT_FALSE(text.empty());
  std::ofstream(folder.path("slow-down.beh")) << text;
  behaviors::Registry registry = behaviors::load_behaviors(folder.path());
  EXPECT_NE(registry.find("SlowDown"), nullptr);
}

TEST(Docs, TheActivityOfTheDocumentIsTaken) {
  const test::TempDir folder;
  const std::string text = block_with(source() / "docs/add-an-activity.md", "defintention");
  ASSERT_FALSE(text.empty());
  std::ofstream(folder.path("greet.act")) << text;
  intentions::ActivityFolders folders({folder.path()}, intentions::all_functions(),
                                      intentions::built_in());
  const intentions::ActivityFolders::News news = folders.look();
  EXPECT_TRUE(news.errors.empty()) << news.errors.front();
  ASSERT_EQ(news.taken.size(), 1U);
  EXPECT_EQ(news.taken[0].name, "greet");
}

}  // namespace
}  // namespace saphira
