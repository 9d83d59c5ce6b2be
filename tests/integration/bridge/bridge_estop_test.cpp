// The emergency stop of the bridge, with a robot that drives.
#include <gtest/gtest.h>

#include <csignal>

#include "scene.hpp"

namespace saphira::test {
namespace {

/// A stop button in its own program.
class Button {
 public:
  explicit Button(Scene& scene) : node_(scene.node.options()) { command_.source = "button"; }

  void say(bool pressed) {
    command_.active = pressed;
    command_.number = command_.number + 1;
    writer_.write(command_);
  }

 private:
  bus::Node node_;
  bus::Writer<v1::MotorCommand> writer_ = node_.writer(bus::topics::kDriveEstop);
  v1::MotorCommand command_;
};

struct Driving : Scene {
  Driving() {
    bridge_options = {"--state", folder.path("state")};
    start();
    forward(command, 0.3);
    drives = true;
  }
  bool moves() {
    return until([&] { return state.velocity > 0.25; });
  }
  bool stopped() const { return grant.estopped && grant.role == v1::ROLE_ESTOP && rests(); }
  /// Presses until it is confirmed, and until the robot rests.
  bool press(Button& button) {
    return until([&] {
      button.say(true);
      return stopped();
    });
  }
  /// For that number of robot cycles; false where it moved, or the stop was released.
  bool stays_stopped(std::uint64_t cycles) {
    const std::uint64_t begin = state.stamp.cycle;
    bool still = true;
    const bool passed = until([&] {
      still = still && stopped();
      return state.stamp.cycle >= begin + cycles;
    });
    return passed && still;
  }
};

TEST(BridgeEstop, HoldsWithoutItsButtonOverANewConnectionAndARestart) {
  Driving scene;
  ASSERT_TRUE(scene.moves()) << scene.bridge_log();
  {
    Button button(scene);
    ASSERT_TRUE(scene.press(button)) << scene.bridge_log();
  }
  EXPECT_EQ(scene.grant.estop_source, "button");
  // The driver still asks; the button's program is gone, its lease and any quiet time are over.
  EXPECT_TRUE(scene.stays_stopped(40));

  const std::uint64_t epoch = scene.state.stamp.epoch;
  scene.start_simulator();
  ASSERT_TRUE(scene.until([&] { return scene.state.stamp.epoch > epoch; }));
  EXPECT_TRUE(scene.stays_stopped(10));

  const std::uint64_t second = scene.state.stamp.epoch;
  scene.bridge->signal(SIGKILL);
  scene.start_bridge();
  ASSERT_TRUE(scene.until([&] { return scene.state.stamp.epoch > second; })) << scene.bridge_log();
  EXPECT_TRUE(scene.stays_stopped(10));
  EXPECT_EQ(scene.grant.estop_source, "button");
  EXPECT_EQ(scene.status.state, v1::SERVICE_DEGRADED);
  EXPECT_NE(scene.status.reason.find("emergency stop, pressed by button"), std::string::npos);
}

}  // namespace
}  // namespace saphira::test
