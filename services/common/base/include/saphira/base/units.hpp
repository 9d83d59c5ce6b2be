#pragma once

#include <optional>
#include <string>
#include <string_view>

// Units behind numbers, as people write them: 30cm, 0.3m/s, 90deg.
namespace saphira {

struct Unit {
  std::string_view name;
  std::string_view si;  ///< the SI unit of the same quantity, such as m/s; empty: a part of one (%)
  double factor;        ///< of a number in this unit, for the SI unit
};

/// nullptr: there is no such unit.
const Unit* find_unit(std::string_view name);

/// The names of all units, with blanks between them.
std::string unit_names();

/// The number that the whole text is, in `unit`. The text may have a unit of the same quantity
/// behind the number, also after a blank: of "90deg" in rad the half of pi, of "90" the 90. None
/// where the text is no finite number or has another unit.
std::optional<double> measured(std::string_view text, std::string_view unit);

}  // namespace saphira
