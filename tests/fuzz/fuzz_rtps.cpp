// Mutated RTPS packets against a running system: packets on the loopback of one DDS domain are
// recorded, mutated and sent again to their destination, in rounds. After each round: the programs
// that have died, and the success of a goal.
//
//   saphira-fuzz-rtps --domain 130 --seconds 3600 [--rate 200] [--seed 1]
//
// It needs the right to record packets (root). Nothing leaves the loopback.
#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "guarded.hpp"
#include "process.hpp"
#include "saphira/command_line/command_line.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;
using saphira::test::Process;
using saphira::test::TempDir;

struct Options {
  unsigned domain = 130;
  unsigned seconds = 3600;
  unsigned round_seconds = 20;
  unsigned rate = 200;  // packets a second
  std::uint64_t seed = 1;
  bool json = false;
  std::string log;  // of the programs; empty: removed at the end
};

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

struct Packet {
  sockaddr_in to{};
  Bytes bytes;
};

/// Captures the packets on the loopback to a domain's ports, and sends there.
class Loopback {
 public:
  explicit Loopback(unsigned domain)
      // The ports of loopback: see idl/README.md.
      : first_port_(7525 + 250 * domain),
        heard_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))),
        sender_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (heard_ < 0)
      fail("packets cannot be recorded (this needs root)");
    sockaddr_ll lo{};
    lo.sll_family = AF_PACKET;
    lo.sll_protocol = htons(ETH_P_IP);
    lo.sll_ifindex = static_cast<int>(if_nametoindex("lo"));
    if (bind(heard_, reinterpret_cast<sockaddr*>(&lo), sizeof lo) != 0)
      fail("lo cannot be recorded");
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof own;
    if (bind(sender_, reinterpret_cast<sockaddr*>(&own), sizeof own) != 0 ||
        getsockname(sender_, reinterpret_cast<sockaddr*>(&own), &size) != 0)
      fail("no socket to send from");
    own_port_ = ntohs(own.sin_port);
    setsockopt(sender_, IPPROTO_IP, IP_MULTICAST_IF, &own.sin_addr, sizeof own.sin_addr);
  }
  ~Loopback() {
    close(heard_);
    close(sender_);
  }
  Loopback(const Loopback&) = delete;
  Loopback& operator=(const Loopback&) = delete;

  int fd() const { return heard_; }

  /// The next captured packet; false: none.
  bool next(Packet& packet) {
    std::array<std::uint8_t, 65536> buffer{};
    for (;;) {
      sockaddr_ll from{};
      socklen_t size = sizeof from;
      const ssize_t got = recvfrom(heard_, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&from), &size);
      if (got < 0)
        return false;
      // Each packet is seen twice, out and in.
      if (from.sll_pkttype != PACKET_OUTGOING &&
          read(buffer.data(), static_cast<std::size_t>(got), packet))
        return true;
    }
  }
  void send(const Packet& packet) const {
    // Fails after the end of a receiver, which is no fault of the fuzzer.
    [[maybe_unused]] const auto sent =
        sendto(sender_, packet.bytes.data(), packet.bytes.size(), 0,
               reinterpret_cast<const sockaddr*>(&packet.to), sizeof packet.to);
  }

 private:
  bool read(const std::uint8_t* data, std::size_t size, Packet& packet) const {
    iphdr ip{};
    udphdr udp{};
    if (size < sizeof ip + sizeof udp)
      return false;
    std::memcpy(&ip, data, sizeof ip);
    const std::size_t header = 4U * ip.ihl;
    if (ip.protocol != IPPROTO_UDP || size < header + sizeof udp)
      return false;
    std::memcpy(&udp, data + header, sizeof udp);
    const unsigned port = ntohs(udp.dest);
    const std::uint8_t* const begin = data + header + sizeof udp;
    if (port < first_port_ || port >= first_port_ + 125 || ntohs(udp.source) == own_port_ ||
        size < header + sizeof udp + 20 || std::memcmp(begin, "RTPS", 4) != 0)
      return false;
    packet.to.sin_family = AF_INET;
    packet.to.sin_port = udp.dest;
    packet.to.sin_addr.s_addr = ip.daddr;
    packet.bytes.assign(begin, data + size);
    return true;
  }

  unsigned first_port_;
  int heard_;
  int sender_;
  unsigned own_port_ = 0;
};

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t limit) { return random_() % limit; }

  void mutate(Bytes& bytes, const Bytes& other) {
    const std::size_t times = 1 + below(4);
    for (std::size_t i = 0; i < times && bytes.size() > kHeader + 4; ++i)
      once(bytes, other);
  }

 private:
  // [bytes] The RTPS header. It is rarely mutated: a packet of an unknown sender is dropped.
  static constexpr std::size_t kHeader = 20;

  void once(Bytes& bytes, const Bytes& other) {
    const std::size_t from = below(20) == 0 ? 4 : kHeader;
    const std::size_t at = from + below(bytes.size() - from);
    switch (below(8)) {
      case 0:
      case 1:
        bytes[at] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 2:
        bytes[at] = static_cast<std::uint8_t>(random_());
        break;
      case 3: {
        static constexpr std::uint32_t kWords[] = {0,          1,          2,         0xffffffff,
                                                   0x7fffffff, 0x80000000, 0x0000ffff};
        const std::uint32_t word = kWords[below(std::size(kWords))];
        std::memcpy(&bytes[std::min(at, bytes.size() - 4)], &word, sizeof word);
        break;
      }
      case 4:
        bytes.resize(at);
        break;
      case 5:
        bytes.insert(bytes.begin() + static_cast<long>(at), 1 + below(64),
                     static_cast<std::uint8_t>(random_()));
        break;
      case 6: {
        const std::size_t count = std::min(bytes.size() - at, 1 + below(32));
        bytes.erase(bytes.begin() + static_cast<long>(at),
                    bytes.begin() + static_cast<long>(at + count));
        break;
      }
      default:
        if (other.size() > kHeader)
          bytes.insert(bytes.end(), other.begin() + kHeader, other.end());
        break;
    }
    if (bytes.size() > 65000)
      bytes.resize(65000);
  }

  std::mt19937_64 random_;
};

