#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira {

/// The frame of a point.
enum class Frame { robot, odom, map };

enum class ArgumentKind {
  number,
  text,
  point,
  truth,   ///< `number` is 1 or 0
  unbound  ///< a slot for the answer to fill
};

/// A point in its original frame.
struct PlacedPoint {
  Pose pose;
  Frame frame = Frame::odom;

  bool operator==(const PlacedPoint&) const = default;
};

/// A named, typed argument of a goal, a behavior or a request. Only the member that `kind` names
/// counts. Several arguments of one name are a list, in their order.
struct Argument {
  Argument() = default;
  Argument(std::string its_name, double value) : name(std::move(its_name)), number(value) {}
  Argument(std::string its_name, std::string value)
      : name(std::move(its_name)), kind(ArgumentKind::text), text(std::move(value)) {}
  Argument(std::string its_name, const PlacedPoint& value)
      : name(std::move(its_name)),
        kind(ArgumentKind::point),
        point(value.pose),
        frame(value.frame) {}
  Argument(std::string its_name, std::same_as<bool> auto value)
      : name(std::move(its_name)), kind(ArgumentKind::truth), number(value ? 1.0 : 0.0) {}

  std::string name;
  ArgumentKind kind = ArgumentKind::number;
  double number = 0.0;  ///< SI
  std::string text;
  Pose point;
  Frame frame = Frame::odom;  ///< of `point`

  bool operator==(const Argument&) const = default;

  SAPHIRA_ARCHIVE(name, kind, number, text, point, frame)
};
using Arguments = std::vector<Argument>;

Argument number(std::string name, double value);
Argument text(std::string name, std::string value);
Argument point(std::string name, const Pose& value, Frame frame = Frame::odom);
Argument truth(std::string name, bool value);

/// The first argument of that name; nullptr: none.
const Argument* find(const Arguments& arguments, std::string_view name);
/// Its value; without it 0, false, an empty text or the origin.
double number_of(const Arguments& arguments, std::string_view name);
bool truth_of(const Arguments& arguments, std::string_view name);
const std::string& text_of(const Arguments& arguments, std::string_view name);
Pose point_of(const Arguments& arguments, std::string_view name);
/// All numbers of that name.
std::vector<double> numbers_of(const Arguments& arguments, std::string_view name);

/// For people: "position=(1, 2, 0.5) speed=0.3".
std::string describe(const Arguments& arguments);

/// "a number"
const char* describe(ArgumentKind kind);

/// A user's text, in quotes, made fit for a message: cut to 40 characters, no control
/// characters.
std::string quoted(std::string_view text);

}  // namespace saphira
