#include "saphira/logs/scan_matching.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "saphira/geometry/axes.hpp"

namespace saphira::logs {

namespace {

constexpr double kSearchCell = 0.1;    // [m] of the cells for the search of points
constexpr double kNormalsAgree = 0.7;  // cosine of the angle between normals that agree
constexpr double kFieldCell = 0.05;    // [m]
constexpr double kFieldSigma = 0.08;   // [m]
constexpr int kFieldReach = 4;         // cells

int cells_along(double length, double cell) {
  return std::max(1, static_cast<int>(std::floor(length / cell)) + 1);
}

// The normal of the surface through point i, from its neighbours on the same surface.
Vec2 normal_at(const std::vector<Vec2>& points, std::size_t i, double reach) {
  constexpr std::size_t kNeighbours = 5;
  std::array<Vec2, 2 * kNeighbours + 1> near;
  std::size_t count = 0;
  near[count++] = points[i];
  for (const bool up : {false, true}) {
    Vec2 last = points[i];
    for (std::size_t k = 1; k <= kNeighbours; ++k) {
      if (up ? i + k >= points.size() : k > i)
        break;
      const Vec2& p = points[up ? i + k : i - k];
      if ((p - points[i]).norm() > reach || (p - last).norm() > 0.6 * reach)
        break;
      near[count++] = p;
      last = p;
    }
  }
  if (count < 3)
    return Vec2::Zero();
  Vec2 mean = Vec2::Zero();
  for (std::size_t k = 0; k < count; ++k)
    mean += near[k] / static_cast<double>(count);
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < count; ++k)
    scatter += (near[k] - mean) * (near[k] - mean).transpose();
  const auto axes = principal_axes(scatter);
  if (axes.eigenvalues()[0] > 0.1 * axes.eigenvalues()[1] || axes.eigenvalues()[1] < 1e-6)
    return Vec2::Zero();
  return axes.eigenvectors().col(0);
}

}  // namespace

Scan make_scan(const std::vector<double>& ranges, const Beams& beams) {
  std::vector<Vec2> in_sensor;
  std::vector<double> used;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double range = ranges[i];
    if (!(range >= beams.min_range && range <= beams.max_range))
      continue;
    const double angle = beams.first_angle + beams.step * static_cast<double>(i);
    in_sensor.emplace_back(range * std::cos(angle), range * std::sin(angle));
    used.push_back(range);
  }
  Scan scan;
  scan.sensor = beams.sensor_in_robot.position();
  const Pose turn{0.0, 0.0, beams.sensor_in_robot.th};
  for (std::size_t i = 0; i < in_sensor.size(); ++i) {
    // The spacing of beams grows with the range: a surface 60 degrees off its normal still has
    // neighbours.
    const double reach = 0.1 + 5.0 * used[i] * beams.step;
    Vec2 normal = normal_at(in_sensor, i, reach);
    if (normal.dot(in_sensor[i]) > 0.0)
      normal = -normal;
    scan.points.push_back(transform(beams.sensor_in_robot, in_sensor[i]));
    scan.normals.push_back(transform(turn, normal));
  }
  return scan;
}

void ScanReference::add(const Scan& scan, const Pose& pose) {
  const Pose turn{0.0, 0.0, pose.th};
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    points_.push_back(transform(pose, scan.points[i]));
    normals_.push_back(transform(turn, scan.normals[i]));
  }
}

void ScanReference::arrange() {
  if (points_.empty())
    return;
  Vec2 low = points_.front();
  Vec2 high = points_.front();
  for (const Vec2& p : points_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  origin_ = low;
  columns_ = cells_along(high.x() - low.x(), kSearchCell);
  rows_ = cells_along(high.y() - low.y(), kSearchCell);
  const auto cell_of = [&](const Vec2& p) {
    return static_cast<int>((p.y() - origin_.y()) / kSearchCell) * columns_ +
           static_cast<int>((p.x() - origin_.x()) / kSearchCell);
  };
  start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const Vec2& p : points_)
    ++start_[static_cast<std::size_t>(cell_of(p)) + 1];
  for (std::size_t c = 1; c < start_.size(); ++c)
    start_[c] += start_[c - 1];
  order_.resize(points_.size());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < points_.size(); ++i)
    order_[static_cast<std::size_t>(next[static_cast<std::size_t>(cell_of(points_[i]))]++)] =
        static_cast<int>(i);
}

