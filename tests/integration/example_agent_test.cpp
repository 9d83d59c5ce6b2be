// A third-party agent, from the installed tree only: installed, configured, built and run against
// the service and a scripted robot.

#include <gtest/gtest.h>

#include <memory>
#include <sstream>

#include "installed.hpp"
#include "node_options.hpp"
#include "saphira/base/text.hpp"
#include "scripted_bus.hpp"

namespace saphira::intentions {
namespace {

using std::chrono::milliseconds;

TEST(ExampleAgent, IsBuiltFromTheInstalledTreeAndSendsTheRobot) {
  const test::Installed installed;
  const std::string build = installed.build("agents/examples/go_there");
  if (HasFatalFailure())
    return;

  const bus::NodeOptions options = test::node_options("robot", test::unique_robot());
  const std::map<std::string, std::string> environment = {{"SAPHIRA_ROBOT", options.robot},
                                                          {"SAPHIRA_DOMAIN", test::domain()}};
  test::Process service({installed.program("saphira-intentions")}, installed.path("service.log"),
                        environment);
  bus::Node node(options);
  ScriptedBus robot(node);
  test::Process agent({build + "/go_there", "1.0", "0.5"}, installed.path("agent.log"),
                      environment);
  EXPECT_TRUE(test::wait_until([&] {
    robot.publish_state();
    for (int i = 0; i < 10 && !robot.act(); ++i)
      node.wait(milliseconds(10));
    return !agent.running();
  })) << service.output();
  EXPECT_EQ(agent.wait(milliseconds(1000)), std::optional<int>(0)) << agent.output();
  EXPECT_NE(agent.output().find("underway: driving to (1.00, 0.50)"), std::string::npos)
      << agent.output();
  EXPECT_NE(agent.output().find("succeeded: arrived"), std::string::npos) << agent.output();
  EXPECT_LE((robot.world.robot.pose_in_odom.position() - Vec2(1.0, 0.5)).norm(), 0.15);

  // A wrong argument is a failure of the agent, with the reason.
  test::Process wrong({build + "/go_there", "1e6", "0"}, installed.path("wrong.log"), environment);
  EXPECT_EQ(wrong.wait(), std::optional<int>(1));
  EXPECT_NE(wrong.output().find("refused: argument \"position\": expected a point"),
            std::string::npos)
      << wrong.output();
}

/// The commands of a document, without comments, in order.
std::vector<std::string> commands_of(const std::string& file) {
  std::vector<std::string> commands;
  std::istringstream in(read_file(file));
  bool shell = false;
  for (std::string line; std::getline(in, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos)
      continue;
    line.erase(0, begin);
    if (line.starts_with("```"))
      shell = line == "```sh";
    else if (shell)
      commands.push_back(line.substr(0, line.find(" #")));
  }
  return commands;
}

TEST(ExampleAgent, TheTenMinutesOfTheDocumentWorkAsTheyAreWritten) {
  const test::TempDir folder;
  const std::string build = test::Installed::build_folder();
  const std::string sanitize = test::Installed::cached("SAPHIRA_SANITIZE");
  const std::map<std::string, std::string> environment = {
      {"SAPHIRA_ROBOT", test::unique_robot()},
      {"SAPHIRA_DOMAIN", test::domain()},
      {"SAPHIRA_RUN", folder.path("run")},
      {"CXXFLAGS", sanitize.empty() ? "" : "-fsanitize=" + sanitize}};
  test::Process up({"saphira", "up", "office", "--set", "port=0"}, folder.path("up.log"),
                   environment);
  std::vector<std::unique_ptr<test::Process>> left_running;
  std::string text;
  int asked = 0;
  for (std::string command : commands_of(test::source("docs/write-an-agent.md"))) {
    for (const auto& [written, here] : std::vector<std::pair<std::string, std::string>>{
             {"build/release", build},
             {"./saphira", test::program("saphira")},
             {"~/saphira", folder.path("installed")},
             {"build/calendar", folder.path("calendar")},
             {"agents/examples", test::source("agents/examples")}})
      for (std::size_t at = command.find(written); at != std::string::npos;
           at = command.find(written, at + here.size()))
        command.replace(at, written.size(), here);
    const auto process = [&] {
      return std::make_unique<test::Process>(
          std::vector<std::string>{"/bin/sh", "-c", "exec " + command}, folder.path("log"),
          environment);
    };
    if (command.starts_with(folder.path("calendar"))) {
      left_running.push_back(process());
      continue;
    }
    const bool asks = command.find(" ask ") != std::string::npos;
    // Before the agent's start the request fails; just after, the agent may not be discovered yet.
    const int expected = asks && asked++ == 0 ? 1 : 0;
    EXPECT_TRUE(test::wait_until([&] {
      const auto one = process();
      const std::optional<int> code = one->wait(std::chrono::minutes(5));
      text = one->output();
      return code == expected;
    })) << command
        << "\n"
        << text;
  }
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(left_running.size(), 1U);
  EXPECT_NE(text.find("library"), std::string::npos) << text;
}

}  // namespace
}  // namespace saphira::intentions
