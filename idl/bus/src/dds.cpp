// The bus over Fast DDS. Only the files dds* use Fast DDS.

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
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
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "dds_bus.hpp"
#include "dds_convert.hpp"
#include "dds_qos.hpp"
#include "dds_types.hpp"
#include "internal.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/format.hpp"

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

/// The part of a reader or writer in one session.
template <class Listener>
struct Part : Listener {
  explicit Part(Ends::Side side) : ends(side) {}
  void count(const WriterId& other, int change) {
    if (change > 0)
      bus->peers.match(ends, other);
    else
      bus->peers.unmatch(ends, other);
  }

  Bus* bus = nullptr;
  const std::string* topic = nullptr;
  Discovery* discovery = nullptr;
  std::string id;
  Ends ends;
};

struct WriterPart : Part<fdds::DataWriterListener> {
  WriterPart() : Part(Ends::Side::readers) {}
  void on_publication_matched(fdds::DataWriter* /*writer*/,
                              const fdds::PublicationMatchedStatus& status) override {
    count(to_id(status.last_subscription_handle), status.current_count_change);
  }
  void on_offered_incompatible_qos(fdds::DataWriter* /*writer*/,
                                   const fdds::OfferedIncompatibleQosStatus& status) override {
    discovery->add_incompatible(*topic, true, status.last_policy_id);
  }

  fdds::DataWriter* writer = nullptr;
};

struct ReaderPart : Part<fdds::DataReaderListener> {
  ReaderPart() : Part(Ends::Side::writers) {}
  void on_data_available(fdds::DataReader* /*reader*/) override { bus->wake->signal(); }
  void on_subscription_matched(fdds::DataReader* /*reader*/,
                               const fdds::SubscriptionMatchedStatus& status) override {
    count(to_id(status.last_publication_handle), status.current_count_change);
  }
  void on_requested_incompatible_qos(fdds::DataReader* /*reader*/,
                                     const fdds::RequestedIncompatibleQosStatus& status) override {
    discovery->add_incompatible(*topic, false, status.last_policy_id);
  }

  fdds::DataReader* reader = nullptr;
};

/// The common part of readers and writers. In a session that is missing or cannot be made yet, an
/// endpoint has no part.
template <class OnePart>
class DdsEnd : public Endpoint {
 protected:
  DdsEnd(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
         const TypeInfo& type, bool writer)
      : bus_(std::move(bus)),
        own_(own_entry(bus_->robot(), topic, type, policies, writer)),
        policies_(policies),
        type_(type) {
    for (OnePart& part : parts_) {
      part.bus = bus_.get();
      part.topic = &own_.topic;
      bus_->peers.add(part.ends);
    }
  }
  ~DdsEnd() override {
    for (OnePart& part : parts_)
      bus_->peers.remove(part.ends);
  }
  DdsEnd& operator=(DdsEnd&&) = delete;

  OnePart& part_of(const Session& session) {
    return parts_[static_cast<std::size_t>(session.side)];
  }
  void add_own(Session& session, OnePart& part, const rtps::GUID_t& guid) const {
    EndpointEntry own = own_;
    own.id = part.id = hex_text(to_id(guid));
    session.discovery.add_own(own);
  }
  void remove_own(Session& session, OnePart& part) const {
    session.discovery.remove_own(part.id);
    bus_->peers.restart(part.ends);
  }
  std::size_t present() const { return parts_[0].ends.present() + parts_[1].ends.present(); }

  const std::shared_ptr<Bus> bus_;
  const EndpointEntry own_;
  const Policies policies_;
  const TypeInfo& type_;
  std::array<OnePart, 2> parts_;  // by Side
};

