// The stopping time and distance of each robot model in the simulator after the loss of its driver,
// its bridge or its line (a silent cut), or an emergency stop. The simulator's trace is the truth.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "bench.hpp"
#include "node_options.hpp"
#include "process.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/trace.hpp"
#include "serial_line.hpp"
#include "stop_ways.hpp"
#include "support/guarded.hpp"

using namespace saphira;
using std::chrono::milliseconds;

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kDomain = "196";
constexpr double kStill = 0.003;  // [m/s]
constexpr double kCycle = 0.1;    // [s]
constexpr milliseconds kLimit{60000};

enum class Loss { driver, bridge, line, estop };
constexpr std::array kLosses{Loss::driver, Loss::bridge, Loss::line, Loss::estop};
constexpr std::array kNames{"driver", "bridge", "line", "estop"};

struct Roll {
  double velocity = 0.0;  ///< [m/s] before
  double time = 0.0;      ///< [s]
  double way = 0.0;       ///< [m]
};

/// A robot, its line, a bridge and a driver.
class Ride {
 public:
  Ride(std::string robot_file, double velocity)
      : robot_file_(std::move(robot_file)), velocity_(velocity) {
    std::ofstream(folder_.path("floor.wld"))
        << "width 100000 height 20000\nposition 2000 10000 0\n";
    simulator_ = std::make_unique<bench::Child>(std::vector<std::string>{
        "saphira-sim", "--world", folder_.path("floor.wld"), "--robot", robot_file_, "--socket",
        folder_.path("robot"), "--trace", folder_.path("trace.csv")});
    line_ = std::make_unique<test::SerialLine>(folder_.path("tty"), folder_.path("robot"), 38400);
    start_bridge();
  }

  Roll lose(Loss loss) {
    drive_ = true;
    need(until([&] { return permitted() && newest().velocity >= 0.97 * *permitted(); }),
         "it does not drive");
    const std::vector<sim::TraceRow> before = rows();
    if (loss == Loss::driver)
      drive_ = false;
    else if (loss == Loss::bridge)
      ::kill(bridge_->pid(), SIGKILL);
    else if (loss == Loss::line)
      line_->cut(true);
    else
      pressed_ = true;
    need(until([&] { return std::abs(newest().velocity) <= kStill; }), "it does not stop");
    // By rows, one a cycle: the cycle numbers restart with each connection.
    const std::vector<sim::TraceRow> all = rows();
    const std::size_t lost = before.size() - 1;
    std::size_t still = lost;
    while (still + 1 < all.size() && std::abs(all[still].velocity) > kStill)
      ++still;
    const Roll roll{
        before.back().velocity, static_cast<double>(still - lost) * kCycle,
        (all[still].pose_in_world.position() - all[lost].pose_in_world.position()).norm()};
    // Restores the starting conditions.
    grant_.reset();
    drive_ = false;
    pressed_ = false;
    line_->cut(false);
    if (loss == Loss::bridge)
      start_bridge();
    return roll;
  }

 private:
  void start_bridge() {
    bridge_.reset();
    bridge_ = std::make_unique<bench::Child>(std::vector<std::string>{
        "saphira-bridge", "--robot", robot_, "--domain", kDomain, "--robot-file", robot_file_,
        "--robot-port", "serial:" + folder_.path("tty") + "@38400"});
  }

  /// [m/s] The speed in the driver's grant: the guard slows a robot that cannot hear people in
  /// time.
  std::optional<double> permitted() const {
    return grant_ && grant_->role == v1::ROLE_DIRECT && grant_->velocity > 0.0
               ? std::optional(grant_->velocity)
               : std::nullopt;
  }

  std::vector<sim::TraceRow> rows() const {
    if (!std::filesystem::exists(folder_.path("trace.csv")))
      return {};
    return sim::parse_trace(read_file(folder_.path("trace.csv")), "trace.csv");
  }
  sim::TraceRow newest() const {
    const auto all = rows();
    return all.empty() ? sim::TraceRow{} : all.back();
  }

  bool until(const std::function<bool()>& condition) {
    const auto end = Clock::now() + kLimit;
    while (Clock::now() < end) {
      node_.wait(milliseconds(25));
      if (const auto state = states_.take_newest())
        state_ = *state;
      if (auto grant = grants_.take_newest())
        grant_ = std::move(grant);
      if (drive_)
        write(driver_, true);
      if (pressed_)
        write(button_, true);
      if (condition())
        return true;
    }
    return false;
  }

