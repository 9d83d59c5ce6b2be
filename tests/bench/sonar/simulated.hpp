#pragma once

#include <cstdint>

#include "saphira/sim/sonar.hpp"
#include "statistics.hpp"

/// Simulated sonar readings at the places of the real ones.
namespace saphira::bench {

/// A model without mirrors: each firing reads the nearest of the rays of its cone.
sim::SonarModel plain_rays();

std::vector<Calibration> simulate(const std::vector<Calibration>& real,
                                  const sim::SonarModel& model, std::uint64_t seed);

/// The same poses in the corridor from the real readings.
std::vector<CorridorRecord> simulate(const std::vector<CorridorRecord>& real,
                                     const Corridor& corridor, const sim::SonarModel& model,
                                     std::uint64_t seed);

/// Rings beside a wall, each at the distance of the real one, at a random angle.
std::vector<std::array<double, kRing>> simulate(const std::vector<std::array<double, kRing>>& real,
                                                const sim::SonarModel& model, std::uint64_t seed);

}  // namespace saphira::bench
