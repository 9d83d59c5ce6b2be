#include "saphira/cli/why.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "saphira/cli/displays.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/words.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

namespace {

constexpr double kNoSpeed = 0.005;         // [m/s] below it stands
constexpr double kNoTurn = radians(1.0);   // below it goes straight on
constexpr double kNoSay = 0.005;           // [0..1] below that a rule or behavior has no say
constexpr double kMentioned = 0.1;         // [0..1] a share that is worth words in the sentence
constexpr double kFarFromTold = 0.05;      // [m/s] from the setpoint: said
constexpr std::size_t kMostMentioned = 3;  // behaviors in the sentence

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string speed_text(double speed) {
  // No "-0.00".
  return format("%.2f m/s", std::abs(speed) < kNoSpeed ? 0.0 : speed);
}

/// "12 degrees"; so little that nobody sees it turn with a decimal.
std::string angle_text(double angle) {
  const double size = degrees(std::abs(angle));
  const double shown = std::round(size);
  return size < 0.95 ? format("%.1f degrees", size)
                     : format("%.0f degree%s", shown, shown == 1.0 ? "" : "s");
}

std::string turn_text(double turn) {
  if (std::abs(turn) < kNoTurn)
    return "straight on";
  return angle_text(turn) + " to the " + (turn > 0.0 ? "left" : "right");
}

bool has_word(const std::string& text, const std::string& word) {
  const auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  for (std::size_t at = text.find(word); at != std::string::npos && !word.empty();
       at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_part(text[at - 1])) && (end == text.size() || !is_part(text[end])))
      return true;
  }
  return false;
}

std::string listed(const std::vector<std::string>& parts, const char* last = " and ") {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? last : ", ") + parts[i];
  return text;
}

double clamp01(double x) {
  return std::clamp(x, 0.0, 1.0);
}

enum class Channel { speed, turn };

Channel channel_of(const v1::RuleState& rule) {
  return rule.action() == v1::CONTROL_TURN_LEFT || rule.action() == v1::CONTROL_TURN_RIGHT
             ? Channel::turn
             : Channel::speed;
}

double weight_of(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? behavior.turn_weight() : behavior.speed_weight();
}

double activity_of(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? behavior.turn_activity() : behavior.speed_activity();
}

bool recommends(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? behavior.recommends_turn() : behavior.recommends_speed();
}

/// What a behavior alone would have.
std::string wish_of(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? turn_text(behavior.turn()) : speed_text(behavior.speed());
}

std::string control_text(const v1::RuleState& rule) {
  switch (rule.action()) {
    case v1::CONTROL_TURN_LEFT:
      return angle_text(rule.value()) + " to the left";
    case v1::CONTROL_TURN_RIGHT:
      return angle_text(rule.value()) + " to the right";
    case v1::CONTROL_ACCELERATE:
      return "faster by " + speed_text(rule.value());
    case v1::CONTROL_DECELERATE:
      return "slower by " + speed_text(rule.value());
    case v1::CONTROL_SPEED:
      break;
  }
  return speed_text(rule.value());
}

/// A name without the number behind it that makes it unique: follow of follow#8.
std::string without_number(const std::string& name) {
  return name.substr(0, name.rfind('#'));
}

