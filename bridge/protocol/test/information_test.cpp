#include "saphira/protocol/information.hpp"

#include <gtest/gtest.h>

#include "saphira/base/random.hpp"

namespace saphira::protocol {
namespace {

Bytes body_of(const Bytes& packet) {
  return {packet.begin() + 3, packet.end() - 2};
}

InformationPacket sample() {
  return InformationPacket{.motors = Motors::kMoving,
                           .x = 0x7FFE,
                           .y = 0x1234,
                           .th = -256,
                           .left_velocity = -40,
                           .right_velocity = 100,
                           .battery = 126,
                           .left_stall = 1,
                           .right_stall = 0,
                           .control = 512,
                           .ptu = 1500,
                           .say = 3,
                           .sonars = {{3, 5000}, {0, 28836}},
                           .timer = 77,
                           .analog = 200,
                           .digital_input = 0x0F,
                           .digital_output = 0xA5};
}

// Table 5-5 in order; little-endian; one stall field of two bytes.
TEST(Information, BytesAreTheTables) {
  EXPECT_EQ(body_of(encode(sample())),
            (Bytes{0x33, 0xFE, 0x7F, 0x34, 0x12, 0x00, 0xFF, 0xD8, 0xFF, 100, 0,
                   126,  1,    0,    0x00, 0x02, 0xDC, 0x05, 3,    2,    3,   0x88,
                   0x13, 0,    0xA4, 0x70, 77,   0,    200,  0x0F, 0xA5}));
}

TEST(Information, SurvivesTheWire) {
  EXPECT_EQ(decode_information(body_of(encode(sample()))), sample());
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    InformationPacket p = sample();
    p.x = static_cast<std::uint16_t>(random.next() & 0x7FFFU);
    p.th = static_cast<std::int16_t>(random.next());
    p.control = static_cast<std::int16_t>(random.next());
    p.sonars.resize(random.next() % (kMaxSonarsInPacket + 1));
    for (auto& sonar : p.sonars)
      sonar = {static_cast<std::uint8_t>(random.next()), static_cast<std::uint16_t>(random.next())};
    ASSERT_EQ(decode_information(body_of(encode(p))), p);
  }
}

InformationPacket arcos_sample() {
  InformationPacket packet = sample();
  packet.trailing = {122, 3, -450, 0x8001, 20, 31, 80, 0x01020304, 7};
  return packet;
}

TEST(Information, AppendedFieldsAreSkippedAndCounted) {
  Bytes body = body_of(encode(arcos_sample()));
  body.insert(body.end(), {1, 2, 3, 4, 5});
  auto packet = decode_information(body);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->unknown_bytes, 5U);
  packet->unknown_bytes = 0;
  EXPECT_EQ(packet, arcos_sample());
}

// Order and size of the fields that ARCOS appends; a packet may end anywhere in them.
TEST(Information, EachTrailingFieldMayBeMissing) {
  const Bytes body = body_of(encode(arcos_sample()));
  const std::size_t start = body_of(encode(sample())).size();
  const Bytes expected{122, 0, 3, 0x3E, 0xFE, 1, 0x80, 20, 0, 31, 80, 4, 3, 2, 1, 7, 0, 0, 0};
  EXPECT_EQ(Bytes(body.begin() + static_cast<std::ptrdiff_t>(start), body.end()), expected);
  const std::size_t ends[] = {0, 2, 3, 5, 7, 9, 10, 11, 15, 19};
  for (std::size_t size = 0; size <= expected.size(); ++size) {
    const auto packet = decode_information(ByteView(body).first(start + size));
    ASSERT_TRUE(packet) << size;
    const TrailingFields& t = packet->trailing;
    const std::size_t present =
        std::size_t{t.battery.has_value()} + std::size_t{t.charge_state.has_value()} +
        std::size_t{t.rotation.has_value()} + std::size_t{t.faults.has_value()} +
        std::size_t{t.lateral.has_value()} + std::size_t{t.temperature.has_value()} +
        std::size_t{t.state_of_charge.has_value()} + std::size_t{t.time.has_value()} +
        std::size_t{t.flags3.has_value()};
    std::size_t fit = 0;
    while (fit + 1 < std::size(ends) && ends[fit + 1] <= size)
      ++fit;
    EXPECT_EQ(present, fit) << size;
    EXPECT_EQ(packet->unknown_bytes, size - ends[fit]) << size;
  }
}