/// The ends of programs that `saphira up` reports ("bridge ended: exit code 3"), with counts.
std::map<std::string, int> ends(const std::string& output) {
  std::map<std::string, int> all;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(" ended: ");
    if (at == std::string::npos || !line.starts_with("saphira"))
      continue;
    const auto begin = line.find("| ");
    ++all[line.substr(begin == std::string::npos ? 0 : begin + 2,
                      line.find(';') - (begin == std::string::npos ? 0 : begin + 2))];
  }
  return all;
}

class Campaign {
 public:
  explicit Campaign(const Options& options)
      : options_(options), loopback_(options.domain), mutator_(options.seed) {}

  int run() {
    Process up({"saphira", "up", "demo"}, options_.log.empty() ? folder_.path("up") : options_.log,
               environment_);
    if (!goal("before")) {
      std::printf("the system did not come up:\n%s\n", up.output().c_str());
      return 1;
    }
    const auto end = Clock::now() + std::chrono::seconds(options_.seconds);
    std::size_t told = 0;
    while (Clock::now() < end && up.running()) {
      ++rounds_;
      send_round();
      const bool moved = goal(std::to_string(rounds_));
      unmoved_ += moved ? 0 : 1;
      const auto found = ends(up.output());
      std::size_t count = 0;
      for (const auto& [what, times] : found)
        count += static_cast<std::size_t>(times);
      std::printf("round %d: %llu packets so far, %zu ends of programs, %s\n", rounds_,
                  static_cast<unsigned long long>(sent_), count,
                  moved ? "the robot drives" : "NO GOAL MOVES THE ROBOT");
      std::fflush(stdout);
      told = count;
    }
    const bool running = up.running();
    nlohmann::json programs = nlohmann::json::object();
    for (const auto& [what, times] : ends(up.output())) {
      std::printf("%4d x %s\n", times, what.c_str());
      programs[what] = times;
    }
    if (options_.json)
      std::printf("%s\n", nlohmann::json{{"rounds", rounds_},
                                         {"packets", sent_},
                                         {"ends", told},
                                         {"programs", programs},
                                         {"rounds_without_motion", unmoved_},
                                         {"supervisor_lives", running}}
                              .dump()
                              .c_str());
    return running && unmoved_ == 0 ? 0 : 1;
  }

 private:
  /// True where a newly started client reaches a goal.
  bool goal(const std::string& name) {
    there_ = !there_;
    // In the map: dead reckoning drifts, and after an hour its (2, 0) is in a room beside the
    // corridor.
    Process client({"saphira", "goal", "go_to", there_ ? "position=3.5,7@map" : "position=2,7@map",
                    "--deadline", "60"},
                   folder_.path("goal-" + name), environment_);
    const auto code = client.wait(std::chrono::seconds(120));
    if (code == 0)
      return true;
    Process status({"saphira", "status"}, folder_.path("status-" + name), environment_);
    status.wait();
    std::printf("%s\n%s\n", client.output().c_str(), status.output().c_str());
    return false;
  }

  void send_round() {
    const auto end = Clock::now() + std::chrono::seconds(options_.round_seconds);
    const auto period = std::chrono::microseconds(1000000 / options_.rate);
    auto due = Clock::now();
    Packet packet;
    Bytes other;
    while (Clock::now() < end) {
      pollfd heard{loopback_.fd(), POLLIN, 0};
      poll(&heard, 1, 100);
      while (loopback_.next(packet)) {
        if (Clock::now() < due)
          continue;
        due = std::max(due + period, Clock::now() - std::chrono::seconds(1));
        const Bytes original = packet.bytes;
        mutator_.mutate(packet.bytes, other);
        loopback_.send(packet);
        ++sent_;
        if (mutator_.below(4) == 0)
          other = original;
      }
    }
  }

  const Options options_;
  Loopback loopback_;
  Mutator mutator_;
  TempDir folder_;
  const std::map<std::string, std::string> environment_{
      {"SAPHIRA_DOMAIN", std::to_string(options_.domain)},
      {"SAPHIRA_PROFILE", "host"},
      // No earlier run has left a place in its memory of the map.
      {"SAPHIRA_ROBOT", "fuzz-" + std::to_string(getpid())}};
  std::uint64_t sent_ = 0;
  int rounds_ = 0;
  int unmoved_ = 0;
  bool there_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  saphira::CommandLine app{"Mutated RTPS packets against a running system, on the loopback"};
  Options options;
  app.add_option("--domain", options.domain, "DDS domain; nobody else's").in_range(0, 232);
  app.add_option("--seconds", options.seconds, "how long").in_range(1, 1000000);
  app.add_option("--round", options.round_seconds, "seconds between two looks at the robot")
      .in_range(1, 3600);
  app.add_option("--rate", options.rate, "packets a second, at most").in_range(1, 100000);
  app.add_option("--seed", options.seed, "of the mutations");
  app.add_option("--log", options.log, "file for what the programs print");
  app.add_flag("--json", options.json, "one JSON object on the last line");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return saphira::test::guarded([&] { return Campaign(options).run(); }, 3);
}
