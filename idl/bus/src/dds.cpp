// The bus over Fast DDS. The only places that know it are the files dds*.

#include <algorithm>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
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
#include <memory>
#include <stdexcept>
#include <utility>

#include "dds_convert.hpp"
#include "dds_discovery.hpp"
#include "dds_network.hpp"
#include "dds_presence.hpp"
#include "dds_qos.hpp"
#include "dds_types.hpp"
#include "internal.hpp"
#include "peers.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus::internal {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;

constexpr std::uint32_t kMaxDomain = 232;

// The participant and what its endpoints share; lives as long as the last of them.
class Bus {
 public:
  Bus(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> the_wake)
      : wake(std::move(the_wake)), peers(wake), discovery(wake, peers), robot(options.robot) {
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
    presence_ = std::make_unique<Presence>(
        peers, instance, topic(topics::kPresence.name, type_of<v1::Presence>().name), publisher,
        subscriber);
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
  Peers peers;
  Discovery discovery;
  const std::string robot;
  fdds::DomainParticipant* participant = nullptr;
  fdds::Publisher* publisher = nullptr;
  fdds::Subscriber* subscriber = nullptr;

 private:
  void close() {
    presence_.reset();
    participant->set_listener(nullptr);
    participant->delete_contained_entities();
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }

  std::unique_ptr<Presence> presence_;
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
    bus_->peers.add(ends_);
    if (dds_topic != nullptr)
      writer_ = bus_->publisher->create_datawriter(
          dds_topic, qos, this,
          fdds::StatusMask::publication_matched() << fdds::StatusMask::offered_incompatible_qos());
    if (writer_ == nullptr) {
      bus_->peers.remove(ends_);
      throw std::runtime_error(std::string("no writer on topic ") + topic);
    }
    own_.id = to_hex(to_id(writer_->guid()));
    bus_->discovery.add_own(own_);
  }
  ~DdsWriter() override {
    writer_->set_listener(nullptr);
    bus_->publisher->delete_datawriter(writer_);
    bus_->peers.remove(ends_);
    bus_->discovery.remove_own(own_.id);
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
    // Fast DDS does not say which reader has not acknowledged. One that is gone never will, and the
    // others have it, or have asked for it again, within a few heartbeats.
    constexpr int kSlice = 50;
    constexpr int kHeartbeats = 400;
    for (int waited = 0; waited < timeout_ms; waited += kSlice) {
      const int slice = std::min(kSlice, timeout_ms - waited);
      if (writer_->wait_for_acknowledgments(milliseconds(slice)) == ReturnCode_t::RETCODE_OK)
        return true;
      if (waited + slice >= kHeartbeats && ends_.present() > 0 && bus_->peers.any_absent(ends_))
        return true;
    }
    return false;
  }
  std::size_t matched() const override { return ends_.present(); }

  void on_publication_matched(fdds::DataWriter* /*writer*/,
                              const fdds::PublicationMatchedStatus& status) override {
    const WriterId other = to_id(status.last_subscription_handle);
    if (status.current_count_change > 0)
      bus_->peers.match(ends_, other);
    else
      bus_->peers.unmatch(ends_, other);
  }
  void on_offered_incompatible_qos(fdds::DataWriter* /*writer*/,
                                   const fdds::OfferedIncompatibleQosStatus& status) override {
    bus_->discovery.add_incompatible(own_.topic, own_.writer, status.last_policy_id);
  }

 private:
  std::shared_ptr<Bus> bus_;
  EndpointEntry own_;
  fdds::DataWriter* writer_ = nullptr;
  Ends ends_;
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
    bus_->peers.add(ends_);
    if (dds_topic != nullptr)
      reader_ = bus_->subscriber->create_datareader(
          dds_topic, qos, this,
          fdds::StatusMask::data_available() << fdds::StatusMask::subscription_matched()
                                             << fdds::StatusMask::requested_incompatible_qos());
    if (reader_ == nullptr) {
      bus_->peers.remove(ends_);
      throw std::runtime_error(std::string("no reader on topic ") + topic);
    }
    own_.id = to_hex(to_id(reader_->guid()));
    bus_->discovery.add_own(own_);
  }
  ~DdsReader() override {
    reader_->set_listener(nullptr);
    bus_->subscriber->delete_datareader(reader_);
    bus_->peers.remove(ends_);
    bus_->discovery.remove_own(own_.id);
  }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  void take(const std::function<void(const void*, const SampleInfo&)>& each) override {
    fdds::SampleInfo dds_info;
    while (reader_->take_next_sample(scratch_.get(), &dds_info) == ReturnCode_t::RETCODE_OK) {
      SampleInfo info;
      info.writer = to_id(dds_info.sample_identity.writer_guid());
      if (internal::take_malformed()) {
        bus_->discovery.add_malformed(own_.topic, dds_info.sample_identity.writer_guid());
      } else if (dds_info.valid_data) {
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

  std::vector<WriterId> take_lost() override { return bus_->peers.take_lost(ends_); }
  std::size_t matched() const override { return ends_.present(); }

  void on_data_available(fdds::DataReader* /*reader*/) override { bus_->wake->signal(); }
  void on_subscription_matched(fdds::DataReader* /*reader*/,
                               const fdds::SubscriptionMatchedStatus& status) override {
    const WriterId other = to_id(status.last_publication_handle);
    if (status.current_count_change > 0)
      bus_->peers.match(ends_, other);
    else
      bus_->peers.unmatch(ends_, other);
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
  Ends ends_;
};

class DdsTransport : public Transport {
 public:
  DdsTransport(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> wake)
      : bus_(std::make_shared<Bus>(options, instance, std::move(wake))) {}

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
  Malformed take_malformed() override { return bus_->discovery.take_malformed(); }
  void watch_endpoints(bool watch) override { bus_->discovery.watch(watch); }

 private:
  std::shared_ptr<Bus> bus_;
};

}  // namespace

std::unique_ptr<Transport> make_dds_transport(const NodeOptions& options, std::uint64_t instance,
                                              std::shared_ptr<Wake> wake) {
  return std::make_unique<DdsTransport>(options, instance, std::move(wake));
}

}  // namespace saphira::bus::internal
