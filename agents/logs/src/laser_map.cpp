#include "saphira/logs/laser_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "saphira/geometry/axes.hpp"

namespace saphira::logs {

namespace {

constexpr double kCell = 0.05;   // [m]
constexpr double kHits = 3;      // scans with a point in the cell
constexpr double kOff = 0.06;    // [m] distance of a cell from its line
constexpr double kAgree = 0.94;  // cosine between the normals
constexpr double kGap = 0.3;     // [m] in a wall
constexpr double kLeast = 0.3;   // [m] of a wall
constexpr double kReach = 20.0;  // [m]
constexpr double kThick = 0.3;   // [m] of a wall, the most
constexpr double kNear = 3.0;    // [m]

struct Cell {
  Vec2 at{0.0, 0.0};
  Vec2 normal{0.0, 0.0};
  double hits = 0.0;
  double near = 0.0;  // points near enough for a sonar
  bool taken = false;
};

struct Wall {
  Vec2 middle{0.0, 0.0};
  Vec2 normal{1.0, 0.0};
  double length = 0.0;
  double near = 0.0;
};

// The two faces of one wall. A map has one line for both.
bool same_wall(const Wall& a, const Wall& b) {
  if (a.normal.dot(b.normal) > -0.95 || std::abs((b.middle - a.middle).dot(a.normal)) > kThick)
    return false;
  const double apart = std::abs((b.middle - a.middle).dot(Vec2(-a.normal.y(), a.normal.x())));
  return 0.5 * (a.length + b.length) - apart > 0.5 * std::min(a.length, b.length);
}

}  // namespace

maps::Map walls_of(const std::vector<Scan>& scans, const std::vector<Pose>& poses) {
  // The two faces of a wall are cells apart, or face opposite sides.
  std::map<std::pair<std::pair<int, int>, int>, Cell> grid;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Pose turn{0.0, 0.0, poses[i].th};
    for (std::size_t k = 0; k < scans[i].points.size(); ++k) {
      if (scans[i].normals[k].isZero() || scans[i].points[k].norm() > 8.0)
        continue;
      const Vec2 at = transform(poses[i], scans[i].points[k]);
      const Vec2 normal = transform(turn, scans[i].normals[k]);
      const int side = static_cast<int>(
          std::floor(norm_angle(std::atan2(normal.y(), normal.x())) / (kPi / 4.0)));
      Cell& cell = grid[{{static_cast<int>(std::floor(at.x() / kCell)),
                          static_cast<int>(std::floor(at.y() / kCell))},
                         side}];
      cell.at += at;
      cell.normal += normal;
      cell.hits += 1.0;
      cell.near += scans[i].points[k].norm() < kNear ? 1.0 : 0.0;
    }
  }
  std::vector<Cell> cells;
  for (auto& [key, cell] : grid)
    if (cell.hits >= kHits)
      cells.push_back({cell.at / cell.hits, cell.normal.normalized(), cell.hits, cell.near, false});
  std::stable_sort(cells.begin(), cells.end(),
                   [](const Cell& a, const Cell& b) { return a.hits > b.hits; });

  std::vector<Wall> walls;
  for (std::size_t seed = 0; seed < cells.size(); ++seed) {
    if (cells[seed].taken)
      continue;
    Vec2 origin = cells[seed].at;
    Vec2 normal = cells[seed].normal;
    std::vector<std::size_t> members;
    double from = 0.0;
    double to = 0.0;
    for (int round = 0; round < 4; ++round) {
      const Vec2 along(-normal.y(), normal.x());
      std::vector<std::pair<double, std::size_t>> near;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const Vec2 off = cells[i].at - origin;
        if (!cells[i].taken && std::abs(off.dot(normal)) < kOff &&
            std::abs(off.dot(along)) < kReach && cells[i].normal.dot(normal) > kAgree)
          near.emplace_back(off.dot(along), i);
      }
      std::sort(near.begin(), near.end());
      // The stretch without a gap about the seed.
      const double here = (cells[seed].at - origin).dot(along);
      auto low = std::lower_bound(near.begin(), near.end(), std::pair(here - 1e-9, std::size_t{0}));
      if (low == near.end()) {
        members.clear();
        break;
      }
      auto high = low;
      while (low != near.begin() && low->first - (low - 1)->first < kGap)
        --low;
      while (high + 1 != near.end() && (high + 1)->first - high->first < kGap)
        ++high;
      from = low->first;
      to = high->first;
      members.clear();
      Vec2 mean = Vec2::Zero();
      for (auto it = low; it <= high; ++it) {
        members.push_back(it->second);
        mean += cells[it->second].at;
      }
      if (members.size() < 4)
        break;
      mean /= static_cast<double>(members.size());
      Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
      for (const std::size_t i : members)
        scatter += (cells[i].at - mean) * (cells[i].at - mean).transpose();
      const auto axes = principal_axes(scatter);
      Vec2 fitted = axes.eigenvectors().col(0);
      if (fitted.dot(normal) < 0.0)
        fitted = -fitted;
      if (fitted.dot(normal) < kAgree)
        break;
      const double shift = (mean - origin).dot(along);
      from -= shift;
      to -= shift;
      origin = mean;
      normal = fitted;
    }
    cells[seed].taken = true;
    if (members.size() < 4 || to - from < kLeast)
      continue;
    Wall wall{origin + 0.5 * (from + to) * Vec2(-normal.y(), normal.x()), normal, to - from, 0.0};
    for (const std::size_t i : members) {
      cells[i].taken = true;
      wall.near += cells[i].near;
    }
    walls.push_back(wall);
  }
  // Keeps the face with more near points.
  std::stable_sort(walls.begin(), walls.end(),
                   [](const Wall& a, const Wall& b) { return a.near > b.near; });
  maps::Map map;
  std::vector<Wall> kept;
  for (const Wall& wall : walls) {
    if (std::any_of(kept.begin(), kept.end(), [&](const Wall& k) { return same_wall(k, wall); }))
      continue;
    kept.push_back(wall);
    maps::Feature feature;
    feature.type = lps::PointType::wall;
    feature.pose_in_map = {wall.middle.x(), wall.middle.y(),
                           std::atan2(wall.normal.x(), -wall.normal.y())};
    feature.length = wall.length;
    map.features.push_back(feature);
  }
  return map;
}

}  // namespace saphira::logs
