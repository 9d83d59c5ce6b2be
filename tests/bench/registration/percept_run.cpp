#include "percept_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace saphira::bench {

using namespace logs;

namespace {

using lps::PointType;
using test::GridTruth;

// As in test::Score.
constexpr int kSamples = 20;
constexpr int kEnough = 17;
constexpr double kOnWall = 0.2;    // [m]
constexpr double kOnCorner = 0.3;  // [m]
constexpr double kAskew = radians(5.0);
constexpr double kPathStep = 0.3;  // [m]

sim::Segment segment_of(const maps::Feature& wall) {
  const Vec2 half =
      0.5 * wall.length * Vec2(std::cos(wall.pose_in_map.th), std::sin(wall.pose_in_map.th));
  return {wall.pose_in_map.position() - half, wall.pose_in_map.position() + half};
}

bool is_covered(const maps::Map& reference, const Vec2& at) {
  return std::any_of(reference.features.begin(), reference.features.end(), [&](const auto& f) {
    return f.type == PointType::office && f.name == "covered" && maps::contains(f, at);
  });
}

bool lasts(const LaserCells& cells, const lps::Percept& wall, const Pose& at) {
  // The surface's distance from the percept along it, and the change of that.
  double n = 0.0;
  double su = 0.0;
  double sv = 0.0;
  double suu = 0.0;
  double suv = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double u = ((i + 0.5) / kSamples - 0.5) * wall.length;
    const auto v = cells.beside(transform(at, {u, 0.0}), at.th + kPi / 2, kOnWall);
    if (!v)
      continue;
    n += 1.0;
    su += u;
    sv += *v;
    suu += u * u;
    suv += u * *v;
  }
  return n >= kEnough && std::abs(std::atan2(n * suv - su * sv, n * suu - su * su)) <= kAskew;
}

bool is_open(const LaserCells& cells, const lps::Percept& opening, const Pose& at) {
  const double half = 0.5 * opening.width;
  for (const double end : {-half, half})
    if (!cells.near(transform(at, {0.0, end}), kOnCorner))
      return false;
  const int steps = static_cast<int>((half - kOnCorner) / (0.5 * LaserCells::kCell));
  for (int i = -steps; i <= steps; ++i)
    if (cells.occupied(transform(at, {0.0, i * 0.5 * LaserCells::kCell})))
      return false;
  return true;
}

std::vector<Vec2> path_of(const std::vector<Pose>& poses) {
  std::vector<Vec2> out;
  for (const Pose& pose : poses)
    if (out.empty() || (pose.position() - out.back()).norm() > kPathStep)
      out.push_back(pose.position());
  return out;
}

}  // namespace

std::optional<maps::Map> load_reference(const std::string& log_folder, const std::string& name) {
  const std::string beside = log_folder + "/reference.map";
  if (!log_folder.empty() && std::filesystem::is_regular_file(beside))
    return maps::load_map(beside);
  const std::string own = std::string(SAPHIRA_REFERENCES) + "/" + name + ".map";
  if (std::filesystem::is_regular_file(own))
    return maps::load_map(own);
  return std::nullopt;
}

double agreement(const maps::Map& reference, const LaserCells& cells) {
  double all = 0.0;
  double seen = 0.0;
  for (const maps::Feature& wall : reference.features) {
    if (wall.type != PointType::wall)
      continue;
    const sim::Segment segment = segment_of(wall);
    const int steps = static_cast<int>(wall.length / 0.1);
    for (int i = 0; i <= steps; ++i) {
      const Vec2 at = segment.from + (i + 0.5) / (steps + 1.0) * (segment.to - segment.from);
      all += 1.0;
      seen += cells.near(at, 0.15) ? 1.0 : 0.0;
    }
  }
  return all > 0.0 ? seen / all : 0.0;
}

PerceptRun run_percepts(const SonarDrive& drive, const std::vector<Pose>& poses_in_map,
                        const std::optional<maps::Map>& reference, const LaserCells& cells) {
  PerceptRun out{{}, test::Score([&cells](const lps::Percept& percept, const Pose& at) {
                   switch (percept.type) {
                     case PointType::wall:
                       return lasts(cells, percept, at);
                     case PointType::door:
                     case PointType::junction:
                       return is_open(cells, percept, at);
                     default:
                       return true;
                   }
                 })};
  if (reference) {
    sim::Things things;
    for (const maps::Feature& feature : reference->features)
      if (feature.type == PointType::wall)
        things.segments.push_back(segment_of(feature));
    out.by_hand.emplace(
        *reference, [things](const Vec2&) { return things; },
        [map = *reference](const Vec2& at) { return is_covered(map, at); });
  }
  interpretation::Settings settings;
  settings.sonars = drive.ring.mounts;
  interpretation::Interpretation interpretation(settings);
  perceive(drive, interpretation, nullptr, [&](const Perceived& seen) {
    const std::size_t i = seen.stamp;
    const std::size_t before = i == 0 ? 0 : i - 1;
    const double seconds = std::max(1e-3, drive.times[i] - drive.times[before]);
    const test::Moment moment{
        seen.cycle, drive.poses_in_odom[i], poses_in_map[i],
        (poses_in_map[i].position() - poses_in_map[before].position()).norm() / seconds};
    out.by_laser.look(moment, seen.output->percepts);
    if (out.by_hand)
      out.by_hand->look(moment, seen.output->percepts);
  });
  return out;
}

std::array<test::GridScore, 2> run_grids(const SonarDrive& drive,
                                         const std::vector<Pose>& poses_in_map,
                                         const std::optional<maps::Map>& reference,
                                         const LaserCells& cells) {
  const std::vector<Vec2> path = path_of(poses_in_map);
  GridTruth truth;
  for (const Vec2& at : cells.surfaces())
    if (test::seen_from(path, at,
                        [&](const Vec2& from, const Vec2& to) { return !cells.sees(from, to); }))
      truth.surfaces.push_back(at);
  if (reference)
    truth.doorways = test::doorways_beside(path, *reference);
  truth.cell = [&cells](const Vec2& at) {
    return cells.occupied(at) ? GridTruth::Cell::occupied
           : cells.free(at)   ? GridTruth::Cell::free
                              : GridTruth::Cell::unknown;
  };
  std::vector<Pose> odom_in_map;
  for (std::size_t i = 0; i < poses_in_map.size(); ++i)
    odom_in_map.push_back(compose(poses_in_map[i], relative(drive.poses_in_odom[i], Pose{})));
  std::array<test::GridScore, 2> out;
  for (const auto model : {interpretation::GridModel::muriel, interpretation::GridModel::cone}) {
    interpretation::Settings settings;
    settings.sonars = drive.ring.mounts;
    settings.grid.model = model;
    settings.grid.window = 1000.0;
    interpretation::Interpretation interpretation(settings);
    perceive(drive, interpretation, &odom_in_map, [](const Perceived&) {});
    out[model == interpretation::GridModel::muriel ? 0 : 1] =
        test::score_grid(interpretation.grid(), truth);
  }
  return out;
}

}  // namespace saphira::bench
