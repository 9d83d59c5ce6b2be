#pragma once

#include <cstdint>

#include "saphira/sim/sonar.hpp"
#include "statistics.hpp"

/// What simulated sonars read where the real ones were.
namespace saphira::bench {

/// A model that knows no mirrors: each firing reads the nearest of the rays of its cone.
sim::SonarModel plain_rays();

std::vector<Calibration> simulate(const std::vector<Calibration>& real,
                                  const sim::SonarModel& model, std::uint64_t seed);

/// The same poses in the corridor that was found in the real readings.
std::vector<CorridorRecord> simulate(const std::vector<CorridorRecord>& real,
                                     const Corridor& corridor, const sim::SonarModel& model,
                                     std::uint64_t seed);

/// A ring beside a wall that is as near as to each of the real ones, the sonars turned anyhow.
std::vector<std::array<double, kRing>> simulate(const std::vector<std::array<double, kRing>>& real,
                                                const sim::SonarModel& model, std::uint64_t seed);

}  // namespace saphira::bench
