#include "saphira/behaviors/core.hpp"

#include <algorithm>

namespace saphira::behaviors {
namespace {

/// [s] Without delays a command is replaced a cycle after the one that it answers.
constexpr double kOrdinaryAge = 0.1;

}  // namespace

Core::Outputs Core::step(const Inputs& inputs) {
  begin(inputs);
  behaviors::Inputs now;
  now.cycle = inputs.cycle;
  now.robot = inputs.robot;
  now.sonars = inputs.sonars;
  now.delay = std::max(delay_.hear(inputs.command_age.value_or(kOrdinaryAge) - kOrdinaryAge), 0.0);
  // Points of an earlier intent have another place in the new frame.
  if (inputs.intent && inputs.intent->cycle >= frame_since_)
    now.intent = &*inputs.intent;
  Intent nothing;
  nothing.cycle = inputs.cycle;
  if (!execution_.works())
    now.intent = &nothing;
  Outputs outputs;
  outputs.output = executive_.step(now);
  if (!execution_.works())
    outputs.output.inactive_reason = execution_.name() + " is suspended";
  outputs.number = ++number_;
  report(outputs.output, outputs);
  return outputs;
}

void Core::begin(const Inputs& inputs) {
  if (inputs.schemas != nullptr)
    executive_.registry() = *inputs.schemas;
  if (inputs.new_robot != nullptr) {
    executive_.reset(*inputs.new_robot);
    delay_ = {};
    frame_since_ = 0;
  } else if (inputs.new_frame) {
    executive_.reset();
    frame_since_ = inputs.cycle;
  }
}

void Core::report(const Output& output, Outputs& outputs) {
  if (output.trouble != trouble_ && !output.trouble.empty())
    outputs.notes.warn("behaviors that cannot be had: " + output.trouble);
  trouble_ = output.trouble;
  const bool slow = !output.slow.empty();
  if (slow)
    outputs.degraded = output.slow + ": the robot drives more slowly";
  // While it does not drive, nothing shows how fast the network is.
  if (output.active && slow != slow_) {
    if (slow)
      outputs.notes.warn(outputs.degraded);
    else
      outputs.notes.info("the network is fast enough again");
    slow_ = slow;
  }
  if (output.active != active_)
    outputs.notes.info(output.active ? "drives" : "does not drive: " + output.inactive_reason);
  active_ = output.active;
}

}  // namespace saphira::behaviors
