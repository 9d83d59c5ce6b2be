#include "saphira/cli/displays.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "saphira/base/cycle.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/words.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

using situation::is_behavior;

namespace {

constexpr int kBar = 8;                      // characters each side of the middle line
constexpr double kFullTurn = radians(30.0);  // the length of the bar
constexpr double kFullSpeed = 0.4;           // [m/s]

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width)
    text.append(width - text.size(), ' ');
  return text;
}

/// The length of the longest text.
template <class Items, class Text>
std::size_t widest(const Items& items, Text text) {
  std::size_t most = 0;
  for (const auto& item : items)
    most = std::max(most, std::invoke(text, item).size());
  return most;
}

/// |===>>>| : activity on both sides of the line, the recommendation (left or right of it) over it.
std::string bar(double activity, double amount, bool recommends) {
  const auto length = [](double part) {
    return static_cast<int>(std::lround(kBar * std::clamp(part, 0.0, 1.0)));
  };
  const int active = length(activity);
  const int strong = recommends ? length(std::abs(amount)) : 0;
  std::string text;
  for (int i = kBar; i >= 1; --i)
    text += amount < 0.0 && i <= strong ? '<' : i <= active ? '=' : ' ';
  text += '|';
  for (int i = 1; i <= kBar; ++i)
    text += amount > 0.0 && i <= strong ? '>' : i <= active ? '=' : ' ';
  return "[" + text + "]";
}

// A turn to the left is drawn to the left.
std::string turn_bar(double activity, double turn, bool recommends) {
  return bar(activity, -turn / kFullTurn, recommends);
}

std::string speed_bar(double activity, double speed, bool recommends) {
  return bar(activity, speed / kFullSpeed, recommends);
}

std::string turn_words(double turn, bool recommends) {
  if (!recommends)
    return "-";
  const double angle = degrees(std::abs(turn));
  return angle < 0.5 ? "0" : format("%.0f %s", angle, turn > 0.0 ? "left" : "right");
}

std::string speed_words(double speed, bool recommends) {
  return recommends ? format("%.2f", std::abs(speed) < 0.005 ? 0.0 : speed) : "-";
}

const char* sign_of(v1::ControlAction action) {
  return word_of(action, {"<", ">", "+", "-", "="});
}

/// Such as "2.5 s", for people.
std::string ago(std::uint64_t since, std::uint64_t now) {
  return since > now ? "-" : format("%.1f s", seconds_of(now - since));
}

struct TreeLine {
  std::string left;
  std::string right;
};

/// The instance in brackets: "Stop (rest, instance 32)", "GoToPos (instance 7)".
std::string with_instance(const std::string& schema, const std::string& name) {
  const bool same = name != schema && without_instance(name) == schema;
  return schema + " (" +
         (same ? instance_words(name).substr(schema.size() + 2) : instance_words(name)) + ")";
}

TreeLine behavior_line(const std::string& indent, bool blocking, const std::string& schema,
                       const std::string& name, const v1::BehaviorSet* behaviors) {
  TreeLine line{indent + (blocking ? "* " : "o ") + with_instance(schema, name) + " B", ""};
  if (behaviors != nullptr)
    for (const v1::BehaviorState& state : behaviors->behaviors)
      if (state.name == name)
        line.right = format("activity %.2f, goal %.2f",
                            std::max(state.turn_activity, state.speed_activity), state.goal);
  return line;
}

TreeLine intention_line(const std::string& indent, const v1::IntentionNode& node) {
  TreeLine line{
      indent + (node.blocking ? "* " : "o ") +
          with_instance(node.schema, node.name.empty() ? "I" + std::to_string(node.id) : node.name),
      node.arguments + (node.arguments.empty() || node.step.empty() ? "" : "; ") + node.step};
  if (node.state == v1::INTENTION_INIT || node.state == v1::INTENTION_RUNNING)
    return line;
  const std::string how = word_of(node.state, {"", "", "suspended", "interrupted", "has succeeded",
                                               "has failed", "took too long"});
  line.right = how + (line.right.empty() ? "" : "; " + line.right);
  return line;
}

void add_tree(const v1::Intentions& all, const v1::BehaviorSet* behaviors, std::uint32_t parent,
              std::size_t depth, std::vector<TreeLine>& lines) {
  const std::string indent(2 * depth, ' ');
  if (depth > all.nodes.size())
    return;  // a cyclic tree
  for (const v1::IntentionNode& node : all.nodes) {
    if (node.parent != parent)
      continue;
    if (is_behavior(node, all)) {
      lines.push_back(behavior_line(indent, node.blocking, node.schema, node.name, behaviors));
      if (node.state == v1::INTENTION_SUSPENDED)
        lines.back().right = "suspended";
      continue;
    }
    lines.push_back(intention_line(indent, node));
    add_tree(all, behaviors, node.id, depth + 1, lines);
  }
  if (parent == 0)
    return;
  for (const v1::IntendedBehavior& behavior : all.behaviors)
    if (behavior.intention == parent)
      lines.push_back(
          behavior_line(indent, behavior.blocking, behavior.schema, behavior.name, behaviors));
}

}  // namespace

