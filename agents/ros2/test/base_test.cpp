// A robot that only speaks ROS 2, driven by packets. No sockets, no clock.
#include "saphira/ros2/base.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lines.hpp"
#include "saphira/base/format.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"

namespace saphira::ros2 {
namespace {

using protocol::Bytes;

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kEps = 1e-6;

protocol::RobotParameters robot() {
  protocol::RobotParameters parameters = protocol::load_parameters(
      std::string(std::getenv("SAPHIRA_SOURCE_DIR")) + "/config/robots/ros2.p");
  // Exactly from the middle.
  for (protocol::SonarUnit& unit : parameters.sonars)
    unit.pose_in_robot = {0.0, 0.0, unit.pose_in_robot.th};
  return parameters;
}

/// 360 rays, a degree apart, from straight ahead.
LaserScan scan_of(float everywhere) {
  LaserScan scan;
  scan.header.frame_id = "laser";
  scan.angle_increment = static_cast<float>(radians(1.0));
  scan.range_min = 0.12F;
  scan.range_max = 12.0F;
  scan.ranges.assign(360, everywhere);
  return scan;
}

Odometry odometry_at(const Pose& pose, double velocity = 0.0) {
  Odometry odometry;
  odometry.header.frame_id = "odom";
  odometry.child_frame_id = "base_footprint";
  odometry.pose.pose.position = {pose.x, pose.y, 0.0};
  odometry.pose.pose.orientation = {0.0, 0.0, std::sin(pose.th / 2), std::cos(pose.th / 2)};
  odometry.twist.twist.linear.x = velocity;
  return odometry;
}

TFMessage fixed(const std::string& parent, const std::string& child, double x, double turn) {
  TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].child_frame_id = child;
  message.transforms[0].transform.translation.x = x;
  message.transforms[0].transform.rotation = {0.0, 0.0, std::sin(turn / 2), std::cos(turn / 2)};
  return message;
}

std::optional<double> range_of(const std::vector<sim::SonarEcho>& echoes, int number) {
  for (const sim::SonarEcho& echo : echoes)
    if (echo.number == number)
      return echo.range;
  return std::nullopt;
}

TEST(Echoes, EachSectorHasItsNearestRay) {
  LaserScan scan = scan_of(kFar);
  scan.ranges[3] = 2.0F;
  scan.ranges[356] = 1.5F;
  scan.ranges[30] = 5.0F;  // beyond SonarMaxRange
  scan.ranges[90] = -kFar;
  const auto found = echoes(scan, Eigen::Isometry3d::Identity(), robot());
  ASSERT_EQ(found.size(), 24U);
  EXPECT_NEAR(*range_of(found, 0), 1.5, kEps);
  EXPECT_FALSE(range_of(found, 1));
  EXPECT_FALSE(range_of(found, 2));
  EXPECT_NEAR(*range_of(found, 6), 0.12, kEps);  // nearer than the laser measures
}

TEST(Echoes, WhatIsNotMeasuredIsNeitherFreeNorAnEcho) {
  for (const float none : {kNone, 0.0F, 0.1F, 12.5F, -1.0F}) {
    LaserScan scan = scan_of(none);
    scan.ranges[0] = 1.0F;
    const auto found = echoes(scan, Eigen::Isometry3d::Identity(), robot());
    ASSERT_EQ(found.size(), 1U) << none;
    EXPECT_EQ(found[0].number, 0);
  }
}

TEST(Echoes, ALaserIsWhereItIs) {
  LaserScan scan = scan_of(kNone);
  scan.ranges[90] = 1.0F;
  // Looks to the back, 0.2 m before the middle.
  Eigen::Isometry3d place =
      Eigen::Translation3d(0.2, 0.0, 0.0) * Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(*range_of(echoes(scan, place, robot()), 12), 0.8, kEps);
  // Upside down its left is the robot's right.
  place = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(*range_of(echoes(scan, place, robot()), 18), 1.0, kEps);
}

/// A client of a robot whose topics come each 50 ms.
struct Client {
  Client() {
    base.take(fixed("base_footprint", "base_link", 0.0, 0.0));
    base.take(fixed("base_link", "laser", 0.0, 0.0));
    base.heard(true);
    topics();
  }
  void topics() {
    if (has_odometry)
      base.take(odometry_at(pose, velocity), now);
    if (has_scan)
      base.take(scan, now);
  }
  void run(double seconds) {
    for (const double end = now + seconds - kEps; now < end;) {
      now += 0.01;
      if (++ticks % 5 == 0)
        topics();
      receive(base.advance(now));
    }
  }
  void receive(const Base::Output& output) {
    if (output.cmd_vel) {
      cmd_vel = *output.cmd_vel;
      ++written;
      fastest = std::max(fastest, cmd_vel.linear.x);
    }
    parser.feed(output.to_client);
    while (const auto body = parser.next()) {
      ++packets;
      if (const auto packet = protocol::decode_information(*body))
        newest = *packet;
    }
  }
  void say(const protocol::Command& command) { base.receive(protocol::encode(command)); }
  void open() {
    for (int i = 0; i < 3; ++i) {
      base.receive(protocol::encode_sync(i));
      run(0.01);
    }
    say(protocol::Open{});
    say(protocol::Enable{true});
    run(0.2);
  }

