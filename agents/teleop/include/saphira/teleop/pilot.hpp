#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "saphira/idl/types.hpp"

namespace saphira::teleop {

constexpr int kReleases = 4;  ///< repetitions of a release

/// A turn by an angle. A new number of `move` begins a new turn, from the heading at that time.
struct Turn {
  double by = 0.0;  ///< [rad] counter-clockwise
  std::uint64_t move = 0;
};

/// The motion that a person wants now.
struct Order {
  bool active = false;       ///< the dead-man is held
  double velocity = 0.0;     ///< [m/s]
  double rotation = 0.0;     ///< [rad/s] counter-clockwise
  std::optional<Turn> turn;  ///< instead of the rotation
  std::uint64_t cycle = 0;   ///< of the robot state that the person sees
  std::string source;        ///< the person's name, for people [empty: nobody has control]
};

/// From a person's orders to the commands for the bridge: `drive/teleop` and `drive/estop`. Both
/// topics are best effort, so releases are repeated. Times are seconds of any clock that does not
/// jump.
class Pilot {
 public:
  explicit Pilot(std::string source) : source_(std::move(source)) {}

  /// The command to send now, with `stamp` of the newest robot state; call it ten times a second or
  /// more. There is none before the person drives. Afterwards commands go on without driving: so
  /// the bridge knows that this program lives, and understands a release that got lost.
  std::optional<v1::MotorCommand> drive(const Order& order, const v1::Stamp& stamp);
  /// Releases the robot and lets autonomy drive again.
  void hand_back();

  /// Presses the emergency stop for this person.
  void press(const std::string& person);
  /// The command of the emergency stop to send now: pressed until the bridge has latched it, then
  /// let go, so that it can be reset.
  std::optional<v1::MotorCommand> stop(bool latched);

  /// Takes a grant at that time.
  void heard(const v1::Grant& grant, double now);
  /// The reason why the bridge refuses this person's driving, or did in the last `within` seconds;
  /// empty: it does not.
  std::string refusal(double now, double within = 0.4) const;

 private:
  std::string source_;
  std::uint64_t number_ = 0;
  bool drove_ = false;
  int hand_backs_left_ = 0;
  std::string presser_;
  bool pressing_ = false;
  int releases_left_ = 0;
  std::string refusal_;
  double refused_at_ = -1e300;
};

}  // namespace saphira::teleop