std::string value_text(const v1::Argument& argument) {
  switch (argument.kind) {
    case v1::ARGUMENT_NUMBER:
      return format("%.4g", argument.number);
    case v1::ARGUMENT_TEXT:
      return "\"" + argument.text + "\"";
    case v1::ARGUMENT_TRUTH:
      return argument.number != 0.0 ? "yes" : "no";
    case v1::ARGUMENT_UNBOUND:
      return "?";
    case v1::ARGUMENT_POINT:
      break;
  }
  const v1::Pose2& point = argument.point;
  return format("(%.2f, %.2f, %.0f deg) in %s", point.x, point.y, degrees(point.th),
                situation::name_of(argument.frame));
}

std::string intentions_display(const v1::Intentions& intentions, const v1::BehaviorSet* behaviors) {
  if (intentions.nodes.empty())
    return "nothing is intended\n";
  std::vector<TreeLine> lines;
  add_tree(intentions, behaviors, 0, 0, lines);
  const std::size_t width = widest(lines, &TreeLine::left);
  std::string text;
  for (const TreeLine& line : lines)
    text += (line.right.empty() ? line.left : padded(line.left, width + 3) + line.right) + "\n";
  if (!intentions.behavior_control)
    text += "behavior control is off\n";
  return text;
}

std::string without_instance(const std::string& name) {
  const std::size_t mark = name.rfind('#');
  const bool numbered = mark != std::string::npos && mark > 0 && mark + 1 < name.size() &&
                        name.find_first_not_of("0123456789", mark + 1) == std::string::npos;
  return numbered ? name.substr(0, mark) : name;
}

std::string instance_words(const std::string& name) {
  const std::string bare = without_instance(name);
  return bare == name ? name : bare + ", instance " + name.substr(bare.size() + 1);
}

std::string behaviors_display(const v1::BehaviorSet& behaviors) {
  if (behaviors.behaviors.empty() && behaviors.trouble.empty())
    return "no behavior is intended\n";
  std::size_t width = 9;
  std::vector<std::string> names;
  for (const v1::BehaviorState& state : behaviors.behaviors) {
    names.push_back(state.name == state.schema || state.schema.empty()
                        ? instance_words(state.name)
                        : with_instance(state.schema, state.name));
    width = std::max(width, names.back().size());
  }
  const auto row = [&](const std::string& mark, const std::string& name,
                       const std::string& priority, const std::string& turn,
                       const std::string& turn_value, const std::string& speed,
                       const std::string& speed_value) {
    return mark + " " + padded(name, width + 2) + padded(priority, 4) + " " + turn + " " +
           padded(turn_value, 10) + " " + speed + (speed_value.empty() ? "" : " ") + speed_value +
           "\n";
  };
  std::string text = row(" ", "", "pri", padded("  turn", 2 * kBar + 3), "degrees",
                         padded("  speed", 2 * kBar + 3), "m/s");
  for (std::size_t i = 0; i < behaviors.behaviors.size(); ++i) {
    const v1::BehaviorState& state = behaviors.behaviors[i];
    if (!state.running) {
      text += row("o", names[i], std::to_string(state.priority), turn_bar(0.0, 0.0, false), "",
                  speed_bar(0.0, 0.0, false), "");
      continue;
    }
    text += row("*", names[i], std::to_string(state.priority),
                turn_bar(state.turn_activity, state.turn, state.recommends_turn),
                turn_words(state.turn, state.recommends_turn),
                speed_bar(state.speed_activity, state.speed, state.recommends_speed),
                speed_words(state.speed, state.recommends_speed));
  }
  text += row(behaviors.control ? "=" : " ", "Summation", "",
              turn_bar(0.0, behaviors.turn, behaviors.turning),
              turn_words(behaviors.turn, behaviors.turning),
              speed_bar(0.0, behaviors.speed, behaviors.moving),
              speed_words(behaviors.speed, behaviors.moving));
  if (!behaviors.control)
    text += "behavior control is off: the summation does not drive\n";
  if (!behaviors.trouble.empty())
    text += "cannot be had: " + behaviors.trouble + "\n";
  return text;
}

std::string schema_display(const v1::BehaviorSchema& schema) {
  std::string text = schema.name + (schema.summary.empty() ? "" : ": " + schema.summary) +
                     "\nIt is loaded" + (schema.source.empty() ? "" : " from " + schema.source) +
                     ", and no goal or activity intends it now.\n\nParams\n";
  for (const v1::BehaviorParameter& parameter : schema.parameters) {
    text += "  " + parameter.name;
    if (parameter.required)
      text += "  required";
    else if (parameter.kind == v1::ARGUMENT_NUMBER)
      text += format("  usually %.4g", parameter.usual);
    else if (!parameter.choices.empty())
      text += "  usually " + parameter.choices.front();
    text += (parameter.meaning.empty() ? "" : "  " + parameter.meaning) + "\n";
  }
  text += "\nRules\n";
  for (const v1::RuleText& rule : schema.rules)
    text += "  " + rule.name + "   if " + rule.antecedent + " then " + rule.action + "\n";
  return text;
}

