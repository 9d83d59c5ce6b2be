#include "saphira/protocol/command.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "saphira/geometry/pose.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::protocol {
namespace {

Bytes body_of(const Bytes& packet) {
  return {packet.begin() + 3, packet.end() - 2};
}

Bytes body(const Command& command) {
  return body_of(encode(command));
}

// Manual Table 5-4, numbers and argument types; Table 5-3, the types' bytes.
TEST(Command, BytesAreTheTables) {
  EXPECT_EQ(body(Pulse{}), (Bytes{0}));
  EXPECT_EQ(body(Open{}), (Bytes{1}));
  EXPECT_EQ(body(Close{}), (Bytes{2}));
  // The manual's example of 5.6: "\001\002\001\006" is the sequence 0, 1, 0, 5.
  EXPECT_EQ(body(Polling{{0, 1, 0, 5}}), (Bytes{3, 0x2B, 1, 2, 1, 6, 0}));
  EXPECT_EQ(body(Polling{}), (Bytes{3, 0x2B, 0}));
  EXPECT_EQ(body(SetOrigin{}), (Bytes{7}));
  EXPECT_EQ(body(Velocity{0.15}), (Bytes{11, 0x3B, 150, 0}));
  EXPECT_EQ(body(Velocity{-0.4}), (Bytes{11, 0x1B, 0x90, 0x01}));
  EXPECT_EQ(body(Heading{radians(320)}), (Bytes{12, 0x3B, 0x40, 0x01}));
  EXPECT_EQ(body(Heading{radians(-40)}), (Bytes{12, 0x3B, 0x40, 0x01}));
  EXPECT_EQ(body(Heading{radians(359.8)}), (Bytes{12, 0x3B, 0, 0}));
  EXPECT_EQ(body(DeltaHeading{radians(-10)}), (Bytes{13, 0x1B, 10, 0}));
  EXPECT_EQ(body(RotationVelocity{radians(-80)}), (Bytes{21, 0x1B, 80, 0}));
  EXPECT_EQ(body(DigitalOutput{0xA5}), (Bytes{30, 0x3B, 0xA5, 0}));
  EXPECT_EQ(body(Timer{7}), (Bytes{31, 0x3B, 7, 0}));
  EXPECT_EQ(body(Gripper{4}), (Bytes{33, 0x3B, 4, 0}));
  EXPECT_EQ(body(Ptu{2000}), (Bytes{41, 0x3B, 0xD0, 0x07}));
  EXPECT_EQ(body(Step{}), (Bytes{64}));
  // Table 5-9: VEL2 40, 50, in units of 4 mm/s; the right wheel in the low byte.
  EXPECT_EQ(body(WheelVelocities{0.16, 0.2}), (Bytes{32, 0x3B, 50, 40}));
  EXPECT_EQ(body(WheelVelocities{-0.16, 0.2}), (Bytes{32, 0x3B, 50, 0xD8}));
}

TEST(Command, SurvivesTheWire) {
  const Command commands[] = {Polling{{0, 1, 0, 5}},       Polling{},
                              DeltaHeading{radians(-170)}, WheelVelocities{-0.16, 0.2},
                              DigitalOutput{0xFF},         Unknown{99}};
  for (const Command& command : commands)
    for (const StringForm form : {StringForm::kNulTerminated, StringForm::kLengthPrefixed})
      EXPECT_EQ(decode_command(body_of(encode(command, kVel2Unit, form))), command)
          << command.index();
}

TEST(Command, WheelVelocitiesInTheRobotsUnit) {
  const Bytes packet = encode(WheelVelocities{-0.5, 1.0}, 0.020);
  EXPECT_EQ(decode_command(body_of(packet), 0.020), Command(WheelVelocities{-0.5, 1.0}));
}

TEST(Command, ValuesAreClampedToWhatThePacketCanSay) {
  EXPECT_EQ(decode_command(body(Velocity{1e9})), Command(Velocity{32.767}));
  EXPECT_EQ(decode_command(body(Velocity{std::numeric_limits<double>::quiet_NaN()})),
            Command(Velocity{0.0}));
  EXPECT_EQ(decode_command(body(RotationVelocity{-100.0})),
            Command(RotationVelocity{radians(-255)}));
  EXPECT_EQ(decode_command(body(Heading{std::numeric_limits<double>::infinity()})),
            Command(Heading{0.0}));
  EXPECT_EQ(decode_command(body(WheelVelocities{9.0, -9.0})),
            Command(WheelVelocities{127 * kVel2Unit, -127 * kVel2Unit}));
  EXPECT_EQ(std::get<Polling>(decode_command(body(Polling{std::vector<std::uint8_t>(20, 3)})))
                .sonars.size(),
            12U);
}

TEST(Command, MissingArgumentsAreTolerated) {
  EXPECT_EQ(decode_command(Bytes{7, 0x3B}), Command(SetOrigin{}));   // Player
  EXPECT_EQ(decode_command(Bytes{1, 0x3B, 1, 0}), Command(Open{}));  // ARIA
  EXPECT_EQ(decode_command(Bytes{2, 0x3B, 1, 0}), Command(Close{}));
  EXPECT_EQ(decode_command(Bytes{11}), Command(Velocity{0.0}));
  EXPECT_EQ(decode_command(Bytes{11, 0x3B}), Command(Velocity{0.0}));
  EXPECT_EQ(decode_command(Bytes{32}), Command(WheelVelocities{}));
  EXPECT_EQ(decode_command(Bytes{3}), Command(Polling{}));
}

TEST(Command, WhatCannotBeReadIsUnknown) {
  EXPECT_EQ(decode_command({}), Command(Unknown{0}));
  EXPECT_EQ(decode_command(Bytes{11, 0x3B, 1}), Command(Unknown{11}));      // half an int
  EXPECT_EQ(decode_command(Bytes{11, 0x2B, 65, 0}), Command(Unknown{11}));  // a string
  EXPECT_EQ(decode_command(Bytes{11, 0x99, 1, 0}), Command(Unknown{11}));   // no such type
  EXPECT_EQ(decode_command(Bytes{3, 0x3B, 1, 0}), Command(Unknown{3}));     // an int
  EXPECT_EQ(decode_command(Bytes{3, 0x2B, 9, 1, 2}), Command(Unknown{3}));  // neither form
  EXPECT_EQ(decode_command(Bytes{31, 0x3B, 8, 0}), Command(Unknown{31}));   // no such pin
  EXPECT_EQ(decode_command(Bytes{14, 0x3B, 1, 0}), Command(Unknown{14}));   // no such command
  EXPECT_EQ(decode_command(Bytes{62, 0x2B, 1, 65}), Command(Unknown{62}));  // a string
  EXPECT_EQ(decode_command(Bytes{224, 0x3B, 1, 0}), Command(Unknown{224}));
}

// ARIA sends HEAD from -180 to 180; some clients send two's complement as a positive integer.
TEST(Command, NegativeIntegersOfEitherKind) {
  EXPECT_EQ(decode_command(Bytes{12, 0x1B, 90, 0}), Command(Heading{radians(-90)}));
  EXPECT_EQ(decode_command(Bytes{11, 0x3B, 0x9C, 0xFF}), Command(Velocity{-0.1}));
}

// The later servers' commands, as their clients send them.
TEST(Command, BytesOfTheLaterServers) {
  EXPECT_EQ(body(Enable{true}), (Bytes{4, 0x3B, 1, 0}));
  EXPECT_EQ(body(Acceleration{0.3}), (Bytes{5, 0x3B, 44, 1}));
  EXPECT_EQ(body(Acceleration{-0.3}), (Bytes{5, 0x1B, 44, 1}));
  EXPECT_EQ(body(MaxVelocity{0.75}), (Bytes{6, 0x3B, 0xEE, 2}));
  EXPECT_EQ(body(Move{-1.0}), (Bytes{8, 0x1B, 0xE8, 3}));
  EXPECT_EQ(body(Rotate{radians(-40)}), (Bytes{9, 0x1B, 40, 0}));
  EXPECT_EQ(body(MaxRotationVelocity{radians(100)}), (Bytes{10, 0x3B, 100, 0}));
  EXPECT_EQ(body(RotationAcceleration{radians(-100)}), (Bytes{23, 0x1B, 100, 0}));
  EXPECT_EQ(body(ConfigRequest{1}), (Bytes{18, 0x3B, 1, 0}));
  EXPECT_EQ(body(SonarSwitch{true, 0}), (Bytes{28, 0x3B, 1, 0}));
  EXPECT_EQ(body(SonarSwitch{false, 2}), (Bytes{28, 0x3B, 4, 0}));
  EXPECT_EQ(body(Stop{}), (Bytes{29}));
  EXPECT_EQ(body(EmergencyStop{}), (Bytes{55}));
  EXPECT_EQ(body(DigitalOutput{0x01, 0x81}), (Bytes{30, 0x3B, 0x01, 0x81}));
  EXPECT_EQ(body(Say{{25, 30}}), (Bytes{15, 0x2B, 2, 25, 30}));
  EXPECT_EQ(body(Aux1Send{{0, 1, 0}}), (Bytes{42, 0x2B, 3, 0, 1, 0}));
  EXPECT_EQ(body(BatteryRequest{1}), (Bytes{62, 0x3B, 1, 0}));
  EXPECT_EQ(body(TruePose{{1.0, -0.002, radians(90)}}),
            (Bytes{224, 0x3B, 0xE8, 3, 0, 0, 0xFE, 0xFF, 0xFF, 0xFF, 90, 0, 0, 0}));
  // Counted strings may end with NUL and still be counted.
  EXPECT_EQ(decode_command(Bytes{42, 0x2B, 3, 0, 1, 0}), Command(Aux1Send{{0, 1, 0}}));
  EXPECT_EQ(decode_command(Bytes{42, 0x2B, 65, 66, 0}), Command(Aux1Send{{65, 66}}));
  // An argument's type without an argument, as one client sends SETO.
  EXPECT_EQ(decode_command(Bytes{7, 0x3B}), Command(SetOrigin{}));
  EXPECT_EQ(decode_command(Bytes{4, 0x3B}), Command(Enable{false}));
  EXPECT_EQ(decode_command(Bytes{29, 0x3B, 1, 0}), Command(Stop{}));
}

TEST(Command, StringsTakeTheFormOfTheGeneration) {
  RobotParameters parameters;
  EXPECT_EQ(body_of(encode(Polling{{0}}, parameters)), (Bytes{3, 0x2B, 1, 0}));
  parameters.protocol = Protocol::kP2os;
  EXPECT_EQ(body_of(encode(Polling{{0}}, parameters)), (Bytes{3, 0x2B, 1, 1}));
}

// Every command of the table: an argument of its form is read, and comes out again as it was.
TEST(Command, EveryLineOfTheTable) {
  int numbers = 0;
  for (const CommandRule& line : rules()) {
    const auto number = static_cast<std::uint8_t>(line.number);
    Bytes argument;
    switch (line.form) {
      case ArgumentForm::kNone:
      case ArgumentForm::kOptional:
        break;
      case ArgumentForm::kInteger:
      case ArgumentForm::kPair:
        argument = {0x3B, 1, 0};
        break;
      case ArgumentForm::kString:
        argument = {0x2B, 2, 65, 66};
        break;
      case ArgumentForm::kRaw:
        argument = {0x3B, 1, 0, 0, 0, 2, 0, 0, 0, 90, 0, 0, 0};
        break;
    }
    Bytes bytes{number};
    bytes.insert(bytes.end(), argument.begin(), argument.end());
    const Command command = decode_command(bytes);
    EXPECT_FALSE(std::holds_alternative<Unknown>(command)) << line.name;
    const Bytes again = body(command);
    EXPECT_EQ(again[0], number) << line.name;
    EXPECT_EQ(decode_command(again), command) << line.name;
    if (line.form == ArgumentForm::kInteger || line.form == ArgumentForm::kPair ||
        line.form == ArgumentForm::kRaw) {
      EXPECT_EQ(again, bytes) << line.name;
    }
    numbers = std::max<int>(numbers, number);
  }
  EXPECT_EQ(numbers, 255);
  EXPECT_EQ(rules().size(), 106U);
  EXPECT_EQ(rule(14), nullptr);
  EXPECT_EQ(rule(11)->name, "VEL");
  EXPECT_EQ(Command(IoRequest{2}), Command(Integer{Number::kIoRequest, 2}));
}

TEST(Sync, PacketsAndStrings) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(body_of(encode_sync(i)), Bytes{static_cast<std::uint8_t>(i)});
    EXPECT_EQ(sync_number(body_of(encode_sync(i))), i);
  }
  EXPECT_FALSE(sync_number(Bytes{0x32}));
  EXPECT_FALSE(sync_number({}));
  const RobotIdentity identity{"Simulator", "Pioneer", "psos43m"};
  const Bytes reply = body_of(encode_sync2_reply(identity));
  const std::string text("\2Simulator\0Pioneer\0psos43m\0", 27);
  EXPECT_EQ(reply, Bytes(text.begin(), text.end()));
  EXPECT_EQ(decode_sync2_reply(reply), identity);
}

TEST(Sync, MissingStringsAreEmptyAndLongOnesAreCut) {
  EXPECT_EQ(decode_sync2_reply(Bytes{2}), RobotIdentity{});
  EXPECT_EQ(decode_sync2_reply(Bytes{2, 'a', 0, 'b'}), (RobotIdentity{"a", "b", ""}));
  EXPECT_FALSE(decode_sync2_reply(Bytes{1}));
  const RobotIdentity identity{std::string(150, 'n'), std::string(150, 'c'), "s"};
  const auto got = decode_sync2_reply(body_of(encode_sync2_reply(identity)));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->name, identity.name);
  EXPECT_EQ(got->robot_class, std::string(44, 'c'));
  EXPECT_EQ(got->subclass, "");
}

}  // namespace
}  // namespace saphira::protocol
