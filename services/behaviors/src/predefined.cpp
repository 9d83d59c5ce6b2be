#include "predefined.hpp"

namespace saphira::behaviors {

Registry predefined() {
  Registry registry;
  registry.add(constant_velocity());
  registry.add(stop());
  registry.add(avoid_collision());
  registry.add(stop_collision());
  registry.add(keep_off());
  registry.add(go_to_pos());
  registry.add(turn_to());
  registry.add(attend_at_pos());
  registry.add(follow());
  registry.add(follow_corridor());
  registry.add(follow_door());
  return registry;
}

}  // namespace saphira::behaviors
