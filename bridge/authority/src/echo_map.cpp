#include "saphira/authority/echo_map.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::authority {

namespace {

constexpr double kTowards = radians(60.0);
constexpr std::uint64_t kTurnCycles = 10;
constexpr double kMatters = 2.5;            // [m] no echo from farther away
constexpr std::uint64_t kRemembered = 150;  // [cycles] the memory has forgotten older echoes
constexpr double kCone = lps::MemorySettings{}.beam + radians(1.0);  // [rad] half angle
constexpr double kThickness = 0.1;  // [m] of the arc, with half a cell of the memory

/// A robot may take ten seconds past a person whose echo has ended. A person may step into a space
/// that was free, so free space does not make an echo less believable.
lps::MemorySettings cautious_memory() {
  lps::MemorySettings settings;
  settings.least = 0.0;
  settings.fading = 0.985;
  return settings;
}

}  // namespace

EchoMap::EchoMap(double sonar_range)
    : range_(std::min(sonar_range, kMatters)), memory_(lps::for_range(range_, cautious_memory())) {}

void EchoMap::clear() {
  memory_.clear();
  echoes_.clear();
  fired_ahead_ = 0;
  fired_behind_ = 0;
}

void EchoMap::update(std::uint64_t cycle, const Pose& robot_in_odom,
                     const std::vector<Reading>& readings) {
  memory_.move_to(robot_in_odom);
  robot_in_odom_ = robot_in_odom;
  cycle_ = cycle;
  while (!echoes_.empty() && echoes_.front().cycle + kRemembered < cycle)
    echoes_.pop_front();
  for (const Reading& reading : readings) {
    if (std::abs(norm2_angle(reading.sonar_in_robot.th)) < kTowards)
      fired_ahead_ = cycle;
    if (std::abs(norm2_angle(reading.sonar_in_robot.th + kPi)) < kTowards)
      fired_behind_ = cycle;
    const Pose sonar_in_odom = compose(robot_in_odom, reading.sonar_in_robot);
    if (reading.range && *reading.range <= range_) {
      memory_.echo(sonar_in_odom, *reading.range);
      echoes_.push_back({reading.sonar, sonar_in_odom, *reading.range, cycle});
    } else {
      memory_.silence(sonar_in_odom);
    }
  }
  memory_.collect(robot_in_odom);
}

std::optional<EchoMap::Heard> EchoMap::heard(const Vec2& spot) const {
  const Vec2 in_odom = compose(robot_in_odom_, {spot.x(), spot.y(), 0.0}).position();
  for (auto echo = echoes_.rbegin(); echo != echoes_.rend(); ++echo) {
    const Vec2 from_sonar = to_frame(echo->sonar_in_odom, in_odom);
    const double distance = from_sonar.norm();
    if (std::abs(distance - echo->range) <= kThickness &&
        std::abs(std::atan2(from_sonar.y(), from_sonar.x())) <= kCone)
      return Heard{echo->sonar, cycle_ - std::min(cycle_, echo->cycle)};
  }
  return std::nullopt;
}

bool EchoMap::sees(std::uint64_t cycle, bool ahead) const {
  return cycle <= (ahead ? fired_ahead_ : fired_behind_) + kTurnCycles;
}

}  // namespace saphira::authority
