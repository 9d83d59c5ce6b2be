#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/heartbeat.hpp"

namespace saphira::cli {

/// Detects hanging, deaf and mute children, by their heartbeats. Pure: the time is an argument.
///
/// A node hangs when it has sent heartbeats regularly and then none for 10 s. A program may have
/// any number of nodes; a silent program is not judged. Time in which it was ready to run and had
/// no processor does not count.
///
/// A node that waits for its robot is deaf, or the bridge of that robot is mute:
/// - deaf after 15 s, where another child hears the robot all the time;
/// - mute after 20 s, where no child of the robot hears it, though the bridge has its robot;
/// - mute also where a child has heard nothing in two lives and waits again;
/// - deaf after 45 s as well where none hears it: the bridge was started again meanwhile.
class Watchdog {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kSilent{10};
  static constexpr std::chrono::seconds kDeaf{15};
  static constexpr std::chrono::seconds kMute{20};
  static constexpr std::chrono::seconds kAllDeaf{45};

  /// robots: of each child.
  explicit Watchdog(std::vector<std::string> robots);

  /// The child was started, or has ended: its state is unknown.
  void forget(std::size_t child);
  void hear(std::size_t child, const Heartbeat& beat, Time now);
  /// The supervisor itself stood still: missing heartbeats of that time do not count.
  void slept(Time now);
  /// The child waited for the processor, for that time since the last call: it could not send then.
  void starved(std::size_t child, std::chrono::nanoseconds waited, Time now);
  /// The error of a child, in words.
  std::optional<std::string> trouble(std::size_t child, Time now) const;

 private:
  static constexpr int kRegular = 5;  // beats

  struct Voice {
    int beats = 0;
    Time last;
    std::uint64_t cycle = 0;
    bool heard = false;           // the robot was heard at some time
    std::optional<Time> stepped;  // time since which it hears the robot
    Time advanced;                // newest
    std::optional<Time> waits;    // time since which it does not hear the robot
    bool bridge = false;          // it writes the robot's state, so it steps without hearing it

    bool steps_since(Time since, Time now) const;
    bool waits_for(std::chrono::seconds time, Time now) const;
  };
  struct Child {
    std::string robot;
    std::map<std::uint64_t, Voice> voices;  // by instance
    int deaf_lives = 0;                     // in a row: lives without hearing the robot

    bool was_deaf() const;
  };

  /// True where some node of the robot satisfies `Is`; `but` is a child that does not count.
  template <class Is>
  bool any(const std::string& robot, std::optional<std::size_t> but, Is is) const;
  bool deaf(std::size_t child, const Voice& voice, Time now) const;
  bool mute(const std::string& robot, const Voice& bridge, Time now) const;

  std::vector<Child> children_;
};

}  // namespace saphira::cli
