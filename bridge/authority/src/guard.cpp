#include "saphira/authority/guard.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/age.hpp"
#include "saphira/base/format.hpp"

namespace saphira::authority {

namespace {

constexpr double kCreep = 0.02;        // [m/s] counts as standing
constexpr double kDeceleration = 0.3;  // [m/s2] of a robot that does not say its own
constexpr double kSameWay = radians(3.0);
constexpr double kNearer = 0.01;  // [m] less is no approach
// [m] A robot whose sonars reach less far keeps distances that are smaller in proportion.
constexpr double kReach = 1.0;
// An approaching obstacle takes at most this share of the range until the robot brakes.
constexpr double kShareOfWay = 0.1;
constexpr double kSweeps = 1.5;  // [s] before it has to brake, the robot sweeps its sonars

double limit_of(double setting, double robot) {
  if (setting <= 0.0)
    return robot;
  return robot <= 0.0 ? setting : std::min(setting, robot);
}

}  // namespace

namespace {

struct Nearest {
  // [m] of the hull along its straight path until the point comes within it and its side margin
  double free = std::numeric_limits<double>::infinity();
  std::size_t point = 0;  // its index
};

Nearest nearest(const std::vector<Vec2>& points, double radius, double side_margin, bool forward) {
  Nearest found;
  const double width = radius + side_margin;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2& point = points[i];
    const double ahead = forward ? point.x() : -point.x();
    const double aside = std::abs(point.y());
    // Driving on leaves an obstacle beside or behind. Within 60 degrees of the path it is ahead.
    if (aside >= width || ahead <= 0.0 || aside > std::sqrt(3.0) * ahead)
      continue;
    const double nose = aside < radius ? std::sqrt(radius * radius - aside * aside) : 0.0;
    if (const double free = std::max(0.0, ahead - nose); free < found.free)
      found = {free, i};
  }
  return found;
}

}  // namespace

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

/// The speed that the points allow straight ahead (or back).
struct Allowed {
  double free = std::numeric_limits<double>::infinity();   // [m] along the hull's path
  double speed = std::numeric_limits<double>::infinity();  // [m/s] past an obstacle...
  double beside = 0.0;                                     // [m] ...at this distance from the hull
  // [m] until the hull is beside an obstacle that may step into its path
  double until_beside = std::numeric_limits<double>::infinity();
  // The echoes behind these, in the robot's frame.
  Vec2 free_at{0.0, 0.0};
  Vec2 speed_at{0.0, 0.0};
  Vec2 beside_at{0.0, 0.0};
};

/// The hull keeps an obstacle's reach. Where its path passes the obstacle at `least`, it approaches
/// up to `touch_velocity`. The middle of the hull is `nearest` from the nearest echo [m]: past a
/// long side it comes no nearer to it. The approach to an obstacle that is passed at an angle is
/// slower than the robot's own motion.
void pass(const Clearance& clearance, const Body& body, double ahead, double aside, double nearest,
          const Vec2& point, Allowed& allowed) {
  const double deceleration = body.deceleration;
  const double error = aside < nearest - kNearer ? clearance.error : 0.0;
  const double room = body.radius + clearance.reach + error;
  if (ahead <= 0.0 || aside >= room)
    return;
  // The point where the hull reaches that distance, and the angle of its approach there.
  const double meets = std::min(ahead, std::sqrt(room * room - aside * aside));
  const double towards = meets / std::hypot(meets, aside);
  const double at_last = aside < body.radius + clearance.least
                             ? 0.0
                             : clearance.touch_velocity / std::max(towards, 1e-3);
  const double speed = approach_speed(ahead - meets, at_last, body.reaction, deceleration);
  if (speed < allowed.speed) {
    allowed.speed = speed;
    allowed.beside = std::hypot(ahead, aside) - body.radius;
    allowed.speed_at = point;
  }
}

