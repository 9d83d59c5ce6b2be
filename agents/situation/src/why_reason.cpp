#include "why_reason.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/idl/goal_words.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::situation {
namespace {

/// The text of a value as the activity language writes it: "keep-out zone \\"lab\\"".
std::string without_escapes(const std::string& value) {
  std::string text;
  for (std::size_t i = 1; i + 1 < value.size(); ++i)
    if (value[i] != '\\' || ++i + 1 < value.size())
      text += value[i];
  return text;
}

bool later(const v1::Stamp& a, const v1::Stamp& b) {
  return a.epoch != b.epoch ? a.epoch > b.epoch : a.cycle >= b.cycle;
}

bool same(const v1::GoalId& a, const v1::GoalId& b) {
  return a.writer == b.writer && a.number == b.number;
}

}  // namespace

std::string Reason::name_of(const v1::BehaviorState& behavior) const {
  const auto short_name = [](const v1::BehaviorState& one) {
    if (nameless(one.name, one.schema))
      return one.schema;
    const std::string name = without_number(one.name);
    return one.schema.empty() ? name : name + " (" + one.schema + ")";
  };
  const std::string name = short_name(behavior);
  const auto& all = scene_.behaviors->behaviors;
  const auto alike = std::ranges::count_if(all, [&](const v1::BehaviorState& other) {
    return other.running && short_name(other) == name;
  });
  return alike <= 1 ? name : behavior.name;
}

std::vector<Say> Reason::says(Channel channel) const {
  std::vector<Say> result;
  double all = 0.0;
  for (const v1::BehaviorState& behavior : scene_.behaviors->behaviors) {
    if (!behavior.running || !recommends(behavior, channel))
      continue;
    Say say{.behavior = &behavior};
    for (const v1::RuleState& rule : behavior.rules) {
      if (channel_of(rule) != channel)
        continue;
      say.weight += clamp01(rule.strength) * weight_of(behavior, channel);
      // The size of turns counts, and the strength of speeds.
      const auto counts = [&](const v1::RuleState& r) {
        return r.strength * (channel == Channel::turn ? std::abs(r.value) : 1.0);
      };
      if (rule.strength > 0.0 &&
          (say.main_rule == nullptr || counts(rule) > counts(*say.main_rule)))
        say.main_rule = &rule;
    }
    all += say.weight;
    result.push_back(say);
  }
  for (Say& say : result)
    say.share = all > 0.0 ? say.weight / all : 0.0;
  std::ranges::stable_sort(result, [](const Say& a, const Say& b) { return a.weight > b.weight; });
  return result;
}

double Reason::told_turn() const {
  if (by_behaviors() && scene_.behaviors)
    return scene_.behaviors->turning ? scene_.behaviors->turn : 0.0;
  if (!scene_.grant || scene_.grant->role == v1::ROLE_NONE)
    return 0.0;
  if (scene_.grant->rotation == v1::ROTATION_VELOCITY)
    return scene_.grant->rotation_velocity;
  return scene_.robot ? norm2_angle(scene_.grant->heading - scene_.robot->pose_in_odom.th) : 0.0;
}

/// The setpoints of the wheels.
std::string Reason::told() const {
  const double speed = told_speed();
  const double turn = told_turn();
  const bool turns = std::abs(turn) >= kNoTurn;
  const bool rate =
      !(by_behaviors() && scene_.behaviors) && scene_.grant->rotation == v1::ROTATION_VELOCITY;
  std::string text = "The robot is told to ";
  if (std::abs(speed) >= kNoSpeed)
    text += (speed > 0.0 ? "drive ahead at " : "back up at ") + speed_text(std::abs(speed)) +
            (turns ? " and to turn " : ", straight on");
  else
    text += turns ? "turn on the spot, " : "stand";
  if (turns)
    text += turn_text(turn, rate);
  return text;
}

