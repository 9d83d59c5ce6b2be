#include "saphira/registration/standing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saphira::registration {
namespace {

/// [rad] The narrowest angle that has all of these directions in it.
double angle_of(std::vector<double> directions) {
  std::sort(directions.begin(), directions.end());
  double gap = 0.0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const bool last = i + 1 == directions.size();
    gap =
        std::max(gap, (last ? directions.front() + 2.0 * kPi : directions[i + 1]) - directions[i]);
  }
  return 2.0 * kPi - gap;
}

}  // namespace

bool Standing::step(const Pose& moved, const std::vector<PlacedReading>& readings) {
  way_ = compose(way_, moved);
  if (way_.position().norm() > settings_.moved ||
      std::abs(norm2_angle(way_.th)) > settings_.turned) {
    forget();
    return false;
  }
  for (const PlacedReading& reading : readings) {
    Sonar& heard = sonars_[reading.sonar];
    heard.direction = norm2_angle(reading.sensor_in_odom.th);
    const double range =
        reading.echo ? std::min(reading.range, settings_.silence) : settings_.silence;
    if (heard.ranges.size() < static_cast<std::size_t>(settings_.learnt)) {
      heard.ranges.push_back(range);
      continue;
    }
    const bool known = std::any_of(heard.ranges.begin(), heard.ranges.end(), [&](double each) {
      return std::abs(each - range) < settings_.same;
    });
    heard.strange = known ? 0 : heard.strange + 1;
    if (heard.strange > settings_.accepted)
      heard = {heard.direction, {}, 0};
  }
  std::size_t known = 0;
  std::vector<double> changed;
  for (const auto& [sonar, heard] : sonars_) {
    known += heard.ranges.size() == static_cast<std::size_t>(settings_.learnt) ? 1 : 0;
    if (heard.strange >= settings_.changed)
      changed.push_back(heard.direction);
  }
  if (changed.size() < static_cast<std::size_t>(settings_.least) ||
      static_cast<double>(changed.size()) < settings_.share * static_cast<double>(known) ||
      angle_of(std::move(changed)) < settings_.around)
    return false;
  sonars_.clear();
  return true;
}

}  // namespace saphira::registration
