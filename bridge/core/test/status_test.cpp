#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

/// A driven robot of ARCOS, whose packets have more fields.
struct Later : Scene {
  Later() {
    robot.protocol = protocol::Protocol::kArcos;
    shown.ptu = protocol::kFlagMotors;
    connect();
    cycles(12, Role::behaviors);
  }
};

TEST(Status, ARobotThatIsServedIsRunning) {
  Driven scene;
  scene.cycles(2, Role::behaviors);
  scene.pass(0.11);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING);
  EXPECT_EQ(scene.condition().reason, "");
  EXPECT_EQ(scene.all<StatusReport>().back().steps, 14U);
}

TEST(Status, ARobotOfAnAssumedGenerationIsTakenForWhatItsPacketsShow) {
  Scene scene;
  scene.robot.protocol_is_assumed = true;
  scene.robot.file = "mt400.p";
  scene.connect();
  scene.cycle();
  EXPECT_EQ(scene.core.parameters().protocol, protocol::Protocol::kP2os);
  EXPECT_FALSE(scene.noted("Protocol arcos"));
  scene.shown.trailing.battery = 245;
  scene.shown.ptu = 0;  // the motors are off
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.core.parameters().protocol, protocol::Protocol::kArcos);
  EXPECT_TRUE(
      scene.noted("mt400.p gives no Protocol, and the robot's packets have fields that "
                  "ARCOS alone sends: it is driven as arcos"));
  const std::vector<CycleBegan> cycles = scene.all<CycleBegan>();
  EXPECT_EQ(cycles.back().state.information.motors_on, std::optional(false));
  EXPECT_NEAR(cycles.back().state.information.battery, 24.5, 1e-9);
  const auto warnings = [&] {
    return std::count_if(scene.said.begin(), scene.said.end(), [](const Output& output) {
      const auto* const note = std::get_if<Note>(&output);
      return note != nullptr && note->text.find("Protocol arcos") != std::string::npos;
    });
  };
  EXPECT_EQ(warnings(), 1);
}

TEST(Status, SaysWhatIsWaitedFor) {
  Scene scene;
  scene.around.link_trouble = "no such file";
  scene.pass(0.1);
  EXPECT_EQ(scene.condition().reason, "robot link: no such file");
  scene.mute = true;
  scene.connect();
  scene.pass(0.1);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_WAITING);
  EXPECT_EQ(scene.condition().reason,
            "waits for the robot to answer SYNC0 (is it switched on, and the cable in?)");
}

TEST(Status, ARobotThatDoesNotComeIsToldInTheLogOnce) {
  Scene scene;
  scene.around.link_trouble = "no such line";
  scene.pass_slowly(2.0);
  EXPECT_FALSE(scene.noted("no such line"));
  scene.pass_slowly(2.0);
  EXPECT_TRUE(scene.noted("there is no robot yet: robot link: no such line"));
  const std::size_t told = scene.all<Note>().size();
  scene.pass_slowly(10.0);
  EXPECT_EQ(scene.all<Note>().size(), told);
}

TEST(Status, SaysThatASimulatorMayWaitForSteps) {
  Scene scene;
  scene.connect();
  scene.pass_slowly(0.7);
  EXPECT_EQ(scene.condition().reason,
            "robot link silent: no packet has come (a simulator in single step needs --lockstep "
            "here)");
}

TEST(Status, ThePressedButtonOfTheRobotIsTold) {
  Later scene;
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING);
  scene.shown.ptu = protocol::kFlagMotors | protocol::kFlagEmergencyStop;
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
  EXPECT_EQ(scene.condition().reason, "the robot's own emergency stop is pressed");
}

TEST(Status, MotorsThatAreOffAreTold) {
  Later scene;
  scene.shown.ptu = 0;
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
  EXPECT_NE(scene.condition().reason.find("the robot's motors are off"), std::string::npos);
}

TEST(Status, ABatteryThatStaysLowIsTold) {
  struct {
    int tenths;       // [0.1 V]; the robot complains at 11.5 V
    unsigned charge;  // [%]; 0: the robot does not tell
    unsigned charger;
    bool is_low;
  } const cases[] = {{118, 0, 0, false}, {117, 0, 0, true},   {80, 0, 0, false},
                     {117, 0, 1, false}, {117, 21, 0, false}, {126, 20, 0, true}};
  for (const auto& one : cases) {
    Later scene;
    // A packet ends behind any of these fields, without a gap.
    scene.shown.trailing = {.battery = static_cast<std::uint16_t>(one.tenths),
                            .charge_state = static_cast<std::uint8_t>(one.charger),
                            .rotation = 0,
                            .faults = 0,
                            .lateral = 0,
                            .temperature = 20,
                            .state_of_charge = static_cast<std::uint8_t>(one.charge),
                            .time = {},
                            .flags3 = {}};
    scene.cycles(99, Role::behaviors);
    EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING) << one.tenths;
    scene.cycles(2, Role::behaviors);
    EXPECT_EQ(scene.condition().health == v1::SERVICE_DEGRADED, one.is_low)
        << one.tenths << ' ' << one.charge << ' ' << scene.condition().reason;
  }
}

TEST(Status, MotorsHaveASecondToBeSwitchedOn) {
  Scene scene;
  scene.shown.motors = protocol::Motors::kNoPower;
  scene.connect();
  scene.cycles(9, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING);
  scene.cycles(3, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
}

TEST(Status, TheKeeperIsWatched) {
  Driven scene;
  scene.around.has_keeper = true;
  scene.around.keeper_alive = true;
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING);
  scene.around.keeper_alive = false;
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.condition().reason,
            "the keeper is gone: nobody stops the robot when the bridge hangs");
  EXPECT_TRUE(scene.noted("the keeper died or hangs: another one is started"));
  scene.around.keeper_alive = true;
  scene.around.keeper_restarts = 1;
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.condition().reason,
            "the keeper died or hung; another one was started (1 so far)");
  scene.cycles(102, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING);
}

TEST(Status, AFieldThatCannotBeTrueIsTold) {
  Driven scene;
  scene.shown.sonars = {{40, 1000}};
  scene.cycles(2, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
  EXPECT_NE(scene.condition().reason.find("sonar number 40"), std::string::npos);
  EXPECT_TRUE(scene.noted("sonar number 40"));
  EXPECT_EQ(scene.core.grant().role, Role::behaviors) << "the rest of the packet holds";
}

TEST(Status, ReactionsAreToldOnceASecond) {
  Driven scene;
  for (int i = 0; i < 25; ++i) {
    scene.cycle();
    scene.core.command(scene.wish(Role::behaviors, 0.01 * i), scene.now);
    scene.core.answer(scene.now);
    for (const Output& output : scene.core.take())
      if (std::holds_alternative<Answered>(output))
        scene.core.answered(scene.now + 0.004);
  }
  std::vector<StatusReport::Reaction> told;
  for (const StatusReport& report : scene.all<StatusReport>())
    if (report.reaction)
      told.push_back(*report.reaction);
  ASSERT_GE(told.size(), 2U);
  EXPECT_LE(told.size(), 3U);
  EXPECT_NEAR(told.back().mean, 0.004, 1e-9);
  EXPECT_NEAR(told.back().max, 0.004, 1e-9);
}

}  // namespace
}  // namespace saphira::bridge::test
