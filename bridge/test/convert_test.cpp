#include "convert.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saphira::bridge {
namespace {

v1::Stamp stamp(std::uint64_t epoch, std::uint64_t cycle) {
  return {.epoch = epoch, .cycle = cycle};
}

TEST(Convert, EveryFieldOfTheState) {
  reflector::State s;
  s.cycle = 9;
  s.odom = 4;
  s.pose_in_odom = {1.0, 2.0, 3.0};
  s.target_velocity = 0.25;
  s.target_heading_in_odom = -1.0;
  s.motor_packets_per_s = 10;
  s.sonar_readings_per_s = 25;
  protocol::Information& in = s.information;
  in.motors = protocol::Motors::kMoving;
  in.velocity = 0.1;
  in.rotation_velocity = 0.2;
  in.left_velocity = 0.08;
  in.right_velocity = 0.12;
  in.battery = 12.6;
  in.right_stalled = true;
  in.bumpers = 0x0100;
  in.ptu = 1500;
  in.say = 3;
  in.timer = 77;
  in.analog = 200;
  in.digital_input = 5;
  in.digital_output = 6;
  in.sonars = {{2, 1.25, true}, {3, 5.0, false}};
  const v1::RobotState out = to_bus(s, stamp(8, 9), 12);
  EXPECT_EQ(out.stamp.epoch, 8U);
  EXPECT_EQ(out.stamp.cycle, 9U);
  EXPECT_EQ(out.odom, 4U);
  EXPECT_EQ(out.pose_in_odom.x, 1.0);
  EXPECT_EQ(out.pose_in_odom.y, 2.0);
  EXPECT_EQ(out.pose_in_odom.th, 3.0);
  EXPECT_EQ(out.velocity, 0.1);
  EXPECT_EQ(out.rotation_velocity, 0.2);
  EXPECT_EQ(out.left_velocity, 0.08);
  EXPECT_EQ(out.right_velocity, 0.12);
  EXPECT_EQ(out.target_velocity, 0.25);
  EXPECT_EQ(out.target_heading_in_odom, -1.0);
  EXPECT_EQ(out.status, v1::MOTORS_MOVING);
  EXPECT_FALSE(out.left_stalled);
  EXPECT_TRUE(out.right_stalled);
  EXPECT_EQ(out.bumpers, 0x0100);
  EXPECT_EQ(out.battery, 12.6);
  EXPECT_EQ(out.ptu, 1500);
  EXPECT_EQ(out.say, 3);
  EXPECT_EQ(out.timer, 77);
  EXPECT_EQ(out.analog, 200);
  EXPECT_EQ(out.digital_input, 5);
  EXPECT_EQ(out.digital_output, 6);
  ASSERT_EQ(out.sonars.size(), 2U);
  EXPECT_EQ(out.sonars[0].sonar, 2);
  EXPECT_EQ(out.sonars[0].range, 1.25F);
  EXPECT_TRUE(out.sonars[0].echo);
  EXPECT_FALSE(out.sonars[1].echo);
  EXPECT_EQ(out.motor_packets_per_s, 10);
  EXPECT_EQ(out.sonar_readings_per_s, 25);
  EXPECT_EQ(out.bad_packets, 12U);
}

TEST(Convert, MotorCommands) {
  v1::MotorCommand in{.stamp = stamp(3, 4),
                      .source = "me",
                      .number = 5,
                      .active = true,
                      .translation = v1::TRANSLATION_POSITION,
                      .velocity = 0.2,
                      .distance = -1.0,
                      .move = 6,
                      .rotation = v1::ROTATION_HEADING,
                      .rotation_velocity = 0.3,
                      .heading = 1.5};
  EXPECT_EQ(trouble(in), "");
  const reflector::Motion motion = to_motion(in);
  EXPECT_EQ(motion.translation, reflector::Translation::position);
  EXPECT_EQ(motion.velocity, 0.2);
  EXPECT_EQ(motion.distance, -1.0);
  EXPECT_EQ(motion.move, 6U);
  EXPECT_EQ(motion.rotation, reflector::Rotation::heading);
  EXPECT_EQ(motion.rotation_velocity, 0.3);
  EXPECT_EQ(motion.heading, 1.5);
  const authority::Command command = to_drive(in, authority::Role::direct, {7}).command;
  EXPECT_EQ(command.epoch, 3U);
  EXPECT_EQ(command.cycle, 4U);
  EXPECT_EQ(command.number, 5U);
  EXPECT_EQ(command.source, "me");
  EXPECT_EQ(command.role, authority::Role::direct);
  EXPECT_EQ(command.writer[0], 7);
  EXPECT_TRUE(command.active);

  in.source = std::string(100000, 'x');
  EXPECT_LE(to_drive(in, authority::Role::direct, {7}).command.source.size(), 255U);
  in.heading = std::numeric_limits<double>::infinity();
  EXPECT_NE(trouble(in), "");
  in.heading = 0.0;
  in.velocity = 1e9;
  EXPECT_NE(trouble(in), "");
  in.velocity = 0.0;
  in.rotation = static_cast<v1::RotationMode>(99);
  EXPECT_NE(trouble(in), "");
  in.rotation = v1::ROTATION_NONE;
  in.translation = static_cast<v1::TranslationMode>(99);
  EXPECT_NE(trouble(in), "");
}

TEST(Convert, Devices) {
  reflector::Devices::Reports reports;
  protocol::Information information;
  const std::vector<reflector::DeviceRequest> requests{
      {7, 5, "me", "motors 1", {AnswerCode::given_up, "because", {}}, 25}};
  v1::Devices out = to_bus(requests, reports, information, stamp(1, 2));
  ASSERT_EQ(out.requests.size(), 1U);
  EXPECT_EQ(out.requests[0].source, "me");
  EXPECT_EQ(out.requests[0].asked, "motors 1");
  EXPECT_EQ(out.requests[0].sent, 25U);
  EXPECT_EQ(out.requests[0].answer.code, v1::ANSWER_GIVEN_UP);
  EXPECT_EQ(out.requests[0].answer.asker, 7U);
  EXPECT_EQ(out.requests[0].answer.number, 5U);
  EXPECT_EQ(out.requests[0].answer.text, "because");
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
  EXPECT_EQ(out.charge, 0.5);
  EXPECT_EQ(out.temperature, -3.0);
  EXPECT_EQ(out.compass, 1.0);
}

TEST(Convert, GrantAndGuard) {
  authority::Grant grant;
  grant.role = authority::Role::teleop;
  grant.source = "joystick";
  grant.reason = "because";
  grant.expires_in = 0.2;
  grant.command_age = 0.1;
  grant.answers = {7, 41};
  grant.number = 12;
  Told told;
  told.setpoints = {0.4, true, 1.25, 0.0};
  told.distance_left = 0.6;
  const std::vector<authority::Refusal> refused(20, {authority::Role::behaviors, "b", "weaker"});
  const v1::Grant out =
      to_bus(grant, told, {0.3, 0.2, authority::GuardAction::slow, "near"}, refused, stamp(1, 2));
  EXPECT_EQ(out.role, v1::ROLE_TELEOP);
  EXPECT_EQ(out.source, "joystick");
  EXPECT_EQ(out.reason, "because");
  EXPECT_EQ(out.expires_in, 0.2);
  EXPECT_EQ(out.command_age, 0.1);
  EXPECT_EQ(out.guard, v1::GUARD_SLOW);
  EXPECT_EQ(out.guard_reason, "near");
  EXPECT_EQ(out.asked_velocity, 0.4);
  EXPECT_EQ(out.velocity, 0.3);
  EXPECT_EQ(out.rotation, v1::ROTATION_HEADING);
  EXPECT_EQ(out.heading, 1.25);
  EXPECT_EQ(out.rotation_velocity, 0.2);
  EXPECT_EQ(out.distance_left, 0.6);
  EXPECT_EQ(out.answers, stamp(7, 41));
  EXPECT_EQ(out.number, 12U);
  EXPECT_EQ(out.refused.size(), 16U);
  EXPECT_EQ(out.refused[0].role, v1::ROLE_BEHAVIORS);
}

TEST(Convert, SonarBuckets) {
  const v1::SonarBuckets out =
      to_bus(std::vector<reflector::Bucket>{{{3, 1.5, true}, 17, {1.0, 2.0, 0.5}, {1.6, 0.1}}}, 4,
             stamp(1, 18));
  EXPECT_EQ(out.stamp, stamp(1, 18));
  EXPECT_EQ(out.odom, 4U);
  ASSERT_EQ(out.buckets.size(), 1U);
  const v1::SonarBucket& bucket = out.buckets[0];
  EXPECT_EQ(bucket.reading.sonar, 3);
  EXPECT_EQ(bucket.reading.range, 1.5F);
  EXPECT_TRUE(bucket.reading.echo);
  EXPECT_EQ(bucket.cycle, 17U);
  EXPECT_EQ(bucket.pose_in_odom.y, 2.0);
  EXPECT_EQ(bucket.x, 1.6);
  EXPECT_EQ(bucket.y, 0.1);
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
  EXPECT_EQ(sample.channels[0].x, -12);
  EXPECT_EQ(sample.channels[0].y, 5);
  EXPECT_EQ(sample.channels[0].area, 300);
  EXPECT_EQ(sample.channels[0].height, 20);
  EXPECT_EQ(sample.channels[0].width, 10);
  EXPECT_EQ(sample.channels[1].mode, v1::VISION_LINE);
  EXPECT_EQ(sample.channels[1].first, 3);
  EXPECT_EQ(sample.channels[1].count, 12);
  EXPECT_EQ(sample.channels[2].mode, v1::VISION_BLOB);
}

}  // namespace
}  // namespace saphira::bridge
