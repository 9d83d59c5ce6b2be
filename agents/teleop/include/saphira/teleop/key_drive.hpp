#pragma once

#include <string>
#include <vector>

#include "saphira/teleop/pilot.hpp"

namespace saphira::teleop {

/// The actions of the keys of manual Table 2-1, and of further keys of a terminal.
enum class DriveKey {
  faster,     ///< i, up
  slower,     ///< m, down
  left,       ///< j, left
  right,      ///< l, right
  stop,       ///< k, space: all stop
  keep,       ///< . or return: continue
  constant,   ///< g: constant velocity on or off
  avoidance,  ///< c: obstacle avoidance
  hand_back,  ///< h: lets autonomy drive again
  quit,       ///< q, Ctrl-C, Ctrl-D
};

/// The keys in a terminal's input; unknown keys are left out. An incomplete escape sequence stays
/// in `input`.
std::vector<DriveKey> take_keys(std::string& input);

/// From keys to orders, with a dead-man by key repeat: the robot drives while keys keep coming.
/// Times are seconds of any steady clock.
///
/// A terminal reports presses and repeats, not releases, and the first repeat of a held key comes
/// late (0.25 to 0.7 s). So the first press holds for `first_hold`, and after the first repeat the
/// hold follows the gaps between repeats: short on a good line, longer on a line that delays or
/// bundles keys. A tap, or a held key that is let go, drives for first_hold at most.
class KeyDrive {
 public:
  struct Settings {
    double first_hold = 0.8;      ///< [s]
    double repeat_hold = 0.3;     ///< [s] at least
    double burst = 0.02;          ///< [s] nearer keys came at once
    double margin = 1.5;          ///< factor on the slowest recent gap
    double forget = 0.8;          ///< factor on that gap for each key
    double velocity_step = 0.05;  ///< [m/s] of one key
    double velocity_rate = 0.2;   ///< [m/s2] at most, of a held key
    double turn_step = 0.2;       ///< [rad] of one key; a held key stays this far ahead
    double max_velocity = 0.4;    ///< [m/s]
  };

  KeyDrive() : KeyDrive(Settings()) {}
  explicit KeyDrive(Settings settings) : settings_(settings) { order_.turn.emplace(); }

  void set_max_velocity(double limit) { settings_.max_velocity = limit; }
  /// One of the driving keys (faster to keep); others are ignored.
  void press(DriveKey key, double now);
  /// Releases the robot at once.
  void release();
  /// The order now, with a turn from the heading at its first command.
  Order order(double now);

 private:
  Settings settings_;
  Order order_;  ///< with a turn, always
  double last_key_ = -1e9;
  double slowest_ = 0.0;  ///< [s] slowest recent gap of keys; 0: no repeat yet
  double last_step_ = -1e9;
  double hold_until_ = -1e9;
};

}  // namespace saphira::teleop
