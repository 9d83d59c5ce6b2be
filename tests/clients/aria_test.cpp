#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "line.hpp"

namespace saphira::test {
namespace {

/// A stand-in of the ARIA family of clients: its packets, requirements and weaknesses, from its
/// sources and its traffic (connection states of ArRobot, SIP of ArRobot::processMotorPacket). It
/// has its own packets and its own parameters, without the project's protocol library.
class AriaClient {
 public:
  explicit AriaClient(Line& line) : line_(line) {}

  // Empty, or the reason of its failure.
  std::string connect() {
    line_.send({'W', 'M', 'S', '2', '\r'});
    for (int number = 0; number < 3; ++number) {
      bool answered = false;
      for (int attempt = 0; attempt < 5 && !answered; ++attempt) {
        line_.send(packet(Wire{static_cast<std::uint8_t>(number)}));
        // It listens for 70 ms, then repeats the packet.
        const auto body = line_.expect([](const Wire&) { return true; }, 0.07);
        if (!body)
          continue;
        if ((*body)[0] == 50) {  // an information packet: the robot is open
          line_.send(packet(2, 1));
          number = -1;
          answered = true;
          break;
        }
        // A slow line: the echo of a packet that was repeated meanwhile.
        if ((*body)[0] < number)
          continue;
        if ((*body)[0] != number)
          return "answer " + std::to_string((*body)[0]) + " to SYNC" + std::to_string(number);
        answered = true;
        if (number == 2)
          read_names(*body);
      }
      if (!answered)
        return "no answer to SYNC" + std::to_string(number);
    }
    known_ = find_known(subclass_);
    if (known_ == nullptr)
      return "Have no parameters for this robot: " + subclass_;
    line_.wait(0.1);
    line_.send(packet(1, 1));  // OPEN 1
    const double begin = line_.now();
    while (line_.now() < begin + 1.0 && config_.empty()) {
      line_.send(packet(18, 1));  // CONFIG 1
      poll(0.2);
    }
    read_config();
    line_.send(packet(62, 1));  // BATTERYINFO 1
    line_.send(packet(4, 1));   // ENABLE 1
    if (known_->moves) {
      line_.send(packet(6, velocity_max_));
      line_.send(packet(5, acceleration_));
      line_.send(packet(5, -acceleration_));
      line_.send(packet(10, rotation_max_));
      line_.send(packet(23, rotation_acceleration_));
      line_.send(packet(23, -rotation_acceleration_));
    }
    return {};
  }

  // Runs for that time, in its cycle of 100 ms.
  void poll(double seconds) {
    const double until = line_.now() + seconds;
    while (line_.now() < until - 1e-9) {
      line_.wait(0.1);
      while (const auto body = line_.next())
        take(*body);
      if (line_.now() - last_sip_ > 8.0)
        lost_ = true;
      if (line_.now() - last_sent_ > 0.5)
        say(packet(Wire{0}));  // PULSE
    }
  }

  void drive_a_metre() {
    const double x0 = x_;
    if (known_->moves) {
      say(packet(8, 1000));  // MOVE, then only pulses until it is done
      for (int i = 0; i < 150 && (x_ - x0 < 950.0 || velocity_ != 0); ++i)
        poll(0.1);
      poll(0.5);
      return;
    }
    // Without MOVE it measures the way itself, and slows down.
    for (int i = 0; i < 200; ++i) {
      const double left = 1000.0 - (x_ - x0);
      if (left < 5.0)
        break;
      say(packet(11, std::clamp(static_cast<int>(left), 10, 300)));
      poll(0.1);
    }
    say(packet(11, 0));
    poll(1.0);
  }

  void turn_to(int degrees) {
    for (int i = 0; i < 150; ++i) {
      // HEAD every cycle while it turns, -180 to 180, negatives by type 1B.
      say(packet(12, degrees));
      poll(0.1);
      if (std::abs(std::remainder(th_ - degrees, 360.0)) < 1.0 && std::abs(rotation_) < 1.0)
        break;
    }
  }

  void disconnect() {
    say(packet(4, 0));
    say(packet(2, 1));
    line_.wait(1.0);
  }

