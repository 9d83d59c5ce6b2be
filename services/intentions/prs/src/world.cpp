#include "saphira/intentions/world.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/intentions/value.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {

bool at_rest(const Robot& robot) {
  return std::abs(robot.velocity) < kRestVelocity &&
         std::abs(robot.rotation_velocity) < kRestRotation;
}

std::optional<Pose> in_frame(const Pose& pose, Frame from, Frame to, const Robot& robot) {
  if (from == to)
    return pose;
  if ((from == Frame::map || to == Frame::map) && !robot.odom_in_map)
    return std::nullopt;
  const Pose in_odom = from == Frame::robot ? compose(robot.pose_in_odom, pose)
                       : from == Frame::map ? relative(*robot.odom_in_map, pose)
                                            : pose;
  return to == Frame::robot ? relative(robot.pose_in_odom, in_odom)
         : to == Frame::map ? compose(*robot.odom_in_map, in_odom)
                            : in_odom;
}

const lps::SeenThing* seen_thing(const World& world, std::uint64_t id) {
  if (world.around.things == nullptr)
    return nullptr;
  const auto found = std::find_if(world.around.things->begin(), world.around.things->end(),
                                  [id](const lps::SeenThing& thing) { return thing.id == id; });
  return found == world.around.things->end() ? nullptr : &*found;
}

bool current(const World& world, const Reference& reference) {
  return reference.revision == world.around.map_revision && world.around.topology != nullptr;
}

std::string name_of(const World& world, const Value& value) {
  const Reference* const reference = value.reference();
  if (reference != nullptr && current(world, *reference)) {
    const maps::Topology& map = *world.around.topology;
    if (reference->kind == Reference::Kind::kRegion && reference->id < map.regions().size())
      return map.text(reference->id);
    if (reference->kind == Reference::Kind::kLink && reference->id < map.links().size()) {
      const maps::Link& link = map.links()[reference->id];
      if (link.kind == maps::LinkKind::meeting)
        return "the way into " + map.text(link.b.value_or(link.a));
      std::string name =
          (link.kind == maps::LinkKind::door ? "door " : "opening ") + std::to_string(link.id);
      if (link.b && !map.regions()[*link.b].area.name.empty())
        name += " (" + map.regions()[*link.b].area.name + ")";
      return name;
    }
  }
  return spoken(value);
}

}  // namespace saphira::intentions