std::optional<std::size_t> ScanReference::nearest(const Vec2& at, const Vec2& normal,
                                                  double limit) const {
  const int column = static_cast<int>(std::floor((at.x() - origin_.x()) / kSearchCell));
  const int row = static_cast<int>(std::floor((at.y() - origin_.y()) / kSearchCell));
  const int rings = static_cast<int>(std::ceil(limit / kSearchCell));
  double best = limit * limit;
  std::optional<std::size_t> found;
  const auto look = [&](int c, int r) {
    if (c < 0 || r < 0 || c >= columns_ || r >= rows_)
      return;
    const auto cell = static_cast<std::size_t>(r * columns_ + c);
    for (int k = start_[cell]; k < start_[cell + 1]; ++k) {
      const auto i = static_cast<std::size_t>(order_[static_cast<std::size_t>(k)]);
      const double away = (points_[i] - at).squaredNorm();
      if (away < best && normals_[i].dot(normal) > kNormalsAgree) {
        best = away;
        found = i;
      }
    }
  };
  for (int ring = 0; ring <= rings; ++ring) {
    const double nearest_of_ring = (ring - 1) * kSearchCell;
    if (ring > 1 && best < nearest_of_ring * nearest_of_ring)
      break;
    for (int c = column - ring; c <= column + ring; ++c) {
      look(c, row - ring);
      if (ring > 0)
        look(c, row + ring);
    }
    for (int r = row - ring + 1; r <= row + ring - 1; ++r) {
      look(column - ring, r);
      look(column + ring, r);
    }
  }
  return found;
}

Alignment align(const ScanReference& reference, const Scan& scan, const Pose& guess,
                const AlignSettings& settings) {
  Alignment out;
  out.pose = guess;
  out.information.setZero();
  if (reference.size() == 0)
    return out;
  double gate = settings.first_gate;
  for (int iteration = 0; iteration < settings.iterations; ++iteration) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    // The robust weight's width follows the gate, so that a start with an error still converges.
    const double width = std::max(0.03, 0.3 * gate);
    const double cos_th = std::cos(out.pose.th);
    const double sin_th = std::sin(out.pose.th);
    std::size_t partners = 0;
    std::size_t countable = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vec2& n = scan.normals[i];
      if (n.isZero())
        continue;
      ++countable;
      const Vec2 turned(cos_th * scan.points[i].x() - sin_th * scan.points[i].y(),
                        sin_th * scan.points[i].x() + cos_th * scan.points[i].y());
      const Vec2 at = out.pose.position() + turned;
      const Vec2 normal(cos_th * n.x() - sin_th * n.y(), sin_th * n.x() + cos_th * n.y());
      const auto partner = reference.nearest(at, normal, gate);
      if (!partner)
        continue;
      const Vec2& line = reference.normal(*partner);
      const double off = line.dot(at - reference.point(*partner));
      const Eigen::Vector3d j(line.x(), line.y(), line.y() * turned.x() - line.x() * turned.y());
      const double weight = 1.0 / (1.0 + off * off / (width * width));
      h += weight * j * j.transpose();
      b += weight * off * j;
      squares += off * off;
      ++partners;
    }
    const double scale = 1.0 / (settings.noise * settings.noise);
    out.information = scale * h;
    out.overlap =
        countable > 0 ? static_cast<double>(partners) / static_cast<double>(countable) : 0.0;
    out.rms = partners > 0 ? std::sqrt(squares / static_cast<double>(partners)) : 0.0;
    if (partners < 10)
      return out;
    const Eigen::Vector3d from_guess(guess.x - out.pose.x, guess.y - out.pose.y,
                                     norm2_angle(guess.th - out.pose.th));
    const Eigen::Matrix3d damping = 1e-6 * scale * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = (out.information + settings.guess_information + damping)
                                     .ldlt()
                                     .solve(-scale * b + settings.guess_information * from_guess);
    out.pose.x += step.x();
    out.pose.y += step.y();
    out.pose.th = norm2_angle(out.pose.th + step.z());
    const bool still = step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5;
    if (still && gate <= settings.last_gate)
      break;
    if (iteration > 1)
      gate = std::max(settings.last_gate, 0.7 * gate);
  }
  return out;
}