/// Copies of the newest samples of each key, which a writer holds for readers that come later.
class Kept {
 public:
  void put(const TypeInfo& type, const void* sample, int depth) {
    auto& samples = samples_[type.key(sample)];
    Sample copy(type.create(), type.destroy);
    type.copy(sample, copy.get());
    samples.push_back(std::move(copy));
    if (samples.size() > static_cast<std::size_t>(depth))
      samples.pop_front();
  }
  void erase(const TypeInfo& type, const void* sample) { samples_.erase(type.key(sample)); }
  /// Of each key the oldest first.
  template <class Each>
  void each(Each&& each) const {
    for (const auto& [key, samples] : samples_)
      for (const Sample& sample : samples)
        each(sample.get());
  }

 private:
  using Sample = std::unique_ptr<void, void (*)(void*)>;

  std::map<InstanceKey, std::deque<Sample>> samples_;
};

class DdsWriter : public RawWriter, public DdsEnd<WriterPart> {
 public:
  DdsWriter(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
            const TypeInfo& type)
      : DdsEnd(std::move(bus), topic, policies, type, true) {
    bus_->add(*this);
  }
  ~DdsWriter() override { bus_->remove(*this); }
  DdsWriter& operator=(DdsWriter&&) = delete;

  void open(Session& session, bool after_sleep) override {
    auto& part = part_of(session);
    part.discovery = &session.discovery;
    fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
    set_common_qos(qos, policies_, policies_.writer_depth);
    qos.reliability().max_blocking_time = milliseconds(100);
    // Of the writer alone: a reader would compare the clocks of two machines.
    if (policies_.lifespan_ms > 0)
      qos.lifespan().duration = milliseconds(policies_.lifespan_ms);
    qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
    // dispose() is to withdraw and to forget. A writer that ends withdraws nothing by that (Fast
    // DDS does not unregister then).
    qos.writer_data_lifecycle().autodispose_unregistered_instances = true;
    if (policies_.heartbeat_ms > 0)
      qos.reliable_writer_qos().times.heartbeatPeriod = milliseconds(policies_.heartbeat_ms);
    if (auto* topic = session.topic(own_.topic.c_str(), type_.name))
      part.writer = session.publisher->create_datawriter(
          topic, qos, &part,
          fdds::StatusMask::publication_matched() << fdds::StatusMask::offered_incompatible_qos());
    if (part.writer == nullptr)
      throw std::runtime_error("no writer on topic " + own_.topic);
    add_own(session, part, part.writer->guid());
    if (!after_sleep || policies_.kept_by_session)
      kept_.each([&](const void* sample) { part.writer->write(const_cast<void*>(sample)); });
  }
  void close(Session& session) override {
    auto& part = part_of(session);
    if (part.writer == nullptr)
      return;
    part.writer->set_listener(nullptr);
    session.publisher->delete_datawriter(part.writer);
    remove_own(session, part);
    part.writer = nullptr;
  }

  // Fast DDS takes a writable pointer and only reads it.
  bool write(const void* sample) override {
    const auto session = bus_->hold();
    if (keeps())
      kept_.put(type_, sample, policies_.writer_depth);
    return each_part(
        [&](fdds::DataWriter& writer) { return writer.write(const_cast<void*>(sample)); });
  }
  bool dispose(const void* sample) override {
    const auto session = bus_->hold();
    kept_.erase(type_, sample);
    return each_part([&](fdds::DataWriter& writer) {
      // An instance that another writer has written is withdrawn as well: it has to be made known
      // here first.
      writer.register_instance(const_cast<void*>(sample));
      // Not dispose() alone: after it Fast DDS keeps the instance for ever, here and at the
      // readers.
      return writer.unregister_instance(const_cast<void*>(sample), fdds::HANDLE_NIL) ==
             ReturnCode_t::RETCODE_OK;
    });
  }
  bool wait_acknowledged(int timeout_ms) override {
    // Fast DDS does not say which reader has not acknowledged. A reader that is gone never will.
    // The others have the sample, or have asked for it again, within a few heartbeats.
    constexpr int kSlice = 50;
    constexpr int kHeartbeats = 400;
    for (int waited = 0; waited < timeout_ms; waited += kSlice) {
      const auto session = bus_->hold();
      const int slice = std::min(kSlice, timeout_ms - waited);
      if (each_part([&](fdds::DataWriter& writer) {
            return writer.wait_for_acknowledgments(milliseconds(slice)) == ReturnCode_t::RETCODE_OK;
          }))
        return true;
      const bool absent = std::any_of(parts_.begin(), parts_.end(), [&](const WriterPart& part) {
        return bus_->peers.any_absent(part.ends);
      });
      if (waited + slice >= kHeartbeats && matched() > 0 && absent)
        return true;
    }
    return false;
  }
  std::size_t matched() const override { return present(); }

