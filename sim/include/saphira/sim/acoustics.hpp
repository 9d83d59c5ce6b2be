#pragma once

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

// Losses of the sound of a 50 kHz transducer on its way to an object and back [dB]. An echo is
// heard when their sum is below the margin of an unhindered wall on the axis (sonar.hpp).

/// [m] of the sound.
inline constexpr double kWavelength = 6.95e-3;

/// One way, off the transducer's axis [rad]: a round piston whose nulls are filled.
double beam_loss(double off_axis);

/// Both ways, for distance [m]: none to 3 m, where the receiver's gain compensates for it.
double way_loss(double range);

/// Of an upright cylinder, or of an edge with this radius [m], relative to a flat wall.
double round_loss(double radius, double range);

/// Of a flat strip of that width [m].
double strip_loss(double width, double range);
/// The same for a strip at an angle `off_normal` [rad] from its normal; infinite from its first
/// null on.
double strip_lobe_loss(double width, double off_normal);

/// The range error of an echo that exceeds the threshold by `margin` [m]: the weaker the echo, the
/// later it rises to the threshold.
double lateness(double margin);

}  // namespace saphira::sim