ScanField::ScanField(const ScanReference& reference, int levels) {
  if (reference.size() == 0)
    return;
  Vec2 low = reference.point(0);
  Vec2 high = low;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    low = low.cwiseMin(reference.point(i));
    high = high.cwiseMax(reference.point(i));
  }
  // The border allows squares to begin outside; the kernel stays inside.
  const int border = kFieldReach + 1;
  origin_ = low - Vec2::Constant(border * kFieldCell);
  columns_ = cells_along(high.x() - low.x(), kFieldCell) + 2 * border;
  rows_ = cells_along(high.y() - low.y(), kFieldCell) + 2 * border;
  const auto size = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  std::vector<float> field(size, 0.0F);
  std::vector<float> kernel;
  for (int r = -kFieldReach; r <= kFieldReach; ++r)
    for (int c = -kFieldReach; c <= kFieldReach; ++c)
      kernel.push_back(static_cast<float>(std::exp(-0.5 * (r * r + c * c) * kFieldCell *
                                                   kFieldCell / (kFieldSigma * kFieldSigma))));
  std::vector<char> done(size, 0);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const int column = static_cast<int>((reference.point(i).x() - origin_.x()) / kFieldCell);
    const int row = static_cast<int>((reference.point(i).y() - origin_.y()) / kFieldCell);
    char& seen = done[static_cast<std::size_t>(row * columns_ + column)];
    if (seen != 0)
      continue;
    seen = 1;
    std::size_t k = 0;
    for (int r = row - kFieldReach; r <= row + kFieldReach; ++r)
      for (int c = column - kFieldReach; c <= column + kFieldReach; ++c, ++k) {
        float& cell = field[static_cast<std::size_t>(r * columns_ + c)];
        cell = std::max(cell, kernel[k]);
      }
  }
  levels_.push_back(std::move(field));
  for (int level = 1; level < levels; ++level) {
    // From four squares of half the size; outside the likelihood is 0. A square may begin up to its
    // width left of or below the field: bound() handles that by clamping.
    const std::vector<float>& finer = levels_.back();
    std::vector<float> coarse(size);
    const int half = 1 << (level - 1);
    for (int r = 0; r < rows_; ++r)
      for (int c = 0; c < columns_; ++c) {
        const auto at = [&](int cc, int rr) {
          return cc < columns_ && rr < rows_ ? finer[static_cast<std::size_t>(rr * columns_ + cc)]
                                             : 0.0F;
        };
        coarse[static_cast<std::size_t>(r * columns_ + c)] = std::max(
            std::max(at(c, r), at(c + half, r)), std::max(at(c, r + half), at(c + half, r + half)));
      }
    levels_.push_back(std::move(coarse));
  }
}

float ScanField::bound(int level, int column, int row) const {
  // A square that begins left of the field is bounded by the one that begins at its border.
  const int width = 1 << level;
  if (column <= -width || row <= -width || column >= columns_ || row >= rows_)
    return 0.0F;
  return levels_[static_cast<std::size_t>(level)]
                [static_cast<std::size_t>(std::max(row, 0) * columns_ + std::max(column, 0))];
}

double ScanField::score(const Scan& scan, const Pose& pose) const {
  if (levels_.empty() || scan.points.empty())
    return 0.0;
  double sum = 0.0;
  for (const Vec2& p : scan.points) {
    const Vec2 at = transform(pose, p) - origin_;
    sum += static_cast<double>(bound(0, static_cast<int>(std::floor(at.x() / kFieldCell)),
                                     static_cast<int>(std::floor(at.y() / kFieldCell))));
  }
  return sum / static_cast<double>(scan.points.size());
}

Eigen::Matrix2d ScanField::slack(const Scan& scan, const Pose& best, const Vec2& expected,
                                 const Eigen::Matrix2d& prior, double distance) const {
  constexpr int kLevel = 1;
  constexpr int kStep = 1 << kLevel;  // cells
  // The points of a scan are far from independent: they count as this many.
  constexpr double kIndependent = 30.0;
  if (levels_.size() <= kLevel || scan.points.empty())
    return prior;
  std::vector<std::pair<int, int>> cells;
  cells.reserve(scan.points.size());
  for (const Vec2& p : scan.points) {
    const Vec2 at = transform(best, p) - origin_;
    cells.emplace_back(static_cast<int>(std::floor(at.x() / kFieldCell)),
                       static_cast<int>(std::floor(at.y() / kFieldCell)));
  }
  const auto rate = [&](int dc, int dr) {
    float sum = 0.0F;
    for (const auto& [column, row] : cells)
      sum += bound(kLevel, column + dc, row + dr);
    return static_cast<double>(sum) / static_cast<double>(cells.size());
  };
  const Eigen::Matrix2d information = prior.inverse();
  const Vec2 off = best.position() - expected;
  const double top = rate(0, 0);
  const double here = 0.5 * off.dot(information * off);
  const int reach = static_cast<int>(std::ceil(distance / (kFieldCell * kStep)));
  double weights = 0.0;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (int r = -reach; r <= reach; ++r)
    for (int c = -reach; c <= reach; ++c) {
      const Vec2 by(kStep * kFieldCell * c, kStep * kFieldCell * r);
      const double less = 0.5 * (off + by).dot(information * (off + by)) - here;
      if (less > 8.0)
        continue;
      const double weight = std::exp(
          std::min(0.0, kIndependent * (rate(kStep * c, kStep * r) - top)) - std::max(0.0, less));
      weights += weight;
      sum += weight * by * by.transpose();
    }
  return sum / weights;
}

