#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saphira/intentions/goal.hpp"

namespace saphira {
class Archive;
}

namespace saphira::intentions {

/// A directed point and the frame that it is given in.
struct Point {
  Pose pose;
  Frame frame = Frame::odom;

  bool operator==(const Point&) const = default;
};

/// A reference to an object of the map or of perception. The kind gives the meaning of the numbers;
/// a reference to the map is valid for one revision of it.
struct Reference {
  enum class Kind {
    kRegion,    ///< maps::Topology::regions(), by index
    kLink,      ///< maps::Topology::links(), by index
    kArtifact,  ///< by the artifact's id on the map
    kPercept,   ///< lps::Percept::id
    kThing      ///< lps::SeenThing::id
  };
  Kind kind = Kind::kArtifact;
  std::uint64_t id = 0;
  std::uint64_t revision = 0;  ///< of the map; 0 of perception

  bool operator==(const Reference&) const = default;
};

/// A value of the activity language. nil is also the empty list and false; all others, including
/// the number 0, are true. A name ('follow-it) is a text ("follow-it").
class Value {
 public:
  using List = std::vector<Value>;

  Value() = default;  ///< nil
  Value(double number) : is_(number) {}
  Value(std::string text) : is_(std::move(text)) {}
  Value(const char* text) : is_(std::string(text)) {}
  Value(const Point& point) : is_(point) {}
  Value(const Reference& reference) : is_(reference) {}
  Value(List list);
  /// t or nil.
  static Value truth(bool yes);

  bool nil() const { return std::holds_alternative<std::monostate>(is_); }
  bool truthy() const { return !nil(); }
  /// The value if it has that type; otherwise nullptr.
  const double* number() const { return std::get_if<double>(&is_); }
  const std::string* text() const { return std::get_if<std::string>(&is_); }
  const Point* point() const { return std::get_if<Point>(&is_); }
  const Reference* reference() const { return std::get_if<Reference>(&is_); }
  /// The elements; empty for any other type.
  const List& list() const;
  bool is_list() const { return std::holds_alternative<std::shared_ptr<const Elements>>(is_); }
  /// The number of values in it, with those of nested lists: the cost of a traversal.
  std::size_t weight() const;
  bool is_t() const { return std::holds_alternative<bool>(is_); }

  bool operator==(const Value& other) const;
  void archive(Archive& a);

 private:
  struct Elements;
  std::variant<std::monostate, bool, double, std::string, Point, Reference,
               std::shared_ptr<const Elements>>
      is_;
};

/// In the form of the activity language: nil, t, 2.5, follow-it, "text", (a b), (point 1 2 0.5
/// :map), (region 3 12).
std::string to_text(const Value& value);
/// For people, as for ~a: a text without its quotes.
std::string spoken(const Value& value);
/// "a number", "nil": for messages.
std::string kind_of(const Value& value);
/// Reads the form of to_text. FileError, with `source` as the file's name, for any other text.
Value parse_value(std::string_view text, const std::string& source = "value");

/// Named values: the arguments of an activity.
using Bindings = std::vector<std::pair<std::string, Value>>;

Value value_of(const Argument& argument);
/// False where the value has none of an argument's kinds.
bool to_argument(const std::string& name, const Value& value, Argument& argument);

/// Names are the same in either case and with - or _ ("go_to", "Go-To"): returns the common form.
std::string normal(std::string_view name);

}  // namespace saphira::intentions
