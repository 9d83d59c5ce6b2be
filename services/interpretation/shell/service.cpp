#include "interpretation/shell/service.hpp"

#include "interpretation/shell/convert.hpp"
#include "lps/shell/convert.hpp"

namespace saphira::interpretation {

Service::Service(runtime::Ports& ports)
    : perceptions_(ports.each_cycle(bus::topics::kPerception)),
      tiles_(ports.changes(bus::topics::kGrid)) {}

void Service::step(const runtime::Turn& turn) {
  Core::Inputs inputs;
  inputs.cycle = turn.stamp.cycle;
  std::vector<lps::SonarMount> sonars;
  if (turn.new_robot) {
    sonars = lps::mounts_from_bus(turn.description);
    inputs.new_robot = &sonars;
  }
  inputs.new_frame = turn.new_frame;
  inputs.pose_in_odom = lps::from_bus(turn.robot.pose_in_odom);
  inputs.readings = lps::sonars_from_bus(turn.robot);

  const Core::Outputs outputs = core_->step(inputs);
  v1::Perception sample = to_bus(*outputs.output);
  sample.odom = turn.robot.odom;
  perceptions_.write(std::move(sample));
  for (const TileKey& key : outputs.gone)
    tiles_.dispose(to_bus(key));
  for (const TileKey& key : outputs.tiles) {
    v1::GridTile tile = to_bus(core_->grid(), key);
    tile.odom = turn.robot.odom;
    tiles_.write(std::move(tile));
  }
}

runtime::Component component() {
  return {"interpretation",
          "Finds walls, doors and corridors in the sonars' readings",
          {},
          [](runtime::Ports& ports) { return std::make_unique<Service>(ports); }};
}

}  // namespace saphira::interpretation
