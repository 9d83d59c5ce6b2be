#include "saphira/lps/local_perceptual_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saphira::lps {
namespace {

/// The id of sfGlobalOrigin.
constexpr std::uint32_t kOriginId = 1;

Artifact origin() {
  Artifact artifact;
  artifact.id = kOriginId;
  return artifact;
}

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
      memory_(settings_.memory),
      artifacts_(1, origin()),
      last_id_(kOriginId) {}

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
  // Global and odom are the same until move_robot changes that.
  if (!placed_) {
    robot_in_global_ = robot_in_odom;
    robot_in_odom_ = robot_in_odom;
    placed_ = true;
  }
  const Pose moved = relative(robot_in_odom_, robot_in_odom);
  const Pose before = robot_in_odom_;
  robot_in_odom_ = robot_in_odom;
  robot_in_global_ = compose(robot_in_global_, moved);
  cycle_ = cycle;
  memory_.move_to(robot_in_odom_);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double part = static_cast<double>(i + 1) / static_cast<double>(readings.size());
    take(readings[i], compose(before, {part * moved.x, part * moved.y, part * moved.th}));
  }
  register_readings();
  register_artifacts();
}

void LocalPerceptualSpace::touch(const Vec2& at_in_robot) {
  memory_.touch(transform(robot_in_odom_, at_in_robot));
  register_readings();
}

LocalPerceptualSpace LocalPerceptualSpace::seen_from(const Pose& robot_in_odom) const {
  LocalPerceptualSpace seen = *this;
  seen.robot_in_global_ = compose(robot_in_global_, relative(robot_in_odom_, robot_in_odom));
  seen.robot_in_odom_ = robot_in_odom;
  seen.register_readings();
  seen.register_artifacts();
  return seen;
}

void LocalPerceptualSpace::take(const SonarReading& reading, const Pose& robot_in_odom) {
  const auto mount = std::find_if(settings_.sonars.begin(), settings_.sonars.end(),
                                  [&](const SonarMount& m) { return m.sonar == reading.sonar; });
  if (mount == settings_.sonars.end())
    return;  // a sonar that the robot's description does not place
  const Pose sonar_in_odom = compose(robot_in_odom, mount->in_robot);
  const Vec2 place = sonar_in_odom.position() + reading.range * sonar_in_odom.direction();
  const bool near = reading.echo && reading.range <= settings_.front_max_range;
  switch (feeds(mount->in_robot)) {
    case Feeds::front:
      if (near)
        front_.add(place, robot_in_odom_);
      else
        front_.add_miss();
      break;
    case Feeds::left:
      if (reading.echo)
        left_.add(place, robot_in_odom_);
      break;
    case Feeds::right:
      if (reading.echo)
        right_.add(place, robot_in_odom_);
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

Artifact LocalPerceptualSpace::local_point(const Pose& in_robot) const {
  Artifact artifact;
  artifact.local = in_robot;
  set_global(artifact);
  return artifact;
}

Artifact LocalPerceptualSpace::global_point(const Pose& in_global) const {
  Artifact artifact;
  artifact.global = in_global;
  set_local(artifact);
  return artifact;
}

void LocalPerceptualSpace::set_local(Artifact& artifact) const {
  artifact.local = relative(robot_in_global_, artifact.global);
}

void LocalPerceptualSpace::set_global(Artifact& artifact) const {
  artifact.global = compose(robot_in_global_, artifact.local);
}

std::uint32_t LocalPerceptualSpace::add(Artifact artifact) {
  if (Artifact* const there = artifact.id != 0 ? find(artifact.id) : nullptr) {
    *there = artifact;
    return artifact.id;
  }
  if (artifact.id == 0)
    artifact.id = last_id_ + 1;
  last_id_ = std::max(last_id_, artifact.id);
  artifacts_.push_back(artifact);
  return artifact.id;
}

bool LocalPerceptualSpace::remove(std::uint32_t id) {
  return id != kOriginId &&
         std::erase_if(artifacts_, [&](const Artifact& a) { return a.id == id; }) != 0;
}

const Artifact* LocalPerceptualSpace::find(std::uint32_t id) const {
  const auto found = std::find_if(artifacts_.begin(), artifacts_.end(),
                                  [&](const Artifact& a) { return a.id == id; });
  return found == artifacts_.end() ? nullptr : &*found;
}

Artifact* LocalPerceptualSpace::find(std::uint32_t id) {
  return const_cast<Artifact*>(std::as_const(*this).find(id));
}

void LocalPerceptualSpace::move_robot(double dx, double dy, double dth) {
  robot_in_global_ = compose(robot_in_global_, {dx, dy, dth});
  register_artifacts();
}

void LocalPerceptualSpace::register_readings() {
  front_.move_to(robot_in_odom_);
  left_.move_to(robot_in_odom_);
  right_.move_to(robot_in_odom_);
  memory_.collect(robot_in_odom_);
}

void LocalPerceptualSpace::register_artifacts() {
  for (Artifact& artifact : artifacts_)
    set_local(artifact);
}

}  // namespace saphira::lps
