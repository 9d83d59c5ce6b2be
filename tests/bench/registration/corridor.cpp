#include "corridor.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "../sonar/statistics.hpp"
#include "saphira/interpretation/interpretation.hpp"

namespace saphira::bench {

namespace {

constexpr double kGapFrom = 3.81;
constexpr double kGapTo = 4.54;

}  // namespace

CorridorFindings interpret_corridor(const std::vector<CorridorRecord>& records) {
  interpretation::Settings settings;
  for (std::size_t i = 0; i < kCorridorBearings.size(); ++i)
    settings.sonars.push_back({static_cast<int>(i), {0.0, 0.0, kCorridorBearings[i]}});
  interpretation::Interpretation interpretation(settings);
  std::map<std::uint32_t, lps::Percept> found;
  std::uint64_t cycle = 0;
  const auto straight = straight_part(records);
  for (const CorridorRecord& record : straight) {
    std::vector<lps::SonarReading> readings;
    for (std::size_t i = 0; i < record.ranges.size(); ++i)
      readings.push_back(
          {static_cast<int>(i), record.ranges[i], record.ranges[i] <= kCorridorNoEcho});
    // About four records a second.
    cycle += 2;
    for (const lps::Percept& percept :
         interpretation.step({cycle, record.pose_in_odom, readings}).percepts)
      found[percept.id] = percept;
  }

  const Corridor truth = fit_corridor(straight);
  CorridorFindings out;
  double left_length = 0.0;
  double right_length = 0.0;
  double confidence = 0.0;
  bool best_gap = false;
  for (const auto& [id, p] : found) {
    out.percepts.push_back(p);
    const double x = p.pose_in_odom.x;
    const double off_left = p.pose_in_odom.y - truth.left.at(x).y();
    const double off_right = p.pose_in_odom.y - truth.right.at(x).y();
    if (p.type == lps::PointType::wall) {
      if (std::abs(off_left) < 0.15 && p.length > left_length) {
        left_length = p.length;
        out.left_offset = off_left;
      }
      if (std::abs(off_right) < 0.15 && p.length > right_length) {
        right_length = p.length;
        out.right_offset = off_right;
      }
      ++(std::min(std::abs(off_left), std::abs(off_right)) < 0.15 ? out.walls : out.other_walls);
    } else if (p.type == lps::PointType::corridor) {
      ++out.corridors;
      if (p.confidence >= confidence) {
        confidence = p.confidence;
        out.width = p.width;
      }
    } else if (p.type == lps::PointType::door || p.type == lps::PointType::junction) {
      const double centre = x - 0.5 * (kGapFrom + kGapTo);
      if (std::abs(off_left) < 0.3 && std::abs(centre) < 0.5) {
        if (!best_gap || std::abs(centre) < std::abs(out.gap_centre_error)) {
          out.gap_centre_error = centre;
          out.gap_width_error = p.width - (kGapTo - kGapFrom);
        }
        best_gap = out.gap_found = true;
      } else {
        ++out.other_openings;
      }
    } else if (p.type == lps::PointType::breach) {
      const double to_end = std::min(std::abs(x - kGapFrom), std::abs(x - kGapTo));
      if (std::abs(off_left) < 0.3 && to_end < 0.3)
        ++out.gap_ends;
    }
  }
  return out;
}

}  // namespace saphira::bench
