#include "saphira/lps/obstacle_memory.hpp"

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
constexpr long kLanes = 8;          // cells that are lowered at once
constexpr float kOutside = -1e9F;   // [m] of the columns beyond the grid: behind any sonar
constexpr double kMoved = 0.001;    // [m] in a cycle: less is rest, and a turn on the spot is
constexpr float kMostUnit = 1e30F;  // of the stored beliefs: well below what a float holds

float narrow(double value) {
  return static_cast<float>(value);
}

std::size_t area(int cells) {
  return static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
}

/// Lowers the beliefs within the cone and the range, less at the cone's rim. In `n` columns.
SAPHIRA_WIDE void lower(float* all, long n, const std::vector<ConeRow>& cone,
                        const ColumnParts& columns, float edge, float range, float soft,
                        float doubt, float least) {
  const float square = range * range;
  for (const ConeRow& row : cone) {
    float* const beliefs = all + row.number * n + row.begin;
    const float* const x = columns.x.data() + row.begin;
    const float* const y = columns.y.data() + row.begin;
    const float row_x = row.x;
    const float row_y = row.y;
    // Some cells more, for whole steps: they are outside the cone, or their belief is the least.
    const long count = (row.end - row.begin + kLanes - 1) / kLanes * kLanes;
    for (long i = 0; i < count; ++i) {
      const float along = x[i] + row_x;
      const float across = std::abs(y[i] + row_y);
      const float rim = edge * along;
      const float sure = std::min((1.0F - across / rim) / soft, 1.0F);
      const float lowered = std::max(beliefs[i] - doubt * sure, least);
      const bool inside =
          (along > 0.0F) & (across <= rim) & (along * along + across * across <= square);
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
      beliefs_(area(settings.cells) + kLanes, 0.0F),
      held_(static_cast<std::size_t>(settings.cells)),
      words_((static_cast<std::size_t>(settings.cells) + kBits - 1) / kBits),
      marks_(words_ * static_cast<std::size_t>(settings.cells), 0),
      columns_{std::vector<float>(held_.size() + kLanes, kOutside),
               std::vector<float>(held_.size() + kLanes)} {}

void ObstacleMemory::clear() {
  placed_ = false;
  unit_ = 1.0F;
  std::fill(beliefs_.begin(), beliefs_.end(), 0.0F);
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
  const std::vector<Part> held = std::exchange(held_, std::vector<Part>(held_.size()));
  std::fill(marks_.begin(), marks_.end(), 0);
  const long n = settings_.cells;
  const auto begin = beliefs_.begin();
  const auto end = begin + n * n;
  const long by = rows * n + columns;
  if (std::abs(columns) >= n || std::abs(rows) >= n)
    std::fill(begin, end, 0.0F);
  else if (by > 0)
    std::fill(std::shift_left(begin, end, by), end, 0.0F);
  else
    std::fill(begin, std::shift_right(begin, end, -by), 0.0F);
  const Part kept{std::max(0L, -columns), std::min(n, n - columns)};
  for (long row = 0; row < n; ++row) {
    const auto to = begin + row * n;
    // The ends of the rows before or after are no part of it.
    std::fill(to, to + std::min(kept.begin, n), 0.0F);
    std::fill(to + std::max(kept.end, 0L), to + n, 0.0F);
    if (row + rows < 0 || row + rows >= n)
      continue;
    const Part& part = held[static_cast<std::size_t>(row + rows)];
    for (long column = std::max(part.begin - columns, kept.begin);
         column < std::min(part.end - columns, kept.end); ++column)
      if (to[column] > 0.0F)
        put(row, column, to[column]);
  }
}

/// Beliefs fade as the unit grows.
void ObstacleMemory::fade() {
  unit_ /= narrow(settings_.fading);
  if (unit_ < kMostUnit)
    return;
  for (float& belief : beliefs_)
    belief /= unit_;
  unit_ = 1.0F;
}

void ObstacleMemory::put(long row, long column, float belief) {
  beliefs_[index(row, column)] = belief;
  held_[static_cast<std::size_t>(row)].widen(column, column + 1);
  const auto bit = static_cast<std::size_t>(column);
  if (belief >= narrow(settings_.obstacle) * unit_)
    marks_[static_cast<std::size_t>(row) * words_ + bit / kBits] |= std::uint64_t{1}
                                                                    << (bit % kBits);
}

SAPHIRA_WIDE void ObstacleMemory::see_columns(const Pose& frame, double cosine, double sine,
                                              long begin, long end) {
  const float cell = narrow(settings_.cell);
  const float from =
      narrow((static_cast<double>(begin + column0_) + 0.5) * settings_.cell - frame.x);
  const float c = narrow(cosine);
  const float s = narrow(sine);
  float* const x = columns_.x.data() + begin;
  float* const y = columns_.y.data() + begin;
  for (int i = 0; i < static_cast<int>(end - begin); ++i) {
    const float dx = from + static_cast<float>(i) * cell;
    x[i] = c * dx;
    y[i] = -s * dx;
  }
}

SAPHIRA_WIDE void ObstacleMemory::look_along(const Pose& sonar, double range, bool only_held) {
  constexpr double kSlack = 0.1;  // [cells] against rounding
  const double cell = settings_.cell;
  const long n = settings_.cells;
  // A row's cells have their middles in its span, from the first one to before the end.
  const auto first_from = [n](double v) {
    return std::clamp(static_cast<long>(v + 0.5 - kSlack), 0L, n);
  };
  const auto end_at = [n](double v) {
    return std::clamp(static_cast<long>(v + 0.5 + kSlack), 0L, n);
  };
  const ConeRows rows(sonar, edge_, range);
  const auto [lowest, highest] = rows.rows();
  const double x = sonar.x / cell - static_cast<double>(column0_);
  const double y = sonar.y / cell - static_cast<double>(row0_);
  const long row_end = end_at(highest / cell + y);
  long first = n;
  long last = 0;
  cone_.clear();
  for (long row = first_from(lowest / cell + y); row < row_end; ++row) {
    const Part& held = held_[static_cast<std::size_t>(row)];
    if (only_held && held.begin == held.end)
      continue;
    const double dy = (static_cast<double>(row + row0_) + 0.5) * cell - sonar.y;
    const auto [low, high] = rows.span(dy);
    const long begin = first_from(low / cell + x);
    const long end = end_at(high / cell + x);
    if (begin >= end)
      continue;
    first = std::min(first, begin);
    last = std::max(last, end);
    const double dx = (static_cast<double>(begin + column0_) + 0.5) * cell - sonar.x;
    cone_.push_back(
        {row, begin, end, dx, dy, narrow(rows.sine() * dy), narrow(rows.cosine() * dy)});
  }
  see_columns(sonar, rows.cosine(), rows.sine(), first, std::min(last + kLanes, n));
}

void ObstacleMemory::pass(double range, double doubt) {
  if (cone_.empty())
    return;
  if (settings_.least >= 0.0)  // no belief falls below 0
    for (ConeRow& row : cone_) {
      const Part& held = held_[static_cast<std::size_t>(row.number)];
      row.begin = std::max(row.begin, held.begin);
      row.end = std::min(row.end, held.end);
    }
  lower(beliefs_.data(), settings_.cells, cone_, columns_, narrow(edge_), narrow(range),
        narrow(soft_), narrow(doubt) * unit_, narrow(settings_.least) * unit_);
}

void ObstacleMemory::pass(const Pose& sonar_in_odom, double range, double doubt) {
  if (range <= 0.0)
    return;
  look_along(sonar_in_odom, range, settings_.least >= 0.0);
  pass(range, doubt);
}

SAPHIRA_WIDE void ObstacleMemory::find_arc(double range) {
  const double cell = settings_.cell;
  const double inner = std::max(range - settings_.thickness - cell, 0.0);
  const float edge = narrow(edge_);
  const float arc = narrow(range);
  const float thickness = narrow(settings_.thickness);
  const float* const x = columns_.x.data();
  const float* const y = columns_.y.data();
  arc_.clear();
  for (const ConeRow& row : cone_) {
    const long count = row.end - row.begin;
    const double farthest = std::max(-row.dx, row.dx + static_cast<double>(count) * cell) + cell;
    if (farthest * farthest + row.dy * row.dy < inner * inner)
      continue;
    // The cells from `left` to `right` are nearer than the arc.
    const double half = std::sqrt(std::max(inner * inner - row.dy * row.dy, 0.0));
    const auto column = [&](double dx) {
      return row.begin + std::clamp(static_cast<long>((dx - row.dx) / cell + 0.5), 0L, count);
    };
    const long left = std::min(column(-half) + 1, row.end);
    const long right = std::max(column(half) - 1, left);
    const float* const beliefs = &beliefs_[index(row.number, 0)];
    const auto find = [&](long i, long end) {
      for (; i < end; ++i) {
        const float along = x[i] + row.x;
        const float across = std::abs(y[i] + row.y);
        const float rim = edge * along;
        if (along <= 0.0F || across > rim)
          continue;
        const float distance = std::sqrt(along * along + across * across);
        if (std::abs(distance - arc) <= thickness)
          arc_.push_back(
              {row.number, i, std::exp(beliefs[i] / unit_) * (1.0F - 0.5F * (across / rim))});
      }
    };
    find(row.begin, left);
    find(right, row.end);
  }
}

void ObstacleMemory::echo(const Pose& sonar_in_odom, double range) {
  look_along(sonar_in_odom, range + settings_.thickness, false);
  find_arc(range);
  pass(std::max(range - 2.0 * settings_.thickness, 0.0), settings_.passed);
  // The likeliest arc cell so far takes the echo in full, the others in proportion.
  const float seen = narrow(settings_.seen) * unit_;
  const float most = narrow(settings_.most) * unit_;
  float likeliest = 0.0F;
  for (const Arc& arc : arc_)
    likeliest = std::max(likeliest, arc.likely);
  for (const Arc& arc : arc_)
    put(arc.row, arc.column,
        std::min(beliefs_[index(arc.row, arc.column)] + seen * arc.likely / likeliest, most));
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
        put(row, column, narrow(settings_.most) * unit_);
    }
}

SAPHIRA_WIDE void ObstacleMemory::collect(const Pose& robot_in_odom) {
  points_.clear();
  const double c = std::cos(robot_in_odom.th);
  const double s = std::sin(robot_in_odom.th);
  see_columns(robot_in_odom, c, s, 0, settings_.cells);
  const float obstacle = narrow(settings_.obstacle) * unit_;
  const auto marked = [](std::uint64_t marks) { return marks != 0; };
  std::uint64_t* const begin = marks_.data();
  std::uint64_t* const end = begin + marks_.size();
  for (std::uint64_t* at = begin; (at = std::find_if(at, end, marked)) != end; ++at) {
    const auto number = static_cast<std::size_t>(at - begin);
    const auto row = static_cast<long>(number / words_);
    const auto column0 = static_cast<long>(number % words_ * kBits);
    const double dy = (static_cast<double>(row + row0_) + 0.5) * settings_.cell - robot_in_odom.y;
    const double row_x = s * dy;
    const double row_y = c * dy;
    const float* const beliefs = &beliefs_[index(row, column0)];
    const float* const x = columns_.x.data() + column0;
    const float* const y = columns_.y.data() + column0;
    for (std::uint64_t left = *at; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      if (beliefs[i] < obstacle)
        *at ^= left & ~(left - 1);
      else
        points_.emplace_back(x[i] + row_x, y[i] + row_y);
    }
  }
}

}  // namespace saphira::lps