std::string Reason::meanwhile() const {
  if (!scene_.robot)
    return {};
  const double velocity = scene_.robot->velocity;
  const double rotation = scene_.robot->rotation_velocity;
  const bool stands =
      scene_.grant && (scene_.grant->role == v1::ROLE_NONE || scene_.grant->role == v1::ROLE_ESTOP);
  const double speed = stands ? 0.0 : told_speed();
  std::vector<std::string> parts;
  if (std::abs(velocity - speed) >= kFarFromTold)
    parts.push_back(std::abs(velocity) < kNoSpeed ? "stands"
                    : velocity > 0.0              ? "drives at " + speed_text(velocity)
                                                  : "backs up at " + speed_text(-velocity));
  // A robot without speed may well turn towards its heading setpoint.
  const bool by_rate = scene_.grant && scene_.grant->rotation == v1::ROTATION_VELOCITY;
  if ((stands || (!by_rate && std::abs(told_turn()) >= kNoTurn)) && std::abs(rotation) >= kTurning)
    parts.push_back("turns " + turn_text(rotation, true));
  if (parts.empty())
    return {};
  return " (now it " + listed(parts, " and ") + ")";
}

const v1::RuleText* Reason::text_of(const v1::BehaviorState& behavior,
                                    const v1::RuleState& rule) const {
  for (const v1::BehaviorSchema& schema : scene_.schemas)
    if (schema.name == behavior.schema)
      for (const v1::RuleText& text : schema.rules)
        if (text.name == rule.name)
          return &text;
  return nullptr;
}

/// The rule's antecedent as written, with the values of its variables; empty where unknown.
std::string Reason::antecedent(const v1::BehaviorState& behavior, const v1::RuleState& rule) const {
  const v1::RuleText* const text = text_of(behavior, rule);
  if (text == nullptr || text->antecedent.empty())
    return {};
  std::vector<std::string> values;
  for (const v1::FuzzyVariable& variable : behavior.variables)
    if (has_word(text->antecedent, variable.name))
      values.push_back(variable.name + format(" %.2f", variable.value));
  return "if " + text->antecedent + (values.empty() ? "" : ": " + listed(values, ", "));
}

const v1::IntentionNode* Reason::node(std::uint32_t id) const {
  if (scene_.intentions && id != 0)
    for (const v1::IntentionNode& candidate : scene_.intentions->nodes)
      if (candidate.id == id)
        return &candidate;
  return nullptr;
}

/// The intention that intends the behavior.
const v1::IntentionNode* Reason::node_of(const v1::BehaviorState& behavior) const {
  if (scene_.intentions)
    for (const v1::IntendedBehavior& intended : scene_.intentions->behaviors)
      if (intended.name == behavior.name) {
        const v1::IntentionNode* const found = node(intended.intention);
        return found != nullptr && is_behavior(*found, *scene_.intentions) ? node(found->parent)
                                                                           : found;
      }
  return nullptr;
}

const v1::GoalStatus* Reason::status(const v1::GoalId& id) const {
  for (const v1::GoalStatus& candidate : scene_.statuses)
    if (same(candidate.id, id))
      return &candidate;
  return nullptr;
}

/// Empty for an unknown goal.
std::string Reason::goal_text(const v1::GoalId& id) const {
  for (const v1::Goal& goal : scene_.goals)
    if (same(goal.id, id))
      return describe(goal);
  const v1::GoalStatus* const known = status(id);
  return known == nullptr ? "" : known->functor;
}

std::string Reason::goal_name(const v1::GoalId& id) const {
  const std::string text = goal_text(id);
  return text.substr(0, text.find('('));
}

/// As intentions has checked it; the goal's own words count where no status is known.
std::string Reason::requester(const v1::GoalId& id) const {
  if (const v1::GoalStatus* const known = status(id); known != nullptr && !known->requester.empty())
    return known->requester;
  for (const v1::Goal& goal : scene_.goals)
    if (same(goal.id, id) && !goal.requester.empty())
      return goal.requester;
  return "somebody";
}

