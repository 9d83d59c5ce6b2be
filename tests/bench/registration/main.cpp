// The poses of robots, from their logs: dead reckoning and registration compared with published
// figures.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "corridor.hpp"
#include "percept_report.hpp"
#include "report.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/logs/data_set.hpp"
#include "saphira/logs/laser_map.hpp"
#include "saphira/logs/scan_mapping.hpp"
#include "saphira/maps/drawing.hpp"
#include "simulated.hpp"
#include "support/quantile.hpp"
#include "synthetic.hpp"

using namespace saphira;
using namespace saphira::bench;
using namespace saphira::logs;
using saphira::test::quantile;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uint64_t kSeed = 1;

// Kümmerle et al. 2009, absolute translational error of the relations [m].
struct Published {
  const char* data;
  const char* method;
  double mean;
  double deviation;
};
constexpr Published kPublished[] = {
    {"aces", "scan matching", 0.173, 0.614},
    {"aces", "GMapping, 50 particles", 0.060, 0.049},
    {"aces", "graph mapping", 0.044, 0.044},
    {"intel", "scan matching", 0.220, 0.296},
    {"intel", "GMapping, 50 particles", 0.070, 0.083},
    {"intel", "graph mapping", 0.031, 0.026},
    {"killian", "scan matching", 1.651, 4.138},
    {"killian", "GMapping, 50 particles", 0.122, 0.386},
    {"killian", "graph mapping", 0.050, 0.056},
    {"csail", "scan matching", 0.106, 0.325},
    {"csail", "GMapping, 50 particles", 0.049, 0.049},
    {"csail", "graph mapping", 0.004, 0.009},
    {"fr079", "scan matching", 0.258, 0.427},
    {"fr079", "GMapping, 50 particles", 0.061, 0.044},
    {"fr079", "graph mapping", 0.056, 0.042},
    {"hospital", "scan matching", 0.434, 1.615},
    {"hospital", "GMapping, 50 particles", 0.637, 2.638},
    {"hospital", "graph mapping", 0.143, 0.180},
};

json evaluate(const DataSet& set, const Trajectory& estimate, const std::string& what,
              Report& report) {
  json out;
  std::vector<std::string> cells(5);
  const auto relations = [&](const std::vector<Relation>& which, const std::string& name,
                             std::size_t cell) {
    if (which.empty())
      return;
    const RelationErrors e = relation_errors(estimate, which);
    out[name] = {{"translation_m", e.translation.mean},
                 {"translation_deviation_m", e.translation.deviation},
                 {"translation_median_m", e.translation.median},
                 {"translation_squared_m2", e.translation.squared},
                 {"translation_max_m", e.translation.most},
                 {"rotation_deg", degrees(e.rotation.mean)},
                 {"rotation_deviation_deg", degrees(e.rotation.deviation)},
                 {"count", e.translation.count},
                 {"missing", e.missing}};
    cells[cell] = format("%.3f +- %.3f (%zu)", e.translation.mean, e.translation.deviation,
                         e.translation.count);
    if (cell == 0)
      cells[1] = format("%.2f +- %.2f", degrees(e.rotation.mean), degrees(e.rotation.deviation));
  };
  relations(set.relations, "relations", 0);
  if (set.exact_relations.size() != set.relations.size())
    relations(set.exact_relations, "relations_exact", 2);
  if (set.reference) {
    const Pairs pairs = pair_up(estimate, *set.reference);
    const DriftErrors d = drift(pairs, 10.0);
    out["ate_rmse_m"] = ate_rmse(pairs);
    out["per_10m_m"] = d.translation.median;
    out["per_10m_deg"] = degrees(d.rotation.median);
    cells[3] = format("%.3f", ate_rmse(pairs));
    cells[4] = format("%.3f m, %.2f deg", d.translation.median, degrees(d.rotation.median));
  }
  report.row(what, cells);
  return out;
}

std::vector<Vec2> points_of(const std::vector<StampedPose>& poses, const Pose& align) {
  constexpr double kSpacing = 0.15;  // [m] more detail only enlarges the file
  std::vector<Vec2> out;
  for (const StampedPose& p : poses) {
    const Vec2 at = transform(align, p.pose.position());
    if (out.empty() || (at - out.back()).norm() > kSpacing)
      out.push_back(at);
  }
  return out;
}

std::vector<StampedPose> stamped(const std::vector<double>& times, const std::vector<Pose>& poses) {
  std::vector<StampedPose> out;
  for (std::size_t i = 0; i < poses.size(); ++i)
    out.push_back({times[i], poses[i]});
  return out;
}

