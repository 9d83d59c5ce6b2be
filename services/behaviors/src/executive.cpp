#include "saphira/behaviors/executive.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace saphira::behaviors {

Executive::Executive(Registry registry, RobotModel model, ExecutiveSettings settings)
    : registry_(std::move(registry)),
      model_(std::move(model)),
      settings_(settings),
      lps_(model_.lps) {}

void Executive::reset() {
  lps_.reset();
  instances_.clear();
}

void Executive::reset(RobotModel model) {
  model_ = std::move(model);
  lps_ = lps::LocalPerceptualSpace(model_.lps);
  instances_.clear();
}

Output Executive::step(const Inputs& inputs) {
  lps_.update(inputs.robot.pose_in_odom, inputs.sonars, inputs.cycle);
  Output output;
  if (inputs.intent != nullptr) {
    output.control = inputs.intent->control;
    output.trouble = reconcile(inputs.intent->behaviors, inputs.robot.pose_in_odom);
  }

  Shared shared;
  const Context context{model_, inputs.robot, lps_, inputs.cycle, shared};
  std::vector<Blended> blended(instances_.size());
  bool running = false;
  for (std::size_t i = instances_.size(); i-- > 0;) {
    Instance& instance = instances_[i];
    blended[i].priority = instance.intended.priority;
    if (!instance.intended.running)
      continue;
    running = true;
    if (!std::exchange(instance.initialised, true))
      instance.behavior->init(instance.parameters, context);
    blended[i].evaluation = instance.behavior->update(instance.parameters, context);
  }
  output.blend = blend(blended, inputs.robot.velocity);
  for (std::size_t i = 0; i < instances_.size(); ++i)
    output.behaviors.push_back({instances_[i].intended.name, instances_[i].intended.schema,
                                instances_[i].intended.running, std::move(blended[i])});

  if (inputs.intent == nullptr)
    output.inactive_reason = "nothing has been intended yet";
  else if (inputs.cycle > inputs.intent->cycle + settings_.intent_lease)
    output.inactive_reason = "the newest intent is " +
                             std::to_string(inputs.cycle - inputs.intent->cycle) + " cycles old";
  else if (!output.control)
    output.inactive_reason = "behavior control is off";
  else if (!running)
    output.inactive_reason = "no running behavior is intended";
  output.active = output.inactive_reason.empty();
  // Where nobody recommends a speed the robot stands: the last setpoint belongs to a past context.
  const double limit = model_.max_velocity;
  output.speed = output.blend.moving ? std::clamp(output.blend.speed, -limit, limit) : 0.0;
  output.heading_in_odom = norm2_angle(inputs.robot.pose_in_odom.th + output.blend.turn);
  return output;
}

std::string Executive::reconcile(const std::vector<Intended>& intended, const Pose& robot_in_odom) {
  std::string trouble;
  std::vector<Instance> next;
  next.reserve(intended.size());
  for (const Intended& wanted : intended)
    if (const std::string wrong = adopt(wanted, robot_in_odom, next); !wrong.empty())
      trouble += (trouble.empty() ? "" : "; ") + wanted.name + ": " + wrong;
  // By name among equals: the order of the set must not show in the result.
  std::stable_sort(next.begin(), next.end(), [](const Instance& a, const Instance& b) {
    return std::tie(a.intended.priority, a.intended.name) <
           std::tie(b.intended.priority, b.intended.name);
  });
  instances_ = std::move(next);
  return trouble;
}

std::string Executive::adopt(const Intended& wanted, const Pose& robot_in_odom,
                             std::vector<Instance>& next) {
  if (std::any_of(next.begin(), next.end(),
                  [&](const Instance& i) { return i.intended.name == wanted.name; }))
    return "the name is there twice; the first one holds";
  const auto same = std::find_if(instances_.begin(), instances_.end(), [&](const Instance& i) {
    return i.behavior != nullptr && i.intended.name == wanted.name &&
           i.intended.schema == wanted.schema;
  });
  const bool known = same != instances_.end();
  if (known && same->intended.parameters == wanted.parameters) {
    next.push_back(std::move(*same));
    next.back().intended = wanted;
    return {};
  }
  const Schema* const schema = registry_.find(wanted.schema);
  if (schema == nullptr) {
    std::string names;
    for (const std::string& name : registry_.names())
      names += (names.empty() ? "" : ", ") + name;
    return "unknown schema \"" + wanted.schema + "\"; there are " + names;
  }
  std::string trouble;
  std::optional<Parameters> parameters =
      Parameters::check(schema->parameters, wanted.parameters, robot_in_odom, trouble);
  if (!parameters)
    return trouble;
  Instance instance;
  if (known)
    instance = std::move(*same);
  else
    instance.behavior = schema->make();
  instance.intended = wanted;
  instance.parameters = std::move(*parameters);
  next.push_back(std::move(instance));
  return {};
}

}  // namespace saphira::behaviors
