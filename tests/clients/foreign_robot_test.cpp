// Our bridge with strict robots: a third-party simulator, and ours under the protocol checker.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "line.hpp"
#include "process.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/protocol/check.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

using std::chrono::seconds;

constexpr double kPeriod = 0.1;          // [s]
constexpr double kDistance = 0.485;      // [mm] of one unit of position
constexpr double kAngle = 360.0 / 4096;  // [deg]

void word(Wire& out, int value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xFF));
  out.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

/// A third-party robot server, after AMRISim's behavior with a Pioneer 3 DX: it listens on a TCP
/// port, sends 0x32 at rest and in motion, sends all sixteen sonars in every packet of 89 bytes,
/// has no watchdog, accepts one client, and ignores unknown commands. It drives on an empty plane.
class ForeignRobot {
 public:
  ForeignRobot()
      : checker_([](const protocol::RobotIdentity&) {
          return protocol::load_parameters(source("config/robots/p3dx.p"));
        }) {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(listener_, 1) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("no port for the foreign robot");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~ForeignRobot() {
    stop_ = true;
    thread_.join();
    if (client_ >= 0)
      ::close(client_);
    ::close(listener_);
  }
  ForeignRobot(const ForeignRobot&) = delete;
  ForeignRobot& operator=(const ForeignRobot&) = delete;

  int port() const { return port_; }
  double velocity() const { return velocity_; }  ///< [mm/s]
  double rotation() const { return rotation_; }  ///< [deg/s]
  double x() const { return x_; }                ///< [mm]
  bool motors() const { return motors_; }
  /// Changes the body of each following information packet before it is sent; the checker gets the
  /// unchanged packet.
  void spoil(std::function<void(Wire&)> how) {
    const std::lock_guard lock(mutex_);
    spoil_ = std::move(how);
  }
  /// Bytes outside of packets, and the strict checker's findings on both sides.
  std::string trouble() const {
    const std::lock_guard lock(mutex_);
    std::string all = trouble_;
    for (const protocol::Finding& finding : checker_.findings())
      if (finding.kind == protocol::Finding::Kind::kViolation)
        all += to_string(finding) + "; ";
    return all;
  }

 private:
  void watch(protocol::Side side, const Wire& bytes) {
    const std::lock_guard lock(mutex_);
    checker_.feed(side, bytes);
  }

  void send(const Wire& body) {
    const Wire bytes = packet(body);
    watch(protocol::Side::kServer, bytes);
    put(bytes);
  }

  void put(const Wire& bytes) const {
    [[maybe_unused]] const auto sent = ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  void run() {
    using Clock = std::chrono::steady_clock;
    Wire received;
    auto due = Clock::now();
    while (!stop_) {
      pollfd fds[2] = {{listener_, POLLIN, 0}, {client_, POLLIN, 0}};
      ::poll(fds, client_ >= 0 ? 2 : 1, 10);
      if (client_ < 0 && (fds[0].revents & POLLIN) != 0) {
        client_ = ::accept(listener_, nullptr, nullptr);
        received.clear();
        syncs_ = 0;
      }
      if (client_ >= 0 && fds[1].revents != 0) {
        std::uint8_t bytes[512];
        const ssize_t size = ::read(client_, bytes, sizeof bytes);
        if (size <= 0) {
          ::close(client_);
          client_ = -1;
          open_ = false;
          const std::lock_guard lock(mutex_);
          checker_.disconnect();
        } else {
          watch(protocol::Side::kClient, {bytes, bytes + size});
          received.insert(received.end(), bytes, bytes + size);
        }
      }
      while (received.size() >= 3 && received.size() >= 3U + received[2]) {
        const auto end = received.begin() + 3 + received[2];
        const Wire whole(received.begin(), end);
        const Wire body(received.begin() + 3, end - 2);
        received.erase(received.begin(), end);
        if (packet(body) == whole) {
          handle(body);
        } else {
          const std::lock_guard lock(mutex_);
          trouble_ += "a bad packet; ";
        }
      }
      if (Clock::now() < due)
        continue;
      due += std::chrono::milliseconds(100);
      if (heads_)
        rotation_ =
            std::clamp(std::remainder(heading_ - th_, 360.0) / kPeriod / 2.0, -100.0, 100.0);
      th_ = std::remainder(th_ + rotation_ * kPeriod, 360.0);
      x_ = x_ + velocity_ * kPeriod * std::cos(th_ * kPi / 180.0);
      y_ += velocity_ * kPeriod * std::sin(th_ * kPi / 180.0);
      if (open_)
        inform();
    }
  }

  void inform() {
    const Wire body = information();
    const Wire bytes = packet(body);
    watch(protocol::Side::kServer, bytes);
    Wire spoiled = body;
    {
      const std::lock_guard lock(mutex_);
      if (spoil_)
        spoil_(spoiled);
    }
    put(packet(spoiled));
  }

  Wire information() const {
    Wire body{0x32};
    word(body, static_cast<int>(std::floor(x_ / kDistance)) & 0x7FFF);
    word(body, static_cast<int>(std::floor(y_ / kDistance)) & 0x7FFF);
    word(body, static_cast<int>(std::lround(th_ / kAngle)));
    const double difference = rotation_ * kPi / 180.0 / 0.0056;
    word(body, static_cast<int>(std::lround(velocity_ - difference)));
    word(body, static_cast<int>(std::lround(velocity_ + difference)));
    body.push_back(130);                     // 13 V
    word(body, 0);                           // stalls, bumpers
    word(body, 0);                           // control
    word(body, (motors_ ? 1 : 0) | 3 << 1);  // flags
    body.push_back(0);                       // compass
    body.push_back(16);
    for (int i = 0; i < 16; ++i) {
      body.push_back(static_cast<std::uint8_t>(i));
      word(body, 3000 + 10 * i);
    }
    word(body, 0);  // gripper
    body.insert(body.end(), {0, 0, 0});
    word(body, 130);    // battery
    body.push_back(0);  // charge
    word(body, static_cast<int>(std::lround(rotation_ * 10)));
    word(body, 0);      // faults
    word(body, 0);      // lateral velocity
    body.push_back(0);  // temperature
    body.push_back(0);  // state of charge
    return body;
  }

  void handle(const Wire& body) {
    if (!open_ && body.size() == 1 && body[0] == syncs_ && syncs_ < 3) {
      Wire answer{body[0]};
      if (syncs_ == 2)
        for (const std::string text : {"MobileSim", "Pioneer", "p3dx"}) {
          answer.insert(answer.end(), text.begin(), text.end());
          answer.push_back(0);
        }
      ++syncs_;
      send(answer);
      return;
    }
    if (syncs_ < 3) {
      const std::lock_guard lock(mutex_);
      trouble_ += "command " + std::to_string(body[0]) + " before the synchronization; ";
      return;
    }
    int value = 0;
    if (body.size() >= 4) {
      value = body[2] | body[3] << 8;
      if (body[1] == 0x1B)
        value = -value;
    }
    switch (body[0]) {
      case 1:
        open_ = true;
        break;
      case 2:
        open_ = false;
        syncs_ = 0;
        velocity_ = rotation_ = 0.0;
        heads_ = false;
        break;
      case 4:
        motors_ = value != 0;
        break;
      case 7:
        x_ = th_ = 0.0;
        y_ = 0.0;
        break;
      case 11:
        velocity_ = motors_ ? value : 0;
        break;
      case 12:
        heads_ = motors_;
        heading_ = value;
        break;
      case 13:
        heads_ = motors_;
        heading_ = th_ + value;
        break;
      case 9:
      case 21:
        heads_ = false;
        rotation_ = motors_ ? value : 0;
        break;
      default:
        break;  // unsupported, as most are
    }
  }

  int listener_ = -1;
  int client_ = -1;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  std::atomic<bool> open_{false};
  std::atomic<bool> motors_{false};
  std::atomic<double> velocity_{0.0};
  std::atomic<double> rotation_{0.0};
  std::atomic<double> x_{0.0};
  std::atomic<double> th_{0.0};
  double y_ = 0.0;
  double heading_ = 0.0;
  bool heads_ = false;
  int syncs_ = 0;
  mutable std::mutex mutex_;
  std::function<void(std::vector<std::uint8_t>&)> spoil_;
  std::string trouble_;
  protocol::Checker checker_;
  std::thread thread_;
};

class ForeignRobotTest : public ::testing::Test {
 protected:
  ForeignRobotTest() {
    scene.robot_port = "tcp:127.0.0.1:" + std::to_string(robot.port());
    scene.start_bridge();
  }

  ForeignRobot robot;
  Scene scene;
};

TEST_F(ForeignRobotTest, IsDrivenByOurBridge) {
  ASSERT_TRUE(scene.until([&] { return scene.connected() && scene.description; }))
      << scene.bridge_log();
  EXPECT_EQ(scene.description->robot_class, "Pioneer");
  EXPECT_TRUE(scene.description->parameter_file.ends_with("/p3dx.p"));
  ASSERT_TRUE(scene.until([&] { return scene.state.sonars.size() == 16; }));
  EXPECT_NEAR(scene.state.sonars[5].range, 3.05, 0.01);
  EXPECT_NEAR(scene.state.battery, 13.0, 1e-6);

  forward(scene.command, 0.25, 0.0);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return robot.velocity() == 250.0; })) << scene.bridge_log();
  EXPECT_TRUE(robot.motors());
  ASSERT_TRUE(scene.until([&] { return scene.state.pose_in_odom.x > 1.0; }));
  EXPECT_NEAR(scene.state.pose_in_odom.x, robot.x() / 1000.0, 0.1);
  forward(scene.command, 0.0, radians(30.0));
  ASSERT_TRUE(scene.until([&] { return scene.state.rotation_velocity > radians(25.0); }));
  EXPECT_NEAR(robot.rotation(), 30.0, 1.0);

  // It has no watchdog: only the bridge stops it.
  scene.drives = false;
  ASSERT_TRUE(scene.until([&] { return robot.velocity() == 0.0 && robot.rotation() == 0.0; }))
      << scene.bridge_log();
  EXPECT_EQ(robot.trouble(), "");
  EXPECT_EQ(scene.state.bad_packets, 0U);
}

