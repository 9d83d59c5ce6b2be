#include "saphira/relay/rendezvous.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

namespace saphira::relay {

namespace {

constexpr std::size_t kShortestToken = 16;

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-' || c == '.';
  });
}

/// 1 to 65535; 0: invalid.
int port_of(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port > 0 && port < 65536 ? port
                                                                                              : 0;
}

}  // namespace

std::vector<Robot> parse_robots(const std::string& file, std::string_view text) {
  std::vector<Robot> robots;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string> found;
    for (std::string word; words >> word;)
      found.push_back(word);
    if (found.empty())
      continue;
    const auto wrong = [&](const std::string& why) {
      return std::invalid_argument(file + ":" + std::to_string(number) + ": " + why);
    };
    if (found.size() != 3)
      throw wrong("expected NAME PORT TOKEN");
    Robot robot{found[0], port_of(found[1]), found[2]};
    if (!is_name(robot.name))
      throw wrong("a name has letters, digits, and _ - .");
    if (robot.port == 0)
      throw wrong("expected a port, 1 to 65535, found " + found[1]);
    if (robot.token.size() < kShortestToken)
      throw wrong("a token has at least 16 characters, such as `openssl rand -hex 24` makes");
    for (const Robot& other : robots)
      if (other.name == robot.name || other.port == robot.port)
        throw wrong("robot " + other.name + " has this name or port already");
    robots.push_back(std::move(robot));
  }
  if (robots.empty())
    throw std::invalid_argument(file + ": expected a line for each robot, NAME PORT TOKEN");
  return robots;
}

Address parse_address(std::string_view text) {
  const auto wrong = [&](const std::string& why) {
    return std::invalid_argument("\"" + std::string(text.substr(0, 100)) + "\": " + why +
                                 "; expected wss://HOST[:PORT]/ROBOT");
  };
  Address address;
  address.encrypted = text.starts_with("wss://");
  if (!address.encrypted && !text.starts_with("ws://"))
    throw wrong("it begins otherwise");
  std::string_view rest = text.substr(address.encrypted ? 6 : 5);
  const std::size_t slash = rest.find('/');
  if (slash == std::string_view::npos || !is_name(rest.substr(slash + 1)))
    throw wrong("no robot is named");
  address.robot = rest.substr(slash + 1);
  rest = rest.substr(0, slash);
  if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
    address.port = port_of(rest.substr(colon + 1));
    if (address.port == 0)
      throw wrong("no port");
    rest = rest.substr(0, colon);
  } else if (!address.encrypted) {
    address.port = 80;
  }
  if (!is_name(rest))
    throw wrong("no host is named");
  address.host = rest;
  if (!address.encrypted && address.host != "localhost" && address.host != "127.0.0.1")
    throw wrong("without encryption the token crosses the network in the clear");
  return address;
}

std::optional<Path> parse_path(std::string_view text) {
  const bool dials = text.starts_with("/dial/");
  if (!dials && !text.starts_with("/carry/"))
    return std::nullopt;
  text.remove_prefix(dials ? 6 : 7);
  const std::size_t slash = dials ? text.size() : text.find('/');
  if (slash == std::string_view::npos || !is_name(text.substr(0, slash)))
    return std::nullopt;
  Path path{std::string(text.substr(0, slash)), {}};
  if (!dials)
    path.ticket = text.substr(slash + 1);
  return dials || is_name(path.ticket) ? std::optional(path) : std::nullopt;
}

bool Rendezvous::knows(std::string_view robot, std::string_view token) const {
  bool known = false;
  for (const Robot& each : robots_) {
    unsigned difference = each.name == robot && each.token.size() == token.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(each.token.size(), token.size()); ++i)
      difference |=
          static_cast<unsigned char>(each.token[i]) ^ static_cast<unsigned char>(token[i]);
    known = known || difference == 0;
  }
  return known;
}

std::optional<Rendezvous::Visitor> Rendezvous::arrive(const std::string& robot,
                                                      const std::string& from, Visitor visitor,
                                                      const std::string& ticket, double now) {
  std::size_t there = 0;
  std::map<std::string, std::size_t> counts;  // by address
  for (const auto& [other, guest] : guests_)
    if (guest.robot == robot) {
      ++there;
      ++counts[guest.from];
    }
  std::optional<std::string> crowd;  // the address that gives a place
  if (counts[from] >= kMostFromOne)
    crowd = from;
  else if (there >= kMost)
    crowd = std::ranges::max_element(counts, [](const auto& a, const auto& b) {
              return a.second < b.second;
            })->first;
  std::optional<Visitor> gone;
  for (const auto& [other, guest] : guests_)
    if (crowd == guest.from && guest.robot == robot &&
        (!gone || guest.heard < guests_[*gone].heard))
      gone = other;
  if (gone)
    guests_.erase(*gone);
  guests_[visitor] = {robot, from, ticket, now, now, true};
  return gone;
}

void Rendezvous::heard(Visitor visitor, double now) {
  if (const auto guest = guests_.find(visitor); guest != guests_.end())
    guest->second.heard = now;
}

std::optional<Rendezvous::Visitor> Rendezvous::fetch(const std::string& robot,
                                                     const std::string& ticket) {
  for (auto& [visitor, guest] : guests_)
    if (guest.waits && guest.robot == robot && guest.ticket == ticket) {
      guest.waits = false;
      return visitor;
    }
  return std::nullopt;
}

void Rendezvous::leave(Visitor visitor) {
  guests_.erase(visitor);
}

std::vector<Rendezvous::Visitor> Rendezvous::expire(double now) {
  std::vector<Visitor> gone;
  for (const auto& [visitor, guest] : guests_)
    if (guest.waits && now - guest.since > kPatience)
      gone.push_back(visitor);
  for (const Visitor visitor : gone)
    guests_.erase(visitor);
  return gone;
}

}  // namespace saphira::relay
