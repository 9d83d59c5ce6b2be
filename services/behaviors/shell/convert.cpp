#include "behaviors/shell/convert.hpp"

#include "lps/shell/convert.hpp"
#include "requests/shell/convert.hpp"

namespace saphira::behaviors {
namespace {

// The bounds of the contract.
constexpr std::size_t kMostRules = 64;
constexpr std::size_t kMostVariables = 64;
constexpr std::size_t kMostAreas = 16;
constexpr std::size_t kMostParameters = 16;
constexpr std::size_t kMostChoices = 16;
constexpr std::size_t kMostSchemas = 1024;

}  // namespace

RobotModel from_bus(const v1::RobotDescription& description) {
  auto model = translated<RobotModel>(description);
  model.lps = lps::settings_from_bus(description);
  return model;
}

RobotNow from_bus(const v1::RobotState& state) {
  return translated<RobotNow>(state);
}

Intent from_bus(const v1::Intentions& intentions) {
  Intent intent;
  intent.cycle = intentions.stamp.cycle;
  intent.control = intentions.behavior_control;
  if (!intentions.limit_reason.empty()) {
    intent.speed_limit = intentions.speed_limit;
    intent.limit_reason = intentions.limit_reason;
  }
  intent.behaviors.reserve(intentions.behaviors.size());
  for (const v1::IntendedBehavior& behavior : intentions.behaviors) {
    intent.behaviors.push_back({behavior.name, behavior.schema, behavior.priority, behavior.running,
                                saphira::from_bus(behavior.parameters)});
  }
  return intent;
}

v1::BehaviorState to_bus(const BehaviorState& state) {
  const Evaluation& evaluation = state.blended.evaluation;
  auto sample = translated<v1::BehaviorState>(state);
  take(sample, state.blended);
  take(sample, evaluation);
  sample.turn_activity = evaluation.activity.turn;
  sample.speed_activity = evaluation.activity.speed;
  sample.goal = evaluation.activity.goal;
  sample.progress = evaluation.activity.progress;
  for (const auto& [name, value] : evaluation.variables)
    sample.variables.push_back({.name = name, .value = value});
  shorten(sample.rules, kMostRules);
  shorten(sample.variables, kMostVariables);
  shorten(sample.areas, kMostAreas);
  return sample;
}

v1::BehaviorSet to_bus(const Output& output) {
  auto sample = translated<v1::BehaviorSet>(output);
  take(sample, output.blend);
  sample.behaviors =
      converted(output.behaviors, [](const BehaviorState& state) { return to_bus(state); });
  return sample;
}

v1::BehaviorSchema to_bus(const Schema& schema) {
  auto sample = translated<v1::BehaviorSchema>(schema);
  shorten(sample.parameters, kMostParameters);
  for (v1::BehaviorParameter& parameter : sample.parameters)
    shorten(parameter.choices, kMostChoices);
  shorten(sample.rules, kMostRules);
  return sample;
}

v1::BehaviorSchemas to_bus(const Registry& registry, const std::string& trouble) {
  v1::BehaviorSchemas sample;
  for (const std::string& name : registry.names())
    if (sample.schemas.size() < kMostSchemas)
      sample.schemas.push_back(to_bus(*registry.find(name)));
  sample.trouble = trouble;
  return sample;
}

v1::MotorCommand command_to_bus(const Output& output) {
  v1::MotorCommand command{.active = output.active};
  if (output.active) {
    command.translation = v1::TRANSLATION_VELOCITY;
    command.velocity = output.speed;
    command.contact_speed = output.contact_speed;
    command.rotation = v1::ROTATION_HEADING;
    command.heading = output.heading_in_odom;
  }
  return command;
}

}  // namespace saphira::behaviors
