#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/requests/functor.hpp"

namespace saphira::behaviors {

using Kind = ArgumentKind;

/// A parameter of a schema: a number, a text of which the first choice is the default, or a point.
using ParameterSpec = Parameter;

/// The parameters of one behavior: every number and text that its schema has, checked; points in
/// odom.
class Parameters {
 public:
  /// Checks `arguments` against `specs` and fills in defaults. A point in the robot's frame is
  /// fixed in odom at the robot's present pose. On an error: nothing, and `trouble` gives the
  /// expected form.
  static std::optional<Parameters> check(const std::vector<ParameterSpec>& specs,
                                         const std::vector<Argument>& arguments,
                                         const Pose& robot_in_odom, std::string& trouble);

  double number(std::string_view name) const;
  /// Nothing where the schema has no such number.
  std::optional<double> number_if_any(std::string_view name) const;
  const std::string& text(std::string_view name) const;
  /// In odom; nothing where it was not given.
  std::optional<Pose> point(std::string_view name) const;

  // By the index in the schema's list.
  double number(std::size_t index) const { return std::get<double>(items_[index].value); }
  std::optional<Pose> point(std::size_t index) const;
  /// The index of a text among its choices.
  std::size_t choice(std::size_t index) const { return items_[index].choice; }

  SAPHIRA_ARCHIVE(items_)

 private:
  /// One for each parameter of the schema; nothing for an absent point.
  struct Item {
    std::string name;
    std::variant<std::monostate, double, std::string, Pose> value;
    std::size_t choice = 0;  ///< of a text
  };
  const Item& find(std::string_view name) const;
  std::vector<Item> items_;
};

/// An optional number, for the tables of schemas.
inline ParameterSpec number_parameter(std::string name, std::string meaning, double low,
                                      double high, double usual) {
  return optional(saphira::number_parameter(std::move(name), std::move(meaning), low, high), usual);
}

}  // namespace saphira::behaviors
