// The simulator as a robot of later generations: P2OS and ARCOS.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "process.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/sim/server.hpp"

namespace saphira::sim {
namespace {

using protocol::Bytes;
using protocol::Command;
using protocol::InformationPacket;
using protocol::ServerPacket;

using test::source;

// A robot of a given file in an empty square of 20 m, and its client.
class Bench {
 public:
  explicit Bench(const std::string& robot)
      : world_(parse_world("width 20000 height 20000 0 0 20000 0 20000 0 20000 20000 "
                           "20000 20000 0 20000 0 20000 0 0",
                           "square.wld")),
        parameters_(protocol::load_parameters(source("config/robots/" + robot + ".p"))),
        scene_(world_),
        server_(scene_, parameters_, {10.0, 10.0, 0.0}, {}) {
    open();
  }
  void open() {
    for (int i = 0; i < 3; ++i)
      server_.receive(protocol::encode_sync(i));
    send(protocol::Open{});
    packets();
  }
  void send(const Command& command, double seconds = 0.0) {
    server_.receive(protocol::encode(command, parameters_));
    advance(seconds);
  }
  /// Advances the time, with a pulse at intervals.
  void advance(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 10.0)); ++i) {
      send(protocol::Pulse{});
      server_.advance(kTicksPerPacket);
    }
  }
  std::vector<ServerPacket> packets() {
    parser_.feed(server_.take_output());
    std::vector<ServerPacket> out;
    while (auto body = parser_.next())
      out.push_back(protocol::decode_packet(*body));
    return out;
  }
  /// The newest packet of a kind since the last call, and their number.
  template <class Packet>
  Packet last(int* count = nullptr) {
    Packet found{};
    int n = 0;
    for (const ServerPacket& packet : packets())
      if (const auto* p = std::get_if<Packet>(&packet)) {
        found = *p;
        ++n;
      }
    if (count != nullptr)
      *count = n;
    return found;
  }
  protocol::Information state() {
    return protocol::interpret(last<InformationPacket>(), parameters_);
  }

  World world_;
  protocol::RobotParameters parameters_;
  Scene scene_;
  Server server_;
  protocol::PacketParser parser_;
};

TEST(LaterServer, MotorsWaitForEnable) {
  Bench b("p3dx-sh");
  b.send(protocol::Velocity{0.3}, 1.0);
  auto packet = b.last<InformationPacket>();
  EXPECT_EQ(packet.motors, protocol::Motors::kStopped);  // clients take no other type
  EXPECT_EQ(packet.ptu & protocol::kFlagMotors, 0U);
  EXPECT_EQ(protocol::interpret(packet, b.parameters_).motors, protocol::Motors::kNoPower);
  b.send(protocol::Enable{true});
  b.send(protocol::Velocity{0.3}, 2.0);
  packet = b.last<InformationPacket>();
  EXPECT_EQ(packet.motors, protocol::Motors::kMoving);
  EXPECT_NE(packet.ptu & protocol::kFlagMotors, 0U);
  EXPECT_NEAR(b.server_.robot().velocity(), 0.3, 1e-9);
  b.send(protocol::Enable{false}, 2.0);
  EXPECT_FALSE(b.server_.robot().moving());
}

TEST(LaterServer, MovesAMetre) {
  for (const std::string robot : {"p3dx", "p3dx-sh", "p2at8+", "amigo-sh"}) {
    Bench b(robot);
    b.send(protocol::Enable{true});
    b.send(protocol::Move{1.0});
    int x = 0;
    std::uint16_t last = 0;
    for (int i = 0; i < 100; ++i) {
      b.advance(0.1);
      for (const ServerPacket& packet : b.packets())
        if (const auto* p = std::get_if<InformationPacket>(&packet))
          x += protocol::position_difference(std::exchange(last, p->x), p->x);
    }
    EXPECT_NEAR(x * b.parameters_.distance_unit, 1.0, 0.01) << robot;
    EXPECT_NEAR(b.server_.robot().pose_in_world().x - 10.0, 1.0, 0.05) << robot;
    EXPECT_FALSE(b.server_.robot().moving()) << robot;
  }
}

