// Our bridge and simulator under the protocol checker.

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "process.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

// All traffic between bridge and simulator, from the synchronization to the end.
TEST(UnderTheChecker, BridgeAndSimulatorKeepToTheTables) {
  Scene scene;
  scene.robot_file = "p3dx-sh.p";
  scene.start_simulator();
  ASSERT_TRUE(wait_until([&] { return ::access(scene.folder.path("robot").c_str(), F_OK) == 0; }));
  Process checker({"saphira-protocol-check", "--listen", scene.folder.path("watched"), "--server",
                   scene.folder.path("robot"), "--robots", source("config/robots")},
                  scene.folder.path("checker.log"));
  scene.robot_port = scene.folder.path("watched");
  scene.start_bridge();
  ASSERT_TRUE(scene.until([&] { return scene.connected(); })) << scene.bridge_log();
  forward(scene.command, 0.15, 0.2);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.pose_in_odom.x > 0.3; })) << scene.bridge_log();
  scene.drives = false;
  ASSERT_TRUE(scene.until([&] { return scene.rests(); }));
  scene.bridge->signal(SIGTERM);
  scene.bridge->wait();
  checker.signal(SIGTERM);
  EXPECT_EQ(checker.wait(), 0) << checker.output();
  EXPECT_NE(checker.output().find("x VEL (11)"), std::string::npos) << checker.output();
  EXPECT_NE(checker.output().find("0 violations"), std::string::npos) << checker.output();
}

}  // namespace
}  // namespace saphira::test
