#include "saphira/viewer/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "geometry/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "saphira/maps/line_map.hpp"

namespace saphira::viewer {

namespace {

constexpr double kSonarHeight = 0.2;           // [m] of drawn echoes
constexpr std::size_t kMostCells = 4'000'000;  // of a drawn grid

/// A line of that length along a pose; `across`: at right angles to it.
Line line_at(const v1::Pose2& pose, double length, bool across) {
  const double th = pose.th + (across ? kPi / 2 : 0.0);
  const Vec2 half = Vec2(std::cos(th), std::sin(th)) * (length / 2);
  const Vec2 middle(pose.x, pose.y);
  return {middle - half, middle + half};
}

}  // namespace

Plan plan_of(const v1::Perception& perception) {
  Plan plan;
  for (const v1::Percept& percept : perception.percepts) {
    if (percept.type == v1::ARTIFACT_WALL)
      plan.walls.push_back(line_at(percept.pose_in_odom, percept.length, false));
    else if (percept.type == v1::ARTIFACT_DOOR || percept.type == v1::ARTIFACT_JUNCTION)
      plan.openings.push_back(line_at(percept.pose_in_odom, percept.width, true));
  }
  return plan;
}

Plan plan_of(const v1::FloorMap& map) {
  Plan plan;
  const maps::Map known = maps::from_bus(map);
  const maps::LineMap lines(known);
  for (const maps::Surface& surface : lines.surfaces())
    plan.walls.push_back({surface.from, surface.to});
  for (const v1::MapArtifact& artifact : map.artifacts) {
    if (artifact.type == v1::ARTIFACT_DOOR || artifact.type == v1::ARTIFACT_BREAK)
      plan.openings.push_back(line_at(artifact.pose_in_map, artifact.width, true));
    else if (!artifact.name.empty())
      plan.names.push_back({artifact.name, artifact.pose_in_map});
  }
  return plan;
}

std::string echoes_of(const v1::SonarBuckets& sonars) {
  std::string points;
  for (const v1::SonarBucket& bucket : sonars.buckets) {
    if (!bucket.reading.echo)
      continue;
    const Vec2 point = transform(from_bus(bucket.pose_in_odom), Vec2(bucket.x, bucket.y));
    for (const double value : {point.x(), point.y(), kSonarHeight}) {
      const auto small = static_cast<float>(value);
      std::array<char, sizeof small> bytes{};
      std::memcpy(bytes.data(), &small, sizeof small);  // little-endian, as this machine
      points.append(bytes.data(), bytes.size());
    }
  }
  return points;
}

void Placing::take(const v1::Registration& registration) {
  registration_.reset();
  if (registration.state == v1::REGISTRATION_TRACKING)
    registration_ = registration;
}

Place Placing::of(const v1::RobotState& state) const {
  if (!registration_ || registration_->odom != state.odom)
    return {{}, state.pose_in_odom};
  return {registration_->odom_in_map,
          to_bus(compose(from_bus(registration_->odom_in_map), from_bus(state.pose_in_odom)))};
}

Tiles::Tiles(double period) : period_ns_(static_cast<std::int64_t>(period * 1e9)) {}

std::optional<Cells> Tiles::take(const v1::GridTile& tile, bool disposed, std::int64_t time_ns) {
  note(tile, disposed);
  if (time_ns - sent_ns_ < period_ns_)
    return std::nullopt;
  std::optional<Cells> all = whole();
  if (all)
    sent_ns_ = time_ns;
  return all;
}

void Tiles::note(const v1::GridTile& tile, bool disposed) {
  if (disposed) {
    tiles_.erase({tile.row, tile.column});
    return;
  }
  std::erase_if(tiles_, [&tile](const auto& entry) {
    const v1::GridTile& other = entry.second;
    return other.odom != tile.odom || other.side != tile.side ||
           other.resolution != tile.resolution;
  });
  tiles_[{tile.row, tile.column}] = tile;
}

std::optional<Cells> Tiles::whole() const {
  if (tiles_.empty())
    return std::nullopt;
  const v1::GridTile& first = tiles_.begin()->second;
  const auto [west, east] = std::minmax_element(
      tiles_.begin(), tiles_.end(),
      [](const auto& a, const auto& b) { return a.first.second < b.first.second; });
  const std::int64_t left = west->first.second;
  const std::int64_t bottom = tiles_.begin()->first.first;
  const std::size_t side = first.side;
  const std::size_t columns = side * static_cast<std::size_t>(east->first.second - left + 1);
  const std::size_t rows =
      side * static_cast<std::size_t>(tiles_.rbegin()->first.first - bottom + 1);
  if (rows > kMostCells || columns > kMostCells || rows * columns > kMostCells)
    return std::nullopt;
  const double edge = static_cast<double>(side) * first.resolution;
  Cells all{first.odom,
            static_cast<double>(left) * edge,
            static_cast<double>(bottom) * edge,
            first.resolution,
            columns,
            rows,
            std::string(rows * columns, '\xFF')};
  for (const auto& [place, each] : tiles_)
    for (std::size_t row = 0; row < side && (row + 1) * side <= each.cells.size(); ++row)
      std::memcpy(
          &all.cells[(static_cast<std::size_t>(place.first - bottom) * side + row) * columns +
                     static_cast<std::size_t>(place.second - left) * side],
          &each.cells[row * side], side);
  return all;
}

}  // namespace saphira::viewer
