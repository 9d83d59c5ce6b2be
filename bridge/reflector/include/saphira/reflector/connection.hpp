#pragma once

#include <string>
#include <vector>

#include "saphira/protocol/command.hpp"

namespace saphira::reflector {

using Packets = std::vector<protocol::Bytes>;

/// Brings a session with a robot server about (manual 5.4): SYNC0, 1, 2, each echoed, then OPEN.
/// Each call returns the packets to be sent. Times in seconds of any clock.
///
/// SYNC0 is PULSE to a server that is still in a session: a robot that its watchdog has stopped
/// would drive on. So zero setpoints go before it, wherever that may be.
///
/// A line that sends back what it is sent (a modem, a terminal server, a loose plug) answers every
/// SYNC. A robot answers SYNC2 with its name, except servers before PSOS 4.1: behind an answer
/// without one go zero setpoints, which no robot sends back, and only the next answer counts.
class Connection {
 public:
  enum class State { closed, sync0, sync1, sync2, open };

  static constexpr double kRetry = 0.2;     ///< [s] a lost packet is sent again
  static constexpr double kPatience = 5.0;  ///< [s] without an answer that leads on

  /// The link is up. `in_session`: the server may be in a session from before, as behind a serial
  /// line, whose loss it does not see.
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
  /// Nothing that leads on has come for so long that another connection may do better: a server
  /// that hangs, a half of a network connection whose other half is gone.
  bool is_hopeless(double now) const;
  /// [s] From SYNC1 or SYNC2 to its answer, the shorter one: how slow the line is. Not exact where
  /// packets are lost.
  double round_trip() const { return round_trip_; }
  /// When to call tick next (while neither closed nor open).
  double due() const { return sent_ + kRetry; }
  /// The thing that it waits for, in words.
  std::string waiting_for() const;

 private:
  Packets go(State state, double now);

  State state_ = State::closed;
  bool in_session_ = false;
  protocol::RobotIdentity identity_;
  double sent_ = 0.0;
  double answered_ = 0.0;  ///< what led on, or the beginning
  double began_ = 0.0;     ///< the state
  double round_trip_ = 0.0;
  bool nameless_ = false;  ///< SYNC2 was answered without a name
  bool echoes_ = false;    ///< the line sends back what it is sent
  int tries_ = 0;
};

}  // namespace saphira::reflector
