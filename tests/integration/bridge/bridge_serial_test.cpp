// The robot behind a serial line at 9600 baud: faults of the line, and their effect for the user.
#include <gtest/gtest.h>

#include "scene.hpp"
#include "serial_line.hpp"

namespace saphira::test {
namespace {

using std::chrono::milliseconds;

/// A scene with a line between bridge and robot.
struct LineScene : Scene {
  LineScene() { robot_port = "serial:" + folder.path("tty") + "@9600"; }
  /// Waits until the robot drives at 0.3 m/s.
  void drive_off() {
    start_simulator();
    ASSERT_TRUE(wait_until([this] { return line.has_robot(); }));
    start_bridge();
    forward(command, 0.3);
    drives = true;
    ASSERT_TRUE(until([&] { return state.velocity > 0.28; })) << bridge_log();
  }
  /// The line will be broken, perhaps within a packet.
  void expect_halves() { simulator->expect_violations(); }
  bool says(const std::string& text) {
    return until([&] { return status.reason.find(text) != std::string::npos; });
  }
  /// Cycles of the trace from `cycle` to the standstill; -1 without one.
  int cycles_to_stand(std::uint64_t cycle) {
    if (!until([&] { return stood_still(trace(), cycle) != 0; }))
      return -1;
    return static_cast<int>(stood_still(trace(), cycle) - cycle);
  }
  SerialLine line{folder.path("tty"), folder.path("robot"), 9600};
};

TEST(BridgeSerial, DrivesAtNinetySixHundredBaud) {
  LineScene scene;
  scene.drive_off();
  const std::size_t before = scene.states.size();
  const auto bytes = scene.line.from_robot();
  const auto commanded = scene.line.to_robot();
  const auto began = std::chrono::steady_clock::now();
  scene.watch(milliseconds(3000));
  const double time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  // Every packet comes: the line needs less than 100 ms for the packets of 100 ms.
  EXPECT_GE(scene.states.size() - before, static_cast<std::size_t>(time * 10.0) - 3);
  const double rate = static_cast<double>(scene.line.from_robot() - bytes) / time;
  EXPECT_GT(rate, 300.0);
  EXPECT_LT(rate, 960.0 * 1.01) << "faster than the line";
  EXPECT_LT(static_cast<double>(scene.line.to_robot() - commanded) / time, 480.0)
      << "commands that wait are old";
  EXPECT_EQ(scene.state.bad_packets, 0U);
  EXPECT_EQ(scene.status.reason, "");
  // Release stops the robot: 0.3 m/s at 2 m/s2, plus the line's own time. From the grant's end on,
  // so that a busy machine's way from here to the bridge does not count.
  scene.drives = false;
  scene.command.active = false;
  scene.publish();
  ASSERT_TRUE(scene.until([&] { return scene.grant.role == v1::ROLE_NONE; }));
  EXPECT_EQ(scene.grant.reason, "nothing asks the robot to move") << "by release, not by lease";
  const int cycles = scene.cycles_to_stand(scene.grant.stamp.cycle);
  std::printf("%.0f bytes/s from the robot; stood still %d cycles after the release\n", rate,
              cycles);
  EXPECT_GE(cycles, 0);
  EXPECT_LE(cycles, 5);
}

TEST(BridgeSerial, ACableThatIsPulledAndPutBack) {
  LineScene scene;
  scene.drive_off();
  scene.expect_halves();
  const std::uint64_t epoch = scene.state.stamp.epoch;
  const std::uint64_t odom = scene.state.odom;
  scene.line.cut(true);
  const std::uint64_t cut = scene.trace().back().cycle;
  ASSERT_TRUE(scene.says("robot link silent")) << scene.status.reason;
  EXPECT_EQ(scene.status.state, v1::SERVICE_WAITING);
  // Only the robot's own watchdog can stop it.
  const int cycles = scene.cycles_to_stand(cut);
  std::printf("stood still %d cycles after the cable was pulled\n", cycles);
  EXPECT_GE(cycles, 0);
  EXPECT_LE(cycles, 20 + 6);
  ASSERT_TRUE(scene.says("is it switched on, and the cable in?")) << scene.status.reason;
  scene.line.cut(false);
  ASSERT_TRUE(scene.until([&] {
    return scene.state.stamp.epoch > epoch && scene.state.velocity > 0.28;
  })) << scene.bridge_log();
  EXPECT_EQ(scene.state.odom, odom) << "the robot counted on";
  ASSERT_TRUE(scene.until([&] { return scene.status.state == v1::SERVICE_RUNNING; }));
}

}  // namespace
}  // namespace saphira::test
