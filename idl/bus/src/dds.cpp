// The bus over Fast DDS. The only place that knows it, with dds_types.cpp.

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/utils/IPFinder.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/publisher/qos/PublisherQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/subscriber/qos/SubscriberQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "dds_types.hpp"
#include "internal.hpp"
#include "log.hpp"

namespace saphira::bus::internal {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kMaxDomain = 232;
// How many programs of one machine can be found by a peer that knows nothing but its address.
constexpr std::uint32_t kProgramsPerPeer = 12;
// [ms] after which a program that has died without a word is taken for gone. Longer than programs
// and networks usually stand still: who was taken for gone by one side alone, for standing still
// about so long, is not heard again by that side (Fast DDS 2.9 keeps the other side's half of the
// match).
constexpr int kLease = 10000;
// [ms] between two announcements of a program: what a restarted one waits at the most until it is
// found.
constexpr int kAnnouncement = 250;
// By unicast to every place where a peer may be: less often, for the sake of a radio.
constexpr int kPeerAnnouncement = 500;
// Until an endpoint that does not match is told by its policy alone: it is usually known sooner.
constexpr std::chrono::seconds kUnexplained{2};

Duration_t milliseconds(int ms) {
  return {ms / 1000, static_cast<std::uint32_t>(ms % 1000) * 1000000U};
}
double seconds(const Duration_t& duration) {
  return duration == eprosima::fastrtps::c_TimeInfinite
             ? 0.0
             : duration.seconds + 1e-9 * static_cast<double>(duration.nanosec);
}

const char* policy_name(fdds::QosPolicyId_t id) {
  switch (id) {
    case fdds::DURABILITY_QOS_POLICY_ID:
      return "durability";
    case fdds::PRESENTATION_QOS_POLICY_ID:
      return "presentation";
    case fdds::DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case fdds::LATENCYBUDGET_QOS_POLICY_ID:
      return "latency budget";
    case fdds::OWNERSHIP_QOS_POLICY_ID:
      return "ownership";
    case fdds::LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case fdds::RELIABILITY_QOS_POLICY_ID:
      return "reliability";
    case fdds::DESTINATIONORDER_QOS_POLICY_ID:
      return "destination order";
    case fdds::DATAREPRESENTATION_QOS_POLICY_ID:
      return "data representation";
    case fdds::TYPECONSISTENCYENFORCEMENT_QOS_POLICY_ID:
      return "type consistency";
    default:
      return "another policy";
  }
}

WriterId to_id(const rtps::GUID_t& guid) {
  WriterId id{};
  std::copy_n(guid.guidPrefix.value, 12, id.begin());
  std::copy_n(guid.entityId.value, 4, id.begin() + 12);
  return id;
}
WriterId to_id(const rtps::InstanceHandle_t& handle) {
  WriterId id{};
  for (unsigned i = 0; i < id.size(); ++i)
    id[i] = handle.value[i];
  return id;
}

std::string to_hex(const WriterId& id) {
  std::string text;
  for (const auto byte : id) {
    text += "0123456789abcdef"[byte >> 4U];
    text += "0123456789abcdef"[byte & 15U];
  }
  return text;
}

class DdsLog : public fdds::LogConsumer {
 public:
  void Consume(const fdds::Log::Entry& entry) override {
    const std::string text = "Fast DDS: " + entry.message;
    // What Fast DDS calls an error is no more than a warning for a system that goes on.
    write_log(entry.kind == fdds::Log::Kind::Info ? v1::LOG_DEBUG : v1::LOG_WARNING, text);
  }
};

// Settings of the library as a whole, before the first participant.
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
  std::vector<rtps::IPFinder::info_IP> found;
  rtps::IPFinder::getIPs(&found, true);
  std::string all;
  for (const auto& ip : found) {
    if (ip.type != rtps::IPFinder::IP4 && ip.type != rtps::IPFinder::IP4_LOCAL)
      continue;
    if (ip.name == address)
      return;
    all += " " + ip.name;
  }
  throw std::runtime_error("interface \"" + address +
                           "\" is not an address of this machine, which has" + all);
}

