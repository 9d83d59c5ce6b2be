#pragma once

// Which other machines there are, where no multicast tells. Pure bookkeeping: no DDS, no clock.

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace saphira::bus::internal {

/// The machines that a program announces itself to although nobody named them.
///
/// Each program tells the others from which machines it hears announcements. So two machines that
/// both know a third one find each other: whoever is told of a machine announces itself there, and
/// to be announced to by one side is enough.
class Machines {
 public:
  using Time = std::chrono::nanoseconds;  ///< since some moment
  using Addresses = std::set<std::string>;

  /// own: the addresses of this machine; named: those of the peers that the options name.
  Machines(Addresses own, Addresses named) : own_(std::move(own)), named_(std::move(named)) {}

  /// An announcement came from there.
  void hear(const std::string& address, Time now);
  /// That program hears these: separated by commas, as heard() says it. Damaged ones are left out.
  void tell(const std::string& program, const std::string& addresses);
  void forget(const std::string& program);
  /// What all programs told.
  void forget_told();

  /// From where announcements come, for other programs.
  std::string heard(Time now) const;
  /// Where to announce oneself besides the named ones.
  Addresses others(Time now) const;
  /// Named ones of which nothing was heard lately.
  std::vector<std::string> silent(Time now) const;

  /// What is not heard for so long is not there any more.
  static constexpr std::chrono::seconds kGone{60};
  /// Whoever tells of more machines makes them up.
  static constexpr std::size_t kMost = 16;

 private:
  bool is_new(const std::string& address) const;
  bool is_heard(const std::string& address, Time now) const;

  const Addresses own_;
  const Addresses named_;
  mutable std::mutex mutex_;
  std::map<std::string, Time> heard_;
  std::map<std::string, Addresses> told_;  ///< by each program
};

}  // namespace saphira::bus::internal