  double now = 100.0;
  int ticks = 0;
  Base base{robot(), {}, now};
  Pose pose;
  double velocity = 0.0;
  bool has_odometry = true;
  bool has_scan = true;
  LaserScan scan = scan_of(2.0F);
  protocol::PacketParser parser;
  protocol::InformationPacket newest;
  int packets = 0;
  Twist cmd_vel;
  double fastest = 0.0;
  int written = 0;
};

class BaseTest : public ::testing::Test, protected Client {};

/// The cases of base.txt. "cmd" is cmd_vel, forward [m/s] and turning [deg/s]; counts begin at
/// "mark".
class Play : public test::LinePlayer, private Client {
 public:
  Play() {
    const auto says = [this](auto command) { return [=, this](auto&) { say(command); }; };
    events_ = {
      ON("open", open()),
      ON("velocity", say(protocol::Velocity{read<double>(in)})),
      ON("rotation", say(protocol::RotationVelocity{radians(read<double>(in))})),
      ON("heading", say(protocol::Heading{radians(read<double>(in))})),
      {"emergency", says(protocol::EmergencyStop{})},
      {"close", says(protocol::Close{})},
      {"origin", says(protocol::SetOrigin{})},
      ON("disconnect", base.disconnect()),
      ON("run", run(read<double>(in))),
      {"pose",
       [this](auto& in) {
         pose.x = read<double>(in);
         pose.y = read<double>(in);
         pose.th = radians(read<double>(in));
       }},
      ON("odometry", has_odometry = rest(in) == "on"),
      ON("scan", has_scan = rest(in) == "on"),
      ON("stamped-scan", scan.header.stamp = {5, 0}; topics()),
      ON("mark", written = packets = 0; fastest = 0.0)
    };
    facts_ = {IS("cmd", format("%.3g %.3g", cmd_vel.linear.x, degrees(cmd_vel.angular.z))),
              IS("fastest", format("%.3g", fastest)),
              IS("written", std::to_string(written)),
              IS("heard", yes(packets > 0)),
              IS("place", format("%d %d", newest.x, newest.y)),
              IS("trouble", base.trouble(now))};
  }
};

TEST(Base, IsAsWritten) {
  EXPECT_EQ(test::play<Play>("agents/ros2/test/base.txt"), 10);
}

TEST_F(BaseTest, NamesItselfAndReportsWhatTheTopicsSay) {
  base.heard(false);
  run(1.0);
  EXPECT_EQ(written, 0);
  base.heard(true);
  run(0.01);
  EXPECT_EQ(written, 1) << "at once: the program before it may have been killed";
  run(1.0);
  EXPECT_EQ(written, 10);  // of the begin
  EXPECT_EQ(cmd_vel, Twist{});
  pose = {1.0, -0.5, 0.3};
  velocity = 0.2;
  BatteryState battery{.voltage = 12.1F};
  base.take(battery);
  open();
  EXPECT_GE(packets, 4);  // the answers to SYNC
  const protocol::Information in = protocol::interpret(newest, robot());
  EXPECT_EQ(newest.x, 1000);
  EXPECT_EQ(newest.y, 32768 - 500);
  EXPECT_NEAR(in.th, 0.3, 0.001);
  EXPECT_NEAR(in.velocity, 0.2, 0.001);
  EXPECT_NEAR(in.battery, 12.1, 0.05);
  EXPECT_NE(newest.motors, protocol::Motors::kNoPower);
  ASSERT_EQ(in.sonars.size(), 24U);
  EXPECT_NEAR(in.sonars[0].range, 2.0, 0.001);
  EXPECT_TRUE(in.sonars[0].echo);
}

TEST_F(BaseTest, TroubleIsNamed) {
  Base other(robot(), {}, now);
  EXPECT_EQ(other.trouble(now), "no odometry has come");
  EXPECT_TRUE(other.take(odometry_at({}), now));
  EXPECT_FALSE(other.take(odometry_at({std::nan(""), 0.0, 0.0}), now));
  EXPECT_EQ(other.trouble(now), "no scan and no range has come");
  EXPECT_TRUE(other.take(scan, now));
  EXPECT_EQ(other.trouble(now), "tf_static does not say where laser is in base_footprint");
  other.take(fixed("base_footprint", "laser", 0.1, 0.0));
  LaserScan near = scan;
  near.range_max = 2.0F;
  EXPECT_TRUE(other.take(near, now));
  EXPECT_EQ(other.trouble(now),
            "laser reaches 2.00 m, and the SonarMaxRange of the robot's file is 3.40 m");
  EXPECT_TRUE(other.take(scan, now));
  EXPECT_EQ(other.trouble(now), "nobody takes cmd_vel");
  other.heard(true);
  EXPECT_EQ(other.trouble(now), "");
}

TEST_F(BaseTest, RangesOfASensorAreThoseOfItsSonar) {
  Base other(robot(), {}, now);
  other.heard(true);
  EXPECT_TRUE(other.take(odometry_at({}), now));
  other.take(fixed("base_footprint", "sonar_3", 0.15, kPi / 4));
  Range range;
  range.header.frame_id = "sonar_3";
  range.min_range = 0.05F;
  range.max_range = 5.0F;
  range.range = 1.0F;
  EXPECT_TRUE(other.take(range, now));
  EXPECT_EQ(other.trouble(now), "");
  EXPECT_EQ(other.trouble(now + Base::kLost + 0.01), "the odometry has ended");
}

/// The body turns as cmd_vel says, 0.15 s later, and reports it each 50 ms.
TEST_F(BaseTest, ATurnToAHeadingDoesNotOvershootDespiteTheLag) {
  open();
  say(protocol::Heading{radians(90.0)});
  std::vector<double> late(15, 0.0);
  double furthest = 0.0;
  for (int i = 0; i < 500; ++i) {
    run(0.01);
    late.push_back(cmd_vel.angular.z);
    pose.th += late[late.size() - 16] * 0.01;
    furthest = std::max(furthest, pose.th);
    if (i % 100 == 99)
      say(protocol::Pulse{});
  }
  EXPECT_NEAR(pose.th, radians(90.0), radians(1.0));
  EXPECT_LT(furthest, radians(92.0));
  EXPECT_EQ(cmd_vel.angular.z, 0.0);
}

}  // namespace
}  // namespace saphira::ros2
