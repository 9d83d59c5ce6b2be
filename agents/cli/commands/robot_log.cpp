#include "robot_log.hpp"

#include <cstdio>
#include <filesystem>

#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/map_words.hpp"
#include "saphira/cli/words.hpp"
#include "saphira/logs/log_map.hpp"
#include "saphira/maps/drawing.hpp"

namespace saphira::cli {

namespace {

struct RobotLogOptions {
  std::string log;
  std::string map;      ///< output file
  std::string drawing;  ///< output picture; empty: none
};

logs::DataSet read(const RobotLogOptions& options) {
  const std::string name = std::filesystem::path(options.log).filename().string();
  logs::DataSet log = logs::load_data_set(name, options.log);
  std::fprintf(stderr, "%s: %zu scans, %.0f m by dead reckoning\n", name.c_str(), log.scans.size(),
               log.way());
  for (const std::string& note : log.notes)
    std::fprintf(stderr, "  %s\n", note.c_str());
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < std::min(log.damaged.size(), kShown); ++i)
    std::fprintf(stderr, "  %s\n", log.damaged[i].c_str());
  if (log.damaged.size() > kShown)
    std::fprintf(stderr, "  and %zu more damaged lines\n", log.damaged.size() - kShown);
  return log;
}

void write(const std::string& path, const std::string& text) {
  if (!replace_file(path, text, true))
    throw UnusableFile(cannot_be(path, "written"));
  std::printf("written to %s\n", path.c_str());
}

std::vector<Vec2> points(const std::vector<Pose>& poses) {
  constexpr double kSpacing = 0.15;  // [m]
  std::vector<Vec2> result;
  for (const Pose& pose : poses)
    if (result.empty() || (pose.position() - result.back()).norm() > kSpacing)
      result.push_back(pose.position());
  return result;
}

int map(const RobotLogOptions& options, const bus::Stop& stop) {
  // Tried before the work of minutes.
  if (!options.drawing.empty())
    expect_ending(options.drawing, ".svg");
  for (const std::string& path : {options.map, options.drawing}) {
    if (!path.empty() && !can_replace_file(path))
      throw UnusableFile(cannot_be(path, "written"));
    std::error_code none;
    if (std::filesystem::equivalent(options.log, path, none))
      throw UnusableFile(path + ": this is the log itself; expected another file to write");
  }
  const logs::DataSet log = read(options);
  const logs::LogMap mapped = logs::map_log(log, [&] { return !stop.requested(); });
  std::fprintf(stderr, "mapped: %zu walls, %zu loops closed, %zu of %zu scans unmatched\n",
               mapped.walls.features.size(), mapped.report.loops, mapped.report.unmatched,
               mapped.report.scans);
  if (mapped.walls.features.empty()) {
    std::fprintf(stderr, "saphira: %s: no wall was found; nothing is written\n",
                 options.log.c_str());
    return bus::kExitFailed;
  }
  write(options.map, maps::to_text(mapped.walls));
  if (options.drawing.empty())
    return bus::kExitOk;
  maps::Drawing drawing;
  drawing.title = log.name;
  drawing.map = mapped.walls;
  drawing.trajectories.push_back({"by the laser", points(mapped.poses)});
  write(options.drawing, maps::to_svg(drawing));
  return bus::kExitOk;
}

}  // namespace

void add_robot_log(CLI::App& log, Chosen& chosen) {
  auto options = std::make_shared<RobotLogOptions>();
  CLI::App* command =
      log.add_subcommand("map", "Draws a map from the laser scans of a robot's log");
  command->fallthrough();
  command->add_option("log", options->log, "the log in CARMEN's format, packed (.gz) or not")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("map", options->map, "the map file to write")->required();
  command->add_option("--drawing", options->drawing, "draws the map and the way into this file")
      ->type_name("FILE.svg");
  chosen.when(command, [options](const bus::NodeOptions&, const bus::Stop& stop) {
    return map(*options, stop);
  });
}

}  // namespace saphira::cli