std::string unknown_behavior(const std::string& name, std::vector<std::string> names) {
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return "no behavior \"" + name.substr(0, 200) + '"' + did_you_mean(name, names, ".") +
         " There are " + (names.empty() ? "none now" : joined(names));
}

std::string behavior_display(const v1::BehaviorState& behavior,
                             const v1::IntendedBehavior* intended,
                             const v1::BehaviorSchema* schema) {
  std::string text =
      instance_words(behavior.name) +
      (without_instance(behavior.name) == behavior.schema ? "" : " (" + behavior.schema + ")");
  if (schema != nullptr && !schema->summary.empty())
    text += ": " + schema->summary;
  text += "\n\n";

  std::vector<std::string> left{"Params"};
  if (intended != nullptr)
    for (const v1::Argument& parameter : intended->parameters)
      left.push_back("  " + parameter.name + " = " + value_text(parameter));
  if (schema != nullptr)
    for (const v1::BehaviorParameter& parameter : schema->parameters) {
      const bool given =
          intended != nullptr &&
          std::ranges::any_of(intended->parameters, [&](const v1::Argument& argument) {
            return argument.name == parameter.name;
          });
      if (!given && parameter.kind == v1::ARGUMENT_NUMBER)
        left.push_back("  " + parameter.name + format(" = %.4g (as usual)", parameter.usual));
    }
  const std::vector<std::string> right{
      format("Running   %d", behavior.running ? 1 : 0),
      format("Priority  %d", static_cast<int>(behavior.priority)),
      format("Act Turn  %.2f   weight %.2f", behavior.turn_activity, behavior.turn_weight),
      format("Act Vel   %.2f   weight %.2f", behavior.speed_activity, behavior.speed_weight),
      format("Goal      %.2f", behavior.goal),
      format("Progress  %.2f", behavior.progress)};
  std::size_t width = widest(left, std::identity());
  for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
    const std::string& first = i < left.size() ? left[i] : std::string();
    text += i < right.size() ? padded(first, width + 3) + right[i] : first;
    text += "\n";
  }

  text += "\nRules\n";
  width = widest(behavior.rules, &v1::RuleState::name);
  for (const v1::RuleState& rule : behavior.rules) {
    const bool turn = rule.action == v1::CONTROL_TURN_LEFT || rule.action == v1::CONTROL_TURN_RIGHT;
    text += "  " + padded(rule.name, width) +
            format("  %.2f %s ", rule.strength, sign_of(rule.action)) +
            (turn ? format("%5.1f deg", degrees(rule.value)) : format("%5.2f m/s", rule.value));
    if (schema != nullptr)
      for (const v1::RuleText& written : schema->rules)
        if (written.name == rule.name && !written.antecedent.empty())
          text += "   if " + written.antecedent +
                  (written.action.empty() ? "" : " then " + written.action);
    text += "\n";
  }
  if (!behavior.variables.empty()) {
    text += "\nFuzzy variables\n";
    width = widest(behavior.variables, &v1::FuzzyVariable::name);
    for (const v1::FuzzyVariable& variable : behavior.variables)
      text += "  " + padded(variable.name, width) + format("  %.2f", variable.value) + "\n";
  }
  return text;
}

std::string beliefs_table(const v1::BeliefSet& beliefs, const std::string& part) {
  std::vector<std::vector<std::string>> rows{{"NAME", "VALUE", "SINCE", "SAID BY"}};
  for (const v1::Belief& belief : beliefs.beliefs)
    if (belief.name.find(part) != std::string::npos)
      rows.push_back(
          {belief.name, belief.value, ago(belief.since, beliefs.stamp.cycle), belief.said_by});
  return rows.size() == 1 ? "" : table(rows);
}

std::string state_text(const v1::Process& process) {
  if (process.state == v1::PROCESS_RUNNING && process.number != 0)
    return std::to_string(process.number);
  return word_of(process.state, {"INIT", "RUN", "SUSP", "RESUME", "INTERRUPT", "SLEEP"});
}

std::string processes_table(std::vector<v1::ProcessSet> services) {
  std::ranges::stable_sort(services, [](const v1::ProcessSet& a, const v1::ProcessSet& b) {
    return a.service < b.service;
  });
  std::vector<std::vector<std::string>> rows{
      {"SERVICE", "PROCESS", "STATE", "SINCE CYCLE", "DOES"}};
  for (const v1::ProcessSet& service : services)
    for (const v1::Process& process : service.processes)
      rows.push_back({service.service, instance_words(process.name), state_text(process),
                      std::to_string(process.since), process.effect});
  return rows.size() == 1 ? "" : table(rows);
}

}  // namespace saphira::cli
