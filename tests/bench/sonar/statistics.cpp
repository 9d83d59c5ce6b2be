#include "statistics.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::bench {

namespace {

constexpr double kToDeviation = 1.4826;  // from the median of absolute values, if they are normal

double median(std::vector<double> values) {
  if (values.empty())
    return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Least squares through the points, repeated without outliers: the limit is far below the error of
// a reflection from another object.
Line robust_line(std::vector<Vec2> points) {
  Line line;
  for (int round = 0; round < 10 && points.size() > 2; ++round) {
    Vec2 mean(0.0, 0.0);
    for (const Vec2& p : points)
      mean += p / static_cast<double>(points.size());
    double sxx = 0.0;
    double sxy = 0.0;
    for (const Vec2& p : points) {
      sxx += (p.x() - mean.x()) * (p.x() - mean.x());
      sxy += (p.x() - mean.x()) * (p.y() - mean.y());
    }
    line.slope = sxy / sxx;
    line.offset = mean.y() - line.slope * mean.x();
    std::vector<double> off;
    double squares = 0.0;
    for (const Vec2& p : points) {
      off.push_back(std::abs(p.y() - line.at(p.x()).y()));
      squares += off.back() * off.back();
    }
    line.rms = std::sqrt(squares / static_cast<double>(points.size()));
    const double limit = std::max(0.05, 3.0 * kToDeviation * median(off));
    const std::size_t before = points.size();
    std::erase_if(points,
                  [&](const Vec2& p) { return std::abs(p.y() - line.at(p.x()).y()) > limit; });
    if (points.size() == before)
      break;
  }
  return line;
}

Vec2 reading_in_odom(const CorridorRecord& record, std::size_t sonar) {
  const double at = record.pose_in_odom.th + kCorridorBearings[sonar];
  return record.pose_in_odom.position() + record.ranges[sonar] * Vec2(std::cos(at), std::sin(at));
}

bool is_side(std::size_t sonar) {
  return sonar == 0 || sonar == 7;
}

bool none(double range) {
  return range > kCorridorNoEcho;
}

}  // namespace

std::vector<RangeBin> range_bins(const std::vector<Calibration>& readings) {
  constexpr double kBin = 0.5;
  constexpr double kOutlier = 0.1;
  // A sensor's constant error grows with the range; the noise is the deviation from a line.
  std::vector<Vec2> inliers;
  for (const Calibration& r : readings)
    if (std::abs(r.reading - r.truth) < kOutlier)
      inliers.emplace_back(r.truth, r.reading);
  const Line line = robust_line(inliers);
  std::map<int, std::vector<Calibration>> bins;
  for (const Calibration& r : readings)
    bins[static_cast<int>(std::floor(r.truth / kBin))].push_back(r);
  std::vector<RangeBin> out;
  for (const auto& [bin, in_bin] : bins) {
    std::vector<double> errors;
    std::vector<double> off;
    for (const Calibration& r : in_bin) {
      if (std::abs(r.reading - r.truth) > kOutlier)
        continue;
      errors.push_back(r.reading - r.truth);
      off.push_back(r.reading - line.at(r.truth).y());
    }
    const double middle = median(off);
    for (double& o : off)
      o = std::abs(o - middle);
    const auto count = static_cast<double>(in_bin.size());
    out.push_back({(bin + 0.5) * kBin, median(errors), kToDeviation * median(off),
                   1.0 - static_cast<double>(errors.size()) / count, in_bin.size()});
  }
  return out;
}

double Line::distance(const Vec2& point) const {
  return std::abs(point.y() - at(point.x()).y()) / std::hypot(1.0, slope);
}

std::vector<CorridorRecord> straight_part(const std::vector<CorridorRecord>& records) {
  std::vector<CorridorRecord> out;
  for (const CorridorRecord& record : records) {
    const Pose& pose = record.pose_in_odom;
    if (pose.x > 0.03 && pose.x < 8.8 && std::abs(pose.th) < radians(12.0))
      out.push_back(record);
  }
  return out;
}

Corridor fit_corridor(const std::vector<CorridorRecord>& straight) {
  Corridor corridor;
  for (const std::size_t side : {std::size_t{0}, std::size_t{7}}) {
    std::vector<Vec2> points;
    for (const CorridorRecord& record : straight)
      if (!none(record.ranges[side]))
        points.push_back(reading_in_odom(record, side));
    (side == 0 ? corridor.right : corridor.left) = robust_line(points);
  }
  // The place along its wall for each new reading of an oblique sonar, if the wall made it.
  constexpr double kGap = 0.15;
  constexpr std::size_t kLeast = 4;
  for (const bool right : {true, false}) {
    const Line& wall = right ? corridor.right : corridor.left;
    std::vector<double> along;
    for (std::size_t sonar = right ? 1 : 4; sonar < (right ? 4U : 7U); ++sonar) {
      double last = -1.0;
      for (const CorridorRecord& record : straight) {
        const double range = record.ranges[sonar];
        const double away = wall.distance(record.pose_in_odom.position());
        if (range != last && !none(range) && range > away)
          along.push_back(record.pose_in_odom.x + std::sqrt(range * range - away * away));
        last = range;
      }
    }
    std::sort(along.begin(), along.end());
    for (std::size_t begin = 0; begin < along.size();) {
      std::size_t end = begin + 1;
      while (end < along.size() && along[end] - along[end - 1] < kGap)
        ++end;
      if (end - begin >= kLeast)
        corridor.posts.push_back(wall.at(along[begin + (end - begin) / 2]));
      begin = end;
    }
  }
  return corridor;
}

sim::World to_world(const Corridor& corridor) {
  constexpr double kHalfPost = 0.02;
  constexpr double kDepth = 0.04;
  constexpr double kFrom = -4.0;
  constexpr double kTo = 20.0;
  const Vec2 shift(kCorridorShift, kCorridorShift);
  sim::World world;
  world.file = "corridor";
  world.width = world.height = 30.0;
  for (const bool right : {true, false}) {
    const Line& wall = right ? corridor.right : corridor.left;
    const Vec2 inwards(0.0, right ? kDepth : -kDepth);
    std::vector<double> posts;
    for (const Vec2& post : corridor.posts)
      if (wall.distance(post) < 1e-6)
        posts.push_back(post.x());
    std::sort(posts.begin(), posts.end());
    std::vector<Vec2> outline{wall.at(kFrom)};
    for (const double x : posts) {
      outline.push_back(wall.at(x - kHalfPost));
      outline.emplace_back(wall.at(x - kHalfPost) + inwards);
      outline.emplace_back(wall.at(x + kHalfPost) + inwards);
      outline.push_back(wall.at(x + kHalfPost));
    }
    outline.push_back(wall.at(kTo));
    for (std::size_t i = 1; i < outline.size(); ++i)
      world.segments.push_back({outline[i - 1] + shift, outline[i] + shift});
  }
  world.corners = sim::find_corners(world.segments);
  return world;
}

CorridorStatistics corridor_statistics(const std::vector<CorridorRecord>& straight,
                                       const Corridor& corridor) {
  constexpr double kMatch = 0.15;            // [m] tolerance for a reading of a post
  constexpr double kLobeBin = radians(4.0);  // off axis
  constexpr double kHalfCone = radians(15.0);
  CorridorStatistics out;
  double squares = 0.0;
  double side = 0.0;
  double side_none = 0.0;
  double oblique = 0.0;
  for (const CorridorRecord& record : straight) {
    const Pose& pose = record.pose_in_odom;
    for (std::size_t sonar = 0; sonar < 8; ++sonar) {
      const double range = record.ranges[sonar];
      const Line& wall = sonar < 4 ? corridor.right : corridor.left;
      if (is_side(sonar)) {
        side += 1.0;
        if (none(range)) {
          side_none += 1.0;
        } else if (const double off = wall.distance(reading_in_odom(record, sonar)); off < 0.3) {
          squares += off * off;
        }
        continue;
      }
      oblique += 1.0;
      bool of_post = false;
      for (const Vec2& post : corridor.posts) {
        const Vec2 seen = to_frame(pose, post);
        const double off = norm2_angle(std::atan2(seen.y(), seen.x()) - kCorridorBearings[sonar]);
        const double away = seen.norm();
        if (std::abs(off) > radians(40.0) || away > 4.8)
          continue;
        const bool match = std::abs(range - away) < kMatch;
        of_post |= match && std::abs(off) < radians(25.0);
        if (range < away - kMatch)
          continue;  // a nearer object was heard: no evidence about this one
        Heard& heard = out.lobe[static_cast<int>(std::lround(off / kLobeBin))];
        (match ? heard.yes : heard.no) += 1;
      }
      const double away = wall.distance(pose.position());
      const double angle =
          std::abs(pose.th + kCorridorBearings[sonar] - std::atan(wall.slope));  // to the wall
      const double nearest = away / std::sin(angle + kHalfCone);
      const double farthest = angle < radians(9.0) ? 5.0 : away / std::sin(angle);
      if (none(range))
        out.oblique_none += 1.0;
      else if (of_post)
        out.oblique_post += 1.0;
      else if (range > nearest - 0.05 && range < farthest + 0.05)
        out.oblique_wall += 1.0;
      else
        out.oblique_other += 1.0;
    }
  }
  for (double* share :
       {&out.oblique_none, &out.oblique_post, &out.oblique_wall, &out.oblique_other})
    *share /= std::max(1.0, oblique);
  out.side_none = side_none / std::max(1.0, side);
  out.side_rms = std::sqrt(squares / std::max(1.0, side - side_none));
  // From the axis outwards, both sides together.
  double before = 1.0;
  for (int bin = 0; bin < 10; ++bin) {
    Heard both;
    for (const int side_bin : {bin, -bin})
      if (const auto found = out.lobe.find(side_bin); found != out.lobe.end()) {
        both.yes += found->second.yes;
        both.no += found->second.no;
      }
    if (both.yes + both.no > 0 && both.share() < 0.5) {
      out.half_width =
          kLobeBin * (bin - (0.5 - both.share()) / std::max(0.01, before - both.share()));
      break;
    }
    before = both.share();
  }
  return out;
}

RingStatistics ring_statistics(const std::vector<std::array<double, kRing>>& rings) {
  RingStatistics out;
  for (const auto& ring : rings) {
    const auto nearest =
        static_cast<std::size_t>(std::min_element(ring.begin(), ring.end()) - ring.begin());
    const double wall = ring[nearest];
    if (wall < kRingNear || wall > kRingFar)
      continue;
    ++out.rings;
    for (std::size_t offset = 0; offset < out.beside.size(); ++offset)
      for (const std::size_t k : {(nearest + offset) % kRing, (nearest + kRing - offset) % kRing}) {
        const double angle = radians(15.0) * static_cast<double>(offset);
        const double square = wall + kRingRadius * (1.0 - std::cos(angle));
        const double axis = square / std::cos(angle);
        RingShare& share = out.beside[offset];
        if (ring[k] > kRingNoEcho)
          share.none += 0.5;
        else if (std::abs(ring[k] - square) < 0.03 + 0.05 * square)
          share.wall += 0.5;
        else if (std::abs(ring[k] - axis) < 0.03 + 0.05 * axis)
          share.axis += 0.5;
        else
          share.other += 0.5;
      }
  }
  for (RingShare& share : out.beside)
    for (double* value : {&share.wall, &share.axis, &share.none, &share.other})
      *value /= std::max(1.0, static_cast<double>(out.rings));
  std::vector<double> second;
  for (std::size_t i = 2; i < rings.size(); ++i)
    for (std::size_t k = 0; k < kRing; ++k) {
      const double a = rings[i - 2][k];
      const double b = rings[i - 1][k];
      const double c = rings[i][k];
      if (std::max({a, b, c}) < kRingNoEcho)
        second.push_back(std::abs(a - 2.0 * b + c) / std::sqrt(6.0));
    }
  out.deviation = kToDeviation * median(second);
  return out;
}

}  // namespace saphira::bench