json sonar_json(const DataSet& set, const SonarRun& run, const std::string& what, Report& report) {
  // The estimates at the time, without later corrections.
  json out = evaluate(set, Trajectory(run.poses), what, report);
  const double steps = static_cast<double>(std::max<std::size_t>(run.steps, 1));
  out["tracking"] = static_cast<double>(run.tracking) / steps;
  out["lost"] = static_cast<double>(run.lost) / steps;
  out["unplaced"] = static_cast<double>(run.unplaced) / steps;
  out["matches"] = run.accepted;
  out["step_ms_p50"] = quantile(run.step_ms, 0.5);
  out["step_ms_p99"] = quantile(run.step_ms, 0.99);
  report.note(
      what + format(": tracking %.1f %%, lost %.1f %% of the steps, %zu matches, %zu walls and %zu "
                    "openings seen; a step %.2f ms, p99 %.2f ms",
                    100.0 * static_cast<double>(run.tracking) / steps,
                    100.0 * static_cast<double>(run.lost) / steps, run.accepted, run.walls,
                    run.openings, quantile(run.step_ms, 0.5), quantile(run.step_ms, 0.99)));
  return out;
}

// Pictures of a drive: its way, and its percepts.
struct Pictures {
  maps::Drawing ways;
  maps::Drawing percepts;
};

