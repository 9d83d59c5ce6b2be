// A stand-in of the BeeSoft family of clients, which is strict with the information packet.

#include <gtest/gtest.h>

#include "line.hpp"

namespace saphira::test {
namespace {

class BeeClient {
 public:
  BeeClient(Line& line, int fewest, int most) : line_(line), fewest_(fewest), most_(most) {}

  bool connect() {
    for (int number = 0; number < 3; ++number) {
      line_.send(packet(Wire{static_cast<std::uint8_t>(number)}));
      const auto body = line_.expect([](const Wire&) { return true; }, 0.5);
      if (!body || (*body)[0] != number)
        return false;
    }
    line_.send(packet(Wire{1}));  // OPEN
    return true;
  }

  void send(const Wire& bytes) { line_.send(bytes); }

  // The next information packet, by its rules; empty, or which one it breaks.
  std::string cycle() {
    const auto body = line_.expect([](const Wire&) { return true; }, 0.5);
    if (!body)
      return "no packet";
    if ((*body)[0] < 0x32 || (*body)[0] > 0x34)
      return "status " + std::to_string((*body)[0]);
    if ((*body)[11] == 0)
      return "battery 0";
    if ((*body)[12] > 1 || (*body)[13] > 1)
      return "stall bytes";
    const int count = (*body)[19];
    // The first packet's sonars began to fire when it was opened.
    if (++packets_ > 1 && (count < fewest_ || count > most_))
      return std::to_string(count) + " sonar readings";
    if (body->size() < 20U + 3U * static_cast<std::size_t>(count) + 5U)
      return "too short";
    moving = (*body)[0] == 0x33;
    return {};
  }

  bool moving = false;

 private:
  Line& line_;
  int fewest_;
  int most_;
  int packets_ = 0;
};

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
