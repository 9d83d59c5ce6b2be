#pragma once

#include <string>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/protocol/command.hpp"

namespace saphira::reflector {

using Packets = std::vector<protocol::Bytes>;

/// Opens a session with a robot server (manual 5.4): SYNC0, 1, 2, each echoed, then OPEN. Each call
/// returns the packets to be sent. Times in seconds of any clock.
///
/// A server that is still in a session takes SYNC0 for a PULSE: a robot that its watchdog has
/// stopped would drive on. So zero setpoints always go before SYNC0.
///
/// A line with an echo (a modem, a terminal server, a loose plug) answers every SYNC. A robot
/// answers SYNC2 with its name, except servers before PSOS 4.1. So an answer without a name is
/// followed by zero setpoints, which no robot echoes, and only the next answer counts.
class Connection {
 public:
  enum class State { closed, sync0, sync1, sync2, open };

  static constexpr double kRetry = 0.2;     ///< [s] a lost packet is sent again
  static constexpr double kPatience = 5.0;  ///< [s] without an answer that advances the state

  /// The link is up. `in_session`: the server may be in a session from before, as behind a serial
  /// line, since it does not see the line's loss.
  Packets begin(double now, bool in_session = false);
  /// The link is gone.
  void end() { state_ = State::closed; }
  /// A packet's body has come.
  Packets packet(protocol::ByteView body, double now);
  /// Time has passed.
  Packets tick(double now);

  State state() const { return state_; }
  bool open() const { return state_ == State::open; }
  const protocol::RobotIdentity& identity() const { return identity_; }
  /// No answer has advanced the state for so long that a new connection may do better: the server
  /// hangs, or the other half of a network connection is gone.
  bool is_hopeless(double now) const;
  /// [s] From SYNC1 or SYNC2 to its answer, the shorter one: the delay of the line. Inexact where
  /// packets are lost.
  double round_trip() const { return round_trip_; }
  /// The time of the next tick (while neither closed nor open).
  double due() const { return sent_ + kRetry; }
  /// The awaited answer, in words.
  std::string waiting_for() const;

  SAPHIRA_ARCHIVE(state_, in_session_, identity_, sent_, answered_, began_, round_trip_, nameless_,
                  echoes_, tries_)

 private:
  Packets go(State state, double now);

  State state_ = State::closed;
  bool in_session_ = false;
  protocol::RobotIdentity identity_;
  double sent_ = 0.0;
  double answered_ = 0.0;  ///< the newest answer that advanced the state, or the beginning
  double began_ = 0.0;     ///< the state
  double round_trip_ = 0.0;
  bool nameless_ = false;  ///< SYNC2 was answered without a name
  bool echoes_ = false;    ///< the line echoes
  int tries_ = 0;
};

}  // namespace saphira::reflector