json measure(const DataSet& set, const std::string& log_folder, Report& report,
             Pictures& pictures) {
  json out;
  report.heading(set.name + format(": %zu scans, %.0f m by dead reckoning", set.scans.size(),
                                   set.odometry.length()));
  report.columns({"relations, m", "deg", "relations with exact stamps, m", "ATE, m", "per 10 m"});
  if (set.mended > 0)
    report.note(
        format("%zu stamps of scans were interpolated in the log and are mended", set.mended));
  for (const std::string& note : set.notes)
    report.note(note);
  for (std::size_t i = 0; i < std::min<std::size_t>(set.damaged.size(), 3); ++i)
    report.note(set.damaged[i]);
  if (set.damaged.size() > 3)
    report.note(format("and %zu more such lines", set.damaged.size() - 3));
  out["dead_reckoning"] = evaluate(set, set.odometry, "dead reckoning", report);
  for (const Published& p : kPublished)
    if (set.name.find(p.data) != std::string::npos)
      report.row(std::string(p.method) + " (published)",
                 {format("%.3f +- %.3f", p.mean, p.deviation), "", "", "", ""});
  if (set.reference && !set.relations.empty())
    out["corrected_file"] =
        evaluate(set, densify(*set.reference, set.odometry), "the corrected file's scans", report);

  logs::ScanMapper mapper;
  std::vector<double> step_ms;
  std::vector<StampedPose> live;
  const double start = cpu_seconds();
  for (std::size_t i = 0; i < set.scans.size(); ++i) {
    const double before = cpu_seconds();
    live.push_back({set.times[i], mapper.add(set.poses_in_odom[i], set.scans[i])});
    step_ms.push_back(1e3 * (cpu_seconds() - before));
  }
  const double drove = cpu_seconds();
  out["full_ranges_live"] = evaluate(set, densify(Trajectory(std::move(live)), set.odometry),
                                     "full ranges, believed at the time", report);
  out["full_ranges_graph"] =
      evaluate(set, densify(Trajectory(stamped(set.times, mapper.trajectory())), set.odometry),
               "full ranges, graph at the end", report);
  const double refining = cpu_seconds();
  mapper.refine(2);
  const double refined = cpu_seconds();
  const std::vector<StampedPose> full = stamped(set.times, mapper.trajectory());
  out["full_ranges"] =
      evaluate(set, densify(Trajectory(full), set.odometry), "full ranges, refined", report);
  const auto& r = mapper.report();
  report.note(format(
      "%zu nodes, %zu wide searches, %zu scans unmatched, %zu loop closures; %.1f s of CPU, a "
      "scan %.1f ms, p99 %.0f ms; refining %.1f s",
      r.nodes, r.searches, r.unmatched, r.loops, drove - start, quantile(step_ms, 0.5),
      quantile(step_ms, 0.99), refined - refining));
  out["full_ranges"]["cpu_s"] = drove - start;
  out["full_ranges"]["refine_cpu_s"] = refined - refining;
  out["full_ranges"]["scan_ms_p50"] = quantile(step_ms, 0.5);
  out["full_ranges"]["scan_ms_p99"] = quantile(step_ms, 0.99);
  out["full_ranges"]["loops"] = r.loops;
  out["full_ranges"]["unmatched"] = r.unmatched;
  if (set.ranges_only)
    return out;

  // Sonar-like ranges, on the walls from the full ranges.
  const maps::Map walls = walls_of(mapper.node_scans(), mapper.nodes());
  report.note(format("%zu walls drawn from the full ranges", walls.features.size()));
  SonarDrive heard = virtual_drive(set, pioneer_sonars());
  const SonarRun by_sonar = register_sonars(heard, walls, full.front().pose);
  out["sonar_like"] = sonar_json(set, by_sonar, "7 virtual sonars, walls known", report);
  const SonarDrive heard_by_more = virtual_drive(set, front_of_b21());
  out["sonar_like_13"] = sonar_json(set, register_sonars(heard_by_more, walls, full.front().pose),
                                    "13 virtual sonars, walls known", report);
  const SonarRun mapped = map_sonars(heard, full.front().pose);
  out["sonar_like_mapping"] =
      sonar_json(set, mapped, "7 virtual sonars, map built on the way", report);
  // The same with calibrated dead reckoning, as for one's own robot. The constants are from the
  // full ranges of the whole drive.
  std::vector<Pose> at_scans;
  for (const StampedPose& p : full)
    at_scans.push_back(p.pose);
  const OdometryErrors errors = fit_odometry(set.poses_in_odom, at_scans);
  report.note(
      format("dead reckoning is off by %.2f degrees a metre, %.1f %% of turns, %.1f %% of ways",
             degrees(errors.turn_per_metre), 100.0 * (errors.turn_scale - 1.0),
             100.0 * (errors.way_scale - 1.0)));
  heard.poses_in_odom = calibrated(set.poses_in_odom, errors);
  out["dead_reckoning_calibrated"] =
      evaluate(set, Trajectory(stamped(set.times, heard.poses_in_odom)),
               "dead reckoning, calibrated", report);
  out["sonar_like_calibrated"] = sonar_json(set, register_sonars(heard, walls, full.front().pose),
                                            "  7 virtual sonars, walls known", report);
  out["sonar_like_mapping_calibrated"] =
      sonar_json(set, map_sonars(heard, full.front().pose),
                 "  7 virtual sonars, map built on the way", report);
  if (set.sonars && set.map) {
    const SonarRun simulated =
        register_sonars(*set.sonars, *set.map, set.reference->poses().front().pose);
    out["sonar"] = sonar_json(set, simulated, "simulated sonars, the map known", report);
    out["sonar_mapping"] =
        sonar_json(set, map_sonars(*set.sonars, set.reference->poses().front().pose),
                   "simulated sonars, map built on the way", report);
  }
  PerceptReport seen = report_percepts(set, log_folder, full, heard.poses_in_odom, report);
  out["percepts"] = std::move(seen.percepts);
  out["grid"] = std::move(seen.grid);
  pictures.percepts = std::move(seen.drawing);
  maps::Drawing& ways = pictures.ways;
  ways.map = walls;
  ways.title = set.name;
  ways.trajectories.push_back({"full ranges", points_of(full, {})});
  if (!by_sonar.poses.empty())
    ways.trajectories.push_back({"7 virtual sonars", points_of(by_sonar.poses, {})});
  const Pose odom = relative(relative(full.front().pose, set.poses_in_odom.front()), Pose{});
  ways.trajectories.push_back({"dead reckoning", points_of(set.odometry.poses(), odom)});
  if (set.reference) {
    const Pairs pairs = pair_up(*set.reference, Trajectory(full));
    ways.trajectories.push_back({"reference", points_of(set.reference->poses(), alignment(pairs))});
  }
  return out;
}

json measure_corridor(const std::string& folder, Report& report) {
  const CorridorFindings f = interpret_corridor(parse_corridor(
      read_file(folder + "/measurement.txt"), read_file(folder + "/poses.txt"), folder));
  report.heading("sonar-corridor: eight real sonars along a corridor");
  report.note(
      format("walls of the second corridor: %zu percepts, the longest %.0f and %.0f mm off the fit",
             f.walls, 1e3 * f.left_offset, 1e3 * f.right_offset));
  report.note(f.width ? format("corridors seen there: %zu, one %.2f m wide (2.14 by the fit)",
                               f.corridors, *f.width)
                      : std::string("no corridor seen"));
  report.note(f.gap_found ? format("the gap is seen: centre %.0f mm, width %.0f mm off",
                                   1e3 * f.gap_centre_error, 1e3 * f.gap_width_error)
                          : format("the gap is not seen as one; %zu of its ends", f.gap_ends));
  report.note(format("openings elsewhere: %zu", f.other_openings));
  report.end_of_set();
  json out = {{"walls", f.walls},
              {"left_offset_m", f.left_offset},
              {"right_offset_m", f.right_offset},
              {"corridors", f.corridors},
              {"gap_found", f.gap_found},
              {"gap_ends", f.gap_ends},
              {"gap_centre_error_m", f.gap_centre_error},
              {"gap_width_error_m", f.gap_width_error},
              {"other_openings", f.other_openings}};
  if (f.width)
    out["width_m"] = *f.width;
  return out;
}

