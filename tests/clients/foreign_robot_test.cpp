// Our bridge with strict robots: a third-party simulator, and ours under the protocol checker.

#include "foreign_robot.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "saphira/geometry/pose.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

using std::chrono::seconds;

class ForeignRobotTest : public ::testing::Test {
 protected:
  ForeignRobotTest() {
    scene.robot_port = "tcp:127.0.0.1:" + std::to_string(robot.port());
    scene.start_bridge();
  }

  ForeignRobot robot;
  Scene scene;
};

TEST_F(ForeignRobotTest, IsDrivenByOurBridge) {
  ASSERT_TRUE(scene.until([&] { return scene.connected() && scene.description; }))
      << scene.bridge_log();
  EXPECT_EQ(scene.description->robot_class, "Pioneer");
  EXPECT_TRUE(scene.description->parameter_file.ends_with("/p3dx.p"));
  ASSERT_TRUE(scene.until([&] { return scene.state.sonars.size() == 16; }));
  EXPECT_NEAR(scene.state.sonars[5].range, 3.05, 0.01);
  EXPECT_NEAR(scene.state.battery, 13.0, 1e-6);

  forward(scene.command, 0.25, 0.0);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return robot.velocity() == 250.0; })) << scene.bridge_log();
  EXPECT_TRUE(robot.motors());
  ASSERT_TRUE(scene.until([&] { return scene.state.pose_in_odom.x > 1.0; }));
  EXPECT_NEAR(scene.state.pose_in_odom.x, robot.x() / 1000.0, 0.1);
  forward(scene.command, 0.0, radians(30.0));
  ASSERT_TRUE(scene.until([&] { return scene.state.rotation_velocity > radians(25.0); }));
  EXPECT_NEAR(robot.rotation(), 30.0, 1.0);

  // It has no watchdog: only the bridge stops it.
  scene.drives = false;
  ASSERT_TRUE(scene.until([&] { return robot.velocity() == 0.0 && robot.rotation() == 0.0; }))
      << scene.bridge_log();
  EXPECT_EQ(robot.trouble(), "");
  EXPECT_EQ(scene.state.bad_packets, 0U);
}

TEST_F(ForeignRobotTest, StopsWhenTheBridgeIsKilled) {
  forward(scene.command, 0.2, 0.0);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return robot.velocity() == 200.0; })) << scene.bridge_log();
  scene.bridge->signal(SIGKILL);
  EXPECT_TRUE(scene.until([&] { return robot.velocity() == 0.0; }, seconds(5)));
  EXPECT_EQ(robot.trouble(), "");
}

// Impossible fields, with a right checksum.
TEST_F(ForeignRobotTest, IsStoppedWhileNoneOfItsPacketsCanBeTrue) {
  forward(scene.command, 0.2, 0.0);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.velocity > 0.19; })) << scene.bridge_log();
  const std::uint64_t epoch = scene.state.stamp.epoch;
  robot.spoil([](std::vector<std::uint8_t>& body) {
    body[7] = 0x01;  // the left wheel backward, the right one forward, at the largest speed
    body[8] = 0x80;
    body[9] = 0xFF;
    body[10] = 0x7F;
  });
  // It also waited during the connection.
  ASSERT_TRUE(scene.until([&] {
    return scene.status.state == v1::SERVICE_WAITING &&
           scene.status.reason.find("the robot sends a turn of 183 rad/s") == 0;
  })) << scene.status.reason;
  EXPECT_TRUE(scene.until([&] { return robot.velocity() == 0.0; }));
  // Longer than the limit of a silent link: packets come, so the link is not silent.
  scene.watch(std::chrono::milliseconds(3000));
  EXPECT_EQ(scene.status.reason.find("the robot sends a turn of 183 rad/s"), 0U)
      << scene.status.reason;
  robot.spoil({});
  ASSERT_TRUE(scene.until([&] { return scene.status.state == v1::SERVICE_RUNNING; }))
      << scene.status.reason;
  EXPECT_EQ(scene.state.stamp.epoch, epoch) << "the session went on";
  EXPECT_GT(scene.state.bad_packets, 20U);
  for (const v1::RobotState& state : scene.states)
    EXPECT_LT(std::abs(state.rotation_velocity), 1.0);
  EXPECT_TRUE(scene.until([&] { return robot.velocity() == 200.0; })) << "and so does the drive";
}

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
