#include "saphira/sim/server.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {
namespace {

using protocol::Bytes;
using protocol::Command;
using protocol::encode;
using protocol::InformationPacket;

using test::source;

// A server in the office, and a client of it without a line between them.
class Fixture : public ::testing::Test {
 protected:
  explicit Fixture(ServerOptions options = traced(), const std::string& robot = "pioneer")
      : world_(load_world(source("config/worlds/office.wld"))),
        parameters_(protocol::load_parameters(source("config/robots/" + robot + ".p"))),
        scene_(world_),
        server_(scene_, parameters_, *world_.start, options) {}

  static ServerOptions traced() {
    ServerOptions options;
    options.trace = true;
    return options;
  }

  std::vector<Bytes> bodies() {
    parser_.feed(server_.take_output());
    std::vector<Bytes> out;
    while (auto body = parser_.next())
      out.push_back(*body);
    return out;
  }
  std::vector<InformationPacket> packets() {
    std::vector<InformationPacket> out;
    for (const Bytes& body : bodies())
      if (auto packet = protocol::decode_information(body))
        out.push_back(*packet);
    return out;
  }
  /// Sends, and lets so many ticks pass.
  void send(const Command& command, int ticks = 0) {
    server_.receive(encode(command));
    server_.advance(ticks);
  }
  void synchronize() {
    for (int i = 0; i < 3; ++i)
      server_.receive(protocol::encode_sync(i));
    bodies();
  }
  void open() {
    synchronize();
    send(protocol::Open{});
  }

