#pragma once

// When a program's side on the network is made, and made anew. Pure bookkeeping: no sockets, no
// clock.

#include <chrono>
#include <set>
#include <string>

namespace saphira::bus::internal {

/// Fast DDS reads the addresses of the machine when a participant is made, and never again. So the
/// participant on the network is made anew when the machine has an address that it was not made
/// with. One that goes needs nothing, and one that comes back works as before.
class Addresses {
 public:
  using Set = std::set<std::string>;
  using Time = std::chrono::nanoseconds;  ///< since some moment

  /// only: the one address to use; empty: all.
  explicit Addresses(std::string only) : only_(std::move(only)) {}

  /// The IPv4 addresses of interfaces that are up, without loopback. True: it is to be made, now.
  bool due(const Set& seen, Time now);
  /// It was made with the addresses that were seen last.
  void made() { made_with_ = usable_; }
  /// It could not be made: tried again in a while.
  void failed(Time now) { not_before_ = now + kPause; }

  /// Those of the addresses seen last that may be used.
  const Set& usable() const { return usable_; }
  /// In words, the address that is waited for; empty where there is one.
  std::string wait() const;

  /// An address is used when the addresses have been the same for so long.
  static constexpr std::chrono::milliseconds kSettled{300};
  static constexpr std::chrono::seconds kPause{5};

 private:
  const std::string only_;
  Set seen_;
  Set usable_;
  Set made_with_;
  bool looked_ = false;
  Time changed_{0};
  Time not_before_{0};
};

}  // namespace saphira::bus::internal
