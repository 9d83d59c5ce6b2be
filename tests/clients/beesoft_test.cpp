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
  PureLine line(GetParam().subclass);
  BeeClient client(line, GetParam().fewest, GetParam().most);
  ASSERT_TRUE(client.connect());
  client.send(packet(4, 1));
  const double x0 = line.robot().pose_in_world().x;
  for (int i = 0; i < 60; ++i) {
    if (i % 10 == 0)
      client.send(packet(Wire{0}));
    if (i == 5)
      client.send(packet(11, 200));
    if (i == 55)
      client.send(packet(11, 0));
    ASSERT_EQ(client.cycle(), "") << "packet " << i;
    if (i == 4 || i == 40) {
      EXPECT_EQ(client.moving, i == 40);
    }
  }
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
