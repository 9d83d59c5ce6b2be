// A stand-in of the BeeSoft family of clients, which is strict with the information packet.

#include <gtest/gtest.h>

#include "beesoft_client.hpp"

namespace saphira::test {
namespace {

struct Robot {
  const char* subclass;
  int fewest;
  int most;
};

class Bee : public ::testing::TestWithParam<Robot> {};

TEST_P(Bee, EveryPacketObeys) {
  Line line(GetParam().subclass);
  BeeClient client(line, GetParam().fewest, GetParam().most);
  ASSERT_TRUE(client.connect());
  const double x0 = line.robot().pose_in_world().x;
  ASSERT_EQ(client.drive_a_metre(), "");
  EXPECT_NEAR(line.robot().pose_in_world().x - x0, 1.0, 0.15);
  client.send(packet(Wire{2}));
  EXPECT_FALSE(line.server().is_open());
  EXPECT_EQ(line.violations(), "");
}

INSTANTIATE_TEST_SUITE_P(Robots, Bee,
                         ::testing::Values(Robot{"psos43m", 2, 3}, Robot{"pionat", 2, 3},
                                           Robot{"p2dx", 4, 6}, Robot{"p2at", 4, 6}),
                         [](const auto& robot) { return std::string(robot.param.subclass); });

}  // namespace
}  // namespace saphira::test
