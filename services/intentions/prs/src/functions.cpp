#include "saphira/intentions/functions.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/base/text.hpp"
#include "saphira/intentions/beliefs.hpp"

namespace saphira::intentions {
namespace {

/// Longer texts and lists are cut: a loop that keeps extending one ends by its timeout, not by the
/// machine's memory.
constexpr std::size_t kLongestText = 4096;
constexpr std::size_t kLongestList = 4096;

Value keep(double number, std::string_view function) {
  if (!std::isfinite(number))
    throw ActivityError("(" + std::string(function) + ") gives no number");
  return Value(number);
}

template <class Operation>
Function fold(std::string name, std::string summary, Operation operation) {
  const std::string own = name;
  return {std::move(name), 1, 64,
          [own, operation](const World&, Values arguments) {
            double sum = number_of(arguments, 0, own);
            for (std::size_t i = 1; i < arguments.size(); ++i)
              sum = operation(sum, number_of(arguments, i, own));
            return keep(sum, own);
          },
          std::move(summary)};
}

template <class Operation>
Function unary(std::string name, std::string summary, Operation operation) {
  const std::string own = name;
  return {std::move(name), 1, 1,
          [own, operation](const World&, Values arguments) {
            return keep(operation(number_of(arguments, 0, own)), own);
          },
          std::move(summary)};
}

/// True where the comparison holds between each value and the next.
template <class Comparison>
Function compare(std::string name, std::string summary, Comparison holds) {
  const std::string own = name;
  return {std::move(name), 2, 64,
          [own, holds](const World&, Values arguments) {
            for (std::size_t i = 0; i + 1 < arguments.size(); ++i) {
              if (!holds(number_of(arguments, i, own), number_of(arguments, i + 1, own)))
                return Value();
            }
            return Value::truth(true);
          },
          std::move(summary)};
}

const Value::List& list_of(Values arguments, std::size_t index, std::string_view function) {
  if (!arguments[index].nil() && !arguments[index].is_list())
    throw ActivityError("(" + std::string(function) + ") expected a list, got " +
                        kind_of(arguments[index]));
  return arguments[index].list();
}

Value list(Value::List elements) {
  Value result(std::move(elements));
  if (result.weight() > kLongestList)
    throw ActivityError("a list of more than " + std::to_string(kLongestList) + " values");
  return result;
}

/// Lisp's format, with ~a and ~% only.
std::string format(Values arguments, std::string_view function) {
  const std::string& pattern = text_of(arguments, 0, function);
  std::string out;
  std::size_t next = 1;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '~' || i + 1 == pattern.size()) {
      out += pattern[i];
      continue;
    }
    const char directive = pattern[++i];
    if (directive == 'a' || directive == 'A' || directive == 's' || directive == 'S')
      out += next < arguments.size() ? spoken(arguments[next++]) : std::string("?");
    else if (directive == '%')
      out += ' ';
    else
      out += directive;
  }
  if (out.size() > kLongestText)
    out.resize(kLongestText);
  return out;
}

Pose pose_in(Values arguments, std::size_t index, Frame frame, const World& world,
             std::string_view function) {
  const Point& point = point_of(arguments, index, function);
  const std::optional<Pose> pose = in_frame(point.pose, point.frame, frame, world.robot);
  if (!pose)
    throw ActivityError(
        "(" + std::string(function) + ") the robot does not know where it is on the map",
        v1::CODE_NO_POSITION);
  return *pose;
}

Frame frame_of(Values arguments, std::size_t index, std::string_view function) {
  const std::string name = normal(text_of(arguments, index, function));
  if (name == "robot")
    return Frame::robot;
  if (name == "odom")
    return Frame::odom;
  if (name == "map")
    return Frame::map;
  throw ActivityError("(" + std::string(function) + ") expected robot, odom or map, got " +
                      quoted(name));
}

/// Manual 7.5.1: from 0 below `low` to 1 above `high`.
double up(double x, double low, double high) {
  if (high <= low)
    return x >= high ? 1.0 : 0.0;
  return std::clamp((x - low) / (high - low), 0.0, 1.0);
}

