// An agent of somebody else, from nothing but the installed tree: installed, configured, built and
// run against the service and a scripted robot.

#include <gtest/gtest.h>

#include "installed.hpp"
#include "node_options.hpp"
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

  // A wrong argument is the agent's failure, with the reason.
  test::Process wrong({build + "/go_there", "1e6", "0"}, installed.path("wrong.log"), environment);
  EXPECT_EQ(wrong.wait(), std::optional<int>(1));
  EXPECT_NE(wrong.output().find("refused: argument \"position\": expected a point"),
            std::string::npos)
      << wrong.output();
}

}  // namespace
}  // namespace saphira::intentions