void write(const std::string& path, const std::string& text) {
  std::ofstream out(path);
  out << text << std::flush;
  if (!out)
    throw std::runtime_error(path + ": cannot be written");
}

struct Options {
  std::string data;
  LogFiles log;
  std::vector<std::string> only;
  std::string plot;
  std::string report;
  bool json = false;
  bool synthetic = false;
};

int run(const Options& options) {
  Report report;
  json out;
  const auto draw = [&](const std::string& name, const maps::Drawing& drawing) {
    if (options.plot.empty() || drawing.title.empty())
      return;
    fs::path path(options.plot);
    std::string file = path.stem().string() + "-" + name + path.extension().string();
    std::replace(file.begin(), file.end(), ' ', '-');
    path.replace_filename(file);
    const std::string text = path.string();
    write(text, maps::to_svg(drawing));
    if (options.report.empty())
      return;
    const fs::path beside = fs::absolute(options.report).parent_path();
    report.picture(drawing.title, fs::absolute(text).lexically_relative(beside).string());
  };
  const auto with = [&](const DataSet& set, const std::string& log_folder) {
    Pictures pictures;
    out[set.name] = measure(set, log_folder, report, pictures);
    draw(set.name, pictures.ways);
    draw(set.name + " percepts", pictures.percepts);
    report.end_of_set();
  };
  const auto wanted = [&](const std::string& name) {
    return options.only.empty() ||
           std::find(options.only.begin(), options.only.end(), name) != options.only.end();
  };
  if (options.synthetic) {
    for (const std::string& name : synthetic_names())
      if (wanted(name))
        with(synthetic_data_set(name, kSeed), "");
  } else if (!options.log.raw.empty()) {
    const std::string file = fs::path(options.log.raw).filename().string();
    with(load_data_set(file.substr(0, file.find('.')), options.log),
         fs::absolute(options.log.raw).parent_path().string());
  } else {
    if (!options.data.empty() && fs::is_directory(options.data)) {
      for (const LogFiles& files : find_logs(options.data)) {
        const fs::path folder = fs::path(files.raw).parent_path();
        if (wanted(files.name))
          with(load_data_set(files.name, files), folder.string());
      }
      const std::string corridor = (fs::path(options.data) / "sonar-corridor").string();
      if (fs::is_directory(corridor) && wanted("sonar-corridor"))
        out["sonar-corridor"] = measure_corridor(corridor, report);
    } else {
      std::printf(
          "no logs of real robots%s%s: give --data (or SAPHIRA_DATA) a folder of them "
          "(tests/bench/registration/README.md); simulated logs only\n",
          options.data.empty() ? "" : " in ", options.data.c_str());
    }
    for (const char* world : {"office-floor", "loop"})
      if (wanted(world))
        with(simulate_data_set(world, 2.0, kSeed, 9000), "");
  }
  if (!options.report.empty())
    write(options.report, report.markdown());
  if (options.json)
    std::printf("%s\n", out.dump().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Registration on logs of real and simulated robots"};
  Options options;
  app.add_flag("--json", options.json, "one JSON object on the last line");
  app.add_option("--data", options.data, "the folder of the data sets, a folder each")
      .environment("SAPHIRA_DATA");
  app.add_option("--only", options.only,
                 "these alone: intel, fr101, sonar-corridor, office-floor...");
  const Option log = app.add_option("--log", options.log.raw, "a CARMEN log instead (.gz or not)");
  app.add_option("--relations", options.log.relations, "its reference relations").needs(log);
  app.add_option("--corrected", options.log.corrected, "its corrected log").needs(log);
  app.add_flag("--synthetic", options.synthetic,
               "full ranges on drives made up instead: other lasers, wheels and floors");
  app.add_option("--report", options.report, "write the tables into this file (Markdown)");
  app.add_option("--plot", options.plot,
                 "draw each drive into FILE-NAME.svg and FILE-NAME-percepts.svg")
      .placeholder("FILE.svg");
  if (const auto code = app.parse(argc, argv))
    return *code;
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "saphira-bench-registration: " << error.what() << '\n';
    return 2;
  }
}