void add_numbers(Functions& functions) {
  functions.add(fold("+", "the sum", [](double a, double b) { return a + b; }));
  functions.add(fold("*", "the product", [](double a, double b) { return a * b; }));
  functions.add(fold("/", "the quotient", [](double a, double b) { return a / b; }));
  functions.add(fold("min", "the smallest", [](double a, double b) { return std::min(a, b); }));
  functions.add(fold("max", "the largest", [](double a, double b) { return std::max(a, b); }));
  functions.add("-", 1, 64, "the difference; of one number: its negation",
                [](const World&, Values arguments) {
                  double left = number_of(arguments, 0, "-");
                  if (arguments.size() == 1)
                    return Value(-left);
                  for (std::size_t i = 1; i < arguments.size(); ++i)
                    left -= number_of(arguments, i, "-");
                  return keep(left, "-");
                });
  functions.add(unary("abs", "the magnitude", [](double x) { return std::abs(x); }));
  functions.add(unary("sqrt", "the square root", [](double x) { return std::sqrt(x); }));
  functions.add(unary("sin", "of radians", [](double x) { return std::sin(x); }));
  functions.add(unary("cos", "of radians", [](double x) { return std::cos(x); }));
  functions.add(unary("floor", "the whole number below", [](double x) { return std::floor(x); }));
  functions.add(unary("norm-angle", "the same angle in -pi..pi",
                      [](double x) { return std::isfinite(x) ? norm2_angle(x) : x; }));
  functions.add("mod", 2, 2, "the remainder of a division, of the sign of the divisor",
                [](const World&, Values arguments) {
                  const double b = number_of(arguments, 1, "mod");
                  const double a = number_of(arguments, 0, "mod");
                  return keep(a - b * std::floor(a / b), "mod");
                });
  functions.add(compare("<", "smaller", [](double a, double b) { return a < b; }));
  functions.add(compare(">", "larger", [](double a, double b) { return a > b; }));
  functions.add(compare("<=", "not larger", [](double a, double b) { return a <= b; }));
  functions.add(compare(">=", "not smaller", [](double a, double b) { return a >= b; }));
  functions.add(compare("=", "the same number", [](double a, double b) { return a == b; }));
  functions.add(compare("/=", "another number", [](double a, double b) { return a != b; }));

  // Manual 7.5.1 and 7.5.2, in both of its spellings.
  for (const char* const name : {"straight-up", "up-straight"})
    functions.add(
        name, 3, 3, "(straight-up x low high) fuzzy: from 0 at low to 1 at high",
        [name](const World&, Values a) {
          return Value(up(number_of(a, 0, name), number_of(a, 1, name), number_of(a, 2, name)));
        });
  for (const char* const name : {"down-straight", "straight-down"})
    functions.add(name, 3, 3, "(down-straight x low high) fuzzy: from 1 at low to 0 at high",
                  [name](const World&, Values a) {
                    return Value(1.0 - up(number_of(a, 0, name), number_of(a, 1, name),
                                          number_of(a, 2, name)));
                  });
  functions.add("f-greater", 3, 3, "(f-greater x c delta) fuzzy: one half at c",
                [](const World&, Values a) {
                  const double c = number_of(a, 1, "f-greater");
                  const double half = number_of(a, 2, "f-greater") / 2.0;
                  return Value(up(number_of(a, 0, "f-greater"), c - half, c + half));
                });
  functions.add("f-smaller", 3, 3, "(f-smaller x c delta) fuzzy: one half at c",
                [](const World&, Values a) {
                  const double c = number_of(a, 1, "f-smaller");
                  const double half = number_of(a, 2, "f-smaller") / 2.0;
                  return Value(1.0 - up(number_of(a, 0, "f-smaller"), c - half, c + half));
                });
  functions.add("f-eq", 3, 3, "(f-eq x c delta) fuzzy: 1 at c, 0 from delta off",
                [](const World&, Values a) {
                  const double off = std::abs(number_of(a, 0, "f-eq") - number_of(a, 1, "f-eq"));
                  return Value(1.0 - up(off, 0.0, number_of(a, 2, "f-eq")));
                });
  functions.add(
      fold("f-and", "fuzzy: the smallest", [](double a, double b) { return std::min(a, b); }));
  functions.add(
      fold("f-or", "fuzzy: the largest", [](double a, double b) { return std::max(a, b); }));
  functions.add(unary("f-not", "fuzzy: 1 - x", [](double x) { return 1.0 - x; }));
}