TEST_F(ForeignRobotTest, StopsWhenTheBridgeIsKilled) {
  forward(scene.command, 0.2, 0.0);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return robot.velocity() == 200.0; })) << scene.bridge_log();
  scene.bridge->signal(SIGKILL);
  EXPECT_TRUE(scene.until([&] { return robot.velocity() == 0.0; }, seconds(5)));
  EXPECT_EQ(robot.trouble(), "");
}

// Impossible fields, with a right checksum.
TEST_F(ForeignRobotTest, IsStoppedWhileNoneOfItsPacketsCanBeTrue) {
  forward(scene.command, 0.2, 0.0);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.velocity > 0.19; })) << scene.bridge_log();
  const std::uint64_t epoch = scene.state.stamp.epoch;
  robot.spoil([](std::vector<std::uint8_t>& body) {
    body[7] = 0x01;  // the left wheel backward, the right one forward, at the largest speed
    body[8] = 0x80;
    body[9] = 0xFF;
    body[10] = 0x7F;
  });
  // It also waited during the connection.
  ASSERT_TRUE(scene.until([&] {
    return scene.status.state == v1::SERVICE_WAITING &&
           scene.status.reason.find("the robot sends a turn of 183 rad/s") == 0;
  })) << scene.status.reason;
  EXPECT_TRUE(scene.until([&] { return robot.velocity() == 0.0; }));
  // Longer than the limit of a silent link: packets come, so the link is not silent.
  scene.watch(std::chrono::milliseconds(3000));
  EXPECT_EQ(scene.status.reason.find("the robot sends a turn of 183 rad/s"), 0U)
      << scene.status.reason;
  robot.spoil({});
  ASSERT_TRUE(scene.until([&] { return scene.status.state == v1::SERVICE_RUNNING; }))
      << scene.status.reason;
  EXPECT_EQ(scene.state.stamp.epoch, epoch) << "the session went on";
  EXPECT_GT(scene.state.bad_packets, 20U);
  for (const v1::RobotState& state : scene.states)
    EXPECT_LT(std::abs(state.rotation_velocity), 1.0);
  EXPECT_TRUE(scene.until([&] { return robot.velocity() == 200.0; })) << "and so does the drive";
}

