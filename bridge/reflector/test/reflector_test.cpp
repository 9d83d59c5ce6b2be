#include "saphira/reflector/reflector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saphira::reflector {
namespace {

using protocol::InformationPacket;

protocol::RobotParameters pioneer() {
  return protocol::RobotParameters{
      .angle_unit = 0.0061359, .distance_unit = 0.05066e-3, .velocity_unit = 2.5332e-3};
}

Reflector open_reflector() {
  Reflector r;
  r.configure(pioneer());
  r.open(0.0, {}, 1);
  return r;
}

TEST(Reflector, ZerosFirstThenTheState) {
  Reflector r = open_reflector();
  const auto first = r.due(0.0);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0], protocol::Command(protocol::Velocity{0.0}));
  EXPECT_EQ(first[1], protocol::Command(protocol::RotationVelocity{0.0}));

  InformationPacket packet{.motors = protocol::Motors::kMoving,
                           .x = 1000,
                           .left_velocity = 100,
                           .right_velocity = 110,
                           .battery = 126,
                           .left_stall = 1,
                           .sonars = {{3, 5000}, {4, 40000}}};
  const State& s = r.packet(packet, 0.1, 2);
  EXPECT_EQ(s.cycle, 1U);
  EXPECT_EQ(s.odom, 1U);
  EXPECT_EQ(s.pose_in_odom, Pose{});
  EXPECT_NEAR(s.information.velocity, 0.105 * 2.5332, 1e-9);
  EXPECT_TRUE(s.information.left_stalled);
  EXPECT_FALSE(s.information.right_stalled);
  packet.x = 1400;
  r.packet(packet, 0.2, 2);
  EXPECT_NEAR(s.pose_in_odom.x, 400 * 0.05066e-3, 1e-9);
}

TEST(Reflector, CountsPacketsPerSecond) {
  Reflector r = open_reflector();
  InformationPacket packet{.sonars = {{0, 1000}, {1, 1000}, {2, 1000}}};
  for (int cycle = 1; cycle <= 25; ++cycle) {
    r.packet(packet, 0.1 * cycle, 2);
    EXPECT_EQ(r.state().motor_packets_per_s, std::min(10U, static_cast<unsigned>(cycle)));
  }
  EXPECT_EQ(r.state().sonar_readings_per_s, 30U);
  r.packet(packet, 4.0, 2);
  EXPECT_EQ(r.state().motor_packets_per_s, 1U);
}

TEST(Reflector, ABucketHoldsTheNewestReadingOfItsSonar) {
  protocol::RobotParameters parameters = pioneer();
  parameters.sonars = {{1, {0.1, 0.1, 0.8}}, {4, {0.1, -0.1, -0.8}}};
  Reflector r;
  r.configure(parameters);
  r.open(0.0, {}, 1);
  InformationPacket packet{.sonars = {{4, 2000}, {1, 1000}}};
  r.packet(packet, 0.1, 2);
  packet.sonars = {{4, 1500}};
  const State& state = r.packet(packet, 0.2, 2);
  ASSERT_EQ(state.buckets.size(), 2U);
  EXPECT_EQ(state.buckets[0].reading.number, 1);
  EXPECT_EQ(state.buckets[0].cycle, 1U);
  EXPECT_EQ(state.buckets[1].reading.number, 4);
  EXPECT_EQ(state.buckets[1].cycle, 2U);
  EXPECT_EQ(state.buckets[1].reading.range, state.information.sonars[0].range);
  // On the axis of the sonar, at its range.
  const double range = state.buckets[1].reading.range;
  EXPECT_GT(range, 0.0);
  EXPECT_NEAR(state.buckets[1].point.x(), 0.1 + range * std::cos(0.8), 1e-9);
  EXPECT_NEAR(state.buckets[1].point.y(), -0.1 - range * std::sin(0.8), 1e-9);
  // Poses of an old odom frame are meaningless in a new one.
  packet.x = 20000;
  packet.sonars = {};
  EXPECT_TRUE(r.packet(packet, 0.3, 3).buckets.empty());
}

TEST(Reflector, HeadingsAreInOdomWhateverTheServersFrame) {
  Reflector r = open_reflector();
  r.due(0.0);
  InformationPacket packet;
  packet.th = 256;  // 90 degrees
  packet.x = 5;
  r.packet(packet, 0.1, 2);
  EXPECT_EQ(r.state().pose_in_odom.th, 0.0);
  r.set({.rotation = Rotation::heading, .heading = radians(-60.0)});
  r.hold(r.motion().setpoints());
  const auto out = r.due(0.1);
  ASSERT_EQ(out.size(), 1U);
  const auto* heading = std::get_if<protocol::Heading>(&out[0]);
  ASSERT_NE(heading, nullptr);
  EXPECT_NEAR(degrees(heading->heading), 30.0, 1e-9);
}

TEST(Reflector, ALostOdomFrameStopsTheMotionThatWasMeantInIt) {
  Reflector r = open_reflector();
  InformationPacket packet{.x = 20000};
  r.packet(packet, 0.1, 2);
  r.set({.rotation = Rotation::heading, .heading = 1.0});
  packet.x = 0;
  r.packet(packet, 0.2, 2);
  EXPECT_EQ(r.state().odom, 2U);
  EXPECT_EQ(r.motion().setpoints(), Setpoints{});
}

TEST(Reflector, TheWatchdogHearsSomethingAtLeastTwiceASecond) {
  Reflector r = open_reflector();
  double last = 0.0;
  r.due(0.0);
  InformationPacket packet;
  for (int cycle = 1; cycle <= 100; ++cycle) {
    const double now = 0.1 * cycle;
    r.packet(packet, now, 2);
    if (!r.due(now).empty())
      last = now;
    ASSERT_LE(now - last, 0.5 + 1e-6);
  }
}

}  // namespace
}  // namespace saphira::reflector
