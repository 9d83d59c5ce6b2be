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

#include "dds_bus.hpp"
#include "dds_convert.hpp"
#include "dds_qos.hpp"
#include "dds_types.hpp"
#include "internal.hpp"
#include "kept.hpp"

namespace saphira::bus::internal {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;

EndpointEntry own_entry(const std::string& robot, const char* topic, const TypeInfo& type,
                        const Policies& policies, bool writer) {
  EndpointEntry own;
  own.topic = topic;
  own.type = type.name;
  own.writer = writer;
  own.robot = robot;
  own.reliable = policies.reliable;
  own.durability = policies.transient_local ? "transient_local" : "volatile";
  own.liveliness = "automatic";
  own.ownership = "shared";
  return own;
}

class DdsWriter : public RawWriter, public Endpoint, public fdds::DataWriterListener {
 public:
  DdsWriter(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
            const TypeInfo& type)
      : bus_(std::move(bus)),
        own_(own_entry(bus_->robot(), topic, type, policies, true)),
        policies_(policies),
        type_(type) {
    bus_->peers.add(ends_);
    try {
      bus_->add(*this);
    } catch (...) {
      bus_->peers.remove(ends_);
      throw;
    }
  }
  ~DdsWriter() override {
    bus_->remove(*this);
    bus_->peers.remove(ends_);
  }
  DdsWriter(const DdsWriter&) = delete;
  DdsWriter& operator=(const DdsWriter&) = delete;

  void open(Session& session) override {
    discovery_ = &session.discovery;
    fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
    set_common_qos(qos, policies_, policies_.writer_depth);
    qos.reliability().max_blocking_time = milliseconds(100);
    qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
    // dispose() is to withdraw and to forget. A writer that ends withdraws nothing by that (Fast
    // DDS does not unregister then).
    qos.writer_data_lifecycle().autodispose_unregistered_instances = true;
    if (policies_.heartbeat_ms > 0)
      qos.reliable_writer_qos().times.heartbeatPeriod = milliseconds(policies_.heartbeat_ms);
    if (auto* topic = session.topic(own_.topic.c_str(), type_.name))
      writer_ = session.publisher->create_datawriter(
          topic, qos, this,
          fdds::StatusMask::publication_matched() << fdds::StatusMask::offered_incompatible_qos());
    if (writer_ == nullptr)
      throw std::runtime_error("no writer on topic " + own_.topic);
    own_.id = to_hex(to_id(writer_->guid()));
    session.discovery.add_own(own_);
    kept_.each([&](const void* sample) { writer_->write(const_cast<void*>(sample)); });
  }
  void close(Session& session) override {
    writer_->set_listener(nullptr);
    session.publisher->delete_datawriter(writer_);
    session.discovery.remove_own(own_.id);
    bus_->peers.restart(ends_);
    writer_ = nullptr;
  }

  // Fast DDS takes a writable pointer and only reads it.
  bool write(const void* sample) override {
    const auto session = bus_->hold();
    if (policies_.kept_by_session)
      kept_.put(type_, sample, policies_.writer_depth);
    return writer_->write(const_cast<void*>(sample));
  }
  bool dispose(const void* sample) override {
    const auto session = bus_->hold();
    kept_.erase(type_, sample);
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
      const auto session = bus_->hold();
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
    discovery_->add_incompatible(own_.topic, own_.writer, status.last_policy_id);
  }

 private:
  std::shared_ptr<Bus> bus_;
  EndpointEntry own_;
  const Policies policies_;
  const TypeInfo& type_;
  fdds::DataWriter* writer_ = nullptr;
  Discovery* discovery_ = nullptr;  // of the session
  Kept kept_;
  Ends ends_{Ends::Side::readers};
};

class DdsReader : public RawReader, public Endpoint, public fdds::DataReaderListener {
 public:
  DdsReader(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
            const TypeInfo& type)
      : bus_(std::move(bus)),
        own_(own_entry(bus_->robot(), topic, type, policies, false)),
        policies_(policies),
        type_(type),
        scratch_(type.create(), type.destroy) {
    bus_->peers.add(ends_);
    try {
      bus_->add(*this);
    } catch (...) {
      bus_->peers.remove(ends_);
      throw;
    }
  }
  ~DdsReader() override {
    bus_->remove(*this);
    bus_->peers.remove(ends_);
  }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  void open(Session& session) override {
    discovery_ = &session.discovery;
    fdds::DataReaderQos qos = fdds::DATAREADER_QOS_DEFAULT;
    set_common_qos(qos, policies_, policies_.reader_depth);
    if (type_.keyed) {
      // With either of the DYNAMIC modes a reader never sees that an instance was withdrawn: the
      // message has no payload, and a buffer of no size is not to be had.
      qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      qos.resource_limits().allocated_samples = 1;
    }
    if (auto* topic = session.topic(own_.topic.c_str(), type_.name))
      reader_ = session.subscriber->create_datareader(
          topic, qos, this,
          fdds::StatusMask::data_available() << fdds::StatusMask::subscription_matched()
                                             << fdds::StatusMask::requested_incompatible_qos());
    if (reader_ == nullptr)
      throw std::runtime_error("no reader on topic " + own_.topic);
    own_.id = to_hex(to_id(reader_->guid()));
    session.discovery.add_own(own_);
  }
  void close(Session& session) override {
    reader_->set_listener(nullptr);
    session.subscriber->delete_datareader(reader_);
    session.discovery.remove_own(own_.id);
    bus_->peers.restart(ends_);
    reader_ = nullptr;
    taken_before_ = taken_;
  }

