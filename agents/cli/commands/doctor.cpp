// doctor: why two programs do not talk.
#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

#include "commands.hpp"
#include "run_folder.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/descriptor.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/security/credentials.hpp"
#include "saphira/watch/diagnosis.hpp"
#include "saphira/watch/processes.hpp"
#include "watch.hpp"

namespace saphira::cli {
namespace {

constexpr const char* kGroup = "239.255.0.1";      // of discovery
constexpr std::chrono::milliseconds kReturn{500};  // of a packet on this machine
constexpr double kSettled = 6.0;                   // [s] what is still open then is a finding

/// Hears the announcements on one interface.
class Ear {
 public:
  Ear(const std::string& address, std::uint16_t port)
      : address_(address), port_(port), socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    const int off = 0;
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_port = htons(port);
    ip_mreq join{};
    inet_pton(AF_INET, kGroup, &join.imr_multiaddr);
    inet_pton(AF_INET, address.c_str(), &join.imr_interface);
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof off);
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &join.imr_interface,
               sizeof join.imr_interface);
    hears_ = bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0 &&
             setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &join, sizeof join) == 0;
  }

  /// True where a packet to the group comes back. Programs drop it: it is no RTPS.
  bool returns() {
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(port_);
    inet_pton(AF_INET, kGroup, &group.sin_addr);
    const std::string probe = "saphira doctor " + std::to_string(getpid());
    if (!hears_ || sendto(socket_, probe.data(), probe.size(), 0,
                          reinterpret_cast<const sockaddr*>(&group), sizeof group) < 0)
      return false;
    const auto end = Clock::now() + kReturn;
    while (Clock::now() < end) {
      pollfd ready{socket_, POLLIN, 0};
      ::poll(&ready, 1, 20);
      if (take(probe))
        return true;
    }
    return false;
  }
  /// The other machines whose announcements have come.
  const std::set<std::string>& others() {
    take({});
    return others_;
  }

 private:
  /// True where `wanted` is among the packets.
  bool take(const std::string& wanted) {
    bool came = false;
    std::array<char, 64> bytes{};
    sockaddr_in from{};
    socklen_t length = sizeof from;
    for (ssize_t size = 0; (size = recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                            reinterpret_cast<sockaddr*>(&from), &length)) >= 0;) {
      const std::string_view text(bytes.data(), static_cast<std::size_t>(size));
      came = came || (!wanted.empty() && text == wanted);
      std::array<char, INET_ADDRSTRLEN> name{};
      inet_ntop(AF_INET, &from.sin_addr, name.data(), name.size());
      if (text.starts_with("RTPS") && address_ != name.data())
        others_.insert(name.data());
    }
    return came;
  }

  const std::string address_;
  const std::uint16_t port_;
  const Descriptor socket_;
  bool hears_ = false;
  std::set<std::string> others_;
};

/// The interfaces that a profile uses, loopback first.
std::vector<watch::NetworkInterface> interfaces_of(const bus::NodeOptions& options) {
  std::vector<watch::NetworkInterface> found;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0)
    return found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET ||
        (one->ifa_flags & IFF_RUNNING) == 0)
      continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr, text.data(),
              text.size());
    const std::string address = text.data();
    if ((one->ifa_flags & IFF_LOOPBACK) != 0) {
      if (address == "127.0.0.1")
        found.insert(found.begin(), {one->ifa_name, address});
    } else if (options.profile != bus::Profile::host &&
               (options.interface.empty() || options.interface == address)) {
      found.push_back({one->ifa_name, address});
    }
  }
  freeifaddrs(all);
  return found;
}

/// Empty: no host of this name was found.
std::string address_of(const std::string& name) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  addrinfo* found = nullptr;
  if (getaddrinfo(name.c_str(), nullptr, &hints, &found) != 0)
    return {};
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr, text.data(),
            text.size());
  freeaddrinfo(found);
  return text.data();
}

watch::CredentialsFact credentials_of(const bus::NodeOptions& options) {
  constexpr std::int64_t kDay = 86400;
  watch::CredentialsFact fact;
  if (options.security.empty() || options.security == bus::kOpenBus)
    return fact;
  fact.folder = options.security;
  try {
    const security::Credentials found = security::load_credentials(
        options.security, options.program.empty() ? options.name : options.program, unix_seconds());
    fact.member = found.subject.name;
    fact.role = found.subject.role;
    fact.site = found.subject.site;
    fact.days = (found.until - unix_seconds()) / kDay;
    fact.trouble = security::trouble_of_key(found);
  } catch (const std::exception& error) {
    fact.trouble = error.what();
  }
  return fact;
}

watch::Setting setting_of(const CLI::App& root, const std::string& option, const char* variable,
                          const std::string& value, const std::string& usual) {
  if (root.get_option(option)->count() == 0)
    return {value, value == usual ? "usual" : "of what runs on this machine"};
  const char* const given = std::getenv(variable);
  return {value, given != nullptr && value == given ? std::string("of ") + variable : option};
}

