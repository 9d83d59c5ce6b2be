// Fuzzy variables (manual 7.5) and behaviors of C programs (7.6, 7.7), and the library's own (7.8).

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "os.hpp"
#include "saphira/behaviors/fuzzy.hpp"

int Accel = 1, Decel = 2, Turn_left = 3, Turn_right = 4;

namespace saphira::c {
namespace {

using behaviors::Action;

/// A predefined behavior: its parameters in the manual's order.
struct Predefined {
  const char* schema;
  struct Parameter {
    const char* name;
    double unit;  ///< [SI] of 1; 0: a point
  };
  std::vector<Parameter> parameters;
};

constexpr double kMm = 0.001;

const std::map<const behavior*, Predefined>& predefined() {
  static const std::map<const behavior*, Predefined> all{
      {sfConstantVelocity, {"ConstantVelocity", {{"speed", kMm}}}},
      {sfStop, {"Stop", {}}},
      {sfAvoidCollision,
       {"AvoidCollision",
        {{"front_sensitivity", 1}, {"side_sensitivity", 1}, {"turn_gain", 1}, {"standoff", kMm}}}},
      {sfStopCollision,
       {"StopCollision", {{"front_sensitivity", 1}, {"side_sensitivity", 1}, {"standoff", kMm}}}},
      {sfKeepOff, {"KeepOff", {{"caution_speed", kMm}, {"sensitivity", 1}}}},
      {sfGoToPos, {"GoToPos", {{"speed", kMm}, {"goal", 0}, {"radius", kMm}}}},
      {sfAttendAtPos, {"AttendAtPos", {{"speed", kMm}, {"goal", 0}, {"radius", kMm}}}},
      {sfFollow,
       {"Follow",
        {{"lane", 0},
         {"goal", 0},
         {"right", kMm},
         {"left", kMm},
         {"speed_off_lane", kMm},
         {"speed", kMm},
         {"turn_ratio", 1}}}},
      {sfFollowCorridor, {"FollowCorridor", {{"corridor", 0}, {"goal", 0}}}},
      {sfFollowDoor, {"FollowDoor", {{"door", 0}, {"direction", 1}}}},
      {sfTurnTo, {"TurnTo", {{"goal", 0}, {"success_angle", 1}, {"turn_speed", 1}}}}};
  return all;
}

Pose local_pose(const void* p) {
  const point& at = *static_cast<const point*>(p);
  return {at.x / 1000.0, at.y / 1000.0, at.th * Os::get().angle_unit};
}

/// A C program's behavior, for the executive.
class InC final : public behaviors::Behavior {
 public:
  void init(const behaviors::Parameters& parameters, const behaviors::Context&) override {
    const Closure* const closure = closure_of(parameters);
    if (closure != nullptr && closure->shown.beh->init != nullptr)
      call(closure->shown.beh->init, *closure);
  }

  behaviors::Evaluation update(const behaviors::Parameters& parameters,
                               const behaviors::Context&) override {
    behaviors::Evaluation result;
    const Closure* const closure = closure_of(parameters);
    if (closure == nullptr)
      return result;
    const behavior& code = *closure->shown.beh;
    c_act_t = c_act_v = 1.0F;
    c_goal = c_progress = 0.0F;
    if (code.update != nullptr)
      call(code.update, *closure);
    bool turns = false;
    bool drives = false;
    for (int i = 0; i < std::clamp(code.n_rules, 0, 10); ++i)
      add_rule(code.rules[i], result, turns, drives);
    result.activity = {turns ? part(c_act_t) : 0.0, drives ? part(c_act_v) : 0.0, part(c_goal),
                       part(c_progress)};
    return result;
  }

 private:
  static const Closure* closure_of(const behaviors::Parameters& parameters) {
    const std::lock_guard lock(Os::get().mutex);
    const auto index = static_cast<std::size_t>(parameters.number("closure"));
    const auto& all = Os::get().closures;
    return index < all.size() ? all[index].get() : nullptr;
  }
  void call(void (*function)(beh_params), const Closure& closure) {
    beh_state = state_.data();
    function(closure.shown.params);
  }
  static double part(float value) {
    return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.0;
  }

