#include "behaviors/shell/service.hpp"

#include <utility>

#include "behaviors/shell/convert.hpp"
#include "behaviors/shell/plugin.hpp"
#include "lps/shell/convert.hpp"
#include "saphira/command_line/command_line.hpp"

namespace saphira::behaviors {

Service::Service(runtime::Ports& ports, const Options& options)
    : ports_(ports),
      intentions_(ports.cycle(bus::topics::kIntentions)),
      commands_(ports.each_cycle(bus::topics::kDriveBehaviors)),
      behaviors_(ports.each_cycle(bus::topics::kBehaviors)),
      recall_(ports.recall(bus::topics::kRecallBehaviors)),
      schemas_(ports.changes(bus::topics::kBehaviorSchemas)) {
  if (!ports.lockstep())
    grants_.emplace(ports.newest(bus::topics::kGrant));
  Notes notes;
  sources_.add(Folder(behaviors_folder()));
  for (const std::string& path : options.plugins) {
    Registry plugin;
    std::string names;
    for (const std::string& name : load_plugin(path, plugin))
      names.append(names.empty() ? "" : ", ").append(name);
    notes.info(path + " gives " + names);
    sources_.add(std::move(plugin));
  }
  ports_.say(notes.lines());
  if (!options.folder.empty())
    sources_.add(Folder(options.folder));
  check_files();
}

void Service::step(const runtime::Turn& turn) {
  Core::Inputs inputs;
  inputs.cycle = turn.stamp.cycle;
  std::optional<RobotModel> robot;
  if (turn.new_robot)
    inputs.new_robot = &robot.emplace(from_bus(turn.description));
  inputs.new_frame = turn.new_frame;
  if (std::exchange(changed_, false))
    inputs.schemas = &registry_;
  inputs.robot = from_bus(turn.robot);
  inputs.sonars = lps::sonars_from_bus(turn.robot);
  if (const v1::Intentions* const intentions = intentions_.value())
    inputs.intent = from_bus(*intentions);
  inputs.command_age = command_age(turn);

  const Core::Outputs outputs = core_->step(inputs);
  v1::MotorCommand command = command_to_bus(outputs.output);
  command.source = ports_.name();
  command.number = outputs.number;
  if (const v1::Intentions* const intentions = intentions_.value()) {
    command.heeds = intentions->heeds;
    command.edges = intentions->edges;
  }
  commands_.write(command);
  v1::BehaviorSet sample = to_bus(outputs.output);
  behaviors_.write(sample);
  recall_.write(sample);
  if (!outputs.degraded.empty())
    ports_.degrade(outputs.degraded);
  ports_.say(outputs.notes.lines());
}

std::optional<double> Service::command_age(const runtime::Turn& turn) {
  const auto grant = grants_ ? grants_->take_newest() : std::nullopt;
  if (!grant || grant->role != v1::ROLE_BEHAVIORS || grant->stamp.epoch != turn.stamp.epoch ||
      grant->source != ports_.name())
    return std::nullopt;
  return grant->command_age;
}

void Service::check_files() {
  const bool first = !std::exchange(looked_, true);
  const Folder::Reload reload = sources_.reload(registry_);
  Notes notes;
  for (const std::string& fault : reload.faults)
    notes.error(fault);
  // At the start, warnings about the shipped files are not logged.
  for (const std::string& warning : reload.warnings)
    if (!first || !warning.starts_with(behaviors_folder()))
      notes.warn(warning);
  if (!first)
    for (const std::string& file : reload.taken)
      notes.info("took " + file);
  for (const std::string& file : reload.gone)
    notes.info(file + " is gone");
  ports_.say(notes.lines());
  changed_ = changed_ || reload.changed;
  if (reload.changed)
    schemas_.write(to_bus(registry_, sources_.trouble()));
}

runtime::Component component() {
  const auto options = std::make_shared<Options>();
  return {"behaviors", "Evaluates the behaviors that are intended and blends them",
          [options](CommandLine& app) {
            app.add_option("--behaviors", options->folder,
                           "folder of behavior files; they cover shipped ones of the same name");
            app.add_option("--plugin", options->plugins,
                           "shared library with behaviors in C++; may be given several times");
          },
          [options](runtime::Ports& ports) { return std::make_unique<Service>(ports, *options); }};
}

}  // namespace saphira::behaviors
