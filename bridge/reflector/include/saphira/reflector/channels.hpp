#pragma once

#include <array>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/reflector/motion.hpp"

namespace saphira::reflector {

/// A motion command with its argument in the packet's whole units: mm/s, degrees, deg/s.
struct Order {
  protocol::Number number = protocol::Number::kPulse;
  int argument = 0;
  bool operator==(const Order&) const = default;
};
protocol::Command to_command(const Order& order);

/// The state of the two channels in an information packet, in the server's frame.
struct Shown {
  double velocity = 0.0;           ///< [m/s]
  double rotation_velocity = 0.0;  ///< [rad/s]
  double control = 0.0;            ///< [rad] heading setpoint of the server's servo
};

/// Makes the robot server hold the setpoints although commands get lost on the way (manual 5.1.3
/// and 6.3). Sends them when they change, again in each cycle until the server's state shows them,
/// and at least every 0.5 s, which also satisfies the server's watchdog. At most one command for a
/// channel in a cycle; only a stop may be added.
class Channels {
 public:
  static constexpr double kRepeat = 0.5;  ///< [s]

  /// A connection is open: zero setpoints are due at once, whatever the server holds from before
  /// (manual 5.4.4: it would accelerate to the last speed).
  void connect();
  /// The setpoints to be held. `rotation`: server's frame to odom [rad].
  void want(const Setpoints& setpoints, double rotation);
  /// The server's emergency stop (ESTOP) instead of setpoints, while on: sent until the server
  /// shows rest, and every 0.5 s. A velocity would end it.
  void brake(bool on);
  /// An information packet came: a new cycle.
  void cycle(const Shown& shown);

  /// The commands to be sent now.
  std::vector<Order> due(double now);
  /// True where due() at `now` would return commands.
  bool pending(double now) const;
  /// The newest setpoint of the translation channel [m/s].
  double sent_velocity() const;

  SAPHIRA_ARCHIVE(channels_, brake_)

 private:
  struct Channel {
    Order want;
    std::optional<Order> sent;
    double at = 0.0;        ///< [s] when it was sent
    bool in_cycle = false;  ///< sent in this cycle
    bool shown = false;
  };
  static bool is_due(const Channel& channel, double now);

  std::array<Channel, 2> channels_;  ///< translation, rotation
  std::optional<Channel> brake_;     ///< while it is on
};

}  // namespace saphira::reflector