/// The intention and goal of these behaviors (or the program, for its own ones), where known.
void Reason::add_purpose(Sentence& sentence,
                         const std::vector<const v1::BehaviorState*>& behaviors) const {
  if (scene_.own_mind)
    sentence.add(1, "; behaviors of the program " + scene_.grant->source);
  const v1::IntentionNode* own = nullptr;
  for (const v1::BehaviorState* behavior : behaviors)
    if (own == nullptr)
      own = node_of(*behavior);
  if (own == nullptr) {
    if (!scene_.intentions)
      if (const Condition how = condition(scene_, "intentions"); !how.words.empty())
        sentence.add(3, "; the goal behind it is not known: intentions " + how.words);
    return;
  }
  const v1::IntentionNode* root = own;
  while (const v1::IntentionNode* const parent = node(root->parent))
    root = parent;
  const std::string goal = goal_text(root->goal);
  if (scene_.own_mind)
    sentence.add(1, ", for " + intention_name(*root));
  else if (goal.empty())
    sentence.add(3, "; for a goal of which nothing is known");
  else
    sentence.add(1, "; for " + goal + " of " + requester(root->goal),
                 "; for " + goal_name(root->goal) + " of " + requester(root->goal));
  if (root != own)
    sentence.add(4, ", by " + with_arguments(*own), ", by " + intention_name(*own));
}

/// The zones that a followed path goes around or through, in words; empty: none, it is interrupted,
/// or a past cycle.
std::string Reason::detour() const {
  if (scene_.past || !scene_.intentions)
    return {};
  const auto& nodes = scene_.intentions->nodes;
  if (std::ranges::none_of(nodes, [](const v1::IntentionNode& one) {
        return one.schema == "follow-path" && one.state == v1::INTENTION_RUNNING;
      }))
    return {};
  for (const v1::Belief& belief : scene_.beliefs)
    if (belief.name == "detour" && belief.value.size() > 2 && belief.value.front() == '"')
      return "it takes the way " + without_escapes(belief.value);
  return {};
}

std::string Reason::of_say(const Say& say, Channel channel, bool with_rule) const {
  return wish_of(*say.behavior, channel) +
         (with_rule && say.main_rule != nullptr ? " (rule " + say.main_rule->name + ")" : "");
}

/// A behavior's recommendation on both channels, as far as it is worth mentioning.
std::string Reason::wants(const std::vector<Say>& speeds, const std::vector<Say>& turns,
                          const v1::BehaviorState& behavior, bool with_rules) const {
  std::vector<std::string> parts;
  for (const Say& say : speeds)
    if (say.behavior == &behavior)
      parts.push_back(of_say(say, Channel::speed, with_rules));
  for (const Say& say : turns)
    if (say.behavior == &behavior)
      parts.push_back(of_say(say, Channel::turn, with_rules));
  return name_of(behavior) + " wants " + listed(parts);
}

std::string refused(const v1::Refusal& refusal) {
  return refusal.source + " (" + situation::name_of(refusal.role) +
         ") was refused: " + refusal.reason;
}

std::string Reason::ago(std::uint64_t since) const {
  return since == 0 ? ""
                    : " " + seconds_text(seconds_of(scene_.cycle - std::min(scene_.cycle, since)));
}

/// The latch that holds, with its age.
std::string Reason::held() const {
  std::string text = latched(*scene_.grant);
  if (const std::string age = ago(scene_.estopped_since); scene_.grant->estopped && !age.empty())
    text.insert(text.rfind(": "), "," + age + " ago");
  return text;
}

Cause Reason::grant_cause() const {
  const v1::Grant& grant = *scene_.grant;
  Cause cause{"grant", std::string(situation::name_of(grant.role))};
  if (grant.role == v1::ROLE_NONE)
    cause.text = "nobody drives";
  else if (grant.estopped)
    return {"grant", held()};
  else
    cause.text = grant.source + " drives as " + situation::name_of(grant.role);
  if (!grant.reason.empty())
    cause.text += ": " + grant.reason;
  for (const v1::Refusal& refusal : grant.refused)
    cause.because.push_back({"grant", refused(refusal)});
  return cause;
}

