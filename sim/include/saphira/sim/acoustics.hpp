#pragma once

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

// Losses of the sound of a 50 kHz transducer on its way to a thing and back [dB]. An echo is heard
// when what an unhindered wall on the axis has above the threshold exceeds their sum (sonar.hpp).

/// [m] of the sound.
inline constexpr double kWavelength = 6.95e-3;

/// One way, off the transducer's axis [rad]: a round piston whose nulls are filled.
double beam_loss(double off_axis);

/// Both ways, for distance [m]: none to 3 m, where the receiver's gain makes up for it.
double way_loss(double range);

/// Of an upright cylinder, or of an edge that is rounded so [m], against a flat wall.
double round_loss(double radius, double range);

/// Of a flat strip of that width [m].
double strip_loss(double width, double range);
/// The same for a strip that is not met at a right angle but `off_normal` [rad]; infinite from its
/// first null on.
double strip_lobe_loss(double width, double off_normal);

/// How much too far the range of an echo is that exceeds the threshold by `margin` [m]: the weaker
/// it is, the later it rises to the threshold.
double lateness(double margin);

}  // namespace saphira::sim
