#include "saphira/registration/standing.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::registration {

bool Standing::step(const Pose& moved, const std::vector<lps::SonarReading>& readings) {
  way_ = compose(way_, moved);
  if (way_.position().norm() > settings_.moved ||
      std::abs(norm2_angle(way_.th)) > settings_.turned) {
    way_ = {};
    sonars_.clear();
    return false;
  }
  for (const lps::SonarReading& reading : readings) {
    Heard& heard = sonars_[reading.sonar];
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
      heard = {};
  }
  std::size_t known = 0;
  std::size_t changed = 0;
  for (const auto& [sonar, heard] : sonars_) {
    known += heard.ranges.size() == static_cast<std::size_t>(settings_.learnt) ? 1 : 0;
    changed += heard.strange >= settings_.changed ? 1 : 0;
  }
  if (changed < static_cast<std::size_t>(settings_.least) ||
      static_cast<double>(changed) < settings_.share * static_cast<double>(known))
    return false;
  sonars_.clear();
  return true;
}

}  // namespace saphira::registration
