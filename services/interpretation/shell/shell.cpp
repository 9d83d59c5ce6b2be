#include "interpretation/shell/shell.hpp"

#include "interpretation/shell/convert.hpp"
#include "lps/shell/convert.hpp"

namespace saphira::interpretation {

Shell::Shell(bus::Node& node)
    : node_(node),
      cycle_(node),
      robot_(node),
      perceptions_(node.writer(bus::topics::kPerception)) {}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop);
  if (!step)
    return false;
  using Knowledge = bus::KnownRobot::Knowledge;
  const Knowledge known = robot_.of(cycle_.stamp().epoch(), stop);
  if (known == Knowledge::fresh) {
    Settings settings;
    settings.sonars = lps::mounts_from_bus(robot_.description());
    interpretation_ = Interpretation(settings);
    odom_.reset();
  }
  v1::Perception sample;
  if (known != Knowledge::none) {
    // Another origin of the odometry: what was seen is elsewhere.
    if (odom_ && *odom_ != step->robot.odom())
      interpretation_.reset();
    odom_ = step->robot.odom();
    sample = to_bus(
        interpretation_.step({cycle_.stamp().cycle(), lps::from_bus(step->robot.pose_in_odom()),
                              lps::sonars_from_bus(step->robot)}));
  }
  sample.stamp(cycle_.stamp());
  sample.odom(step->robot.odom());
  perceptions_.write(sample);
  cycle_.done();
  return true;
}

}  // namespace saphira::interpretation
