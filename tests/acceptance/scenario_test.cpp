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
  std::vector<std::string> words{"scenario", "--lockstep", "--json"};
  words.insert(words.end(), options.begin(), options.end());
  const Outcome played = saphira(words, {}, std::chrono::minutes(8));
  EXPECT_GE(played.code, 0) << played.text;
  const nlohmann::json result =
      nlohmann::json::parse(played.text, nullptr, /*allow_exceptions=*/false);
  EXPECT_TRUE(result.is_object()) << played.text;
  return result;
}

class Story : public testing::TestWithParam<const char*> {};

TEST_P(Story, EndsAsItsCastSays) {
  const nlohmann::json result = scenario({"--cast", GetParam(), "--seed", "1"});
  EXPECT_EQ(result.at("well"), 1) << result;
  EXPECT_EQ(result.at("contacts"), 0) << result;
}

INSTANTIATE_TEST_SUITE_P(Casts, Story,
                         testing::Values("report", "early", "away", "leak", "knowers", "passers"),
                         [](const auto& cast) { return std::string(cast.param); });

TEST(Scenario, IsTheSameEachTime) {
  EXPECT_EQ(scenario({"--cast", "early"}), scenario({"--cast", "early"}));
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
  const Outcome refused = saphira({"scenario", "--lockstep", "--cast", file});
  EXPECT_EQ(refused.code, 2) << refused.text;
  EXPECT_TRUE(has(refused.text, "wrong.people:2:1")) << refused.text;
}

}  // namespace
}  // namespace saphira::test
