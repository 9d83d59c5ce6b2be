// A line that damages bytes: the robot executes only commands that were sent, and the bridge
// publishes no implausible state.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "noise.hpp"
#include "saphira/base/random.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

TEST(BridgeNoise, NoWrongCommandIsActedOn) {
  Scene scene;
  scene.robot_port = scene.folder.path("line");
  scene.bridge_options = {"--no-guard"};  // which would add speeds of its own
  scene.start_simulator();
  ASSERT_TRUE(
      wait_until([&] { return scene.simulator->output().find("listening") != std::string::npos; }));
  NoisyLine line(scene.robot_port, scene.folder.path("robot"), 42);
  scene.start_bridge();
  // Whole numbers of the packet's units, so that executed commands can be compared exactly.
  Random random(7);
  std::set<int> speeds{0};
  std::set<int> turns{0};
  scene.command.translation = v1::TRANSLATION_VELOCITY;
  scene.command.rotation = v1::ROTATION_VELOCITY;
  scene.command.velocity = 0.2;
  speeds.insert(200);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.velocity > 0.18; })) << scene.bridge_log();
  EXPECT_EQ(scene.simulator->violations(), "");
  scene.simulator->expect_violations();
  line.set_probability(0.1, 0.0);
  int moved = 0;
  for (int leg = 0; leg < 24; ++leg) {
    const int speed = static_cast<int>(random.next() % 9) * 50 - 200;
    const int turn = static_cast<int>(random.next() % 9) * 10 - 40;
    speeds.insert(speed);
    turns.insert(turn);
    scene.command.velocity = speed * 0.001;
    scene.command.rotation_velocity = radians(turn);
    scene.watch(std::chrono::milliseconds(500));
    if (!scene.rests())
      ++moved;
  }
  EXPECT_TRUE(scene.bridge->running()) << scene.bridge_log();
  EXPECT_TRUE(scene.simulator->running());
  EXPECT_GT(line.hurt(), 50U);
  EXPECT_NE(scene.simulator->violations(), "") << "the checker listens";
  EXPECT_GT(moved, 12) << "where the robot is heard it still drives";

  const auto rows = scene.whole_trace();
  int executed = 0;
  for (const sim::TraceRow& row : rows) {
    const int speed = static_cast<int>(std::lround(row.set_velocity * 1000.0));
    ASSERT_TRUE(speeds.contains(speed)) << "cycle " << row.cycle << ": nobody sent " << speed;
    ASSERT_NEAR(row.set_velocity * 1000.0, speed, 1e-6);
    ASSERT_TRUE(std::isnan(row.set_heading)) << "nobody sent a heading";
    const int turn = static_cast<int>(std::lround(degrees(row.set_rotation_velocity)));
    ASSERT_TRUE(turns.contains(turn)) << "cycle " << row.cycle << ": nobody sent " << turn;
    executed += speed != 0;
  }
  EXPECT_GT(executed, 0);
  std::printf(
      "%zu bytes hurt, %zu of %zu cycles seen, %d cycles driven, %u bad "
      "packets\n",
      static_cast<std::size_t>(line.hurt()), scene.states.size(), rows.size(), executed,
      scene.state.bad_packets);

  // The states on the bus are plausible: no jump of the pose, no impossible speed.
  const v1::RobotState* last = nullptr;
  for (const v1::RobotState& state : scene.states) {
    ASSERT_LT(std::abs(state.velocity), 0.45);
    if (last != nullptr && last->stamp.epoch == state.stamp.epoch && last->odom == state.odom) {
      ASSERT_LT(std::hypot(state.pose_in_odom.x - last->pose_in_odom.x,
                           state.pose_in_odom.y - last->pose_in_odom.y),
                0.8);
    }
    last = &state;
  }
}

}  // namespace
}  // namespace saphira::test