  void take(const std::function<void(const void*, const SampleInfo&)>& each) override {
    fdds::SampleInfo dds_info;
    while (take_next(dds_info)) {
      SampleInfo info;
      info.writer = to_id(dds_info.sample_identity.writer_guid());
      if (bus_->guard())
        info.sender = sender_of(dds_info.sample_identity.writer_guid());
      if (internal::take_malformed()) {
        add_malformed(dds_info.sample_identity.writer_guid());
      } else if (was_taken(dds_info.sample_identity)) {
        continue;
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
    discovery_->add_incompatible(own_.topic, own_.writer, status.last_policy_id);
  }

 private:
  using Holder = std::unique_ptr<void, void (*)(void*)>;

  // The session is held for this call alone: who takes may write meanwhile.
  bool take_next(fdds::SampleInfo& info) {
    const auto session = bus_->hold();
    return reader_->take_next_sample(scratch_.get(), &info) == ReturnCode_t::RETCODE_OK;
  }

  std::shared_ptr<const Identity> sender_of(const rtps::GUID_t& writer) {
    const auto session = bus_->hold();
    return bus_->session().discovery.identity_of(writer);
  }

  void add_malformed(const rtps::GUID_t& writer) {
    const auto session = bus_->hold();
    bus_->session().discovery.add_malformed(own_.topic, writer);
  }

  // A writer that still lives sends its history again to the reader of a new session.
  bool was_taken(const rtps::SampleIdentity& sample) {
    if (!policies_.transient_local)
      return false;
    const auto number = sample.sequence_number().to64long();
    const auto before = taken_before_.find(sample.writer_guid());
    if (before != taken_before_.end() && number <= before->second)
      return true;
    if (taken_.size() >= kMostWriters && !taken_.contains(sample.writer_guid()))
      taken_.clear();
    taken_[sample.writer_guid()] = number;
    return false;
  }

  // get_key_value() is not supported: what was withdrawn is known by this alone.
  void remember(const rtps::InstanceHandle_t& handle) {
    auto found = last_.find(handle);
    if (found == last_.end())
      found = last_.emplace(handle, Holder(type_.create(), type_.destroy)).first;
    type_.copy(scratch_.get(), found->second.get());
  }

  // Writers come and go for months. Forgetting them costs no more than a sample that comes twice.
  static constexpr std::size_t kMostWriters = 1000;

  std::shared_ptr<Bus> bus_;
  EndpointEntry own_;
  const Policies policies_;
  const TypeInfo& type_;
  fdds::DataReader* reader_ = nullptr;
  Discovery* discovery_ = nullptr;  // of the session
  Holder scratch_;
  std::map<rtps::InstanceHandle_t, Holder> last_;
  // Of each writer the number of the sample that was taken last: now, and when the session began.
  std::map<rtps::GUID_t, std::uint64_t> taken_;
  std::map<rtps::GUID_t, std::uint64_t> taken_before_;
  Ends ends_{Ends::Side::writers};
};

class DdsTransport : public Transport {
 public:
  DdsTransport(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> wake)
      : bus_(std::make_shared<Bus>(options, instance, std::move(wake))) {}

  std::unique_ptr<RawWriter> make_writer(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    check_role(topic, true);
    return std::make_unique<DdsWriter>(bus_, topic, policies, type);
  }
  std::unique_ptr<RawReader> make_reader(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    check_role(topic, false);
    return std::make_unique<DdsReader>(bus_, topic, policies, type);
  }
  std::vector<EndpointEntry> endpoints() const override {
    const auto session = bus_->hold();
    return bus_->session().discovery.endpoints();
  }
  std::vector<std::string> take_troubles() override {
    const auto session = bus_->hold();
    return bus_->session().discovery.take_troubles();
  }
  Malformed take_malformed() override {
    const auto session = bus_->hold();
    return bus_->session().discovery.take_malformed();
  }
  void watch_endpoints(bool watch) override { bus_->watch(watch); }
  std::vector<std::string> silent_peers() const override { return bus_->silent_peers(); }
  void renew() override { bus_->renew_soon(); }
  std::optional<Identity> identity() const override {
    return bus_->guard() ? std::optional(bus_->guard()->own()) : std::nullopt;
  }
  std::string expiry() const override { return bus_->guard() ? bus_->guard()->expiry() : ""; }
  bool is_own(const WriterId& writer) const override {
    const auto session = bus_->hold();
    const WriterId self = to_id(bus_->session().participant->guid());
    return std::equal(writer.begin(), writer.begin() + 12, self.begin());
  }

 private:
  /// Fast DDS would refuse it without a word.
  void check_role(const char* topic, bool writes) const {
    if (!bus_->guard())
      return;
    const std::string why = bus_->guard()->why_not(bus_->guard()->own(), topic, writes);
    if (!why.empty())
      throw std::invalid_argument(why);
  }

  std::shared_ptr<Bus> bus_;
};

}  // namespace

std::unique_ptr<Transport> make_dds_transport(const NodeOptions& options, std::uint64_t instance,
                                              std::shared_ptr<Wake> wake) {
  return std::make_unique<DdsTransport>(options, instance, std::move(wake));
}

}  // namespace saphira::bus::internal
