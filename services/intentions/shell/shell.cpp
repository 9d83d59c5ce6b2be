#include "intentions/shell/shell.hpp"

#include <algorithm>

#include "intentions/shell/convert.hpp"
#include "saphira/intentions/functors.hpp"

namespace saphira::intentions {
namespace {

/// Without a cycle for this long there is no robot, live.
constexpr std::chrono::seconds kSilence{1};

}  // namespace

Shell::Shell(bus::Node& node, const ShellOptions& options)
    : node_(node),
      cycle_(node),
      behaviors_(cycle_.input(bus::topics::kBehaviors)),
      registration_(options.registration ? &cycle_.input(bus::topics::kRegistration) : nullptr),
      goals_(node.reader(bus::topics::kGoals)),
      intentions_(node.writer(bus::topics::kIntentions)),
      recall_(node.writer(bus::topics::kRecallIntentions)),
      statuses_(node.writer(bus::topics::kGoalStatus)),
      memory_(options.memory_file),
      executor_(built_in(), memory_.memory()),
      processes_(node, table_,
                 [this](const std::string& name, ProcessAction action, std::uint32_t cycles) {
                   return ask_intention(name, action, cycles);
                 }) {}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] { idle(); });
  if (!step)
    return false;
  stamp_ = cycle_.stamp();
  stepped_ = Clock::now();
  robot_here_ = true;

  Inputs inputs;
  inputs.epoch = stamp_.epoch();
  inputs.cycle = stamp_.cycle();
  inputs.robot = from_bus(step->robot);
  if (const v1::Behaviors* const behaviors = behaviors_.value()) {
    inputs.behaviors = from_bus(*behaviors);
    inputs.behaviors_cycle = behaviors->stamp().cycle();
  }
  if (const v1::Registration* const registration =
          registration_ == nullptr ? nullptr : registration_->value())
    inputs.robot.odom_in_map =
        odom_in_map_from_bus(*registration, stamp_.cycle(), inputs.robot.odom);
  inputs.events = take_events();
  processes_.step(stamp_);
  if (!execution_.works())
    inputs.hold = execution_.name() + " is suspended";
  const Outputs outputs = executor_.step(inputs);
  nodes_ = outputs.nodes;

  v1::Intentions sample;
  sample.stamp(stamp_);
  sample.behavior_control(true);
  for (const IntendedBehavior& behavior : outputs.behaviors)
    sample.behaviors().push_back(to_bus(behavior));
  for (const IntentionNode& node : outputs.nodes)
    sample.nodes().push_back(to_bus(node));
  intentions_.write(sample);
  recall_.write(sample);
  publish(outputs.news);
  cycle_.done();
  return true;
}

void Shell::idle() {
  processes_.idle();
  publish(executor_.hear(take_events()));
  // A simulator that is being single-stepped may stand still for as long as it likes.
  if (robot_here_ && !node_.options().lockstep && Clock::now() - stepped_ > kSilence) {
    robot_here_ = false;
    publish(executor_.robot_gone());
  }
}

std::optional<std::string> Shell::ask_intention(const std::string& name, ProcessAction action,
                                                std::uint32_t cycles) {
  const auto node = std::find_if(nodes_.begin(), nodes_.end(), [&](const IntentionNode& one) {
    return one.name == name || std::to_string(one.id) == name ||
           "I" + std::to_string(one.id) == name;
  });
  if (node == nodes_.end())
    return std::nullopt;
  if (cycles > 0)
    return "an intention is interrupted until it is resumed, not for some cycles";
  if (action == ProcessAction::resume)
    return executor_.resume(node->id) ? "" : name + " was not interrupted";
  return executor_.interrupt(node->id) ? "" : name + " is not an intention any more";
}

std::vector<GoalEvent> Shell::take_events() {
  std::vector<GoalEvent> events;
  for (const auto& sample : goals_.take()) {
    GoalEvent event;
    event.goal = from_bus(sample.data);
    event.kind = sample.info.disposed ? GoalEvent::Kind::kDisposed : GoalEvent::Kind::kWritten;
    if (!sample.info.disposed)
      writers_[event.goal.id] = sample.info.writer;
    events.push_back(std::move(event));
  }
  for (const bus::WriterId& lost : goals_.take_lost()) {
    for (const auto& [id, writer] : writers_) {
      if (writer != lost)
        continue;
      GoalEvent event;
      event.kind = GoalEvent::Kind::kWriterLost;
      event.goal.id = id;
      events.push_back(std::move(event));
    }
  }
  return events;
}

void Shell::publish(const News& news) {
  // On the disk before anybody hears of an end: nobody sees a goal that has ended begin again.
  std::string lines;
  for (const Placement& placement : news.placed)
    lines += write_line(placement);
  for (const Ending& ending : news.endings)
    lines += write_line(ending);
  if (!lines.empty() && !memory_.append(lines))
    node_.warn("the memory file cannot be written: a restart may do a finished goal again");

  for (const GoalStatus& status : news.changed) {
    if (!statuses_.write(to_bus(status, stamp_)))
      node_.warn("the status of goal " + describe(status.id) + " did not get onto the bus");
    const auto logged = logged_.find(status.id);
    if (logged != logged_.end() && logged->second == status.state)
      continue;
    logged_[status.id] = status.state;
    node_.info("goal " + describe(status.id) + ", " + quoted(status.functor) + " of " +
               quoted(status.requester) + ": " + name_of(status.state) +
               (status.reason.empty() ? "" : ": " + status.reason));
  }
  for (const GoalId& id : news.withdrawn) {
    GoalStatus status;
    status.id = id;
    statuses_.dispose(to_bus(status, stamp_));
    writers_.erase(id);
    logged_.erase(id);
  }
}

}  // namespace saphira::intentions