std::vector<watch::OtherDomain> other_domains(const bus::NodeOptions& options) {
  std::vector<watch::OtherDomain> all;
  for (const std::uint32_t domain : watch::domains_in(read_bytes("/proc/net/udp"))) {
    if (domain == options.domain)
      continue;
    watch::OtherDomain other{domain, {}};
    for (const RunningBus& bus : running_buses())
      if (bus.domain == domain)
        other.what += (other.what.empty() ? "" : "; ") + bus.what + ", robot " + bus.robot;
    all.push_back(std::move(other));
  }
  return all;
}

/// True while further findings may come with more time.
bool is_open(const bus::ProgramEntry& program) {
  return !program.let_in || program.endpoints == 0;
}

watch::BusFacts facts_of(const CLI::App& root, const bus::NodeOptions& options,
                         const bus::Stop& stop) {
  const bus::NodeOptions usual;
  watch::BusFacts facts;
  facts.robot = setting_of(root, "--robot", "SAPHIRA_ROBOT", options.robot, usual.robot);
  facts.domain = setting_of(root, "--domain", "SAPHIRA_DOMAIN", std::to_string(options.domain),
                            std::to_string(usual.domain));
  facts.profile = options.profile;
  facts.credentials = credentials_of(options);
  facts.domains = other_domains(options);
  const std::string version = bus::version();
  facts.contract = version.substr(version.rfind(' ') + 1);
  facts.interfaces = interfaces_of(options);
  std::vector<std::unique_ptr<Ear>> ears;
  for (watch::NetworkInterface& each : facts.interfaces) {
    const bool loopback = each.address.starts_with("127.");
    if (!loopback && options.profile != bus::Profile::lan)
      continue;
    ears.push_back(
        std::make_unique<Ear>(each.address, watch::discovery_port(options.domain, loopback)));
    each.multicast_returns = ears.back()->returns();
  }
  for (const std::string& peer : options.peers)
    facts.peers.push_back({peer, address_of(peer), false});
  if (!facts.credentials.trouble.empty()) {
    facts.trouble = "this program is not let on the bus: its credentials are unusable";
    return facts;
  }
  try {
    bus::Node node(options);
    const bus::Census census(node);
    Processes processes(node);
    const auto began = Clock::now();
    const auto poll = [&] {
      processes.poll();
      node.health();  // logs what does not fit
    };
    watch::listen(node, stop, processes, poll, [&] { return processes.news(); });
    const auto is_settled = [&] {
      poll();
      return std::ranges::none_of(bus::found_programs(node), is_open);
    };
    wait_for(node, std::chrono::duration<double>(kSettled - seconds_since(began)), stop,
             is_settled);
    facts.programs = bus::found_programs(node);
    facts.others = census.others();
    facts.endpoints = census.endpoints();
    facts.statuses = processes.all();
    facts.refused = node.take_refused();
    facts.waits = node.network_waits();
    const std::vector<std::string> silent = node.silent_peers();
    for (watch::PeerFact& peer : facts.peers)
      peer.silent = std::ranges::find(silent, peer.name) != silent.end();
  } catch (const std::exception& error) {
    facts.trouble = error.what();
  }
  for (std::size_t i = 0; i < ears.size(); ++i)
    facts.interfaces[i].others = {ears[i]->others().begin(), ears[i]->others().end()};
  return facts;
}

int doctor(const CLI::App& root, const std::vector<std::string>& programs,
           const bus::NodeOptions& options, const bus::Stop& stop) {
  const watch::BusFacts facts = facts_of(root, options, stop);
  const std::vector<watch::Finding> findings =
      programs.empty() || !facts.trouble.empty()
          ? watch::diagnose(facts)
          : watch::diagnose(facts, programs[0], programs.size() > 1 ? programs[1] : "");
  int code = bus::kExitOk;
  for (const watch::Finding& each : findings) {
    const bool is_wrong = each.verdict == watch::Verdict::wrong;
    print("%-5s  %-12s  %s\n",
          is_wrong                               ? "WRONG"
          : each.verdict == watch::Verdict::note ? "note"
                                                 : "ok",
          each.code.c_str(), each.is.c_str());
    if (!each.remedy.empty())
      print("%-5s  %-12s  > %s\n", "", "", each.remedy.c_str());
    if (is_wrong)
      code = bus::kExitFailed;
  }
  return code;
}

}  // namespace

void add_doctor(CLI::App& app, Chosen& chosen) {
  auto programs = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand(
      "doctor", "Why programs do not find or hear each other, and what to do about it");
  command
      ->add_option("program", *programs,
                   "why this one does not talk with the others, or with the second one")
      ->expected(0, 2);
  command->footer("Exit code 0: nothing is wrong; 1: something is.");
  chosen.when(command, [&app, programs](const bus::NodeOptions& node, const bus::Stop& stop) {
    return doctor(app, *programs, node, stop);
  });
}

}  // namespace saphira::cli
