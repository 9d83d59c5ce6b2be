#pragma once

#include <cstdint>
#include <string>

#include "saphira/protocol/packet.hpp"

namespace saphira::bridge::test {

/// The result of a play.
struct Played {
  std::string wrong;  ///< the violated property, and the time; empty: none
  int sessions = 0;
  int cycles = 0;
  int motions = 0;  ///< commands that move the robot
  int stops = 0;    ///< emergency stops that were pressed
  int resets = 0;   ///< releases of them
  int stopped = 0;  ///< stops that are not latched
  int steps = 0;    ///< of a simulator
  int silences = 0;
  int gaps = 0;
  std::uint64_t sent = 0;  ///< a hash of all bytes to the robot

  bool operator==(const Played&) const = default;
};

/// A core, a robot, drivers, and a person who presses the emergency stop. The bytes give the
/// settings and the events, one after the other. The core's outputs are compared with rules that
/// are written here a second time, from the events alone:
///
/// - Packets are whole, and of the kinds that the bridge sends.
/// - No command moves the robot without a live command of a driver, of this session, later than the
///   last silence of the link and the last gap of the loop.
/// - After a stop no command moves the robot but one of a driver that was silent before it, or has
/// let
///   go since, or heeds the stop.
/// - Zero setpoints come first: in each session, after a silence and after a gap.
/// - While an emergency stop is latched no command moves the robot, and it is told to stand.
/// - When the link is closed, the robot was told to stand.
/// - A simulator steps when the behaviors have answered and the permit covers it.
///
/// `restores_every` so many events a new core goes on, into which the state was saved and restored;
/// 0: never.
Played play(protocol::ByteView bytes, unsigned restores_every = 0);

}  // namespace saphira::bridge::test
