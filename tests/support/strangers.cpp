#include "strangers.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <thread>
#include <vector>

namespace saphira::test {

namespace {

constexpr const char* kGroup = "239.255.0.1";
constexpr std::size_t kPrefixAt = 8;
constexpr std::size_t kPrefix = 12;

sockaddr_in place(const char* address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  inet_pton(AF_INET, address, &result.sin_addr);
  return result;
}

/// The announcement of a program, at the port of its robot: one of eight behind the domain's first.
std::string hear_one(std::uint16_t first) {
  std::vector<pollfd> heard;
  for (std::uint16_t port = first + 2; port < first + 10; ++port) {
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const ip_mreq group{place(kGroup, 0).sin_addr, place("127.0.0.1", 0).sin_addr};
    setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
    const sockaddr_in here = place(kGroup, port);
    if (bind(fd, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0)
      heard.push_back({fd, POLLIN, 0});
    else
      close(fd);
  }
  std::string packet;
  while (packet.empty() && poll(heard.data(), heard.size(), 20'000) > 0)
    for (const pollfd& each : heard) {
      if ((each.revents & POLLIN) == 0)
        continue;
      std::array<char, 65536> buffer{};
      const ssize_t got = recv(each.fd, buffer.data(), buffer.size(), 0);
      const std::string text(buffer.data(), static_cast<std::size_t>(got < 0 ? 0 : got));
      if (text.starts_with("RTPS") && text.size() > 300 &&
          text.find(std::string("\0\1\0\xc2", 4)) != std::string::npos)
        packet = text;
    }
  for (const pollfd& each : heard)
    close(each.fd);
  if (packet.empty())
    throw std::runtime_error("no program announces itself behind port " + std::to_string(first));
  return packet;
}

}  // namespace

Strangers::Strangers(unsigned domain)
    : sender_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)),
      // The ports of loopback: see idl/README.md.
      port_(static_cast<std::uint16_t>(7525 + 250 * domain)),
      heard_(hear_one(port_)) {
  const in_addr loopback = place("127.0.0.1", 0).sin_addr;
  setsockopt(sender_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
}

Strangers::~Strangers() {
  close(sender_);
}

void Strangers::announce(int count, int per_second, int programs) {
  const std::string genuine = heard_.substr(kPrefixAt, kPrefix);
  const sockaddr_in to = place(kGroup, port_);
  auto due = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) {
    if (programs > 0)
      random_.seed(static_cast<std::uint64_t>(i % programs));
    std::string prefix(kPrefix, '\0');
    for (char& byte : prefix)
      byte = static_cast<char>(random_());
    std::string forged = heard_;
    for (std::size_t at = kPrefixAt; (at = forged.find(genuine, at)) != std::string::npos;)
      forged.replace(at, kPrefix, prefix);
    sendto(sender_, forged.data(), forged.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
    due += std::chrono::microseconds(1000000 / per_second);
    std::this_thread::sleep_until(due);
  }
}

}  // namespace saphira::test