 private:
  /// True where a later session gets the stored samples again.
  bool keeps() const { return policies_.kept_by_session || policies_.declares(); }
  /// Loopback first. True where it went well in all sessions.
  template <class Do>
  bool each_part(Do&& act) {
    bool well = true;
    for (WriterPart& part : parts_)
      if (part.writer != nullptr && !act(*part.writer))
        well = false;
    return well;
  }

  Kept kept_;
};

class DdsReader : public RawReader, public DdsEnd<ReaderPart> {
 public:
  DdsReader(std::shared_ptr<Bus> bus, const char* topic, const Policies& policies,
            const TypeInfo& type)
      : DdsEnd(std::move(bus), topic, policies, type, false),
        scratch_(type.create(), type.destroy) {
    bus_->add(*this);
  }
  ~DdsReader() override { bus_->remove(*this); }

  void open(Session& session, bool /*after_sleep*/) override {
    auto& part = part_of(session);
    part.discovery = &session.discovery;
    fdds::DataReaderQos qos = fdds::DATAREADER_QOS_DEFAULT;
    set_common_qos(qos, policies_, policies_.reader_depth);
    if (type_.keyed) {
      // With either of the DYNAMIC modes a reader never sees that an instance was withdrawn: the
      // message has no payload, and a buffer of no size is not to be had.
      qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      qos.resource_limits().allocated_samples = 1;
    }
    if (auto* topic = session.topic(own_.topic.c_str(), type_.name))
      part.reader = session.subscriber->create_datareader(
          topic, qos, &part,
          fdds::StatusMask::data_available() << fdds::StatusMask::subscription_matched()
                                             << fdds::StatusMask::requested_incompatible_qos());
    if (part.reader == nullptr)
      throw std::runtime_error("no reader on topic " + own_.topic);
    add_own(session, part, part.reader->guid());
  }
  void close(Session& session) override {
    auto& part = part_of(session);
    if (part.reader == nullptr)
      return;
    part.reader->set_listener(nullptr);
    session.subscriber->delete_datareader(part.reader);
    remove_own(session, part);
    part.reader = nullptr;
    begun_anew_ = true;
  }

  void take(const std::function<void(const void*, const SampleInfo&)>& each) override {
    // Samples that were taken before a session ended are not taken again.
    if (begun_anew_.exchange(false))
      taken_before_ = taken_;
    for (ReaderPart& part : parts_)
      for (const WriterId& writer : bus_->peers.take_returned(part.ends))
        declare_again(writer, each);
    for (ReaderPart& part : parts_)
      take(part, each);
  }

  std::vector<WriterId> take_lost() override {
    std::vector<WriterId> lost = bus_->peers.take_lost(parts_[0].ends);
    const std::vector<WriterId> more = bus_->peers.take_lost(parts_[1].ends);
    lost.insert(lost.end(), more.begin(), more.end());
    // Its history is news again, where a new match sends it.
    for (auto* const taken : {&taken_, &taken_before_})
      std::erase_if(*taken, [&](const auto& one) {
        return std::find(lost.begin(), lost.end(), to_id(one.first)) != lost.end();
      });
    return lost;
  }
  std::size_t matched() const override { return present(); }

