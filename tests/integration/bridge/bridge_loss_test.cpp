// Each part dies or hangs in turn: the robot stops soon, and everything continues when the part is
// back.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>

#include "scene.hpp"

namespace saphira::test {
namespace {

using std::chrono::milliseconds;

/// A scene whose robot drives at 0.3 m/s.
void start(Scene& scene) {
  scene.start();
  forward(scene.command, 0.3);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.velocity > 0.28; })) << scene.bridge_log();
}

TEST(BridgeLoss, AStoppedBridgeIsSpokenFor) {
  Scene scene;
  // The driver's commands name no cycle, so that the gap does not make them look old.
  scene.follows_cycles = false;
  start(scene);
  scene.bridge->signal(SIGSTOP);
  const std::uint64_t stopped = scene.trace().back().cycle;
  ASSERT_TRUE(scene.until([&] { return stood_still(scene.trace(), stopped) != 0; }));
  const std::uint64_t still = stood_still(scene.trace(), stopped);
  std::printf("stood still %d cycles after SIGSTOP\n", static_cast<int>(still - stopped));
  EXPECT_LE(still, stopped + 5 + 1);

  // It stays so while the bridge hangs, beyond the server's watchdog.
  scene.watch(milliseconds(3000));
  for (const sim::TraceRow& row : scene.trace()) {
    if (row.cycle > still) {
      ASSERT_LT(std::abs(row.velocity), 1e-3) << row.cycle;
    }
  }

  // Back again without a driver: the commands that waited are old.
  scene.drives = false;
  scene.watch(milliseconds(200));
  const std::uint64_t resumed = scene.trace().back().cycle;
  scene.bridge->signal(SIGCONT);
  ASSERT_TRUE(scene.until([&] { return scene.state.stamp.cycle > resumed + 10; }));
  for (const sim::TraceRow& row : scene.trace()) {
    if (row.cycle > still) {
      ASSERT_LT(std::abs(row.velocity), 1e-3) << row.cycle;
    }
  }
  EXPECT_NE(scene.bridge_log().find("a new grant is needed"), std::string::npos);

  scene.drives = true;
  EXPECT_TRUE(scene.until([&] { return scene.state.velocity > 0.28; })) << scene.bridge_log();
}

TEST(BridgeLoss, AKilledBridgeStopsTheRobotAndGoesOnWhereItWas) {
  Scene scene;
  scene.bridge_options = {"--state", scene.folder.path("state")};
  start(scene);
  ASSERT_TRUE(scene.until([&] { return scene.state.pose_in_odom.x > 1.8; }));
  const std::uint64_t odom = scene.state.odom;
  const std::uint64_t epoch = scene.state.stamp.epoch;
  scene.bridge->signal(SIGKILL);
  const std::uint64_t killed = scene.trace().back().cycle;
  ASSERT_TRUE(scene.until([&] { return stood_still(scene.trace(), killed) != 0; }));
  const std::uint64_t still = stood_still(scene.trace(), killed);
  std::printf("stood still %d cycles after SIGKILL\n", static_cast<int>(still - killed));
  EXPECT_LE(still, killed + 5);

  scene.start_bridge();
  ASSERT_TRUE(scene.until([&] {
    return scene.state.stamp.epoch > epoch && scene.state.velocity > 0.28;
  })) << scene.bridge_log();
  EXPECT_EQ(scene.state.odom, odom);
  scene.command.velocity = 0.0;
  ASSERT_TRUE(scene.until([&] { return scene.rests(); }));
  scene.watch(milliseconds(300));
  // The world is 20 m wide, the start in the middle; the simulated odometry is accurate enough.
  EXPECT_NEAR(scene.state.pose_in_odom.x, scene.trace().back().pose_in_world.x - 10.0, 0.1);
}

}  // namespace
}  // namespace saphira::test
