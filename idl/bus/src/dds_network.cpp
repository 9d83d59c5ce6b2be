#include "dds_network.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/utils/IPFinder.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <unistd.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dds_convert.hpp"
#include "dds_sieve.hpp"
#include "internal.hpp"
#include "log.hpp"

namespace saphira::bus::internal {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

// [ms] between two announcements of a program: what a restarted one waits at the most until it is
// found.
constexpr int kAnnouncement = 250;
// By unicast to every place where a peer may be: less often, for the sake of a radio.
constexpr int kPeerAnnouncement = 500;

/// Of an endpoint of somebody else: Discovery tells whose, and why.
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
    const std::string text = "Fast DDS: " + entry.message;
    // What Fast DDS calls an error is no more than a warning for a system that goes on.
    write_log(entry.kind == fdds::Log::Kind::Info ? v1::LOG_DEBUG : v1::LOG_WARNING, text);
  }
};

rtps::Locator_t locator(const std::string& address) {
  rtps::Locator_t result;
  result.kind = LOCATOR_KIND_UDPv4;
  result.port = 0;  // the well-known ports of the domain
  if (rtps::IPLocator::isIPv4(address)) {
    rtps::IPLocator::setIPv4(result, address);
    return result;
  }
  const auto resolved = rtps::IPLocator::resolveNameDNS(address);
  if (resolved.first.empty())
    throw std::runtime_error("peer \"" + address +
                             "\" is neither an IPv4 address nor a known host");
  rtps::IPLocator::setIPv4(result, *resolved.first.begin());
  return result;
}

void check_interface(const std::string& address) {
  const auto found = own_addresses();
  if (found.contains(address))
    return;
  std::string all;
  for (const auto& own : found)
    all += " " + own;
  throw std::runtime_error("interface \"" + address +
                           "\" is not an address of this machine, which has" + all);
}

}  // namespace

std::set<std::string> own_addresses() {
  std::vector<rtps::IPFinder::info_IP> found;
  rtps::IPFinder::getIPs(&found, true);
  std::set<std::string> addresses;
  for (const auto& ip : found)
    if (ip.type == rtps::IPFinder::IP4 || ip.type == rtps::IPFinder::IP4_LOCAL)
      addresses.insert(ip.name);
  return addresses;
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

fdds::UserDataQosPolicy user_data(const std::string& heard) {
  const std::string text = "host=" + host_name() + ";pid=" + std::to_string(getpid()) + ";" +
                           (heard.empty() ? "" : "hears=" + heard + ";");
  fdds::UserDataQosPolicy data;
  data.setValue(std::vector<rtps::octet>(text.begin(), text.end()));
  return data;
}

std::set<std::string> peer_addresses(const NodeOptions& options) {
  std::set<std::string> addresses;
  if (options.profile == Profile::wan)
    for (const auto& peer : options.peers)
      addresses.insert(rtps::IPLocator::toIPv4string(locator(peer)));
  return addresses;
}

fdds::DomainParticipantQos participant_qos(const NodeOptions& options,
                                           std::shared_ptr<const std::atomic<bool>> mute,
                                           std::shared_ptr<Machines> machines,
                                           std::shared_ptr<Guard> guard) {
  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  qos.name(options.name);
  qos.user_data() = user_data("");

  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.leaseDuration = milliseconds(1000 * static_cast<int>(kLease.count()));
  builtin.discovery_config.leaseDuration_announcementperiod = milliseconds(kAnnouncement);
  std::string own_address = "127.0.0.1";
  switch (options.profile) {
    case Profile::host:
      udp->interfaceWhiteList.push_back(own_address);
      break;
    case Profile::lan:
    case Profile::wan:
      if (!options.interface.empty()) {
        check_interface(options.interface);
        own_address = options.interface;
        udp->interfaceWhiteList.push_back(own_address);
      }
      break;
  }
  std::vector<std::uint32_t> ports;
  if (options.profile == Profile::wan) {
    for (std::uint32_t i = 0; i < kProgramsPerPeer; ++i)
      ports.push_back(qos.wire_protocol().port.getUnicastPort(options.domain, i));
    builtin.avoid_builtin_multicast = true;
    builtin.discovery_config.leaseDuration_announcementperiod = milliseconds(kPeerAnnouncement);
    // A unicast place for discovery, and so no multicast one.
    rtps::Locator_t here;
    here.kind = LOCATOR_KIND_UDPv4;
    here.port = 0;
    builtin.metatrafficUnicastLocatorList.push_back(here);
    udp->maxInitialPeersRange = kProgramsPerPeer;
    builtin.initialPeersList.push_back(locator(own_address));
    for (const auto& peer : options.peers)
      builtin.initialPeersList.push_back(locator(peer));
  }
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(std::make_shared<SieveDescriptor>(
      udp, std::move(mute), std::move(machines), std::move(ports), guard));
  if (guard)
    guard->secure(qos);
  return qos;
}

}  // namespace saphira::bus::internal