TEST(LaterServer, LimitsAreSet) {
  Bench b("p3dx-sh");
  b.send(protocol::Enable{true});
  b.send(protocol::Acceleration{1.0});
  b.send(protocol::Acceleration{-0.2});
  b.send(protocol::Velocity{0.5}, 0.3);
  EXPECT_NEAR(b.server_.robot().velocity(), 0.3, 1e-9);
  b.advance(0.5);
  b.send(protocol::Stop{}, 1.0);
  EXPECT_NEAR(b.server_.robot().velocity(), 0.3, 1e-9);
  b.send(protocol::EmergencyStop{}, 1.0);
  EXPECT_FALSE(b.server_.robot().moving());
  EXPECT_TRUE(b.state().emergency_stop.value());
}

TEST(LaterServer, ConfigurationSaysWhatTheFileSays) {
  Bench b("p3at-sh");
  b.send(protocol::ConfigRequest{1});
  const auto config = b.last<protocol::ConfigPacket>();
  EXPECT_EQ(config.robot_class, "Pioneer");
  EXPECT_EQ(config.subclass, "p3at-sh");
  EXPECT_EQ(config.velocity_max, 1200);
  EXPECT_EQ(config.rotation_velocity_max, 300);
  EXPECT_EQ(config.acceleration, 300);
  EXPECT_NE(config.serial, "SIM");  // ARIA would expect a simulator's laser
}

// ARIA stops a PeopleBot while a bit of its table sensors is clear.
TEST(LaterServer, NoTableIsBeforeAPeopleBotAtRest) {
  for (const auto& [robot, inputs] : {std::pair{"p2pp", 0xFF},
                                      {"perfpb", 0xFF},
                                      {"perfpb+", 0xFF},
                                      {"peoplebot-sh", 0xFF},
                                      {"p2pb", 0},
                                      {"p3dx-sh", 0}}) {
    Bench b(robot);
    b.send(protocol::IoRequest{1});
    EXPECT_EQ(b.last<protocol::IoPacket>().digital_inputs, Bytes{static_cast<std::uint8_t>(inputs)})
        << robot;
  }
}

TEST(LaterServer, PacketsOnRequest) {
  Bench b("peoplebot-sh");
  int count = 0;
  b.send(protocol::EncoderRequest{1}, 1.0);
  b.last<protocol::EncoderPacket>(&count);
  EXPECT_EQ(count, 1);
  b.send(protocol::EncoderRequest{2});
  b.send(protocol::Enable{true});
  b.send(protocol::Move{0.5}, 6.0);
  const auto encoders = b.last<protocol::EncoderPacket>(&count);
  EXPECT_EQ(count, 60);
  EXPECT_NEAR(encoders.left * b.parameters_.encoder_unit, 0.5, 0.02);
  EXPECT_NEAR(encoders.right * b.parameters_.encoder_unit, 0.5, 0.02);
  b.send(protocol::EncoderRequest{0});
  b.send(protocol::IoRequest{2});
  b.send(protocol::DigitalOutput{0xFF, 0x0F});
  b.server_.devices().set_digital_input(0x12);
  b.server_.devices().set_analog(0x80);
  b.advance(0.5);
  const auto io = b.last<protocol::IoPacket>(&count);
  EXPECT_EQ(count, 5);
  EXPECT_EQ(io.digital_outputs, Bytes{0x0F});
  EXPECT_EQ(io.digital_inputs, Bytes{0x12});
  EXPECT_EQ(io.analogs, std::vector<std::uint16_t>{0x200});
  b.server_.devices().set_analog(0x40, 5);
  b.send(protocol::AnalogSelect{5}, 0.5);
  EXPECT_EQ(b.last<protocol::IoPacket>().analogs, std::vector<std::uint16_t>{0x100});
  b.send(protocol::BatteryRequest{1});
  EXPECT_EQ(b.last<protocol::BatteryPacket>().batteries, 1);
  EXPECT_TRUE(b.server_.is_open());
  b.send(protocol::Close{});
  EXPECT_TRUE(b.packets().empty());
  b.open();
  b.advance(0.5);
  b.last<protocol::IoPacket>(&count);
  EXPECT_EQ(count, 0) << "somebody else's request lives on";
}

