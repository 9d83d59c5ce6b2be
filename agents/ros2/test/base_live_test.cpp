// A base on Cyclone DDS, without a timeout of its own, is driven through the bridge.
#include <atomic>
#include <cmath>
#include <csignal>
#include <fstream>
#include <optional>
#include <thread>
#include <utility>

#include "cyclone_client.hpp"
#include "ros2_cyclone.h"
#include "saphira/bus/topics.hpp"
#include "scene.hpp"

namespace saphira::ros2 {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr float kTurn = 6.2831853F;

/// It drives along the x axis, as its newest cmd_vel says, and sees a wall across it.
class FakeBase {
 public:
  static constexpr double kWall = 2.5;  // [m]

  explicit FakeBase(const std::string& space)
      : odom_(client_.writer("rt/" + space + "/odom", nav_msgs_msg_dds__Odometry__desc)),
        scan_(client_.writer("rt/" + space + "/scan", sensor_msgs_msg_dds__LaserScan__desc)),
        fixed_(
            client_.writer("rt/" + space + "/tf_static", tf2_msgs_msg_dds__TFMessage__desc, true)),
        cmd_vel_(client_.reader("rt/" + space + "/cmd_vel", geometry_msgs_msg_dds__Twist__desc)) {
    geometry_msgs_msg_dds__TransformStamped_ laser{};
    laser.header.frame_id = base_frame_.data();
    laser.child_frame_id = laser_frame_.data();
    laser.transform.rotation.w = 1.0;
    tf2_msgs_msg_dds__TFMessage_ message{};
    message.transforms._length = message.transforms._maximum = 1;
    message.transforms._buffer = &laser;
    dds_write(fixed_, &message);
    thread_ = std::thread([this] {
      while (!ends_) {
        step();
        std::this_thread::sleep_for(kStep);  // the pace of the base, not a wait for anything
      }
    });
  }
  ~FakeBase() {
    ends_ = true;
    thread_.join();
  }

  std::atomic<bool> has_scan{true};
  std::atomic<double> x{0.0};
  std::atomic<double> velocity{0.0};  // that cmd_vel asked for last

 private:
  static constexpr std::chrono::milliseconds kStep{20};

  void step() {
    const auto obey = [this](const geometry_msgs_msg_dds__Twist_& twist) {
      velocity = twist.linear.x;
      return true;
    };
    take<geometry_msgs_msg_dds__Twist_>(cmd_vel_, obey);
    x = x + velocity * Seconds(kStep).count();
    nav_msgs_msg_dds__Odometry_ odometry{};
    odometry.header.frame_id = odom_frame_.data();
    odometry.child_frame_id = base_frame_.data();
    odometry.pose.pose.position.x = x;
    odometry.pose.pose.orientation.w = 1.0;
    odometry.twist.twist.linear.x = velocity;
    dds_write(odom_, &odometry);
    if (!has_scan || ++steps_ % 5 != 0)
      return;
    sensor_msgs_msg_dds__LaserScan_ scan{};
    scan.header.frame_id = laser_frame_.data();
    scan.angle_increment = kTurn / static_cast<float>(ranges_.size());
    scan.range_min = 0.12F;
    scan.range_max = 12.0F;
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      const float ahead = std::cos(static_cast<float>(i) * scan.angle_increment);
      const auto range = static_cast<float>(kWall - x) / ahead;
      ranges_[i] = ahead > 0.0F && range < scan.range_max ? range : HUGE_VALF;
    }
    scan.ranges._length = scan.ranges._maximum = static_cast<std::uint32_t>(ranges_.size());
    scan.ranges._buffer = ranges_.data();
    dds_write(scan_, &scan);
  }

