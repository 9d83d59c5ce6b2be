#include "saphira/security/roles.hpp"

#include <gtest/gtest.h>

#include <random>

#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::security {
namespace {

const std::vector<std::string> kTopics{"drive/teleop", "robot/state"};

constexpr const char* kGood = R"(roles:
  bridge:
    about: beside the robot
    programs: [bridge]
  operator:
    about: a person
topics:
  robot/state: {write: [bridge], read: [any]}
  drive/teleop: {write: [operator], read: [bridge]}
)";

std::string replaced(const std::string& what, const std::string& by) {
  std::string text = kGood;
  return text.replace(text.find(what), what.size(), by);
}

TEST(Roles, SayWhichMayWriteAndRead) {
  const Roles roles = parse_roles(kGood, "roles.yaml", kTopics);
  EXPECT_TRUE(roles.may_write("bridge", "robot/state"));
  EXPECT_FALSE(roles.may_write("operator", "robot/state"));
  EXPECT_TRUE(roles.may_read("operator", "robot/state"));
  EXPECT_TRUE(roles.may_read("bridge", "robot/state"));
  EXPECT_FALSE(roles.may_read("operator", "drive/teleop"));
  EXPECT_EQ(roles.those_that_read("robot/state"), "bridge, operator");
  ASSERT_NE(roles.of_program("bridge"), nullptr);
  EXPECT_EQ(roles.of_program("bridge")->name, "bridge");
  EXPECT_EQ(roles.of_program("cli"), nullptr);
}

TEST(Roles, ASealMayBeRequired) {
  const auto parsed = [](const std::string& more) {
    return parse_roles(std::string(kGood) + more, "roles.yaml", kTopics);
  };
  EXPECT_FALSE(parsed("").seal_required);
  EXPECT_TRUE(parsed("seal: required\n").seal_required);
  EXPECT_THROW(parsed("seal: preferred\n"), FileError);
}

TEST(Roles, WhatIsNotWrittenIsRefused) {
  const Roles roles = parse_roles(kGood, "roles.yaml", kTopics);
  EXPECT_FALSE(roles.may_read("bridge", "other"));
  EXPECT_FALSE(roles.may_read("other", "robot/state"));
  EXPECT_FALSE(roles.may_write("", "robot/state"));
}

struct Mistake {
  const char* what;
  const char* by;
  const char* place;  ///< line:column
  const char* message;
};

TEST(Roles, MistakesAreToldWithTheirPlace) {
  for (const Mistake& mistake : {
           Mistake{"robot/state:", "robot/stat:", "8:3", "did you mean robot/state?"},
           Mistake{"  robot/state: {write: [bridge], read: [any]}\n", "", "8:3",
                   "the topic robot/state is missing"},
           Mistake{"[operator]", "[oprator]", "9:26", "did you mean operator?"},
           Mistake{"read: [any]", "reads: [any]", "8:34", "did you mean read?"},
           Mistake{", read: [bridge]", "", "9:3", "expected read: [roles]"},
           Mistake{"[any]", "any", "8:40", "expected a list of roles"},
           Mistake{"  operator:", "  bridge:", "5:3", "is there already"},
           Mistake{"  operator:", "  any:", "5:3", "expected the name of a role"},
           Mistake{"    about: a person\n", "    programs: [x]\n", "5:3", "expected about:"},
           Mistake{"about: a person", "about: a person\n    programs: [bridge]", "7:16",
                   "bridge has the role bridge"},
           Mistake{"topics:", "topic:", "1:1", "expected roles: and topics:"},
           Mistake{"[any]}", "[any]", "9:", "not YAML"},
       }) {
    const std::string text = saphira::test::trouble_of<FileError>(
        [&] { parse_roles(replaced(mistake.what, mistake.by), "roles.yaml", kTopics); });
    EXPECT_TRUE(saphira::test::has(text, mistake.message)) << text;
    EXPECT_TRUE(text.starts_with("roles.yaml:" + std::string(mistake.place)))
        << mistake.message << "\n"
        << text;
  }
}

TEST(Roles, TheShippedFileCoversTheContract) {
  const std::string file = config_folder() + "/security/roles.yaml";
  const Roles roles = parse_roles(read_file(file), file, topics_of_contract());
  EXPECT_EQ(roles.topics.size(), topics_of_contract().size());
  for (const TopicRule& rule : roles.topics) {
    EXPECT_FALSE(rule.writers.empty()) << rule.topic;
    EXPECT_FALSE(rule.readers.empty()) << rule.topic;
    // People open the address of a page: not everybody's word counts.
    const bool own = rule.topic.starts_with("system/") && rule.topic != "system/page";
    EXPECT_EQ(rule.writers.contains("observer"),
              own || rule.topic == "drive/stop" || rule.topic == "audit")
        << rule.topic;
    EXPECT_EQ(rule.writers.contains("recorder"), own) << rule.topic;
    EXPECT_TRUE(rule.readers.contains("recorder")) << rule.topic;
    for (const auto* const roles_of_it : {&rule.writers, &rule.readers}) {
      EXPECT_EQ(roles_of_it->contains("robot"),
                roles_of_it->contains("bridge") || roles_of_it->contains("services"))
          << rule.topic;
    }
  }
  EXPECT_EQ(roles.those_that_write("drive/teleop"), "operator");
}

// As docs/security.md has it, with operator for the page.
TEST(Roles, ARobotsProgramsNeedTheRolesBridgeAndServicesAlone) {
  const std::string file = config_folder() + "/security/roles.yaml";
  const Roles roles = parse_roles(read_file(file), file, topics_of_contract());
  const std::string folder = config_folder() + "/deployments";
  int found = 0;
  for (const std::string& name : names_in(folder, ".yaml")) {
    const std::string deployment = read_file(folder + "/" + name + ".yaml");
    for (const Role& role : roles.roles)
      for (const std::string& program : role.programs)
        if (deployment.find("saphira-" + program + "\n") != std::string::npos ||
            deployment.find("saphira-" + program + " ") != std::string::npos) {
          ++found;
          EXPECT_TRUE(role.name == "bridge" || role.name == "services") << name << ": " << program;
        }
  }
  EXPECT_GT(found, 40);
}

// A damaged file is taken, or refused with line and column.
TEST(Roles, DamagedFilesAreToldNotTaken) {
  const std::string file = config_folder() + "/security/roles.yaml";
  const std::string good = read_file(file);
  std::mt19937 random(16);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  for (int i = 0; i < 400; ++i) {
    std::string text = good;
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(at, below(40));
          break;
        case 2:
          text.insert(at, std::string(1 + below(3), "[]{}:,&*#\n \t-\"'"[below(15)]));
          break;
        default:
          text.resize(at + 1);
      }
      if (text.empty())
        text = ":";
    }
    try {
      const Roles roles = parse_roles(text, file, topics_of_contract());
      EXPECT_EQ(roles.topics.size(), topics_of_contract().size()) << text;
    } catch (const FileError& error) {
      EXPECT_GE(error.line(), 1);
      EXPECT_GE(error.column(), 1);
    }
  }
}

}  // namespace
}  // namespace saphira::security
