#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "introduction.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

/// The value of a key in a participant's user data; empty: it has none.
std::string field(std::string_view data, std::string_view key);

/// Keeps the programs of different robots apart in one domain. Each program takes the announcements
/// of its own robot's programs alone, so that the programs of other robots cost it next to nothing:
/// Fast DDS exchanges all endpoints with every participant that it hears of, and never less.
class Fleet {
 public:
  using Time = BootClock::time_point;

  explicit Fleet(const NodeOptions& options);

  /// For the user data of this program.
  std::string fields() const;
  /// True for a program of this robot, one that does not tell its robot, and where either of both
  /// meets the others.
  bool meets(const Announced& other) const;

  /// The multicast ports for announcements on one machine, behind the first port of the domain.
  /// Each robot has one of `kPorts`, so that its programs are not woken by every other robot. A
  /// program of several robots, or that does not ignore the others, has all of them.
  std::vector<std::uint16_t> ports() const;

  /// An announcement of a program that this one does not meet has come.
  void note(const Announced& other, Time now);
  /// Those noted lately; for all copies of this fleet. From any thread. Sorted.
  std::vector<OtherProgram> others(Time now) const;

  /// An announcement of a program that this one meets has come.
  void hear(std::string_view prefix, Time now);
  /// True where this program's own announcement is to be sent. While nobody is new, one in
  /// `kSeldom` is enough: a newcomer announces itself, and is answered with the next one.
  bool is_due(std::string_view data, Time now);

  static constexpr std::chrono::seconds kSeldom{2};
  /// The standard leaves these free: 0 and 1 are multicast, and those of programs begin at 10.
  static constexpr std::uint16_t kFirstPort = 2;
  static constexpr std::uint16_t kPorts = 8;
  /// A noted program that is silent for this long is forgotten.
  static constexpr std::chrono::seconds kForgotten{10};
  /// After its start and after each newcomer a program sends every announcement for this long.
  static constexpr std::chrono::seconds kOften{3};
  /// Fast DDS sends an announcement several times at once, to different places.
  static constexpr std::chrono::milliseconds kOnce{50};

 private:
  struct Noted {
    std::mutex mutex;
    std::map<OtherProgram, Time> programs;
  };

  std::string robot_;
  Others others_;
  std::shared_ptr<Noted> noted_ = std::make_shared<Noted>();
  std::set<std::string, std::less<>> known_;  ///< prefixes
  bool begun_ = false;
  Time often_until_;
  Time sent_;
  std::string sent_data_;
};

}  // namespace saphira::bus::internal
