#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/security/door_keys.hpp"

namespace saphira::console {

/// The rules of access. A browser also carries requests of other sites' pages to this program, so
/// the origin of a request is checked before anything else.
struct AccessSettings {
  /// With all rights. This one or a person's is required for all but watching from this machine.
  std::string key;
  std::vector<std::string> names;  ///< host names of this machine, and of proxies before it
  int port = 0;                    ///< of this program
  bool always = false;             ///< the key is required for watching from this machine, too
};

/// The headers of a browser's connection.
struct Caller {
  std::string host;    ///< the header Host, such as localhost:8642; of a proxy, the one asked for
  std::string origin;  ///< the header Origin [empty: no browser, or a page's own request]
  bool loopback = false;  ///< from this machine, by no proxy that is to be seen in the headers
};

/// The reason for a refusal of a caller, in words; empty: allowed. A foreign host name means DNS
/// rebinding: another name leads here. An origin other than the host means a page of another site;
/// a proxy may have changed host or port, so the names of `settings` may be origins.
std::string refusal(const AccessSettings& settings, const Caller& caller);

/// The person behind a key, and their right.
struct Visitor {
  security::DoorRight right = security::DoorRight::none;
  std::optional<security::DoorKey> person{};  ///< none: the one key of `settings`, or no key

  bool may(security::DoorRight wanted) const { return right >= wanted; }
};
/// now: [s] since 1970.
Visitor visitor_of(const AccessSettings& settings, const security::DoorKeys& keys,
                   std::string_view key, std::int64_t now);

/// The visitor's name for the rest of the system. The name of a key is certain. Without that the
/// page itself says one: it is shown without brackets, which hold roles, and a visitor without any
/// key is told apart.
std::string name_of(const Visitor& visitor, const std::string& claimed);

/// Watching from this machine needs no key. A host or an origin that this program does not have on
/// this machine is that of a proxy or a tunnel: anybody may be behind it.
bool may_watch(const AccessSettings& settings, const Caller& caller);

}  // namespace saphira::console
