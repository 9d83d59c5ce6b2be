// The stopping time and distance of each robot model in the simulator after the loss of its driver,
// its bridge or its line (a silent cut), or an emergency stop. The simulator's trace is the truth.

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "bench.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/parameters.hpp"
#include "scene.hpp"
#include "serial_line.hpp"
#include "stop_ways.hpp"
#include "support/guarded.hpp"

using namespace saphira;

namespace {

constexpr const char* kDomain = "196";
constexpr double kStill = 0.003;  // [m/s]
constexpr std::chrono::seconds kLimit{60};

enum class Loss { driver, bridge, line, estop };
constexpr std::array kLosses{Loss::driver, Loss::bridge, Loss::line, Loss::estop};
constexpr std::array kNames{"driver", "bridge", "line", "estop"};

struct Roll {
  double velocity = 0.0;  ///< [m/s] before
  double time = 0.0;      ///< [s]
  double way = 0.0;       ///< [m]
};

/// A robot, its serial line, a bridge and a driver.
class Ride {
 public:
  Ride(const std::string& robot_file, double velocity) {
    scene_.world = "width 100000 height 20000\nposition 2000 10000 0\n";
    scene_.robot_file = std::filesystem::absolute(robot_file);
    scene_.bridge_options = {"--robot-file", robot_file};
    scene_.robot_port = "serial:" + scene_.folder.path("tty") + "@38400";
    scene_.command.translation = v1::TRANSLATION_VELOCITY;
    scene_.command.velocity = velocity;
    scene_.start_simulator();
    line_.emplace(scene_.folder.path("tty"), scene_.folder.path("robot"), 38400);
    scene_.start_bridge();
  }

  Roll lose(Loss loss) {
    scene_.drives = true;
    std::vector<sim::TraceRow> before;
    // The guard slows a robot that cannot hear people in time: the speed is the grant's.
    need(scene_.until(
             [&] {
               const v1::Grant& grant = scene_.grant;
               if (grant.role != v1::ROLE_DIRECT || grant.velocity <= 0.0)
                 return false;
               before = scene_.whole_trace();
               return !before.empty() && before.back().velocity >= 0.97 * grant.velocity;
             },
             kLimit),
         "it does not drive");
    if (loss == Loss::driver)
      scene_.drives = false;
    else if (loss == Loss::bridge)
      scene_.bridge->signal(SIGKILL);
    else if (loss == Loss::line)
      line_->cut(true);
    std::vector<sim::TraceRow> all;
    need(scene_.until(
             [&] {
               if (loss == Loss::estop) {
                 ++scene_.command.number;
                 button_.write(scene_.command);
               }
               all = scene_.whole_trace();
               return std::abs(all.back().velocity) <= kStill;
             },
             kLimit),
         "it does not stop");
    // By rows, one a cycle: the cycle numbers restart with each connection.
    const std::size_t lost = before.size() - 1;
    std::size_t still = lost;
    while (still + 1 < all.size() && std::abs(all[still].velocity) > kStill)
      ++still;
    // The starting conditions again.
    scene_.grant = {};
    scene_.drives = false;
    line_->cut(false);
    if (loss == Loss::bridge)
      scene_.start_bridge();
    return {before.back().velocity, static_cast<double>(still - lost) * kCycle,
            (all[still].pose_in_world.position() - all[lost].pose_in_world.position()).norm()};
  }

 private:
  void need(bool done, const std::string& what) const {
    if (!done)
      throw std::runtime_error(scene_.robot_file + ": " + what);
  }

  test::Scene scene_;
  bus::Writer<v1::MotorCommand> button_ = scene_.node.writer(bus::topics::kDriveEstop);
  std::optional<test::SerialLine> line_;
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
