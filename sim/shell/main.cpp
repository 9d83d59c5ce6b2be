// saphira-sim: a simulated robot behind a local socket or a TCP port.

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/log_line.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/stop_signals.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/host.hpp"
#include "saphira/sim/trace.hpp"
#include "saphira/sim/world.hpp"

namespace {

bool is_rate(const std::string& text) {
  const auto rate = saphira::number_in<double>(text);
  return rate && *rate >= 1e-6 && *rate <= 1000.0;
}

saphira::Pose parse_position(const std::string& text) {
  const auto lines = saphira::split_lines(text);
  if (lines.size() != 1)
    throw std::invalid_argument("--position: expected \"x y th\" in mm, mm, degrees");
  saphira::LineReader in("--position", lines.front());
  const double x = in.number("x in mm") / 1000.0;
  const double y = in.number("y in mm") / 1000.0;
  const double th = saphira::radians(in.number("th in degrees"));
  in.expect_end();
  return {x, y, saphira::norm2_angle(th)};
}

/// Sets the first robot and the others; a robot without a file of its own gets the last file before
/// it.
void set_robots(saphira::sim::HostOptions& options, const std::vector<std::string>& files,
                const std::vector<std::string>& positions, std::size_t count) {
  const std::size_t robots = std::max({files.size(), positions.size(), count});
  options.robot = files.front();
  for (std::size_t i = 0; i < robots; ++i) {
    std::optional<saphira::Pose> position;
    if (i < positions.size())
      position = parse_position(positions[i]);
    if (i == 0)
      options.position = position;
    else
      options.more.push_back({files[std::min(i, files.size() - 1)], position});
  }
}

void plot(const std::vector<std::string>& files, const saphira::sim::HostOptions& options) {
  const auto world = saphira::sim::load_world(options.world, options.things);
  const auto robot = saphira::protocol::load_parameters(options.robot);
  const auto trace = saphira::sim::parse_trace(saphira::read_file(files[0]), files[0]);
  std::ofstream out(files[1], std::ios::binary);
  out << saphira::sim::plot_svg(world, trace, robot.radius) << std::flush;
  if (!out)
    throw saphira::UnusableFile(saphira::cannot_be(files[1], "written"));
}

}  // namespace

int main(int argc, char** argv) {
  saphira::CommandLine app{"A simulated robot: a robot server as the Saphira manual describes it"};
  saphira::sim::HostOptions options;
  std::vector<std::string> robots;
  std::vector<std::string> positions;
  std::size_t count = 1;
  std::string rate = "1";
  std::vector<std::string> plot_files;
  options.world = "office";
  app.add_option("--world", options.world, "World file, or the name of one that is shipped");
  app.add_option("--things", options.things,
                 "File of the same form with what stands and walks in that world besides: people, "
                 "doors, boxes, posts")
      .existing_file();
  app.add_option("--robot,--robot-file", robots,
                 "Robot parameter file, or the name of one that is shipped (default: pioneer); "
                 "again for each further robot, which listens on the next port, or on the socket "
                 "with \"-2\" (\"-3\"...) behind it")
      .one_value_each();
  app.add_option("--robots", count, "How many robots; those without a file are as the last one")
      .in_range(1, 1000);
  const saphira::Option socket =
      app.add_option("--socket", options.socket,
                     "Local socket to listen on (default: $ROBOT_SOCKET, otherwise "
                     "/tmp/saphira-robot-<uid>)");
  const saphira::Option tcp =
      app.add_option("--tcp", options.tcp, "TCP port to listen on instead; 0: a free one")
          .excludes(socket);
  std::string terminal;
  const saphira::Option pty =
      app.add_option("--pty", terminal,
                     "A pseudo-terminal to talk on instead, as on a serial line: a symbolic "
                     "link to it is put at this path (default: " +
                         saphira::sim::default_terminal() + ")")
          .values(0, 1)
          .placeholder("PATH")
          .excludes(socket)
          .excludes(tcp);
  app.add_option("--tcp-address", options.tcp_address,
                 "Address of the TCP port; anybody who reaches it can drive the robot");
  app.add_option("--seed", options.seed, "Seed of all that is random");
  app.add_flag("--step", options.step, "Single-step from the start: time passes by command 64");
  app.add_option("--rate", rate, "Times real time; max: as fast as the clients answer")
      .check([](const std::string& text) {
        return text == "max" || is_rate(text)
                   ? std::string()
                   : "expected a number from 1e-6 to 1000, or max, found " + text;
      });
  app.add_option("--trace", options.trace, "File for the true state of every cycle, CSV");
  app.add_option("--check", options.check,
                 "File to which is appended what of the conversation is against the protocol's "
                 "tables (default: $SAPHIRA_CHECK; none)");
  app.add_option("--stereo", options.stereo,
                 "Folder for what the robot's stereo cameras see: a PGM each cycle, the left "
                 "picture beside the right one");
  app.add_option("--stereo-socket", options.stereo_socket,
                 "Local socket that sends the same pictures to whoever connects");
  app.add_option("--camera-socket", options.camera_socket,
                 "Local socket that sends pictures in colour, for saphira-camera");
  app.add_option(
      "--view-socket", options.view_socket,
      "Local socket of the simulator's own view: what is true, and what people do to it");
  app.add_option("--resume", options.state,
                 "File for the places of all that moves: a simulator that is ended, and started "
                 "again with it, goes on there");
  app.add_option("--position", positions,
                 "Start as \"x y th\" [mm mm deg] in the world, instead of the world file's; again "
                 "for each further robot")
      .one_value_each();
  bool dry_run = false;
  app.add_flag("--dry-run", dry_run, "Check the files, report errors, and end");
  app.add_option("--plot", plot_files, "Draw a trace into a picture (SVG), and end")
      .values(2)
      .placeholder("TRACE.csv OUT.svg");
  if (const auto code = app.parse(argc, argv))
    return *code;

  return saphira::exit_code_of("saphira-sim", [&] {
    if (robots.empty())
      robots.emplace_back("pioneer");
    const std::string config = saphira::config_folder();
    for (std::string& file : robots)
      file = saphira::find_file(config + "/robots", file, ".p");
    options.world = saphira::find_file(config + "/worlds", options.world, ".wld");
    if (pty.given())
      options.terminal = terminal.empty() ? saphira::sim::default_terminal() : terminal;
    set_robots(options, robots, positions, count);
    saphira::sim::offer_files(options, config);
    options.rate = rate == "max" ? saphira::sim::kMaxRate : std::stod(rate);
    if (!plot_files.empty()) {
      plot(plot_files, options);
      return saphira::kExitOk;
    }
    options.log = [](std::string_view level, const std::string& text) {
      const std::string line = saphira::log_line(saphira::unix_time(), level, "sim", text);
      std::fprintf(stderr, "%s\n", line.c_str());
    };
    if (dry_run) {
      options.log = [](std::string_view level, const std::string& text) {
        if (level == "warning")
          std::fprintf(stderr, "%s\n", text.c_str());
      };
      saphira::sim::check(options);
      return saphira::kExitOk;
    }
    saphira::sim::run(options, saphira::stop_on_signals());
    return saphira::kExitOk;
  });
}
