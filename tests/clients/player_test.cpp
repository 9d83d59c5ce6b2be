#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "line.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

/// A stand-in of the Player family of clients (the p2os driver, and ROS' of the same descent).
class PlayerClient {
 public:
  explicit PlayerClient(Line& line) : line_(line) {}

  // Empty, or the reason of its failure.
  std::string connect() {
    for (int number = 0; number < 3; ++number) {
      std::optional<Wire> body;
      for (int attempt = 0; attempt < 4 && !body; ++attempt) {
        line_.send(packet(Wire{static_cast<std::uint8_t>(number)}));
        body = line_.expect([](const Wire&) { return true; }, 0.2);
      }
      if (!body)
        return "no answer to SYNC" + std::to_string(number);
      if ((*body)[0] != number)
        return "out of step";
      if (number == 2) {
        std::string names[3];
        std::size_t at = 1;
        for (std::string& name : names) {
          while (at < body->size() && (*body)[at] != 0)
            name += static_cast<char>((*body)[at++]);
          ++at;
        }
        known_ = find_known(names[2]);
        if (lowered(names[1]) != "pioneer" || known_ == nullptr)
          return "it does not know the robot";
      }
    }
    line_.send(packet(Wire{1}));                             // OPEN: the bytes of SYNC1
    line_.send(packet(Wire{0}));                             // PULSE
    line_.send({0xFA, 0xFB, 0x04, 0x07, 0x3B, 0x07, 0x3B});  // SETO: a type and no argument
    return {};
  }

  void motors(bool on) { line_.send(packet(4, on ? 1 : 0)); }
  void sonars(bool on) { line_.send(packet(28, on ? 1 : 0)); }
  void stop() {
    line_.send(packet(11, 0));
    line_.send(packet(21, 0));
  }
  void close() {
    line_.send(packet(Wire{29}));  // STOP
    line_.send(packet(Wire{2}));   // CLOSE
  }

  void set_speed(int velocity, int rotation) {
    line_.send(packet(11, velocity));
    line_.send(packet(21, rotation));
  }

  // One information packet after the other, without answers: its default sends no pulse.
  bool cycle() {
    const auto body = line_.expect(
        [](const Wire& b) { return b[0] == 0x32 || b[0] == 0x33 || b[0] == 0x31; }, 0.5);
    if (!body)
      return false;
    take(*body);
    return true;
  }

  // Switches sonars and motors on, and reads for 1.5 s; false where the robot fell silent.
  bool switch_on() {
    sonars(true);
    motors(true);
    return cycles(15);
  }
  bool drive_a_metre() {
    for (int i = 0; i < 200 && x < 950.0; ++i) {
      set_speed(200, 0);
      if (!cycle())
        return false;
    }
    stop();
    return cycles(15);
  }

  double x = 0.0;   // mm
  int tainted = 0;  // odometry steps that it discards
  std::map<int, double> ranges;
  const KnownRobot* known() const { return known_; }

 private:
  bool cycles(int count) {
    for (int i = 0; i < count; ++i)
      if (!cycle())
        return false;
    return true;
  }

  void take(const Wire& body) {
    const auto u16 = [&](std::size_t at) { return body[at] | body[at + 1] << 8; };
    // It keeps 12 bits of the position.
    const int raw = u16(1) % 4096;
    if (have_) {
      int step = raw - last_;
      if (step > 2048)
        step -= 4096;
      if (step < -2048)
        step += 4096;
      const double way = step * known_->distance;
      if (std::abs(way) > 100.0)
        ++tainted;
      else
        x += way;
    }
    have_ = true;
    last_ = raw;
    for (std::size_t i = 0; i < body[19]; ++i)
      ranges[body[20 + 3 * i]] = u16(21 + 3 * i) * known_->range;
  }

  Line& line_;
  const KnownRobot* known_ = nullptr;
  bool have_ = false;
  int last_ = 0;
};

class Player : public ::testing::TestWithParam<std::string> {};

TEST_P(Player, ConnectsDrivesSeesAndStops) {
  Line line(GetParam());
  PlayerClient client(line);
  ASSERT_EQ(client.connect(), "");
  ASSERT_TRUE(client.switch_on());
  const KnownRobot& known = *client.known();
  ASSERT_TRUE(client.ranges.contains(known.front));
  EXPECT_NEAR(client.ranges.at(known.front), 3000.0 - known.front_x, 150.0);

  ASSERT_TRUE(client.drive_a_metre());
  EXPECT_EQ(client.tainted, 0);
  EXPECT_NEAR(client.x / 1000.0, line.robot().pose_in_world().x - line.start().x, 0.06);
  EXPECT_GT(client.x, 950.0);
  EXPECT_FALSE(line.robot().moving());
  client.close();
  EXPECT_FALSE(line.server().is_open());
  EXPECT_EQ(line.server().counters().unknown_commands, 0U);
  EXPECT_EQ(line.violations(), "");
}

INSTANTIATE_TEST_SUITE_P(Robots, Player,
                         ::testing::Values("psos43m", "pionat", "p2dx", "p2at", "p2d8+", "p3dx",
                                           "p3dx-sh", "p3at", "p3at-sh", "amigo", "amigo-sh",
                                           "perfpb", "peoplebot-sh", "powerbot-sh", "patrolbot-sh"),
                         [](const auto& robot) { return test_name(robot.param); });

}  // namespace
}  // namespace saphira::test
