// The stand-ins again, with the real program, in real time: over a pseudo-terminal as slow as a
// serial line at 9600 baud, over a local socket, over TCP. The checker sits in the simulator.

#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <regex>

#include "aria_client.hpp"
#include "beesoft_client.hpp"
#include "player_client.hpp"
#include "process.hpp"
#include "real_line.hpp"
#include "saphira/base/text.hpp"
#include "saphira/sim/trace.hpp"
#include "serial_line.hpp"

namespace saphira::test {
namespace {

enum class Way { kTerminal, kLocal, kTcp };

struct Case {
  const char* robot;
  Way way;
};

// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest looks for this name
void PrintTo(const Case& which, std::ostream* out) {
  *out << which.robot;
}

std::string printable(const ::testing::TestParamInfo<Case>& test) {
  return test_name(test.param.robot) + (test.param.way == Way::kTerminal ? "AtNinetySixHundredBaud"
                                        : test.param.way == Way::kLocal  ? "OnALocalSocket"
                                                                         : "OnTcp");
}

/// saphira-sim in the hall, and a line to it.
class RealTime : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const Way way = GetParam().way;
    std::ofstream(folder_.path("hall.wld")) << hall() << "position 4000 4000 0\n";
    std::vector<std::string> argv{"saphira-sim", "--world",        folder_.path("hall.wld"),
                                  "--robot",     GetParam().robot, "--trace",
                                  trace_};
    for (const std::string& word : way == Way::kTcp ? std::vector<std::string>{"--tcp", "0"}
                                                    : std::vector<std::string>{"--socket", socket_})
      argv.push_back(word);
    simulator_.emplace(argv, folder_.path("log"));
    std::smatch where;
    std::string log;
    ASSERT_TRUE(wait_until([&] {
      log = simulator_->output();
      return std::regex_search(log, where, std::regex("listening on .*[^0-9]([0-9]+)\n")) ||
             (way != Way::kTcp && log.find("listening on " + socket_) != std::string::npos);
    })) << log;
    if (way == Way::kTerminal)
      serial_.emplace(folder_.path("tty"), socket_, 9600);
    line_.emplace(way == Way::kTerminal ? RealLine::terminal(folder_.path("tty"))
                  : way == Way::kLocal  ? RealLine::local(socket_)
                                        : RealLine::tcp(std::stoi(where[1])));
  }

  // The newest row of the simulator's trace: the true state.
  sim::TraceRow truth() const { return sim::parse_trace(read_file(trace_), trace_).back(); }
  // Ends the program; returns all findings of the checker.
  std::string ended() {
    simulator_->signal(SIGTERM);
    EXPECT_EQ(simulator_->wait(), 0);
    EXPECT_FALSE(line_->closed()) << "the simulator hung up";
    return simulator_->checked();
  }

  TempDir folder_;
  std::string socket_ = folder_.path("robot");
  std::string trace_ = folder_.path("trace.csv");
  std::optional<Process> simulator_;
  std::optional<SerialLine> serial_;
  std::optional<RealLine> line_;
};

class AriaInRealTime : public RealTime {};

TEST_P(AriaInRealTime, ConnectsConfiguresDrivesSeesAndStops) {
  AriaClient client(*line_);
  ASSERT_EQ(client.connect(), "");
  client.poll(1.0);
  EXPECT_GE(client.sips(), 8);
  const KnownRobot& known = *client.known();
  EXPECT_EQ(client.has_config(), known.moves);
  const double ahead = 3000.0 - known.front_x;
  EXPECT_NEAR(client.sonar().at(known.front), ahead, 150.0);

  client.drive_a_metre();
  EXPECT_NEAR(client.x(), 1000.0, 40.0);
  EXPECT_NEAR(truth().pose_in_world.x - kStart.x, 1.0, 0.08);
  EXPECT_NEAR(truth().velocity, 0.0, 1e-6);
  EXPECT_NEAR(client.sonar().at(known.front), ahead - 1000.0, 150.0);
  client.turn_to(90);
  EXPECT_NEAR(client.th(), 90.0, 3.0);
  EXPECT_NEAR(degrees(truth().pose_in_world.th), 90.0, 7.0);

  client.disconnect();
  const auto cycles = truth().cycle;
  line_->wait(0.5);
  EXPECT_EQ(truth().cycle, cycles) << "packets after CLOSE";
  EXPECT_FALSE(client.lost());
  const std::string checked = ended();
  EXPECT_NE(checked.find("client: 1 x OPEN (1)"), std::string::npos) << checked;
  EXPECT_NE(checked.find("0 violations"), std::string::npos) << checked;
}

INSTANTIATE_TEST_SUITE_P(Robots, AriaInRealTime,
                         ::testing::Values(Case{"psos43m", Way::kTerminal},
                                           Case{"p3dx-sh", Way::kTcp}),
                         printable);

class PlayerInRealTime : public RealTime {};

TEST_P(PlayerInRealTime, ConnectsDrivesSeesAndStops) {
  PlayerClient client(*line_);
  ASSERT_EQ(client.connect(), "");
  EXPECT_FALSE(client.warned);
  ASSERT_TRUE(client.switch_on());
  const KnownRobot& known = *client.known();
  EXPECT_NEAR(client.ranges.at(known.front), 3000.0 - known.front_x, 150.0);
  ASSERT_TRUE(client.drive_a_metre());
  EXPECT_EQ(client.tainted, 0);
  EXPECT_NEAR(client.x / 1000.0, truth().pose_in_world.x - kStart.x, 0.06);
  EXPECT_NEAR(truth().velocity, 0.0, 1e-6);
  client.close();
  line_->wait(0.3);
  const std::string checked = ended();
  EXPECT_NE(checked.find("0 violations"), std::string::npos) << checked;
}

INSTANTIATE_TEST_SUITE_P(Robots, PlayerInRealTime, ::testing::Values(Case{"p2d8+", Way::kTerminal}),
                         printable);

class BeeInRealTime : public RealTime {};

TEST_P(BeeInRealTime, EveryPacketObeys) {
  BeeClient client(*line_, 2, 3);
  ASSERT_TRUE(client.connect());
  ASSERT_EQ(client.drive_a_metre(), "");
  EXPECT_NEAR(truth().pose_in_world.x - kStart.x, 1.0, 0.15);
  client.send(packet(Wire{2}));
  line_->wait(0.3);
  const std::string checked = ended();
  EXPECT_NE(checked.find("0 violations"), std::string::npos) << checked;
}

INSTANTIATE_TEST_SUITE_P(Robots, BeeInRealTime, ::testing::Values(Case{"pionat", Way::kLocal}),
                         printable);

}  // namespace
}  // namespace saphira::test
