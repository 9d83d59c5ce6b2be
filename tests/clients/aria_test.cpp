// A stand-in of the ARIA family of clients: its packets, requirements and weaknesses, from its
// sources and its traffic (connection states of ArRobot, SIP of ArRobot::processMotorPacket). It
// has its own packets and its own parameters, without the project's protocol library.

#include <gtest/gtest.h>

#include "aria_client.hpp"

namespace saphira::test {
namespace {

class Aria : public ::testing::TestWithParam<std::string> {};

TEST_P(Aria, ConnectsConfiguresDrivesSeesAndStops) {
  Line line(GetParam());
  AriaClient client(line);
  ASSERT_EQ(client.connect(), "");
  EXPECT_EQ(client.robot_class(), "Pioneer");
  const bool psos = line.parameters().protocol == protocol::Protocol::kPsos;
  EXPECT_EQ(client.has_config(), !psos);
  if (!psos) {
    // With zeros there it would only send VEL 0.
    EXPECT_EQ(client.config_velocity_max(),
              static_cast<int>(line.parameters().max_velocity * 1000.0));
  }

  client.poll(2.0);
  EXPECT_GE(client.sips(), 19);
  EXPECT_GT(client.battery(), 10.0);
  EXPECT_EQ(client.motors_on(), !psos);  // a Pioneer 1 has the servo in that word
  const KnownRobot& known = *client.known();
  ASSERT_TRUE(client.sonar().contains(known.front));
  // The wall is 3 m from the robot's middle; the beam is some degrees wide.
  const double ahead = (3000.0 - known.front_x);
  EXPECT_NEAR(client.sonar().at(known.front), ahead, 150.0);
  EXPECT_EQ(client.sonar().size(), static_cast<std::size_t>(known.sonars));
  EXPECT_EQ(client.unknown_sonars(), 0);

  client.drive_a_metre();
  EXPECT_NEAR(client.x(), 1000.0, 30.0);
  EXPECT_NEAR(line.robot().pose_in_world().x - line.start().x, 1.0, 0.06);
  EXPECT_FALSE(line.robot().moving());
  EXPECT_NEAR(client.sonar().at(known.front), ahead - 1000.0, 150.0);

  client.turn_to(90);
  EXPECT_NEAR(client.th(), 90.0, 2.0);
  EXPECT_NEAR(degrees(line.robot().pose_in_world().th), 90.0, 6.0);
  client.turn_to(-45);
  EXPECT_NEAR(client.th(), -45.0, 2.0);

  client.disconnect();
  EXPECT_FALSE(line.server().is_open());
  EXPECT_FALSE(line.next()) << "a packet after CLOSE";
  EXPECT_FALSE(client.lost());
  EXPECT_EQ(line.server().counters().unknown_commands, 0U);
  EXPECT_EQ(line.server().counters().watchdog_stops, 0U);
  EXPECT_EQ(line.violations(), "");
}

std::vector<std::string> subclasses() {
  std::vector<std::string> out;
  for (const KnownRobot& robot : all_known())
    out.emplace_back(robot.subclass);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Robots, Aria, ::testing::ValuesIn(subclasses()),
                         [](const auto& robot) { return test_name(robot.param); });

// A killed client did not send CLOSE; on a serial line the robot continues to send.
TEST(AriaAgain, FindsAnOpenRobot) {
  Line line("p3dx-sh");
  {
    AriaClient client(line);
    ASSERT_EQ(client.connect(), "");
    client.poll(0.3);
  }
  line.wait(0.15);
  AriaClient client(line);
  EXPECT_EQ(client.connect(), "");
  client.poll(1.0);
  EXPECT_GE(client.sips(), 9);
}

// Its bytes, as observed on the wire.
TEST(AriaAgain, TheOpeningByteForByte) {
  EXPECT_EQ(packet(Wire{0}), (Wire{0xFA, 0xFB, 3, 0, 0, 0}));
  EXPECT_EQ(packet(Wire{1}), (Wire{0xFA, 0xFB, 3, 1, 0, 1}));
  EXPECT_EQ(packet(1, 1), (Wire{0xFA, 0xFB, 6, 1, 0x3B, 1, 0, 2, 0x3B}));
  EXPECT_EQ(packet(18, 1), (Wire{0xFA, 0xFB, 6, 18, 0x3B, 1, 0, 0x13, 0x3B}));
  EXPECT_EQ(packet(12, -90), (Wire{0xFA, 0xFB, 6, 12, 0x1B, 90, 0, 0x66, 0x1B}));
}

}  // namespace
}  // namespace saphira::test
