#include "saphira/base/places.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "trouble.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

std::string source() {
  const char* folder = std::getenv("SAPHIRA_SOURCE_DIR");
  return folder == nullptr ? "" : folder;
}

const std::string kRobots = config_folder() + "/robots";

TEST(Places, ConfigIsTheSourceTreesUntilInstalled) {
  EXPECT_TRUE(fs::equivalent(config_folder(), fs::path(source()) / "config"));
  EXPECT_TRUE(fs::is_directory(program_folder()));
}

TEST(Places, AShippedFileIsFoundByItsName) {
  EXPECT_EQ(fs::path(find_file(kRobots, "pioneer", ".p")).filename(), "pioneer.p");
  EXPECT_EQ(fs::path(find_file(kRobots, "pioneer.p", ".p")).filename(), "pioneer.p");
}

TEST(Places, APathIsTakenAsItIs) {
  const std::string path = source() + "/config/robots/pioneer.p";
  EXPECT_EQ(find_file(kRobots, path, ".p"), path);
}

std::string trouble(const std::string& name) {
  return test::trouble_of<std::invalid_argument>([&] { find_file(kRobots, name, ".p"); });
}

TEST(Places, AFolderIsNoFile) {
  for (const auto& [path, found] : {std::pair("/tmp", "a folder"), {"/dev/null", "a device"}})
    EXPECT_EQ(trouble(path), path + std::string(": expected a file, found ") + found);
}

TEST(Places, APathIsNoShippedName) {
  for (const auto& [path, said] :
       {std::pair(std::string("/tmp/nowhere/pioneer.p"), std::string()),
        {kRobots + "/pionere.p", ": did you mean " + kRobots + "/pioneer.p?"}})
    EXPECT_EQ(trouble(path), path + ": there is no such file" + said);
}

TEST(Places, WhatIsNotThereIsAnErrorThatListsWhatIs) {
  const std::string text = trouble("nonesuch");
  EXPECT_NE(text.find("no \"nonesuch\" in " + kRobots), std::string::npos) << text;
  EXPECT_NE(text.find(" pioneer"), std::string::npos) << text;
}

}  // namespace
}  // namespace saphira
