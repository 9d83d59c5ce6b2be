#include "saphira/lps/local_perceptual_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saphira::lps {
namespace {

void append_valid(const SonarBuffer& buffer, std::vector<Vec2>& points) {
  for (const SonarEntry& entry : buffer.entries())
    if (entry.valid)
      points.push_back(entry.in_robot);
}

}  // namespace

Feeds feeds(const Pose& sonar_in_robot) {
  const double slack = 1e-6;  // bearings come from files in degrees
  const double bearing = norm2_angle(sonar_in_robot.th);
  if (std::abs(bearing) <= radians(60.0) + slack)
    return Feeds::front;
  if (std::abs(bearing) <= radians(120.0) + slack)
    return bearing > 0.0 ? Feeds::left : Feeds::right;
  return Feeds::none;
}

LocalPerceptualSpace::LocalPerceptualSpace(LpsSettings settings)
    : settings_(std::move(settings)),
      front_(settings_.front_buffer),
      left_(settings_.side_buffer),
      right_(settings_.side_buffer),
      memory_(for_range(settings_.front_max_range, settings_.memory)) {}

void LocalPerceptualSpace::reset() {
  *this = LocalPerceptualSpace(settings_);
}

void LocalPerceptualSpace::set_front_buffer(std::size_t limit) {
  front_.set_limit(limit);
  settings_.front_buffer = front_.limit();
}

void LocalPerceptualSpace::set_side_buffer(std::size_t limit) {
  left_.set_limit(limit);
  right_.set_limit(limit);
  settings_.side_buffer = left_.limit();
}

void LocalPerceptualSpace::update(const Pose& robot_in_odom,
                                  const std::vector<SonarReading>& readings, std::uint64_t cycle) {
  if (!std::exchange(placed_, true))
    robot_in_odom_ = robot_in_odom;
  const Pose moved = relative(robot_in_odom_, robot_in_odom);
  const Pose before = robot_in_odom_;
  robot_in_odom_ = robot_in_odom;
  cycle_ = cycle;
  memory_.move_to(robot_in_odom_);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double part = static_cast<double>(i + 1) / static_cast<double>(readings.size());
    take(readings[i], compose(before, {part * moved.x, part * moved.y, part * moved.th}));
  }
  register_readings();
}

void LocalPerceptualSpace::touch(const Vec2& at_in_robot) {
  memory_.touch(transform(robot_in_odom_, at_in_robot));
  register_readings();
}

LocalPerceptualSpace LocalPerceptualSpace::seen_from(const Pose& robot_in_odom) const {
  LocalPerceptualSpace seen = *this;
  seen.robot_in_odom_ = robot_in_odom;
  seen.register_readings();
  return seen;
}

void LocalPerceptualSpace::take(const SonarReading& reading, const Pose& robot_in_odom) {
  const auto mount = std::find_if(settings_.sonars.begin(), settings_.sonars.end(),
                                  [&](const SonarMount& m) { return m.sonar == reading.sonar; });
  if (mount == settings_.sonars.end())
    return;  // a sonar that the robot's description does not place
  const Pose sonar_in_odom = compose(robot_in_odom, mount->in_robot);
  const auto place = [&]() -> Vec2 {
    return sonar_in_odom.position() + reading.range * sonar_in_odom.direction();
  };
  const bool near = reading.echo && reading.range <= settings_.front_max_range;
  switch (feeds(mount->in_robot)) {
    case Feeds::front:
      if (near)
        front_.add(place(), robot_in_odom_);
      else
        front_.add_miss();
      break;
    case Feeds::left:
      if (reading.echo)
        left_.add(place(), robot_in_odom_);
      break;
    case Feeds::right:
      if (reading.echo)
        right_.add(place(), robot_in_odom_);
      break;
    case Feeds::none:
      break;
  }
  if (near)
    memory_.echo(sonar_in_odom, reading.range);
  else
    memory_.silence(sonar_in_odom);
}

std::vector<Vec2> LocalPerceptualSpace::points(Source source) const {
  if (source == Source::remembered)
    return memory_.points();
  std::vector<Vec2> points;
  if (source != Source::sides)
    append_valid(front_, points);
  if (source != Source::front) {
    append_valid(left_, points);
    append_valid(right_, points);
  }
  return points;
}

Occupancy LocalPerceptualSpace::box(Axis axis, double cx, double cy, double h, double w,
                                    Source source) const {
  return occupancy_box(points(source), axis, cx, cy, h, w);
}

Occupancy LocalPerceptualSpace::plane(Direction direction, Source source, double d, double s1,
                                      double s2) const {
  return occupancy_plane(points(source), direction, d, s1, s2);
}

void LocalPerceptualSpace::register_readings() {
  front_.move_to(robot_in_odom_);
  left_.move_to(robot_in_odom_);
  right_.move_to(robot_in_odom_);
  memory_.collect(robot_in_odom_);
}

}  // namespace saphira::lps
