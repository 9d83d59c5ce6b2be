#include "saphira/reflector/channels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "saphira/base/random.hpp"

namespace saphira::reflector {
namespace {

constexpr auto kVel = protocol::Number::kVelocity;
constexpr auto kHead = protocol::Number::kHeading;
constexpr auto kRvel = protocol::Number::kRotationVelocity;
constexpr Order kVelZero{kVel, 0};
constexpr Order kRvelZero{kRvel, 0};

Setpoints speed(double v) {
  return {v, false, 0.0, 0.0};
}

/// Connected, with the zero setpoints sent.
Channels at_zero() {
  Channels channels;
  channels.connect();
  channels.due(100.0);
  return channels;
}

TEST(Channels, ZeroSetpointsComeFirst) {
  Channels channels;
  channels.connect();
  EXPECT_EQ(channels.due(100.0), (std::vector<Order>{kVelZero, kRvelZero}));
  EXPECT_TRUE(channels.due(100.0).empty());
  // Zeros are sent again on the next connection, although zero was sent last.
  channels.connect();
  EXPECT_EQ(channels.due(100.1), (std::vector<Order>{kVelZero, kRvelZero}));
}

TEST(Channels, AChangeGoesOutAtOnceAndOnceACycle) {
  Channels channels = at_zero();
  channels.cycle({});
  EXPECT_TRUE(channels.due(100.1).empty()) << "shown: nothing to say";
  channels.want(speed(0.3), 0.0);
  EXPECT_EQ(channels.due(100.11), (std::vector<Order>{{kVel, 300}}));
  EXPECT_DOUBLE_EQ(channels.sent_velocity(), 0.3);
  channels.want(speed(0.2), 0.0);
  EXPECT_TRUE(channels.due(100.12).empty()) << "one command a cycle";
  channels.want(speed(0.0), 0.0);
  EXPECT_EQ(channels.due(100.13), (std::vector<Order>{kVelZero})) << "but a stop does not wait";
  EXPECT_TRUE(channels.due(100.14).empty());
}

TEST(Channels, AnEmergencyStopIsSentBehindZeroSetpoints) {
  const std::vector<Order> brake{{protocol::Number::kVelocity, 0},
                                 {protocol::Number::kRotationVelocity, 0},
                                 {protocol::Number::kEmergencyStop, 0}};
  Channels channels = at_zero();
  channels.want(speed(0.3), 0.0);
  channels.due(100.1);
  channels.cycle({0.3, 0.0, 0.0});
  channels.brake(true);
  EXPECT_EQ(channels.due(100.11), brake);
  channels.brake(true);
  EXPECT_TRUE(channels.due(100.12).empty()) << "once a cycle";
  EXPECT_EQ(channels.sent_velocity(), 0.0);
  channels.cycle({0.2, 0.0, 0.0});
  EXPECT_EQ(channels.due(100.21), brake) << "it still moves";
  channels.cycle({0.0, 0.5, 0.0});
  EXPECT_EQ(channels.due(100.31), brake) << "it still turns";
  channels.cycle({});
  EXPECT_TRUE(channels.due(100.41).empty());
  EXPECT_FALSE(channels.pending(100.7));
  EXPECT_EQ(channels.due(100.82), brake) << "the beat";
  channels.brake(false);
  EXPECT_EQ(channels.due(100.9), (std::vector<Order>{kVelZero, kRvelZero}));
}

TEST(Channels, RepeatsUntilShownAndThenEveryHalfSecond) {
  Channels channels = at_zero();
  channels.cycle({});
  channels.want(speed(0.3), 0.0);
  int sent = 0;
  for (int cycle = 1; cycle <= 40; ++cycle) {
    const double now = 100.0 + 0.1 * cycle;
    channels.cycle({cycle <= 20 ? 0.01 * cycle : 0.3, 0.0, 0.0});
    int vel = 0;
    for (const Order& order : channels.due(now)) {
      if (order == Order{kVel, 300})
        ++vel;
    }
    if (cycle <= 20)
      EXPECT_EQ(vel, 1) << cycle;
    else
      sent += vel;
  }
  EXPECT_EQ(sent, 4);
}

TEST(Channels, OrdersAreWholeInThePacket) {
  for (int argument = -400; argument <= 400; ++argument) {
    for (const Order order : {Order{kVel, argument}, Order{kHead, (argument + 720) % 360},
                              Order{kRvel, argument / 2}}) {
      const protocol::Bytes packet = protocol::encode(to_command(order));
      const int sign = packet.at(4) == 0x1B ? -1 : 1;
      ASSERT_EQ(packet.at(3), static_cast<int>(order.number));
      ASSERT_EQ(sign * (packet.at(5) | packet.at(6) << 8), order.argument);
    }
  }
}

TEST(Channels, BeatsWithoutPackets) {
  Channels channels = at_zero();
  EXPECT_FALSE(channels.pending(100.4));
  EXPECT_TRUE(channels.pending(100.5));
  EXPECT_EQ(channels.due(100.5).size(), 2U);
}

TEST(Channels, HeadingsAreTheServersDegrees) {
  Channels channels = at_zero();
  channels.cycle({});
  channels.want({0.0, true, radians(-30.0), 0.0}, radians(10.0));
  EXPECT_EQ(channels.due(100.1), (std::vector<Order>{{kHead, 320}}));
  channels.cycle({0.0, 0.0, radians(-40.4)});
  EXPECT_TRUE(channels.due(100.2).empty()) << "control shows it";
  channels.want({0.0, true, radians(-0.4), 0.0}, 0.0);
  channels.cycle({0.0, 0.0, radians(-40.4)});
  EXPECT_EQ(channels.due(100.3), (std::vector<Order>{{kHead, 0}})) << "not 360";
}

// Over a line that loses 60 % of the commands, the server reaches every setpoint that stays.
TEST(Channels, GetThroughALossyLine) {
  Random random(5);
  Channels channels;
  channels.connect();
  std::map<protocol::Number, int> server;
  double v = 0.0;
  double w = 0.0;
  double now = 0.0;
  for (int change = 0; change < 200; ++change) {
    const double wanted = 0.01 * std::floor(random.uniform(-40.0, 40.0));
    const double turn = radians(std::floor(random.uniform(-90.0, 90.0)));
    for (int cycle = 0; cycle < 30; ++cycle) {
      now += 0.1;
      channels.cycle({v, w, 0.0});
      channels.want({wanted, false, 0.0, turn}, 0.0);
      for (const Order& order : channels.due(now)) {
        if (!random.chance(0.6))
          server[order.number] = order.argument;
      }
      v += std::clamp(server[kVel] * 0.001 - v, -0.05, 0.05);
      w += std::clamp(radians(server[kRvel]) - w, -0.5, 0.5);
    }
    ASSERT_NEAR(v, wanted, 0.021) << change;
    ASSERT_NEAR(w, turn, 0.1) << change;
  }
}

}  // namespace
}  // namespace saphira::reflector
