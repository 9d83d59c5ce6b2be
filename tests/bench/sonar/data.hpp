#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

/// Readings of real sonars, from public data sets. All in metres and radians.
namespace saphira::bench {

/// One reading of an ultrasonic sensor in front of a plate, with the true range. No echo: a range
/// beyond the sensor's.
struct Calibration {
  double truth = 0.0;
  double reading = 0.0;
};

/// The file of calibration readings; `column` is that of the sensor. FileError where it is wrong.
std::vector<Calibration> parse_calibration(std::string_view csv, const std::string& column,
                                           const std::string& file);

/// The robot with eight sonars that drove along a corridor.
inline constexpr std::array<double, 8> kCorridorBearings{
    radians(-90.0), radians(-37.5), radians(-22.5), radians(-7.5),
    radians(7.5),   radians(22.5),  radians(37.5),  radians(90.0)};
inline constexpr double kCorridorNoEcho = 5.105;  ///< [m] larger ranges are no echo

struct CorridorRecord {
  Pose pose_in_odom;
  std::array<double, 8> ranges{};
};

/// Both files line by line: `t s1..s8` in mm, `t x y theta` in mm and tenths of a degree.
std::vector<CorridorRecord> parse_corridor(std::string_view measurements, std::string_view poses,
                                           const std::string& folder);

/// Rings of 24 sonars, 15 degrees apart, 5 m at most.
inline constexpr std::size_t kRing = 24;
inline constexpr double kRingNoEcho = 4.9995;  ///< [m] larger ranges are no echo

std::vector<std::array<double, kRing>> parse_ring(std::string_view csv, const std::string& file);

}  // namespace saphira::bench
