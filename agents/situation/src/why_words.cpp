#include "why_words.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace saphira::situation {

std::string speed_text(double speed) {
  // No "-0.00".
  return format("%.2f m/s", std::abs(speed) < kNoSpeed ? 0.0 : speed);
}

std::string angle_text(double angle) {
  const double size = degrees(std::abs(angle));
  const double shown = std::round(size);
  return size < 0.95 ? format("%.1f degrees", size)
                     : format("%.0f degree%s", shown, shown == 1.0 ? "" : "s");
}

std::string turn_text(double turn, bool rate) {
  if (std::abs(turn) < kNoTurn)
    return "straight on";
  return (rate ? "at " + angle_text(turn) + "/s" : angle_text(turn)) + " to the " +
         (turn > 0.0 ? "left" : "right");
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

double clamp01(double x) {
  return std::clamp(x, 0.0, 1.0);
}

Channel channel_of(const v1::RuleState& rule) {
  return rule.action == v1::CONTROL_TURN_LEFT || rule.action == v1::CONTROL_TURN_RIGHT
             ? Channel::turn
             : Channel::speed;
}

double weight_of(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? behavior.turn_weight : behavior.speed_weight;
}

double activity_of(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? behavior.turn_activity : behavior.speed_activity;
}

bool recommends(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? behavior.recommends_turn : behavior.recommends_speed;
}

std::string wish_of(const v1::BehaviorState& behavior, Channel channel) {
  return channel == Channel::turn ? turn_text(behavior.turn) : speed_text(behavior.speed);
}

std::string control_text(const v1::RuleState& rule) {
  if (channel_of(rule) == Channel::turn && degrees(std::abs(rule.value)) < 0.05)
    return "straight on";
  switch (rule.action) {
    case v1::CONTROL_TURN_LEFT:
      return angle_text(rule.value) + " to the left";
    case v1::CONTROL_TURN_RIGHT:
      return angle_text(rule.value) + " to the right";
    case v1::CONTROL_ACCELERATE:
      return "faster by " + speed_text(rule.value);
    case v1::CONTROL_DECELERATE:
      return "slower by " + speed_text(rule.value);
    case v1::CONTROL_SPEED:
      break;
  }
  return speed_text(rule.value);
}

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

bool nameless(const std::string& name, const std::string& schema) {
  return name.empty() || plain(without_number(name)) == plain(schema);
}

std::string intention_name(const v1::IntentionNode& node) {
  // The root of a goal's tree has the goal's id as its name.
  return node.parent == 0 || nameless(node.name, node.schema)
             ? node.schema
             : node.schema + " (" + without_number(node.name) + ")";
}

bool concerns(const v1::Belief& belief, const std::string& schema, const std::string& arguments) {
  if (belief.name == "hazards")
    return schema == "go-to-place";
  const auto is_argument = [&](std::string word) {
    std::erase(word, '"');
    const std::string text = " " + arguments + ",";
    for (std::size_t at = text.find(word); word.size() > 1 && at != std::string::npos;
         at = text.find(word, at + 1))
      if (text[at - 1] == '=' && text[at + word.size()] == ',')
        return true;
    return false;
  };
  // Two persons may share an office: the person decides, not the place.
  return is_argument(belief.name.substr(belief.name.rfind('-') + 1)) ||
         (!belief.name.starts_with("place-of-") && is_argument(belief.value));
}

std::string with_arguments(const v1::IntentionNode& node) {
  return intention_name(node) + (node.arguments.empty() ? "" : " [" + node.arguments + "]");
}

}  // namespace saphira::situation
