#include "corridor.hpp"

#include <cmath>
#include <map>

#include "saphira/interpretation/interpretation.hpp"

namespace saphira::bench {

namespace {

constexpr double kGapMiddle = -6.24;  // [m] y
constexpr double kGapWidth = 0.73;
constexpr double kAlong = radians(-87.0);  // the second corridor's heading

// x of a wall of the second corridor by its y: least squares over the side sonar's echoes near it.
struct WallFit {
  double slope = 0.0;
  double offset = 0.0;
  double x(double y) const { return offset + slope * y; }
};

WallFit fit(const std::vector<CorridorRecord>& records, std::size_t sonar, double about) {
  double n = 0.0;
  double sy = 0.0;
  double sx = 0.0;
  double syy = 0.0;
  double sxy = 0.0;
  for (const CorridorRecord& record : records) {
    const double at = record.pose_in_odom.th + kCorridorBearings[sonar];
    const Vec2 echo =
        record.pose_in_odom.position() + record.ranges[sonar] * Vec2(std::cos(at), std::sin(at));
    if (record.ranges[sonar] > kCorridorNoEcho || std::abs(echo.x() - about) > 0.12 ||
        std::abs(norm2_angle(record.pose_in_odom.th - kAlong)) > radians(6.0))
      continue;
    n += 1.0;
    sy += echo.y();
    sx += echo.x();
    syy += echo.y() * echo.y();
    sxy += echo.x() * echo.y();
  }
  WallFit wall;
  wall.slope = (n * sxy - sx * sy) / (n * syy - sy * sy);
  wall.offset = (sx - wall.slope * sy) / n;
  return wall;
}

}  // namespace

CorridorFindings interpret_corridor(const std::vector<CorridorRecord>& records) {
  interpretation::Settings settings;
  for (std::size_t i = 0; i < kCorridorBearings.size(); ++i)
    settings.sonars.push_back({static_cast<int>(i), {0.0, 0.0, kCorridorBearings[i]}});
  interpretation::Interpretation interpretation(settings);
  std::map<std::uint32_t, lps::Percept> found;
  std::uint64_t cycle = 0;
  for (const CorridorRecord& record : records) {
    std::vector<lps::SonarReading> readings;
    for (std::size_t i = 0; i < record.ranges.size(); ++i)
      readings.push_back(
          {static_cast<int>(i), record.ranges[i], record.ranges[i] <= kCorridorNoEcho});
    cycle += 2;  // about four records a second
    for (const lps::Percept& percept :
         interpretation.step({cycle, record.pose_in_odom, readings}).percepts)
      found[percept.id] = percept;
  }

  const WallFit left = fit(records, 7, 17.42);
  const WallFit right = fit(records, 0, 15.32);
  CorridorFindings out;
  double left_length = 0.0;
  double right_length = 0.0;
  double width_off = 1e9;
  for (const auto& [id, p] : found) {
    out.percepts.push_back(p);
    const Pose& at = p.pose_in_odom;
    if (at.y > -3.0)
      continue;
    const double off_left = at.x - left.x(at.y);
    const double off_right = at.x - right.x(at.y);
    if (p.type == lps::PointType::wall) {
      if (std::abs(off_left) < 0.15 && p.length > left_length) {
        left_length = p.length;
        out.left_offset = off_left;
      }
      if (std::abs(off_right) < 0.15 && p.length > right_length) {
        right_length = p.length;
        out.right_offset = off_right;
      }
      out.walls += std::min(std::abs(off_left), std::abs(off_right)) < 0.15 ? 1U : 0U;
    } else if (p.type == lps::PointType::corridor) {
      // It is narrower before the gap, where an object stands along the right wall.
      ++out.corridors;
      const double off = std::abs(p.width - (left.x(at.y) - right.x(at.y)));
      if (off < width_off) {
        width_off = off;
        out.width = p.width;
      }
    } else if (p.type == lps::PointType::door || p.type == lps::PointType::junction) {
      const double centre = at.y - kGapMiddle;
      if (std::abs(off_left) < 0.3 && std::abs(centre) < 0.5) {
        if (!out.gap_found || std::abs(centre) < std::abs(out.gap_centre_error)) {
          out.gap_centre_error = centre;
          out.gap_width_error = p.width - kGapWidth;
        }
        out.gap_found = true;
      } else {
        ++out.other_openings;
      }
    } else if (p.type == lps::PointType::breach && std::abs(off_left) < 0.3 &&
               std::abs(std::abs(at.y - kGapMiddle) - 0.5 * kGapWidth) < 0.3) {
      ++out.gap_ends;
    }
  }
  return out;
}

}  // namespace saphira::bench
