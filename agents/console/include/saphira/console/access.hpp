#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace saphira::console {

/// The rules of access. A browser carries the pages of strangers to this program as well, so the
/// origin of a request is checked before anything else.
struct AccessSettings {
  std::string key;                 ///< what everybody needs who does more than watch from here
  std::vector<std::string> names;  ///< host names that this machine is known by
};

/// The headers by which a browser opens a connection.
struct Caller {
  std::string host;       ///< the header Host, such as localhost:8642
  std::string origin;     ///< the header Origin [empty: no browser, or a page's own request]
  bool loopback = false;  ///< it is on this machine
};

/// Why a caller is refused, in words; empty where it may go on. A host name that is not ours means
/// that somebody lets a name of his own lead here (DNS rebinding); an origin that is not the host,
/// that a page of somebody else asks.
std::string refusal(const AccessSettings& settings, const Caller& caller);

/// True where the key is the right one. Takes as long for a wrong one.
bool right_key(const AccessSettings& settings, std::string_view key);

/// Watching from this machine needs no key.
bool may_watch(const AccessSettings& settings, const Caller& caller, std::string_view key);

}  // namespace saphira::console
