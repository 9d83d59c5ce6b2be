#include "saphira/lps/obstacle_memory.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

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
constexpr std::size_t kBits = 64;   // of a word of marks
constexpr long kLanes = 4;          // cells that are lowered at once
constexpr double kMoved = 0.001;    // [m] in a cycle: less is rest, and a turn on the spot is

std::size_t area(int cells) {
  return static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
}

SAPHIRA_WIDE void scale(double* values, long count, double factor) {
  for (long i = 0; i < count; ++i)
    values[i] *= factor;
}

/// Lowers the beliefs within the cone and the range, less at the cone's rim.
SAPHIRA_WIDE void lower(double* all, const ConeCells& cone, double cell, double edge, double range,
                        double soft, double doubt, double least) {
  const double x = cone.x;
  const double c = cone.cosine;
  const double s = cone.sine;
  const double square = range * range;
  for (const ConeCells::Row& row : cone.rows) {
    double* const beliefs = all + row.index;
    const double first = row.first;
    const double dy = row.dy;
    for (int i = 0; i < static_cast<int>(row.count); ++i) {
      const double dx = (first + i + 0.5) * cell - x;
      const double along = c * dx + s * dy;
      const double across = std::abs(-s * dx + c * dy);
      const double rim = edge * along;
      const double sure = std::min((1.0 - across / rim) / soft, 1.0);
      const double lowered = std::max(beliefs[i] - doubt * sure, least);
      const bool inside =
          (along > 0.0) & (across <= rim) & (along * along + across * across <= square);
      beliefs[i] = inside ? lowered : beliefs[i];
    }
  }
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
      edge_(std::tan(settings.beam)),
      soft_(1.0 - std::tan(settings.sure) / std::tan(settings.beam)),
      beliefs_(area(settings.cells), 0.0),
      held_(static_cast<std::size_t>(settings.cells)),
      words_((static_cast<std::size_t>(settings.cells) + kBits - 1) / kBits),
      marks_(words_ * static_cast<std::size_t>(settings.cells), 0) {}

void ObstacleMemory::clear() {
  placed_ = false;
  std::fill(beliefs_.begin(), beliefs_.end(), 0.0);
  std::fill(held_.begin(), held_.end(), Part{});
  std::fill(marks_.begin(), marks_.end(), 0);
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
  if (placed_)
    shift(column0 - column0_, row0 - row0_);
  placed_ = true;
  column0_ = column0;
  row0_ = row0;
}

void ObstacleMemory::shift(long columns, long rows) {
  const std::vector<double> beliefs = std::exchange(beliefs_, std::vector<double>(beliefs_.size()));
  const std::vector<Part> held = std::exchange(held_, std::vector<Part>(held_.size()));
  std::fill(marks_.begin(), marks_.end(), 0);
  const long n = settings_.cells;
  for (long row = std::max(0L, rows); row < std::min(n, n + rows); ++row) {
    const Part& part = held[static_cast<std::size_t>(row)];
    const long begin = std::max(part.begin, columns);
    const long end = std::min(part.end, n + columns);
    if (begin >= end)
      continue;
    hold(static_cast<std::size_t>(row - rows), begin - columns, end - columns);
    for (long column = begin; column < end; ++column) {
      const double belief = beliefs[static_cast<std::size_t>(row * n + column)];
      beliefs_[static_cast<std::size_t>((row - rows) * n + column - columns)] = belief;
      if (belief >= settings_.obstacle)
        mark(static_cast<std::size_t>(row - rows), static_cast<std::size_t>(column - columns));
    }
  }
}

void ObstacleMemory::fade() {
  for (std::size_t row = 0; row < held_.size(); ++row)
    scale(&beliefs_[row * held_.size() + static_cast<std::size_t>(held_[row].begin)],
          held_[row].end - held_[row].begin, settings_.fading);
}

void ObstacleMemory::hold(std::size_t row, long begin, long end) {
  Part& held = held_[row];
  held = held.begin == held.end ? Part{begin, end}
                                : Part{std::min(held.begin, begin), std::max(held.end, end)};
}

void ObstacleMemory::put(std::size_t cell, double belief) {
  beliefs_[cell] = belief;
  const std::size_t row = cell / held_.size();
  const std::size_t column = cell % held_.size();
  hold(row, static_cast<long>(column), static_cast<long>(column) + 1);
  if (belief >= settings_.obstacle)
    mark(row, column);
}

void ObstacleMemory::mark(std::size_t row, std::size_t column) {
  marks_[row * words_ + column / kBits] |= std::uint64_t{1} << (column % kBits);
}

void ObstacleMemory::look_along(const Pose& sonar, double range, bool only_held) {
  const double cell = settings_.cell;
  const long n = settings_.cells;
  const auto clamped = [n](double v) {
    return std::clamp(static_cast<long>(std::floor(v)), 0L, n);
  };
  const ConeRows rows(sonar, edge_, range);
  const auto [lowest, highest] = rows.rows();
  const double x = sonar.x / cell - static_cast<double>(column0_);
  const double y = sonar.y / cell - static_cast<double>(row0_);
  const long row_end = clamped(highest / cell + y + 1.5);
  cone_.x = sonar.x;
  cone_.cosine = rows.cosine();
  cone_.sine = rows.sine();
  cone_.rows.clear();
  for (long row = clamped(lowest / cell + y - 1.5); row < row_end; ++row) {
    const Part& held = held_[static_cast<std::size_t>(row)];
    if (only_held && held.begin == held.end)
      continue;
    const double dy = (static_cast<double>(row + row0_) + 0.5) * cell - sonar.y;
    const auto [low, high] = rows.span(dy);
    const long begin = clamped(low / cell + x - 1.5);
    const long end = clamped(high / cell + x + 1.5);
    if (begin < end)
      cone_.rows.push_back({static_cast<std::size_t>(row * n + begin), end - begin,
                            static_cast<double>(begin + column0_), dy});
  }
}

void ObstacleMemory::pass(double range, double doubt) {
  const long n = settings_.cells;
  for (ConeCells::Row& row : cone_.rows) {
    const std::size_t number = row.index / held_.size();
    const auto column = static_cast<long>(row.index % held_.size());
    long begin = column;
    long end = column + row.count;
    if (settings_.least >= 0.0) {
      // No belief falls below 0.
      begin = std::max(begin, held_[number].begin);
      end = std::max(begin, std::min(end, held_[number].end));
    }
    begin -= begin % kLanes;
    end = std::min((end + kLanes - 1) / kLanes * kLanes, n);
    if (settings_.least < 0.0)
      hold(number, begin, end);
    row = {number * held_.size() + static_cast<std::size_t>(begin), end - begin,
           row.first + static_cast<double>(begin - column), row.dy};
  }
  lower(beliefs_.data(), cone_, settings_.cell, edge_, range, soft_, doubt, settings_.least);
}

void ObstacleMemory::pass(const Pose& sonar_in_odom, double range, double doubt) {
  if (range <= 0.0)
    return;
  look_along(sonar_in_odom, range, settings_.least >= 0.0);
  pass(range, doubt);
}

void ObstacleMemory::find_arc(double range) {
  const double cell = settings_.cell;
  const double inner = std::max(range - settings_.thickness - cell, 0.0);
  arc_.clear();
  for (const ConeCells::Row& row : cone_.rows) {
    // From the middle of the first cell.
    const double dx0 = (row.first + 0.5) * cell - cone_.x;
    const double farthest = std::max(-dx0, dx0 + static_cast<double>(row.count) * cell) + cell;
    if (farthest * farthest + row.dy * row.dy < inner * inner)
      continue;
    // The cells from `left` to `right` are nearer than the arc.
    const double half = std::sqrt(std::max(inner * inner - row.dy * row.dy, 0.0));
    const auto column = [&](double dx) {
      return std::clamp(static_cast<long>((dx - dx0) / cell + 0.5), 0L, row.count);
    };
    const long left = column(-half) + 1;
    const long right = column(half) - 1;
    for (long i = 0; i < row.count; ++i) {
      if (i == left && left < right)
        i = right;
      const double dx = (row.first + static_cast<double>(i) + 0.5) * cell - cone_.x;
      const double along = cone_.cosine * dx + cone_.sine * row.dy;
      const double across = -cone_.sine * dx + cone_.cosine * row.dy;
      if (along <= 0.0 || std::abs(across) > edge_ * along)
        continue;
      const double distance = std::sqrt(along * along + across * across);
      if (distance <= range - 2.0 * settings_.thickness || distance > range + settings_.thickness ||
          std::abs(distance - range) > settings_.thickness)
        continue;
      const std::size_t index = row.index + static_cast<std::size_t>(i);
      arc_.push_back(
          {index, std::exp(beliefs_[index]) * (1.0 - 0.5 * (std::abs(across) / (edge_ * along)))});
    }
  }
}

void ObstacleMemory::echo(const Pose& sonar_in_odom, double range) {
  look_along(sonar_in_odom, range + settings_.thickness, false);
  find_arc(range);
  pass(std::max(range - 2.0 * settings_.thickness, 0.0), settings_.passed);
  // The likeliest arc cell so far takes the echo in full, the others in proportion.
  double likeliest = 0.0;
  for (const Arc& arc : arc_)
    likeliest = std::max(likeliest, arc.likely);
  for (const Arc& arc : arc_)
    put(arc.cell,
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
        put(static_cast<std::size_t>(row * n + column), settings_.most);
    }
}

void ObstacleMemory::collect(const Pose& robot_in_odom) {
  points_.clear();
  const ToFrame to_robot(robot_in_odom);
  const double size = settings_.cell;
  for (std::size_t word = 0; word < marks_.size(); ++word) {
    const std::size_t row = word / words_;
    const std::size_t column0 = word % words_ * kBits;
    for (std::uint64_t left = marks_[word]; left != 0; left &= left - 1) {
      const std::size_t column = column0 + static_cast<std::size_t>(std::countr_zero(left));
      if (beliefs_[row * held_.size() + column] < settings_.obstacle) {
        marks_[word] ^= left & ~(left - 1);
        continue;
      }
      points_.push_back(
          to_robot({(static_cast<double>(static_cast<long>(column) + column0_) + 0.5) * size,
                    (static_cast<double>(static_cast<long>(row) + row0_) + 0.5) * size}));
    }
  }
}

}  // namespace saphira::lps