  const Client client_;
  std::string odom_frame_ = "odom";
  std::string base_frame_ = "base_link";
  std::string laser_frame_ = "laser";
  const dds_entity_t odom_, scan_, fixed_, cmd_vel_;
  std::vector<float> ranges_ = std::vector<float>(360);
  int steps_ = 0;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

/// A bridge with the base as its robot, and a driver. The tests of the bridge's core and base_test
/// cover the times.
class Ros2Base : public ::testing::Test {
 protected:
  void start() {
    scene.robot_port = "ros2:" + scene.robot + ",domain=" + test::domain() + ",interface=127.0.0.1";
    scene.start_bridge();
    EXPECT_TRUE(reason("no odometry")) << scene.status.reason;
    base.emplace(scene.robot);
    ASSERT_TRUE(scene.until([&] { return scene.connected(); })) << scene.bridge_log();
    epoch = scene.state.stamp.epoch;
    scene.use(bus::topics::kDriveTeleop);
    scene.drives = true;
  }
  bool reason(const std::string& part) {
    return scene.until([&] { return scene.status.reason.find(part) != std::string::npos; });
  }
  bool drive(double velocity) {
    test::forward(scene.command, velocity);
    return scene.until([&] {
      // A person who was stopped lets go, and presses again.
      scene.command.active = scene.grant.role != v1::ROLE_NONE || scene.command.number % 20 >= 10;
      return std::abs(base->velocity) > 0.7 * std::abs(velocity);
    });
  }
  bool stops() {
    return scene.until([&] { return base->velocity == 0.0; });
  }
  bool connects_again() {
    const std::uint64_t before = std::exchange(epoch, scene.state.stamp.epoch);
    return scene.until([&] { return (epoch = scene.state.stamp.epoch) > before; });
  }

  test::Scene scene;
  std::optional<FakeBase> base;
  std::uint64_t epoch = 0;
};

TEST_F(Ros2Base, DrivesAndStopsForAWallAPressALossAndAKill) {
  start();
  EXPECT_EQ(scene.description->robot_subclass, "ros2");
  EXPECT_EQ(scene.description->sonars.size(), 24U);

  // The guard holds it before the wall.
  EXPECT_TRUE(drive(0.3)) << scene.bridge_log();
  EXPECT_TRUE(scene.until([&] { return base->velocity == 0.0 && base->x > 1.0; }));
  EXPECT_LT(base->x, FakeBase::kWall);

  // The emergency stop, backward.
  EXPECT_TRUE(drive(-0.2));
  bus::Writer<v1::MotorCommand> estop = scene.node.writer(bus::topics::kDriveEstop);
  v1::MotorCommand press{.source = "test", .active = true};
  EXPECT_TRUE(scene.until([&] {
    ++press.number;
    estop.write(press);
    return scene.grant.estopped;
  }));
  EXPECT_TRUE(stops());
  EXPECT_TRUE(scene.until([&] {
    return scene.ask(bus::topics::kEstopReset, "reset").code == v1::ANSWER_DONE;
  })) << "once no press counts any more";

  // The scan ends while it drives, and comes again.
  EXPECT_TRUE(drive(-0.2));
  base->has_scan = false;
  EXPECT_TRUE(stops());
  EXPECT_TRUE(reason("no scan")) << scene.status.reason;
  base->has_scan = true;
  EXPECT_TRUE(connects_again());
  EXPECT_TRUE(drive(-0.2)) << scene.bridge_log();

  // The translator is killed: the next one says at once that the robot stands.
  const std::string bridge = std::to_string(scene.bridge->pid());
  std::ifstream children("/proc/" + bridge + "/task/" + bridge + "/children");
  for (int pid = 0; children >> pid;) {
    std::string name;
    std::getline(std::ifstream("/proc/" + std::to_string(pid) + "/comm"), name);
    if (name == "saphira-ros2-ba")
      ::kill(pid, SIGKILL);
  }
  scene.command.velocity = 0.0;
  EXPECT_TRUE(stops());

  // So is the bridge.
  EXPECT_TRUE(connects_again());
  EXPECT_TRUE(drive(-0.2));
  scene.bridge->signal(SIGKILL);
  EXPECT_TRUE(stops());
}

}  // namespace
}  // namespace saphira::ros2