  void add_rule(const beh_rule& rule, behaviors::Evaluation& result, bool& turns, bool& drives) {
    const std::string name = rule.name == nullptr ? "a rule" : rule.name;
    const auto usable = [](int index) { return index >= 0 && index < BEH_STATE_LEN; };
    if (!usable(rule.antecedent) || !usable(rule.mean)) {
      result.trouble = name + ": an index into beh_state is not 0 to 63";
      return;
    }
    const double strength = state_[static_cast<std::size_t>(rule.antecedent)];
    const double mean = state_[static_cast<std::size_t>(rule.mean)];
    if (rule.consequent == &Accel || rule.consequent == &Decel) {
      drives = true;
      result.rules.push_back({name, strength,
                              rule.consequent == &Accel ? Action::accelerate : Action::decelerate,
                              mean * kMm});
    } else if (rule.consequent == &Turn_left || rule.consequent == &Turn_right) {
      turns = true;
      result.rules.push_back(
          {name, strength, rule.consequent == &Turn_left ? Action::turn_left : Action::turn_right,
           radians(mean)});
    } else {
      result.trouble = name + ": the consequent is not &Accel, &Decel, &Turn_left or &Turn_right";
    }
  }

  std::array<float, BEH_STATE_LEN> state_{};
};

constexpr const char* kInC = "behavior in C";

}  // namespace

void register_behaviors(behaviors::Registry& registry) {
  behaviors::Schema schema{
      .name = kInC,
      .summary = "a behavior of this program",
      .parameters = {behaviors::number_parameter("closure", "which one", 0.0, 1e9, 0.0)}};
  schema.make = [] { return std::make_unique<InC>(); };
  registry.add(std::move(schema));
}

std::vector<int> kinds_of(const behavior* b) {
  std::vector<int> kinds;
  if (const auto known = predefined().find(b); known != predefined().end())
    for (const Predefined::Parameter& parameter : known->second.parameters)
      kinds.push_back(parameter.unit == 0.0                        ? sfPTR
                      : std::string(parameter.name) == "direction" ? sfINT
                                                                   : sfFLOAT);
  return kinds;
}

Closure* Os::add_closure(behavior* b, int priority, bool running, std::vector<beh_param> params,
                         bool duplicate) {
  const std::lock_guard lock(mutex);
  Closure* closure = nullptr;
  for (const auto& each : closures)
    if (!duplicate && !each->removed && each->shown.beh == b)
      closure = each.get();
  if (closure == nullptr) {
    closures.push_back(std::make_unique<Closure>());
    closure = closures.back().get();
    const std::string base = b->name == nullptr ? "behavior" : b->name;
    closure->name = base;
    const auto taken = [&](const std::string& name) {
      return std::any_of(closures.begin(), closures.end() - 1,
                         [&](const auto& other) { return !other->removed && other->name == name; });
    };
    for (int i = 2; taken(closure->name); ++i)
      closure->name = base + " " + std::to_string(i);
  }
  const auto known = predefined().find(b);
  closure->schema = known == predefined().end() ? kInC : known->second.schema;
  replaced_.push_back(std::exchange(closure->params, std::move(params)));
  closure->params.resize(std::max<std::size_t>(closure->params.size(), 1));
  closure->shown = {closure->name.c_str(),  b,    priority, running ? TRUE : FALSE,
                    closure->params.data(), 0.0F, 0.0F,     0.0F};
  return closure;
}

Closure* Os::of(const beh_closure* shown) {
  const std::lock_guard lock(mutex);
  for (const auto& closure : closures)
    if (&closure->shown == shown)
      return closure.get();
  return nullptr;
}

behaviors::Intended Os::intended(const Closure& closure) {
  behaviors::Intended intended;
  intended.name = closure.name;
  intended.schema = closure.schema;
  intended.priority = std::max(closure.shown.priority, 0);
  intended.running = closure.shown.running != FALSE;
  const auto known = predefined().find(closure.shown.beh);
  if (known == predefined().end()) {
    const auto index =
        std::ranges::find_if(closures, [&](const auto& each) { return each.get() == &closure; });
    intended.parameters.push_back(number("closure", static_cast<double>(index - closures.begin())));
    return intended;
  }
  const behaviors::Schema* const schema = schemas_.find(closure.schema);
  std::size_t i = 0;
  for (const Predefined::Parameter& parameter : known->second.parameters) {
    const beh_param given = i < closure.params.size() ? closure.params[i] : beh_param{};
    ++i;
    if (parameter.unit == 0.0) {
      if (given.p == nullptr)
        continue;  // the executive reports the missing one
      const Pose at = local_pose(given.p);
      intended.parameters.push_back(saphira::point(parameter.name, compose(robot_in_odom, at)));
      const wall& wide = *static_cast<const wall*>(given.p);
      const bool has_width = wide.type == CORRIDOR || wide.type == DOOR;
      if (has_width &&
          (closure.shown.beh == sfFollowCorridor || closure.shown.beh == sfFollowDoor) && i == 1 &&
          wide.width > 0.0F)
        intended.parameters.push_back(number("width", std::clamp(wide.width * kMm, 0.3, 5.0)));
    } else if (closure.shown.beh == sfFollowDoor) {
      intended.parameters.push_back(text(parameter.name, given.i == sfOUT ? "out" : "in"));
    } else {
      double value = given.f * parameter.unit;
      // The manual's own examples exceed its ranges: take the nearest value.
      if (schema != nullptr)
        for (const behaviors::ParameterSpec& spec : schema->parameters)
          if (spec.name == parameter.name && std::isfinite(value))
            value = std::clamp(value, spec.low, spec.high);
      intended.parameters.push_back(number(parameter.name, value));
    }
  }
  if (closure.shown.beh == sfAvoidCollision || closure.shown.beh == sfKeepOff)
    intended.parameters.push_back(text("preferred_turn", sfPreferredTurnDir == sfLEFTTURN ? "left"
                                                         : sfPreferredTurnDir == sfRIGHTTURN
                                                             ? "right"
                                                             : "auto"));
  return intended;
}

std::vector<behaviors::Intended> Os::intended() {
  std::vector<behaviors::Intended> all;
  for (const auto& closure : closures)
    if (!closure->removed)
      all.push_back(intended(*closure));
  return all;
}

/// The micro-task execute_current_behaviors.
void Os::evaluate_behaviors() {
  behaviors::Core::Inputs inputs;
  const behaviors::RobotModel model = model_of(parameters);
  const bool interrupted = process_state == sfINTERRUPT;
  {
    const std::lock_guard lock(mutex);
    inputs.cycle = cycle;
    inputs.new_robot = behaviors_began_ ? nullptr : &model;
    inputs.schemas = behaviors_began_ ? nullptr : &schemas_;
    behaviors_began_ = true;
    inputs.new_frame = new_frame_;
    const protocol::Information& now = state.information;
    inputs.robot = {robot_in_odom,         now.velocity,
                    now.rotation_velocity, state.target_heading_in_odom,
                    now.left_stalled,      now.right_stalled};
    inputs.sonars = readings_;
    inputs.intent = behaviors::Intent{cycle, sfBehaviorControl != 0 && !interrupted, intended()};
  }
  behaviors_->processes().step(inputs.cycle);
  const behaviors::Core::Outputs said = behaviors_->step(inputs);  // calls the program's functions
  const std::lock_guard lock(mutex);
  hear_behaviors(said.output);
  behaviors_said_ = said.output;
  const bool drive = said.output.active && !interrupted;
  if (drive) {
    if (!behaviors_drive_)
      let_go();
    motion = {};
    motion.translation = reflector::Translation::velocity;
    motion.velocity = said.output.speed;
    motion.rotation = reflector::Rotation::heading;
    motion.heading = target_heading = said.output.heading_in_odom;
    position_target.reset();
  } else if (behaviors_drive_) {
    motion.translation = reflector::Translation::velocity;
    motion.velocity = 0.0;
    motion.rotation = reflector::Rotation::velocity;
    motion.rotation_velocity = 0.0;
  }
  behaviors_drive_ = drive;
}

void Os::hear_behaviors(const behaviors::Output& output) {
  for (const behaviors::BehaviorState& told : output.behaviors)
    for (const auto& closure : closures)
      if (!closure->removed && closure->name == told.name) {
        const behaviors::Activity& activity = told.blended.evaluation.activity;
        closure->shown.goal = told.running ? static_cast<float>(activity.goal) : 0.0F;
        closure->shown.act_t = static_cast<float>(activity.turn);
        closure->shown.act_v = static_cast<float>(activity.speed);
      }
  if (output.trouble != behavior_trouble_ && !output.trouble.empty())
    say(output.trouble, true);
  behavior_trouble_ = output.trouble;
}

bool read_arguments(const std::string& function, std::vector<beh_param>& params,
                    std::vector<int>& kinds, va_list list) {
  constexpr std::size_t kMost = 20;
  while (params.size() <= kMost) {
    beh_param param{};
    kinds.push_back(va_arg(list, int));
    switch (kinds.back()) {
      case sfEND:
        return true;
      case sfINT:
        param.i = va_arg(list, int);
        break;
      case sfFLOAT:
        param.f = static_cast<float>(va_arg(list, double));
        break;
      case sfPTR:
        param.p = va_arg(list, void*);
        break;
      default:
        Os::get().say(function + ": argument " + std::to_string(params.size() + 1) +
                          " of the list: expected sfINT, sfFLOAT or sfPTR and a value, or sfEND at "
                          "the end (is sfEND missing?)",
                      true);
        return false;
    }
    params.push_back(param);
  }
  Os::get().say(function + ": more than 20 arguments (is sfEND missing?)", true);
  return false;
}

}  // namespace saphira::c

