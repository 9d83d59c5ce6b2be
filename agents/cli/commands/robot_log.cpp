#include "robot_log.hpp"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/map_words.hpp"
#include "saphira/cli/words.hpp"
#include "saphira/logs/log_map.hpp"
#include "saphira/logs/virtual_sonar.hpp"
#include "saphira/maps/drawing.hpp"

namespace saphira::cli {

namespace {

struct RobotLogOptions {
  std::string log;
  std::string map;      ///< map: output file; evaluate: the map for localization
  std::string drawing;  ///< output picture; empty: none
  std::vector<double> start;
  std::string sonars = "pioneer";
  bool json = false;
};

logs::DataSet read(const RobotLogOptions& options) {
  const std::string name = std::filesystem::path(options.log).filename().string();
  logs::DataSet log = logs::load_data_set(name, options.log);
  std::fprintf(stderr, "%s: %zu scans, %.0f m by dead reckoning\n", name.c_str(), log.scans.size(),
               log.odometry.length());
  for (const std::string& note : log.notes)
    std::fprintf(stderr, "  %s\n", note.c_str());
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < std::min(log.damaged.size(), kShown); ++i)
    std::fprintf(stderr, "  %s\n", log.damaged[i].c_str());
  if (log.damaged.size() > kShown)
    std::fprintf(stderr, "  and %zu more damaged lines\n", log.damaged.size() - kShown);
  return log;
}

logs::LogMap map_log(const logs::DataSet& log, const bus::Stop& stop) {
  logs::LogMap mapped = logs::map_log(log, [&] { return !stop.requested(); });
  std::fprintf(stderr, "mapped: %zu walls, %zu loops closed, %zu of %zu scans unmatched\n",
               mapped.walls.features.size(), mapped.report.loops, mapped.report.unmatched,
               mapped.report.scans);
  return mapped;
}

void write(const std::string& path, const std::string& text) {
  if (!replace_file(path, text, true))
    throw UnusableFile(cannot_be(path, "written"));
  std::printf("written to %s\n", path.c_str());
}

std::vector<Vec2> points(const std::vector<logs::StampedPose>& poses) {
  constexpr double kSpacing = 0.15;  // [m]
  std::vector<Vec2> result;
  for (const logs::StampedPose& at : poses)
    if (result.empty() || (at.pose.position() - result.back()).norm() > kSpacing)
      result.push_back(at.pose.position());
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
  const logs::LogMap mapped = map_log(log, stop);
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

void tell(const char* what, const logs::Accuracy& accuracy) {
  if (accuracy.compared < 2)
    std::printf("%-16s no pose to compare\n", what);
  else
    std::printf("%-16s %.3f m off (rms), %.1f %% within %.1f m; %.3f m and %.2f degrees per 10 m\n",
                what, accuracy.ate, 100.0 * accuracy.within, logs::kWithin, accuracy.drift,
                degrees(accuracy.drift_heading));
}

int evaluate(const RobotLogOptions& options, const bus::Stop& stop) {
  const logs::DataSet log = read(options);
  const std::optional<maps::Map> map =
      options.map.empty() ? std::nullopt : std::optional(maps::load_map(options.map));
  const logs::LogMap mapped = map_log(log, stop);
  std::optional<Pose> start;
  if (!options.start.empty())
    start = Pose{options.start[0], options.start[1], options.start[2]};
  else if (!map)
    start = mapped.poses.front().pose;
  const logs::LogEvaluation result = logs::evaluate_log(
      log, mapped, options.sonars == "b21" ? logs::front_of_b21() : logs::pioneer_sonars(),
      map ? *map : mapped.walls, start);
  const logs::SonarRun& run = result.run;
  const auto share = [&](std::size_t steps) {
    return static_cast<double>(steps) / static_cast<double>(std::max<std::size_t>(1, run.steps));
  };
  if (options.json) {
    nlohmann::json out{{"scans", log.scans.size()},
                       {"way_m", log.odometry.length()},
                       {"walls", mapped.walls.features.size()},
                       {"reckoned_ate_m", result.dead_reckoning.ate},
                       {"tracking", share(run.tracked.size())},
                       {"lost", share(run.lost)},
                       {"unplaced", share(run.unplaced)},
                       {"matches", run.accepted}};
    // Without a pose, or with one of dead reckoning alone, the error is null.
    const logs::Accuracy& at = result.localized;
    const auto known = [&](double value) {
      return at.compared < 2 || run.accepted == 0 ? nlohmann::json() : nlohmann::json(value);
    };
    out["ate_m"] = known(at.ate);
    out["within_half_a_metre"] = known(at.within);
    out["tracking_within_half_a_metre"] = known(result.tracked.within);
    out["per_10m_m"] = known(at.drift);
    out["per_10m_deg"] = known(degrees(at.drift_heading));
    std::cout << out.dump() << '\n';
    return bus::kExitOk;
  }
  std::printf("against where the laser says that the robot was:\n");
  tell("dead reckoning", result.dead_reckoning);
  if (run.accepted == 0) {
    std::printf("%-16s no reading was matched with the map: its pose is that of dead reckoning\n",
                "by sonars");
    return bus::kExitOk;
  }
  tell("by sonars", result.localized);
  std::printf(
      "%-16s sure of its pose in %.1f %% of the steps, and then within %.1f m of the laser in %.1f "
      "%%; lost in %.1f %%, without a pose in %.1f %%; %zu matches\n",
      "by its own word", 100.0 * share(run.tracked.size()), logs::kWithin,
      100.0 * result.tracked.within, 100.0 * share(run.lost), 100.0 * share(run.unplaced),
      run.accepted);
  return bus::kExitOk;
}

using Command = int (*)(const RobotLogOptions&, const bus::Stop&);

CLI::App* add(CLI::App& log, Chosen& chosen, const char* name, const char* what, Command run,
              const std::shared_ptr<RobotLogOptions>& options) {
  CLI::App* command = log.add_subcommand(name, what);
  command->fallthrough();
  command->add_option("log", options->log, "the log in CARMEN's format, packed (.gz) or not")
      ->required()
      ->check(CLI::ExistingFile);
  chosen.when(command, [options, run](const bus::NodeOptions&, const bus::Stop& stop) {
    return run(*options, stop);
  });
  return command;
}

}  // namespace

void add_robot_log(CLI::App& log, Chosen& chosen) {
  auto options = std::make_shared<RobotLogOptions>();
  CLI::App* command =
      add(log, chosen, "map", "Draws a map from the laser scans of a robot's log", map, options);
  command->add_option("map", options->map, "the map file to write")->required();
  command->add_option("--drawing", options->drawing, "draws the map and the way into this file")
      ->type_name("FILE.svg");

  options = std::make_shared<RobotLogOptions>();
  command = add(log, chosen, "evaluate",
                "Localizes the robot of a log by what its sonars would have heard, and compares "
                "that with its laser",
                evaluate, options);
  command->add_option("--map", options->map, "on this map; else on the one that the log gives")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--start", options->start,
                   "where the robot is at first: x y th [m, rad] on the map; without it the robot "
                   "finds its place on a map that was given")
      ->expected(3)
      ->check(number_that("a finite number", [](double) { return true; }));
  command->add_option("--sonars", options->sonars, "whose sonars")
      ->check(CLI::IsMember({"pioneer", "b21"}))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object");
}

}  // namespace saphira::cli
