#include "behaviors/shell/shell.hpp"

#include <algorithm>

#include "behaviors/shell/convert.hpp"
#include "behaviors/shell/plugin.hpp"
#include "lps/shell/convert.hpp"

namespace saphira::behaviors {
namespace {

/// Between looks at the behavior files: in cycles, and where there are none.
constexpr std::uint64_t kLook = 10;
constexpr std::uint64_t kLookInLockstep = 100;  // there they are milliseconds
constexpr std::chrono::seconds kIdleLook{1};
/// [s] A command is replaced a cycle after the one that it answers, where nothing is slow.
constexpr double kOrdinaryAge = 0.1;

}  // namespace

Shell::Shell(bus::Node& node, const ShellOptions& options)
    : node_(node),
      cycle_(node),
      intentions_(cycle_.input(bus::topics::kIntentions)),
      robot_(node),
      commands_(node.writer(bus::topics::kDriveBehaviors)),
      behaviors_(node.writer(bus::topics::kBehaviors)),
      recall_(node.writer(bus::topics::kRecallBehaviors)),
      processes_(node, table_),
      schemas_(node.writer(bus::topics::kBehaviorSchemas)) {
  if (!node.options().lockstep)
    grants_.emplace(node.reader(bus::topics::kGrant));
  sources_.add(Folder(behaviors_folder()));
  for (const std::string& path : options.plugins) {
    Registry plugin;
    std::string names;
    for (const std::string& name : load_plugin(path, plugin))
      names.append(names.empty() ? "" : ", ").append(name);
    node_.info(path + " gives " + names);
    sources_.add(std::move(plugin));
  }
  if (!options.folder.empty())
    sources_.add(Folder(options.folder));
  look();
}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] {
    processes_.idle();
    if (std::chrono::steady_clock::now() - looked_ >= kIdleLook)
      look();
  });
  if (!step)
    return false;
  processes_.step(cycle_.stamp());
  Output output;
  using Knowledge = bus::KnownRobot::Knowledge;
  const Knowledge known = robot_.of(cycle_.stamp().epoch(), stop);
  if (known == Knowledge::fresh) {
    executive_.reset(from_bus(robot_.description()));
    delay_ = {};
    odom_.reset();
    odom_since_ = 0;
  }
  if (known != Knowledge::none) {
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
    inputs.sonars = lps::sonars_from_bus(step->robot);
    take_delay();
    inputs.delay = std::max(delay_.peak(), 0.0);
    std::optional<Intent> intent;
    const v1::Intentions* const sample = intentions_.value();
    if (sample != nullptr && sample->stamp().cycle() >= odom_since_)
      inputs.intent = &intent.emplace(from_bus(*sample));
    if (!execution_.works()) {
      intent.emplace();
      intent->cycle = inputs.cycle;
      inputs.intent = &*intent;
    }
    output = executive_.step(inputs);
    if (!execution_.works())
      output.inactive_reason = execution_.name() + " is suspended";
  }
  publish(output);
  // Only now, when the robot has its command.
  if (++steps_ % (node_.options().lockstep ? kLookInLockstep : kLook) == 0)
    look();
  cycle_.done();
  return true;
}

void Shell::take_delay() {
  const auto grant = grants_ ? grants_->take_newest() : std::nullopt;
  const bool mine = grant && grant->role() == v1::ROLE_BEHAVIORS &&
                    grant->stamp().epoch() == cycle_.stamp().epoch() &&
                    grant->source() == node_.options().name;
  delay_.hear(mine ? grant->command_age() - kOrdinaryAge : 0.0);
}

void Shell::look() {
  const bool first = looked_ == std::chrono::steady_clock::time_point{};
  looked_ = std::chrono::steady_clock::now();
  const Folder::News news = sources_.look(executive_.registry());
  for (const std::string& fault : news.faults)
    node_.error(fault + (first ? "" : "\nWhat this file gave before stays in use."));
  // At the start the shipped files are as everybody has them.
  for (const std::string& warning : news.warnings)
    if (!first || !warning.starts_with(behaviors_folder()))
      node_.warn(warning);
  if (!first)
    for (const std::string& file : news.taken)
      node_.info("took " + file);
  if (!news.changed)
    return;
  v1::BehaviorSchemas sample = to_bus(executive_.registry(), sources_.trouble());
  sample.stamp(cycle_.stamp());
  schemas_.write(sample);
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
  recall_.write(sample);
  if (output.trouble != trouble_ && !output.trouble.empty())
    node_.warn("behaviors that cannot be had: " + output.trouble);
  trouble_ = output.trouble;
  if (!output.slow.empty()) {
    node_.status().state(v1::SERVICE_DEGRADED);
    node_.status().reason(output.slow + ": the robot drives more slowly");
  }
  if (output.slow.empty() == slow_) {
    if (slow_)
      node_.info("the network is fast enough again");
    else
      node_.warn(output.slow + ": the robot drives more slowly");
    slow_ = !slow_;
  }
  if (output.active != active_)
    node_.info(output.active ? "drives" : "does not drive: " + output.inactive_reason);
  active_ = output.active;
}

}  // namespace saphira::behaviors
