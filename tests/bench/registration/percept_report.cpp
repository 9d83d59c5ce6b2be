#include "percept_report.hpp"

#include <algorithm>

#include "percept_run.hpp"
#include "support/quantile.hpp"

namespace saphira::bench {

using namespace logs;

namespace {

using lps::PointType;
using nlohmann::json;
using saphira::test::quantile;

constexpr double kAgrees = 0.85;  // least share of the reference's walls that the laser sees

json json_of(const test::Count& count) {
  return {{"reported", count.reported}, {"real", count.real}, {"precision", count.precision()}};
}

json errors(const std::vector<double>& values, double unit = 1.0) {
  if (values.empty())
    return nullptr;
  return {{"p50", unit * quantile(values, 0.5)}, {"p95", unit * quantile(values, 0.95)}};
}

std::string of(const test::Count& count) {
  return format("%d of %d", count.real, count.reported);
}

std::string spread(const std::vector<double>& values, const char* how, double unit = 1.0) {
  if (values.empty())
    return "-";
  return format(how, unit * quantile(values, 0.5)) + ", " +
         format(how, unit * quantile(values, 0.95));
}

json percepts_of(const PerceptRun& run, const std::string& what, Report& report) {
  json out;
  std::vector<std::string> cells(7, "-");
  const auto counts = [](const test::Score& score) {
    return json{{"walls", json_of(score.walls())},
                {"doors", json_of(score.doors())},
                {"junctions", json_of(score.count(PointType::junction))}};
  };
  if (run.by_hand) {
    const test::Score& score = *run.by_hand;
    json hand = counts(score);
    hand["doors_passed"] = score.doors_passed();
    hand["doors_found"] = score.doors_found();
    if (score.doors_passed() > 0)
      hand["doors_recall"] = score.recall();
    hand["wall_offset_m"] = errors(score.wall_offset);
    hand["wall_heading_deg"] = errors(score.wall_heading, degrees(1.0));
    hand["door_place_m"] = errors(score.door_place);
    hand["door_width_m"] = errors(score.door_width);
    out["by_hand"] = hand;
    cells[0] = of(score.walls());
    cells[1] = of(score.doors());
    cells[2] = of(score.count(PointType::junction));
    cells[3] = format("%d of %d", score.doors_found(), score.doors_passed());
    cells[4] = spread(score.wall_offset, "%.3f") + " m; " +
               spread(score.wall_heading, "%.1f", degrees(1.0)) + " deg";
    cells[5] = score.door_place.empty() ? "-" : spread(score.door_place, "%.3f") + " m";
  }
  out["by_laser"] = counts(run.by_laser);
  cells[6] = of(run.by_laser.walls()) + "; " + of(run.by_laser.doors()) + "; " +
             of(run.by_laser.count(PointType::junction));
  report.row(what, cells);
  return out;
}

json grids_of(const std::array<test::GridScore, 2>& grids, const std::string& what,
              Report& report) {
  json out;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const test::GridScore& grid = grids[i];
    const char* model = i == 0 ? "muriel" : "cone";
    out[model] = {{"walls_kept", grid.walls}, {"free_wrong", grid.free}, {"auc", grid.auc}};
    if (grid.doorways)
      out[model]["doorways_blocked"] = *grid.doorways;
    report.row(what + (i == 0 ? ", MURIEL" : ", cone"),
               {format("%.3f", grid.walls), grid.doorways ? format("%.3f", *grid.doorways) : "-",
                format("%.4f", grid.free), format("%.3f", grid.auc)});
  }
  return out;
}

void add(const lps::Percept& percept, const Pose& at, maps::Strokes& strokes) {
  const bool wall = percept.type == PointType::wall;
  const Vec2 half = wall ? Vec2(0.5 * percept.length, 0.0) : Vec2(0.0, 0.5 * percept.width);
  strokes.lines.push_back(transform(at, -half));
  strokes.lines.push_back(transform(at, half));
}

void draw(const PerceptRun& run, const std::optional<maps::Map>& reference, const LaserCells& cells,
          maps::Drawing& drawing) {
  // A run of occupied cells is one stroke.
  maps::Strokes laser{"what the laser saw", "#bbb", LaserCells::kCell, {}};
  for (const Vec2& at : cells.surfaces()) {
    const Vec2 half(0.5 * LaserCells::kCell, 0.0);
    if (!laser.lines.empty() && (laser.lines.back() - (at - half)).norm() < 1e-6)
      laser.lines.back() = at + half;
    else
      laser.lines.insert(laser.lines.end(), {at - half, at + half});
  }
  maps::Strokes drawn{"by hand", "#222", 0.03, {}};
  maps::Strokes missed{"doors missed", "#e69f00", 0.2, {}};
  maps::Strokes found{"doors found", "#0072b2", 0.2, {}};
  maps::Strokes walls{"walls, real", "#009e73", 0.06, {}};
  maps::Strokes openings{"openings, real", "#56b4e9", 0.08, {}};
  maps::Strokes wrong{"wrong", "#d00", 0.06, {}};
  maps::Strokes outside{"not judged by hand", "#cc79a7", 0.04, {}};
  const auto shown = [](const lps::Percept& percept) {
    return percept.type == PointType::wall || percept.type == PointType::door ||
           percept.type == PointType::junction;
  };
  const test::Score& score = run.by_hand ? *run.by_hand : run.by_laser;
  for (const auto& [id, judged] : run.by_laser.judged())
    if (shown(judged.percept) && !score.judged().contains(id))
      add(judged.percept, judged.pose_in_world, outside);
  for (const auto& [id, judged] : score.judged())
    if (shown(judged.percept) && judged.real)
      add(judged.percept, judged.pose_in_world,
          judged.percept.type == PointType::wall ? walls : openings);
  for (const test::Mistake& mistake : score.mistakes())
    if (shown(mistake.percept))
      add(mistake.percept, mistake.pose_in_world, wrong);
  if (reference) {
    for (const maps::Feature& feature : reference->features) {
      lps::Percept as_percept;
      as_percept.type = feature.type;
      as_percept.length = feature.length;
      as_percept.width = feature.width;
      if (feature.type == PointType::wall)
        add(as_percept, feature.pose_in_map, drawn);
      const auto of_it = [&](bool is_found) {
        return std::any_of(score.passages().begin(), score.passages().end(), [&](const auto& p) {
          return p.door == feature.id && p.found == is_found;
        });
      };
      if (feature.type == PointType::door && (of_it(true) || of_it(false)))
        add(as_percept, feature.pose_in_map, of_it(true) ? found : missed);
    }
  }
  for (maps::Strokes* strokes :
       {&laser, &drawn, &missed, &found, &outside, &walls, &openings, &wrong})
    if (!strokes->lines.empty())
      drawing.strokes.push_back(std::move(*strokes));
}

}  // namespace