std::string Reason::guard_words(bool brief) const {
  const std::string& reason = scene_.grant->guard_reason;
  std::string text = std::string("the guard beside the robot ") +
                     situation::name_of(scene_.grant->guard) + " it (" +
                     (brief ? reason.substr(0, reason.find(';')) : reason) + ")";
  if (reason.find("contact is meant") != std::string::npos && scene_.behaviors)
    for (const Say& say : says(Channel::speed))
      if (const v1::IntentionNode* const meant = node_of(*say.behavior))
        return text + ", by " + intention_name(*meant);
  return text;
}

std::optional<Cause> Reason::guard_cause() const {
  if (!scene_.grant || scene_.grant->guard == v1::GUARD_NONE)
    return std::nullopt;
  return Cause{"guard", guard_words(false)};
}

std::optional<Cause> Reason::hindrance() const {
  if (!scene_.robot || (!scene_.grant && !scene_.behaviors) ||
      (std::abs(told_speed()) < kNoSpeed && std::abs(told_turn()) < kNoTurn))
    return std::nullopt;
  const v1::RobotState& robot = *scene_.robot;
  if (robot.status == v1::MOTORS_NO_POWER && std::abs(robot.velocity) < kFarFromTold &&
      std::abs(robot.rotation_velocity) < kTurning)
    return Cause{"motors", "its motors are off (saphira device motors on)"};
  const std::string since = scene_.stalled_since == 0 ? "" : " for" + ago(scene_.stalled_since);
  if (robot.left_stalled && robot.right_stalled)
    return Cause{"motors", "both wheels are stalled" + since};
  if (robot.left_stalled || robot.right_stalled)
    return Cause{"motors", std::string("its ") + (robot.left_stalled ? "left" : "right") +
                               " wheel is stalled" + since};
  return std::nullopt;
}

/// The hops on which samples are late, with the machines where they are several.
std::string Reason::slow_way() const {
  const auto at = [this](const char* const name) {
    for (const Program& program : scene_.programs)
      if (program.status.name == name)
        return program.status.host;
    return std::string();
  };
  const auto hop = [&at](const char* const from, const char* const word, const char* const to) {
    const std::string hosts =
        at(from) == at(to) ? "" : " (" + at(from) + " " + word + " " + at(to) + ")";
    return std::string(from) + " " + word + " " + to + hosts;
  };
  std::vector<std::string> ways;
  if (scene_.behaviors->input_age >= kSlowHop)
    ways.push_back("from " + hop("intentions", "to", "behaviors"));
  if (scene_.grant && scene_.grant->command_age >= kSlowHop)
    ways.push_back("between " + hop("bridge", "and", "behaviors"));
  return ways.empty() ? "" : " (slow " + listed(ways) + ")";
}

std::optional<Cause> Reason::age_cause() const {
  if (!scene_.behaviors)
    return std::nullopt;
  const v1::BehaviorSet& all = *scene_.behaviors;
  if (!all.limit_reason.empty())
    return Cause{"limit", all.limit_reason +
                              (all.speed_limit > 0.0
                                   ? ", so it drives no faster than " + speed_text(all.speed_limit)
                                   : "") +
                              (all.limit_reason.starts_with(kSlowWords) ? slow_way() : "")};
  const double command_age = scene_.grant ? scene_.grant->command_age : 0.0;
  if (std::max(all.input_age, command_age) < kOldInput)
    return std::nullopt;
  return Cause{"age", kSlowWords + format(": intentions were %.1f s old, ", all.input_age) +
                          format("and the command answers a state of %.1f s ago", command_age) +
                          slow_way()};
}

Cause Reason::rule_cause(const v1::BehaviorState& behavior, const v1::RuleState& rule) const {
  Cause cause{"rule",
              "rule " + rule.name + format(" holds to %.2f: ", rule.strength) + control_text(rule)};
  if (const std::string text = antecedent(behavior, rule); !text.empty())
    cause.because.push_back({"rule", text});
  return cause;
}