  World world_;
  protocol::RobotParameters parameters_;
  Scene scene_;
  Server server_;
  protocol::PacketParser parser_;
};

class ServerTest : public Fixture {};

// Manual 5.4.1 and 5.4.2.
TEST_F(ServerTest, EchoesTheSynchronizationAndSaysWhatItIs) {
  server_.receive(protocol::encode_sync(0));
  EXPECT_EQ(bodies(), std::vector<Bytes>{Bytes{0}});
  server_.receive(protocol::encode_sync(1));
  EXPECT_EQ(bodies(), std::vector<Bytes>{Bytes{1}});
  server_.receive(protocol::encode_sync(2));
  const auto reply = bodies();
  ASSERT_EQ(reply.size(), 1U);
  EXPECT_EQ(protocol::decode_sync2_reply(reply[0]),
            (protocol::RobotIdentity{"Simulator", "Pioneer", "psos43m"}));
}

TEST_F(ServerTest, WaitsForTheSynchronizationFromItsBeginning) {
  for (int i = 1; i < 3; ++i)
    server_.receive(protocol::encode_sync(i));
  send(protocol::Velocity{0.3});
  send(protocol::Step{});
  EXPECT_TRUE(bodies().empty());
  EXPECT_FALSE(server_.is_open());
}

TEST_F(ServerTest, ALostEchoIsMadeAgain) {
  for (const int number : {0, 0, 1, 1, 2, 2})
    server_.receive(protocol::encode_sync(number));
  EXPECT_EQ(bodies().size(), 6U);
  for (const int number : {0, 1, 2})
    server_.receive(protocol::encode_sync(number));
  EXPECT_EQ(bodies().size(), 3U);
  send(protocol::Open{});
  EXPECT_TRUE(server_.is_open());
  EXPECT_TRUE(bodies().empty());
}

TEST_F(ServerTest, SendsAPacketEvery100MillisecondsOnceOpen) {
  synchronize();
  server_.advance(100);
  EXPECT_TRUE(packets().empty());
  send(protocol::Open{}, 9);
  EXPECT_TRUE(packets().empty());
  EXPECT_EQ(server_.ticks_to_packet(), 1);
  server_.advance(1);
  EXPECT_EQ(packets().size(), 1U);
  for (int i = 0; i < 19; ++i) {
    send(protocol::Pulse{}, 10);
  }
  const auto got = packets();
  ASSERT_EQ(got.size(), 19U);
  std::set<int> numbers;
  for (const auto& packet : got) {
    EXPECT_EQ(packet.motors, protocol::Motors::kStopped);
    EXPECT_EQ(packet.battery, 126);
    EXPECT_GE(packet.sonars.size(), 2U);
    EXPECT_LE(packet.sonars.size(), 3U);
    for (const auto& sonar : packet.sonars)
      numbers.insert(sonar.number);
  }
  EXPECT_EQ(numbers.size(), 7U);
}

TEST_F(ServerTest, DrivesAndReports) {
  open();
  send(protocol::Velocity{0.3});
  send(protocol::Heading{radians(10.0)}, 100);
  auto got = packets();
  ASSERT_EQ(got.size(), 10U);
  EXPECT_EQ(got.back().motors, protocol::Motors::kMoving);
  const auto in = protocol::interpret(got.back(), parameters_);
  EXPECT_NEAR(in.velocity, 0.3, 0.003);
  EXPECT_NEAR(in.th, radians(10.0), 0.01);
  EXPECT_NEAR(in.control, radians(10.0), parameters_.angle_unit);
  EXPECT_NEAR(got.back().x * parameters_.distance_unit, server_.robot().pose_in_odom().x,
              parameters_.distance_unit);
  send(protocol::SetOrigin{}, 10);
  EXPECT_LT(server_.robot().pose_in_odom().x, 0.05);
  send(protocol::RotationVelocity{radians(-30.0)}, 50);
  EXPECT_NEAR(server_.robot().rotation_velocity(), radians(-30.0), 1e-9);
  send(protocol::DeltaHeading{radians(20.0)});
  send(protocol::Velocity{0.0});
  const double from = server_.robot().pose_in_odom().th;
  server_.advance(150);
  EXPECT_NEAR(norm2_angle(server_.robot().pose_in_odom().th - from), radians(20.0), 0.01);
  EXPECT_FALSE(server_.robot().moving());
}

// A negative coordinate rolls over to the top of 15 bits (manual 5.5.1).
TEST_F(ServerTest, ThePositionIsAlwaysPositive) {
  open();
  send(protocol::Velocity{-0.2}, 50);
  const auto got = packets();
  EXPECT_GT(got.back().x, 0x7000);
  EXPECT_LT(protocol::position_difference(0, got.back().x), 0);
}

TEST_F(ServerTest, DevicesAreReflected) {
  open();
  send(protocol::DigitalOutput{0x5A});
  send(protocol::Ptu{1500});
  send(protocol::Gripper{4});
  send(protocol::Timer{3});
  send(protocol::Polling{{3}}, 20);
  const auto got = packets();
  EXPECT_EQ(got.back().digital_output, 0x5A);
  EXPECT_EQ(got.back().ptu, 1500);
  EXPECT_EQ(server_.devices().gripper().action(), 4);
  for (const auto& sonar : got.back().sonars)
    EXPECT_EQ(sonar.number, 3);
  send(protocol::Polling{}, 20);
  EXPECT_TRUE(packets().back().sonars.empty());
}

class HeadTest : public Fixture {
 protected:
  HeadTest() : Fixture(traced(), "pioneer-head") {}
};

// 120 degrees a second, six microseconds a degree.
TEST_F(HeadTest, TurnsAtItsSpeedWithinItsReach) {
  open();
  server_.advance(10);
  EXPECT_EQ(packets().back().ptu, 1500) << "straight ahead";
  send(protocol::Ptu{2400}, 50);
  EXPECT_EQ(packets().back().ptu, 1860);
  EXPECT_NEAR(server_.devices().head(), radians(60.0), 1e-9);
  server_.advance(100);
  EXPECT_EQ(packets().back().ptu, 2400);
  send(protocol::Ptu{500}, 300);
  EXPECT_EQ(packets().back().ptu, 510) << "the end stop";
  send(protocol::Ptu{0}, 100);
  EXPECT_EQ(packets().back().ptu, 510) << "no pulse: it stays";
}

TEST_F(ServerTest, UnknownCommandsAreIgnoredAndCounted) {
  open();
  send(protocol::Unknown{14});
  server_.receive(protocol::frame(Bytes{11, 0x2B, 'x', 0}));
  EXPECT_EQ(server_.counters().unknown_commands, 2U);
  send(protocol::BatteryRequest{1});  // a later robot's; and it ends no simulator
  send(protocol::Move{1.0});
  EXPECT_EQ(server_.counters().unsupported_commands, 2U);
  server_.advance(100);
  EXPECT_TRUE(server_.is_open());
  EXPECT_FALSE(server_.robot().moving());
  Bytes bad = encode(protocol::Velocity{0.3});
  bad[5] ^= 1U;
  server_.receive(bad);
  EXPECT_EQ(server_.counters().bad_packets, 1U);
  server_.advance(50);
  EXPECT_FALSE(server_.robot().moving());
}

// Manual 5.4.4.
TEST_F(ServerTest, TheWatchdogStopsAndACommandRevives) {
  open();
  send(protocol::Velocity{0.2});
  server_.advance(199);  // two seconds are 200 ticks
  EXPECT_NEAR(server_.robot().velocity(), 0.2, 1e-12);
  server_.advance(30);
  EXPECT_FALSE(server_.robot().moving());
  EXPECT_EQ(server_.counters().watchdog_stops, 1U);
  server_.advance(1000);
  EXPECT_FALSE(server_.robot().moving());
  EXPECT_EQ(server_.counters().watchdog_stops, 1U);
  send(protocol::Pulse{}, 100);
  EXPECT_NEAR(server_.robot().velocity(), 0.2, 1e-12);
  server_.advance(200);
  EXPECT_FALSE(server_.robot().moving());
  send(protocol::Velocity{0.0}, 100);
  EXPECT_FALSE(server_.robot().moving());
}

TEST_F(ServerTest, ClosingStopsTheRobotAndItsPositionStays) {
  open();
  send(protocol::Velocity{0.4}, 150);
  const double before = server_.robot().pose_in_odom().x;
  packets();
  send(protocol::Close{});
  EXPECT_FALSE(server_.is_open());
  server_.advance(1000);
  EXPECT_FALSE(server_.robot().moving());
  EXPECT_TRUE(packets().empty());
  const double at = server_.robot().pose_in_odom().x;
  EXPECT_LT(at - before, 0.06);  // 0.4 m/s, braked at 2 m/s2
  const auto rows = server_.take_trace();
  EXPECT_EQ(rows.back().velocity, 0.0);
  EXPECT_EQ(rows.back().cycle, 17U);  // 15 open, and on until it stood: 0.2 s
  EXPECT_FALSE(server_.runs());

  open();
  send(protocol::Pulse{}, 50);
  EXPECT_FALSE(server_.robot().moving()) << "drives off with the velocity of the last client";
  EXPECT_DOUBLE_EQ(server_.robot().pose_in_odom().x, at);
  const auto again = server_.take_trace();
  ASSERT_FALSE(again.empty());
  EXPECT_TRUE(again.front().first);
  EXPECT_EQ(again.front().cycle, 1U);
}

TEST_F(ServerTest, ADroppedConnectionStopsTheRobot) {
  open();
  send(protocol::Velocity{0.4}, 150);
  server_.receive(Bytes{0xFA, 0xFB, 50});  // cut off in the middle
  server_.disconnect();
  EXPECT_TRUE(server_.take_output().empty());
  server_.advance(30);
  EXPECT_FALSE(server_.robot().moving());
  synchronize();
  send(protocol::Open{});
  EXPECT_TRUE(server_.is_open());
}

TEST_F(ServerTest, AFalseHeaderHoldsNothingBackForLong) {
  open();
  server_.receive(Bytes{0xFA, 0xFB, 199});
  send(protocol::Velocity{0.2}, 10);
  EXPECT_NEAR(server_.robot().target_velocity(), 0.2, 1e-12);
}

TEST_F(ServerTest, StepsAreTheSamePhysicsAsLive) {
  ServerOptions options = traced();
  options.single_step = true;
  Scene scene(world_);
  Server stepped(scene, parameters_, *world_.start, options);
  for (int i = 0; i < 3; ++i)
    stepped.receive(protocol::encode_sync(i));
  stepped.receive(encode(protocol::Open{}));
  open();
  for (int i = 0; i < 300; ++i) {
    const Command command = i % 7 == 0
                                ? Command{protocol::RotationVelocity{radians(i % 5 * 10.0 - 20.0)}}
                                : Command{protocol::Velocity{0.1 * (i % 4)}};
    send(command);
    server_.advance(kTicksPerPacket);
    stepped.receive(encode(command));
    stepped.advance(1000);  // time alone moves nothing
    stepped.receive(encode(protocol::Step{}));
  }
  const auto live = server_.take_trace();
  const auto step = stepped.take_trace();
  ASSERT_EQ(live.size(), 300U);
  ASSERT_EQ(step.size(), 300U);
  for (std::size_t i = 0; i < live.size(); ++i)
    ASSERT_EQ(to_csv(live[i]), to_csv(step[i])) << i;
  EXPECT_EQ(server_.take_output().size(), [&] {
    Bytes all = stepped.take_output();
    for (int i = 0; i < 3; ++i)  // the echoes, which bodies() took from the other one
      all.erase(all.begin(), all.begin() + 3 + all[2]);
    return all.size();
  }());
}

TEST_F(ServerTest, TheFirstStepEndsLiveMode) {
  open();
  server_.advance(14);
  EXPECT_EQ(packets().size(), 1U);
  send(protocol::Step{});
  EXPECT_EQ(packets().size(), 1U);
  EXPECT_TRUE(server_.single_step());
  server_.advance(1000);
  EXPECT_TRUE(packets().empty());
  for (int i = 0; i < 5; ++i)
    send(protocol::Step{});
  EXPECT_EQ(packets().size(), 5U);
  server_.disconnect();
  open();
  server_.advance(20);
  EXPECT_EQ(packets().size(), 2U);
}

TEST_F(ServerTest, RefusesToStandInAWall) {
  Scene scene(world_);
  EXPECT_THROW(Server(scene, parameters_, {1.5, 6.1, 0.0}, {}), std::invalid_argument);
}

TEST(Trace, SurvivesTheFile) {
  const TraceRow row{true, 7, {1.0 / 3.0, -2.0, 0.1}, 0.3, -0.2, 0.4, std::nan(""), 0.0, 0.25, 2};
  const std::string text = trace_header() + to_csv(row) + to_csv(row) + "9,1,2";
  const auto rows = parse_trace(text, "t.csv");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[0].first);
  EXPECT_FALSE(rows[1].first);
  EXPECT_EQ(to_csv(rows[0]), to_csv(row));
  EXPECT_THROW(parse_trace("1,2,3\n", "t.csv"), FileError);
  EXPECT_THROW(parse_trace(trace_header() + "1,2,3\n", "t.csv"), FileError);
  EXPECT_THROW(parse_trace(trace_header() + "1,2,3,4,5,6,7,8,9,10,x\n", "t.csv"), FileError);
}

TEST_F(ServerTest, ThePictureHasTheWorldAndTheWay) {
  open();
  send(protocol::Velocity{0.3}, 190);
  const auto rows = server_.take_trace();
  const std::string svg = plot_svg(world_, rows, parameters_.radius);
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find("M0 14000L24000 14000"), std::string::npos);  // a wall, y turned over
  EXPECT_TRUE(plot_svg(world_, {}, 0.22).ends_with("</svg>\n"));
}

}  // namespace
}  // namespace saphira::sim