// All traffic between bridge and simulator, from the synchronization to the end.
TEST(UnderTheChecker, BridgeAndSimulatorKeepToTheTables) {
  Scene scene;
  scene.robot_file = "p3dx-sh.p";
  scene.start_simulator();
  ASSERT_TRUE(wait_until([&] { return ::access(scene.folder.path("robot").c_str(), F_OK) == 0; }));
  Process checker({"saphira-protocol-check", "--listen", scene.folder.path("watched"), "--server",
                   scene.folder.path("robot"), "--robots", source("config/robots")},
                  scene.folder.path("checker.log"));
  scene.robot_port = scene.folder.path("watched");
  scene.start_bridge();
  ASSERT_TRUE(scene.until([&] { return scene.connected(); })) << scene.bridge_log();
  forward(scene.command, 0.15, 0.2);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.pose_in_odom.x > 0.3; })) << scene.bridge_log();
  scene.drives = false;
  ASSERT_TRUE(scene.until([&] { return scene.rests(); }));
  scene.bridge->signal(SIGTERM);
  scene.bridge->wait();
  checker.signal(SIGTERM);
  EXPECT_EQ(checker.wait(), 0) << checker.output();
  EXPECT_NE(checker.output().find("x VEL (11)"), std::string::npos) << checker.output();
  EXPECT_NE(checker.output().find("0 violations"), std::string::npos) << checker.output();
}

}  // namespace
}  // namespace saphira::test
