#include "saphira/cli/deployment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::cli {
namespace {

constexpr const char* kGood = R"(# a comment
robot: alpha
domain: 7
profile: wan
peers: [192.168.1.20, robot.local]
interface: 192.168.1.4
security: /etc/saphira/credentials
lockstep: true
settings:
  world: "${config}/office.wld"
  seed: 1
programs:
  - program: one
    bus: false
    arguments: [--world, "${world}", --seed, "${seed}", "--socket=${run}/s"]
  - program: one
    name: two
    robot: beta
    arguments: ["${robot}"]
    restart: false
)";

/// A folder with a program "one".
class DeploymentTest : public testing::Test {
 protected:
  DeploymentTest() {
    std::ofstream(folder_ + "/one") << "#!/bin/sh\n";
    std::filesystem::permissions(folder_ + "/one", std::filesystem::perms::owner_all);
    std::ofstream(folder_ + "/data") << "not a program\n";
    places_ = {folder_, "/conf", "/run/x"};
  }

  const test::TempDir temporary_;
  const std::string folder_ = temporary_.path();
  Places places_;
};

TEST_F(DeploymentTest, BecomesCommandLines) {
  const Deployment deployment = parse_deployment(kGood, "good.yaml");
  const auto children = command_lines(deployment, places_, {"seed=42"});
  ASSERT_EQ(children.size(), 2U);
  EXPECT_EQ(children[0].name, "one");
  EXPECT_TRUE(children[0].restart);
  EXPECT_EQ(children[0].argv,
            (std::vector<std::string>{folder_ + "/one", "--world", "/conf/office.wld", "--seed",
                                      "42", "--socket=/run/x/s"}));
  EXPECT_EQ(children[1].name, "two");
  EXPECT_FALSE(children[1].restart);
  EXPECT_EQ(children[1].argv,
            (std::vector<std::string>{folder_ + "/one", "beta", "--robot", "beta", "--domain", "7",
                                      "--profile", "wan", "--peer", "192.168.1.20", "--peer",
                                      "robot.local", "--interface", "192.168.1.4", "--security",
                                      "/etc/saphira/credentials", "--lockstep"}));
}

TEST_F(DeploymentTest, WhatIsNotStatedIsLeftToThePrograms) {
  const auto children = command_lines(parse_deployment("programs: [{program: one}]", "f"), places_);
  EXPECT_EQ(children.at(0).argv, std::vector<std::string>{folder_ + "/one"});
}

TEST_F(DeploymentTest, NamesAreWithoutThePrefix) {
  const Deployment deployment =
      parse_deployment("programs: [{program: saphira-bridge}, {program: ./x/agent}]", "f");
  EXPECT_EQ(deployment.programs[0].name, "bridge");
  EXPECT_EQ(deployment.programs[1].name, "agent");
}

TEST_F(DeploymentTest, APathIsFromTheFile) {
  const auto children = command_lines(
      parse_deployment("programs: [{program: ./one}]", folder_ + "/x.yaml"), {"/nowhere", "", ""});
  EXPECT_EQ(children.at(0).argv.at(0), folder_ + "/./one");
}

TEST_F(DeploymentTest, AnUnknownSettingIsRefused) {
  const Deployment deployment = parse_deployment(kGood, "good.yaml");
  for (const char* word : {"sede=1", "seed", "=1", "config=/"})
    EXPECT_THROW(command_lines(deployment, places_, {word}), std::invalid_argument) << word;
}

constexpr const char* kOptional = R"(settings:
  speech: off
programs:
  - program: one
  - program: saphira-speech
    when: "${speech}"
)";

TEST_F(DeploymentTest, AnOptionalProgramRunsWhereItsSettingIsOn) {
  std::filesystem::copy_file(folder_ + "/one", folder_ + "/saphira-speech");
  const Deployment deployment = parse_deployment(kOptional, "f");
  EXPECT_EQ(command_lines(deployment, places_).size(), 1U);
  for (const char* word : {"speech=on", "speech=true", "speech=yes"})
    EXPECT_EQ(command_lines(deployment, places_, {word}).at(1).name, "speech");
  for (const char* word : {"speech=off", "speech=no"})
    EXPECT_EQ(command_lines(deployment, places_, {word}).size(), 1U);
  EXPECT_TRUE(command_lines(parse_deployment("programs: [{program: one, when: off}]", "f"), places_)
                  .empty());
  for (const std::string word : {"perhaps", ""})
    EXPECT_TRUE(test::has(test::trouble_of<FileError>(
                              [&] { command_lines(deployment, places_, {"speech=" + word}); }),
                          "6:11: expected on or off for ${speech}, found \"" + word + "\""));
}

TEST_F(DeploymentTest, AnOptionalProgramThatIsNotInstalledIsLeftOutWithAWord) {
  const Deployment deployment = parse_deployment(kOptional, "f");
  const std::vector<std::string> on{"speech=on"};
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);  // this machine may have it
  std::vector<std::string> left_out;
  EXPECT_EQ(command_lines(deployment, places_, {}, &left_out).size(), 1U);
  EXPECT_TRUE(left_out.empty());
  EXPECT_EQ(command_lines(deployment, places_, on, &left_out).size(), 1U);
  EXPECT_THROW(command_lines(deployment, places_, on), FileError);
  setenv("PATH", path.c_str(), 1);
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0], "speech is left out: expected a program, found no \"saphira-speech\" in " +
                             folder_ + " or on PATH: " + kInstallSpeech);
  // The others are needed.
  EXPECT_THROW(
      command_lines(parse_deployment("programs: [{program: two}]", "f"), places_, {}, &left_out),
      FileError);
}

