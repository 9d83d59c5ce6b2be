#include "saphira/sim/acoustics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace saphira::sim {

namespace {

struct Knot {
  double angle;  // [degrees]
  double loss;   // [dB]
};

// A piston of 38 mm; a real one's beam has no nulls between its lobes.
constexpr std::array<Knot, 17> kBeam{{{0.0, 0.0},
                                      {2.5, 0.6},
                                      {5.0, 2.6},
                                      {7.5, 6.3},
                                      {9.0, 9.8},
                                      {10.0, 12.9},
                                      {11.0, 15.5},
                                      {12.0, 17.5},
                                      {17.0, 17.5},
                                      {20.0, 19.5},
                                      {25.0, 22.0},
                                      {30.0, 22.5},
                                      {35.0, 25.0},
                                      {42.0, 25.0},
                                      {50.0, 32.0},
                                      {70.0, 45.0},
                                      {90.0, 60.0}}};

constexpr double kGainEnds = 3.0;      // [m] the last step of the receiver's gain
constexpr double kAbsorption = 3.3;    // [dB/m] of air, both ways
constexpr double kRise = 0.017;        // [m] of the envelope of an echo
constexpr double kLatest = 0.056;      // [m] the length of the burst
constexpr double kLeastMargin = 0.01;  // [dB]

}  // namespace

double beam_loss(double off_axis) {
  const double angle = degrees(std::abs(off_axis));
  const auto after = std::find_if(kBeam.begin() + 1, kBeam.end() - 1,
                                  [&](const Knot& knot) { return angle <= knot.angle; });
  const Knot& to = *after;
  const Knot& from = *(after - 1);
  return from.loss + (angle - from.angle) / (to.angle - from.angle) * (to.loss - from.loss);
}

double way_loss(double range) {
  return range <= kGainEnds
             ? 0.0
             : 20.0 * std::log10(range / kGainEnds) + kAbsorption * (range - kGainEnds);
}

double round_loss(double radius, double range) {
  return 10.0 * std::log10((radius + range) / radius);
}

double strip_loss(double width, double range) {
  return 20.0 * std::log10(std::max(1.0, std::sqrt(kWavelength * range) / width));
}

double strip_lobe_loss(double width, double off_normal) {
  const double x = 2.0 * width * std::sin(std::abs(off_normal)) / kWavelength;
  if (x >= 1.0)
    return std::numeric_limits<double>::infinity();
  return x < 1e-6 ? 0.0 : -20.0 * std::log10(std::sin(kPi * x) / (kPi * x));
}

double lateness(double margin) {
  const double amplitude = std::pow(10.0, -std::max(margin, kLeastMargin) / 20.0);
  return std::min(kLatest, -kRise * std::log(1.0 - amplitude));
}

}  // namespace saphira::sim
