#pragma once

#include <string>

#include "saphira/protocol/packet.hpp"

namespace saphira::bridge::test {

/// How a play went.
struct Played {
  std::string wrong;  ///< the property that did not hold, and when; empty: all held
  int sessions = 0;
  int cycles = 0;
  int motions = 0;  ///< commands that move the robot
  int stops = 0;    ///< emergency stops that were pressed
  int resets = 0;   ///< and released
  int steps = 0;    ///< of a simulator
  int silences = 0;
  int gaps = 0;
};

/// A core, a robot, drivers, and somebody who presses the emergency stop. The bytes say what
/// happens, one event after the other, and the settings. What the core sends is compared with rules
/// that are written here a second time, from the events alone:
///
/// - Packets are whole, and of the kinds that the bridge sends.
/// - No command moves the robot without a live command of a driver, of this session, from after the
///   last silence of the link and the last gap of the loop.
/// - Zero setpoints come first: in each session, after a silence and after a gap.
/// - While an emergency stop is latched nothing moves the robot, and it is told to stand.
/// - The link is closed with the robot told to stand.
/// - A simulator steps when the behaviors have answered and the permit covers it.
Played play(protocol::ByteView bytes);

}  // namespace saphira::bridge::test
