#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/heartbeat.hpp"

namespace saphira::cli {

/// Which children hang or are deaf, by what they say of themselves. Pure: time is given to it.
///
/// A node hangs when it has said something regularly and then nothing for 10 s. It is deaf when it
/// hears no robot for 15 s while another child of the same robot does, all the time. A program has
/// as many nodes as it likes; one that says nothing is not judged.
class Watchdog {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kSilent{10};
  static constexpr std::chrono::seconds kDeaf{15};

  /// robots: of each child.
  explicit Watchdog(std::vector<std::string> robots);

  /// The child was started, or has ended: nothing is known of it.
  void forget(std::size_t child);
  void hear(std::size_t child, const Heartbeat& beat, Time now);
  /// The supervisor stood still itself: what it did not hear meanwhile says nothing.
  void slept(Time now);
  /// What is wrong with a child, in words.
  std::optional<std::string> trouble(std::size_t child, Time now) const;

 private:
  static constexpr int kRegular = 5;  // beats

  struct Voice {
    int beats = 0;
    Time last;
    std::uint64_t cycle = 0;
    std::optional<Time> stepped;  // since when it hears the robot
    Time advanced;                // newest
    std::optional<Time> waits;    // since when it hears none
  };
  struct Child {
    std::string robot;
    std::map<std::uint64_t, Voice> voices;  // by instance
  };

  bool others_hear(std::size_t child, Time since, Time now) const;

  std::vector<Child> children_;
};

}  // namespace saphira::cli
