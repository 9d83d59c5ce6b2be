// Robots of every generation behind the bridge: it takes the parameter file that each robot names,
// drives it so that its odometry agrees with the true motion, gets its sonars, and uses its
// devices.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "saphira/protocol/parameters.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

class BridgeRobots : public ::testing::TestWithParam<const char*> {};

// In lockstep: a command to drive a distance is sent once, and a pause of the machine would end it.
TEST_P(BridgeRobots, IsConfiguredDrivenAndHeard) {
  Scene scene(true);
  scene.robot_file = std::string(GetParam()) + ".p";
  scene.world =
      "width 20000 height 20000\nposition 10000 10000 0\n8000 8500 12000 8500\n"
      "8000 11500 12000 11500\n";
  scene.start();
  ASSERT_TRUE(scene.until([&] { return scene.description.has_value(); })) << scene.bridge_log();
  const auto robot = protocol::load_parameters(source("config/robots/" + scene.robot_file));
  EXPECT_TRUE(scene.description->parameter_file.ends_with("/" + scene.robot_file))
      << scene.description->parameter_file;
  EXPECT_EQ(scene.description->robot_class, robot.robot_class);
  EXPECT_EQ(scene.description->sonars.size(), robot.sonars.size());
  EXPECT_EQ(scene.description->radius, robot.radius);
  EXPECT_EQ(scene.description->max_velocity, robot.max_velocity);

  // A third of a metre and a quarter turn, by the robot's own count and by the true pose. Slowly:
  // the smallest robot reaches 0.1 m/s.
  const double speed = std::min(0.25, 0.8 * scene.description->max_velocity);
  scene.command.translation = v1::TRANSLATION_POSITION;
  scene.command.distance = 0.33;
  scene.command.velocity = speed;
  scene.command.move = 1;
  scene.permit(1000);
  ASSERT_TRUE(scene.until([&] { return scene.state.pose_in_odom.x > 0.3 && scene.rests(); }))
      << scene.bridge_log();
  EXPECT_NEAR(scene.state.pose_in_odom.x, 0.33, 0.03);
  EXPECT_EQ(scene.state.stamp.epoch, scene.description->stamp.epoch);
  const std::uint64_t driven = scene.state.stamp.cycle;
  scene.command.translation = v1::TRANSLATION_NONE;
  scene.command.rotation = v1::ROTATION_HEADING;
  scene.command.heading = kPi / 2;
  ASSERT_TRUE(scene.until([&] {
    return std::abs(scene.state.pose_in_odom.th - kPi / 2) < radians(3.0) && scene.rests();
  })) << scene.state.pose_in_odom.th;
  const std::uint64_t turned = scene.state.stamp.cycle;
  std::set<int> heard;
  for (const v1::RobotState& state : scene.states)
    for (const v1::SonarReading& reading : state.sonars)
      heard.insert(reading.sonar);
  EXPECT_EQ(heard.size(), scene.description->sonars.size()) << "every sonar fires";
  EXPECT_EQ(scene.state.bad_packets, 0U);
  EXPECT_GT(scene.state.battery, 4.0);
  EXPECT_TRUE(scene.devices.unread_packets.empty());
  const std::vector<sim::TraceRow> rows = scene.end();
  ASSERT_GE(rows.size(), turned);
  EXPECT_NEAR(rows[driven - 1].pose_in_world.x - 10.0, 0.33, 0.05) << rows[driven - 1].cycle;
  EXPECT_NEAR(rows[turned - 1].pose_in_world.th, kPi / 2, radians(6.0)) << rows[turned - 1].cycle;
}

INSTANTIATE_TEST_SUITE_P(All, BridgeRobots,
                         ::testing::Values("psos43m", "pionat", "p2dx", "p2at8+", "p3dx", "p3dx-sh",
                                           "p3at-sh", "amigo", "amigo-sh", "peoplebot-sh",
                                           "powerbot-sh", "b14", "b21", "khepera"),
                         [](const auto& each) {
                           std::string name = each.param;
                           for (char& c : name)
                             c = c == '-' ? '_' : c == '+' ? 'p' : c;
                           return name;
                         });

TEST(BridgeDevices, FromTheCommandLine) {
  Scene scene;
  scene.robot_file = "p3dx-sh.p";
  scene.start();
  ASSERT_TRUE(scene.until([&] { return scene.connected(); })) << scene.bridge_log();
  const auto run = [&](std::vector<std::string> words, int code) {
    words.insert(words.begin(), "device");
    const Outcome outcome = saphira(words, {{"SAPHIRA_ROBOT", scene.robot}});
    EXPECT_EQ(outcome.code, code) << outcome.text;
    return outcome.text;
  };
  EXPECT_NE(run({"output", "0x21"}, 0).find("output 0x21: the robot shows it"), std::string::npos);
  EXPECT_NE(run({"timer", "3"}, 0).find("timer 3: sent"), std::string::npos);
  EXPECT_NE(run({"sonar", "on", "63"}, 1).find("refused; the robot has no sonar 63"),
            std::string::npos);
  EXPECT_NE(run({"motors", "maybe"}, 2).find("expected on or off"), std::string::npos);
  const std::string all = run({}, 0);
  EXPECT_NE(all.find("0b00100001"), std::string::npos) << all;
  EXPECT_NE(all.find("timer 3: sent"), std::string::npos) << all;
}

}  // namespace
}  // namespace saphira::test
