#include "saphira/transport/keeper.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

namespace saphira::transport {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

const std::vector<std::uint8_t> kStop{'S', 'T', 'O', 'P'};

/// A robot at the end of a socket pair.
struct Robot {
  Robot() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0); }
  ~Robot() {
    if (ends[0] >= 0)
      ::close(ends[0]);
    ::close(ends[1]);
  }
  /// What came within the time; empty where nothing did, "end" at the end.
  std::string hear(int ms) const {
    pollfd ready{ends[1], POLLIN, 0};
    if (::poll(&ready, 1, ms) != 1)
      return {};
    char buffer[64];
    const ssize_t n = ::read(ends[1], buffer, sizeof buffer);
    return n <= 0 ? "end" : std::string(buffer, static_cast<std::size_t>(n));
  }
  int ends[2];  ///< the bridge's, the robot's
};

TEST(Keeper, IsSilentWhileTheHeartBeats) {
  Robot robot;
  Keeper keeper(kStop, milliseconds(300));
  keeper.watch(robot.ends[0]);
  for (int i = 0; i < 12; ++i) {
    keeper.beat();
    EXPECT_EQ(robot.hear(50), "");
  }
}

TEST(Keeper, StopsTheRobotWhenTheHeartIsSilentAndUntilItBeats) {
  Robot robot;
  Keeper keeper(kStop, milliseconds(300));
  keeper.watch(robot.ends[0]);
  const auto start = Clock::now();
  EXPECT_EQ(robot.hear(5000), "STOP");
  EXPECT_GE(Clock::now() - start, milliseconds(290));
  EXPECT_EQ(robot.hear(5000), "STOP") << "again: a packet may be lost";
  keeper.beat();
  while (!robot.hear(20).empty()) {
  }
  for (int i = 0; i < 6; ++i) {
    keeper.beat();
    EXPECT_EQ(robot.hear(50), "");
  }
}

TEST(Keeper, KeepsWhatItIsGivenAlone) {
  Robot robot;
  Robot other;
  Keeper keeper(kStop, milliseconds(50));
  EXPECT_EQ(robot.hear(200), "") << "no robot yet";
  keeper.watch(robot.ends[0]);
  keeper.watch(other.ends[0]);
  EXPECT_EQ(other.hear(5000), "STOP");
  EXPECT_EQ(robot.hear(0), "");
  keeper.unwatch();
  // Told to leave it, the keeper holds no copy: the end is heard.
  ::close(other.ends[0]);
  other.ends[0] = -1;
  std::string heard;
  while ((heard = other.hear(5000)) == "STOP" || heard == "STOPSTOP") {
  }
  EXPECT_EQ(heard, "end");
}

// A whole bridge that is killed: its robot is stopped, and the keeper leaves nothing open.
TEST(Keeper, EndsWithTheBridgeAfterStoppingTheRobot) {
  Robot robot;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t bridge = ::fork();
  ASSERT_GE(bridge, 0);
  if (bridge == 0) {
    Keeper keeper(kStop, milliseconds(10000));
    keeper.watch(robot.ends[0]);
    ::close(robot.ends[1]);
    const char up = 'u';
    if (::write(ready[1], &up, 1) != 1)
      ::_exit(1);
    while (true)
      ::pause();
  }
  ::close(robot.ends[0]);
  robot.ends[0] = -1;
  char up = 0;
  ASSERT_EQ(::read(ready[0], &up, 1), 1);
  ::kill(bridge, SIGKILL);
  std::string heard;
  std::string all;
  while ((heard = robot.hear(5000)) != "end" && !heard.empty())
    all += heard;
  EXPECT_EQ(heard, "end");
  EXPECT_EQ(all, "STOPSTOP");
  ::waitpid(bridge, nullptr, 0);
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST(Keeper, ItsOwnEndIsNoticed) {
  Robot robot;
  Keeper keeper(kStop);
  keeper.watch(robot.ends[0]);
  ASSERT_TRUE(keeper.alive());
  ::kill(keeper.pid(), SIGKILL);
  const auto limit = Clock::now() + std::chrono::seconds(10);
  while (keeper.alive() && Clock::now() < limit)
    keeper.beat();
  EXPECT_FALSE(keeper.alive());
}

}  // namespace
}  // namespace saphira::transport
