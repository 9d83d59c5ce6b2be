#pragma once

// The other machines, where multicast does not find them. Pure bookkeeping: no DDS, no clock.

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace saphira::bus::internal {

/// The machines that a program announces itself to: those that the options name, and others.
///
/// Each program tells the others from which machines it hears announcements. So two machines that
/// both know a third one find each other: a program that learns of a machine announces itself
/// there. An announcement in one direction is enough.
class Machines {
 public:
  using Time = std::chrono::nanoseconds;  ///< since some moment
  using Addresses = std::set<std::string>;

  /// The addresses of this machine, which change.
  void be(Addresses own);
  /// A peer of the options has this address; empty: none is known yet.
  void name(const std::string& peer, const std::string& address);

  /// An announcement came from this address.
  void hear(const std::string& address, Time now);
  /// The machines that a program hears, separated by commas, as from heard(). Damaged addresses are
  /// left out.
  void tell(const std::string& program, const std::string& addresses);
  void forget(const std::string& program);
  /// Forgets the addresses that all programs told.
  void forget_told();

  /// The sources of announcements, for other programs.
  std::string heard(Time now) const;
  /// The machines to announce this program to.
  Addresses others(Time now) const;
  /// Named peers that were silent lately.
  std::vector<std::string> silent(Time now) const;
  /// Named peers without a known address.
  std::vector<std::string> unknown() const;

  /// The silence after which a machine counts as gone.
  static constexpr std::chrono::seconds kGone{60};
  /// The limit of each list of machines: a longer list is forged.
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