TEST(Deployments, AMistakeIsNamedWithItsPlaceAndWhatWasExpected) {
  const int cases =
      test::each_mistake("agents/cli/test/deployments.txt", [](const std::string& text) {
        command_lines(parse_deployment(text, "broken.yaml"), {"/nowhere", "/conf", "/run"});
      });
  EXPECT_EQ(cases, 33);
}

TEST(FindDeployment, NamesWhatThereIs) {
  const Places places{"/nowhere", test::source("config"), ""};
  EXPECT_EQ(find_deployment("demo", places), places.config + "/deployments/demo.yaml");
  EXPECT_EQ(find_deployment("demo.yaml", places), places.config + "/deployments/demo.yaml");
  EXPECT_TRUE(test::has(
      test::trouble_of<std::invalid_argument>([&] { find_deployment("dmeo", places); }), " demo"));
}

TEST(ShippedDeployments, AreAllGood) {
  const Places places{std::filesystem::path(test::program("saphira")).parent_path(),
                      test::source("config"), "/tmp"};
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(places.config + "/deployments")) {
    if (entry.path().extension() != ".yaml")
      continue;
    ++count;
    const Deployment deployment = load_deployment(entry.path().string());
    for (const ChildSpec& child : command_lines(deployment, places)) {
      for (std::size_t i = 1; i < child.argv.size(); ++i) {
        if (child.argv[i].starts_with(places.config)) {
          EXPECT_TRUE(std::filesystem::exists(child.argv[i])) << entry.path() << child.argv[i];
        }
      }
    }
  }
  EXPECT_GE(count, 5);
}

// Each deployment with a dialogue has speech, switched off, with the grammar of the dialogue.
TEST(ShippedDeployments, HearAndSpeakWhereTheyUnderstandSentences) {
  const test::TempDir bin;
  const Places places{bin.path(), test::source("config"), "/tmp"};
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(places.config + "/deployments")) {
    if (entry.path().extension() != ".yaml")
      continue;
    const Deployment deployment = load_deployment(entry.path().string());
    for (const Program& program : deployment.programs) {
      std::ofstream(bin.path(program.program.text)) << "#!/bin/sh\n";
      std::filesystem::permissions(bin.path(program.program.text),
                                   std::filesystem::perms::owner_all);
    }
    const auto argv_of = [](const std::vector<ChildSpec>& children, const std::string& name) {
      for (const ChildSpec& child : children)
        if (child.name == name)
          return child.argv;
      return std::vector<std::string>{};
    };
    const auto grammar = [](const std::vector<std::string>& argv) {
      const auto option = std::ranges::find(argv, "--grammar");
      return option == argv.end() ? "flakey" : *std::next(option);
    };
    const auto usual = command_lines(deployment, places);
    EXPECT_TRUE(argv_of(usual, "speech").empty()) << entry.path();
    const std::vector<std::string> dialogue = argv_of(usual, "dialogue");
    EXPECT_EQ(deployment.settings.contains("speech"), !dialogue.empty()) << entry.path();
    if (dialogue.empty())
      continue;
    ++count;
    const std::vector<std::string> speech = argv_of(
        command_lines(deployment, places, {"speech=on", "microphone=hw:1", "loudspeaker=none"}),
        "speech");
    ASSERT_FALSE(speech.empty()) << entry.path();
    EXPECT_EQ(grammar(speech), grammar(dialogue)) << entry.path();
    for (const auto& [option, value] :
         std::map<std::string, std::string>{{"--microphone", "hw:1"}, {"--speaker", "none"}}) {
      const auto found = std::ranges::find(speech, option);
      ASSERT_NE(found, speech.end()) << entry.path() << option;
      EXPECT_EQ(*std::next(found), value) << entry.path();
    }
  }
  EXPECT_EQ(count, 4);
}

TEST(ServiceSight, FilesInHomesAndInTheSharedTmpAreNamed) {
  const std::string text = hidden_from_service(
      {"/usr/bin/saphira-bridge", "--link", "unix:/tmp/robot", "--map=/home/ann/lab.map", "--state",
       "/tmp/run/bridge.state", "/etc/saphira/home/x", "/dev/ttyUSB0"},
      "/tmp/run");
  EXPECT_EQ(std::ranges::count(text, '\n'), 2) << text;
  EXPECT_NE(text.find("does not see /tmp/robot:"), std::string::npos) << text;
  EXPECT_NE(text.find("does not see /home/ann/lab.map:"), std::string::npos) << text;
}

TEST(ServiceSight, ADeviceThatIsNotThereIsNotClosed) {
  EXPECT_EQ(closed_devices({"--link", "/dev/null", "/dev/none@19200", "/dev/tty/none"}), "");
}

}  // namespace
}  // namespace saphira::cli