fdds::DomainParticipantQos participant_qos(const NodeOptions& options) {
  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  qos.name(options.name);
  const std::string who = "host=" + host_name() + ";pid=" + std::to_string(getpid()) + ";";
  qos.user_data().setValue(std::vector<rtps::octet>(who.begin(), who.end()));

  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.leaseDuration = milliseconds(kLease);
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
  if (options.profile == Profile::wan) {
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
  qos.transport().user_transports.push_back(udp);
  return qos;
}

// What was discovered of others, and what did not match. Filled by Fast DDS's threads.
class Discovery : public fdds::DomainParticipantListener {
 public:
  explicit Discovery(std::shared_ptr<Wake> wake) : wake_(std::move(wake)) {}

  void on_participant_discovery(fdds::DomainParticipant* /*participant*/,
                                rtps::ParticipantDiscoveryInfo&& info) override {
    using Info = rtps::ParticipantDiscoveryInfo;
    const std::scoped_lock lock(mutex_);
    const auto& prefix = info.info.m_guid.guidPrefix;
    if (info.status == Info::REMOVED_PARTICIPANT || info.status == Info::DROPPED_PARTICIPANT) {
      programs_.erase(prefix);
      std::erase_if(endpoints_, [&](const auto& item) { return item.first.guidPrefix == prefix; });
    } else {
      Program& program = programs_[prefix];
      program.name = info.info.m_participantName.to_string();
      const auto& bytes = info.info.m_userData.data_vec();
      const std::string data(bytes.begin(), bytes.end());
      program.host = field(data, "host=");
      const std::string pid = field(data, "pid=");
      std::from_chars(pid.data(), pid.data() + pid.size(), program.pid);
    }
    changed();
  }

  void on_subscriber_discovery(fdds::DomainParticipant* /*participant*/,
                               rtps::ReaderDiscoveryInfo&& info) override {
    put(info.info, false, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
  }
  void on_publisher_discovery(fdds::DomainParticipant* /*participant*/,
                              rtps::WriterDiscoveryInfo&& info) override {
    put(info.info, true, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
  }

  // Fast DDS found an endpoint on the other side of this topic that does not match, by this policy.
  // It says so again at each announcement, and may say so before the endpoint of ours is made or
  // the other's is told.
  void add_incompatible(const std::string& topic, bool own_writes, fdds::QosPolicyId_t policy) {
    const std::scoped_lock lock(mutex_);
    incompatible_.try_emplace({topic, own_writes, policy_name(policy)}, Clock::now());
    wake_->signal();
  }
  void add_own(const EndpointEntry& own) {
    const std::scoped_lock lock(mutex_);
    own_.push_back(own);
    type_check_due_ = true;
  }
  void remove_own(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(own_, [&](const EndpointEntry& own) { return own.id == id; });
  }

  std::vector<EndpointEntry> endpoints() const {
    const std::scoped_lock lock(mutex_);
    std::vector<EndpointEntry> result;
    result.reserve(endpoints_.size());
    for (const auto& [guid, endpoint] : endpoints_)
      result.push_back(with_program(guid, endpoint));
    return result;
  }

  std::vector<std::string> take_troubles() {
    const std::scoped_lock lock(mutex_);
    std::vector<std::string> texts;
    std::erase_if(incompatible_, [&](const auto& item) {
      return tell_incompatible(item.first, Clock::now() - item.second > kUnexplained, texts);
    });
    // Fast DDS says nothing where only the names of the types differ.
    if (std::exchange(type_check_due_, false)) {
      for (const auto& own : own_)
        for (const auto& [guid, other] : endpoints_)
          if (other.writer != own.writer && other.topic == own.topic && other.type != own.type &&
              partitions_meet(other.robot, own.robot) && told_.insert({own.id, other.id}).second)
            texts.push_back("topic " + own.topic + ": " + name(with_program(guid, other)) +
                            " has type " + other.type + ", expected " + own.type);
    }
    return texts;
  }

  void watch(bool on) { watched_ = on; }

 private:
  struct Program {
    std::string name;
    std::string host;
    std::uint32_t pid = 0;
  };

  static std::string field(const std::string& data, const std::string& key) {
    const auto begin = data.find(key);
    if (begin == std::string::npos)
      return {};
    const auto from = begin + key.size();
    return data.substr(from, data.find(';', from) - from);
  }

  static std::string name(const EndpointEntry& endpoint) {
    return std::string(endpoint.writer ? "the writer of " : "the reader of ") +
           (endpoint.program.empty() ? "an unknown program" : endpoint.program) +
           (endpoint.host.empty() ? "" : " at " + endpoint.host);
  }

  EndpointEntry with_program(const rtps::GUID_t& guid, EndpointEntry endpoint) const {
    if (const auto found = programs_.find(guid.guidPrefix); found != programs_.end()) {
      endpoint.program = found->second.name;
      endpoint.host = found->second.host;
      endpoint.pid = found->second.pid;
    }
    return endpoint;
  }

  struct Incompatible {
    std::string topic;
    bool own_writes = false;
    std::string policy;
    auto operator<=>(const Incompatible&) const = default;
  };

  // Each pair of endpoints once; where no pair explains it in time, the policy once. False: not
  // yet.
  bool tell_incompatible(const Incompatible& found, bool late, std::vector<std::string>& texts) {
    bool explained = false;
    for (const auto& own : own_) {
      if (own.topic != found.topic || own.writer != found.own_writes)
        continue;
      for (const auto& [guid, other] : endpoints_) {
        if (other.writer == own.writer || other.topic != own.topic ||
            !partitions_meet(other.robot, own.robot))
          continue;
        const std::string why =
            own.writer ? why_incompatible(own, other) : why_incompatible(other, own);
        explained = explained || !why.empty();
        if (!why.empty() && told_.insert({own.id, other.id}).second)
          texts.push_back("topic " + own.topic + ": " + name(with_program(guid, other)) +
                          " does not match, " + why);
      }
    }
    if (!explained && late && told_.insert({found.topic, found.policy}).second)
      texts.push_back("topic " + found.topic + ": " + (found.own_writes ? "a reader" : "a writer") +
                      " does not match, " + found.policy);
    return explained || late;
  }

  template <class Proxy>
  void put(const Proxy& proxy, bool writer, bool removed) {
    const std::scoped_lock lock(mutex_);
    if (removed) {
      endpoints_.erase(proxy.guid());
    } else {
      EndpointEntry endpoint;
      endpoint.topic = proxy.topicName().to_string();
      endpoint.type = proxy.typeName().to_string();
      endpoint.writer = writer;
      for (const auto& partition : proxy.m_qos.m_partition.names())
        endpoint.robot += (endpoint.robot.empty() ? "" : ",") + partition;
      endpoint.reliable = proxy.m_qos.m_reliability.kind == fdds::RELIABLE_RELIABILITY_QOS;
      static constexpr const char* durability[] = {"volatile", "transient_local", "transient",
                                                   "persistent"};
      endpoint.durability = durability[proxy.m_qos.m_durability.kind & 3U];
      endpoint.deadline = seconds(proxy.m_qos.m_deadline.period);
      static constexpr const char* liveliness[] = {"automatic", "manual_by_participant",
                                                   "manual_by_topic", "automatic"};
      endpoint.liveliness = liveliness[proxy.m_qos.m_liveliness.kind & 3U];
      if (const double lease = seconds(proxy.m_qos.m_liveliness.lease_duration); lease > 0.0) {
        std::ostringstream text;
        text << " " << lease << " s";
        endpoint.liveliness += text.str();
      }
      endpoint.ownership =
          proxy.m_qos.m_ownership.kind == fdds::EXCLUSIVE_OWNERSHIP_QOS ? "exclusive" : "shared";
      endpoint.id = to_hex(to_id(proxy.guid()));
      endpoints_[proxy.guid()] = endpoint;
      for (const auto& own : own_)
        if (own.topic == endpoint.topic && own.type != endpoint.type) {
          type_check_due_ = true;
          wake_->signal();
        }
      if (!incompatible_.empty())
        wake_->signal();
    }
    changed();
  }

  void changed() {
    if (watched_)
      wake_->signal();
  }

  std::shared_ptr<Wake> wake_;
  std::atomic<bool> watched_{false};
  mutable std::mutex mutex_;
  std::map<rtps::GuidPrefix_t, Program> programs_;
  std::map<rtps::GUID_t, EndpointEntry> endpoints_;
  std::vector<EndpointEntry> own_;
  std::map<Incompatible, Clock::time_point> incompatible_;  // since when
  std::set<std::pair<std::string, std::string>> told_;
  bool type_check_due_ = false;
};

// The participant and what its endpoints share; lives as long as the last of them.
class Bus {
 public:
  Bus(const NodeOptions& options, std::shared_ptr<Wake> the_wake)
      : wake(std::move(the_wake)), discovery(wake), robot(options.robot) {
    if (options.domain > kMaxDomain)
      throw std::runtime_error("domain " + std::to_string(options.domain) + " is not in [0, " +
                               std::to_string(kMaxDomain) + "]");
    set_up_library();
    auto* factory = fdds::DomainParticipantFactory::get_instance();
    participant = factory->create_participant(options.domain, participant_qos(options), &discovery,
                                              fdds::StatusMask::none());
    if (participant == nullptr)
      throw std::runtime_error("no participant on domain " + std::to_string(options.domain) +
                               ": Fast DDS refused the settings");
    for (auto& type : all_types())
      type.register_type(participant);
    fdds::PublisherQos publisher_qos = fdds::PUBLISHER_QOS_DEFAULT;
    fdds::SubscriberQos subscriber_qos = fdds::SUBSCRIBER_QOS_DEFAULT;
    if (!robot.empty()) {
      publisher_qos.partition().push_back(robot.c_str());
      subscriber_qos.partition().push_back(robot.c_str());
    }
    if (participant->enable() == ReturnCode_t::RETCODE_OK) {
      publisher = participant->create_publisher(publisher_qos);
      subscriber = participant->create_subscriber(subscriber_qos);
    }
    if (publisher == nullptr || subscriber == nullptr) {
      close();
      throw std::runtime_error("no bus on domain " + std::to_string(options.domain) +
                               ": no network socket could be opened for it");
    }
  }
  ~Bus() { close(); }
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  fdds::Topic* topic(const char* name, const char* type) {
    if (auto* description = participant->lookup_topicdescription(name))
      return dynamic_cast<fdds::Topic*>(description);
    return participant->create_topic(name, type, fdds::TOPIC_QOS_DEFAULT);
  }

  const std::shared_ptr<Wake> wake;
  Discovery discovery;
  const std::string robot;
  fdds::DomainParticipant* participant = nullptr;
  fdds::Publisher* publisher = nullptr;
  fdds::Subscriber* subscriber = nullptr;

 private:
  void close() {
    participant->set_listener(nullptr);
    participant->delete_contained_entities();
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }
};

EndpointEntry own_entry(const Bus& bus, const char* topic, const TypeInfo& type,
                        const Policies& policies, bool writer) {
  EndpointEntry own;
  own.topic = topic;
  own.type = type.name;
  own.writer = writer;
  own.robot = bus.robot;
  own.reliable = policies.reliable;
  own.durability = policies.transient_local ? "transient_local" : "volatile";
  own.liveliness = "automatic";
  own.ownership = "shared";
  return own;
}

template <class Q>
void set_common_qos(Q& qos, const Policies& policies, int depth) {
  qos.reliability().kind =
      policies.reliable ? fdds::RELIABLE_RELIABILITY_QOS : fdds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = policies.transient_local ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                   : fdds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  // 0 is infinite. The default of ten instances makes the eleventh key's write fail.
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  // AUTO would leave files in /dev/shm after a kill, even with UDP as the only transport.
  qos.data_sharing().off();
  if (policies.lifespan_ms > 0)
    qos.lifespan().duration = milliseconds(policies.lifespan_ms);
}

class DdsWriter : public RawWriter, public fdds::DataWriterListener {
 public:
  DdsWriter(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
            const TypeInfo& type)
      : bus_(std::move(bus)), own_(own_entry(*bus_, topic, type, policies, true)) {
    fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
    set_common_qos(qos, policies, policies.writer_depth);
    qos.reliability().max_blocking_time = milliseconds(100);
    qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
    // dispose() is to withdraw and to forget. A writer that ends withdraws nothing by that (Fast
    // DDS does not unregister then).
    qos.writer_data_lifecycle().autodispose_unregistered_instances = true;
    if (policies.heartbeat_ms > 0)
      qos.reliable_writer_qos().times.heartbeatPeriod = milliseconds(policies.heartbeat_ms);
    auto* dds_topic = bus_->topic(topic, type.name);
    if (dds_topic != nullptr)
      writer_ = bus_->publisher->create_datawriter(
          dds_topic, qos, this,
          fdds::StatusMask::publication_matched() << fdds::StatusMask::offered_incompatible_qos());
    if (writer_ == nullptr)
      throw std::runtime_error(std::string("no writer on topic ") + topic);
    own_.id = to_hex(to_id(writer_->guid()));
    bus_->discovery.add_own(own_);
  }
  ~DdsWriter() override {
    bus_->discovery.remove_own(own_.id);
    writer_->set_listener(nullptr);
    bus_->publisher->delete_datawriter(writer_);
  }
  DdsWriter(const DdsWriter&) = delete;
  DdsWriter& operator=(const DdsWriter&) = delete;

  // Fast DDS takes a writable pointer and only reads it.
  bool write(const void* sample) override { return writer_->write(const_cast<void*>(sample)); }
  bool dispose(const void* sample) override {
    // An instance that another writer has written is withdrawn as well: it has to be made known
    // here first.
    writer_->register_instance(const_cast<void*>(sample));
    // Not only dispose(): after that Fast DDS keeps the instance for ever, here and at the readers.
    return writer_->unregister_instance(const_cast<void*>(sample), fdds::HANDLE_NIL) ==
           ReturnCode_t::RETCODE_OK;
  }
  bool wait_acknowledged(int timeout_ms) override {
    return writer_->wait_for_acknowledgments(milliseconds(timeout_ms)) == ReturnCode_t::RETCODE_OK;
  }
  std::size_t matched() const override { return matched_; }

  void on_publication_matched(fdds::DataWriter* /*writer*/,
                              const fdds::PublicationMatchedStatus& status) override {
    matched_ = static_cast<std::size_t>(std::max(0, status.current_count));
    bus_->wake->signal();
  }
  void on_offered_incompatible_qos(fdds::DataWriter* /*writer*/,
                                   const fdds::OfferedIncompatibleQosStatus& status) override {
    bus_->discovery.add_incompatible(own_.topic, own_.writer, status.last_policy_id);
  }

 private:
  std::shared_ptr<Bus> bus_;
  EndpointEntry own_;
  fdds::DataWriter* writer_ = nullptr;
  std::atomic<std::size_t> matched_{0};
};

class DdsReader : public RawReader, public fdds::DataReaderListener {
 public:
  DdsReader(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
            const TypeInfo& type)
      : bus_(std::move(bus)),
        own_(own_entry(*bus_, topic, type, policies, false)),
        type_(type),
        scratch_(type.create(), type.destroy) {
    fdds::DataReaderQos qos = fdds::DATAREADER_QOS_DEFAULT;
    set_common_qos(qos, policies, policies.reader_depth);
    if (type.keyed) {
      // With either of the DYNAMIC modes a reader never sees that an instance was withdrawn: the
      // message has no payload, and a buffer of no size is not to be had.
      qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      qos.resource_limits().allocated_samples = 1;
    }
    auto* dds_topic = bus_->topic(topic, type.name);
    if (dds_topic != nullptr)
      reader_ = bus_->subscriber->create_datareader(
          dds_topic, qos, this,
          fdds::StatusMask::data_available() << fdds::StatusMask::subscription_matched()
                                             << fdds::StatusMask::requested_incompatible_qos());
    if (reader_ == nullptr)
      throw std::runtime_error(std::string("no reader on topic ") + topic);
    own_.id = to_hex(to_id(reader_->guid()));
    bus_->discovery.add_own(own_);
  }
  ~DdsReader() override {
    bus_->discovery.remove_own(own_.id);
    reader_->set_listener(nullptr);
    bus_->subscriber->delete_datareader(reader_);
  }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  void take(const std::function<void(const void*, const SampleInfo&)>& each) override {
    fdds::SampleInfo dds_info;
    while (reader_->take_next_sample(scratch_.get(), &dds_info) == ReturnCode_t::RETCODE_OK) {
      SampleInfo info;
      info.writer = to_id(dds_info.sample_identity.writer_guid());
      if (dds_info.valid_data) {
        if (type_.keyed)
          remember(dds_info.instance_handle);
        each(scratch_.get(), info);
      } else if (dds_info.instance_state == fdds::NOT_ALIVE_DISPOSED_INSTANCE_STATE) {
        // Withdrawn before any sample of it was taken: there is nothing to tell.
        const auto found = last_.find(dds_info.instance_handle);
        if (found == last_.end())
          continue;
        const Holder last = std::move(found->second);
        last_.erase(found);
        info.disposed = true;
        each(last.get(), info);
      }
    }
  }

  std::vector<WriterId> take_lost() override {
    const std::scoped_lock lock(mutex_);
    return std::exchange(lost_, {});
  }
  std::size_t matched() const override { return matched_; }

  void on_data_available(fdds::DataReader* /*reader*/) override { bus_->wake->signal(); }
  void on_subscription_matched(fdds::DataReader* /*reader*/,
                               const fdds::SubscriptionMatchedStatus& status) override {
    matched_ = static_cast<std::size_t>(std::max(0, status.current_count));
    if (status.current_count_change < 0) {
      const std::scoped_lock lock(mutex_);
      lost_.push_back(to_id(status.last_publication_handle));
    }
    bus_->wake->signal();
  }
  void on_requested_incompatible_qos(fdds::DataReader* /*reader*/,
                                     const fdds::RequestedIncompatibleQosStatus& status) override {
    bus_->discovery.add_incompatible(own_.topic, own_.writer, status.last_policy_id);
  }

 private:
  using Holder = std::unique_ptr<void, void (*)(void*)>;

  // get_key_value() is not supported: what was withdrawn is known by this alone.
  void remember(const rtps::InstanceHandle_t& handle) {
    auto found = last_.find(handle);
    if (found == last_.end())
      found = last_.emplace(handle, Holder(type_.create(), type_.destroy)).first;
    type_.copy(scratch_.get(), found->second.get());
  }

  std::shared_ptr<Bus> bus_;
  EndpointEntry own_;
  const TypeInfo& type_;
  fdds::DataReader* reader_ = nullptr;
  Holder scratch_;
  std::map<rtps::InstanceHandle_t, Holder> last_;
  std::atomic<std::size_t> matched_{0};
  std::mutex mutex_;
  std::vector<WriterId> lost_;
};

class DdsTransport : public Transport {
 public:
  DdsTransport(const NodeOptions& options, std::shared_ptr<Wake> wake)
      : bus_(std::make_shared<Bus>(options, std::move(wake))) {}

  std::unique_ptr<RawWriter> make_writer(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    return std::make_unique<DdsWriter>(bus_, topic, policies, type);
  }
  std::unique_ptr<RawReader> make_reader(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    return std::make_unique<DdsReader>(bus_, topic, policies, type);
  }
  std::vector<EndpointEntry> endpoints() const override { return bus_->discovery.endpoints(); }
  std::vector<std::string> take_troubles() override { return bus_->discovery.take_troubles(); }
  void watch_endpoints(bool watch) override { bus_->discovery.watch(watch); }

 private:
  std::shared_ptr<Bus> bus_;
};

}  // namespace

std::unique_ptr<Transport> make_dds_transport(const NodeOptions& options,
                                              std::shared_ptr<Wake> wake) {
  return std::make_unique<DdsTransport>(options, std::move(wake));
}

}  // namespace saphira::bus::internal
