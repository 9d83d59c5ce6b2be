#include "saphira/console/access.hpp"

#include <algorithm>

namespace saphira::console {

namespace {

/// The name in "name:port" or "[address]:port".
std::string_view name_of(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view{} : host.substr(0, end + 1);
  }
  return host.substr(0, host.find(':'));
}

/// A numeric address leads to itself only.
bool is_address(std::string_view name) {
  if (name.starts_with('['))
    return name.size() > 2 && name.find_first_not_of("[]0123456789abcdefABCDEF:.") == name.npos;
  return !name.empty() && name.find_first_not_of("0123456789.") == name.npos;
}

}  // namespace

std::string refusal(const AccessSettings& settings, const Caller& caller) {
  const std::string_view name = name_of(caller.host);
  if (name.empty())
    return "no host is named";
  if (name != "localhost" && !is_address(name) &&
      std::find(settings.names.begin(), settings.names.end(), name) == settings.names.end())
    return "this program is not " + std::string(name.substr(0, 100)) +
           ": use localhost, the address in digits, or start it with --host-name";
  if (!caller.origin.empty() && caller.origin != "http://" + caller.host &&
      caller.origin != "https://" + caller.host)
    return "a page of " + caller.origin.substr(0, 100) + " may not connect";
  return {};
}

bool right_key(const AccessSettings& settings, std::string_view key) {
  if (settings.key.empty() || key.size() != settings.key.size())
    return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < key.size(); ++i)
    difference |= static_cast<unsigned char>(key[i]) ^ static_cast<unsigned char>(settings.key[i]);
  return difference == 0;
}

bool may_watch(const AccessSettings& settings, const Caller& caller, std::string_view key) {
  return caller.loopback || right_key(settings, key);
}

}  // namespace saphira::console