PerceptReport report_percepts(const DataSet& set, const std::string& log_folder,
                              const std::vector<StampedPose>& full,
                              const std::vector<Pose>& calibrated_in_odom, Report& report) {
  // Transforms all into the frame of the corrected poses.
  const Pose place = set.reference ? alignment(pair_up(Trajectory(full), *set.reference)) : Pose{};
  std::vector<Pose> poses;
  for (const StampedPose& p : full)
    poses.push_back(compose(place, p.pose));
  const LaserCells cells(set.scans, poses);
  std::optional<maps::Map> reference = load_reference(log_folder, set.name);
  if (!reference)
    report.note("no reference of walls and doors made by hand for this log");
  else if (const double seen = agreement(*reference, cells); seen < kAgrees) {
    report.note(
        format("the reference by the name of this log is not of it: the laser sees %.0f %% of its "
               "walls; nothing is held against it",
               100.0 * seen));
    reference.reset();
  }

  PerceptReport out;
  report.columns({"walls, real of reported", "doors", "junctions", "doors passed, found",
                  "error of walls p50, p95", "of doors, along the wall",
                  "by the laser alone: walls; doors; junctions"});
  for (const bool calibrate : {false, true})
    for (const bool thirteen : {false, true}) {
      SonarDrive drive = virtual_drive(set, thirteen ? front_of_b21() : pioneer_sonars());
      if (calibrate)
        drive.poses_in_odom = calibrated_in_odom;
      const PerceptRun run = run_percepts(drive, poses, reference, cells);
      const std::string name = thirteen ? "13 virtual sonars" : "7 virtual sonars";
      const std::string key = thirteen ? "sonars_13" : "sonars_7";
      out.percepts[key + (calibrate ? "_calibrated" : "")] =
          percepts_of(run, name + (calibrate ? ", calibrated" : ""), report);
      if (calibrate && !thirteen)
        draw(run, reference, cells, out.drawing);
    }
  report.columns({"walls kept", "doorways blocked", "free is wrong", "AUC"});
  for (const bool thirteen : {false, true})
    out.grid[thirteen ? "sonars_13" : "sonars_7"] =
        grids_of(run_grids(virtual_drive(set, thirteen ? front_of_b21() : pioneer_sonars()), poses,
                           reference, cells),
                 thirteen ? "13 virtual sonars" : "7 virtual sonars", report);
  out.drawing.title = set.name + ": what 7 virtual sonars saw, dead reckoning calibrated";
  return out;
}

}  // namespace saphira::bench
