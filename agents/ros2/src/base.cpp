#include "saphira/ros2/base.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saphira/base/format.hpp"

namespace saphira::ros2 {

namespace {

constexpr double kNarrowest = radians(8.0);  // the guard's lobe of a sonar
constexpr double kWidest = radians(15.0);
constexpr int kRests = 10;  // cmd_vel of no motion before the silence
constexpr int kMostTicks = 3 * sim::kTicksPerPacket;
constexpr int kDeepest = 32;     // frames
constexpr double kJump = 0.3;    // [m], beyond the way that the robot may have come
constexpr double kTurned = 0.4;  // [rad] likewise
constexpr double kRound = 0.01;  // [m] of a sensor's greatest range
constexpr const char* kEmpty = "width 100000\nheight 100000\n";

std::string plain_frame(const std::string& frame) {
  return frame.substr(frame.starts_with('/') ? 1 : 0);
}

Eigen::Isometry3d isometry(const Eigen::Vector3d& at, const Eigen::Quaterniond& turn) {
  return Eigen::Translation3d(at) * turn.normalized();
}

Eigen::Isometry3d isometry(const Pose& pose) {
  return isometry({pose.x, pose.y, 0.0},
                  Eigen::Quaterniond(Eigen::AngleAxisd(pose.th, Eigen::Vector3d::UnitZ())));
}

sim::ServerOptions named(const std::string& name) {
  sim::ServerOptions options;
  options.name = name;
  return options;
}

struct Sector {
  Pose sonar;
  double half = 0.0;
  bool seen = false;
  double nearest = std::numeric_limits<double>::infinity();
};

std::vector<Sector> sectors(const std::vector<protocol::SonarUnit>& sonars) {
  std::vector<Sector> all;
  for (const protocol::SonarUnit& unit : sonars) {
    double gap = 2.0 * kWidest;
    for (const protocol::SonarUnit& other : sonars)
      if (const double angle =
              std::abs(norm2_angle(other.pose_in_robot.th - unit.pose_in_robot.th));
          angle > 0.0)
        gap = std::min(gap, angle);
    all.push_back({unit.pose_in_robot, std::max(gap / 2.0, kNarrowest)});
  }
  return all;
}

}  // namespace

std::vector<sim::SonarEcho> echoes(const LaserScan& scan, const Eigen::Isometry3d& laser_in_robot,
                                   const protocol::RobotParameters& robot) {
  std::vector<Sector> all = sectors(robot.sonars);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    double range = scan.ranges[i];
    const bool far = range == std::numeric_limits<double>::infinity();
    if (far)
      range = scan.range_max;
    else if (range == -std::numeric_limits<double>::infinity())
      range = scan.range_min;  // something is nearer than it measures
    else if (!(range >= scan.range_min && range <= scan.range_max && range > 0.0))
      continue;
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const Eigen::Vector3d spot =
        laser_in_robot * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0.0);
    for (Sector& sector : all) {
      const Vec2 from = to_frame(sector.sonar, spot.head<2>());
      if (std::abs(std::atan2(from.y(), from.x())) > sector.half)
        continue;
      sector.seen = true;
      if (!far)
        sector.nearest = std::min(sector.nearest, from.norm());
    }
  }
  std::vector<sim::SonarEcho> found;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].seen)
      found.push_back({robot.sonars[i].number, all[i].nearest <= robot.sonar_max_range
                                                   ? std::optional(all[i].nearest)
                                                   : std::nullopt});
  return found;
}

bool Base::Stream::is_new(const Time& of, double now) {
  // Without a clock a robot has no stamps.
  if (came && of == stamp && of != Time{})
    return false;
  came = now;
  stamp = of;
  return true;
}

Base::Base(const protocol::RobotParameters& robot, const std::optional<Pose>& laser_in_robot,
           double now)
    : robot_(robot),
      world_(sim::parse_world(kEmpty, "nothing")),
      scene_(world_),
      server_(scene_, robot, {50.0, 50.0, 0.0}, named("ROS 2")),
      began_(now),
      wrote_(now),
      rests_(kRests) {
  if (laser_in_robot)
    laser_in_robot_ = isometry(*laser_in_robot);
}

bool Base::take(const Odometry& odometry, double now) {
  const auto& at = odometry.pose.pose.position;
  const Quaternion& q = odometry.pose.pose.orientation;
  sim::Measured body{
      {at.x, at.y, std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))},
      odometry.twist.twist.linear.x,
      odometry.twist.twist.angular.z,
      body_.battery};
  if (!std::isfinite(body.pose.x) || !std::isfinite(body.pose.y) || !std::isfinite(body.pose.th) ||
      !std::isfinite(body.velocity) || !std::isfinite(body.rotation_velocity))
    return false;
  const std::optional<double> before = odometry_.came;
  if (!odometry_.is_new(odometry.header.stamp, now))
    return true;
  if (const std::string frame = plain_frame(odometry.child_frame_id); !frame.empty())
    frame_ = frame;
  // The client sees a jump, and begins anew. A heading of before means another direction now.
  if (before) {
    const double waited = now - *before;
    const Pose way = relative(body_.pose, body.pose);
    if (way.position().norm() > kJump + robot_.max_velocity * waited ||
        std::abs(way.th) > kTurned + robot_.max_rotation_velocity * waited)
      server_.halt();
  }
  body_ = body;
  server_.measure(body_);
  return true;
}