  void write(bus::Writer<v1::MotorCommand>& writer, bool active) {
    v1::MotorCommand command{.stamp = state_.stamp, .source = "bench"};
    command.number = ++number_;
    command.active = active;
    command.translation = v1::TRANSLATION_VELOCITY;
    command.velocity = velocity_;
    writer.write(command);
  }

  void need(bool done, const std::string& what) const {
    if (!done)
      throw std::runtime_error(robot_file_ + ": " + what);
  }

  std::string robot_file_;
  double velocity_;
  std::string robot_ = "stops" + std::to_string(getpid());
  test::TempDir folder_;
  bus::Node node_{test::node_options("bench", robot_, kDomain)};
  bus::Writer<v1::MotorCommand> driver_ = node_.writer(bus::topics::kDriveDirect);
  bus::Writer<v1::MotorCommand> button_ = node_.writer(bus::topics::kDriveEstop);
  bus::Reader<v1::RobotState> states_ = node_.reader(bus::topics::kRobotState);
  bus::Reader<v1::Grant> grants_ = node_.reader(bus::topics::kGrant);
  std::unique_ptr<bench::Child> simulator_;
  std::unique_ptr<test::SerialLine> line_;
  std::unique_ptr<bench::Child> bridge_;
  v1::RobotState state_;
  std::optional<v1::Grant> grant_;
  bool drive_ = false;
  bool pressed_ = false;
  std::uint64_t number_ = 0;
};

nlohmann::json measure(const std::string& file, double wanted) {
  const protocol::RobotParameters robot = protocol::load_parameters(file);
  const double velocity = std::min(wanted, robot.max_velocity);
  Ride ride(file, velocity);
  nlohmann::json out{{"robot", std::filesystem::path(file).stem().string()}};
  std::printf("%-14s", out["robot"].get<std::string>().c_str());
  for (const Loss loss : kLosses) {
    const Roll roll = ride.lose(loss);
    if (!out.contains("velocity_m_s")) {
      out["velocity_m_s"] = roll.velocity;
      std::printf(" %4.2f m/s", roll.velocity);
    }
    const char* const name = kNames.at(static_cast<std::size_t>(loss));
    out[name] = {{"s", roll.time}, {"m", roll.way}};
    std::printf("   %s %.1f s %.2f m", name, roll.time, roll.way);
    std::fflush(stdout);
  }
  std::printf("\n");
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{
      "All ways to stop the robot times all ways to move it; and how far each robot rolls "
      "when its driver, its bridge or its line is lost"};
  bool json = false;
  double velocity = 0.4;
  std::vector<std::string> names;
  app.add_flag("--json", json, "one JSON object on the last line");
  bool ways = false;
  app.add_flag("--ways", ways, "only the ways to stop, with a Pioneer 1");
  app.add_option("--velocity", velocity, "[m/s], or the robot's own limit").in_range(0.05, 2.0);
  app.add_option("robots", names, "names of config/robots, or files (usual: all)");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] {
    const std::string folder = config_folder() + "/robots";
    nlohmann::json result = nlohmann::json::object();
    setenv("SAPHIRA_DOMAIN", kDomain, 1);
    setenv("SAPHIRA_SOURCE_DIR", (config_folder() + "/..").c_str(), 0);
    if (names.empty())
      result = bench::stop_ways();
    if (names.empty() && !ways)
      names = names_in(folder, ".p");
    nlohmann::json robots = nlohmann::json::array();
    double worst[kLosses.size()] = {};
    for (const std::string& name : names) {
      robots.push_back(measure(find_file(folder, name, ".p"), velocity));
      for (std::size_t i = 0; i < kLosses.size(); ++i)
        worst[i] = std::max(worst[i], robots.back().at(kNames.at(i)).at("m").get<double>());
    }
    if (json) {
      result["robots"] = robots;
      for (std::size_t i = 0; i < kLosses.size(); ++i)
        result[std::string(kNames.at(i)) + "_m_max"] = worst[i];
      bench::print(result, true);
    }
    return 0;
  });
}