  const std::string& name() const { return name_; }
  const std::string& robot_class() const { return class_; }
  bool lost() const { return lost_; }
  int sips() const { return sips_; }
  bool motors_on() const { return (flags_ & 1) != 0; }
  double x() const { return x_; }
  double th() const { return th_; }
  double battery() const { return battery_; }
  const std::map<int, double>& sonar() const { return sonar_; }
  int config_velocity_max() const { return velocity_max_; }
  bool has_config() const { return !config_.empty(); }
  const KnownRobot* known() const { return known_; }
  int unknown_sonars() const { return unknown_sonars_; }

 private:
  void say(const Wire& bytes) {
    line_.send(bytes);
    last_sent_ = line_.now();
  }

  void read_names(const Wire& body) {
    std::string* names[] = {&name_, &class_, &subclass_};
    std::size_t at = 1;
    for (std::string* name : names) {
      while (at < body.size() && body[at] != 0)
        *name += static_cast<char>(body[at++]);
      ++at;
    }
  }

  void take(const Wire& body) {
    if (body[0] == 0x32 || body[0] == 0x33) {  // and no other
      motor_packet(body);
    } else if (body[0] == 0x20) {
      config_ = body;
    }
  }

  // Limits come from the configuration packet, if there is one; zeros there stay zero.
  void read_config() {
    if (config_.empty())
      return;
    std::size_t at = 1;
    const auto skip_string = [&] {
      while (at < config_.size() && config_[at] != 0)
        ++at;
      ++at;
    };
    const auto word = [&] {
      const int value = config_[at] | config_[at + 1] << 8;
      at += 2;
      return value;
    };
    skip_string();  // class
    skip_string();  // subclass
    const std::size_t serial = at;
    skip_string();
    simulator_ = std::string(config_.begin() + static_cast<std::ptrdiff_t>(serial),
                             config_.begin() + static_cast<std::ptrdiff_t>(at - 1)) == "SIM";
    at += 1 + 2 * 5;
    skip_string();    // name
    at += 3;          // sip cycle, baud rates
    at += 2 + 2 + 1;  // gripper, sonars
    at += 2 + 2 + 2;  // battery, revolutions, watchdog
    at += 1 + 2 + 2;  // packets, stalls
    at += 2 + 2;      // joystick
    rotation_max_ = word();
    velocity_max_ = word();
    rotation_acceleration_ = word();
    at += 2 + 6;
    acceleration_ = word();
  }

  void motor_packet(const Wire& body) {
    const auto u16 = [&](std::size_t at) { return body[at] | body[at + 1] << 8; };
    const auto i16 = [&](std::size_t at) { return static_cast<std::int16_t>(u16(at)); };
    last_sip_ = line_.now();
    ++sips_;
    const int raw_x = u16(1) & 0x7FFF;
    if (sips_ > 1) {
      int step = raw_x - last_raw_x_;
      if (step > 0x1000)  // a wrap
        step -= 0x8000;
      else if (step < -0x1000)
        step += 0x8000;
      x_ += step * known_->distance;
    }
    last_raw_x_ = raw_x;
    th_ = i16(5) * known_->angle * 180.0 / kPi;
    rotation_ = i16(9) - i16(7);
    velocity_ = i16(9) + i16(7);
    battery_ = body[11] * 0.1;
    flags_ = u16(16);
    const std::size_t count = body[19];
    for (std::size_t i = 0; i < count; ++i) {
      const int index = body[20 + 3 * i];
      if (index >= known_->sonars) {
        ++unknown_sonars_;
        continue;
      }
      sonar_[index] = u16(21 + 3 * i) * known_->range;
    }
  }

  Line& line_;
  std::string name_, class_, subclass_;
  const KnownRobot* known_ = nullptr;
  Wire config_;
  bool simulator_ = false;
  int velocity_max_ = 400, rotation_max_ = 100, acceleration_ = 300, rotation_acceleration_ = 100;
  double last_sip_ = 0.0, last_sent_ = 0.0;
  bool lost_ = false;
  int sips_ = 0;
  int last_raw_x_ = 0;
  int velocity_ = 0;  // of both wheels, in their units
  double x_ = 0.0, th_ = 0.0, rotation_ = 0.0, battery_ = 0.0;
  int flags_ = 0;
  std::map<int, double> sonar_;
  int unknown_sonars_ = 0;
};

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

}  // namespace
}  // namespace saphira::test
