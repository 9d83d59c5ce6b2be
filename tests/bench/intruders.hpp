#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/security/authority.hpp"

namespace saphira::bench {

/// The trial without an intruder, in which nobody is to be named.
inline constexpr const char* kNobody = "nobody";

/// Somebody who has no right to what they try, against a robot's bridge on a secured bus.
struct Intrusion {
  std::string who;
  /// The topics that they wrote or read without the right to it.
  std::vector<std::string> got;
  std::string named;                  ///< what the bridge said of them; empty: nothing
  std::vector<std::string> named_by;  ///< of its log, its audit and its status
  std::size_t cycles = 0;             ///< of the bridge meanwhile
  std::size_t late = 0;               ///< of these, more than 50 ms
  bool aborted = false;               ///< the bridge has ended
  bool left_out = false;              ///< this user has no right to hear packets
};

/// Tries all kinds, some seconds each. `folder`: for files. `self`: this program, which is the
/// bridge with --watched CREDENTIALS.
std::vector<Intrusion> intrude(security::Authority& site, const std::string& folder,
                               const std::string& self, std::uint32_t domain, std::int64_t now);

/// The bridge of these trials, until SIGTERM; then it prints what it has heard.
int watched(const std::string& credentials, std::uint32_t domain);

}  // namespace saphira::bench