std::string plain(const std::string& name) {
  std::string result;
  for (const char c : name)
    if (c != '-' && c != '_')
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Whether an instance has its name from its schema: KeepOff#3, keep-off.
bool nameless(const std::string& name, const std::string& schema) {
  return name.empty() || plain(without_number(name)) == plain(schema);
}

std::string intention_name(const v1::IntentionNode& node) {
  // The root of a goal's tree has the goal's id for a name.
  return node.parent() == 0 || nameless(node.name(), node.schema())
             ? node.schema()
             : node.schema() + " (" + node.name() + ")";
}

std::string with_arguments(const v1::IntentionNode& node) {
  return intention_name(node) + (node.arguments().empty() ? "" : " [" + node.arguments() + "]");
}

/// How a behavior takes part in a channel of the blend.
struct Say {
  const v1::BehaviorState* behavior = nullptr;
  double weight = 0.0;  ///< its rules' strengths times what is left of its activity
  double share = 0.0;   ///< [0..1] of all weights on the channel
  const v1::RuleState* main_rule = nullptr;
};

/// Walks over what is known and puts it into words.
class Reason {
 public:
  explicit Reason(const Scene& scene) : scene_(scene) {}

  Explanation why();
  Explanation why_not(Wish wish);

 private:
  bool driven_by_behaviors() const {
    return scene_.grant && scene_.grant->role() == v1::ROLE_BEHAVIORS;
  }
  double told_speed() const {
    return scene_.grant ? scene_.grant->velocity() : scene_.behaviors->speed();
  }
  std::string name_of(const v1::BehaviorState& behavior) const;
  std::vector<Say> says(Channel channel) const;
  std::string told() const;
  std::string of_say(const Say& say, Channel channel) const;
  std::string wants(const std::vector<Say>& speeds, const std::vector<Say>& turns,
                    const v1::BehaviorState& behavior) const;

  const v1::RuleText* text_of(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;
  std::string antecedent(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;

  const v1::IntentionNode* node(std::uint32_t id) const;
  const v1::IntentionNode* node_of(const v1::BehaviorState& behavior) const;
  const v1::GoalStatus* status(const v1::GoalId& id) const;
  std::string goal_text(const v1::GoalId& id) const;
  std::string requester(const v1::GoalId& id) const;
  std::string purpose(const std::vector<const v1::BehaviorState*>& behaviors) const;
  std::string idle_reason() const;

  Cause grant_cause() const;
  std::optional<Cause> guard_cause() const;
  Cause rule_cause(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;
  Cause behavior_cause(const Say& say, Channel channel);
  Cause channel_cause(Channel channel);
  std::optional<Cause> chain(const v1::BehaviorState& behavior);
  std::optional<Cause> chain(const v1::IntentionNode& node);
  Cause goal_cause(const v1::GoalId& id) const;
  Cause wheels(const std::string& text);

  Explanation stopped() const;
  Explanation by_hand() const;
  Explanation finish(std::string sentence, Cause cause) const;

  const Scene& scene_;
  std::set<std::uint32_t> told_nodes_;
};

std::string Reason::name_of(const v1::BehaviorState& behavior) const {
  const auto short_name = [](const v1::BehaviorState& one) {
    if (nameless(one.name(), one.schema()))
      return one.schema();
    const std::string name = without_number(one.name());
    return one.schema().empty() ? name : name + " (" + one.schema() + ")";
  };
  const std::string name = short_name(behavior);
  const auto& all = scene_.behaviors->behaviors();
  const auto alike = std::count_if(all.begin(), all.end(), [&](const v1::BehaviorState& other) {
    return short_name(other) == name;
  });
  return alike == 1 ? name : behavior.name();
}

std::vector<Say> Reason::says(Channel channel) const {
  std::vector<Say> result;
  double all = 0.0;
  for (const v1::BehaviorState& behavior : scene_.behaviors->behaviors()) {
    if (!behavior.running() || !recommends(behavior, channel))
      continue;
    Say say;
    say.behavior = &behavior;
    for (const v1::RuleState& rule : behavior.rules()) {
      if (channel_of(rule) != channel)
        continue;
      say.weight += clamp01(rule.strength()) * weight_of(behavior, channel);
      // Of turns what counts is how far they turn; of speeds, how strongly they hold.
      const auto counts = [&](const v1::RuleState& r) {
        return r.strength() * (channel == Channel::turn ? std::abs(r.value()) : 1.0);
      };
      if (rule.strength() > 0.0 &&
          (say.main_rule == nullptr || counts(rule) > counts(*say.main_rule)))
        say.main_rule = &rule;
    }
    all += say.weight;
    result.push_back(say);
  }
  for (Say& say : result)
    say.share = all > 0.0 ? say.weight / all : 0.0;
  std::stable_sort(result.begin(), result.end(),
                   [](const Say& a, const Say& b) { return a.weight > b.weight; });
  return result;
}

/// What the wheels are told.
std::string Reason::told() const {
  const double speed = told_speed();
  const double turn = scene_.behaviors->turning() ? scene_.behaviors->turn() : 0.0;
  const bool turns = std::abs(turn) >= kNoTurn;
  std::string text = "The robot is told to ";
  if (std::abs(speed) >= kNoSpeed)
    text += (speed > 0.0 ? "drive ahead at " : "back up at ") + speed_text(std::abs(speed)) +
            (turns ? " and to turn " : ", straight on");
  else
    text += turns ? "turn on the spot, " : "stand";
  if (turns)
    text += turn_text(turn);
  if (scene_.robot && std::abs(scene_.robot->velocity() - speed) >= kFarFromTold)
    text += " (now it does " + speed_text(scene_.robot->velocity()) + ")";
  return text;
}

const v1::RuleText* Reason::text_of(const v1::BehaviorState& behavior,
                                    const v1::RuleState& rule) const {
  for (const v1::BehaviorSchema& schema : scene_.schemas)
    if (schema.name() == behavior.schema())
      for (const v1::RuleText& text : schema.rules())
        if (text.name() == rule.name())
          return &text;
  return nullptr;
}

/// The rule's antecedent as it is written, with the values of what is in it; empty where it is not
/// known.
std::string Reason::antecedent(const v1::BehaviorState& behavior, const v1::RuleState& rule) const {
  const v1::RuleText* const text = text_of(behavior, rule);
  if (text == nullptr || text->antecedent().empty())
    return {};
  std::vector<std::string> values;
  for (const v1::FuzzyVariable& variable : behavior.variables())
    if (has_word(text->antecedent(), variable.name()))
      values.push_back(variable.name() + format(" %.2f", variable.value()));
  return "if " + text->antecedent() + (values.empty() ? "" : ": " + listed(values, ", "));
}

const v1::IntentionNode* Reason::node(std::uint32_t id) const {
  if (scene_.intentions && id != 0)
    for (const v1::IntentionNode& candidate : scene_.intentions->nodes())
      if (candidate.id() == id)
        return &candidate;
  return nullptr;
}

/// The intention that wants the behavior.
const v1::IntentionNode* Reason::node_of(const v1::BehaviorState& behavior) const {
  if (scene_.intentions)
    for (const v1::IntendedBehavior& intended : scene_.intentions->behaviors())
      if (intended.name() == behavior.name()) {
        const v1::IntentionNode* const found = node(intended.intention());
        return found != nullptr && is_behavior(*found, *scene_.intentions) ? node(found->parent())
                                                                           : found;
      }
  return nullptr;
}

bool same(const v1::GoalId& a, const v1::GoalId& b) {
  return a.writer() == b.writer() && a.number() == b.number();
}

const v1::GoalStatus* Reason::status(const v1::GoalId& id) const {
  for (const v1::GoalStatus& candidate : scene_.statuses)
    if (same(candidate.id(), id))
      return &candidate;
  return nullptr;
}

/// Empty where nothing is known of it.
std::string Reason::goal_text(const v1::GoalId& id) const {
  for (const v1::Goal& goal : scene_.goals)
    if (same(goal.id(), id))
      return describe(goal);
  const v1::GoalStatus* const known = status(id);
  return known == nullptr ? "" : known->functor();
}

std::string Reason::requester(const v1::GoalId& id) const {
  for (const v1::Goal& goal : scene_.goals)
    if (same(goal.id(), id) && !goal.requester().empty())
      return goal.requester();
  const v1::GoalStatus* const known = status(id);
  return known == nullptr || known->requester().empty() ? "somebody" : known->requester();
}

/// For which intention and goal these behaviors are there: a clause; empty where it is not known.
std::string Reason::purpose(const std::vector<const v1::BehaviorState*>& behaviors) const {
  std::vector<const v1::IntentionNode*> nodes;
  for (const v1::BehaviorState* behavior : behaviors)
    if (const v1::IntentionNode* const found = node_of(*behavior);
        found != nullptr && std::find(nodes.begin(), nodes.end(), found) == nodes.end())
      nodes.push_back(found);
  if (nodes.empty())
    return {};
  std::vector<std::string> names;
  names.reserve(nodes.size());
  for (const v1::IntentionNode* one : nodes)
    names.push_back(with_arguments(*one));
  const v1::IntentionNode* root = nodes.front();
  while (const v1::IntentionNode* const parent = node(root->parent()))
    root = parent;
  // What was asked for, by itself.
  std::string text = "this is";
  if (root != nodes.front() || nodes.size() > 1)
    text = listed(names) + (nodes.size() == 1 ? " intends " : " intend ") +
           (behaviors.size() == 1 ? "it" : "them");
  const std::string goal = goal_text(root->goal());
  if (root != nodes.front() && plain(goal.substr(0, goal.find('('))) != plain(root->schema()))
    text += ", as part of " + intention_name(*root) + ",";
  return text + (goal.empty() ? " for a goal of which nothing is known"
                              : " for the goal " + goal + ", which " + requester(root->goal()) +
                                    " asked for");
}

std::string Reason::of_say(const Say& say, Channel channel) const {
  std::vector<std::string> details;
  if (say.main_rule != nullptr)
    details.push_back("rule " + say.main_rule->name() +
                      format(", %.2f", say.main_rule->strength()));
  if (say.share < 1.0 - kNoSay)
    details.push_back(format("%.0f %% of the say", 100.0 * say.share));
  return wish_of(*say.behavior, channel) +
         (details.empty() ? "" : " (" + listed(details, "; ") + ")");
}

/// What a behavior wants on both channels, as far as it is to be mentioned.
std::string Reason::wants(const std::vector<Say>& speeds, const std::vector<Say>& turns,
                          const v1::BehaviorState& behavior) const {
  std::vector<std::string> parts;
  for (const Say& say : speeds)
    if (say.behavior == &behavior)
      parts.push_back(of_say(say, Channel::speed));
  for (const Say& say : turns)
    if (say.behavior == &behavior)
      parts.push_back(of_say(say, Channel::turn));
  return name_of(behavior) + " wants " + listed(parts);
}

Cause Reason::grant_cause() const {
  const v1::Grant& grant = *scene_.grant;
  Cause cause{"grant", std::string(cli::name_of(grant.role())), {}};
  if (grant.role() == v1::ROLE_NONE)
    cause.text = "nobody drives";
  else
    cause.text = grant.source() + " drives as " + cli::name_of(grant.role());
  if (!grant.reason().empty())
    cause.text += ": " + grant.reason();
  for (const v1::Refusal& refusal : grant.refused())
    cause.because.push_back({"grant",
                             refusal.source() + " (" + cli::name_of(refusal.role()) +
                                 ") was refused: " + refusal.reason(),
                             {}});
  return cause;
}

std::optional<Cause> Reason::guard_cause() const {
  if (!scene_.grant || scene_.grant->guard() == v1::GUARD_NONE)
    return std::nullopt;
  return Cause{"guard",
               std::string("the guard beside the robot ") + cli::name_of(scene_.grant->guard()) +
                   " it (" + scene_.grant->guard_reason() + ")",
               {}};
}

Cause Reason::rule_cause(const v1::BehaviorState& behavior, const v1::RuleState& rule) const {
  Cause cause{
      "rule",
      "rule " + rule.name() + format(" holds to %.2f: ", rule.strength()) + control_text(rule),
      {}};
  if (const std::string text = antecedent(behavior, rule); !text.empty())
    cause.because.push_back({"rule", text, {}});
  return cause;
}

Cause Reason::goal_cause(const v1::GoalId& id) const {
  if (goal_text(id).empty())
    return {"goal", "a goal of which nothing is known", {}};
  return {"goal", "goal " + goal_text(id) + " of " + requester(id), {}};
}

std::optional<Cause> Reason::chain(const v1::IntentionNode& of) {
  Cause cause{"intention", "for " + with_arguments(of), {}};
  if (!of.label().empty())
    cause.text += ", at " + of.label();
  if (!of.step().empty())
    cause.text += ": " + of.step();
  if (!told_nodes_.insert(of.id()).second) {
    cause.text = "for " + intention_name(of) + ", as above";
    return cause;
  }
  if (const v1::IntentionNode* const parent = node(of.parent())) {
    if (auto above = chain(*parent))
      cause.because.push_back(std::move(*above));
  } else {
    cause.because.push_back(goal_cause(of.goal()));
  }
  return cause;
}

std::optional<Cause> Reason::chain(const v1::BehaviorState& behavior) {
  const v1::IntentionNode* const found = node_of(behavior);
  return found == nullptr ? std::nullopt : chain(*found);
}

Cause Reason::behavior_cause(const Say& say, Channel channel) {
  const v1::BehaviorState& behavior = *say.behavior;
  Cause cause{"behavior",
              name_of(behavior) + format(", priority %d, ", behavior.priority()) +
                  (say.weight < kNoSay ? "has no say: "
                                       : format("%.0f %% of the say: ", 100.0 * say.share)) +
                  wish_of(behavior, channel),
              {}};
  if (say.weight < kNoSay && activity_of(behavior, channel) >= kNoSay) {
    for (const v1::BehaviorState& above : scene_.behaviors->behaviors())
      if (above.running() && above.priority() < behavior.priority() &&
          activity_of(above, channel) >= 1.0 - kNoSay) {
        cause.because.push_back({"behavior", name_of(above) + " is above it and fully active", {}});
        break;
      }
  }
  for (const v1::RuleState& rule : behavior.rules())
    if (channel_of(rule) == channel && rule.strength() >= kNoSay)
      cause.because.push_back(rule_cause(behavior, rule));
  if (auto purpose = chain(behavior))
    cause.because.push_back(std::move(*purpose));
  return cause;
}

Cause Reason::channel_cause(Channel channel) {
  const v1::Behaviors& all = *scene_.behaviors;
  Cause cause;
  if (channel == Channel::speed)
    cause = {"speed",
             all.moving() ? "the behaviors' blend of speeds: " + speed_text(all.speed())
                          : "no behavior wants a speed: it stands",
             {}};
  else
    cause = {"turn",
             all.turning() ? "the behaviors' blend of turns: " + turn_text(all.turn())
                           : "no behavior wants a turn: straight on",
             {}};
  for (const Say& say : says(channel))
    cause.because.push_back(behavior_cause(say, channel));
  return cause;
}

Cause Reason::wheels(const std::string& text) {
  Cause cause{"wheels", text, {}};
  if (scene_.grant)
    cause.because.push_back(grant_cause());
  if (auto guard = guard_cause())
    cause.because.push_back(std::move(*guard));
  if (scene_.behaviors) {
    cause.because.push_back(channel_cause(Channel::speed));
    cause.because.push_back(channel_cause(Channel::turn));
    if (!scene_.behaviors->trouble().empty())
      cause.because.push_back(
          {"trouble", "behaviors that cannot be had: " + scene_.behaviors->trouble(), {}});
  }
  return cause;
}

/// Why the behaviors do not want to drive; empty where that is not known.
std::string Reason::idle_reason() const {
  if (!scene_.missing.empty())
    return scene_.missing + " is not on the bus";
  if (!scene_.suspended.empty())
    return scene_.suspended + " is suspended";
  if (scene_.intentions && !scene_.intentions->behavior_control())
    return "behavior control is switched off";
  if (scene_.intentions && !scene_.intentions->behaviors().empty())
    return {};
  const v1::GoalStatus* newest = nullptr;
  for (const v1::GoalStatus& status : scene_.statuses) {
    if (status.state() == v1::GOAL_UNDERWAY)
      return "the goal " + goal_text(status.id()) + " of " + requester(status.id()) +
             " is underway and intends no behavior now" +
             (status.step().empty() ? "" : ": " + status.step());
    if (newest == nullptr || status.stamp().epoch() > newest->stamp().epoch() ||
        (status.stamp().epoch() == newest->stamp().epoch() &&
         status.stamp().cycle() >= newest->stamp().cycle()))
      newest = &status;
  }
  if (newest == nullptr)
    return "nobody has asked for a goal";
  std::string text = "no goal is underway; the newest one, " + goal_text(newest->id()) + " of " +
                     requester(newest->id()) + ", ";
  switch (newest->state()) {
    case v1::GOAL_WAITING:
      text += "waits";
      break;
    case v1::GOAL_SUSPENDED:
      text += "is suspended";
      break;
    case v1::GOAL_REFUSED:
      text += "was refused";
      break;
    case v1::GOAL_SUCCEEDED:
      text += "succeeded";
      break;
    case v1::GOAL_CANCELED:
      text += "was canceled";
      break;
    default:
      text += "failed";
      break;
  }
  return text + (newest->reason().empty() ? "" : ": " + newest->reason());
}

Explanation Reason::finish(std::string sentence, Cause cause) const {
  Explanation result;
  result.cycle = scene_.cycle;
  if (scene_.behaviors)
    result.epoch = scene_.behaviors->stamp().epoch();
  else if (scene_.grant)
    result.epoch = scene_.grant->stamp().epoch();
  result.sentence = std::move(sentence) + ".";
  result.cause = std::move(cause);
  return result;
}

Explanation Reason::stopped() const {
  const v1::Grant& grant = *scene_.grant;
  const std::string idle = idle_reason();
  std::string sentence = "The robot stands because nobody drives it: " + grant.reason();
  Cause cause{"wheels", "The robot is told to stand", {grant_cause()}};
  if (!idle.empty()) {
    sentence += "; " + idle;
    cause.because.front().because.push_back({"goal", idle, {}});
  }
  return finish(std::move(sentence), std::move(cause));
}

Explanation Reason::by_hand() const {
  const v1::Grant& grant = *scene_.grant;
  std::string sentence;
  if (grant.role() == v1::ROLE_ESTOP)
    sentence = "The robot is told to stop because " + grant.source() + " holds the emergency stop";
  else
    sentence = "The robot is told to drive at " + speed_text(grant.velocity()) + " because " +
               grant.source() + " drives it (" + cli::name_of(grant.role()) + ")";
  Cause cause{"wheels", sentence, {grant_cause()}};
  if (auto guard = guard_cause()) {
    sentence += "; " + guard->text;
    cause.because.push_back(std::move(*guard));
  }
  return finish(std::move(sentence), std::move(cause));
}

Explanation Reason::why() {
  if (!scene_.robot && !scene_.grant && !scene_.behaviors)
    return finish("Nothing is known of this cycle" +
                      (scene_.missing.empty() ? "" : ": not on the bus: " + scene_.missing),
                  {"wheels", "nothing is known", {}});
  if (scene_.grant && scene_.grant->role() == v1::ROLE_NONE)
    return stopped();
  if (scene_.grant && scene_.grant->role() != v1::ROLE_BEHAVIORS)
    return by_hand();
  if (!scene_.behaviors)
    return finish("What the behaviors computed in this cycle is not known",
                  {"wheels", "not known",
                   scene_.grant ? std::vector<Cause>{grant_cause()} : std::vector<Cause>{}});

  const std::string what = told();
  std::string sentence = what;
  std::vector<const v1::BehaviorState*> mentioned;
  const auto mention = [&](const Say& say) {
    if (std::find(mentioned.begin(), mentioned.end(), say.behavior) == mentioned.end())
      mentioned.push_back(say.behavior);
  };
  std::vector<std::string> reasons;
  const bool guarded = scene_.grant && scene_.grant->guard() != v1::GUARD_NONE;
  if (guarded)
    reasons.push_back(guard_cause()->text);
  const double turn = scene_.behaviors->turning() ? scene_.behaviors->turn() : 0.0;
  std::vector<Say> speeds = says(Channel::speed);
  std::vector<Say> turns = says(Channel::turn);
  const auto few = [](std::vector<Say>& all) {
    std::erase_if(all,
                  [](const Say& say) { return say.share < kMentioned || say.weight < kNoSay; });
    if (all.size() > kMostMentioned)
      all.resize(kMostMentioned);
  };
  few(speeds);
  few(turns);
  // Going straight on needs no reason unless somebody wanted something else.
  std::erase_if(turns, [](const Say& say) { return std::abs(say.behavior->turn()) < kNoTurn; });
  if (std::abs(turn) < kNoTurn && turns.size() < 2)
    turns.clear();
  for (const Say& say : speeds)
    mention(say);
  for (const Say& say : turns)
    mention(say);
  for (const v1::BehaviorState* behavior : mentioned)
    reasons.push_back(wants(speeds, turns, *behavior));
  if (speeds.empty() && !guarded)
    reasons.emplace_back("no behavior wants a speed");
  sentence += ", because " + listed(reasons, ", and ");
  if (const std::string what_for = purpose(mentioned); !what_for.empty())
    sentence += "; " + what_for;
  return finish(std::move(sentence), wheels(what));
}

Explanation Reason::why_not(Wish wish) {
  const bool turning = wish == Wish::turn_left || wish == Wish::turn_right;
  const Channel channel = turning ? Channel::turn : Channel::speed;
  const std::string wanted = wish == Wish::turn_left    ? "turn left"
                             : wish == Wish::turn_right ? "turn right"
                             : wish == Wish::faster     ? "go faster"
                                                        : "go slower";
  const std::string no = "It does not " + wanted;
  if (!scene_.grant || scene_.grant->role() != v1::ROLE_BEHAVIORS || !scene_.behaviors) {
    const Explanation as_it_is = why();
    std::string sentence = as_it_is.sentence;
    sentence.pop_back();
    return finish(no + " because the behaviors do not drive it. " + sentence, as_it_is.cause);
  }

  const v1::Behaviors& all = *scene_.behaviors;
  const double turn = all.turning() ? all.turn() : 0.0;
  const double speed = told_speed();
  const double velocity = scene_.robot ? scene_.robot->velocity() : speed;
  const bool does = wish == Wish::turn_left    ? turn >= kNoTurn
                    : wish == Wish::turn_right ? turn <= -kNoTurn
                    : wish == Wish::faster     ? speed >= velocity + kFarFromTold
                                               : speed <= velocity - kFarFromTold;
  if (does) {
    const Explanation as_it_is = why();
    std::string sentence = as_it_is.sentence;
    sentence.pop_back();
    return finish("It does " + wanted + ". " + sentence, as_it_is.cause);
  }

  Cause cause{"wheels", told(), {}};
  if (wish == Wish::faster && scene_.grant->guard() != v1::GUARD_NONE &&
      all.speed() > speed + kNoSpeed) {
    const Cause guard = *guard_cause();
    cause.because.push_back(guard);
    cause.because.push_back(channel_cause(channel));
    return finish(no + " because " + guard.text + "; the behaviors want " + speed_text(all.speed()),
                  std::move(cause));
  }

  const auto would = [&](const v1::RuleState& rule) {
    switch (wish) {
      case Wish::turn_left:
        return rule.action() == v1::CONTROL_TURN_LEFT && rule.value() > 0.0;
      case Wish::turn_right:
        return rule.action() == v1::CONTROL_TURN_RIGHT && rule.value() > 0.0;
      case Wish::faster:
        return rule.action() == v1::CONTROL_ACCELERATE ||
               (rule.action() == v1::CONTROL_SPEED && rule.value() > speed + kNoSpeed);
      case Wish::slower:
        break;
    }
    return rule.action() == v1::CONTROL_DECELERATE ||
           (rule.action() == v1::CONTROL_SPEED && rule.value() < speed - kNoSpeed);
  };
  // The best reason is of the rule that came nearest to having its way.
  enum Rank { not_true, too_little, no_activity, suppressed, outweighed };
  struct Best {
    int rank = -1;
    double measure = 0.0;
    std::string text;
  } best;
  const auto consider = [&](Rank rank, double measure, std::string text, Cause detail) {
    cause.because.push_back(std::move(detail));
    if (rank > best.rank || (rank == best.rank && measure > best.measure))
      best = {rank, measure, std::move(text)};
  };
  const std::vector<Say> say = says(channel);
  for (const v1::BehaviorState& behavior : all.behaviors()) {
    // What the rules of one that does not run would say is not known.
    if (!behavior.running())
      continue;
    for (const v1::RuleState& rule : behavior.rules()) {
      if (!would(rule))
        continue;
      // A setpoint of a rule that does not hold is nobody's wish.
      if (wish == Wish::faster && rule.action() == v1::CONTROL_SPEED && rule.strength() < kNoSay)
        continue;
      const std::string who =
          name_of(behavior) + " would (rule " + rule.name() + ", " + control_text(rule) + ")";
      const double weight = weight_of(behavior, channel);
      Cause detail = rule_cause(behavior, rule);
      detail.text = name_of(behavior) + ": " + detail.text;
      if (rule.strength() < kNoSay) {
        const std::string text = antecedent(behavior, rule);
        consider(not_true, 0.0, who + ", but finds no cause" + (text.empty() ? "" : ": " + text),
                 std::move(detail));
      } else if (turning && rule.strength() * rule.value() < kNoTurn) {
        consider(too_little, rule.value(), who + ", but that is as good as straight on",
                 std::move(detail));
      } else if (activity_of(behavior, channel) < kNoSay) {
        consider(no_activity, rule.strength(), who + ", but says itself that it does not count now",
                 std::move(detail));
      } else if (weight < kNoSay) {
        std::vector<std::string> above;
        for (const v1::BehaviorState& other : all.behaviors())
          if (other.running() && other.priority() < behavior.priority() &&
              activity_of(other, channel) >= kNoSay)
            above.push_back(name_of(other));
        consider(suppressed, rule.strength(),
                 who + ", but " + (above.empty() ? "others of higher priority" : listed(above)) +
                     (above.size() == 1 ? " is above it and leaves it no say"
                                        : " are above it and leave it no say"),
                 std::move(detail));
      } else {
        const Say* against = nullptr;
        for (const Say& other : say) {
          const bool opposed = turning ? (wish == Wish::turn_left) != (other.behavior->turn() > 0.0)
                               : wish == Wish::faster ? other.behavior->speed() < speed + kNoSpeed
                                                      : other.behavior->speed() > speed - kNoSpeed;
          if (opposed && other.weight >= kNoSay && against == nullptr)
            against = &other;
        }
        // Within one behavior, too, a rule may speak against another.
        const std::string what = against == nullptr ? "it weighs too little for it"
                                                    : name_of(*against->behavior) + " wants " +
                                                          of_say(*against, channel);
        consider(outweighed, rule.strength() * weight, who + ", but " + what, std::move(detail));
      }
    }
  }
  if (best.rank < 0) {
    std::string text = no + ", because no running behavior ";
    text += turning ? "has a rule that would" : "wants that";
    for (const Say& one : say)
      if (one.weight >= kNoSay) {
        text.append("; ")
            .append(name_of(*one.behavior))
            .append(" wants ")
            .append(of_say(one, channel));
        break;
      }
    return finish(text, wheels(told()));
  }
  cause.because.push_back(channel_cause(channel));
  return finish(no + ": " + best.text, std::move(cause));
}

void draw(const Cause& cause, const std::string& indent, std::string& text) {
  for (std::size_t i = 0; i < cause.because.size(); ++i) {
    const bool last = i + 1 == cause.because.size();
    text.append(indent).append(last ? "`- " : "|- ").append(cause.because[i].text).append("\n");
    draw(cause.because[i], indent + (last ? "   " : "|  "), text);
  }
}

nlohmann::ordered_json json_of(const Cause& cause) {
  nlohmann::ordered_json json;
  json["kind"] = cause.kind;
  json["text"] = cause.text;
  json["because"] = nlohmann::ordered_json::array();
  for (const Cause& one : cause.because)
    json["because"].push_back(json_of(one));
  return json;
}

}  // namespace

Explanation why(const Scene& scene) {
  return Reason(scene).why();
}

Explanation why_not(const Scene& scene, Wish wish) {
  return Reason(scene).why_not(wish);
}

std::optional<Wish> parse_wish(const std::vector<std::string>& words) {
  const std::string text = listed(words, " ");
  if (text == "turn left")
    return Wish::turn_left;
  if (text == "turn right")
    return Wish::turn_right;
  if (text == "faster")
    return Wish::faster;
  if (text == "slower")
    return Wish::slower;
  return std::nullopt;
}

std::string to_text(const Explanation& explanation) {
  std::string text = explanation.sentence + "\n\n" + "cycle " + std::to_string(explanation.cycle) +
                     ": " + explanation.cause.text + "\n";
  draw(explanation.cause, "", text);
  return text;
}

std::string to_json(const Explanation& explanation) {
  nlohmann::ordered_json json;
  json["epoch"] = explanation.epoch;
  json["cycle"] = explanation.cycle;
  json["sentence"] = explanation.sentence;
  json["tree"] = json_of(explanation.cause);
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace saphira::cli