/// Adds the limits of one kind of echo. Nobody steps out of a wall: `steps` is for people alone.
void allow(const Clearance& clearance, double steps, const Body& body,
           const std::vector<Vec2>& points, bool forward, double turning, Allowed& allowed) {
  double closest = std::numeric_limits<double>::infinity();
  for (const Vec2& point : points)
    closest = std::min(closest, point.norm());
  const auto look = [&](const std::vector<Vec2>& seen) {
    const auto take_nearest = [&](double margin, double& least, Vec2& at) {
      const Nearest found = nearest(seen, body.radius, margin, forward);
      if (found.free >= least)
        return;
      least = found.free;
      at = points[found.point];
    };
    if (steps > 0.0)
      take_nearest(steps, allowed.until_beside, allowed.beside_at);
    take_nearest(clearance.side_margin, allowed.free, allowed.free_at);
    for (std::size_t i = 0; i < seen.size(); ++i)
      pass(clearance, body, forward ? seen[i].x() : -seen[i].x(), std::abs(seen[i].y()), closest,
           points[i], allowed);
  };
  look(points);
  // The robot turns meanwhile: also check the heading that it will have.
  const double turn = turning * body.reaction;
  if (std::abs(turn) >= kSameWay) {
    const ToFrame turned({0.0, 0.0, turn});
    std::vector<Vec2> seen;
    seen.reserve(points.size());
    for (const Vec2& point : points)
      seen.push_back(turned(point));
    look(seen);
  }
}

/// A motion and its limits, one by one. The tightest limit gives the reason.
class Cut {
 public:
  Cut(const GuardSettings& settings, const Body& body, double velocity)
      : settings_(settings),
        body_(body),
        wanted_(velocity),
        reach_(std::min(settings.dependable_range, body.sonar_range)),
        scale_(std::min(1.0, reach_ / kReach)),
        margin_(settings.margin * scale_),
        speed_(std::abs(velocity)) {
    if (body_.deceleration <= 0.0)
      body_.deceleration = kDeceleration;
  }

  void rotation(double wanted) {
    turning_ = wanted;
    const double most = limit_of(settings_.max_rotation_velocity, body_.max_rotation_velocity);
    if (most <= 0.0 || std::abs(wanted) <= most)
      return;
    turning_ = std::copysign(most, wanted);
    act(GuardAction::limit,
        format("rotation of %.2f rad/s cut to the limit of %.2f", wanted, most));
  }

  void robot() {
    const double most = limit_of(settings_.max_velocity, body_.max_velocity);
    if (most > 0.0)
      cut(most, GuardAction::limit,
          [&] { return format("%.2f m/s cut to the limit of %.2f", wanted_, most); });
    const double blind = settings_.max_blind_velocity;
    if (blind > 0.0 && !(forward() ? body_.sees_ahead : body_.sees_behind))
      cut(blind, GuardAction::limit,
          [&] { return format("%.2f m/s cut to %.2f: no sonar looks ", wanted_, blind) + side(); });
    if (blind > 0.0) {
      const double covered = body_.covered - margin_;
      const double safe = stops_within(covered, blind);
      sweep_ = stops_within(covered - kSweeps * speed_, blind) < speed_;
      cut(safe, GuardAction::limit, [&] {
        return format("%.2f m/s cut to %.2f: the sonars have covered no more than %.2f m ", wanted_,
                      safe, body_.covered) +
               side();
      });
    }
    const double unheard = stops_within(reach_ - margin_, 0.0);
    cut(unheard, GuardAction::limit, [&] {
      return format("%.2f m/s cut to %.2f: no farther ahead can a person be heard", wanted_,
                    unheard);
    });
  }

  void beside(const Allowed& allowed) {
    cut(
        allowed.speed, allowed.speed > 0.0 ? GuardAction::slow : GuardAction::stop,
        [&] {
          return format("something beside the path, %.2f m away: at most %.2f m/s", allowed.beside,
                        allowed.speed);
        },
        &allowed.speed_at);
    const double past = stops_within(allowed.until_beside - margin_, settings_.beside_velocity);
    cut(
        past, GuardAction::slow,
        [&] {
          return format("something near the path, %.2f m ", allowed.until_beside) + side() +
                 at_most(past);
        },
        &allowed.beside_at);
  }