void add_lists(Functions& functions) {
  functions.add("not", 1, 1, "t of nil, nil of everything else",
                [](const World&, Values a) { return Value::truth(a[0].nil()); });
  functions.add("null", 1, 1, "whether it is nil, which is the empty list",
                [](const World&, Values a) { return Value::truth(a[0].nil()); });
  for (const char* const name : {"equal", "eq", "eql"})
    functions.add(name, 2, 2, "whether both are the same",
                  [](const World&, Values a) { return Value::truth(a[0] == a[1]); });
  functions.add("list", 0, 64, "a list of the arguments",
                [](const World&, Values a) { return list(Value::List(a.begin(), a.end())); });
  functions.add("cons", 2, 2, "the list with one more at its front", [](const World&, Values a) {
    Value::List all = {a[0]};
    const Value::List& rest = list_of(a, 1, "cons");
    all.insert(all.end(), rest.begin(), rest.end());
    return list(std::move(all));
  });
  functions.add("append", 0, 64, "the lists in one", [](const World&, Values a) {
    Value::List all;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Value::List& each = list_of(a, i, "append");
      all.insert(all.end(), each.begin(), each.end());
    }
    return list(std::move(all));
  });
  for (const char* const name : {"first", "car"})
    functions.add(name, 1, 1, "the first of a list; nil of nil", [name](const World&, Values a) {
      const Value::List& all = list_of(a, 0, name);
      return all.empty() ? Value() : all.front();
    });
  functions.add("last", 1, 1, "the last of a list; nil of nil", [](const World&, Values a) {
    const Value::List& all = list_of(a, 0, "last");
    return all.empty() ? Value() : all.back();
  });
  for (const char* const name : {"rest", "cdr"})
    functions.add(name, 1, 1, "the list without its first", [name](const World&, Values a) {
      const Value::List& all = list_of(a, 0, name);
      if (all.empty())
        return Value();
      return Value(Value::List(all.begin() + 1, all.end()));
    });
  functions.add("nth", 2, 2, "(nth 0 list) is the first; nil beyond the end",
                [](const World&, Values a) {
                  const double n = number_of(a, 0, "nth");
                  const Value::List& all = list_of(a, 1, "nth");
                  if (!(n >= 0.0) || n >= static_cast<double>(all.size()))
                    return Value();
                  return all[static_cast<std::size_t>(n)];
                });
  functions.add("length", 1, 1, "how many a list has", [](const World&, Values a) {
    return Value(static_cast<double>(list_of(a, 0, "length").size()));
  });
  functions.add("reverse", 1, 1, "the list from its end", [](const World&, Values a) {
    Value::List all = list_of(a, 0, "reverse");
    std::reverse(all.begin(), all.end());
    return Value(std::move(all));
  });
  functions.add(
      "as-list", 1, 1, "a list as it is, and nil; the list of anything else alone",
      [](const World&, Values a) { return a[0].nil() || a[0].is_list() ? a[0] : list({a[0]}); });
  functions.add("member", 2, 2,
                "the list from where it has the first argument; nil where it has not",
                [](const World&, Values a) {
                  const Value::List& all = list_of(a, 1, "member");
                  const auto found = std::find(all.begin(), all.end(), a[0]);
                  return Value(Value::List(found, all.end()));
                });
  functions.add("format", 1, 64,
                "(format \"to ~a\" x): the text with its arguments in the place of ~a",
                [](const World&, Values a) { return Value(format(a, "format")); });
}