TEST(LaterServer, TheGripperTakesItsTime) {
  Bench b("peoplebot-sh");
  b.send(protocol::GripperRequest{2});
  b.send(protocol::Gripper{static_cast<int>(protocol::GripperAction::kClose)}, 0.5);
  auto gripper = b.last<protocol::GripperPacket>();
  EXPECT_EQ(gripper.kind, 2);
  EXPECT_EQ(gripper.state & 0b111, 0b100);  // moving
  b.advance(1.5);
  EXPECT_EQ(b.last<protocol::GripperPacket>().state & 0b111, 0b010);  // closed
  b.send(protocol::Gripper{static_cast<int>(protocol::GripperAction::kDeploy)}, 2.0);
  EXPECT_EQ(b.state().gripper_bits & 0b111, 0b001);  // open
  Bench none("p3dx-sh");
  none.send(protocol::GripperRequest{1});
  EXPECT_EQ(none.last<protocol::GripperPacket>().kind, 0);
}

TEST(LaterServer, SonarArraysGoOffAndOn) {
  Bench b("p3dx-sh");
  EXPECT_EQ(b.state().sonars.size(), 0U);
  b.advance(2.0);
  EXPECT_EQ((b.last<InformationPacket>().ptu & protocol::kFlagSonars) >> 1U, 0b11U);
  b.send(protocol::SonarSwitch{false, 2}, 0.2);
  b.packets();
  b.advance(2.0);
  for (const ServerPacket& packet : b.packets())
    if (const auto* p = std::get_if<InformationPacket>(&packet)) {
      EXPECT_EQ((p->ptu & protocol::kFlagSonars) >> 1U, 0b01U);
      for (const auto& sonar : p->sonars)
        EXPECT_LT(sonar.number, 8);
    }
  b.send(protocol::SonarSwitch{false, 0}, 0.2);
  b.packets();
  b.advance(1.0);
  EXPECT_TRUE(b.last<InformationPacket>().sonars.empty());
  b.send(protocol::SonarSwitch{true, 0}, 1.0);
  EXPECT_FALSE(b.last<InformationPacket>().sonars.empty());
}

TEST(LaterServer, BumpersAreInTheirBits) {
  Bench b("p3dx-sh");
  b.send(protocol::Enable{true});
  b.send(protocol::Velocity{0.4});
  protocol::Information state;
  for (int i = 0; i < 600 && state.front_bumpers == 0; ++i) {
    b.send(protocol::Velocity{1.0}, 0.1);
    state = b.state();
  }
  EXPECT_EQ(state.front_bumpers & 0b00100, 0b00100);  // head on: the middle one of five
  EXPECT_EQ(state.rear_bumpers, 0);
  EXPECT_TRUE(state.left_stalled);
}

TEST(LaterServer, TrailingFieldsOfArcosAlone) {
  Bench arcos("p3dx-sh");
  arcos.advance(0.1);
  const auto packet = arcos.last<InformationPacket>();
  EXPECT_TRUE(packet.trailing.flags3);
  EXPECT_NEAR(protocol::interpret(packet, arcos.parameters_).battery, 12.8, 0.05);
  arcos.send(protocol::BatteryTest{114});
  arcos.advance(0.1);
  EXPECT_NEAR(arcos.state().battery, 11.4, 0.05);
  for (const std::string robot : {"p3dx", "p2dx", "pioneer"}) {
    Bench other(robot);
    other.advance(0.1);
    EXPECT_FALSE(other.last<InformationPacket>().trailing.battery) << robot;
  }
}

