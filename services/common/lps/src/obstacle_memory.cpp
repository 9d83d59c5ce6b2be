#include "saphira/lps/obstacle_memory.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/wide.hpp"
#include "saphira/geometry/cone.hpp"

namespace saphira::lps {
namespace {

/// [cells] The grid follows when the robot is this far from its middle.
constexpr long kFollow = 10;
/// [cells] The least size of a hit obstacle, to each side.
constexpr double kTouched = 2.0;
/// The cone of a sonar is at least as long as so many cells, and as so many errors of its range.
constexpr double kCells = 20.0;
constexpr double kErrors = 12.0;
constexpr double kShortest = 0.01;  // [m] range of a sonar
constexpr double kMoved = 0.001;    // [m] in a cycle: less is rest, and a turn on the spot is

std::size_t area(int cells) {
  return static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
}

SAPHIRA_WIDE void scale(std::vector<double>& values, double factor) {
  for (double& value : values)
    value *= factor;
}

SAPHIRA_WIDE long count_from(double least, const double* values, long count) {
  long found = 0;
  for (long i = 0; i < count; ++i)
    found += values[i] >= least ? 1 : 0;
  return found;
}

}  // namespace

MemorySettings for_range(double range, MemorySettings settings) {
  const double length = std::max(range, kShortest);
  settings.cell = std::min(settings.cell, length / kCells);
  settings.thickness = std::min(settings.thickness, length / kErrors);
  settings.silent_range = std::min(settings.silent_range, range);
  return settings;
}

ObstacleMemory::ObstacleMemory(MemorySettings settings)
    : settings_(settings),
      beliefs_(area(settings.cells), 0.0),
      highest_(static_cast<std::size_t>(settings.cells), 0.0) {}

void ObstacleMemory::clear() {
  placed_ = false;
  std::fill(beliefs_.begin(), beliefs_.end(), 0.0);
  std::fill(highest_.begin(), highest_.end(), 0.0);
  points_.clear();
}

void ObstacleMemory::move_to(const Pose& robot_in_odom) {
  const double way = (robot_in_odom.position() - robot_in_odom_.position()).norm();
  robot_in_odom_ = robot_in_odom;
  if (!settings_.keeps_at_rest || way > kMoved)
    fade();
  const long half = settings_.cells / 2;
  const long column0 = std::lround(robot_in_odom.x / settings_.cell) - half;
  const long row0 = std::lround(robot_in_odom.y / settings_.cell) - half;
  if (placed_ && std::abs(column0 - column0_) <= kFollow && std::abs(row0 - row0_) <= kFollow)
    return;
  if (placed_) {
    std::vector<double> moved(beliefs_.size(), 0.0);
    const long n = settings_.cells;
    for (long row = 0; row < n; ++row)
      for (long column = 0; column < n; ++column) {
        const long old_row = row + row0 - row0_;
        const long old_column = column + column0 - column0_;
        if (old_row >= 0 && old_row < n && old_column >= 0 && old_column < n)
          moved[static_cast<std::size_t>(row * n + column)] =
              beliefs_[static_cast<std::size_t>(old_row * n + old_column)];
      }
    beliefs_ = std::move(moved);
    std::fill(highest_.begin(), highest_.end(), settings_.most);
  }
  placed_ = true;
  column0_ = column0;
  row0_ = row0;
}

void ObstacleMemory::fade() {
  scale(beliefs_, settings_.fading);
  scale(highest_, settings_.fading);
}

void ObstacleMemory::raise(std::size_t cell, double belief) {
  beliefs_[cell] = belief;
  double& highest = highest_[cell / static_cast<std::size_t>(settings_.cells)];
  highest = std::max(highest, belief);
}

template <class F>
void ObstacleMemory::for_cone(const Pose& sonar, double range, F&& f) {
  const double cell = settings_.cell;
  const long n = settings_.cells;
  // The box around the cone: its tip, the ends of the arc, the middle of the arc. The arc's extreme
  // lies within a cell of these for a cone as narrow as a sonar's.
  double low_x = sonar.x, high_x = sonar.x, low_y = sonar.y, high_y = sonar.y;
  for (const double off : {-settings_.beam, 0.0, settings_.beam}) {
    const double x = sonar.x + range * std::cos(sonar.th + off);
    const double y = sonar.y + range * std::sin(sonar.th + off);
    low_x = std::min(low_x, x);
    high_x = std::max(high_x, x);
    low_y = std::min(low_y, y);
    high_y = std::max(high_y, y);
  }
  const auto clamped = [n](double v) {
    return std::clamp(static_cast<long>(std::floor(v)), 0L, n);
  };
  const long column_begin = clamped(low_x / cell - 1.0 - static_cast<double>(column0_));
  const long column_end = clamped(high_x / cell + 2.0 - static_cast<double>(column0_));
  const long row_begin = clamped(low_y / cell - 1.0 - static_cast<double>(row0_));
  const long row_end = clamped(high_y / cell + 2.0 - static_cast<double>(row0_));
  const double c = std::cos(sonar.th);
  const double s = std::sin(sonar.th);
  const double edge = std::tan(settings_.beam);
  const ConeRows rows(sonar, edge, range);
  for (long row = row_begin; row < row_end; ++row) {
    const double dy = (static_cast<double>(row + row0_) + 0.5) * cell - sonar.y;
    const auto [low, high] = rows.span(dy);
    const double offset = sonar.x / cell - static_cast<double>(column0_);
    const long begin = std::max(column_begin, clamped(low / cell + offset - 1.5));
    const long end = std::min(column_end, clamped(high / cell + offset + 1.5));
    for (long column = begin; column < end; ++column) {
      const double dx = (static_cast<double>(column + column0_) + 0.5) * cell - sonar.x;
      const double along = c * dx + s * dy;
      const double across = -s * dx + c * dy;
      if (along <= 0.0 || std::abs(across) > edge * along)
        continue;
      const double distance = std::sqrt(along * along + across * across);
      if (distance <= range)
        f(static_cast<std::size_t>(row * n + column), distance, std::abs(across) / (edge * along));
    }
  }
}

ObstacleMemory::Passing::Passing(const MemorySettings& settings, double doubt)
    : soft_(1.0 - std::tan(settings.sure) / std::tan(settings.beam)),
      doubt_(doubt),
      least_(settings.least) {}

void ObstacleMemory::Passing::operator()(double& belief, double off) const {
  const double sure = std::min((1.0 - off) / soft_, 1.0);
  belief = std::max(belief - doubt_ * sure, least_);
}

void ObstacleMemory::pass(const Pose& sonar_in_odom, double range, double doubt) {
  const Passing passing(settings_, doubt);
  for_cone(sonar_in_odom, range, [&](std::size_t cell, double /*distance*/, double off) {
    passing(beliefs_[cell], off);
  });
}

void ObstacleMemory::echo(const Pose& sonar_in_odom, double range) {
  // The likeliest arc cell so far takes the echo in full, the others in proportion.
  const double free = range - 2.0 * settings_.thickness;
  const Passing passing(settings_, settings_.passed);
  double likeliest = 0.0;
  arc_.clear();
  for_cone(sonar_in_odom, range + settings_.thickness,
           [&](std::size_t cell, double distance, double off) {
             double& belief = beliefs_[cell];
             if (distance <= free) {
               passing(belief, off);
             } else if (std::abs(distance - range) <= settings_.thickness) {
               arc_.push_back({cell, std::exp(belief) * (1.0 - 0.5 * off)});
               likeliest = std::max(likeliest, arc_.back().likely);
             }
           });
  for (const Arc& arc : arc_)
    raise(arc.cell,
          std::min(beliefs_[arc.cell] + settings_.seen * arc.likely / likeliest, settings_.most));
}

void ObstacleMemory::free_before(const Pose& sonar_in_odom, double range) {
  pass(sonar_in_odom, range - 2.0 * settings_.thickness, settings_.passed);
}

void ObstacleMemory::silence(const Pose& sonar_in_odom) {
  pass(sonar_in_odom, settings_.silent_range, settings_.silent);
}

void ObstacleMemory::touch(const Vec2& at_in_odom) {
  const double cell = settings_.cell;
  const long n = settings_.cells;
  for (long row = 0; row < n; ++row)
    for (long column = 0; column < n; ++column) {
      const Vec2 middle((static_cast<double>(column + column0_) + 0.5) * cell,
                        (static_cast<double>(row + row0_) + 0.5) * cell);
      if ((middle - at_in_odom).norm() <= kTouched * cell)
        raise(static_cast<std::size_t>(row * n + column), settings_.most);
    }
}

void ObstacleMemory::collect(const Pose& robot_in_odom) {
  points_.clear();
  const ToFrame to_robot(robot_in_odom);
  const double obstacle = settings_.obstacle;
  const long n = settings_.cells;
  // Counting a whole row is faster than searching it.
  for (long row = 0; row < n; ++row) {
    double& highest = highest_[static_cast<std::size_t>(row)];
    if (highest < obstacle)
      continue;
    const double* const beliefs = beliefs_.data() + row * n;
    long obstacles = count_from(obstacle, beliefs, n);
    if (obstacles == 0)
      highest = std::nextafter(obstacle, 0.0);
    for (long column = 0; obstacles > 0; ++column) {
      if (beliefs[column] < obstacle)
        continue;
      --obstacles;
      points_.push_back(to_robot({(static_cast<double>(column + column0_) + 0.5) * settings_.cell,
                                  (static_cast<double>(row + row0_) + 0.5) * settings_.cell}));
    }
  }
}

}  // namespace saphira::lps