void add_points(Functions& functions) {
  functions.add("point", 2, 4,
                "(point x y [heading] ['robot|'odom|'map]) in odom where no frame is given",
                [](const World&, Values a) {
                  Point point;
                  point.pose.x = number_of(a, 0, "point");
                  point.pose.y = number_of(a, 1, "point");
                  std::size_t next = 2;
                  if (next < a.size() && a[next].number() != nullptr)
                    point.pose.th = number_of(a, next++, "point");
                  if (next < a.size())
                    point.frame = frame_of(a, next, "point");
                  return Value(point);
                });
  functions.add("x", 1, 1, "of a point, in its frame",
                [](const World&, Values a) { return Value(point_of(a, 0, "x").pose.x); });
  functions.add("y", 1, 1, "of a point, in its frame",
                [](const World&, Values a) { return Value(point_of(a, 0, "y").pose.y); });
  functions.add("heading", 1, 1, "of a point, in its frame",
                [](const World&, Values a) { return Value(point_of(a, 0, "heading").pose.th); });
  functions.add("in-frame", 2, 2, "(in-frame point 'odom): the same point in another frame",
                [](const World& world, Values a) {
                  const Frame frame = frame_of(a, 1, "in-frame");
                  return Value(Point{pose_in(a, 0, frame, world, "in-frame"), frame});
                });
  functions.add("distance", 1, 2, "from the robot, or between two points [m]",
                [](const World& world, Values a) {
                  const Pose p = pose_in(a, 0, Frame::robot, world, "distance");
                  const Pose q =
                      a.size() < 2 ? Pose{} : pose_in(a, 1, Frame::robot, world, "distance");
                  return Value((p.position() - q.position()).norm());
                });
  functions.add("bearing", 1, 1,
                "where a point is from the robot's heading [rad, left is positive]",
                [](const World& world, Values a) {
                  const Pose p = pose_in(a, 0, Frame::robot, world, "bearing");
                  return Value(std::atan2(p.y, p.x));
                });
  functions.add("robot", 0, 1,
                "where the robot is, in odom or the frame that is named; nil: not known",
                [](const World& world, Values a) {
                  const Frame frame = a.empty() ? Frame::odom : frame_of(a, 0, "robot");
                  const auto pose = in_frame({}, Frame::robot, frame, world.robot);
                  return pose ? Value(Point{*pose, frame}) : Value();
                });
  functions.add("offset", 3, 4, "(offset point forward left [turn]): another, as seen from a point",
                [](const World&, Values a) {
                  Point point = point_of(a, 0, "offset");
                  const double th = a.size() < 4 ? 0.0 : number_of(a, 3, "offset");
                  point.pose = compose(point.pose,
                                       {number_of(a, 1, "offset"), number_of(a, 2, "offset"), th});
                  return Value(point);
                });
}

/// The speaker of what people said, as services/agent_interface names its claims: Bob said "no".
/// A checked identity stands before that, with a comma.
Value speaker_of(const std::string& said_by) {
  const std::size_t end = said_by.find(" said \"");
  if (end == std::string::npos)
    return {};
  const std::size_t comma = said_by.rfind(", ", end);
  const std::size_t begin = comma == std::string::npos ? 0 : comma + 2;
  const std::string speaker = lowered(said_by.substr(begin, end - begin));
  return speaker.empty() || speaker == "somebody" ? Value() : Value(speaker);
}

void add_beliefs(Functions& functions) {
  functions.add("belief", 1, 1, "(belief 'name): what is known under that name, such as a claim",
                [](const World& world, Values a) {
                  return world.beliefs.get(normal(text_of(a, 0, "belief")), world);
                });
  functions.add(
      "belief-since", 1, 1, "(belief-since 'name): when it was said, as (now) [s]; nil: it was not",
      [](const World& world, Values a) {
        const Belief* const belief = world.beliefs.stored(normal(text_of(a, 0, "belief-since")));
        return belief == nullptr ? Value() : Value(in_seconds(belief->since));
      });
  functions.add("belief-by", 1, 1,
                "(belief-by 'name): the person who said it, in small letters; nil: not known",
                [](const World& world, Values a) {
                  const Belief* const belief =
                      world.beliefs.stored(normal(text_of(a, 0, "belief-by")));
                  return belief == nullptr ? Value() : speaker_of(belief->said_by);
                });
  functions.add("yes", 1, 1, "(yes answer): whether it is t or yes", [](const World&, Values a) {
    const std::string* const text = a[0].text();
    return Value::truth(a[0].is_t() || (text != nullptr && normal(*text) == "yes"));
  });
  functions.add("now", 0, 0, "(now): the robot's time since the service began [s]",
                [](const World& world, Values) { return Value(in_seconds(world.now)); });
}

