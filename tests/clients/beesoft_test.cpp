#include <gtest/gtest.h>

#include <string>

#include "line.hpp"

namespace saphira::test {
namespace {

/// A stand-in of the BeeSoft family of clients, which is strict with the information packet.
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

  // The next information packet, by its rules; empty, or the broken rule.
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
    // The sonars of the first packet began to fire at the opening.
    if (++packets_ > 1 && (count < fewest_ || count > most_))
      return std::to_string(count) + " sonar readings";
    if (body->size() < 20U + 3U * static_cast<std::size_t>(count) + 5U)
      return "too short";
    moving_ = (*body)[0] == 0x33;
    return {};
  }

  // A metre in six seconds; empty, or the error and its packet.
  std::string drive_a_metre() {
    send(packet(4, 1));  // ENABLE
    for (int i = 0; i < 60; ++i) {
      if (i % 10 == 0)
        send(packet(Wire{0}));  // PULSE
      if (i == 5)
        send(packet(11, 200));  // VEL [mm/s]
      if (i == 55)
        send(packet(11, 0));
      std::string fault = cycle();
      if (fault.empty() && i == 4 && moving_)
        fault = "moves before it is told to";
      if (fault.empty() && i == 40 && !moving_)
        fault = "does not move";
      if (!fault.empty())
        return "packet " + std::to_string(i) + ": " + fault;
    }
    return {};
  }

 private:
  bool moving_ = false;
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
