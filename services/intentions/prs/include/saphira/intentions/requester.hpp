#pragma once

#include <cstdint>
#include <string>

#include "saphira/base/archived.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/intentions/world.hpp"

namespace saphira::intentions {

/// The program that asked for a goal, and the effect of its silence on the goal:
/// - heard: it has written the goal, which goes on;
/// - cut off: its writer is gone. The goal waits, and ends after 10 s; a kept one goes on;
/// - recalled: the service was restarted. It waits for 10 min; a kept one goes on after 3 s;
/// - switched on: the bridge was restarted as well. Likewise; a kept one ends after 3 s;
/// - left: nobody asks for a kept goal any more. It goes on.
/// A goal that waits goes on when its program is heard.
class Requester {
 public:
  /// A cut network is back by then.
  static constexpr Ticks kCutOff = 100;
  /// After a restart of the service the programs that are there, and their withdrawals, have been
  /// heard by then. The first step may be of ten.
  static constexpr Ticks kMeeting = 30;
  /// Programs that were restarted as well have been heard by then.
  static constexpr Ticks kRecalled = 6000;

  void hear() { state_ = State::kHeard; }
  void cut_off(Ticks now);
  /// The service was restarted, and has the goal from before.
  void recall(Ticks now);
  /// The bridge was started again: a robot does not set out by itself once it is switched on.
  void meet_bridge();

  /// The goal is not told of: its program is probably heard in a moment.
  bool is_meeting(Ticks now) const;
  /// The reason why the goal waits; empty: it does not.
  std::string why_to_wait(v1::WriterLost policy) const;

  enum class Turn : std::uint8_t { kNone, kKept, kEnds };
  /// The turn of the goal at that time: kKept once, where it goes on without its program.
  Turn pass(v1::WriterLost policy, Ticks now);
  /// The reason for kEnds.
  std::string why_ended(v1::WriterLost policy) const;

  bool operator==(const Requester&) const = default;

  SAPHIRA_ARCHIVE(state_, since_)

 private:
  enum class State : std::uint8_t { kHeard, kCutOff, kRecalled, kSwitchedOn, kLeft };

  Ticks patience(v1::WriterLost policy) const;

  State state_ = State::kHeard;
  Ticks since_ = 0;
};

}  // namespace saphira::intentions
