#include "convert.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saphira::bridge {
namespace {

v1::Stamp stamp(std::uint64_t epoch, std::uint64_t cycle) {
  return {.epoch = epoch, .cycle = cycle};
}

TEST(Convert, AMotorCommandThatIsNoneIsRefused) {
  const v1::MotorCommand good{.translation = v1::TRANSLATION_POSITION,
                              .velocity = 0.2,
                              .distance = -1.0,
                              .rotation = v1::ROTATION_HEADING,
                              .heading = 1.5};
  EXPECT_EQ(trouble(good), "");
  EXPECT_EQ(to_motion(good).translation, reflector::Translation::position);
  EXPECT_EQ(to_motion(good).rotation, reflector::Rotation::heading);
  v1::MotorCommand bad = good;
  bad.heading = std::numeric_limits<double>::infinity();
  EXPECT_NE(trouble(bad), "");
  bad = good;
  bad.velocity = 1e9;
  EXPECT_NE(trouble(bad), "");
  bad = good;
  bad.rotation = static_cast<v1::RotationMode>(99);
  EXPECT_NE(trouble(bad), "");
  bad = good;
  bad.translation = static_cast<v1::TranslationMode>(99);
  EXPECT_NE(trouble(bad), "");
  bad = good;
  bad.source = std::string(100000, 'x');
  EXPECT_LE(to_drive(bad, authority::Role::direct, {7}).command.source.size(), 255U);
  bad.source.clear();
  EXPECT_EQ(to_drive(bad, authority::Role::direct, {7}).command.source, "a program without a name");
}

TEST(Convert, Devices) {
  reflector::Devices::Reports reports;
  protocol::Information information;
  const std::vector<reflector::DeviceRequest> requests{
      {7, 5, "me", "motors 1", {AnswerCode::given_up, "because", {}}, 25}};
  v1::Devices out = to_bus(requests, reports, information, stamp(1, 2));
  ASSERT_EQ(out.requests.size(), 1U);
  EXPECT_EQ(out.requests[0].answer.code, v1::ANSWER_GIVEN_UP);
  EXPECT_EQ(out.requests[0].answer.asker, 7U);
  EXPECT_EQ(out.requests[0].answer.number, 5U);
  EXPECT_FALSE(out.has_flags || out.has_io || out.has_gripper || out.has_encoders ||
               out.has_charge || out.has_temperature || out.has_configuration);

  reports.configuration.emplace().firmware = "2.1";
  reports.encoders = {-5, 6};
  reports.io = {{1, 2}, {3}, {1023}};
  reports.gripper = {2, 0x12, 9};
  reports.unread = {{0x9A, 3}};
  information.motors_on = true;
  information.emergency_stop = true;
  information.state_of_charge = 0.5;
  information.temperature = -3.0;
  information.compass = 1.0;
  out = to_bus(requests, reports, information, stamp(1, 2));
  EXPECT_EQ(out.firmware, "2.1");
  EXPECT_EQ(out.left_encoder, -5);
  EXPECT_EQ(out.digital_inputs, (std::vector<std::uint8_t>{1, 2}));
  EXPECT_EQ(out.analog_inputs.at(0), 1023);
  EXPECT_EQ(out.gripper_state, 0x12);
  EXPECT_EQ(out.unread_packets.at(0).count, 3U);
  EXPECT_TRUE(out.has_flags && out.motors_on && out.emergency_stop);
  EXPECT_TRUE(out.has_io && out.has_gripper && out.has_encoders);
  EXPECT_EQ(out.charge, 0.5);
  EXPECT_EQ(out.temperature, -3.0);
  EXPECT_EQ(out.compass, 1.0);
}

TEST(Convert, OfManyRefusalsAsManyAsTheContractTakes) {
  const std::vector<authority::Refusal> refused(20, {authority::Role::behaviors, "b", "weaker"});
  authority::Grant grant;
  grant.role = authority::Role::teleop;
  const v1::Grant out =
      to_bus(grant, {}, {0.3, 0.2, authority::GuardAction::slow, "near"}, refused, stamp(1, 2));
  EXPECT_EQ(out.role, v1::ROLE_TELEOP);
  EXPECT_EQ(out.guard, v1::GUARD_SLOW);
  EXPECT_EQ(out.refused.size(), 16U);
  EXPECT_EQ(out.refused[0].role, v1::ROLE_BEHAVIORS);
}

TEST(Convert, VisionChannels) {
  protocol::VisionPacket packet;
  using Mode = protocol::VisionChannel::Mode;
  packet.channels[0] = {Mode::kBlobWithBox, -12, 5, 300, 20, 10, 0, 0};
  packet.channels[1] = {Mode::kLine, 7, 0, 0, 0, 0, 3, 12};
  packet.channels[2] = {Mode::kBlob, 1, 2, 3, 0, 0, 0, 0};
  const v1::VisionChannels sample = to_bus(packet);
  ASSERT_EQ(sample.channels.size(), 3U);
  EXPECT_EQ(sample.channels[0].mode, v1::VISION_BLOB_BOX);
  EXPECT_EQ(sample.channels[1].mode, v1::VISION_LINE);
  EXPECT_EQ(sample.channels[2].mode, v1::VISION_BLOB);
}

}  // namespace
}  // namespace saphira::bridge