void add_conditions(Functions& functions) {
  const auto add = [&](const char* name, const char* summary, auto test) {
    functions.add(name, std::string("whether ") + summary,
                  [test](const World& world) { return Value::truth(test(world)); });
  };
  add("connected", "there is a robot", [](const World& w) { return w.robot.connected; });
  add("has-power", "its motors have power", [](const World& w) { return w.robot.has_power; });
  add("stalled", "a wheel is stalled",
      [](const World& w) { return w.robot.left_stalled || w.robot.right_stalled; });
  add("bumped", "a bumper is pressed", [](const World& w) { return w.robot.bumpers != 0; });
  add("at-rest", "it neither drives nor turns", [](const World& w) { return at_rest(w.robot); });
  add("registered", "it knows where it is on the map",
      [](const World& w) { return w.robot.odom_in_map.has_value(); });
  add("unsure-of-position", "what it hears does not confirm where it believes to be on the map",
      [](const World& w) { return w.unsure_of_position(); });
}

}  // namespace

void Functions::add(Function function) {
  std::string name = normal(function.name);
  functions_.insert_or_assign(std::move(name), std::move(function));
}

void Functions::add(Action action) {
  std::string name = normal(action.name);
  actions_.insert_or_assign(std::move(name), std::move(action));
}

void Functions::add(Condition condition) {
  std::string name = normal(condition.name);
  conditions_.insert_or_assign(std::move(name), std::move(condition));
}

namespace {

template <class Map>
auto look_up(const Map& map, std::string_view name) -> const typename Map::mapped_type* {
  const auto found = map.find(name);
  return found == map.end() ? nullptr : &found->second;
}

[[noreturn]] void unfit(Values arguments, std::size_t index, std::string_view function,
                        const char* expected) {
  throw ActivityError("(" + std::string(function) + ") expected " + expected + ", got " +
                      (index < arguments.size() ? kind_of(arguments[index]) : "nothing"));
}

}  // namespace

const Function* Functions::function(std::string_view name) const {
  return look_up(functions_, name);
}
const Action* Functions::action(std::string_view name) const {
  return look_up(actions_, name);
}
const Condition* Functions::condition(std::string_view name) const {
  return look_up(conditions_, name);
}

double number_of(Values arguments, std::size_t index, std::string_view function) {
  if (index >= arguments.size() || arguments[index].number() == nullptr)
    unfit(arguments, index, function, "a number");
  return *arguments[index].number();
}

const std::string& text_of(Values arguments, std::size_t index, std::string_view function) {
  if (index >= arguments.size() || arguments[index].text() == nullptr)
    unfit(arguments, index, function, "a text");
  return *arguments[index].text();
}

const Point& point_of(Values arguments, std::size_t index, std::string_view function) {
  if (index >= arguments.size() || arguments[index].point() == nullptr)
    unfit(arguments, index, function, "a point");
  return *arguments[index].point();
}

Functions core_functions() {
  Functions functions;
  add_numbers(functions);
  add_lists(functions);
  add_points(functions);
  add_beliefs(functions);
  add_conditions(functions);
  add_asking(functions);
  functions.add(Action{"say", 1, 64,
                       [](Effects& effects, Values arguments) {
                         effects.say(format(arguments, "say"));
                         return Value();
                       },
                       "(say \"to ~a\" x) says it to people"});
  functions.add(Action{"believe", 2, 2,
                       [](Effects& effects, Values arguments) {
                         effects.believe(text_of(arguments, 0, "believe"), arguments[1]);
                         return arguments[1];
                       },
                       "(believe name value): as setq of a variable whose name is computed"});
  functions.add(Action{"believe-while", 2, 2,
                       [](Effects& effects, Values arguments) {
                         effects.believe_while(text_of(arguments, 0, "believe-while"),
                                               arguments[1]);
                         return arguments[1];
                       },
                       "(believe-while name value): the same, until this intention ends"});
  return functions;
}

}  // namespace saphira::intentions