Sight look_at(const Scan& scan, const std::vector<Vec2>& points) {
  constexpr double kSame = 0.2;        // [m]
  constexpr std::size_t kBeside = 2;   // beams to each side
  constexpr double kGap = radians(5);  // the laser sees through wider ones
  struct Beam {
    double angle;
    double range;
  };
  std::vector<Beam> beams;
  beams.reserve(scan.points.size());
  for (const Vec2& p : scan.points) {
    const Vec2 off = p - scan.sensor;
    beams.push_back({std::atan2(off.y(), off.x()), off.norm()});
  }
  const auto before = [](const Beam& a, const Beam& b) { return a.angle < b.angle; };
  std::sort(beams.begin(), beams.end(), before);
  Sight out;
  for (const Vec2& p : points) {
    const Vec2 off = p - scan.sensor;
    const Beam to{std::atan2(off.y(), off.x()), off.norm()};
    const auto after = static_cast<std::size_t>(
        std::lower_bound(beams.begin(), beams.end(), to, before) - beams.begin());
    if (after < kBeside || after + kBeside > beams.size() ||
        beams[after + kBeside - 1].angle - beams[after - kBeside].angle > kGap)
      continue;
    double nearest = beams[after].range;
    double farthest = nearest;
    for (std::size_t i = after - kBeside; i < after + kBeside; ++i) {
      nearest = std::min(nearest, beams[i].range);
      farthest = std::max(farthest, beams[i].range);
    }
    if (to.range < nearest - kSame)
      ++out.through;
    else if (to.range < farthest + kSame)
      ++out.agree;
  }
  return out;
}

std::optional<SearchResult> ScanField::search(const Scan& scan, const Pose& guess,
                                              const SearchWindow& window, double at_least) const {
  if (levels_.empty() || scan.points.empty())
    return std::nullopt;
  struct Candidate {
    int turn;
    int column;
    int row;
    double score;
  };
  struct Cell {
    int column;
    int row;
  };
  const int turns = static_cast<int>(std::floor(window.turn / window.turn_step));
  const int reach = static_cast<int>(std::ceil(window.distance / kFieldCell));
  std::vector<std::vector<Cell>> turned(static_cast<std::size_t>(2 * turns + 1));
  for (int t = -turns; t <= turns; ++t) {
    const Pose pose{guess.x, guess.y, guess.th + t * window.turn_step};
    auto& cells = turned[static_cast<std::size_t>(t + turns)];
    cells.reserve(scan.points.size());
    for (const Vec2& p : scan.points) {
      const Vec2 at = transform(pose, p) - origin_;
      cells.push_back({static_cast<int>(std::floor(at.x() / kFieldCell)),
                       static_cast<int>(std::floor(at.y() / kFieldCell))});
    }
  }
  const auto rate = [&](int level, int t, int column, int row) {
    float sum = 0.0F;
    for (const Cell& cell : turned[static_cast<std::size_t>(t)])
      sum += bound(level, cell.column + column, cell.row + row);
    return static_cast<double>(sum) / static_cast<double>(scan.points.size());
  };
  const auto better = [](const Candidate& a, const Candidate& b) {
    return std::tie(b.score, a.turn, a.column, a.row) < std::tie(a.score, b.turn, b.column, b.row);
  };
  int top = 0;
  while (top + 1 < static_cast<int>(levels_.size()) && (1 << top) < reach)
    ++top;
  std::vector<Candidate> roots;
  for (int t = 0; t <= 2 * turns; ++t)
    for (int c = -reach; c <= reach; c += 1 << top)
      for (int r = -reach; r <= reach; r += 1 << top) {
        const double score = rate(top, t, c, r);
        if (score > at_least)
          roots.push_back({t, c, r, score});
      }
  std::sort(roots.begin(), roots.end(), better);
  std::optional<Candidate> best;
  double limit = at_least;
  const auto descend = [&](auto&& self, const Candidate& from, int level) -> void {
    if (from.score <= limit)
      return;
    if (level == 0) {
      best = from;
      limit = from.score;
      return;
    }
    const int half = 1 << (level - 1);
    std::array<Candidate, 4> parts{};
    std::size_t k = 0;
    for (const int dc : {0, half})
      for (const int dr : {0, half}) {
        Candidate& part = parts[k++];
        part = {from.turn, from.column + dc, from.row + dr, 0.0};
        if (part.column <= reach && part.row <= reach)
          part.score = rate(level - 1, part.turn, part.column, part.row);
      }
    std::sort(parts.begin(), parts.end(), better);
    for (const Candidate& part : parts)
      self(self, part, level - 1);
  };
  for (const Candidate& root : roots)
    descend(descend, root, top);
  if (!best)
    return std::nullopt;
  return SearchResult{{guess.x + best->column * kFieldCell, guess.y + best->row * kFieldCell,
                       norm2_angle(guess.th + (best->turn - turns) * window.turn_step)},
                      best->score};
}

}  // namespace saphira::logs
