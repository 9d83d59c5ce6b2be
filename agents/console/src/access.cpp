#include "saphira/console/access.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace saphira::console {

namespace {

struct Authority {
  std::string name;  ///< as names are compared: in small letters, without the dot at the end
  int port = 0;      ///< 0: none is named
};

std::string comparable(std::string_view name) {
  if (name.ends_with('.'))
    name.remove_suffix(1);
  std::string text(name);
  for (char& c : text)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// Of "name", "name:port" or "[address]:port"; without a name for anything else.
Authority authority_of(std::string_view host) {
  const std::size_t bracket = host.starts_with('[') ? host.find(']') : 0;
  const std::size_t colon = host.find(':', bracket);
  Authority authority{comparable(host.substr(0, colon)), 0};
  if (colon == std::string_view::npos)
    return authority;
  const char* const end = host.data() + host.size();
  const auto read = std::from_chars(host.data() + colon + 1, end, authority.port);
  return read.ptr == end && read.ec == std::errc() ? authority : Authority{};
}

/// Of "scheme://name:port", with the port of the scheme where none is named.
Authority origin_of(std::string_view origin) {
  const bool encrypted = origin.starts_with("https://");
  if (!encrypted && !origin.starts_with("http://"))
    return {};
  Authority authority = authority_of(origin.substr(encrypted ? 8 : 7));
  if (authority.port == 0)
    authority.port = encrypted ? 443 : 80;
  return authority;
}

/// A numeric address leads to itself only.
bool is_address(std::string_view name) {
  if (name.starts_with('['))
    return name.size() > 2 && name.find_first_not_of("[]0123456789abcdef:.") == name.npos;
  return !name.empty() && name.find_first_not_of("0123456789.") == name.npos;
}

bool is_known(const AccessSettings& settings, const std::string& name) {
  return std::ranges::any_of(settings.names,
                             [&](const std::string& each) { return comparable(each) == name; });
}

/// A browser names the port of each host but for the one of the scheme. A host without it has come
/// by a proxy, which names its host alone.
bool is_same(const Authority& origin, const Authority& host) {
  return !origin.name.empty() && origin.name == host.name &&
         (host.port == 0 || host.port == origin.port);
}

/// For a person, without anything that a page could be made of.
std::string shown(std::string_view text) {
  std::string shown(text.substr(0, 100));
  std::replace_if(
      shown.begin(), shown.end(),
      [](char c) { return c < ' ' || c > '~' || c == '<' || c == '>' || c == '&'; }, '?');
  return shown;
}

}  // namespace

std::string refusal(const AccessSettings& settings, const Caller& caller) {
  const Authority host = authority_of(caller.host);
  if (host.name.empty())
    return "no host is named";
  if (host.name != "localhost" && !is_address(host.name) && !is_known(settings, host.name))
    return "this program is not " + shown(host.name) +
           ": use localhost or the address in digits, or start it with --host-name " +
           shown(host.name);
  if (caller.origin.empty())
    return {};
  const Authority origin = origin_of(caller.origin);
  if (is_same(origin, host) || is_known(settings, origin.name))
    return {};
  return "a page of " + shown(caller.origin) + " may not connect" +
         (origin.name.empty()
              ? ""
              : "; if that is a proxy's own name for this program, start it with --host-name " +
                    shown(origin.name));
}

namespace {

/// A wrong key takes as long.
bool right_key(const AccessSettings& settings, std::string_view key) {
  if (settings.key.empty() || key.size() != settings.key.size())
    return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < key.size(); ++i)
    difference |= static_cast<unsigned char>(key[i]) ^ static_cast<unsigned char>(settings.key[i]);
  return difference == 0;
}

}  // namespace

Visitor visitor_of(const AccessSettings& settings, const security::DoorKeys& keys,
                   std::string_view key, std::int64_t now) {
  if (right_key(settings, key))
    return {security::DoorRight::operate};
  const security::DoorKey* const person = keys.find(key, now);
  return person == nullptr ? Visitor{} : Visitor{person->right, *person};
}

std::string name_of(const Visitor& visitor, const std::string& claimed) {
  if (visitor.person)
    return visitor.person->name;
  std::string name = claimed;
  std::erase_if(name,
                [](char c) { return std::string_view("()[],;").find(c) != std::string::npos; });
  if (visitor.may(security::DoorRight::watch))
    return name;
  return "a visitor without a key" + (name.empty() ? "" : " (" + name + ")");
}

bool may_watch(const AccessSettings& settings, const Caller& caller) {
  const Authority host = authority_of(caller.host);
  const bool is_here = host.name == "localhost" || host.name == "[::1]" ||
                       (is_address(host.name) && host.name.starts_with("127."));
  const bool is_own_port = host.port == settings.port ||
                           (host.port == 0 && (settings.port == 80 || settings.port == 443));
  return caller.loopback && !settings.always && is_here && is_own_port &&
         (caller.origin.empty() || is_same(origin_of(caller.origin), host));
}

}  // namespace saphira::console
