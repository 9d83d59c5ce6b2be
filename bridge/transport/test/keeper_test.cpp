#include "saphira/transport/keeper.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "trouble.hpp"

namespace saphira::transport {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

const std::vector<std::uint8_t> kStop{'S', 'T', 'O', 'P'};

std::string program() {
  const char* const folder = std::getenv("SAPHIRA_BIN_DIR");
  return std::string(folder == nullptr ? "." : folder) + "/saphira-keeper";
}

/// A robot at the end of a socket pair.
struct Robot {
  Robot() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0); }
  ~Robot() {
    if (ends[0] >= 0)
      ::close(ends[0]);
    ::close(ends[1]);
  }
  /// The bytes within the time; empty where nothing came, "end" at the end.
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
  Keeper keeper(milliseconds(300), program());
  keeper.watch(robot.ends[0], kStop);
  for (int i = 0; i < 12; ++i) {
    keeper.beat();
    EXPECT_EQ(robot.hear(50), "");
  }
}

TEST(Keeper, StopsTheRobotWhenTheHeartIsSilentAndUntilItBeats) {
  Robot robot;
  Keeper keeper(milliseconds(300), program());
  keeper.watch(robot.ends[0], kStop);
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
  Keeper keeper(milliseconds(50), program());
  EXPECT_EQ(robot.hear(200), "") << "no robot yet";
  keeper.watch(robot.ends[0], kStop);
  keeper.watch(other.ends[0], kStop);
  EXPECT_EQ(other.hear(5000), "STOP");
  EXPECT_EQ(robot.hear(0), "");
  keeper.unwatch();
  // After unwatch the keeper holds no copy: the end is seen.
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
    Keeper keeper(milliseconds(10000), program());
    keeper.watch(robot.ends[0], kStop);
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

/// Beats until another process keeps the robot.
bool replaced(Keeper& keeper, int before) {
  const auto limit = Clock::now() + std::chrono::seconds(60);
  while (keeper.pid() == before && Clock::now() < limit) {
    keeper.beat();
    ::poll(nullptr, 0, 20);
  }
  return keeper.pid() != before;
}

TEST(Keeper, OneThatDiesIsReplacedAndKeepsTheSameRobot) {
  Robot robot;
  Keeper keeper(milliseconds(300), program());
  keeper.watch(robot.ends[0], kStop);
  ASSERT_TRUE(keeper.alive());
  ::kill(keeper.pid(), SIGKILL);
  ASSERT_TRUE(replaced(keeper, keeper.pid()));
  EXPECT_TRUE(keeper.alive());
  EXPECT_EQ(keeper.restarts(), 1);
  EXPECT_EQ(robot.hear(5000), "STOP") << "now the heart is silent";
}

TEST(Keeper, OneThatHangsIsReplaced) {
  Robot robot;
  Keeper keeper(milliseconds(300), program());
  keeper.watch(robot.ends[0], kStop);
  const int first = keeper.pid();
  ::kill(first, SIGSTOP);
  ASSERT_TRUE(replaced(keeper, first));
  EXPECT_TRUE(keeper.alive());
  EXPECT_NE(::kill(first, 0), 0) << "two keepers would stop the robot against each other";
}

TEST(Keeper, AMissingProgramIsNamed) {
  EXPECT_EQ(test::trouble_of<std::runtime_error>(
                [] { const Keeper keeper(milliseconds(300), "/nowhere/saphira-keeper"); }),
            "keeper: /nowhere/saphira-keeper: No such file or directory");
}

}  // namespace
}  // namespace saphira::transport
