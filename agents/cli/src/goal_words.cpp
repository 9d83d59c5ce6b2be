#include "saphira/cli/goal_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>

#include "saphira/base/cycle.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/base/units.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

namespace {

constexpr std::size_t kLongestName = 31;
constexpr std::size_t kLongestText = 255;
constexpr std::size_t kMostArguments = 16;

/// The number of the whole text, in SI units; an angle in degrees ends with deg.
std::optional<double> parse_number(std::string_view text) {
  const bool angle = text.ends_with("deg");
  if (angle)
    text.remove_suffix(3);
  if (text.starts_with('+'))
    text.remove_prefix(1);
  const auto value = number_in<double>(text);
  if (!value || !std::isfinite(*value))
    return std::nullopt;
  return angle ? radians(*value) : value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos)
      return parts;
    text.remove_prefix(end + 1);
  }
}

/// True where the text has the form of a point, and so has to be a valid one.
bool looks_like_point(std::string_view text) {
  const std::string_view first = text.substr(0, text.find(','));
  return first.size() != text.size() && parse_number(first).has_value();
}

void read_point(std::string_view text, const std::string& word, v1::Argument& argument) {
  const auto fail = [&word](const std::string& what) {
    throw std::invalid_argument("expected a point x,y or x,y,th or x,y@frame in \"" + word +
                                "\": " + what);
  };
  argument.kind = v1::ARGUMENT_POINT;
  argument.frame = v1::FRAME_ODOM;
  const std::size_t at = text.find('@');
  if (at != std::string_view::npos) {
    const std::string_view frame = text.substr(at + 1);
    if (frame == "robot")
      argument.frame = v1::FRAME_ROBOT;
    else if (frame == "map")
      argument.frame = v1::FRAME_MAP;
    else if (frame != "odom")
      fail("\"" + std::string(frame) + "\" is not a frame (odom, robot or map)");
  }
  const auto parts = split(text.substr(0, at), ',');
  if (parts.size() < 2 || parts.size() > 3)
    fail(std::to_string(parts.size()) + " numbers");
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto value = parse_number(parts[i]);
    if (!value)
      fail("\"" + std::string(parts[i]) + "\" is not a number");
    values[i] = value.value_or(0.0);
  }
  argument.point.x = values[0];
  argument.point.y = values[1];
  argument.point.th = values[2];
}

}  // namespace

v1::Argument parse_argument(const std::string& word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == word.size())
    throw std::invalid_argument("expected name=value, found \"" + word + "\"");
  const std::string name = word.substr(0, equals);
  const std::string value = word.substr(equals + 1);
  if (name.size() > kLongestName)
    throw std::invalid_argument("the name \"" + name + "\" is longer than 31 characters");
  if (value.size() > kLongestText)
    throw std::invalid_argument("the value of " + name + " is longer than 255 characters");
  v1::Argument argument{.name = name};
  if (const auto number = parse_number(value)) {
    argument.kind = v1::ARGUMENT_NUMBER;
    argument.number = *number;
  } else if (looks_like_point(value)) {
    read_point(value, word, argument);
  } else {
    argument.kind = v1::ARGUMENT_TEXT;
    argument.text = value;
  }
  return argument;
}

v1::Goal parse_goal(const std::string& functor, const std::vector<std::string>& words) {
  if (functor.empty() || functor.find('=') != std::string::npos)
    throw std::invalid_argument("expected an activity such as go_to, found \"" + functor + "\"");
  if (words.size() > kMostArguments)
    throw std::invalid_argument("a goal has at most 16 arguments");
  v1::Goal goal{.functor = functor};
  for (const std::string& word : words) {
    const v1::Argument argument = parse_argument(word);
    for (const v1::Argument& other : goal.arguments)
      if (other.name == argument.name)
        throw std::invalid_argument("\"" + argument.name + "\" is there twice");
    goal.arguments.push_back(argument);
  }
  return goal;
}

