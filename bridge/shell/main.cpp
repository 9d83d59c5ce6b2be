#include <cstdio>
#include <filesystem>
#include <optional>

#include "position_file.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/vision_setting.hpp"
#include "saphira/transport/address.hpp"
#include "shell.hpp"

namespace {

/// Reads the files that a robot's answer would need.
int check(const saphira::bridge::BridgeOptions& given) {
  const saphira::bridge::BridgeOptions options = saphira::bridge::checked(given);
  const std::string trouble =
      saphira::transport::line_trouble(saphira::transport::parse_address(options.robot_port));
  if (!trouble.empty())
    std::fprintf(stderr, "%s\n", trouble.c_str());
  const auto load = [](const std::string& path) {
    for (const std::string& warning : saphira::protocol::load_parameters(path).warnings)
      std::fprintf(stderr, "%s\n", warning.c_str());
  };
  for (const auto& file : std::filesystem::directory_iterator(options.robots_folder))
    if (file.path().extension() == ".p")
      load(file.path());
  const saphira::bridge::PositionFile position(options.state_file, saphira::Files::kStay);
  if (!position.trouble().empty())
    std::fprintf(stderr, "%s\n", position.trouble().c_str());
  if (!options.parameter_file.empty())
    load(options.parameter_file);
  return saphira::bus::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  saphira::bridge::BridgeOptions options;
  options.robots_folder = saphira::config_folder() + "/robots";
  double lease_ms = options.lease * 1000.0;
  std::optional<double> quiet_ms;
  bool no_guard = false;
  bool no_keeper = false;
  bool vision = false;
  std::vector<std::string> said;
  return saphira::bus::run_program(
      argc, argv, "bridge", "Connects one robot server to the bus and decides who drives it.",
      [&](saphira::CommandLine& app) {
        app.add_option(
            "--robot-port,--link", options.robot_port,
            "the robot: /dev/tty...[@baud], serial:/path, unix:/path, a path of either, "
            "tcp:host:port, or ros2:NAMESPACE,OPTION=VALUE... (options of saphira-ros2-base)");
        app.add_option("--robots", options.robots_folder, "folder of robot parameter files");
        app.add_option("--robot-file", options.parameter_file,
                       "parameter file of the robot, or the name of one in that folder (usual: the "
                       "one that is named after the subclass or class that the robot names)");
        app.add_option("--lease-ms", lease_ms, "a command drives for so long")
            .in_range(50.0, 2000.0);
        app.add_option("--quiet-ms", quiet_ms,
                       "after a person has driven, autonomy drives again when the person's program "
                       "has said for so long that it does not drive (usual: never, only when it is "
                       "handed back)")
            .in_range(0.0, 600000.0);
        app.add_flag("--no-guard", no_guard, "do not stop before obstacles");
        app.add_option("--guard-margin", options.guard_margin,
                       "m that the guard keeps before an obstacle ahead")
            .in_range(0.1, 1.0);
        app.add_option("--contact-speed", options.contact_speed,
                       "m/s at the most, up to 0.15, where a driver means contact; 0: never")
            .in_range(0.0, 0.15);
        app.add_option("--state", options.state_file,
                       "file that keeps the robot's position over a restart");
        app.add_flag("--free-step", options.free_step, "lockstep: step without a permit");
        app.add_flag("--no-keeper", no_keeper, "no second process that stops the robot");
        app.add_flag("--vision", vision,
                     "the robot has a Fast Track vision system: asks for boxes around its blobs "
                     "and publishes its packets");
        app.add_option("--vision-say", said,
                       "further words to it (manual 9.1), such as pioneer_a_color=orange for a "
                       "simulator's channel A")
            .needs(app.option("--vision"))
            .check([](const std::string& text) {
              try {
                saphira::protocol::parse_vision_setting(text);
                return std::string();
              } catch (const std::invalid_argument& error) {
                return std::string(error.what());
              }
            });
      },
      [&](const saphira::bus::NodeOptions& node, const saphira::bus::Stop& stop) {
        options.lease = lease_ms / 1000.0;
        if (quiet_ms)
          options.quiet = *quiet_ms / 1000.0;
        options.guard = !no_guard;
        options.keeper = !no_keeper;
        if (vision) {
          options.vision = {"pioneer_a_mode=2", "pioneer_b_mode=2", "pioneer_c_mode=2"};
          options.vision.insert(options.vision.end(), said.begin(), said.end());
        }
        if (node.dry_run)
          return check(options);
        return saphira::bridge::Shell(node, options).run(stop);
      });
}
