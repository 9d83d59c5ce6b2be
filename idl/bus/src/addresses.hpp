#pragma once

// The times at which a program's network side is made, and made anew. Pure bookkeeping: no sockets,
// no clock.

#include <chrono>
#include <map>
#include <string>

namespace saphira::bus::internal {

/// Fast DDS reads the machine's addresses when a participant is made, and never again. So the
/// network participant is made anew when the machine has an address that was not there before, or
/// has it on another device, such as an adapter that was plugged in again: membership in multicast
/// groups ends with a device. The loss of an address needs no action, and one that returns on its
/// device works as before.
class Addresses {
 public:
  using Devices = std::map<std::string, unsigned>;  ///< the index of each address's device
  using Time = std::chrono::nanoseconds;            ///< since some moment

  /// only: the one address to use; empty: all.
  explicit Addresses(std::string only) : only_(std::move(only)) {}

  /// The IPv4 addresses of interfaces that are up, without loopback. True: make the network side
  /// now.
  bool due(const Devices& seen, Time now);
  /// The network side was made with the addresses that were seen last.
  void made() { made_with_ = usable_; }
  /// The network side could not be made; the next attempt is after kPause.
  void failed(Time now) { not_before_ = now + kPause; }

  /// Those of the addresses seen last that may be used.
  const Devices& usable() const { return usable_; }
  /// The awaited address, in words; empty where there is one.
  std::string wait() const;

  /// An address is used when the addresses have not changed for this long.
  static constexpr std::chrono::milliseconds kSettled{300};
  static constexpr std::chrono::seconds kPause{5};

 private:
  const std::string only_;
  Devices seen_;
  Devices usable_;
  Devices made_with_;
  bool looked_ = false;
  Time changed_{0};
  Time not_before_{0};
};

}  // namespace saphira::bus::internal
