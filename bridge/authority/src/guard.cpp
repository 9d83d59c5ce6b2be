#include "saphira/authority/guard.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace saphira::authority {

namespace {

constexpr double kCreep = 0.02;        // [m/s] slower is as good as standing
constexpr double kDeceleration = 0.3;  // [m/s2] of a robot that does not say its own
constexpr double kSameWay = radians(3.0);
// [m] A robot whose sonars reach less keeps this share of their reach as margin.
constexpr double kShareOfReach = 0.25;
// What comes closer takes no more than this share of the reach until the robot brakes.
constexpr double kShareOfWay = 0.1;

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

double approach_speed(double distance, double end, double reaction, double deceleration,
                      double closing) {
  const double a = deceleration;
  const double left = distance - closing * reaction;
  if (left <= 0.0)
    return end;
  // The root v of v t + (v^2 - end^2) / 2a + closing (v - end) / a = left.
  const double b = a * reaction + closing;
  return std::max(end, std::sqrt(b * b + 2.0 * a * left + end * end + 2.0 * closing * end) - b);
}

namespace {

/// What the points allow of a motion straight ahead (or back).
struct Allowed {
  double free = std::numeric_limits<double>::infinity();   // [m] of the hull's path
  double speed = std::numeric_limits<double>::infinity();  // [m/s] past what stands beside it...
  double beside = 0.0;                                     // [m] ...so far from the hull
  // [m] until the hull is beside what may step into its path
  double until_beside = std::numeric_limits<double>::infinity();
};

/// The hull may come as near as a person reaches to what stands beside the path, and no nearer
/// faster than `touch_velocity`. What is driven past at an angle is approached more slowly than the
/// robot moves.
void pass(const GuardSettings& settings, const Body& body, double ahead, double aside,
          Allowed& allowed) {
  const double deceleration = body.deceleration;
  const double room = body.radius + settings.person;
  if (ahead <= 0.0 || aside >= room)
    return;
  const double away = std::hypot(ahead, aside);
  // Where the hull has come so near, and how straight it then goes for it.
  const double meets = std::min(ahead, std::sqrt(room * room - aside * aside));
  const double towards = meets / std::hypot(meets, aside);
  const double at_last = settings.touch_velocity / std::max(towards, 1e-3);
  const double speed = approach_speed(ahead - meets, at_last, body.reaction, deceleration);
  if (speed < allowed.speed) {
    allowed.speed = speed;
    allowed.beside = away - body.radius;
  }
}

Allowed allow(const GuardSettings& settings, const Body& body, const std::vector<Vec2>& points,
              bool forward, double turning) {
  Allowed allowed;
  const auto look = [&](const std::vector<Vec2>& seen) {
    allowed.until_beside =
        std::min(allowed.until_beside, free_distance(seen, body.radius, settings.beside, forward));
    allowed.free =
        std::min(allowed.free, free_distance(seen, body.radius, settings.side_margin, forward));
    for (const Vec2& point : seen)
      pass(settings, body, forward ? point.x() : -point.x(), std::abs(point.y()), allowed);
  };
  look(points);
  // The robot turns meanwhile: also where it will point.
  const double turn = turning * body.reaction;
  if (std::abs(turn) >= kSameWay) {
    const ToFrame turned({0.0, 0.0, turn});
    std::vector<Vec2> seen;
    seen.reserve(points.size());
    for (const Vec2& point : points)
      seen.push_back(turned(point));
    look(seen);
  }
  return allowed;
}

}  // namespace

Guarded guard(const GuardSettings& settings, const Body& body, const std::vector<Vec2>& points,
              double velocity, double rotation_velocity, double turning, double contact_speed) {
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

  Body braking = body;
  if (braking.deceleration <= 0.0)
    braking.deceleration = kDeceleration;
  const double a = braking.deceleration;
  const Allowed allowed = allow(settings, braking, points, forward, turning);
  if (settings.slow_distance > 0.0 && allowed.free < settings.slow_distance &&
      speed > settings.slow_velocity) {
    speed = settings.slow_velocity;
    act(GuardAction::slow, text("something %.2f m ahead: slowed to %.2f m/s", allowed.free, speed));
  }
  if (speed > allowed.speed) {
    speed = allowed.speed;
    act(GuardAction::slow,
        text("something beside the path, %.2f m away: slowed to %.2f m/s", allowed.beside, speed));
  }
  const double reach = std::min(settings.dependable_range, body.sonar_range);
  const double margin = std::min(settings.margin, kShareOfReach * reach);
  const double past =
      approach_speed(allowed.until_beside - margin, settings.beside_velocity, body.reaction, a);
  if (speed > past) {
    speed = past;
    act(GuardAction::slow, text("something near the path, %.2f m ahead: slowed to %.2f m/s",
                                allowed.until_beside, speed));
  }
  const double unheard = approach_speed(reach - margin, 0.0, body.reaction, a);
  if (speed > unheard) {
    speed = unheard;
    act(GuardAction::limit,
        text("%.2f m/s cut to %.2f: no farther ahead can a person be heard", velocity, speed));
  }
  const double closing = std::min(settings.closing_velocity, kShareOfWay * reach / body.reaction);
  const double careful =
      approach_speed(allowed.free - margin, settings.careful_velocity, body.reaction, a, closing);
  const double safe =
      std::min(careful, approach_speed(allowed.free - margin, 0.0, body.reaction, a));
  if (speed > safe) {
    if (safe < kCreep) {
      speed = 0.0;
      act(GuardAction::stop,
          text("something %.2f m ahead: stopped (margin %.2f m)", allowed.free, margin));
    } else {
      speed = safe;
      act(GuardAction::slow,
          text("something %.2f m ahead: slowed to %.2f m/s", allowed.free, speed));
    }
  }
  const double contact = forward ? std::min(contact_speed, settings.max_contact_velocity) : 0.0;
  const double meant = std::min(std::abs(velocity), contact);
  if (meant > speed) {
    speed = meant;
    out.action = GuardAction::slow;
    out.reason = text("something %.2f m ahead, and contact is meant: slowed to %.2f m/s",
                      allowed.free, speed);
  }
  out.velocity = forward ? speed : -speed;
  return out;
}

}  // namespace saphira::authority