TEST(Information, MeaningByGeneration) {
  InformationPacket packet = arcos_sample();
  packet.left_stall = 0b00010101;   // stalled; rear switches 2 and 4
  packet.right_stall = 0b00000010;  // front switch 1
  packet.ptu = kFlagMotors | kFlagEmergencyStop;
  packet.say = 45;
  RobotParameters p;
  Information psos = interpret(packet, p);
  EXPECT_EQ(psos.front_bumpers, 0);
  EXPECT_FALSE(psos.motors_on);
  EXPECT_EQ(psos.ptu, packet.ptu);
  EXPECT_NEAR(psos.battery, packet.battery / 10.0, 1e-12);

  p.protocol = Protocol::kP2os;
  p.front_bumpers = 5;
  p.rear_bumpers = 4;
  p.compass = true;
  const Information p2os = interpret(packet, p);
  EXPECT_TRUE(p2os.left_stalled);
  EXPECT_FALSE(p2os.right_stalled);
  EXPECT_EQ(p2os.front_bumpers, 0b00001);
  EXPECT_EQ(p2os.rear_bumpers, 0b1010);
  EXPECT_NEAR(p2os.compass.value(), radians(90), 1e-12);
  EXPECT_FALSE(p2os.motors_on);

  p.protocol = Protocol::kArcos;
  const Information arcos = interpret(packet, p);
  EXPECT_TRUE(arcos.motors_on.value());
  EXPECT_TRUE(arcos.emergency_stop.value());
  EXPECT_NEAR(arcos.battery, 12.2, 1e-12);
  EXPECT_NEAR(arcos.rotation_velocity, radians(-45), 1e-12);
  EXPECT_NEAR(arcos.temperature.value(), 31.0, 1e-12);
  EXPECT_NEAR(arcos.state_of_charge.value(), 0.8, 1e-12);
  packet.trailing.temperature = -128;
  packet.ptu = 0;
  EXPECT_FALSE(interpret(packet, p).temperature);
  EXPECT_EQ(interpret(packet, p).motors, Motors::kNoPower);
}

TEST(Information, EverythingBehindTheSonarsMayBeMissing) {
  Bytes body = body_of(encode(sample()));
  for (int i = 0; i < 5; ++i) {
    body.pop_back();
    const auto packet = decode_information(body);
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->sonars, sample().sonars);
    EXPECT_EQ(packet->digital_output, 0);
  }
  while (!body.empty()) {
    body.pop_back();
    EXPECT_FALSE(decode_information(body)) << body.size();
  }
}

TEST(Information, OtherPacketsAreNot) {
  for (int type = 0; type < 256; ++type) {
    Bytes body = body_of(encode(sample()));
    body[0] = static_cast<std::uint8_t>(type);
    EXPECT_EQ(decode_information(body).has_value(), type >= 0x31 && type <= 0x34) << type;
  }
}

TEST(Information, TooManySonarsAreLeftOut) {
  InformationPacket p;
  p.sonars.resize(100);
  const auto got = decode_information(body_of(encode(p)));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->sonars.size(), kMaxSonarsInPacket);
}

TEST(Information, InSiUnits) {
  RobotParameters pioneer;  // the conversion factors of the Pioneer 1
  const Information in = interpret(sample(), pioneer);
  EXPECT_EQ(in.motors, Motors::kMoving);
  EXPECT_NEAR(in.th, -kPi / 2, 1e-4);
  EXPECT_NEAR(in.left_velocity, -0.101328, 1e-9);
  EXPECT_NEAR(in.right_velocity, 0.25332, 1e-9);
  EXPECT_NEAR(in.velocity, 0.075996, 1e-9);
  EXPECT_NEAR(in.rotation_velocity, (0.25332 + 0.101328) / 2 * 3.33333, 1e-9);
  EXPECT_NEAR(in.battery, 12.6, 1e-9);
  EXPECT_TRUE(in.left_stalled);
  EXPECT_FALSE(in.right_stalled);
  EXPECT_EQ(in.bumpers, 1);
  EXPECT_NEAR(std::abs(in.control), kPi, 1e-3);
  ASSERT_EQ(in.sonars.size(), 2U);
  EXPECT_EQ(in.sonars[0].number, 3);
  EXPECT_NEAR(in.sonars[0].range, 0.867, 1e-9);
  EXPECT_TRUE(in.sonars[0].echo);
  EXPECT_FALSE(in.sonars[1].echo);
}

// 5000 means that no echo was received, whatever the robot's unit of range.
TEST(Information, FiveThousandMillimetresAreNoEcho) {
  for (const double unit : {0.1734e-3, 0.229e-3, 0.268e-3, 1e-3}) {
    RobotParameters parameters{.range_unit = unit};
    InformationPacket p{.sonars = {{0, static_cast<std::uint16_t>(std::lround(5.0 / unit))},
                                   {1, static_cast<std::uint16_t>(std::lround(5.0 / unit) - 2)}}};
    const Information in = interpret(p, parameters);
    EXPECT_FALSE(in.sonars[0].echo) << unit;
    EXPECT_TRUE(in.sonars[1].echo) << unit;
  }
}

// Manual 5.5.1.
TEST(Information, ThePositionRollsOver) {
  EXPECT_EQ(position_difference(0x7FFF, 0), 1);
  EXPECT_EQ(position_difference(0, 0x7FFF), -1);
  EXPECT_EQ(position_difference(5, 5), 0);
  EXPECT_EQ(position_difference(0, 0x3FFF), 0x3FFF);
}

}  // namespace
}  // namespace saphira::protocol
