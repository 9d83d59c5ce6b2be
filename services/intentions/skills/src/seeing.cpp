#include "seeing.hpp"

#include <utility>

namespace saphira::intentions {
namespace {

using lps::SeenThing;
using SeenKind = SeenThing::Kind;

struct Wanted {
  SeenKind kind = SeenKind::person;
  int channel = -1;  ///< any
};

std::optional<Wanted> wanted(const std::string& what) {
  if (what == "person")
    return Wanted{};
  if (what == "blob")
    return Wanted{SeenKind::blob, -1};
  if (what.size() == 6 && what.starts_with("blob-") && what[5] >= 'a' && what[5] <= 'c')
    return Wanted{SeenKind::blob, what[5] - 'a'};
  return std::nullopt;
}

constexpr double kInSight = 1.0;  // [s] since it was seen

/// The thing of a reference; nullptr where the argument is nil or the thing is gone.
const SeenThing* thing_at(const World& world, Values arguments, std::string_view function) {
  if (arguments[0].nil())
    return nullptr;
  const Reference* const reference = arguments[0].reference();
  if (reference == nullptr || reference->kind != Reference::Kind::kThing)
    throw ActivityError(std::string(function) + ": expected a person or blob, found " +
                        kind_of(arguments[0]));
  return seen_thing(world, reference->id);
}

/// A function of one thing; nil where the thing is gone.
template <class F>
Function of_thing(std::string name, std::string summary, F&& value) {
  const std::string own = name;
  return {std::move(name), 1, 1,
          [own, value](const World& world, Values arguments) {
            const SeenThing* const thing = thing_at(world, arguments, own);
            return thing == nullptr ? Value() : value(world, *thing);
          },
          std::move(summary)};
}

Value place_in(const World& world, Values arguments) {
  const SeenThing* const thing = thing_at(world, arguments, "predicted-place");
  if (thing == nullptr)
    return {};
  const double seconds = number_of(arguments, 1, "predicted-place");
  Pose pose = thing->pose_in_odom;
  pose.x += seconds * thing->velocity_in_odom.x();
  pose.y += seconds * thing->velocity_in_odom.y();
  return Value(Point{pose, Frame::odom});
}

}  // namespace

double seconds_unseen(const World& world, const SeenThing& thing) {
  return thing.seen < world.around.cycle
             ? static_cast<double>(world.around.cycle - thing.seen) * kTick
             : 0.0;
}

std::optional<Value> nearest_seen(const World& world, const std::string& what,
                                  const std::optional<Pose>& place) {
  const std::optional<Wanted> kind = wanted(what);
  if (!kind)
    return std::nullopt;
  // One out of sight is only a guess, and may have gone: it does not hide one in sight.
  const Vec2 at = place.value_or(world.robot.pose_in_odom).position();
  const auto rank = [&](const SeenThing& thing) {
    return std::pair(seconds_unseen(world, thing) > kInSight,
                     (thing.pose_in_odom.position() - at).norm());
  };
  const SeenThing* best = nullptr;
  if (world.around.things != nullptr)
    for (const SeenThing& thing : *world.around.things) {
      if (thing.kind != kind->kind || (kind->channel >= 0 && thing.channel != kind->channel))
        continue;
      if (best == nullptr || rank(thing) < rank(*best))
        best = &thing;
    }
  return best == nullptr ? Value() : Value(Reference{Reference::Kind::kThing, best->id, 0});
}

void add_seeing(Functions& functions) {
  functions.add(of_thing("still-seen", "(still-seen THING): itself, or nil once it is forgotten",
                         [](const World&, const SeenThing& thing) {
                           return Value(Reference{Reference::Kind::kThing, thing.id, 0});
                         }));
  functions.add(of_thing("seconds-unseen",
                         "(seconds-unseen THING): since it was seen last [s]; nil once forgotten",
                         [](const World& world, const SeenThing& thing) {
                           return Value(seconds_unseen(world, thing));
                         }));
  functions.add(of_thing(
      "speed-of", "(speed-of THING): how fast it moves [m/s]",
      [](const World&, const SeenThing& thing) { return Value(thing.velocity_in_odom.norm()); }));
  functions.add(of_thing("area-of", "(area-of THING): how much of the picture a blob fills, 0 to 1",
                         [](const World&, const SeenThing& thing) { return Value(thing.area); }));
  functions.add(
      of_thing("confidence-of", "(confidence-of THING): that there is such a thing, 0 to 1",
               [](const World&, const SeenThing& thing) { return Value(thing.confidence); }));
  functions.add(of_thing(
      "range-known", "(range-known THING): whether its place is known, not only its direction",
      [](const World&, const SeenThing& thing) { return Value::truth(thing.range_known); }));
  functions.add("predicted-place", 2, 2,
                "(predicted-place THING SECONDS): where it will be if it goes on as now", place_in);
  functions.add("head-reach", 0, 0,
                "(head-reach): how far the cameras turn to either side [rad]; 0: they are fixed",
                [](const World& world, Values) { return Value(world.around.head_reach); });
  functions.add("head", 0, 0, "(head): the direction of the cameras in the robot [rad]",
                [](const World& world, Values) { return Value(world.robot.head); });
  functions.add("can-see", "whether there is a camera and somebody who looks at its pictures",
                [](const World& world) { return Value::truth(world.around.things != nullptr); });
  functions.add("can-see-colours", "whether one of them is for colours", [](const World& world) {
    return Value::truth(world.around.things != nullptr && world.around.sees_colors);
  });
}

}  // namespace saphira::intentions
