#include "saphira/authority/guard.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace saphira::authority {

namespace {

constexpr double kCreep = 0.02;  // [m/s] slower is as good as standing
constexpr double kTowards = radians(60.0);

std::string text(const char* format, double a, double b) {
  char out[128];
  std::snprintf(out, sizeof out, format, a, b);
  return out;
}

double limit_of(double setting, double robot) {
  if (setting <= 0.0)
    return robot;
  return robot <= 0.0 ? setting : std::min(setting, robot);
}

}  // namespace

void Echoes::update(std::uint64_t cycle, const std::vector<Echo>& echoes,
                    const std::vector<Silence>& silent) {
  for (const Silence& silence : silent) {
    fired(cycle, silence.sonar_in_robot);
    const auto point = newest_.find(silence.sonar);
    if (point != newest_.end() && ++point->second.missed >= 2)
      newest_.erase(point);
  }
  for (const Echo& echo : echoes) {
    fired(cycle, echo.sonar_in_robot);
    const Pose sonar_in_odom = compose(echo.robot_in_odom, echo.sonar_in_robot);
    newest_[echo.sonar] = {transform(sonar_in_odom, {echo.range, 0.0}), cycle, 0};
  }
  std::erase_if(newest_, [&](const auto& item) { return cycle - item.second.cycle > kept_cycles; });
}

void Echoes::fired(std::uint64_t cycle, const Pose& sonar_in_robot) {
  if (std::abs(norm2_angle(sonar_in_robot.th)) < kTowards)
    fired_ahead_ = cycle;
  if (std::abs(norm2_angle(sonar_in_robot.th + kPi)) < kTowards)
    fired_behind_ = cycle;
}

bool Echoes::sees(std::uint64_t cycle, bool ahead) const {
  return cycle <= (ahead ? fired_ahead_ : fired_behind_) + kept_cycles;
}

std::vector<Vec2> Echoes::seen_from(const Pose& robot_in_odom) const {
  std::vector<Vec2> out;
  for (const auto& [sonar, point] : newest_) {
    const Pose p = relative(robot_in_odom, {point.in_odom.x(), point.in_odom.y(), 0.0});
    out.emplace_back(p.x, p.y);
  }
  return out;
}

double free_distance(const std::vector<Vec2>& points, double radius, double side_margin,
                     bool forward) {
  double free = std::numeric_limits<double>::infinity();
  const double width = radius + side_margin;
  for (const Vec2& point : points) {
    const double ahead = forward ? point.x() : -point.x();
    const double aside = std::abs(point.y());
    // What is beside or behind is left by driving on. Within 60 degrees of the path it is ahead.
    if (aside >= width || ahead <= 0.0 || aside > std::sqrt(3.0) * ahead)
      continue;
    const double nose = aside < radius ? std::sqrt(radius * radius - aside * aside) : 0.0;
    free = std::min(free, std::max(0.0, ahead - nose));
  }
  return free;
}

Guarded guard(const GuardSettings& settings, const Body& body, const std::vector<Vec2>& points,
              double velocity, double rotation_velocity, double contact_speed) {
  Guarded out{velocity, rotation_velocity, GuardAction::none, {}};
  if (!settings.enabled)
    return out;
  const auto act = [&](GuardAction action, std::string reason) {
    if (action > out.action) {
      out.action = action;
      out.reason = std::move(reason);
    }
  };

  const double max_turn = limit_of(settings.max_rotation_velocity, body.max_rotation_velocity);
  if (max_turn > 0.0 && std::abs(rotation_velocity) > max_turn) {
    out.rotation_velocity = std::copysign(max_turn, rotation_velocity);
    act(GuardAction::limit,
        text("rotation of %.2f rad/s cut to the limit of %.2f", rotation_velocity, max_turn));
  }
  if (velocity == 0.0)
    return out;

  const bool forward = velocity > 0.0;
  double speed = std::abs(velocity);
  const double max_speed = limit_of(settings.max_velocity, body.max_velocity);
  if (max_speed > 0.0 && speed > max_speed) {
    speed = max_speed;
    act(GuardAction::limit, text("%.2f m/s cut to the limit of %.2f", velocity, max_speed));
  }
  if (!(forward ? body.sees_ahead : body.sees_behind) && settings.max_blind_velocity > 0.0 &&
      speed > settings.max_blind_velocity) {
    speed = settings.max_blind_velocity;
    act(GuardAction::limit, text(forward ? "%.2f m/s cut to %.2f: no sonar looks ahead"
                                         : "%.2f m/s cut to %.2f: no sonar looks behind",
                                 velocity, speed));
  }

  const double free = free_distance(points, body.radius, settings.side_margin, forward);
  if (settings.slow_distance > 0.0 && free < settings.slow_distance &&
      speed > settings.slow_velocity) {
    speed = settings.slow_velocity;
    act(GuardAction::slow, text("something %.2f m ahead: slowed to %.2f m/s", free, speed));
  }
  // The approach: the speed v from which the robot still stops before the margin, by
  // v t + v^2 / 2a = distance.
  const double distance = free - settings.margin;
  const double a = body.deceleration > 0.0 ? body.deceleration : 0.5;
  const double t = settings.reaction;
  const double safe = distance <= 0.0 ? 0.0 : a * (std::sqrt(t * t + 2.0 * distance / a) - t);
  const double contact = forward ? std::min(contact_speed, settings.max_contact_velocity) : 0.0;
  if (speed > safe && contact > safe) {
    if (speed > contact)
      act(GuardAction::slow,
          text("something %.2f m ahead, and contact is meant: slowed to %.2f m/s", free, contact));
    speed = std::min(speed, contact);
  } else if (speed > safe) {
    if (safe < kCreep) {
      speed = 0.0;
      act(GuardAction::stop,
          text("something %.2f m ahead: stopped (margin %.2f m)", free, settings.margin));
    } else {
      speed = safe;
      act(GuardAction::slow, text("something %.2f m ahead: slowed to %.2f m/s", free, speed));
    }
  }
  out.velocity = forward ? speed : -speed;
  return out;
}

}  // namespace saphira::authority
