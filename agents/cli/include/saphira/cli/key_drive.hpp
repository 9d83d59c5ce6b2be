#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::cli {

/// The actions of the keys of manual Table 2-1, and of those that a terminal needs besides.
enum class DriveKey {
  faster,     ///< i, up
  slower,     ///< m, down
  left,       ///< j, left
  right,      ///< l, right
  stop,       ///< k, space: all stop
  keep,       ///< . or return: go on as it is
  constant,   ///< g: constant velocity on or off
  avoidance,  ///< c: obstacle avoidance
  hand_back,  ///< h: lets autonomy drive again
  quit,       ///< q, Ctrl-C, Ctrl-D
};

/// The keys in what a terminal sent; what is no key of ours is left out. An escape sequence that is
/// not whole yet stays in `input`.
std::vector<DriveKey> take_keys(std::string& input);

/// From keys to setpoints, with a dead-man by key repeat: the robot is driven for as long as keys
/// keep coming. Times are seconds of any steady clock.
///
/// A terminal tells presses and repeats, not releases, and the first repeat of a held key comes
/// late (0.25 to 0.7 s). So the first press holds for `first_hold`, and once repeats are seen the
/// hold follows the gaps between them: short on a good line, longer on one that brings keys late or
/// several at once. A tap, and a held key that is let go, drives for first_hold at most.
class KeyDrive {
 public:
  struct Settings {
    double first_hold = 0.8;      ///< [s]
    double repeat_hold = 0.3;     ///< [s] at least
    double burst = 0.02;          ///< [s] keys so near to each other came at once
    double margin = 1.5;          ///< of the slowest gap that was seen lately
    double forget = 0.8;          ///< of that gap, a key
    double stop_hold = 2.0;       ///< [s] of an all stop; without keys it is then a release
    double velocity_step = 0.05;  ///< [m/s] of one key
    double velocity_rate = 0.2;   ///< [m/s2] at most, of a key that is held
    double turn_step = 0.2;       ///< [rad] of one key; a held key is always so far ahead
    double max_velocity = 0.4;    ///< [m/s]
  };

  /// The command to send now.
  struct Setpoint {
    bool active = false;
    double velocity = 0.0;   ///< [m/s]
    double heading = 0.0;    ///< [rad] from the heading at the first sample with `move`
    std::uint64_t move = 0;  ///< a new number for a new heading
  };

  KeyDrive() = default;
  explicit KeyDrive(Settings settings) : settings_(settings) {}

  void set_max_velocity(double limit) { settings_.max_velocity = limit; }
  /// One of the driving keys (faster to keep); others are ignored.
  void press(DriveKey key, double now);
  /// Gives the robot back at once.
  void release();
  Setpoint setpoint(double now);

 private:
  Settings settings_;
  Setpoint setpoint_;
  double last_key_ = -1e9;
  double slowest_ = 0.0;  ///< [s] between two keys lately; 0: no repeat was seen
  double last_step_ = -1e9;
  double hold_until_ = -1e9;
};

}  // namespace saphira::cli
