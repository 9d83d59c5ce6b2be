#include "saphira/base/places.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

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

TEST(Places, AFolderIsNoFile) {
  for (const auto& [path, found] : {std::pair("/tmp", "a folder"), {"/dev/null", "a device"}})
    try {
      find_file(kRobots, path, ".p");
      FAIL() << "found";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), path + std::string(": expected a file, found ") + found);
    }
}

TEST(Places, APathIsNoShippedName) {
  for (const auto& [path, said] :
       {std::pair(std::string("/tmp/nowhere/pioneer.p"), std::string()),
        {kRobots + "/pionere.p", ": did you mean " + kRobots + "/pioneer.p?"}})
    try {
      find_file(kRobots, path, ".p");
      FAIL() << "found";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), path + ": there is no such file" + said);
    }
}

TEST(Places, WhatIsNotThereIsAnErrorThatListsWhatIs) {
  try {
    find_file(kRobots, "nonesuch", ".p");
    FAIL() << "found";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("no \"nonesuch\" in " + kRobots), std::string::npos) << text;
    EXPECT_NE(text.find(" pioneer"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace saphira
