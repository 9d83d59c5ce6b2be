#include "dds_network.hpp"

#include <arpa/inet.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <random>
#include <utility>
#include <vector>

#include "dds_convert.hpp"
#include "dds_sieve.hpp"
#include "internal.hpp"
#include "log.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/fnv1a.hpp"

namespace saphira::bus::internal {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

// [ms] between two announcements of a program: the longest time until a restarted program is found.
constexpr int kAnnouncement = 250;
// By unicast to every place where a peer may be: less often, to spare a radio link.
constexpr int kPeerAnnouncement = 500;

// Fast DDS's own limit is 100.
constexpr std::uint32_t kMostPrograms = 500;

/// True for a message about another program's endpoint: Discovery tells whose it is, and why.
bool is_refusal(const std::string& message) {
  return message.starts_with("Security manager returns an error") ||
         message.starts_with("Error checking create remote ") ||
         message.find(" not found in allow rule") != std::string::npos;
}

class DdsLog : public fdds::LogConsumer {
 public:
  void Consume(const fdds::Log::Entry& entry) override {
    if (is_refusal(entry.message))
      return;
    // An error of Fast DDS is logged as a warning, since the program goes on.
    write_log(entry.kind == fdds::Log::Kind::Info ? v1::LOG_DEBUG : v1::LOG_WARNING, "Fast DDS",
              entry.message);
  }
};

// Loopback has the ports of the other half of a domain's 250: neighbours do not hear the
// announcements that are for other machines, and the other way round.
constexpr std::uint16_t kLoopbackPorts = 125;

// Of the standard, for announcements.
constexpr const char* kGroup = "239.255.0.1";

/// A number of this machine since its boot, or of this network namespace.
std::uint32_t machine() {
  static const std::uint32_t number = [] {
    std::string text;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> text;
    std::error_code none;
    text += std::filesystem::read_symlink("/proc/self/ns/net", none).string();
    Fnv1a hash;
    hash.add(text);
    return static_cast<std::uint32_t>(hash.value() ^ (hash.value() >> 32U));
  }();
  return number;
}

/// Fast DDS makes the prefix from the machine's present addresses, so that machines without an
/// address would have the same one.
rtps::GuidPrefix_t new_prefix() {
  static const std::uint32_t process = std::random_device{}();
  static std::atomic<std::uint32_t> count{0};
  const std::array<std::uint32_t, 3> parts{machine(), process, ++count};
  rtps::GuidPrefix_t prefix;
  static_assert(sizeof parts == sizeof prefix.value);
  std::memcpy(prefix.value, parts.data(), sizeof parts);
  return prefix;
}

/// True where an address is one of this machine's, by a look at them that is not older than a
/// second.
class OwnAddress {
 public:
  bool is(const std::string& address) {
    const std::scoped_lock lock(mutex_);
    const auto now = BootClock::now();
    if (own_.contains(address))
      return true;
    if (now - looked_ < std::chrono::seconds(1) && others_.contains(address))
      return false;
    own_ = network_addresses();
    own_.try_emplace("127.0.0.1");
    if (now - looked_ >= std::chrono::seconds(1))
      others_.clear();
    looked_ = now;
    if (own_.contains(address))
      return true;
    others_.insert(address);
    return false;
  }

 private:
  std::mutex mutex_;
  BootClock::time_point looked_;
  Addresses::Devices own_;
  std::set<std::string> others_;
};

/// Programs of this machine are heard on loopback, and would be heard twice. With security the
/// first bytes of a prefix identify a program, not its machine.
SieveDescriptor::Ignore own_programs(bool secured) {
  if (!secured)
    return [](const std::uint8_t* prefix, const rtps::Locator_t& /*from*/) {
      const std::uint32_t own = machine();
      return std::memcmp(prefix, &own, sizeof own) == 0;
    };
  return [own = std::make_shared<OwnAddress>()](const std::uint8_t* /*prefix*/,
                                                const rtps::Locator_t& from) {
    return own->is(rtps::IPLocator::toIPv4string(from));
  };
}

}  // namespace

Addresses::Devices network_addresses() {
  Addresses::Devices found;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0)
    return found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET ||
        (one->ifa_flags & IFF_LOOPBACK) != 0 || (one->ifa_flags & IFF_RUNNING) == 0)
      continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* const address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr)
      found.emplace(text.data(), if_nametoindex(one->ifa_name));
  }
  freeifaddrs(all);
  return found;
}

bool is_address(const std::string& text) {
  return rtps::IPLocator::isIPv4(text);
}

std::string look_up(const std::string& host) {
  const auto found = rtps::IPLocator::resolveNameDNS(host).first;
  return found.empty() ? std::string() : *found.begin();
}

