#include "strangers.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <thread>

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

std::string hear_one(std::uint16_t port) {
  const int heard = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(heard, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const ip_mreq group{place(kGroup, 0).sin_addr, place("127.0.0.1", 0).sin_addr};
  setsockopt(heard, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
  const timeval limit{20, 0};
  setsockopt(heard, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  const sockaddr_in here = place(kGroup, port);
  std::string packet;
  if (bind(heard, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0)
    for (ssize_t got = 0; got >= 0 && packet.empty();) {
      std::array<char, 65536> buffer{};
      got = recv(heard, buffer.data(), buffer.size(), 0);
      const std::string text(buffer.data(), static_cast<std::size_t>(got < 0 ? 0 : got));
      if (text.starts_with("RTPS") && text.size() > 300 &&
          text.find(std::string("\0\1\0\xc2", 4)) != std::string::npos)
        packet = text;
    }
  close(heard);
  if (packet.empty())
    throw std::runtime_error("no program announces itself on port " + std::to_string(port));
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