namespace {

using namespace saphira::c;

/// The types of the library's behaviors' parameters are known: an int in place of a float counts as
/// its number.
bool take_kinds(const std::string& call, const behavior* b, std::vector<beh_param>& params,
                const std::vector<int>& kinds) {
  const std::vector<int> due = kinds_of(b);
  for (std::size_t i = 0; i < due.size() && i < params.size(); ++i) {
    if (due[i] == sfFLOAT && kinds[i] == sfINT) {
      params[i].f = static_cast<float>(params[i].i);
    } else if (due[i] != kinds[i]) {
      Os::get().say(call + ": parameter " + std::to_string(i + 1) + ": expected " +
                        (due[i] == sfFLOAT ? "sfFLOAT"
                         : due[i] == sfPTR ? "sfPTR"
                                           : "sfINT"),
                    true);
      return false;
    }
  }
  return true;
}

BEHCLOSURE init_behavior(const char* function, behavior* b, int priority, int running,
                         bool duplicate, va_list list) {
  Os& os = Os::get();
  if (b == nullptr) {
    os.say(std::string(function) + ": the behavior is NULL", true);
    return nullptr;
  }
  const std::string call = std::string(function) + "(" + (b->name ? b->name : "?") + ")";
  if (b->n_rules < 0 || b->n_rules > 10) {
    os.say(call + ": a behavior has 10 rules at the most, not " + std::to_string(b->n_rules), true);
    return nullptr;
  }
  std::vector<beh_param> params;
  std::vector<int> kinds;
  if (!read_arguments(call, params, kinds, list))
    return nullptr;
  if (static_cast<int>(params.size()) != b->n_params) {
    os.say(call + ": expected " + std::to_string(b->n_params) + " parameters, not " +
               std::to_string(params.size()),
           true);
    return nullptr;
  }
  if (!take_kinds(call, b, params, kinds))
    return nullptr;
  return &os.add_closure(b, priority, running != FALSE, std::move(params), duplicate)->shown;
}

Closure* closure_of(const char* function, BEHCLOSURE b) {
  Closure* const closure = b == nullptr ? nullptr : Os::get().of(b);
  if (closure == nullptr || closure->removed)
    Os::get().say(std::string(function) + (b == nullptr ? ": the behavior is NULL (was it found?)"
                                                        : ": there is no such behavior (any more)"),
                  true);
  return closure;
}

std::string plain(std::string_view name) {
  const std::string text = bare(name);
  return text.starts_with("sf") ? text.substr(2) : text;
}

behavior constant_velocity{"sfConstantVelocity", nullptr, nullptr, 1, 0, {}};
behavior stop_{"sfStop", nullptr, nullptr, 0, 0, {}};
behavior avoid_collision{"sfAvoidCollision", nullptr, nullptr, 4, 0, {}};
behavior stop_collision{"sfStopCollision", nullptr, nullptr, 3, 0, {}};
behavior keep_off{"sfKeepOff", nullptr, nullptr, 2, 0, {}};
behavior go_to_pos{"sfGoToPos", nullptr, nullptr, 3, 0, {}};
behavior attend_at_pos{"sfAttendAtPos", nullptr, nullptr, 3, 0, {}};
behavior follow_lane{"sfFollow", nullptr, nullptr, 7, 0, {}};
behavior follow_door{"sfFollowDoor", nullptr, nullptr, 2, 0, {}};
behavior turn_to{"sfTurnTo", nullptr, nullptr, 3, 0, {}};

}  // namespace

