#include "saphira/protocol/impossible.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <variant>

#include "process.hpp"
#include "saphira/base/random.hpp"

namespace saphira::protocol {
namespace {

using test::source;

RobotParameters robot(const std::string& name) {
  return load_parameters(source("config/robots/" + name + ".p"));
}

InformationPacket usual() {
  return InformationPacket{.battery = 125, .sonars = {{0, 1000}, {6, 2000}}};
}

struct Case {
  const char* name;
  const char* robot;
  void (*spoil)(InformationPacket&);
  bool whole;
  const char* what;
};

class ImpossibleField : public ::testing::TestWithParam<Case> {};

TEST_P(ImpossibleField, IsNamed) {
  InformationPacket packet = usual();
  GetParam().spoil(packet);
  ServerPacket any = packet;
  const auto impossible = take_out_impossible(any, robot(GetParam().robot));
  ASSERT_TRUE(impossible);
  EXPECT_EQ(impossible->whole, GetParam().whole) << impossible->what;
  EXPECT_NE(impossible->what.find(GetParam().what), std::string::npos) << impossible->what;
  if (!GetParam().whole) {
    EXPECT_FALSE(take_out_impossible(any, robot(GetParam().robot))) << "it was taken out";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Robots, ImpossibleField,
    ::testing::Values(
        Case{"SonarBeyondTheTable", "amigo", [](auto& p) { p.sonars[1].number = 40; }, false,
             "sonar number 40; its table has 8"},
        Case{"TooManyReadings", "p3dx", [](auto& p) { p.sonars.resize(17); }, true,
             "17 sonar readings in a packet; its table has 16"},
        Case{"Turn", "p3dx",
             [](auto& p) {
               p.left_velocity = -32767;
               p.right_velocity = 32767;
             },
             true, "a turn of 183 rad/s"},
        Case{"Speed", "pioneer", [](auto& p) { p.left_velocity = p.right_velocity = 2000; }, true,
             "a speed of 5.07 m/s"},
        Case{"Heading", "p3dx", [](auto& p) { p.th = 9000; }, true, "more than a whole turn"},
        Case{"Servo", "pioneer", [](auto& p) { p.ptu = 7; }, false, "a servo at 7 us"},
        Case{"LaterBattery", "p3dx-sh", [](auto& p) { p.trailing.battery = 5000; }, false,
             "a battery of 500 V"},
        Case{"LaterTurn", "p3dx-sh",
             [](auto& p) {
               p.trailing.battery = 120;
               p.trailing.rotation = 32000;
             },
             false, "a turn of 55.9 rad/s"},
        Case{"Charge", "p3dx-sh", [](auto& p) { p.trailing.state_of_charge = 101; }, false,
             "charged to 101 %"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(Impossible, WhatIsTakenOutTakesNothingElseAlong) {
  InformationPacket packet = usual();
  packet.sonars.push_back({16, 500});
  packet.ptu = 7;  // the flags of many a server since P2OS
  packet.trailing.battery = 124;
  ServerPacket any = packet;
  EXPECT_TRUE(take_out_impossible(any, robot("p3dx")));
  packet.sonars.pop_back();
  packet.ptu = 0;
  EXPECT_EQ(std::get<InformationPacket>(any), packet);
}

TEST(Impossible, FlagsOfALaterServerAreNoFault) {
  InformationPacket packet = usual();
  packet.ptu = 7;
  ServerPacket any = packet;
  EXPECT_FALSE(take_out_impossible(any, robot("p3dx-sh")));
  EXPECT_EQ(std::get<InformationPacket>(any), packet) << "they are flags there";
  EXPECT_FALSE(take_out_impossible(any, robot("p3dx")));
  EXPECT_EQ(std::get<InformationPacket>(any).ptu, 0);
}

// A robot of each shipped file at its limits, in both directions, sends nothing impossible.
TEST(Impossible, NotWhatARobotCanDo) {
  for (const auto& entry : std::filesystem::directory_iterator(source("config/robots"))) {
    if (entry.path().extension() != ".p")
      continue;
    const RobotParameters p = load_parameters(entry.path().string());
    for (const double sign : {-1.0, 1.0}) {
      InformationPacket packet;
      const double turn = p.max_rotation_velocity / p.rotation_per_difference;
      packet.left_velocity =
          static_cast<std::int16_t>(sign * (p.max_velocity - turn) / p.velocity_unit);
      packet.right_velocity =
          static_cast<std::int16_t>(sign * (p.max_velocity + turn) / p.velocity_unit);
      packet.th = static_cast<std::int16_t>(sign * 2.0 * kPi / p.angle_unit);
      packet.ptu = p.protocol == Protocol::kArcos ? 0x3F : 1500;
      for (const SonarUnit& unit : p.sonars)
        packet.sonars.push_back({unit.number, 0xFFFF});
      const InformationPacket before = packet;
      ServerPacket any = packet;
      const auto impossible = take_out_impossible(any, p);
      EXPECT_FALSE(impossible) << entry.path() << ": " << impossible->what;
      EXPECT_EQ(std::get<InformationPacket>(any), before) << entry.path();
    }
  }
}

TEST(Impossible, PacketsThatEndWithinTheirFields) {
  const RobotParameters p = robot("p3dx");
  Bytes whole = encode(usual());
  for (const int count : {3, 60}) {
    Bytes body(whole.begin() + 3, whole.end() - 2);
    body[19] = static_cast<std::uint8_t>(count + 20);
    ServerPacket any = decode_packet(body);
    const auto impossible = take_out_impossible(any, p);
    ASSERT_TRUE(impossible) << count;
    EXPECT_TRUE(impossible->whole);
  }
  for (const PacketType type : {PacketType::kConfig, PacketType::kEncoder, PacketType::kIo,
                                PacketType::kGripper, PacketType::kVision}) {
    ServerPacket any = decode_packet(Bytes{static_cast<std::uint8_t>(type), 3});
    const auto impossible = take_out_impossible(any, p);
    ASSERT_TRUE(impossible) << packet_type_name(static_cast<std::uint8_t>(type));
    EXPECT_TRUE(impossible->whole);
  }
  ServerPacket unknown = decode_packet(Bytes{0x77, 3});
  EXPECT_FALSE(take_out_impossible(unknown, p)) << "nobody knows what it may hold";
}

TEST(Impossible, InOtherPackets) {
  const RobotParameters p = robot("p3dx");
  const auto what = [&p](ServerPacket packet) {
    const auto impossible = take_out_impossible(packet, p);
    return impossible ? impossible->what : "";
  };
  EXPECT_EQ(what(IoPacket{{1}, {2}, {0, 1023}}), "");
  EXPECT_NE(what(IoPacket{{1}, {2}, {1024}}), "");
  EXPECT_EQ(what(GripperPacket{2, 0xFF, 0xFF}), "");
  EXPECT_NE(what(GripperPacket{3, 0, 0}), "");
  VisionPacket vision;
  vision.channels[2].x = -541;
  EXPECT_NE(what(vision), "");
  vision.channels[2].x = -100;
  EXPECT_EQ(what(vision), "");
}

// The remaining values of a random packet lie within the limits of the contract.
TEST(Impossible, NothingElseIsLeftOfRandomPackets) {
  Random random(5);
  int kept = 0;
  for (const char* name :
       {"pioneer", "p2dx", "p3dx", "p3dx-sh", "khepera", "amigo", "powerbot-sh"}) {
    const RobotParameters p = robot(name);
    for (int i = 0; i < 20000; ++i) {
      const Bytes whole = encode(usual());
      Bytes body(whole.begin() + 3, whole.end() - 2);
      body.resize(body.size() + random.next() % 24);
      // From nearly right to pure noise.
      const std::uint64_t spoiled = 1 + random.next() % (i % 2 == 0 ? 4 : body.size());
      for (std::uint64_t n = 0; n < spoiled; ++n)
        body[1 + random.next() % (body.size() - 1)] = static_cast<std::uint8_t>(random.next());
      ServerPacket any = decode_packet(body);
      const auto impossible = take_out_impossible(any, p);
      const auto* packet = std::get_if<InformationPacket>(&any);
      if ((impossible && impossible->whole) || packet == nullptr) {
        ASSERT_TRUE(impossible) << "an information packet that vanished";
        continue;
      }
      ++kept;
      const Information in = interpret(*packet, p);
      ASSERT_LE(std::abs(in.velocity), 2.0 * p.max_velocity + 1.0);
      ASSERT_LE(std::abs(in.rotation_velocity), 2.0 * p.max_rotation_velocity + kPi);
      ASSERT_LE(std::abs(in.th), kPi);
      ASSERT_LE(std::abs(in.control), kPi);
      ASSERT_LE(in.battery, 60.0);
      ASSERT_TRUE(in.ptu == 0 || (in.ptu >= kShortestPulse && in.ptu <= kLongestPulse)) << in.ptu;
      ASSERT_LE(in.sonars.size(), 64U);
      for (const Sonar& sonar : in.sonars) {
        ASSERT_LT(sonar.number, p.sonars.size());
        ASSERT_GE(sonar.range, 0.0);
        ASSERT_LE(sonar.range, kNoEcho);
      }
      ASSERT_LE(std::abs(in.compass.value_or(0.0)), kPi);
      ASSERT_LE(std::abs(in.lateral_velocity.value_or(0.0)), 2.0 * p.max_velocity + 1.0);
      ASSERT_GE(in.temperature.value_or(0.0), -40.0);
      ASSERT_LE(in.state_of_charge.value_or(0.0), 1.0);
    }
  }
  EXPECT_GT(kept, 1000);
}

}  // namespace
}  // namespace saphira::protocol
