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

/// The machines that a program announces itself to: those that the options name, and others.
///
/// Each program tells the others from which machines it hears announcements. So two machines that
/// both know a third one find each other: whoever is told of a machine announces itself there, and
/// to be announced to by one side is enough.
class Machines {
 public:
  using Time = std::chrono::nanoseconds;  ///< since some moment
  using Addresses = std::set<std::string>;

  /// The addresses of this machine, which change.
  void be(Addresses own);
  /// A peer of the options has this address; empty: none is known yet.
  void name(const std::string& peer, const std::string& address);

  /// An announcement came from there.
  void hear(const std::string& address, Time now);
  /// That program hears these: separated by commas, as heard() says it. Damaged ones are left out.
  void tell(const std::string& program, const std::string& addresses);
  void forget(const std::string& program);
  /// Forgets the addresses that all programs told.
  void forget_told();

  /// From where announcements come, for other programs.
  std::string heard(Time now) const;
  /// Where to announce oneself.
  Addresses others(Time now) const;
  /// Named ones of which nothing was heard lately.
  std::vector<std::string> silent(Time now) const;
  /// Named ones that have no known address.
  std::vector<std::string> unknown() const;

  /// The silence after which a machine counts as gone.
  static constexpr std::chrono::seconds kGone{60};
  /// The limit of each list of machines: a longer list is made up.
  static constexpr std::size_t kMost = 16;

 private:
  bool is_heard(const std::string& address, Time now) const;

  mutable std::mutex mutex_;
  Addresses own_;
  std::map<std::string, std::string> named_;  ///< peer and address
  std::map<std::string, Time> heard_;
  std::map<std::string, Addresses> told_;  ///< by each program
};

}  // namespace saphira::bus::internal
