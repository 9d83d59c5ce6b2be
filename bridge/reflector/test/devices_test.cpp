#include "saphira/reflector/devices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

namespace saphira::reflector {
namespace {

using protocol::Command;
using protocol::InformationPacket;

/// A robot that gets requests, cycle by cycle.
struct Bench {
  explicit Bench(protocol::RobotParameters p = {}) : parameters(std::move(p)) { devices.connect(); }
  void ask(const Wish& wish) {
    Request request{.functor = {}, .source = "test"};
    request.asker = 7;
    request.number = ++number;
    request.deadline = deadline;
    devices.request(request, wish, parameters);
  }
  /// Runs one cycle; returns how often this command was sent in it.
  int cycle(const Command& command) {
    devices.reflect(packet, protocol::interpret(packet, parameters), origin);
    now += 0.1;
    int count = 0;
    for (const Command& each : devices.due(now))
      count += each == command;
    return count;
  }
  int cycles(int n, const Command& command) {
    int count = 0;
    for (int i = 0; i < n; ++i)
      count += cycle(command);
    return count;
  }
  DeviceRequest only() const {
    EXPECT_EQ(devices.requests().size(), 1U);
    return devices.requests().at(0);
  }

  protocol::RobotParameters parameters;
  Devices devices;
  InformationPacket packet;
  bool origin = false;
  double now = 0.0;
  double deadline = 0.0;
  std::uint64_t number = 0;
};

TEST(Devices, AreGivenUpAtTheDeadline) {
  Bench b;
  b.deadline = 0.95;
  b.ask(OutputWish{0xFF, 6});
  EXPECT_EQ(b.cycles(30, protocol::DigitalOutput{6}), 5);
  EXPECT_EQ(b.only().answer.code, AnswerCode::too_late);
}

TEST(Devices, AreSentUntilShown) {
  Bench b;
  b.ask(OutputWish{0xFF, 5});
  b.ask(OutputWish{0xFF, 6});
  EXPECT_EQ(b.cycle(protocol::DigitalOutput{5}), 0) << "a newer one took its place";
  EXPECT_EQ(b.only().answer.code, AnswerCode::underway);
  EXPECT_EQ(b.cycles(10, protocol::DigitalOutput{6}), 5) << "every 0.2 s";
  b.packet.digital_output = 6;
  EXPECT_EQ(b.cycles(10, protocol::DigitalOutput{6}), 0);
  EXPECT_EQ(b.only().answer.code, AnswerCode::done);
  EXPECT_EQ(b.only().number, 2U);
  EXPECT_EQ(b.only().asked, "output 0x06");
  EXPECT_TRUE(b.devices.take_changed());
  EXPECT_FALSE(b.devices.take_changed());
  EXPECT_TRUE(b.devices.take_troubles().empty());
}

TEST(Devices, AMaskLeavesTheOtherBits) {
  Bench b;
  b.packet.digital_output = 0xA5;
  b.cycle(Command{});
  b.ask(OutputWish{0x0F, 0xFA});
  EXPECT_EQ(b.cycle(protocol::DigitalOutput{0xAA}), 1);
  b.packet.digital_output = 0x0A;
  b.cycle(Command{});
  EXPECT_EQ(b.only().answer.code, AnswerCode::done) << "the other bits are not what was asked for";
}

TEST(Devices, AServoIsShownByARobotOfThatGeneration) {
  Bench b;
  b.ask(ServoWish{1500});
  EXPECT_EQ(b.cycle(protocol::Ptu{1500}), 1);
  b.packet.ptu = 1500;
  b.cycle(Command{});
  EXPECT_EQ(b.only().answer.code, AnswerCode::done);
}

TEST(Devices, AHeadLooksWithinItsReach) {
  Bench b;
  b.ask(ServoWish{0, 0.5});
  EXPECT_EQ(b.only().answer.text,
            "look to 29 degrees: refused; this robot's parameter file has no head (HeadReach)");
  b.parameters.head_reach = radians(150.0);
  b.ask(ServoWish{0, radians(160.0)});
  EXPECT_EQ(b.only().answer.text,
            "look to 160 degrees: refused; its head turns by 150 degrees to either side at most");
  b.ask(ServoWish{0, radians(-90.0)});
  EXPECT_EQ(b.cycle(protocol::Ptu{960}), 1);
  b.packet.ptu = 1200;
  b.cycle(Command{});
  EXPECT_EQ(b.only().answer.code, AnswerCode::underway) << "it is on its way";
  b.packet.ptu = 960;
  b.cycle(Command{});
  EXPECT_EQ(b.only().answer.code, AnswerCode::done);
}

TEST(Devices, AreGivenUpAfterFiveSeconds) {
  Bench b;
  b.ask(ServoWish{1500});
  EXPECT_EQ(b.cycles(80, protocol::Ptu{1500}), 25);
  EXPECT_EQ(b.only().answer.code, AnswerCode::given_up);
  EXPECT_EQ(b.devices.take_troubles(),
            std::vector<std::string>{
                "a request of test: servo 1500 us: given up after 25 times; the robot does not "
                "show it"});
  EXPECT_TRUE(b.devices.take_troubles().empty());
}

TEST(Devices, WhatNoPacketShowsIsSentThriceOrOnce) {
  Bench b;
  b.ask(TimerWish{2});
  EXPECT_EQ(b.cycles(20, protocol::Timer{2}), 1) << "a second one would begin it again";
  EXPECT_EQ(b.only().answer.code, AnswerCode::sent);
  b.ask(GripperWish{GripperAction::number, 5});
  EXPECT_EQ(b.cycles(20, protocol::Gripper{5}), 3);
}

TEST(Devices, TheOriginIsShownByThePosition) {
  Bench b;
  b.ask(ServerWish{ServerAction::set_origin, 0});
  EXPECT_EQ(b.cycles(4, protocol::SetOrigin{}), 2);
  b.origin = true;
  b.cycle(Command{});
  EXPECT_EQ(b.only().answer.code, AnswerCode::done);
}

TEST(Devices, PollingNamesSonarsThatThereAre) {
  protocol::RobotParameters parameters;
  parameters.sonars = {{0, {}}, {1, {}}, {2, {}}};
  Bench b(parameters);
  b.ask(SonarWish{true, {2, 0, 2}});
  EXPECT_EQ(b.cycles(20, protocol::Polling{{2, 0, 2}}), 3);
  b.ask(SonarWish{true, {}});
  EXPECT_EQ(b.cycles(20, protocol::Polling{{0, 1, 2}}), 3);
  b.ask(SonarWish{false, {}});
  EXPECT_EQ(b.cycles(20, protocol::Polling{}), 3);
  b.ask(SonarWish{true, {3}});
  EXPECT_EQ(b.only().answer.code, AnswerCode::refused);
  EXPECT_EQ(b.only().answer.text, "sonar on 3: refused; the robot has no sonar 3");
  EXPECT_TRUE(b.devices.due(1000.0).empty());
}

TEST(Devices, ALostConnectionEndsWhatWasUnderWay) {
  Bench b;
  b.ask(ServoWish{1500});
  b.cycle(Command{});
  b.devices.connect();
  EXPECT_EQ(b.only().answer.code, AnswerCode::lost);
  EXPECT_EQ(b.cycles(50, protocol::Ptu{1500}), 0) << "the robot was perhaps switched off";
}

protocol::RobotParameters of(protocol::Protocol generation) {
  protocol::RobotParameters parameters;
  parameters.protocol = generation;
  parameters.sonars = {{0, {}}, {1, {}}};
  return parameters;
}

TEST(Devices, WaitForTheLine) {
  Bench b(of(protocol::Protocol::kArcos));
  b.ask(SerialWish{1, std::vector<std::uint8_t>(180, 7), 0});
  b.ask(SerialWish{2, std::vector<std::uint8_t>(180, 8), 0});
  EXPECT_TRUE(b.devices.due(1.0, 100).empty());
  EXPECT_EQ(b.devices.due(1.0, 250).size(), 1U);
  EXPECT_TRUE(b.devices.due(1.1, 100).empty());
  EXPECT_EQ(b.devices.due(1.2, 250).size(), 1U);
  for (const DeviceRequest& request : b.devices.requests())
    EXPECT_EQ(request.answer.code, AnswerCode::sent) << request.asked;
}

// Manual 9.1. Two settings do not displace each other; a lost command is repeated.
TEST(Devices, TheVisionSystemIsSpokenTo) {
  Bench b(of(protocol::Protocol::kPsos));
  b.ask(VisionWish{"pioneer_a_mode=1"});
  b.ask(VisionWish{"pioneer_b_mode=0"});
  b.ask(VisionWish{"line_min_mass=8"});
  std::map<std::string, int> said;
  for (int i = 0; i < 20; ++i)
    for (const Command& command : b.devices.due(b.now += 0.1)) {
      const auto& bytes = std::get<protocol::Text>(command).text;
      ++said[std::string(bytes.begin(), bytes.end())];
    }
  EXPECT_EQ(said, (std::map<std::string, int>{
                      {"pioneer_a_mode=1", 3}, {"pioneer_b_mode=0", 3}, {"line_min_mass=8", 3}}));
  for (const DeviceRequest& request : b.devices.requests())
    EXPECT_EQ(request.answer.code, AnswerCode::sent) << request.asked;
}

TEST(Devices, APioneerOneIsNotAskedForWhatCameLater) {
  Bench b(of(protocol::Protocol::kPsos));
  b.devices.begin(b.parameters);
  EXPECT_TRUE(b.devices.requests().empty());
  for (const Wish& wish :
       {Wish(SoundWish{{{5, 60}}, 0}), Wish(AnalogWish{1}), Wish(SerialWish{1, {7}, 0}),
        Wish(ServerWish{ServerAction::motors, 1}), Wish(GripperWish{GripperAction::open, 0})}) {
    b.ask(wish);
    EXPECT_TRUE(b.devices.due(b.now).empty()) << text(wish);
    EXPECT_FALSE(b.devices.take_troubles().empty()) << text(wish);
  }
}

TEST(Devices, ALaterRobotIsSwitchedOnAndAskedWhatItIsLike) {
  Bench b(of(protocol::Protocol::kP2os));
  b.devices.begin(b.parameters);
  int on = 0;
  int asked = 0;
  for (int i = 0; i < 30; ++i) {
    for (const Command& command : b.devices.due(b.now += 0.1)) {
      on += command == Command(protocol::Enable{true});
      asked += command == Command(protocol::ConfigRequest{1});
    }
  }
  EXPECT_EQ(on, 3);
  EXPECT_EQ(asked, 3) << "no answer is tolerated";
  EXPECT_TRUE(b.devices.take_troubles().empty());
  protocol::ConfigPacket configuration;
  configuration.firmware = "1.9";
  b.ask(ServerWish{ServerAction::configuration, 0});
  b.cycle(Command{});
  b.devices.take_changed();
  b.devices.reflect(configuration, static_cast<std::uint8_t>(protocol::PacketType::kConfig));
  EXPECT_TRUE(b.devices.take_changed());
  EXPECT_EQ(b.devices.reports().configuration->firmware, "1.9");
  EXPECT_EQ(b.devices.requests().back().answer.code, AnswerCode::done);
}

TEST(Devices, AStrongerDecelerationIsSetBeforeTheQuestionHowItIsSet) {
  protocol::RobotParameters parameters = of(protocol::Protocol::kP2os);
  parameters.stop_deceleration = 0.6;
  parameters.stop_rotation_deceleration = 2.0;
  Bench b(parameters);
  b.devices.begin(b.parameters);
  int rounds = 0;
  for (int i = 0; i < 30; ++i) {
    const std::vector<Command> due = b.devices.due(b.now += 0.1);
    const auto set = std::find(due.begin(), due.end(), Command(protocol::Acceleration{-0.6}));
    if (set == due.end())
      continue;
    ++rounds;
    EXPECT_EQ(set[1], Command(protocol::RotationAcceleration{-2.0}));
    EXPECT_EQ(set[2], Command(protocol::ConfigRequest{1}));
  }
  EXPECT_EQ(rounds, 3) << "a packet may be lost";
}

TEST(Devices, FlagsOfArcosShowMotorsSonarsAndTheAnalogPort) {
  Bench b(of(protocol::Protocol::kArcos));
  b.packet.ptu = protocol::kFlagSonars;
  b.ask(ServerWish{ServerAction::motors, 1});
  EXPECT_EQ(b.cycles(10, protocol::Enable{true}), 5);
  b.packet.ptu |= protocol::kFlagMotors;
  EXPECT_EQ(b.cycles(10, protocol::Enable{true}), 0);
  EXPECT_EQ(b.only().answer.code, AnswerCode::done);
  b.ask(SonarWish{false, {}});
  EXPECT_EQ(b.cycles(10, protocol::SonarSwitch{false, 0}), 5);
  b.packet.ptu = protocol::kFlagMotors;
  EXPECT_EQ(b.cycles(10, protocol::SonarSwitch{false, 0}), 0);
  b.ask(AnalogWish{3});
  EXPECT_EQ(b.cycles(4, protocol::AnalogSelect{3}), 2);
  b.packet.timer = 3;
  EXPECT_EQ(b.cycles(10, protocol::AnalogSelect{3}), 0);
  for (const DeviceRequest& request : b.devices.requests())
    EXPECT_EQ(request.answer.code, AnswerCode::done) << request.asked;
}

TEST(Devices, LaterRobotsHaveMasksTonesAndSerialPorts) {
  Bench b(of(protocol::Protocol::kP2os));
  b.ask(OutputWish{0x0F, 0x05});
  EXPECT_EQ(b.cycle(protocol::DigitalOutput{0x05, 0x0F}), 1);
  b.ask(SoundWish{{{25, 60}, {5, 0}}, 0});
  EXPECT_EQ(b.cycles(10, protocol::Say{{25, 60, 5, 0}}), 1) << "said once";
  b.ask(GripperWish{GripperAction::lift_up, 0});
  EXPECT_EQ(b.cycles(10, protocol::Gripper{4}), 3);
  b.ask(SerialWish{2, {1, 2, 3}, 9});
  const std::vector<Command> sent = b.devices.due(b.now + 0.1);
  EXPECT_NE(std::find(sent.begin(), sent.end(), Command(protocol::Aux2Send{{1, 2, 3}})),
            sent.end());
  EXPECT_NE(std::find(sent.begin(), sent.end(), Command(protocol::Aux2Read{9})), sent.end());
}

TEST(Devices, PacketsThatNobodyReadsAreCounted) {
  Bench b;
  b.devices.reflect(protocol::OtherPacket{0x9A, {}}, 0x9A);
  EXPECT_TRUE(b.devices.take_changed());
  b.devices.reflect(protocol::OtherPacket{0x9A, {}}, 0x9A);
  EXPECT_FALSE(b.devices.take_changed());
  EXPECT_EQ(b.devices.reports().unread.at(0x9A), 2U);
}

}  // namespace
}  // namespace saphira::reflector