extern "C" {

behavior follow_corridor{"sfFollowCorridor", nullptr, nullptr, 2, 0, {}};
behavior* sfConstantVelocity = &constant_velocity;
behavior* sfStop = &stop_;
behavior* sfAvoidCollision = &avoid_collision;
behavior* sfStopCollision = &stop_collision;
behavior* sfKeepOff = &keep_off;
behavior* sfGoToPos = &go_to_pos;
behavior* sfAttendAtPos = &attend_at_pos;
behavior* sfFollow = &follow_lane;
behavior* sfFollowCorridor = &follow_corridor;
behavior* sfFollowDoor = &follow_door;
behavior* sfTurnTo = &turn_to;
int sfPreferredTurnDir = sfNOTURN;
int sfBehaviorControl = 1;
float* beh_state = nullptr;
float c_act_t = 1.0F, c_act_v = 1.0F, c_goal = 0.0F, c_progress = 0.0F;

BEHCLOSURE sfInitBehavior(behavior* b, int priority, int running, ...) {
  va_list list;
  va_start(list, running);
  BEHCLOSURE made = init_behavior("sfInitBehavior", b, priority, running, false, list);
  va_end(list);
  return made;
}
BEHCLOSURE sfInitBehaviorDup(behavior* b, int priority, int running, ...) {
  va_list list;
  va_start(list, running);
  BEHCLOSURE made = init_behavior("sfInitBehaviorDup", b, priority, running, true, list);
  va_end(list);
  return made;
}
void sfKillBehavior(BEHCLOSURE b) {
  const std::lock_guard lock(Os::get().mutex);
  if (Closure* const closure = closure_of("sfKillBehavior", b))
    closure->removed = true;
}
void sfSetBehaviorState(BEHCLOSURE b, int state) {
  const std::lock_guard lock(Os::get().mutex);
  Closure* const closure = closure_of("sfSetBehaviorState", b);
  if (closure == nullptr)
    return;
  if (state != sfON && state != sfOFF && state != sfTOGGLE)
    return Os::get().say("sfSetBehaviorState: expected sfON, sfOFF or sfTOGGLE", true);
  closure->shown.running = state == sfTOGGLE ? !closure->shown.running : state;
}
void sfBehaviorOn(BEHCLOSURE b) {
  sfSetBehaviorState(b, sfON);
}
void sfBehaviorOff(BEHCLOSURE b) {
  sfSetBehaviorState(b, sfOFF);
}
BEHCLOSURE sfFindBehavior(const char* name) {
  const std::lock_guard lock(Os::get().mutex);
  if (name == nullptr)
    return nullptr;
  for (const auto& closure : Os::get().closures)
    if (!closure->removed && plain(closure->name) == plain(name))
      return &closure->shown;
  return nullptr;
}

float straight_up(float x, float min, float max) {
  return real(saphira::behaviors::straight_up(x, min, max));
}
float down_straight(float x, float min, float max) {
  return real(saphira::behaviors::down_straight(x, min, max));
}
float f_greater(float x, float c, float delta) {
  return real(saphira::behaviors::f_greater(x, c, delta));
}
float f_smaller(float x, float c, float delta) {
  return real(saphira::behaviors::f_smaller(x, c, delta));
}
float f_eq(float x, float c, float delta) {
  return real(saphira::behaviors::f_eq(x, c, delta));
}
float f_not(float x) {
  return real(saphira::behaviors::f_not(x));
}
float f_and(float x, float y) {
  return real(saphira::behaviors::f_and(x, y));
}
float f_or(float x, float y) {
  return real(saphira::behaviors::f_or(x, y));
}

}  // extern "C"