Cause Reason::goal_cause(const v1::GoalId& id) const {
  if (goal_text(id).empty())
    return {"goal", "a goal of which nothing is known"};
  return {"goal", "goal " + goal_text(id) + " of " + requester(id)};
}

std::optional<Cause> Reason::chain(const v1::IntentionNode& of) {
  Cause cause{"intention", "for " + with_arguments(of)};
  // Its label is the next state, which does not describe the present.
  if (!of.step.empty())
    cause.text += ": " + of.step;
  if (!told_nodes_.insert(of.id).second) {
    cause.text = "for " + intention_name(of) + ", as above";
    return cause;
  }
  if (const v1::IntentionNode* const parent = node(of.parent)) {
    if (auto above = chain(*parent))
      cause.because.push_back(std::move(*above));
  } else {
    cause.because.push_back(scene_.own_mind
                                ? Cause{"program", "of the program " + scene_.grant->source}
                                : goal_cause(of.goal));
  }
  add_advice(of, cause);
  return cause;
}

/// People's advice on the subject of the intention: each once, at its first use.
void Reason::add_advice(const v1::IntentionNode& of, Cause& cause) {
  std::string arguments = of.arguments;
  for (const v1::Goal& goal : scene_.goals)  // the first intention has those of its goal
    if (of.parent == 0 && same(goal.id, of.goal))
      for (const v1::Argument& argument : goal.arguments)
        if (argument.kind == v1::ARGUMENT_TEXT)
          arguments += (arguments.empty() ? "" : ", ") + argument.name + "=" + argument.text;
  for (const v1::Belief& belief : scene_.beliefs)
    if (belief.said_by.find(" said ") != std::string::npos &&
        concerns(belief, of.schema, arguments) && told_beliefs_.insert(belief.name).second)
      cause.because.push_back(
          {"belief", belief.said_by + " (" + belief.name + ": " + belief.value + ")"});
}

std::optional<Cause> Reason::chain(const v1::BehaviorState& behavior) {
  const v1::IntentionNode* const found = node_of(behavior);
  return found == nullptr ? std::nullopt : chain(*found);
}

Cause Reason::behavior_cause(const Say& say, Channel channel) {
  const v1::BehaviorState& behavior = *say.behavior;
  Cause cause{"behavior",
              name_of(behavior) + format(", priority %d, ", behavior.priority) +
                  (say.weight < kNoSay ? "does not count: "
                                       : format("%.0f %% of the say: ", 100.0 * say.share)) +
                  wish_of(behavior, channel)};
  if (say.weight < kNoSay && activity_of(behavior, channel) >= kNoSay) {
    for (const v1::BehaviorState& above : scene_.behaviors->behaviors)
      if (above.running && above.priority < behavior.priority &&
          activity_of(above, channel) >= 1.0 - kNoSay) {
        cause.because.push_back({"behavior", name_of(above) + " is above it and fully active"});
        break;
      }
  }
  for (const v1::RuleState& rule : behavior.rules)
    if (channel_of(rule) == channel && rule.strength >= kNoSay)
      cause.because.push_back(rule_cause(behavior, rule));
  if (auto purpose = chain(behavior))
    cause.because.push_back(std::move(*purpose));
  return cause;
}

Cause Reason::channel_cause(Channel channel) {
  const v1::BehaviorSet& all = *scene_.behaviors;
  Cause cause;
  if (channel == Channel::speed)
    cause = {"speed", all.moving ? "the behaviors' blend of speeds: " + speed_text(all.speed)
                                 : "no behavior wants a speed: it stands"};
  else
    cause = {"turn", all.turning ? "the behaviors' blend of turns: " + turn_text(all.turn)
                                 : "no behavior wants a turn: straight on"};
  for (const Say& say : says(channel))
    cause.because.push_back(behavior_cause(say, channel));
  return cause;
}

