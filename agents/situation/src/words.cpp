#include "saphira/situation/words.hpp"

#include <algorithm>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"

namespace saphira::situation {

const char* name_of(v1::Frame frame) {
  return word_of(frame, {"robot", "odom", "map"});
}

const char* name_of(v1::ServiceState state) {
  return word_of(state, {"starting", "waiting", "running", "degraded", "stopping"});
}

const char* name_of(v1::LogLevel level) {
  return word_of(level, {"debug", "info", "warning", "error"});
}

const char* name_of(v1::Role role) {
  return word_of(role, {"nobody", "estop", "teleop", "direct", "behaviors"});
}

const char* name_of(v1::GuardAction action) {
  return word_of(action, {"passes", "limits", "slows", "stops"});
}

std::string latched(const v1::Grant& grant) {
  if (grant.estopped)
    return "EMERGENCY STOP, pressed by " +
           (grant.estop_source.empty() ? "a program without a name" : grant.estop_source) +
           ": the robot stands until saphira estop reset";
  if (grant.waits_for_hand_back)
    return "autonomy waits until the robot is handed back: saphira drive hand-back";
  return {};
}

std::string describe(const v1::Grant& grant) {
  std::string text;
  if (grant.estopped) {
    text = latched(grant);
  } else {
    text = name_of(grant.role);
    text += grant.role == v1::ROLE_NONE ? " drives" : " drives (" + grant.source + ")";
    if (!grant.reason.empty())
      text += ": " + grant.reason;
    if (grant.waits_for_hand_back && grant.reason.find("hand-back") == std::string::npos)
      text += "; " + latched(grant);
  }
  if (grant.guard != v1::GUARD_NONE)
    text += "; the guard " + std::string(name_of(grant.guard)) + ": " + grant.guard_reason;
  for (const v1::Refusal& refusal : grant.refused)
    text += "; refused " + refusal.source + " (" + name_of(refusal.role) + "): " + refusal.reason;
  return text;
}

std::string describe(const v1::Goal& goal) {
  std::string text = goal.functor + "(";
  const char* separator = "";
  for (const v1::Argument& argument : goal.arguments) {
    text += separator + argument.name + "=";
    separator = ", ";
    switch (argument.kind) {
      case v1::ARGUMENT_NUMBER:
        text += plain(argument.number);
        break;
      case v1::ARGUMENT_TEXT:
        text += "\"" + argument.text + "\"";
        break;
      case v1::ARGUMENT_POINT:
        text += "(" + plain(argument.point.x) + ", " + plain(argument.point.y) + ") in " +
                name_of(argument.frame);
        break;
      case v1::ARGUMENT_TRUTH:
        text += argument.number != 0.0 ? "yes" : "no";
        break;
      case v1::ARGUMENT_UNBOUND:
        text += "?";
        break;
    }
  }
  return text + ")";
}

v1::Utterance typed(std::uint64_t writer, std::uint64_t number, const std::string& speaker,
                    const std::string& text, double time) {
  return {.id = {writer, number},
          .speaker = speaker,
          .text = text,
          .means = v1::UTTERANCE_TYPED,
          .confidence = 1.0,
          .time = time};
}

bool is_behavior(const v1::IntentionNode& node, const v1::Intentions& intentions) {
  return node.label == "B" ||
         std::ranges::any_of(intentions.behaviors, [&](const v1::IntendedBehavior& behavior) {
           return behavior.intention == node.id && behavior.name == node.name &&
                  behavior.schema == node.schema;
         });
}

std::string seconds_text(double seconds) {
  return seconds < 9.95 ? format("%.1f s", seconds) : format("%.0f s", seconds);
}

std::string listed(const std::vector<std::string>& parts, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? last : ", ") + parts[i];
  return text;
}

void Sentence::add(int rank, std::string text, std::string brief) {
  if (!text.empty())
    parts_.push_back({rank, std::move(text), std::move(brief)});
}

std::string Sentence::text() const {
  std::vector<Part> parts = parts_;
  const auto joined = [&parts] {
    std::string text;
    for (const Part& part : parts)
      text += part.text;
    return text;
  };
  const auto fits = [&] { return joined().size() + 1 < kLongestSentence; };
  int most = 0;
  for (const Part& part : parts)
    most = std::max(most, part.rank);
  // Among equal ranks, the last part is less important.
  for (int rank = most; rank >= 0 && !fits(); --rank)
    for (std::size_t i = parts.size(); i-- > 0 && !fits();)
      if (parts[i].rank == rank && !parts[i].brief.empty())
        parts[i].text = parts[i].brief;
  for (int rank = most; rank > 0 && !fits(); --rank)
    for (std::size_t i = parts.size(); i-- > 0 && !fits();)
      if (parts[i].rank == rank)
        parts[i].text.clear();
  return cut(joined(), kLongestSentence - 2) + ".";
}

std::string cut(const std::string& text, std::size_t most) {
  constexpr std::size_t kDots = 3;
  if (text.size() <= most || most <= kDots)
    return text;
  std::size_t end = text.rfind(' ', most - kDots);
  if (end == std::string::npos || end < most / 2)
    end = most - kDots;
  // Not within a character of several bytes.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;
  return text.substr(0, end) + "...";
}

}  // namespace saphira::situation
