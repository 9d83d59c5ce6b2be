#include "saphira/base/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace saphira {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array<Unit, 17> kUnits{{{"m", "m", 1.0},
                                       {"mm", "m", 1e-3},
                                       {"cm", "m", 1e-2},
                                       {"km", "m", 1e3},
                                       {"s", "s", 1.0},
                                       {"ms", "s", 1e-3},
                                       {"min", "s", 60.0},
                                       {"h", "s", 3600.0},
                                       {"deg", "rad", kDegree},
                                       {"rad", "rad", 1.0},
                                       {"m/s", "m/s", 1.0},
                                       {"mm/s", "m/s", 1e-3},
                                       {"cm/s", "m/s", 1e-2},
                                       {"km/h", "m/s", 1.0 / 3.6},
                                       {"deg/s", "rad/s", kDegree},
                                       {"rad/s", "rad/s", 1.0},
                                       {"%", "", 1e-2}}};

}  // namespace

const Unit* find_unit(std::string_view name) {
  const auto found = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const Unit& unit) { return unit.name == name; });
  return found == kUnits.end() ? nullptr : &*found;
}

std::string unit_names() {
  std::string names;
  for (const Unit& unit : kUnits)
    names.append(names.empty() ? "" : " ").append(unit.name);
  return names;
}

std::optional<double> measured(std::string_view text, std::string_view unit) {
  if (text.starts_with('+') && !text.starts_with("+-"))
    text.remove_prefix(1);
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || !std::isfinite(value))
    return std::nullopt;
  std::string_view written = text.substr(static_cast<std::size_t>(read.ptr - text.data()));
  if (written.size() > 1 && written.starts_with(' '))
    written.remove_prefix(1);
  if (written.empty() || written == unit)
    return value;
  const Unit* const from = find_unit(written);
  const Unit* const to = find_unit(unit);
  if (from == nullptr || to == nullptr || from->si != to->si)
    return std::nullopt;
  return value * from->factor / to->factor;
}

}  // namespace saphira