bool Base::hear(const LaserScan& scan, const std::optional<Eigen::Isometry3d>& in_robot,
                Stream& stream, double now) {
  if (!std::isfinite(scan.angle_min) || !std::isfinite(scan.angle_increment) ||
      !std::isfinite(scan.range_min) || !std::isfinite(scan.range_max))
    return false;
  const std::string frame = plain_frame(scan.header.frame_id);
  if (!in_robot)
    bad_ranges_ = "tf_static does not say where " + frame + " is in " + frame_;
  else if (scan.range_max + kRound < robot_.sonar_max_range)
    bad_ranges_ = format("%s reaches %.2f m, and the SonarMaxRange of the robot's file is %.2f m",
                         frame.c_str(), scan.range_max, robot_.sonar_max_range);
  else if (stream.is_new(scan.header.stamp, now))
    server_.hear(echoes(scan, *in_robot, robot_));
  return true;
}

bool Base::take(const LaserScan& scan, double now) {
  return hear(scan, laser_in_robot_ ? laser_in_robot_ : place(scan.header.frame_id), scan_, now);
}

bool Base::take(const Range& range, double now) {
  // A scan of one ray.
  LaserScan scan{.header = range.header,
                 .range_min = range.min_range,
                 .range_max = range.max_range,
                 .ranges = {range.range}};
  return hear(scan, place(range.header.frame_id), ranges_[range.header.frame_id], now);
}

void Base::take(const TFMessage& transforms) {
  for (const Transform& each : transforms.transforms) {
    const auto& at = each.transform.translation;
    const Quaternion& turn = each.transform.rotation;
    fixed_[plain_frame(each.child_frame_id)] = {
        plain_frame(each.header.frame_id),
        isometry({at.x, at.y, at.z}, {turn.w, turn.x, turn.y, turn.z})};
  }
}

void Base::take(const BatteryState& battery) {
  body_.battery = std::isfinite(battery.voltage) ? battery.voltage : 0.0;
}

std::optional<Eigen::Isometry3d> Base::place(std::string frame) const {
  frame = plain_frame(frame);
  Eigen::Isometry3d in_robot = Eigen::Isometry3d::Identity();
  for (int i = 0; i < kDeepest && frame != frame_; ++i) {
    const auto found = fixed_.find(frame);
    if (found == fixed_.end())
      return std::nullopt;
    in_robot = found->second.in_parent * in_robot;
    frame = found->second.parent;
  }
  return frame == frame_ ? std::optional(in_robot) : std::nullopt;
}

std::string Base::trouble(double now) const {
  if (!odometry_.came)
    return "no odometry has come";
  if (!odometry_.lives(now))
    return "the odometry has ended";
  const bool has_ranges =
      std::ranges::any_of(ranges_, [](const auto& each) { return each.second.came.has_value(); });
  if (!robot_.sonars.empty() && !scan_.came && !has_ranges)
    return bad_ranges_.empty() ? "no scan and no range has come" : bad_ranges_;
  if (scan_.came && !scan_.lives(now))
    return "the scan has ended";
  if (has_ranges &&
      std::ranges::none_of(ranges_, [&](const auto& each) { return each.second.lives(now); }))
    return "the ranges have ended";
  return is_heard_ ? "" : "nobody takes cmd_vel";
}

void Base::receive(protocol::ByteView bytes) {
  server_.receive(bytes);
}

void Base::disconnect() {
  server_.disconnect();
  server_.halt();
}

Base::Output Base::advance(double now) {
  const bool is_lost = !trouble(now).empty();
  if (is_lost)
    server_.halt();
  const auto due = static_cast<std::int64_t>((now - began_) / sim::kTick) - ticks_;
  ticks_ += due;
  server_.advance(static_cast<int>(std::clamp<std::int64_t>(due, 0, kMostTicks)));
  if (is_lost)
    server_.halt();
  Output output{server_.take_output(), {}};
  if (is_lost)
    output.to_client.clear();
  Twist twist;
  twist.linear.x = server_.robot().motor_velocity();
  twist.angular.z = server_.robot().motor_rotation_velocity();
  const bool rests = twist == Twist{};
  if (server_.is_open() || !rests)
    rests_ = kRests;
  // A stop is written at once.
  if (!is_heard_ || rests_ == 0 || (now - wrote_ < kPeriod - 1e-9 && (!rests || written_ == twist)))
    return output;
  if (!server_.is_open() && rests)
    --rests_;
  wrote_ = now;
  written_ = twist;
  output.cmd_vel = twist;
  return output;
}

}  // namespace saphira::ros2
