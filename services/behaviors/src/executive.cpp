#include "saphira/behaviors/executive.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

namespace saphira::behaviors {
namespace {

/// The parameter by which a behavior says that it means contact: [m/s] at no more than this.
constexpr const char* kContact = "contact";

/// Nothing that is not a number may get to the robot. Returns what is wrong.
std::string check(Evaluation& evaluation) {
  std::string wrong = std::move(evaluation.trouble);
  const auto bad = [&](const std::string& what) {
    wrong += (wrong.empty() ? "" : ", ") + what + " is not a number";
  };
  for (Rule& rule : evaluation.rules)
    if (!std::isfinite(rule.strength) || !std::isfinite(rule.value)) {
      rule.strength = 0.0;
      rule.value = 0.0;
      bad("rule \"" + rule.name + "\"");
    }
  Activity& activity = evaluation.activity;
  for (double* const value : {&activity.turn, &activity.speed, &activity.goal, &activity.progress})
    if (!std::isfinite(*value)) {
      *value = 0.0;
      bad("the activity");
    }
  evaluation.trouble = wrong;
  return wrong;
}

}  // namespace

Executive::Executive(Registry registry, RobotModel model, ExecutiveSettings settings)
    : registry_(std::move(registry)),
      model_(std::move(model)),
      settings_(settings),
      lps_(model_.lps) {}

void Executive::reset() {
  lps_.reset();
  instances_.clear();
  reconciled_.clear();
  reconcile_trouble_.clear();
  missing_.clear();
}

void Executive::reset(RobotModel model) {
  model_ = std::move(model);
  lps_ = lps::LocalPerceptualSpace(model_.lps);
  instances_.clear();
  reconciled_.clear();
  reconcile_trouble_.clear();
  missing_.clear();
}

Output Executive::step(const Inputs& inputs) {
  lps_.update(inputs.robot.pose_in_odom, inputs.sonars, inputs.cycle);
  Output output;
  if (inputs.intent != nullptr) {
    output.control = inputs.intent->control;
    output.trouble = reconcile(inputs.intent->behaviors, inputs.robot.pose_in_odom);
    output.missing = missing_;
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
    // A plug-in may throw; the others run on, and it is asked again in the next cycle.
    try {
      if (!std::exchange(instance.initialised, true))
        instance.behavior->init(instance.parameters, context);
      blended[i].evaluation = instance.behavior->update(instance.parameters, context);
    } catch (const std::exception& error) {
      blended[i].evaluation = {};
      blended[i].evaluation.trouble = error.what();
    }
    if (const std::string wrong = check(blended[i].evaluation); !wrong.empty())
      output.trouble +=
          (output.trouble.empty() ? "" : "; ") + instance.intended.name + ": " + wrong;
  }
  output.blend = blend(blended, inputs.robot.velocity);
  output.contact_speed = contact_speed(blended);
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
  else if (const auto missing = std::find_if(missing_.begin(), missing_.end(),
                                             [](const Missing& one) { return one.running; });
           missing != missing_.end())
    output.inactive_reason = missing->name + " cannot be made: " + missing->reason;
  else if (!running)
    output.inactive_reason = "no running behavior is intended";
  output.active = output.inactive_reason.empty();
  // Where nobody recommends a speed the robot stands: the last setpoint belongs to a past context.
  const double limit = model_.max_velocity;
  output.speed = output.blend.moving ? std::clamp(output.blend.speed, -limit, limit) : 0.0;
  output.heading_in_odom = norm2_angle(inputs.robot.pose_in_odom.th + output.blend.turn);
  return output;
}

double Executive::contact_speed(const std::vector<Blended>& blended) const {
  std::optional<double> least;
  for (std::size_t i = 0; i < instances_.size(); ++i)
    if (blended[i].recommends_speed && blended[i].speed_weight > 0.0)
      least = std::min(least.value_or(std::numeric_limits<double>::infinity()),
                       instances_[i].parameters.number_if_any(kContact).value_or(0.0));
  return std::max(least.value_or(0.0), 0.0);
}

std::string Executive::reconcile(const std::vector<Intended>& intended, const Pose& robot_in_odom) {
  // Most cycles want what the one before has wanted.
  if (reconciled_revision_ == registry_.revision() && reconciled_ == intended)
    return reconcile_trouble_;
  std::map<std::string, Instance*> known;  // by copies: instances are moved from below
  for (Instance& instance : instances_)
    known.emplace(instance.intended.name, &instance);
  std::set<std::string_view> seen;
  std::string trouble;
  missing_.clear();
  std::vector<Instance> next;
  next.reserve(intended.size());
  for (const Intended& wanted : intended) {
    std::string wrong;
    const auto found = known.find(wanted.name);
    Instance* const same = found != known.end() && found->second->intended.schema == wanted.schema
                               ? found->second
                               : nullptr;
    if (!seen.insert(wanted.name).second)
      wrong = "the name is there twice; the first one holds";
    else if (const std::size_t before = next.size();
             !(wrong = adopt(wanted, robot_in_odom, same, next)).empty() && next.size() == before)
      missing_.push_back({wanted.name, wrong, wanted.running});
    if (!wrong.empty())
      trouble += (trouble.empty() ? "" : "; ") + wanted.name + ": " + wrong;
  }
  // By name among equals: the order of the set must not show in the result.
  std::stable_sort(next.begin(), next.end(), [](const Instance& a, const Instance& b) {
    return std::tie(a.intended.priority, a.intended.name) <
           std::tie(b.intended.priority, b.intended.name);
  });
  instances_ = std::move(next);
  reconciled_ = intended;
  reconciled_revision_ = registry_.revision();
  reconcile_trouble_ = trouble;
  return trouble;
}

std::string Executive::adopt(const Intended& wanted, const Pose& robot_in_odom, Instance* same,
                             std::vector<Instance>& next) {
  const Schema* const schema = registry_.find(wanted.schema);
  const auto keep = [&] {
    Instance instance = std::move(*same);
    instance.intended = wanted;
    next.push_back(std::move(instance));
  };
  // One whose schema is gone stays as long as nothing else is wanted of it.
  const bool current = same != nullptr && (schema == nullptr || same->revision == schema->revision);
  if (current && same->intended.parameters == wanted.parameters) {
    keep();
    return {};
  }
  if (schema == nullptr) {
    std::string names;
    for (const std::string& name : registry_.names())
      names += (names.empty() ? "" : ", ") + name;
    return "unknown schema \"" + wanted.schema + "\"; there are " + names;
  }
  std::string trouble;
  std::optional<Parameters> parameters =
      Parameters::check(schema->parameters, wanted.parameters, robot_in_odom, trouble);
  if (!parameters) {
    if (same == nullptr || same->intended.parameters != wanted.parameters)
      return trouble;
    // The new version wants other parameters than those that were fine: the old one runs on.
    keep();
    return "its schema has changed, and the old version runs on: " + trouble;
  }
  Instance instance;
  if (current) {
    instance = std::move(*same);
  } else {
    // That of a plug-in may throw.
    try {
      instance.behavior = schema->make();
      if (instance.behavior == nullptr)
        return "its schema has made none";
      if (same != nullptr)
        instance.behavior->take_over(*same->behavior);
    } catch (const std::exception& error) {
      return error.what();
    }
  }
  instance.revision = schema->revision;
  instance.intended = wanted;
  instance.parameters = std::move(*parameters);
  next.push_back(std::move(instance));
  return {};
}

}  // namespace saphira::behaviors
