// docs/add-a-robot.md and docs/robots-of-others.md, followed: a file of one's own, and the
// simulated robot that it describes.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "lockstep.hpp"
#include "pages.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::test {
namespace {

TEST(OwnRobot, DrivesByACopyOfTheNearestRobotsFile) {
  const TempDir own;
  const std::string file = own.path("my-robot.p");
  std::string text = read_file(source("config/robots/p3dx.p"));
  text = std::regex_replace(text, std::regex("\nSubclass .*"), "\nSubclass my-robot");
  text = std::regex_replace(text, std::regex("\nRobotRadius .*"), "\nRobotRadius 240");
  std::ofstream(file) << text;
  EXPECT_EQ(protocol::find_parameter_file(own.path(), "Pioneer", "My-Robot"), file);

  LockstepSystem system({.world = read_file(source("config/worlds/office.wld")), .robot = file});
  auto descriptions = system.node.reader(bus::topics::kRobotDescription);
  std::uint64_t permitted = 0;
  for (const std::string& command : commands_of("docs/robots-of-others.md")) {
    if (!command.starts_with("saphira goal ")) {
      EXPECT_EQ(command, "saphira up demo --set base=my-robot.p");
      continue;
    }
    std::vector<std::string> words;
    std::istringstream in(command.substr(13));
    for (std::string word; in >> word;)
      words.push_back(word);
    const v1::GoalId id = system.ask(cli::parse_request(words));
    system.permit(permitted += 600);
    const std::optional<v1::GoalStatus> status = system.wait_end(id);
    ASSERT_TRUE(status) << command << system.output();
    EXPECT_EQ(status->state, v1::GOAL_SUCCEEDED) << status->reason << system.output();
  }
  EXPECT_GT(permitted, 0U) << "the page drives";
  std::optional<v1::RobotDescription> description;
  ASSERT_TRUE(wait_until([&] { return (description = descriptions.take_newest()).has_value(); }));
  EXPECT_EQ(description->robot_subclass, "my-robot");
  EXPECT_EQ(description->parameter_file, file);
  EXPECT_NEAR(description->radius, 0.24, 1e-6);
  const std::vector<sim::TraceRow> rows = sim::parse_trace(system.end(), "trace.csv");
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows.back().contacts, 0);
  EXPECT_NEAR((rows.back().pose_in_world.position() - rows.front().pose_in_world.position()).norm(),
              3.0, 0.2);
}

}  // namespace
}  // namespace saphira::test
