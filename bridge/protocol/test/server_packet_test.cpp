#include "saphira/protocol/server_packet.hpp"

#include <gtest/gtest.h>

namespace saphira::protocol {
namespace {

Bytes body_of(const Bytes& packet) {
  return {packet.begin() + 3, packet.end() - 2};
}

TEST(ServerPacket, BytesOfTheSmallOnes) {
  EXPECT_EQ(body_of(encode(EncoderPacket{1, -2})),
            (Bytes{0x90, 1, 0, 0, 0, 0xFE, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(body_of(encode(IoPacket{{0xA5}, {0x0F, 1}, {512}})),
            (Bytes{0xF0, 1, 0xA5, 2, 0x0F, 1, 1, 0, 2}));
  EXPECT_EQ(body_of(encode(GripperPacket{2, 0x11, 20})), (Bytes{0xE0, 2, 0x11, 20}));
  EXPECT_EQ(body_of(encode(AuxPacket{2, {7, 8}})), (Bytes{0xB8, 7, 8}));
  EXPECT_EQ(body_of(encode(GyroPacket{{{510, 128}}})), (Bytes{0x98, 1, 0xFE, 1, 128}));
  EXPECT_EQ(body_of(encode(BatteryPacket{1, 2, {3, 4}})), (Bytes{0xFA, 1, 2, 3, 4}));
}

TEST(ServerPacket, SurviveTheWire) {
  VisionPacket vision;
  vision.channels[0] = {VisionChannel::Mode::kBlob, -12, 5, 300, 0, 0, 0, 0};
  vision.channels[1] = {VisionChannel::Mode::kBlobWithBox, 40, -3, 90, 10, 9, 0, 0};
  vision.channels[2] = {VisionChannel::Mode::kLine, 7, 0, 0, 0, 0, 3, 12};
  EXPECT_EQ(std::get<VisionPacket>(decode_packet(body_of(encode(vision)))), vision);
  const SimStatusPacket status{1, 100, 100, 99, 1000, -2000, 0, 90, 0, 0, 0, -1, 3, -4, 5};
  EXPECT_EQ(body_of(encode(status)).size(), 1U + 2 + 4 + 6 + 16 + 12 + 1 + 12);
  EXPECT_EQ(std::get<SimStatusPacket>(decode_packet(body_of(encode(status)))), status);
  const SimLaserPacket laser{1, -2, 3, 181, 0, {4000, 32000}};
  EXPECT_EQ(std::get<SimLaserPacket>(decode_packet(body_of(encode(laser)))), laser);
  const JoystickPacket joystick{1, 0, 600, 400, 512};
  EXPECT_EQ(std::get<JoystickPacket>(decode_packet(body_of(encode(joystick)))), joystick);
  const IoPacket io{{1}, {2}, {3, 1023}};
  EXPECT_EQ(std::get<IoPacket>(decode_packet(body_of(encode(io)))), io);
  const AuxPacket aux{3, {0, 1, 2}};
  EXPECT_EQ(std::get<AuxPacket>(decode_packet(body_of(encode(aux)))), aux);
  InformationPacket information{.sonars = {{3, 1000}}};
  EXPECT_EQ(std::get<InformationPacket>(decode_packet(body_of(encode(information)))), information);
}

// The place of each field, from the client's reader.
TEST(ServerPacket, Config) {
  RobotParameters p{.robot_class = "Pioneer",
                    .subclass = "p3dx-sh",
                    .protocol = Protocol::kArcos,
                    .switch_to_baud = 38400,
                    .watchdog = 2.0,
                    .front_bumpers = 5,
                    .encoder_unit = 0.001 / 128,
                    .max_velocity = 0.75};
  const ConfigPacket config = config_of(p, "MyRobot", "1234");
  const Bytes body = body_of(encode(config));
  const std::string strings = std::string("Pioneer\0p3dx-sh\0", 16) + std::string("1234\0", 5);
  EXPECT_EQ(body[0], 0x20);
  EXPECT_EQ(std::string(body.begin() + 1, body.begin() + 22), strings);
  EXPECT_EQ(body[22], 0);  // four motors
  EXPECT_EQ(body[23] | body[24] << 8, 100);
  EXPECT_EQ(body[25] | body[26] << 8, 750);
  EXPECT_EQ(std::string(body.begin() + 33, body.begin() + 40), "MyRobot");
  EXPECT_EQ(body[41], 100);  // cycle
  EXPECT_EQ(std::get<ConfigPacket>(decode_packet(body)), config);
  EXPECT_GT(config.rotation_acceleration_top, 0);
  EXPECT_EQ(config.watchdog, 2000);
  EXPECT_EQ(config.encoder_ticks_per_mm, 128);
  EXPECT_EQ(config.reset_baud, 2);
  // Older servers' end early.
  const auto early = std::get<ConfigPacket>(decode_packet(ByteView(body).first(30)));
  EXPECT_EQ(early.velocity_top, 750);
  EXPECT_EQ(early.velocity_max, 0);
}

// Any packet cut anywhere is read, or is an OtherPacket; never half of a packet.
TEST(ServerPacket, CutPackets) {
  const Bytes bodies[] = {body_of(encode(EncoderPacket{1, 2})),
                          body_of(encode(IoPacket{{1}, {2}, {3}})),
                          body_of(encode(GripperPacket{1, 2, 3})),
                          body_of(encode(GyroPacket{{{1, 2}}})),
                          body_of(encode(JoystickPacket{})),
                          body_of(encode(VisionPacket{})),
                          body_of(encode(SimLaserPacket{0, 0, 0, 1, 0, {5}})),
                          body_of(encode(SimStatusPacket{}))};
  for (const Bytes& body : bodies) {
    EXPECT_FALSE(std::holds_alternative<OtherPacket>(decode_packet(body))) << int{body[0]};
    for (std::size_t size = 1; size < body.size(); ++size)
      EXPECT_TRUE(std::holds_alternative<OtherPacket>(decode_packet(ByteView(body).first(size))))
          << int{body[0]} << " " << size;
  }
}

TEST(ServerPacket, UnknownTypesAreKeptAsTheyCame) {
  EXPECT_EQ(std::get<OtherPacket>(decode_packet(Bytes{0x42, 1, 2})), (OtherPacket{0x42, {1, 2}}));
  EXPECT_EQ(std::get<OtherPacket>(decode_packet(Bytes{0xD0, 1})), (OtherPacket{0xD0, {1}}));
  EXPECT_EQ(packet_type_name(0xD0), "PLAYLIST");
  EXPECT_EQ(packet_type_name(0x42), "");
}

}  // namespace
}  // namespace saphira::protocol