Cause Reason::wheels(const std::string& text) {
  Cause cause{"wheels", text};
  if (scene_.grant)
    cause.because.push_back(grant_cause());
  if (auto hindered = hindrance())
    cause.because.push_back(std::move(*hindered));
  if (auto guard = guard_cause())
    cause.because.push_back(std::move(*guard));
  if (auto age = age_cause())
    cause.because.push_back(std::move(*age));
  if (scene_.behaviors) {
    cause.because.push_back(channel_cause(Channel::speed));
    cause.because.push_back(channel_cause(Channel::turn));
    if (!scene_.behaviors->trouble.empty())
      cause.because.push_back(
          {"trouble", "behaviors that cannot be had: " + scene_.behaviors->trouble});
  }
  return cause;
}

std::string Reason::idle_reason(bool brief) const {
  for (const char* const name : {"behaviors", "intentions"})
    if (const Condition how = condition(scene_, name); !how.heard())
      return std::string(name) + " " + how.words;
  if (const std::string names = suspended(scene_); !names.empty())
    return names + " is suspended";
  if (scene_.intentions && !scene_.intentions->behavior_control)
    return "behavior control is switched off";
  if (scene_.intentions && !scene_.intentions->behaviors.empty())
    return {};
  return goals_reason(brief);
}

/// The goal that is underway, else the newest one.
const v1::GoalStatus* Reason::foremost() const {
  const v1::GoalStatus* newest = nullptr;
  for (const v1::GoalStatus& status : scene_.statuses) {
    if (status.state == v1::GOAL_UNDERWAY)
      return &status;
    if (newest == nullptr || later(status.stamp, newest->stamp))
      newest = &status;
  }
  return newest;
}

/// The goal for which the robot would drive while a program is silent; else empty.
std::string Reason::goal_so_far(bool brief) const {
  if (!condition(scene_, "intentions").heard())
    return last_known(brief);
  const v1::GoalStatus* const status = foremost();
  const bool waits = status != nullptr && status->state == v1::GOAL_UNDERWAY && !scene_.past &&
                     !condition(scene_, "behaviors").heard();
  return waits ? goal_of(status->id, brief) + " is underway" : "";
}

std::string Reason::last_known(bool brief) const {
  const v1::GoalStatus* const status = foremost();
  if (status == nullptr && !scene_.past && !scene_.goals.empty())
    return goal_of(scene_.goals.back().id, brief) + " is asked for, and its state is not known";
  if (scene_.past || status == nullptr || !scene_.robot ||
      status->stamp.epoch != scene_.robot->stamp.epoch)
    return {};
  const double age = seconds_of(scene_.now - std::min(scene_.now, status->stamp.cycle));
  return "last known of " + goal_of(status->id, brief) + ": " + v1::word_of(status->state) + ", " +
         seconds_text(age) + " ago";
}

std::string Reason::goal_of(const v1::GoalId& id, bool brief) const {
  return (brief ? goal_name(id) : goal_text(id)) + " of " + requester(id);
}

/// For a robot without an intended behavior.
std::string Reason::goals_reason(bool brief) const {
  const v1::GoalStatus* const newest = foremost();
  if (newest != nullptr && newest->state == v1::GOAL_UNDERWAY)
    return goal_of(newest->id, brief) + " is underway and intends no behavior now" +
           (newest->step.empty() ? "" : ": " + newest->step);
  if (newest == nullptr) {
    if (!scene_.statuses_known)
      return std::string("which goals there ") + (scene_.past ? "were" : "are") + " is not known";
    return scene_.past ? "no goal was underway" : "no goal is underway";
  }
  if (newest->functor == "stop" && newest->state == v1::GOAL_SUCCEEDED)
    return requester(newest->id) + " stopped it, and no goal is underway";
  const std::string& reason = newest->reason;
  return std::string("no goal is underway; ") + (brief ? "" : "the newest, ") +
         goal_of(newest->id, brief) + ": " + v1::word_of(newest->state) +
         (reason.empty() ? "" : ", " + reason);
}

}  // namespace saphira::situation
