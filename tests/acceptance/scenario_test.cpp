// The paper's story in lockstep: it ends as its cast requires, without a contact, and the same seed
// gives the same story and the same trajectory.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "process.hpp"

namespace saphira::test {
namespace {

nlohmann::json scenario(const std::vector<std::string>& options) {
  const TempDir folder;
  std::vector<std::string> argv{"saphira", "scenario", "--lockstep", "--json"};
  argv.insert(argv.end(), options.begin(), options.end());
  Process process(argv, folder.path("output"));
  EXPECT_TRUE(process.wait(std::chrono::minutes(8)).has_value()) << process.output();
  const std::string text = process.output();
  const nlohmann::json result = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  EXPECT_TRUE(result.is_object()) << text;
  return result;
}

class Story : public testing::TestWithParam<const char*> {};

TEST_P(Story, EndsAsItsCastSays) {
  const nlohmann::json result = scenario({"--cast", GetParam(), "--seed", "1", "--seeds", "2"});
  EXPECT_EQ(result.at("runs"), 2);
  EXPECT_EQ(result.at("well"), 2) << result;
  EXPECT_EQ(result.at("contacts"), 0) << result;
}

INSTANTIATE_TEST_SUITE_P(Casts, Story,
                         testing::Values("report", "early", "away", "leak", "knowers"),
                         [](const auto& cast) { return std::string(cast.param); });

TEST(Scenario, IsTheSameEachTime) {
  EXPECT_EQ(scenario({"--cast", "knowers"}), scenario({"--cast", "knowers"}));
}

// Paper 4.4: it follows its supervisor, by its cameras, around a corner and through a door.
TEST(Scenario, ItIsIntroducedToTheOfficeByFollowingItsSupervisor) {
  const nlohmann::json result = scenario({"--cast", "introduction"});
  EXPECT_EQ(result.at("delivered"), 1) << result;
  EXPECT_EQ(result.at("contacts"), 0) << result;
}

TEST(Scenario, WhatWasSaidIsWrittenAsSound) {
  if (!std::filesystem::exists(program("saphira-speech")))
    GTEST_SKIP() << "saphira-speech is not built here";
  const TempDir folder;
  scenario({"--cast", "early", "--audio", folder.path("audio")});
  std::ifstream text(folder.path("audio/dialogue.txt"));
  std::string first;
  std::getline(text, first);
  EXPECT_EQ(first, "alice: Flakey, EJ-247 is Alice's office");
  EXPECT_GT(std::filesystem::file_size(folder.path("audio/001-alice.wav")), 30000U);
  EXPECT_GT(std::filesystem::file_size(folder.path("audio/dialogue.wav")), 300000U);
}

TEST(Scenario, ACastWithAMistakeIsRefusedBeforeAnythingRuns) {
  const TempDir folder;
  const std::string file = folder.path("wrong.people");
  std::ofstream(file) << "PERSON alice EJ-247\nLIKES tea\n";
  Process process({"saphira", "scenario", "--lockstep", "--cast", file}, folder.path("output"));
  EXPECT_EQ(process.wait(std::chrono::seconds(30)), 2) << process.output();
  EXPECT_NE(process.output().find("wrong.people:2:1"), std::string::npos) << process.output();
}

}  // namespace
}  // namespace saphira::test
