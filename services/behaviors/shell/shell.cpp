#include "behaviors/shell/shell.hpp"

#include "behaviors/shell/convert.hpp"

namespace saphira::behaviors {

Shell::Shell(bus::Node& node)
    : node_(node),
      cycle_(node),
      intentions_(cycle_.input(bus::topics::kIntentions)),
      descriptions_(node.reader(bus::topics::kRobotDescription)),
      commands_(node.writer(bus::topics::kDriveBehaviors)),
      behaviors_(node.writer(bus::topics::kBehaviors)) {}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop);
  if (!step)
    return false;
  Output output;
  if (know_robot(step->robot, stop)) {
    Inputs inputs;
    inputs.cycle = cycle_.stamp().cycle();
    // Another origin of the odometry: what is remembered is elsewhere, and so are the points that
    // were intended before.
    if (odom_ && *odom_ != step->robot.odom()) {
      executive_.reset();
      odom_since_ = inputs.cycle;
    }
    odom_ = step->robot.odom();
    inputs.robot = from_bus(step->robot);
    inputs.sonars = sonars_from_bus(step->robot);
    std::optional<Intent> intent;
    const v1::Intentions* const sample = intentions_.value();
    if (sample != nullptr && sample->stamp().cycle() >= odom_since_)
      inputs.intent = &intent.emplace(from_bus(*sample));
    output = executive_.step(inputs);
  } else {
    wait_for_description();
  }
  publish(output);
  cycle_.done();
  return true;
}

void Shell::take_description() {
  if (auto newest = descriptions_.take_newest())
    description_ = std::move(*newest);
}

bool Shell::know_robot(const v1::RobotState& robot, const bus::Stop& stop) {
  const std::uint64_t epoch = robot.stamp().epoch();
  if (model_epoch_ == epoch)
    return true;
  take_description();
  // The description is written before the first state, but on another topic: it may come later. In
  // lockstep that must not show in what the robot does.
  while (node_.options().lockstep && !stop.requested() &&
         (!description_ || description_->stamp().epoch() != epoch)) {
    node_.wait(std::chrono::milliseconds(500), &stop);
    take_description();
    wait_for_description();
    node_.publish_status();
  }
  if (!description_ || description_->stamp().epoch() != epoch)
    return false;
  executive_.reset(from_bus(*description_));
  model_epoch_ = epoch;
  odom_.reset();
  odom_since_ = 0;
  node_.status().state() = v1::SERVICE_RUNNING;
  node_.status().reason().clear();
  return true;
}

void Shell::wait_for_description() {
  node_.status().state() = v1::SERVICE_WAITING;
  node_.status().reason() = std::string("waits for ") + bus::topics::kRobotDescription.name;
}

void Shell::publish(const Output& output) {
  // First what moves the robot.
  v1::MotorCommand command = command_to_bus(output);
  command.stamp(cycle_.stamp());
  command.source(node_.options().name);
  command.number(++number_);
  commands_.write(command);

  v1::Behaviors sample = to_bus(output);
  sample.stamp(cycle_.stamp());
  behaviors_.write(sample);
  if (output.trouble != trouble_ && !output.trouble.empty())
    node_.warn("behaviors that cannot be had: " + output.trouble);
  trouble_ = output.trouble;
  if (output.active != active_)
    node_.info(output.active ? "drives" : "does not drive: " + output.inactive_reason);
  active_ = output.active;
}

}  // namespace saphira::behaviors