v1::Goal parse_request(const std::vector<std::string>& words) {
  if (words.empty())
    throw std::invalid_argument("expected a goal, such as go 3 1");
  std::vector<std::string> rest(words.begin() + 1, words.end());
  // The leading words without "=", of which a short form has a fixed number.
  std::size_t bare = 0;
  while (bare < rest.size() && rest[bare].find('=') == std::string::npos)
    ++bare;
  const auto expect = [&](std::size_t count, const std::string& form, const char* unit) {
    if (bare != count)
      throw std::invalid_argument("expected " + form + ", found " + counted(bare, "word") +
                                  " after " + words[0]);
    for (std::size_t i = 0; i < count; ++i)
      if (const auto value = measured(rest[i], unit))
        rest[i] = exact(*value);
      else
        throw std::invalid_argument("expected " + form + ", found \"" + rest[i] + "\"");
  };
  const auto with = [&](const std::string& first) {
    rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(bare));
    rest.insert(rest.begin(), first);
    return rest;
  };
  // "go to PLACE", as in speech.
  if (words[0] == "go" && bare >= 2 && rest[0] == "to") {
    rest.erase(rest.begin());
    --bare;
  }
  // Lengths may have their unit; one alone may be a name.
  if (words[0] == "go" && bare >= 2 && measured(rest[0], "m"))
    for (std::size_t i = 0; i < bare; ++i)
      if (const auto length = measured(rest[i], "m"); length && !parse_number(rest[i]))
        rest[i] = exact(*length);
  // The name of a place can have several words.
  if (words[0] == "go" && bare >= 1 && !parse_number(rest[0])) {
    const std::string place = joined(std::span(rest).first(bare), " ");
    return parse_goal("go-to-place", with("place=" + place));
  }
  if (words[0] == "go") {
    expect(2, "go X Y [m, in odom] or go PLACE", "m");
    return parse_goal("go_to", with("position=" + rest[0] + "," + rest[1]));
  }
  // The activity drive in its long form also requires a speed.
  if (words[0] == "drive" && std::ranges::none_of(rest, [](const std::string& word) {
        return word.starts_with("speed=");
      })) {
    expect(1, "drive SPEED [m/s]", "m/s");
    return parse_goal("drive", with("speed=" + rest[0]));
  }
  // To a heading; `saphira turn` turns by an angle.
  if (words[0] == "turn") {
    const std::string form = "turn to DEGREES (a heading in odom)";
    if (bare == 1 && measured(rest[0], "deg"))
      throw std::invalid_argument("expected " + form + ", found turn " + rest[0] +
                                  "; saphira turn " + rest[0] + " turns by an angle");
    if (bare > 0 && rest[0] == "to") {
      rest.erase(rest.begin());
      --bare;
    }
    expect(1, form, "deg");
    return parse_goal("turn_to", with("heading=" + rest[0] + "deg"));
  }
  if (rest.empty() && words[0].size() > 5 && guess(words[0], {"activities"}) == "activities")
    throw std::invalid_argument("expected an activity, found \"" + words[0] +
                                "\": did you mean activities?");
  return parse_goal(words[0], rest);
}

std::vector<v1::GoalStatus> by_acceptance(
    const std::map<std::pair<std::uint64_t, std::uint64_t>, v1::GoalStatus>& goals) {
  std::vector<v1::GoalStatus> all;
  for (const auto& [id, status] : goals)
    all.push_back(status);
  const auto accepted = [](const v1::GoalStatus& status) {
    return std::pair(status.stamp.epoch,
                     std::round(static_cast<double>(status.stamp.cycle) - status.elapsed / kCycle));
  };
  std::ranges::stable_sort(all, {}, accepted);
  return all;
}

std::string advice_after_failure(const v1::Goal& goal) {
  const auto& arguments = goal.arguments;
  const bool off_the_map =
      goal.functor == "go_to" && std::ranges::any_of(arguments, [](const v1::Argument& one) {
        return one.kind == v1::ARGUMENT_POINT && one.frame != v1::FRAME_MAP;
      });
  return off_the_map ? "go X Y heads straight for a point of odom, where the robot began at 0 0; "
                       "saphira goal go X,Y@map takes the ways of the map"
                     : "";
}

}  // namespace saphira::cli
