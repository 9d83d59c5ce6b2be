#include "slow_link.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <exception>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

namespace saphira::test {
namespace {

using Clock = std::chrono::steady_clock;

/// The result of a system call; std::system_error where it failed.
int need(int result, const char* what) {
  if (result < 0)
    throw std::system_error(errno, std::generic_category(), what);
  return result;
}

ifreq request(const char* interface) {
  ifreq made{};
  std::strncpy(made.ifr_name, interface, IFNAMSIZ - 1);
  return made;
}

void set_address(int socket, const char* interface, unsigned long what, const char* address) {
  ifreq made = request(interface);
  sockaddr_in inet{};
  inet.sin_family = AF_INET;
  inet_pton(AF_INET, address, &inet.sin_addr);
  std::memcpy(&made.ifr_addr, &inet, sizeof inet);
  need(ioctl(socket, what, &made), "address of a network interface");
}

void up(int socket, const char* interface) {
  ifreq made = request(interface);
  need(ioctl(socket, SIOCGIFFLAGS, &made), "network interface");
  made.ifr_flags = static_cast<short>(made.ifr_flags | IFF_UP | IFF_RUNNING);
  need(ioctl(socket, SIOCSIFFLAGS, &made), "network interface");
}

/// Gives the calling thread its own network namespace, with one end of the link in it.
void make_host(const char* address, int& network, int& tap) {
  need(unshare(CLONE_NEWNET), "a network namespace");
  network = need(open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC), "a network namespace");
  tap = need(open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC), "/dev/net/tun");
  ifreq made = request("link");
  made.ifr_flags = IFF_TAP | IFF_NO_PI;
  need(ioctl(tap, TUNSETIFF, &made), "/dev/net/tun");
  const int socket = need(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), "socket");
  set_address(socket, "link", SIOCSIFADDR, address);
  set_address(socket, "link", SIOCSIFNETMASK, "255.255.255.0");
  up(socket, "link");
  up(socket, "lo");
  close(socket);
}

/// True for an ARP frame, which a radio link does not lose: ARP repeats only after a second.
bool is_arp(const std::vector<char>& frame) {
  return frame.size() > 13 && frame[12] == 0x08 && frame[13] == 0x06;
}

}  // namespace

SlowLink::SlowLink() {
  for (std::size_t host = 0; host < 2; ++host) {
    // In a separate thread, whose namespace then becomes the host's.
    std::exception_ptr trouble;
    std::thread([&] {
      try {
        make_host(address(static_cast<int>(host)), networks_[host], taps_[host]);
      } catch (...) {
        trouble = std::current_exception();
      }
    }).join();
    if (trouble)
      std::rethrow_exception(trouble);
  }
  thread_ = std::thread([this] { relay(); });
}

SlowLink::~SlowLink() {
  ends_ = true;
  if (thread_.joinable())
    thread_.join();
  for (const int fd : taps_)
    close(fd);
  for (const int fd : networks_)
    close(fd);
}

void SlowLink::relay() {
  struct Frame {
    Clock::time_point due;
    std::vector<char> data;
  };
  std::array<std::deque<Frame>, 2> on_the_way;  // from each host
  std::mt19937 random(1);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::vector<char> buffer(65536);
  while (!ends_) {
    auto wake = Clock::now() + std::chrono::milliseconds(50);
    for (const auto& queue : on_the_way)
      if (!queue.empty())
        wake = std::min(wake, queue.front().due);
    const auto rest = std::max(wake - Clock::now(), Clock::duration::zero());
    const timespec timeout{0, std::chrono::duration_cast<std::chrono::nanoseconds>(rest).count()};
    std::array<pollfd, 2> waits{{{taps_[0], POLLIN, 0}, {taps_[1], POLLIN, 0}}};
    ppoll(waits.data(), waits.size(), &timeout, nullptr);
    const auto due = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(delay_.load()));
    for (std::size_t from = 0; from < 2; ++from) {
      ssize_t size = 0;
      while ((size = read(taps_[from], buffer.data(), buffer.size())) > 0) {
        std::vector<char> frame(buffer.begin(), buffer.begin() + size);
        if (!cut_ && (is_arp(frame) || chance(random) >= loss_))
          on_the_way[from].push_back({due, std::move(frame)});
      }
      auto& queue = on_the_way[from];
      for (; !queue.empty() && queue.front().due <= Clock::now(); queue.pop_front()) {
        const std::vector<char>& frame = queue.front().data;
        // A full queue of the other host counts as a loss.
        [[maybe_unused]] const ssize_t written = write(taps_[1 - from], frame.data(), frame.size());
      }
    }
  }
}

}  // namespace saphira::test
