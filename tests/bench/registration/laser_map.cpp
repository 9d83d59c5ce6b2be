#include "laser_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace saphira::bench {

namespace {

constexpr double kCell = 0.05;   // [m]
constexpr double kHits = 3;      // scans that saw a cell
constexpr double kOff = 0.06;    // [m] of a cell from the line that it is of
constexpr double kAgree = 0.94;  // cosine between the normals
constexpr double kGap = 0.3;     // [m] in a wall
constexpr double kLeast = 0.8;   // [m] of a wall
constexpr double kReach = 20.0;  // [m]

struct Cell {
  Vec2 at{0.0, 0.0};
  Vec2 normal{0.0, 0.0};
  double hits = 0.0;
  bool taken = false;
};

}  // namespace

maps::Map walls_of(const std::vector<registration::Scan>& scans, const std::vector<Pose>& poses) {
  // The two faces of a wall are cells apart, or look to opposite sides.
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
    }
  }
  std::vector<Cell> cells;
  for (auto& [key, cell] : grid)
    if (cell.hits >= kHits)
      cells.push_back({cell.at / cell.hits, cell.normal.normalized(), cell.hits, false});
  std::stable_sort(cells.begin(), cells.end(),
                   [](const Cell& a, const Cell& b) { return a.hits > b.hits; });

  maps::Map map;
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
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
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
    for (const std::size_t i : members)
      cells[i].taken = true;
    const Vec2 along(-normal.y(), normal.x());
    const Vec2 middle = origin + 0.5 * (from + to) * along;
    maps::Feature wall;
    wall.type = lps::PointType::wall;
    wall.pose_in_map = {middle.x(), middle.y(), std::atan2(along.y(), along.x())};
    wall.length = to - from;
    map.features.push_back(wall);
  }
  return map;
}

}  // namespace saphira::bench