 private:
  using Holder = std::unique_ptr<void, void (*)(void*)>;
  struct Last {
    Holder data;
    SampleInfo info;
    rtps::SampleIdentity identity;
    std::int64_t written = 0;  ///< [ns since 1970]
  };

  void declare_again(const WriterId& writer,
                     const std::function<void(const void*, const SampleInfo&)>& each) {
    if (!policies_.declares())
      return;
    for (auto& [instance, last] : last_) {
      if (last.info.writer != writer)
        continue;
      was_taken(last.identity);
      last.info.age = age_of(last.written);
      each(last.data.get(), last.info);
    }
  }

  void take(ReaderPart& part, const std::function<void(const void*, const SampleInfo&)>& each) {
    fdds::SampleInfo dds_info;
    SampleInfo info;
    bool malformed = false;
    while (take_next(part, dds_info, info, malformed)) {
      if (malformed || was_taken(dds_info.sample_identity) || has_waited_too_long(dds_info)) {
        continue;
      } else if (dds_info.valid_data) {
        if (type_.keyed)
          remember(dds_info, info);
        each(scratch_.get(), info);
      } else if (dds_info.instance_state != fdds::ALIVE_INSTANCE_STATE) {
        // "No writers" is the state of an instance whose writer had ended before another one
        // withdrew it. Where the same writer gave it up, the instance stays.
        // Withdrawn before any sample of it was taken: there is nothing to tell.
        const auto found = last_.find(dds_info.instance_handle);
        if (found == last_.end() ||
            (dds_info.instance_state == fdds::NOT_ALIVE_NO_WRITERS_INSTANCE_STATE &&
             found->second.info.writer == info.writer))
          continue;
        const Holder last = std::move(found->second.data);
        last_.erase(found);
        info.disposed = true;
        each(last.get(), info);
      }
    }
  }

