// An agent of somebody else, from nothing but the installed tree: installed, configured, built and
// run against the service and a scripted robot.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "process.hpp"
#include "scripted_bus.hpp"

namespace saphira::intentions {
namespace {

using std::chrono::milliseconds;

std::string build_folder() {
  const char* const folder = std::getenv("SAPHIRA_BUILD_DIR");
  return folder == nullptr ? "" : folder;
}

/// An entry of the CMake cache of this build, so that the agent is built the same way.
std::string cached(const std::string& name) {
  std::ifstream cache(build_folder() + "/CMakeCache.txt");
  for (std::string line; std::getline(cache, line);) {
    if (line.starts_with(name + ":"))
      return line.substr(line.find('=') + 1);
  }
  return {};
}

TEST(ExampleAgent, IsBuiltFromTheInstalledTreeAndSendsTheRobot) {
  const test::TempDir dir;
  const auto run = [&](const std::vector<std::string>& command) {
    test::Process process(command, dir.path("log"));
    const auto code = process.wait(std::chrono::minutes(5));
    ASSERT_EQ(code, std::optional<int>(0)) << command[0] << ": " << process.output();
  };
  const std::string prefix = dir.path("installed");
  const std::string build = dir.path("build");
  run({"/usr/bin/env", "cmake", "--install", build_folder(), "--prefix", prefix});
  const std::string sanitize = cached("SAPHIRA_SANITIZE");
  run({"/usr/bin/env", "cmake", "-S", test::source("agents/examples/go_there"), "-B", build, "-G",
       "Ninja", "-DCMAKE_PREFIX_PATH=" + prefix,
       "-DCMAKE_CXX_COMPILER=" + cached("CMAKE_CXX_COMPILER"),
       "-DCMAKE_CXX_FLAGS=" + (sanitize.empty() ? "" : "-fsanitize=" + sanitize)});
  run({"/usr/bin/env", "cmake", "--build", build});
  if (HasFatalFailure())
    return;

  bus::NodeOptions options;
  options.name = "robot";
  options.robot = test::unique_robot();
  options.domain = static_cast<std::uint32_t>(std::stoul(test::domain()));
  const std::map<std::string, std::string> environment = {{"SAPHIRA_ROBOT", options.robot},
                                                          {"SAPHIRA_DOMAIN", test::domain()}};
  test::Process service({prefix + "/bin/saphira-intentions"}, dir.path("service.log"), environment);
  bus::Node node(options);
  ScriptedBus robot(node);
  test::Process agent({build + "/go_there", "1.0", "0.5"}, dir.path("agent.log"), environment);
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

  // A wrong argument is the agent's failure, with the reason.
  test::Process wrong({build + "/go_there", "1e6", "0"}, dir.path("wrong.log"), environment);
  EXPECT_EQ(wrong.wait(), std::optional<int>(1));
  EXPECT_NE(wrong.output().find("refused: argument \"position\": expected a point"),
            std::string::npos)
      << wrong.output();
}

}  // namespace
}  // namespace saphira::intentions
