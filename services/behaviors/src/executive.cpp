#include "saphira/behaviors/executive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "free_path.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/text.hpp"
#include "saphira/behaviors/foresight.hpp"

namespace saphira::behaviors {
namespace {

/// The parameter by which a behavior wants contact: [m/s] at most.
constexpr const char* kContact = "contact";
constexpr double kFarEnough = 3.0;       // [m] of free way that counts
constexpr double kMargin = 0.05;         // [m] by which a sonar's obstacle may be nearer,
constexpr double kMarginOfRange = 0.03;  // and that per metre
// The bearing of a contact that stalls one wheel.
constexpr double kTouchBearing = radians(60.0);
// A robot that wants to drive but is held turns to and fro, so that its beams sweep the gaps
// between them: the guard beside the robot forgets an echo only where a beam looks.
constexpr double kHeld = 0.015;           // [m/s] slower than this it stands
constexpr std::uint64_t kSweep = 20;      // [cycles] until it turns, and in each direction
constexpr double kSwing = radians(20.0);  // the first two turns; later ones are wider
constexpr std::uint64_t kWidest = 3;      // times as wide
constexpr const char* kSlow = "the network, or a computer, is slow: ";

std::string number(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string seconds(double value) {
  return number("%.1f s", value);
}

std::string meters(double value) {
  return number("%.2f m", value);
}

/// The age of the intent [cycles].
double intent_cycles(const Inputs& inputs) {
  const std::uint64_t intended = inputs.intent->cycle;
  return inputs.cycle > intended ? static_cast<double>(inputs.cycle - intended) : 0.0;
}

/// No NaN or infinity may reach the robot. Returns the errors.
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
  reset(std::move(model_));
}

void Executive::reset(RobotModel model) {
  *this = Executive(std::move(registry_), std::move(model), settings_);
}

void Executive::archive(Archive& a) {
  std::vector<Saved> memories;
  if (!a.restores())
    for (const Instance& instance : instances_)
      memories.push_back({saved(*instance.behavior)});
  a("model", model_)("lps", lps_)("instances", instances_)("memories", memories)(
      "reconciled", reconciled_)("reconcile_trouble", reconcile_trouble_)("missing", missing_)(
      "newest_intent", newest_intent_)("intent_came", intent_came_)("held", held_)(
      "backwards", backwards_)("intent_age", intent_age_);
  if (!a.restores())
    return;
  a.expect(memories.size() == instances_.size(), "a memory for each instance");
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    const std::string& name = instances_[i].intended.schema;
    const Schema* const schema = registry_.find(name);
    a.expect(schema != nullptr, "no schema but " + joined(registry_.names()) + ": " + name);
    instances_[i].revision = schema->revision;
    instances_[i].behavior = schema->make();
    restore(memories[i].text, *instances_[i].behavior);
  }
  reconciled_revision_ = registry_.revision();
}

// A stall gives the side, and the sign of the commanded speed gives front or back.
void Executive::feel(const RobotNow& robot) {
  if (!robot.left_stalled && !robot.right_stalled)
    return;
  double bearing = 0.0;
  if (!robot.right_stalled)
    bearing = kTouchBearing;
  else if (!robot.left_stalled)
    bearing = -kTouchBearing;
  if (backwards_)
    bearing = kPi - bearing;
  lps_.touch(model_.radius * Vec2(std::cos(bearing), std::sin(bearing)));
}

Output Executive::step(const Inputs& inputs) {
  lps_.update(inputs.robot.pose_in_odom, inputs.sonars, inputs.cycle);
  feel(inputs.robot);
  Output output;
  if (inputs.intent != nullptr) {
    if (newest_intent_ != inputs.intent->cycle || intent_came_ == 0) {
      newest_intent_ = inputs.intent->cycle;
      intent_came_ = inputs.cycle;
    }
    // The intent of the cycle before has no delay. Ageing in silence is no delay: when the network
    // is back, the delay is as before.
    if (!silent(inputs))
      intent_age_.hear(kCycle * (intent_cycles(inputs) - 1.0));
    output.input_age = kCycle * intent_cycles(inputs);
    output.control = inputs.intent->control;
    output.trouble = reconcile(inputs.intent->behaviors, inputs.robot.pose_in_odom);
    output.missing = missing_;
  }

  const bool late = inputs.delay > 0.0;
  const RobotNow ahead = late ? foresee(inputs.robot, inputs.delay) : inputs.robot;
  std::optional<lps::LocalPerceptualSpace> seen_ahead;
  if (late)
    seen_ahead = lps_.seen_from(ahead.pose_in_odom);
  Shared shared;
  const Context context{model_, ahead, late ? *seen_ahead : lps_, inputs.cycle, shared};
  std::vector<Blended> blended(instances_.size());
  bool running = false;
  for (std::size_t i = instances_.size(); i-- > 0;) {
    Instance& instance = instances_[i];
    blended[i].priority = instance.intended.priority;
    if (!instance.intended.running)
      continue;
    running = true;
    // A plug-in may throw; the others continue, and it is called again in the next cycle.
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

  output.inactive_reason = why_inactive(inputs, running);
  output.active = output.inactive_reason.empty();
  // Without a recommended speed the robot stands: the last setpoint belongs to a past context.
  const double limit = model_.max_velocity;
  output.speed = output.blend.moving ? std::clamp(output.blend.speed, -limit, limit) : 0.0;
  output.heading_in_odom = norm2_angle(ahead.pose_in_odom.th + output.blend.turn);
  if (inputs.intent != nullptr && !(output.limit_reason = why_unheard(inputs)).empty())
    output.speed_limit = 0.0;
  else
    limit_speed(inputs, output);
  obey_limit(inputs, output);
  backwards_ = output.speed < 0.0;
  sweep(inputs.robot, output);
  return output;
}

void Executive::sweep(const RobotNow& robot, Output& output) {
  const bool held = output.active && output.contact_speed == 0.0 &&
                    std::abs(output.speed) > kHeld && std::abs(robot.velocity) < kHeld;
  held_ = held ? held_ + 1 : 0;
  const std::uint64_t turn = held_ / kSweep;
  if (turn == 0)
    return;
  const double swing = kSwing * static_cast<double>(std::min((turn + 1) / 2, kWidest));
  output.heading_in_odom = norm2_angle(output.heading_in_odom + (turn % 2 == 1 ? swing : -swing));
}

double Executive::contact_speed(const std::vector<Blended>& blended) const {
  std::optional<double> least;
  for (std::size_t i = 0; i < instances_.size(); ++i)
    if (blended[i].recommends_speed && blended[i].speed_weight > 0.0)
      least = std::min(least.value_or(std::numeric_limits<double>::infinity()),
                       instances_[i].parameters.number_if_any(kContact).value_or(0.0));
  return std::max(least.value_or(0.0), 0.0);
}

bool Executive::silent(const Inputs& inputs) const {
  return inputs.cycle >= intent_came_ + settings_.intent_lease;
}

std::string Executive::why_unheard(const Inputs& inputs) const {
  if (silent(inputs))
    return "no newer intent has come for " + std::to_string(inputs.cycle - intent_came_) +
           " cycles: intentions, or the network to it, is slow or gone";
  if (intent_age_.peak() > kOldest)
    return kSlow + ("intents are, or were a moment ago, " + seconds(intent_age_.peak())) +
           " old, which is too old to drive by";
  return {};
}

std::string Executive::why_inactive(const Inputs& inputs, bool running) const {
  if (inputs.intent == nullptr)
    return "nothing has been intended yet";
  if (std::string unheard = why_unheard(inputs); !unheard.empty())
    return unheard;
  if (!inputs.intent->control)
    return "behavior control is off";
  const auto missing = std::find_if(missing_.begin(), missing_.end(),
                                    [](const Missing& one) { return one.running; });
  if (missing != missing_.end())
    return missing->name + " cannot be made: " + missing->reason;
  return running ? "" : "no running behavior is intended";
}

void Executive::limit_speed(const Inputs& inputs, Output& output) {
  const double old = intent_age_.peak();
  const double age = old + inputs.delay;
  if (age <= 0.0)
    return;
  output.speed_limit = speed_for_age(age);
  std::string why =
      inputs.delay <= 0.0 ? "" : "commands take effect " + seconds(inputs.delay) + " late";
  if (old > 0.0)
    why = "intentions are " + seconds(old) + " old" + (why.empty() ? "" : ", " + why);
  if (output.speed_limit < std::max(std::abs(output.speed), model_.max_velocity))
    output.slow = kSlow + why;
  // The obstacles are from the robot's place at that time.
  if (inputs.delay > 0.0 && output.speed != 0.0) {
    const double free =
        free_path(lps_.obstacles(), output.speed > 0.0 ? 0.0 : kPi, model_.radius, kFarEnough);
    const double stops = std::max(output.contact_speed,  // that much for wanted contact
                                  speed_that_stops(free - kMargin - kMarginOfRange * free,
                                                   inputs.delay + kCycle, model_.deceleration));
    if (stops < output.speed_limit) {
      output.speed_limit = stops;
      why += ", " + meters(free) + " are free";
    }
  }
  if (std::abs(output.speed) <= output.speed_limit)
    return;
  output.speed = std::copysign(output.speed_limit, output.speed);
  output.limit_reason = kSlow + why;
}

/// The intended limit. The reason of a lower one, by the age of the inputs, stays.
void Executive::obey_limit(const Inputs& inputs, Output& output) {
  if (inputs.intent == nullptr || inputs.intent->speed_limit < 0.0)
    return;
  const double limit = inputs.intent->speed_limit;
  if (output.speed_limit < 0.0 || limit < output.speed_limit)
    output.speed_limit = limit;
  if (std::abs(output.speed) <= limit)
    return;
  output.speed = std::copysign(limit, output.speed);
  output.limit_reason = inputs.intent->limit_reason;
}

std::string Executive::reconcile(const std::vector<Intended>& intended, const Pose& robot_in_odom) {
  // Most cycles have the same intent as the one before.
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
  // By name among equals: the order of the set must not affect the result.
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
  // An instance whose schema is gone stays until its parameters change.
  const bool current = same != nullptr && (schema == nullptr || same->revision == schema->revision);
  if (current && same->intended.parameters == wanted.parameters) {
    keep();
    return {};
  }
  if (schema == nullptr)
    return "unknown schema \"" + wanted.schema + "\"; there are " + joined(registry_.names());
  std::string trouble;
  std::optional<Parameters> parameters =
      Parameters::check(schema->parameters, wanted.parameters, robot_in_odom, trouble);
  if (!parameters) {
    if (same == nullptr || same->intended.parameters != wanted.parameters)
      return trouble;
    // The new version does not accept the parameters of the old one: the old one continues.
    keep();
    return "its schema has changed, and the old version runs on: " + trouble;
  }
  Instance instance;
  if (current) {
    instance = std::move(*same);
  } else {
    // The factory of a plug-in may throw.
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
