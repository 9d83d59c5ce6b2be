#include "saphira/authority/echo_map.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::authority {

namespace {

constexpr double kTowards = radians(60.0);
constexpr std::uint64_t kTurnCycles = 10;
constexpr double kMatters = 2.5;            // [m] no echo from farther away
constexpr std::uint64_t kRemembered = 150;  // [cycles] older firings are not named
constexpr double kCone = lps::MemorySettings{}.beam + radians(1.0);  // [rad] half angle
constexpr double kThickness = 0.1;  // [m] of the arc, with half a cell of the memory

// A post may be heard in a side lobe. A slanting wall is heard from its nearest point in the lobes
// to its nearest point about the axis. Both to the error of the robot's place on the map.
const double kLobes = std::tan(radians(40.0));
const double kAboutAxis = std::tan(radians(20.0));
constexpr double kOnEdge = 0.12;  // [m]

/// A person whom no beam looks at any more is still there while the robot stands. A moving one may
/// take ten seconds past him. He may step into a space that was free, so free space does not make
/// an echo less believable.
lps::MemorySettings cautious_memory() {
  return lps::MemorySettings{.least = 0.0, .fading = 0.985, .keeps_at_rest = true};
}

/// True where the edge, in the sonar's frame, may have caused the echo.
bool is_of(const Edge& edge, double range) {
  const auto nearest = distance_in_cone(edge, kLobes);
  return nearest && range >= *nearest - kOnEdge &&
         range <= distance_in_cone(edge, kAboutAxis).value_or(*nearest) + kOnEdge;
}

}  // namespace

EchoMap::EchoMap(double sonar_range)
    : range_(std::min(sonar_range, kMatters)),
      memory_(lps::for_range(range_, cautious_memory())),
      edges_(lps::for_range(range_, cautious_memory())) {}

void EchoMap::clear() {
  memory_.clear();
  edges_.clear();
  echoes_.clear();
  fired_ahead_ = 0;
  fired_behind_ = 0;
}

void EchoMap::update(std::uint64_t cycle, const Pose& robot_in_odom,
                     const std::vector<Reading>& readings, const std::vector<Edge>& edges) {
  memory_.move_to(robot_in_odom);
  edges_.move_to(robot_in_odom);
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
      const ToFrame to_sonar(sonar_in_odom);
      const bool of_edge = std::any_of(edges.begin(), edges.end(), [&](const Edge& edge) {
        return is_of({to_sonar(edge.from), to_sonar(edge.to)}, *reading.range);
      });
      (of_edge ? edges_ : memory_).echo(sonar_in_odom, *reading.range);
      // Nothing else stands at an edge's own echo.
      if (of_edge)
        memory_.free_before(sonar_in_odom, *reading.range + kOnEdge);
      else
        edges_.free_before(sonar_in_odom, *reading.range);
      echoes_.push_back({reading.sonar, sonar_in_odom, *reading.range, cycle});
    } else {
      memory_.silence(sonar_in_odom);
      edges_.silence(sonar_in_odom);
    }
  }
  memory_.collect(robot_in_odom);
  edges_.collect(robot_in_odom);
}

std::optional<EchoMap::Firing> EchoMap::heard(const Vec2& spot) const {
  const Vec2 in_odom = compose(robot_in_odom_, {spot.x(), spot.y(), 0.0}).position();
  for (auto echo = echoes_.rbegin(); echo != echoes_.rend(); ++echo) {
    const Vec2 from_sonar = to_frame(echo->sonar_in_odom, in_odom);
    const double distance = from_sonar.norm();
    if (std::abs(distance - echo->range) <= kThickness &&
        std::abs(std::atan2(from_sonar.y(), from_sonar.x())) <= kCone)
      return Firing{echo->sonar, cycle_ - std::min(cycle_, echo->cycle)};
  }
  return std::nullopt;
}

bool EchoMap::sees(std::uint64_t cycle, bool ahead) const {
  return cycle <= (ahead ? fired_ahead_ : fired_behind_) + kTurnCycles;
}

}  // namespace saphira::authority
