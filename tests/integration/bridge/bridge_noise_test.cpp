// A line that damages bytes: the robot executes only commands that were sent, and the bridge
// publishes no implausible state.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "saphira/base/random.hpp"
#include "scene.hpp"

namespace saphira::test {
namespace {

sockaddr_un address(const std::string& path) {
  sockaddr_un out{};
  out.sun_family = AF_UNIX;
  path.copy(out.sun_path, sizeof out.sun_path - 1);
  return out;
}

/// A bad line: listens on a local socket, connects to another for each client, and corrupts, drops
/// or doubles bytes in both directions, each with a third of the probability. Seeded.
class NoisyLine {
 public:
  NoisyLine(std::string listen_on, std::string connect_to, std::uint64_t seed)
      : path_(std::move(listen_on)),
        target_(std::move(connect_to)),
        seed_(seed),
        listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_un name = address(path_);
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 ||
        ::listen(listener_, 4) != 0)
      throw std::runtime_error(path_ + ": cannot listen");
    thread_ = std::thread([this] { run(); });
  }
  ~NoisyLine() {
    stop_ = true;
    thread_.join();
    ::close(listener_);
    ::unlink(path_.c_str());
  }
  NoisyLine(const NoisyLine&) = delete;
  NoisyLine& operator=(const NoisyLine&) = delete;

  /// Of a byte to, and from the robot; 0 at first.
  void set_probability(double to, double from) {
    probability_[0] = to;
    probability_[1] = from;
  }
  std::uint64_t hurt() const { return hurt_; }

 private:
  void run() {
    while (!stop_) {
      pollfd ready{listener_, POLLIN, 0};
      if (::poll(&ready, 1, 50) != 1)
        continue;
      const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (client >= 0) {
        serve(client);
        ::close(client);
      }
    }
  }
  void serve(int client) {
    const int robot = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const sockaddr_un name = address(target_);
    if (::connect(robot, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0) {
      ::close(robot);
      return;
    }
    Random random(seed_);
    pollfd ends[2] = {{client, POLLIN, 0}, {robot, POLLIN, 0}};
    bool open = true;
    while (open && !stop_) {
      ::poll(ends, 2, 50);
      for (int i = 0; i < 2; ++i) {
        if (ends[i].revents == 0)
          continue;
        std::uint8_t in[512];
        const ssize_t n = ::read(ends[i].fd, in, sizeof in);
        if (n <= 0) {
          open = false;
          break;
        }
        std::vector<std::uint8_t> out;
        for (ssize_t k = 0; k < n; ++k) {
          if (!random.chance(probability_[i])) {
            out.push_back(in[k]);
            continue;
          }
          ++hurt_;
          switch (random.next() % 3) {
            case 0:
              out.push_back(static_cast<std::uint8_t>(random.next()));
              break;
            case 1:
              break;
            default:
              out.push_back(in[k]);
              out.push_back(in[k]);
          }
        }
        if (::send(ends[1 - i].fd, out.data(), out.size(), MSG_NOSIGNAL) < 0)
          open = false;
      }
    }
    ::close(robot);
  }

  std::string path_;
  std::string target_;
  std::atomic<double> probability_[2]{0.0, 0.0};
  std::uint64_t seed_;
  int listener_ = -1;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> hurt_{0};
  std::thread thread_;
};

TEST(BridgeNoise, NoWrongCommandIsActedOn) {
  Scene scene;
  scene.robot_port = scene.folder.path("line");
  scene.bridge_options = {"--no-guard"};  // which would add speeds of its own
  scene.start_simulator();
  ASSERT_TRUE(
      wait_until([&] { return scene.simulator->output().find("listening") != std::string::npos; }));
  NoisyLine line(scene.robot_port, scene.folder.path("robot"), 42);
  scene.start_bridge();
  // Whole numbers of the packet's units, so that executed commands can be compared exactly.
  Random random(7);
  std::set<int> speeds{0};
  std::set<int> turns{0};
  scene.command.translation = v1::TRANSLATION_VELOCITY;
  scene.command.rotation = v1::ROTATION_VELOCITY;
  scene.command.velocity = 0.2;
  speeds.insert(200);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] { return scene.state.velocity > 0.18; })) << scene.bridge_log();
  EXPECT_EQ(scene.simulator->violations(), "");
  scene.simulator->expect_violations();
  line.set_probability(0.1, 0.0);
  int moved = 0;
  for (int leg = 0; leg < 24; ++leg) {
    const int speed = static_cast<int>(random.next() % 9) * 50 - 200;
    const int turn = static_cast<int>(random.next() % 9) * 10 - 40;
    speeds.insert(speed);
    turns.insert(turn);
    scene.command.velocity = speed * 0.001;
    scene.command.rotation_velocity = radians(turn);
    scene.watch(std::chrono::milliseconds(500));
    if (!scene.rests())
      ++moved;
  }
  EXPECT_TRUE(scene.bridge->running()) << scene.bridge_log();
  EXPECT_TRUE(scene.simulator->running());
  EXPECT_GT(line.hurt(), 50U);
  EXPECT_NE(scene.simulator->violations(), "") << "the checker listens";
  EXPECT_GT(moved, 12) << "where the robot is heard it still drives";

  const auto rows = scene.whole_trace();
  int executed = 0;
  for (const sim::TraceRow& row : rows) {
    const int speed = static_cast<int>(std::lround(row.set_velocity * 1000.0));
    ASSERT_TRUE(speeds.contains(speed)) << "cycle " << row.cycle << ": nobody sent " << speed;
    ASSERT_NEAR(row.set_velocity * 1000.0, speed, 1e-6);
    ASSERT_TRUE(std::isnan(row.set_heading)) << "nobody sent a heading";
    const int turn = static_cast<int>(std::lround(degrees(row.set_rotation_velocity)));
    ASSERT_TRUE(turns.contains(turn)) << "cycle " << row.cycle << ": nobody sent " << turn;
    executed += speed != 0;
  }
  EXPECT_GT(executed, 0);
  std::printf(
      "%zu bytes hurt, %zu of %zu cycles seen, %d cycles driven, %u bad "
      "packets\n",
      static_cast<std::size_t>(line.hurt()), scene.states.size(), rows.size(), executed,
      scene.state.bad_packets);

  // The states on the bus are plausible: no jump of the pose, no impossible speed.
  const v1::RobotState* last = nullptr;
  for (const v1::RobotState& state : scene.states) {
    ASSERT_LT(std::abs(state.velocity), 0.45);
    if (last != nullptr && last->stamp.epoch == state.stamp.epoch && last->odom == state.odom) {
      ASSERT_LT(std::hypot(state.pose_in_odom.x - last->pose_in_odom.x,
                           state.pose_in_odom.y - last->pose_in_odom.y),
                0.8);
    }
    last = &state;
  }
}

}  // namespace
}  // namespace saphira::test
