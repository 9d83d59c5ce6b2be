#include "saphira/intentions/gaze.hpp"

#include <cmath>

#include "saphira/intentions/beliefs.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

constexpr double kLead = 0.2;             // [s] from a request to its effect
constexpr double kStep = radians(2.0);    // the least turn
constexpr double kMissed = radians(4.0);  // of the head from the direction asked for
constexpr std::uint64_t kBetween = 2;     // [cycles] between requests
constexpr std::uint64_t kPatience = 20;   // [cycles] before a request is made again

/// The direction of a place in odom as it will be seen when the head has turned.
double bearing_of(const World& world, const Vec2& place) {
  Pose robot = world.robot.pose_in_odom;
  const double way = kLead * world.robot.velocity;
  robot.x += way * std::cos(robot.th);
  robot.y += way * std::sin(robot.th);
  robot.th += kLead * world.robot.rotation_velocity;
  const Pose seen = relative(robot, {place.x(), place.y(), 0.0});
  return std::atan2(seen.y, seen.x);
}

}  // namespace

double Gaze::wanted(const World& world, const Value& watched) const {
  const double reach = world.around.head_reach;
  double bearing = 0.0;
  if (const double* const number = watched.number()) {
    bearing = norm2_angle(*number);
  } else if (const Point* const point = watched.point()) {
    if (const auto place = in_frame(point->pose, point->frame, Frame::odom, world.robot))
      bearing = bearing_of(world, place->position());
  } else if (const Reference* const reference = watched.reference();
             reference != nullptr && reference->kind == Reference::Kind::kThing) {
    if (const lps::SeenThing* const thing = seen_thing(world, reference->id))
      bearing = bearing_of(world, thing->pose_in_odom.position() + kLead * thing->velocity_in_odom);
  }
  if (std::abs(bearing) <= reach)
    return bearing;
  // Behind the robot the head stays on its side.
  const double side = std::abs(asked_) > reach / 2.0 ? asked_ : bearing;
  return std::copysign(reach, side);
}

std::optional<double> Gaze::step(const World& world) {
  const std::uint64_t cycle = world.around.cycle;
  if (cycle < now_) {  // another epoch of the robot
    asked_ = world.robot.head;
    at_ = 0;
  }
  now_ = cycle;
  if (world.around.head_reach == 0.0 || cycle < at_ + kBetween)
    return std::nullopt;
  const Belief* const belief = world.beliefs.stored("gaze");
  const Value watched = belief == nullptr ? Value() : belief->value;
  const double bearing = wanted(world, watched);
  const bool moved = std::abs(bearing - asked_) > kStep;
  // Where nothing is watched, another program may turn the head.
  const bool missed =
      watched.truthy() && std::abs(world.robot.head - asked_) > kMissed && cycle >= at_ + kPatience;
  if (!moved && !missed)
    return std::nullopt;
  asked_ = bearing;
  at_ = cycle;
  return asked_;
}

}  // namespace saphira::intentions
