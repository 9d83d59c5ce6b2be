#include "behaviors/shell/convert.hpp"

#include "lps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/enum_pairs.hpp"

namespace saphira::behaviors {
namespace {

// The bounds of the contract.
constexpr std::size_t kMostRules = 64;
constexpr std::size_t kMostVariables = 64;
constexpr std::size_t kMostAreas = 16;
constexpr std::size_t kMostParameters = 16;
constexpr std::size_t kMostChoices = 16;
constexpr std::size_t kMostSchemas = 1024;

constexpr auto kActions = pairs_by_name<Action, v1::ControlAction>();

}  // namespace

RobotModel from_bus(const v1::RobotDescription& description) {
  RobotModel model;
  model.radius = description.radius;
  model.max_velocity = description.max_velocity;
  model.max_rotation_velocity = description.max_rotation_velocity;
  model.deceleration = description.deceleration;
  model.lps = lps::settings_from_bus(description);
  return model;
}

RobotNow from_bus(const v1::RobotState& state) {
  return {lps::from_bus(state.pose_in_odom), state.velocity,     state.rotation_velocity,
          state.target_heading_in_odom,      state.left_stalled, state.right_stalled};
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
  const Blended& blended = state.blended;
  const Activity& activity = blended.evaluation.activity;
  v1::BehaviorState sample{.name = state.name,
                           .schema = state.schema,
                           .priority = blended.priority,
                           .running = state.running,
                           .turn_activity = activity.turn,
                           .speed_activity = activity.speed,
                           .turn_weight = blended.turn_weight,
                           .speed_weight = blended.speed_weight,
                           .goal = activity.goal,
                           .progress = activity.progress,
                           .recommends_turn = blended.recommends_turn,
                           .turn = blended.turn,
                           .recommends_speed = blended.recommends_speed,
                           .speed = blended.speed};
  sample.rules.reserve(std::min(blended.evaluation.rules.size(), kMostRules));
  for (const Rule& rule : blended.evaluation.rules) {
    if (sample.rules.size() == kMostRules)
      break;
    sample.rules.push_back({.name = rule.name,
                            .strength = rule.strength,
                            .action = kActions.theirs(rule.action),
                            .value = rule.value});
  }
  for (const auto& [name, value] : blended.evaluation.variables) {
    if (sample.variables.size() == kMostVariables)
      break;
    sample.variables.emplace_back();
    sample.variables.back().name = name;
    sample.variables.back().value = value;
  }
  for (const Area& area : blended.evaluation.areas) {
    if (sample.areas.size() == kMostAreas)
      break;
    sample.areas.emplace_back();
    sample.areas.back().x_from = static_cast<float>(area.x_from);
    sample.areas.back().x_to = static_cast<float>(area.x_to);
    sample.areas.back().y_from = static_cast<float>(area.y_from);
    sample.areas.back().y_to = static_cast<float>(area.y_to);
  }
  return sample;
}

v1::BehaviorSet to_bus(const Output& output) {
  v1::BehaviorSet sample{.control = output.control};
  sample.behaviors.reserve(output.behaviors.size());
  for (const BehaviorState& state : output.behaviors)
    sample.behaviors.push_back(to_bus(state));
  sample.turning = output.blend.turning;
  sample.turn = output.blend.turn;
  sample.moving = output.blend.moving;
  sample.speed = output.blend.speed;
  sample.input_age = output.input_age;
  sample.speed_limit = output.speed_limit;
  sample.limit_reason = output.limit_reason;
  for (const Missing& missing : output.missing) {
    sample.missing.emplace_back();
    sample.missing.back().name = missing.name;
    sample.missing.back().reason = missing.reason;
  }
  sample.trouble = output.trouble;
  return sample;
}

v1::BehaviorSchema to_bus(const Schema& schema) {
  v1::BehaviorSchema sample{
      .name = schema.name, .summary = schema.summary, .source = schema.source};
  for (const ParameterSpec& spec : schema.parameters) {
    if (sample.parameters.size() == kMostParameters)
      break;
    v1::BehaviorParameter out{.name = spec.name,
                              .kind = saphira::to_bus(spec.kind),
                              .meaning = spec.meaning,
                              .required = spec.required,
                              .low = spec.low,
                              .high = spec.high,
                              .usual = spec.usual};
    for (const std::string& choice : spec.choices)
      if (out.choices.size() < kMostChoices)
        out.choices.push_back(choice);
    sample.parameters.push_back(std::move(out));
  }
  for (const RuleSpec& rule : schema.rules) {
    if (sample.rules.size() == kMostRules)
      break;
    sample.rules.push_back(
        {.name = rule.name, .antecedent = rule.antecedent, .action = rule.action});
  }
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
