#pragma once

#include <string>
#include <utility>

#include "saphira/intentions/schema.hpp"

/// Common parts of the activities that drive.
namespace saphira::intentions {

/// Priorities of the behaviors that the functors intend: 0 is the highest (manual 7.3).
inline constexpr int kAvoid = 0;
inline constexpr int kKeepOff = 1;
inline constexpr int kTask = 2;
inline constexpr int kRest = 3;  ///< only without any other behavior

/// A goal's point, for people.
std::string format_point(const Argument& point);

/// An optional number.
inline Parameter quantity(std::string name, std::string unit, double low, double high,
                          double usual) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.unit = std::move(unit);
  parameter.low = low;
  parameter.high = high;
  parameter.usual = usual;
  return parameter;
}

}  // namespace saphira::intentions
