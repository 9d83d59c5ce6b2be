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
  /// When to call tick next (while neither closed nor open).
  double due() const { return sent_ + kRetry; }
  /// What it waits for, in words.
  std::string waiting_for() const;

 private:
  Packets go(State state, double now);

  State state_ = State::closed;
  bool in_session_ = false;
  protocol::RobotIdentity identity_;
  double sent_ = 0.0;
  double answered_ = 0.0;  ///< what led on, or the beginning
  int tries_ = 0;
};

}  // namespace saphira::reflector