  // The session is held for this call alone: the caller may write between calls.
  bool take_next(ReaderPart& part, fdds::SampleInfo& from, SampleInfo& info, bool& malformed) {
    const auto session = bus_->hold();
    if (part.reader == nullptr ||
        part.reader->take_next_sample(scratch_.get(), &from) != ReturnCode_t::RETCODE_OK)
      return false;
    const rtps::GUID_t& writer = from.sample_identity.writer_guid();
    info = {};
    info.writer = to_id(writer);
    info.age = age_of(from.source_timestamp.to_ns());
    if (bus_->guard())
      info.sender = part.discovery->identity_of(writer);
    malformed = internal::take_malformed();
    if (malformed)
      part.discovery->add_malformed(own_.topic, writer);
    return true;
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

  // By this machine's clock alone.
  bool has_waited_too_long(const fdds::SampleInfo& sample) const {
    return policies_.lifespan_ms > 0 && age_of(sample.reception_timestamp.to_ns()) >
                                            1e-3 * static_cast<double>(policies_.lifespan_ms);
  }

  // get_key_value() is not supported: this map alone gives the key of a withdrawn instance.
  void remember(const fdds::SampleInfo& sample, const SampleInfo& info) {
    auto found = last_.find(sample.instance_handle);
    if (found == last_.end() && last_.size() >= kMostInstances)
      forget_oldest(info.writer);
    if (found == last_.end())
      found = last_.emplace(sample.instance_handle, Last{{type_.create(), type_.destroy}, {}, {}})
                  .first;
    Last& last = found->second;
    type_.copy(scratch_.get(), last.data.get());
    last.info = info;
    last.identity = sample.sample_identity;
    last.written = sample.source_timestamp.to_ns();
  }
  /// Of this writer, where it has any, so that none crowds out the others.
  void forget_oldest(const WriterId& writer) {
    last_.erase(std::ranges::min_element(last_, {}, [&](const auto& one) {
      return std::pair(one.second.info.writer != writer, one.second.written);
    }));
  }
  /// [s]
  static double age_of(std::int64_t written) {
    return 1e-9 * static_cast<double>(unix_nanoseconds() - written);
  }

  // Writers come and go for months. A forgotten writer costs at most a sample that comes twice.
  static constexpr std::size_t kMostWriters = 1000;
  // Without its last sample an instance that is withdrawn is not told.
  static constexpr std::size_t kMostInstances = 2000;

  Holder scratch_;
  std::map<rtps::InstanceHandle_t, Last> last_;
  // For each writer the number of the sample that was taken last: now, and at the session's start.
  std::map<rtps::GUID_t, std::uint64_t> taken_;
  std::map<rtps::GUID_t, std::uint64_t> taken_before_;
  std::atomic<bool> begun_anew_{false};
};

class DdsTransport : public Transport {
  /// The results of `say` from the discoveries of all sessions, one after the other.
  template <class Say>
  auto from_each(Say say) const {
    const auto session = bus_->hold();
    std::invoke_result_t<Say, Discovery&> all;
    bus_->each_session([&](Session& one) {
      auto more = std::invoke(say, one.discovery);
      all.insert(all.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
    });
    return all;
  }

 public:
  DdsTransport(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> wake)
      : bus_(std::make_shared<Bus>(options, instance, std::move(wake))) {}

  std::unique_ptr<RawWriter> make_writer(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    if (bus_->guard())
      bus_->guard()->check_own(topic, true);
    return std::make_unique<DdsWriter>(bus_, topic, policies, type);
  }
  std::unique_ptr<RawReader> make_reader(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    if (bus_->guard())
      bus_->guard()->check_own(topic, false);
    return std::make_unique<DdsReader>(bus_, topic, policies, type);
  }
  std::vector<EndpointEntry> endpoints() const override { return from_each(&Discovery::endpoints); }
  std::vector<ProgramEntry> programs() const override { return from_each(&Discovery::programs); }
  std::vector<OtherProgram> others() const override { return bus_->others(); }
  std::vector<std::string> take_troubles() override { return from_each(&Discovery::take_troubles); }
  Refusals take_refusals() override {
    const auto session = bus_->hold();
    Refusals all;
    bus_->each_session([&](Session& one) {
      const Refusals more = one.discovery.take_refusals();
      all.samples += more.samples;
      all.texts.insert(all.texts.end(), more.texts.begin(), more.texts.end());
    });
    return all;
  }
  void watch_endpoints(bool watch) override { bus_->watch(watch); }
  std::vector<std::string> silent_peers() const override { return bus_->silent_peers(); }
  std::vector<std::string> network_waits() const override { return bus_->waits(); }
  void renew() override { bus_->renew_soon(); }
  std::optional<Identity> identity() const override {
    return bus_->guard() ? std::optional(bus_->guard()->own()) : std::nullopt;
  }
  std::vector<std::string> notices() const override {
    std::vector<std::string> all;
    if (!bus_->guard())
      return all;
    all.push_back(bus_->guard()->expiry());
    const auto session = bus_->hold();
    bus_->each_session(
        [&](Session& one) { all.push_back(one.entrance->strangers(BootClock::now())); });
    std::erase(all, "");
    return all;
  }
  std::string bar() const override {
    const auto session = bus_->hold();
    std::string found;
    bus_->each_session([&](Session& one) {
      if (found.empty())
        found = one.discovery.bar();
    });
    return found;
  }
  bool is_own(const WriterId& writer) const override {
    const auto session = bus_->hold();
    bool own = false;
    bus_->each_session([&](Session& one) {
      const WriterId self = to_id(one.participant->guid());
      own = own || std::equal(writer.begin(), writer.begin() + 12, self.begin());
    });
    return own;
  }

 private:
  std::shared_ptr<Bus> bus_;
};

}  // namespace

std::unique_ptr<Transport> make_dds_transport(const NodeOptions& options, std::uint64_t instance,
                                              std::shared_ptr<Wake> wake) {
  return std::make_unique<DdsTransport>(options, instance, std::move(wake));
}

}  // namespace saphira::bus::internal