void set_up_library() {
  static const bool once = [] {
    fdds::Log::ClearConsumers();
    fdds::Log::RegisterConsumer(std::make_unique<DdsLog>());
    fdds::Log::SetVerbosity(fdds::Log::Kind::Error);
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_FULL;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
    // A participant is enabled after its types are there, not before.
    auto* factory = fdds::DomainParticipantFactory::get_instance();
    fdds::DomainParticipantFactoryQos qos;
    factory->get_qos(qos);
    qos.entity_factory().autoenable_created_entities = false;
    factory->set_qos(qos);
    return true;
  }();
  static_cast<void>(once);
}

fdds::UserDataQosPolicy user_data(const NodeOptions& options, const std::string& heard) {
  const std::string text = "host=" + host_name() + ";pid=" + std::to_string(getpid()) +
                           ";contract=" SAPHIRA_CONTRACT ";program=" +
                           (options.program.empty() ? options.name : options.program) + ";" +
                           Fleet(options).fields() + (heard.empty() ? "" : "hears=" + heard + ";");
  fdds::UserDataQosPolicy data;
  data.setValue(std::vector<rtps::octet>(text.begin(), text.end()));
  return data;
}

fdds::DomainParticipantQos participant_qos(const NodeOptions& options, Side side,
                                           std::shared_ptr<const std::atomic<bool>> mute,
                                           std::shared_ptr<Machines> machines,
                                           std::shared_ptr<Guard> guard,
                                           std::shared_ptr<Entrance> entrance, const Fleet& fleet) {
  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  qos.name(options.name);
  qos.user_data() = user_data(options, "");
  qos.wire_protocol().prefix = new_prefix();

  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.leaseDuration = milliseconds(1000 * static_cast<int>(kLease.count()));
  builtin.discovery_config.leaseDuration_announcementperiod = milliseconds(kAnnouncement);
  // Programs of one machine on one domain: each tries the next port until one is free.
  builtin.mutation_tries = kMostPrograms;
  std::vector<std::uint32_t> ports;
  SieveDescriptor::Ignore ignore;
  if (side == Side::local) {
    udp->interfaceWhiteList.push_back("127.0.0.1");
    auto& port = qos.wire_protocol().port;
    port.portBase += kLoopbackPorts;
    // A program hears its robot's port, and the usual one, which programs on another DDS announce
    // themselves at: it answers these by unicast.
    const std::uint32_t usual = port.getMulticastPort(options.domain);
    const auto add = [&](rtps::LocatorList_t& list, const std::string& address,
                         std::uint32_t number) {
      rtps::Locator_t place;
      rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, address, number, place);
      list.push_back(place);
    };
    add(builtin.metatrafficUnicastLocatorList, "127.0.0.1", 0);
    add(builtin.metatrafficMulticastLocatorList, kGroup, usual);
    for (const std::uint16_t offset : fleet.ports()) {
      add(builtin.metatrafficMulticastLocatorList, kGroup, usual + offset);
      add(builtin.initialPeersList, kGroup, usual + offset);
    }
  } else {
    ignore = own_programs(guard != nullptr);
    // A packet that waits for a neighbour's address must not hold up the sender.
    udp->non_blocking_send = true;
    if (!options.interface.empty())
      udp->interfaceWhiteList.push_back(options.interface);
    if (machines) {
      for (std::uint32_t i = 0; i < kProgramsPerPeer; ++i)
        ports.push_back(qos.wire_protocol().port.getUnicastPort(options.domain, i));
      builtin.avoid_builtin_multicast = true;
      builtin.discovery_config.leaseDuration_announcementperiod = milliseconds(kPeerAnnouncement);
      // A unicast place for discovery, and so no multicast one.
      rtps::Locator_t here;
      here.kind = LOCATOR_KIND_UDPv4;
      here.port = 0;
      builtin.metatrafficUnicastLocatorList.push_back(here);
      // Announcements go to the machines (Sieve). Fast DDS makes none where it knows no place for
      // them.
      udp->maxInitialPeersRange = 1;
      rtps::IPLocator::setIPv4(here, options.interface.empty() ? "127.0.0.1" : options.interface);
      builtin.initialPeersList.push_back(here);
    }
  }
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(
      std::make_shared<SieveDescriptor>(udp, std::move(mute), std::move(machines), std::move(ports),
                                        guard, std::move(entrance), std::move(ignore), fleet));
  if (guard) {
    guard->secure(qos);
    // Fast DDS has room for 100 handshakes, and ends by an assertion where there is none.
    qos.allocation().participants = {0, 100, 1};
  }
  return qos;
}

}  // namespace saphira::bus::internal