// Manual 9.1 and 9.2: channels, modes, ten packets a second.
TEST(FastTrackTest, SendsWhatTheCameraSees) {
  const World world = parse_world(
      "width 20000 height 20000 post can 12000 10000 100 color red tall 700 "
      "post box 12000 10500 100 color green tall 700",
      "colors.wld");
  const auto parameters = protocol::load_parameters(source("config/robots/pioneer.p"));
  Scene scene(world);
  Server server(scene, parameters, {10.0, 10.0, 0.0}, {});
  protocol::PacketParser parser;
  const auto seen = [&](int cycles) {
    server.advance(cycles * kTicksPerPacket);
    parser.feed(server.take_output());
    std::vector<protocol::VisionPacket> out;
    while (auto body = parser.next())
      if (const ServerPacket packet = protocol::decode_packet(*body);
          std::holds_alternative<protocol::VisionPacket>(packet))
        out.push_back(std::get<protocol::VisionPacket>(packet));
    return out;
  };
  const auto say = [&](const std::string& text) {
    server.receive(protocol::encode(protocol::VisionCommand(Bytes(text.begin(), text.end()))));
  };
  for (int i = 0; i < 3; ++i)
    server.receive(protocol::encode_sync(i));
  server.receive(protocol::encode(protocol::Open{}));
  EXPECT_TRUE(seen(3).empty()) << "nobody has asked";
  say("pioneer_a_mode=2");
  say("pioneer_b_mode=1");
  const auto packets = seen(10);
  ASSERT_EQ(packets.size(), 10U);
  const auto& [a, b, c] = packets.back().channels;
  EXPECT_EQ(a.mode, protocol::VisionChannel::Mode::kBlobWithBox);
  EXPECT_NEAR(a.x, 0, 1);
  EXPECT_GT(a.area, 100);
  EXPECT_GT(a.height, a.width);
  EXPECT_EQ(b.mode, protocol::VisionChannel::Mode::kLine);
  const double pixels_per_degree = 3.0;  // manual 9.2
  EXPECT_NEAR(std::abs(b.x), degrees(std::atan2(0.5, 1.85)) * pixels_per_degree, 3.0);
  EXPECT_GT(b.count, 10);
  EXPECT_EQ(c.area, 0) << "nothing is blue";
  // In slices of ten rows, of which two are below it; then a segment needs more than it has.
  const int bottom = b.first, rows = b.count;
  say("line_bottom_row=" + std::to_string(bottom - 20));
  say("line_slice_size=10");
  say("line_num_slices=4");
  say("line_min_mass=8");
  const protocol::VisionChannel sliced = seen(1).back().channels[1];
  EXPECT_EQ(sliced.first, 2);
  EXPECT_EQ(sliced.count, 2) << "slices 2 and 3 of " << rows << " rows";
  say("line_min_mass=1000");
  EXPECT_EQ(seen(1).back().channels[1].count, 0);
  say("pioneer_c_color=red");
  EXPECT_NEAR(seen(1).back().channels[2].area, a.area, 5);
  EXPECT_EQ(server.counters().unsupported_commands, 0U);
  say("pioneer_d_mode=0");
  EXPECT_EQ(server.counters().unsupported_commands, 1U);
  server.receive(protocol::encode(protocol::Close{}));
  EXPECT_TRUE(seen(3).empty());
}

// MobileSim's and the old simulator's commands for the true pose of the robot.
TEST(LaterServer, AHandPutsTheRobotElsewhere) {
  Bench b("p3dx-sh");
  b.send(protocol::TruePose{{3.0, 4.0, radians(90)}});
  EXPECT_NEAR(b.server_.robot().pose_in_world().x, 3.0, 1e-9);
  EXPECT_NEAR(b.server_.robot().pose_in_world().th, radians(90), 1e-9);
  EXPECT_NEAR(b.server_.robot().pose_in_odom().x, 0.0, 1e-9);
  b.send(protocol::SimStatus{1});
  const auto status = b.last<protocol::SimStatusPacket>();
  EXPECT_EQ(status.true_x, 3000);
  EXPECT_EQ(status.true_th, 90);
  EXPECT_EQ(status.odometry_error_x, 7000);
  b.send(protocol::SimReset{});
  EXPECT_NEAR(b.server_.robot().pose_in_world().x, 10.0, 1e-9);
}

TEST(LaterServer, TheWatchdogIsTheFiles) {
  Bench b("p3dx-sh");
  b.parameters_.watchdog = 0.5;
  Scene scene(b.world_);
  Server server(scene, b.parameters_, {10.0, 10.0, 0.0}, {});
  for (int i = 0; i < 3; ++i)
    server.receive(protocol::encode_sync(i));
  server.receive(protocol::encode(protocol::Open{}));
  server.receive(protocol::encode(protocol::Enable{true}));
  server.receive(protocol::encode(protocol::Velocity{0.1}));
  server.advance(49);
  EXPECT_EQ(server.counters().watchdog_stops, 0U);
  server.advance(1);
  EXPECT_EQ(server.counters().watchdog_stops, 1U);
}

}  // namespace
}  // namespace saphira::sim
