#include "saphira/authority/approaches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saphira::authority {

namespace {

constexpr double kCycle = 0.1;            // [s]
constexpr std::uint64_t kApart = 5;       // [cycles] two firings are no farther apart
constexpr std::uint64_t kComes = 10;      // [cycles] it is taken to come on for so long...
constexpr std::uint64_t kAlarm = 50;      // [cycles] ...and to stand there until the alarm ends
constexpr std::uint64_t kPause = 20;      // [cycles] between two alarms
constexpr double kFarthest = 2.5;         // [m]
constexpr double kSlowest = 0.6;          // [m/s]
constexpr double kFastest = 2.5;          // [m/s] what is faster is another thing
constexpr double kTurned = radians(6.0);  // a sonar that turned more hears another thing
// An echo that comes and goes at one place, as that of a wall at a slant does, is no news.
constexpr std::uint64_t kFlickers = 25;  // [cycles]
constexpr double kSame = 0.2;            // [m] so near to what is known it is no other thing

}  // namespace

void Approaches::clear() {
  fired_.clear();
  came_.clear();
  noticed_.clear();
  began_ = 0;
}

void Approaches::hear(std::uint64_t cycle, const Pose& robot_in_odom, const Reading& reading,
                      const std::vector<Vec2>& known_in_robot) {
  const Firing now{cycle, compose(robot_in_odom, reading.sonar_in_robot), reading.range};
  const Firing before = std::exchange(fired_[reading.sonar], now);
  if (!before.range || !now.range || *now.range > kFarthest || now.cycle <= before.cycle ||
      now.cycle > before.cycle + kApart ||
      std::abs(norm2_angle(now.sonar_in_odom.th - before.sonar_in_odom.th)) > kTurned)
    return;
  const double own = (now.sonar_in_odom.position() - before.sonar_in_odom.position())
                         .dot(before.sonar_in_odom.direction());
  const double closing =
      (*before.range - own - *now.range) / (kCycle * static_cast<double>(now.cycle - before.cycle));
  if (closing < kSlowest || closing > kFastest)
    return;
  const Vec2 at_in_robot = transform(reading.sonar_in_robot, Vec2(*now.range, 0.0));
  const Vec2 at_in_odom = transform(robot_in_odom, at_in_robot);
  if (std::any_of(known_in_robot.begin(), known_in_robot.end(),
                  [&](const Vec2& known) { return (known - at_in_robot).norm() < kSame; }))
    return;
  while (!noticed_.empty() && cycle > noticed_.front().cycle + kFlickers)
    noticed_.pop_front();
  const bool again = std::any_of(noticed_.begin(), noticed_.end(), [&](const Came& other) {
    return (other.at_in_odom - at_in_odom).norm() < kSame;
  });
  noticed_.push_back({cycle, at_in_odom, closing});
  // Echoes that mislead do not hold the robot for ever: between two alarms it may drive.
  if (again || (cycle > began_ + kAlarm && cycle < began_ + kAlarm + kPause && began_ > 0))
    return;
  if (began_ == 0 || cycle > began_ + kAlarm)
    began_ = cycle;
  came_[reading.sonar] = noticed_.back();
}

std::vector<Approach> Approaches::now(std::uint64_t cycle, const Pose& robot_in_odom) const {
  std::vector<Approach> coming;
  if (cycle > began_ + kAlarm)
    return coming;
  for (const auto& [sonar, came] : came_) {
    if (came.cycle < began_)
      continue;
    const Vec2 at = to_frame(robot_in_odom, came.at_in_odom);
    const std::uint64_t cycles = std::min(cycle - came.cycle, kComes);
    const double way = came.closing * kCycle * static_cast<double>(cycles);
    coming.push_back({at * std::max(0.0, 1.0 - way / std::max(at.norm(), way)),
                      cycle > came.cycle + kComes ? 0.0 : came.closing});
  }
  return coming;
}

}  // namespace saphira::authority