  void ahead(const Allowed& allowed) {
    const double free = allowed.free;
    const Vec2* const at = &allowed.free_at;
    if (settings_.slow_distance > 0.0 && free < settings_.slow_distance)
      cut(
          settings_.slow_velocity, GuardAction::slow,
          [&] { return something(free) + at_most(settings_.slow_velocity); }, at);
    const double closing =
        std::min(settings_.closing_velocity, kShareOfWay * reach_ / body_.reaction);
    const auto safe_at = [&](double distance) {
      return std::min(stops_within(distance - margin_, settings_.careful_velocity, closing),
                      stops_within(distance - margin_, 0.0));
    };
    const double safe = safe_at(free);
    const auto until = [&] {
      double distance = margin_;
      while (safe_at(distance) < kCreep && distance < reach_)
        distance += 0.01;
      return format("; it lets go beyond %.2f m", distance);
    };
    if (safe < kCreep)
      cut(
          0.0, GuardAction::stop, [&] { return something(free) + until(); }, at);
    else
      cut(
          safe, GuardAction::slow, [&] { return something(free) + at_most(safe); }, at);
  }

  void contact(double meant, const Allowed& allowed) {
    const double speed =
        forward() ? std::min({wanted_, meant, settings_.max_contact_velocity}) : 0.0;
    if (speed <= speed_)
      return;
    speed_ = speed;
    action_ = GuardAction::slow;
    obstacle_ = allowed.free_at;
    reason_ = something(allowed.free) + ", and contact is meant" + at_most(speed);
  }

  const Body& body() const { return body_; }
  Clearance scaled(const Clearance& clearance) const {
    return {clearance.side_margin * scale_, clearance.reach * scale_, clearance.touch_velocity,
            clearance.least * scale_, clearance.error * scale_};
  }
  Guarded result() const {
    return {forward() ? speed_ : -speed_, turning_, action_, reason_, obstacle_, sweep_};
  }

 private:
  bool forward() const { return wanted_ >= 0.0; }
  double stops_within(double way, double end, double closing = 0.0) const {
    return approach_speed(way, end, body_.reaction, body_.deceleration, closing);
  }
  const char* side() const { return forward() ? "ahead" : "behind"; }
  std::string something(double free) const { return format("something %.2f m ", free) + side(); }
  static std::string at_most(double speed) { return format(": at most %.2f m/s", speed); }
  template <class Reason>
  void cut(double speed, GuardAction action, const Reason& reason, const Vec2* at = nullptr) {
    if (speed_ <= speed)
      return;
    speed_ = speed;
    act(action, reason(), at);
  }
  void act(GuardAction action, std::string reason, const Vec2* at = nullptr) {
    action_ = std::max(action_, action);
    reason_ = std::move(reason);
    obstacle_ = at == nullptr ? std::nullopt : std::optional(*at);
  }

  const GuardSettings& settings_;
  Body body_;
  double wanted_;
  double reach_;   // [m] range at which a person is surely heard
  double scale_;   // of the distances
  double margin_;  // [m]
  double speed_;
  double turning_ = 0.0;
  GuardAction action_ = GuardAction::none;
  std::string reason_;
  std::optional<Vec2> obstacle_;
  bool sweep_ = false;
};

}  // namespace

Guarded guard(const GuardSettings& settings, const Body& body, const std::vector<Vec2>& points,
              double velocity, double rotation_velocity, double turning, double contact_speed,
              const std::vector<Vec2>& edges) {
  if (!settings.enabled)
    return {velocity, rotation_velocity, GuardAction::none, {}};
  Cut cut(settings, body, velocity);
  cut.rotation(rotation_velocity);
  if (velocity == 0.0)
    return cut.result();
  cut.robot();
  Allowed allowed;
  const bool forward = velocity > 0.0;
  allow(cut.scaled(body.knows_edges ? settings.person : settings.anything), settings.beside,
        cut.body(), points, forward, turning, allowed);
  allow(cut.scaled(settings.edge), 0.0, cut.body(), edges, forward, turning, allowed);
  cut.ahead(allowed);
  cut.beside(allowed);
  cut.contact(contact_speed, allowed);
  return cut.result();
}

Guarded slow_for_age(Guarded guarded, double age, double fresh) {
  const double limit = speed_for_age(age - fresh);
  if (std::abs(guarded.velocity) <= limit)
    return guarded;
  // The stronger limit gives the reason.
  if (guarded.action <= GuardAction::limit) {
    guarded.reason =
        format("%.2f m/s cut to %.2f: the command answers the robot's state of %.1f s ago",
               guarded.velocity, limit, age);
    guarded.action = GuardAction::limit;
  }
  guarded.velocity = std::copysign(limit, guarded.velocity);
  return guarded;
}

}  // namespace saphira::authority
