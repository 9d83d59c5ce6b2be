#include "behavior_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/intentions/functions.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

/// A smaller correction of registration does not move a point on the map, so that the behavior does
/// not change every cycle.
constexpr double kMoved = 0.005;  ///< [m]
constexpr double kTurned = radians(0.3);

/// The behavior's own spelling of a parameter.
std::string spelled(const std::string& name, const BehaviorSignature* known) {
  if (known == nullptr) {
    std::string guess = name;
    std::replace(guess.begin(), guess.end(), '-', '_');
    return guess;
  }
  const auto parameter =
      std::find_if(known->parameters.begin(), known->parameters.end(),
                   [&](const Parameter& each) { return normal(each.name) == normal(name); });
  if (parameter == known->parameters.end())
    throw ActivityError("behavior " + known->name + " has no parameter " + quoted(name));
  return parameter->name;
}

}  // namespace

BehaviorParameters::BehaviorParameters(const Bindings& given, const std::string& behavior,
                                       const BehaviorSignature* known, const World& world) {
  for (const auto& [name, value] : given) {
    const std::string own_name = spelled(name, known);
    if (value.nil())
      continue;  // absent
    Argument argument;
    std::uint64_t moving = 0;
    const Reference* const reference = value.reference();
    if (reference != nullptr && reference->kind == Reference::Kind::kThing) {
      const lps::SeenThing* const thing = seen_thing(world, reference->id);
      if (thing == nullptr)
        throw ActivityError("behavior " + behavior + ": what " + quoted(name) +
                            " means is not seen any more");
      argument = point(own_name, thing->pose_in_odom);
      moving = thing->id;
    } else if (!to_argument(own_name, value, argument)) {
      throw ActivityError("behavior " + behavior + ": parameter " + quoted(name) + " cannot be " +
                          kind_of(value));
    }
    if (argument.kind == ArgumentKind::point && argument.frame == Frame::robot) {
      argument.point = compose(world.robot.pose_in_odom, argument.point);
      argument.frame = Frame::odom;
    }
    on_map_ = on_map_ || (argument.kind == ArgumentKind::point && argument.frame == Frame::map);
    given_.push_back(std::move(argument));
    things_.push_back(moving);
  }
}

bool BehaviorParameters::place(Arguments& parameters, const World& world) const {
  if (parameters.empty())
    parameters = given_;
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const lps::SeenThing* const thing = things_[i] == 0 ? nullptr : seen_thing(world, things_[i]);
    if (thing != nullptr)
      parameters[i].point = thing->pose_in_odom;
  }
  if (!on_map_)
    return true;
  bool placed = true;
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const Argument& given = given_[i];
    Argument& argument = parameters[i];
    if (given.kind != ArgumentKind::point || given.frame != Frame::map)
      continue;
    const auto there = in_frame(given.point, Frame::map, Frame::odom, world.robot);
    if (!there) {
      placed = placed && argument.frame == Frame::odom;
      continue;
    }
    const bool moved = argument.frame == Frame::map ||
                       (argument.point.position() - there->position()).norm() > kMoved ||
                       std::abs(norm2_angle(argument.point.th - there->th)) > kTurned;
    if (moved)
      argument.point = *there;
    argument.frame = Frame::odom;
  }
  return placed;
}

}  // namespace saphira::intentions
