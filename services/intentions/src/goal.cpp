#include "saphira/intentions/goal.hpp"

#include <cstdio>

namespace saphira::intentions {

Argument number(std::string name, double value) {
  Argument argument;
  argument.name = std::move(name);
  argument.kind = ArgumentKind::kNumber;
  argument.number = value;
  return argument;
}

Argument text(std::string name, std::string value) {
  Argument argument;
  argument.name = std::move(name);
  argument.kind = ArgumentKind::kText;
  argument.text = std::move(value);
  return argument;
}

Argument point(std::string name, const Pose& value, Frame frame) {
  Argument argument;
  argument.name = std::move(name);
  argument.kind = ArgumentKind::kPoint;
  argument.point = value;
  argument.frame = frame;
  return argument;
}

const Argument* find(const Arguments& arguments, std::string_view name) {
  for (const Argument& argument : arguments) {
    if (argument.name == name)
      return &argument;
  }
  return nullptr;
}

const char* name_of(GoalState state) {
  switch (state) {
    case GoalState::kWaiting:
      return "waiting";
    case GoalState::kRefused:
      return "refused";
    case GoalState::kUnderway:
      return "underway";
    case GoalState::kSuspended:
      return "suspended";
    case GoalState::kSucceeded:
      return "succeeded";
    case GoalState::kFailed:
      return "failed";
    case GoalState::kCanceled:
      return "canceled";
  }
  return "?";
}

const char* name_of(GoalCode code) {
  switch (code) {
    case GoalCode::kNone:
      return "none";
    case GoalCode::kUnknownFunctor:
      return "unknown_functor";
    case GoalCode::kBadArgument:
      return "bad_argument";
    case GoalCode::kChanged:
      return "changed";
    case GoalCode::kTooMany:
      return "too_many";
    case GoalCode::kDeadline:
      return "deadline";
    case GoalCode::kBlocked:
      return "blocked";
    case GoalCode::kNoRobot:
      return "no_robot";
    case GoalCode::kNoPosition:
      return "no_position";
    case GoalCode::kNoRoute:
      return "no_route";
    case GoalCode::kActivity:
      return "activity";
    case GoalCode::kTimeout:
      return "timeout";
    case GoalCode::kDisposed:
      return "disposed";
    case GoalCode::kWriterLost:
      return "writer_lost";
    case GoalCode::kPreempted:
      return "preempted";
  }
  return "?";
}

std::string describe(const GoalId& id) {
  char text[48];
  std::snprintf(text, sizeof text, "%llx:%llu", static_cast<unsigned long long>(id.writer),
                static_cast<unsigned long long>(id.number));
  return text;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace saphira::intentions
