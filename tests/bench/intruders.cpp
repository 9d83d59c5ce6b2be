#include "intruders.hpp"

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "forged.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/stop_signals.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/node.hpp"
#include "support/process.hpp"
#include "support/strangers.hpp"

namespace saphira::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

constexpr const char* kRobot = "guarded";
constexpr seconds kTrial{5};
// A program that is not let in is named after 5 s.
constexpr seconds kNaming{20};
constexpr milliseconds kCycle{100};
constexpr milliseconds kLate{50};
constexpr std::int64_t kHour = 3600;
constexpr const char* kAudit = "for the audit: ";

bus::NodeOptions options_of(const std::string& program, const std::string& credentials,
                            std::uint32_t domain) {
  bus::NodeOptions options;
  options.name = options.program = program;
  options.robot = kRobot;
  options.domain = domain;
  options.security = credentials;
  return options;
}

/// UDP packets on the loopback, as anybody on a cable can hear and send them.
class Wire {
 public:
  struct Packet {
    sockaddr_in to{};
    std::string content;
  };

  Wire() : heard_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))) {
    sockaddr_ll place{};
    place.sll_family = AF_PACKET;
    place.sll_protocol = htons(ETH_P_IP);
    place.sll_ifindex = static_cast<int>(if_nametoindex("lo"));
    const timeval limit{0, 100'000};
    const int room = 1 << 24;
    setsockopt(heard_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    setsockopt(heard_, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room);
    hears_ = bind(heard_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
    const in_addr loopback{htonl(INADDR_LOOPBACK)};
    setsockopt(sender_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  }
  ~Wire() {
    close(heard_);
    close(sender_);
  }
  Wire& operator=(Wire&&) = delete;

  /// False without the right to hear packets.
  bool hears() const { return hears_; }
  /// RTPS packets of that domain.
  std::vector<Packet> hear(std::uint32_t domain, Clock::duration time) const {
    std::vector<Packet> packets;
    std::array<char, 65536> buffer{};
    for (const auto end = Clock::now() + time; Clock::now() < end;) {
      const ssize_t size = recv(heard_, buffer.data(), buffer.size(), 0);
      constexpr ssize_t kHeaders = 28;  // of IP without options, and of UDP
      if (size <= kHeaders || buffer[0] != 0x45 || buffer[9] != IPPROTO_UDP)
        continue;
      Packet packet;
      packet.to.sin_family = AF_INET;
      std::memcpy(&packet.to.sin_addr, buffer.data() + 16, 4);
      std::memcpy(&packet.to.sin_port, buffer.data() + 22, 2);
      packet.content.assign(buffer.data() + kHeaders, static_cast<std::size_t>(size - kHeaders));
      const unsigned port = ntohs(packet.to.sin_port);
      if (packet.content.starts_with("RTPS") && port >= 7400 + 250 * domain &&
          port < 7400 + 250 * (domain + 1))
        packets.push_back(std::move(packet));
    }
    return packets;
  }
  void send(const Packet& packet) const {
    sendto(sender_, packet.content.data(), packet.content.size(), 0,
           reinterpret_cast<const sockaddr*>(&packet.to), sizeof packet.to);
  }

 private:
  int heard_;
  int sender_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  bool hears_ = false;
};

/// The bridge, as another process.
class Watched {
 public:
  Watched(const std::string& self, const std::string& credentials, const std::string& output)
      : process_({self, "--watched", credentials}, output) {
    if (!test::wait_until([&] { return process_.output().find("watched\n") != std::string::npos; }))
      throw std::runtime_error("the bridge does not begin: " + process_.output());
  }

  /// Waits until it has named somebody, if it does.
  void wait_for_name() {
    test::wait_until([&] { return process_.output().find(kAudit) != std::string::npos; }, kNaming);
  }

  /// Its end, and what it tells of the trial.
  nlohmann::json end(Intrusion& result) {
    result.aborted = !process_.running();
    process_.signal(SIGTERM);
    process_.wait();
    const std::string said = process_.output();
    const std::size_t at = said.rfind("\n{");
    if (at == said.npos)
      return nlohmann::json::object();
    const auto told = nlohmann::json::parse(said.substr(at + 1));
    result.cycles = told.at("cycles");
    result.late = told.at("late");
    if (const std::size_t name = said.find(kAudit); name != said.npos) {
      const std::size_t begin = name + std::strlen(kAudit);
      result.named = said.substr(begin, said.find('\n', begin) - begin);
      result.named_by.push_back("audit");
      if (said.find("bridge: " + result.named) != said.npos)
        result.named_by.push_back("log");
    }
    if (told.at("status").get<std::string>().find("kept out") != std::string::npos)
      result.named_by.push_back("status");
    return told;
  }

 private:
  test::Process process_;
};

/// A drive of an operator, once the bridge hears it; returns the packets on the wire meanwhile. It
/// takes so long that at least three announcements are among them, which come every 2 s: who
/// repeats them is known by those that are more than 2 s older than the newest.
std::vector<Wire::Packet> drive(const Wire& wire, const std::string& credentials,
                                std::uint32_t domain) {
  std::vector<Wire::Packet> packets;
  bus::Node node(options_of("bench", credentials, domain));
  auto commands = node.writer(bus::topics::kDriveTeleop);
  if (!test::wait_until([&] { return commands.matched() > 0; }))
    throw std::runtime_error("the bridge does not take an operator's commands");
  constexpr seconds kDrive{8};
  std::jthread listener([&] { packets = wire.hear(domain, kDrive); });
  v1::MotorCommand command;
  for (const auto end = Clock::now() + kDrive; Clock::now() < end;) {
    ++command.number;
    commands.write(command);
    node.wait(milliseconds(20));
  }
  listener.join();
  if (wire.hears() && packets.empty())
    throw std::runtime_error("nothing of an operator's drive was heard on the wire");
  return packets;
}

class Trials {
 public:
  Trials(security::Authority& site, std::string folder, std::string self, std::uint32_t domain,
         std::int64_t now)
      : site_(site),
        folder_(std::move(folder)),
        self_(std::move(self)),
        domain_(domain),
        now_(now),
        bridge_(site.add("guarded", {"bridge"}, "", 365, now)) {}

  std::vector<Intrusion> all() {
    trial(kNobody, [] {});
    for (const auto& members : heard_)
      for (const std::string name : members)
        own_.insert(name);
    altered("no credentials", bus::kOpenBus, "");
    altered("observer", copy(site_.add("john", {"observer"}, "", 365, now_)), "observer");
    altered("agent", copy(site_.add("planner", {"agent"}, "", 365, now_)), "agent");
    altered("operator of another robot", copy(site_.add("far", {"operator"}, "other", 365, now_)),
            "");
    altered("the same, self-signed", forged("farther", "operator", "other"), "");
    altered("self-signed", forged("liar", "observer", ""), "");
    altered("other site", other_site(), "");
    // The authority itself is valid since a day.
    altered("expired", copy(site_.add("late", {"operator"}, "", 1, now_ - 36 * kHour)), "",
            {"--hours-back", "18"});
    const std::string gone = copy(site_.add("gone", {"operator"}, "", 365, now_));
    site_.revoke("gone");
    altered("revoked", gone, "");
    flood("flood", 0);
    flood("flood of 300 that repeat themselves", 300);
    fragments();
    replay();
    return std::move(results_);
  }

 private:
  std::string copy(const std::string& folder) const {
    const std::string to = folder_ + "/" + fs::path(folder).filename().string();
    fs::remove_all(to);
    fs::copy(folder, to, fs::copy_options::recursive);
    return to;
  }

  /// A member's folder that gives it every right. Signed by the member itself.
  std::string forged(const std::string& name, const std::string& role, const std::string& robot) {
    const std::string folder = copy(site_.add(name, {role}, robot, 365, now_));
    security::test::forge(folder, {{name, 1, role, "bench"}, "", now_ - 60, now_ + 3600},
                          site_.roles(), security::test::pair_of(folder, role));
    return folder;
  }

  std::string other_site() const {
    const std::string roles = config_folder() + "/security/roles.yaml";
    security::Authority other = security::Authority::make(folder_ + "/other-site", "elsewhere",
                                                          read_file(roles), roles, now_);
    return other.add("foreign", {"operator"}, "", 365, now_);
  }

  Intrusion& trial(const std::string& who, const std::function<void()>& act) {
    Intrusion& result = results_.emplace_back();
    result.who = who;
    Watched bridge(self_, bridge_, folder_ + "/bridge-" + std::to_string(results_.size()));
    act();
    std::this_thread::sleep_for(kTrial);
    if (who != kNobody)
      bridge.wait_for_name();
    told_ = bridge.end(result);
    heard_ = told_.value("heard", nlohmann::json::object());
    return result;
  }

  /// A program that writes and reads all that it can, with these credentials. `role`: whose rights
  /// it has; empty: none.
  void altered(const std::string& who, const std::string& credentials, const std::string& role,
               const std::vector<std::string>& more = {}) {
    std::unique_ptr<test::Process> liar;
    Intrusion& result = trial(who, [&] {
      std::vector<std::string> words{"saphira-bus-altered", "--name", "liar"};
      words.insert(words.end(), more.begin(), more.end());
      liar = std::make_unique<test::Process>(
          words, folder_ + "/liar-" + std::to_string(results_.size()),
          std::map<std::string, std::string>{{"SAPHIRA_DOMAIN", std::to_string(domain_)},
                                             {"SAPHIRA_ROBOT", kRobot},
                                             {"SAPHIRA_SECURITY", credentials}});
    });
    if (!liar->running())
      throw std::runtime_error(who + ": the altered program has ended: " + liar->output());
    for (const auto& [topic, members] : heard_.items())
      if (by_others(members) && (role.empty() || !site_.roles().may_write(role, topic)))
        result.got.push_back("writes " + topic);
    bus::for_each_topic([&](const auto& topic) {
      const std::string line = std::string("hears ") + topic.name + "\n";
      if (liar->output().find(line) != std::string::npos &&
          (role.empty() || !site_.roles().may_read(role, topic.name)))
        result.got.push_back("reads " + std::string(topic.name));
    });
  }

  bool by_others(const nlohmann::json& members) const {
    return std::any_of(members.begin(), members.end(),
                       [this](const std::string& name) { return !own_.contains(name); });
  }

  void flood(const std::string& who, int programs) {
    trial(who, [&] { test::Strangers(domain_).announce(10000, 2000, programs); });
  }

  /// Pieces of samples in the name of the bridge, of others and of nobody.
  void fragments() {
    const Wire wire;
    const std::string credentials = site_.add("kate", {"operator"}, "", 365, now_);
    Intrusion& result = trial("fragments", [&] {
      const auto heard = drive(wire, credentials, domain_);
      std::mt19937 random(1);
      for (int i = 0; i < 20000 && !heard.empty(); ++i) {
        Wire::Packet packet = heard[random() % heard.size()];
        packet.content.resize(20);
        if (i % 3 == 0)
          for (std::size_t at = 8; at < 20; ++at)
            packet.content[at] = static_cast<char>(random());
        std::string body(44 + random() % 200, '\0');
        for (char& byte : body)
          byte = static_cast<char>(random());
        // The endpoints of handshakes, announcements and any others.
        const std::string writers[]{{"\0\2\1\xc3", 4}, {"\0\1\0\xc2", 4}, body.substr(0, 4)};
        body.replace(8, 4, writers[random() % 3]);
        packet.content += '\x16';
        packet.content += '\1';
        packet.content += static_cast<char>(body.size() & 0xfc);
        packet.content += '\0';
        packet.content += body.substr(0, body.size() & 0xfc);
        wire.send(packet);
      }
    });
    result.left_out = !wire.hears();
  }

  /// An operator's packets again, after its drive.
  void replay() {
    const Wire wire;
    const std::string credentials = site_.add("karen", {"operator"}, "", 365, now_);
    Intrusion& result = trial("replayed packets", [&] {
      const auto packets = drive(wire, credentials, domain_);
      for (int i = 0; i < 5; ++i)
        for (const Wire::Packet& packet : packets)
          wire.send(packet);
    });
    result.left_out = !wire.hears();
    if (const std::size_t again = told_.value("repeated", std::size_t{0}); again > 0)
      result.got.push_back(std::to_string(again) + " commands again");
    if (told_.value("commands", std::size_t{0}) == 0)
      throw std::runtime_error("the operator's commands were not heard at all");
  }

  security::Authority& site_;
  const std::string folder_;
  const std::string self_;
  const std::uint32_t domain_;
  const std::int64_t now_;
  const std::string bridge_;
  std::vector<Intrusion> results_;
  nlohmann::json told_;
  std::set<std::string> own_;  ///< the bridge itself, as it hears itself
  nlohmann::json heard_ = nlohmann::json::object();
};

}  // namespace

std::vector<Intrusion> intrude(security::Authority& site, const std::string& folder,
                               const std::string& self, std::uint32_t domain, std::int64_t now) {
  return Trials(site, folder, self, domain, now).all();
}

int watched(const std::string& credentials, std::uint32_t domain) {
  const int stop = stop_on_signals();
  bus::Node node(options_of("bridge", credentials, domain));
  std::vector<std::function<void()>> turns;
  std::map<std::string, std::set<std::string>> heard;
  std::size_t commands = 0;
  std::size_t repeated = 0;
  std::set<std::uint64_t> numbers;
  std::string status;
  auto states = node.writer(bus::topics::kRobotState);
  bus::for_each_topic([&]<class T>(const bus::Topic<T>& topic) {
    bool reads = true;
    std::shared_ptr<bus::Reader<T>> reader;
    try {
      reader = std::make_shared<bus::Reader<T>>(node.reader(topic));
    } catch (const std::invalid_argument&) {
      reads = false;
    }
    if (reads)
      turns.push_back([&, reader, name = std::string(topic.name)] {
        for (const auto& sample : reader->take()) {
          heard[name].insert(sample.info.sender ? sample.info.sender->text() : "none");
          if constexpr (std::is_same_v<T, v1::ServiceStatus>)
            if (sample.data.name == "bridge")
              status = sample.data.reason;
          if constexpr (std::is_same_v<T, v1::MotorCommand>)
            if (name == bus::topics::kDriveTeleop.name && sample.data.number > 0) {
              ++commands;
              repeated += numbers.insert(sample.data.number).second ? 0U : 1U;
            }
        }
      });
  });
  std::printf("watched\n");
  std::fflush(stdout);
  std::size_t cycles = 0;
  std::size_t late = 0;
  v1::RobotState state;
  pollfd ended{stop, POLLIN, 0};
  for (auto due = Clock::now(); poll(&ended, 1, 0) == 0;) {
    due += kCycle;
    while (Clock::now() < due)
      node.wait(std::chrono::duration_cast<milliseconds>(due - Clock::now()) + milliseconds(1));
    ++cycles;
    if (Clock::now() - due > kLate) {
      ++late;
      due = Clock::now();
    }
    ++state.stamp.cycle;
    states.write(state);
    for (const auto& turn : turns)
      turn();
    node.publish_status();
    // As the bridge writes it into its audit.
    for (const std::string& text : node.take_refused())
      std::printf("%s%s\n", kAudit, text.c_str());
    std::fflush(stdout);
  }
  std::printf("\n%s\n", nlohmann::json{{"cycles", cycles},
                                       {"late", late},
                                       {"heard", heard},
                                       {"status", status},
                                       {"commands", commands},
                                       {"repeated", repeated}}
                            .dump()
                            .c_str());
  return 0;
}

}  // namespace saphira::bench
