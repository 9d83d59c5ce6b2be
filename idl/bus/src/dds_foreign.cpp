// Topics of other systems over Fast DDS.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <cstring>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <stdexcept>
#include <utility>

#include "dds_convert.hpp"
#include "dds_network.hpp"
#include "dds_qos.hpp"
#include "saphira/bus/foreign.hpp"

namespace saphira::bus {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;
using internal::to_id;

// Programs of one machine that announcements to 127.0.0.1 find, where others do without multicast.
constexpr std::uint32_t kProgramsOfMachine = 32;
constexpr int kAnnouncement = 1000;  // [ms]
constexpr int kHeartbeat = 200;      // [ms]
constexpr std::uint32_t kUsualSize = 512;

/// Samples as bytes, with their encapsulation.
class Bytes : public fdds::TopicDataType {
 public:
  explicit Bytes(const std::string& name) {
    setName(name.c_str());
    m_typeSize = kUsualSize;  // buffers grow
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const std::string*>(data);
    if (bytes.size() > payload->max_size)
      return false;
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(payload->data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data),
                                            payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] {
      return static_cast<std::uint32_t>(static_cast<const std::string*>(data)->size());
    };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*force_md5*/) override {
    return false;
  }
};

std::vector<rtps::octet> octets(const std::string& text) {
  return {text.begin(), text.end()};
}

rtps::GUID_t guid_of(const WriterId& id) {
  rtps::GUID_t guid;
  std::copy_n(id.begin(), 12, guid.guidPrefix.value);
  std::copy_n(id.begin() + 12, 4, guid.entityId.value);
  return guid;
}

SampleId id_of(const rtps::SampleIdentity& identity) {
  return {to_id(identity.writer_guid()), identity.sequence_number().to64long()};
}

template <class Q>
void set_qos(Q& qos, const ForeignTopic& topic) {
  internal::set_common_qos(
      qos, {.reliable = topic.reliable, .transient_local = topic.transient_local}, topic.depth);
  qos.user_data().setValue(octets(topic.user_data));
}

struct Listener : fdds::DataReaderListener {
  explicit Listener(const std::function<void()>& on_data) : wake(on_data) {}
  void on_data_available(fdds::DataReader* /*reader*/) override { wake(); }
  const std::function<void()>& wake;
};

class FastWriter : public Foreign::Writer {
 public:
  FastWriter(fdds::Publisher& publisher, fdds::Topic* topic, const ForeignTopic& about)
      : publisher_(publisher) {
    fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
    set_qos(qos, about);
    qos.reliability().max_blocking_time = internal::milliseconds(100);
    qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
    qos.reliable_writer_qos().times.heartbeatPeriod = internal::milliseconds(kHeartbeat);
    writer_ = topic == nullptr ? nullptr : publisher_.create_datawriter(topic, qos);
    if (writer_ == nullptr)
      throw std::runtime_error("no writer on topic " + about.name);
  }
  ~FastWriter() override { publisher_.delete_datawriter(writer_); }
  FastWriter& operator=(FastWriter&&) = delete;

  bool write(const std::string& bytes, const SampleId* answers) override {
    auto* const data = const_cast<std::string*>(&bytes);  // it is only read
    if (answers == nullptr)
      return writer_->write(data);
    rtps::WriteParams how;
    how.related_sample_identity().writer_guid(guid_of(answers->writer));
    how.related_sample_identity().sequence_number(rtps::SequenceNumber_t(answers->number));
    return writer_->write(data, how);
  }
  std::size_t matched() const override {
    fdds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return static_cast<std::size_t>(status.current_count);
  }
  WriterId id() const override { return to_id(writer_->guid()); }

 private:
  fdds::Publisher& publisher_;
  fdds::DataWriter* writer_ = nullptr;
};

class FastReader : public Foreign::Reader {
 public:
  FastReader(fdds::Subscriber& subscriber, fdds::Topic* topic, const ForeignTopic& about,
             const std::function<void()>& wake)
      : subscriber_(subscriber), listener_(wake) {
    fdds::DataReaderQos qos = fdds::DATAREADER_QOS_DEFAULT;
    set_qos(qos, about);
    reader_ = topic == nullptr ? nullptr
                               : subscriber_.create_datareader(topic, qos, &listener_,
                                                               fdds::StatusMask::data_available());
    if (reader_ == nullptr)
      throw std::runtime_error("no reader on topic " + about.name);
  }
  ~FastReader() override {
    reader_->set_listener(nullptr);
    subscriber_.delete_datareader(reader_);
  }
  FastReader& operator=(FastReader&&) = delete;

  std::vector<ForeignSample> take() override {
    std::vector<ForeignSample> samples;
    fdds::SampleInfo info;
    std::string bytes;
    while (reader_->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK)
      if (info.valid_data)
        samples.push_back(
            {bytes, id_of(info.sample_identity), id_of(info.related_sample_identity)});
    return samples;
  }
  std::size_t matched() const override {
    fdds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return static_cast<std::size_t>(status.current_count);
  }
  WriterId id() const override { return to_id(reader_->guid()); }

 private:
  fdds::Subscriber& subscriber_;
  Listener listener_;
  fdds::DataReader* reader_ = nullptr;
};

}  // namespace

struct Foreign::Impl {
  explicit Impl(std::function<void()> on_data) : wake(std::move(on_data)) {}
  ~Impl() {
    if (participant == nullptr)
      return;
    participant->delete_contained_entities();
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }
  Impl& operator=(Impl&&) = delete;

  fdds::Topic* topic(const ForeignTopic& about) const {
    fdds::TypeSupport(new Bytes(about.type)).register_type(participant);
    if (auto* description = participant->lookup_topicdescription(about.name))
      return dynamic_cast<fdds::Topic*>(description);
    return participant->create_topic(about.name, about.type, fdds::TOPIC_QOS_DEFAULT);
  }

  const std::function<void()> wake;
  fdds::DomainParticipant* participant = nullptr;
  fdds::Publisher* publisher = nullptr;
  fdds::Subscriber* subscriber = nullptr;
};

Foreign::Foreign(const Options& options, std::function<void()> wake)
    : impl_(std::make_unique<Impl>(std::move(wake))) {
  internal::set_up_library();
  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  qos.name(options.name);
  qos.user_data().setValue(octets(options.user_data));
  // Shared memory of another version of Fast DDS would be misread; UDP is understood by all.
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  if (!options.interface.empty())
    udp->interfaceWhiteList.push_back(options.interface);
  udp->maxInitialPeersRange = kProgramsOfMachine;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.leaseDuration_announcementperiod = internal::milliseconds(kAnnouncement);
  for (const char* const place : {"239.255.0.1", "127.0.0.1"}) {
    rtps::Locator_t peer;
    peer.kind = LOCATOR_KIND_UDPv4;
    peer.port = 0;
    rtps::IPLocator::setIPv4(peer, place);
    builtin.initialPeersList.push_back(peer);
  }
  auto* const factory = fdds::DomainParticipantFactory::get_instance();
  impl_->participant = factory->create_participant(options.domain, qos);
  if (impl_->participant != nullptr && impl_->participant->enable() == ReturnCode_t::RETCODE_OK) {
    impl_->publisher = impl_->participant->create_publisher(fdds::PUBLISHER_QOS_DEFAULT);
    impl_->subscriber = impl_->participant->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT);
  }
  if (impl_->publisher == nullptr || impl_->subscriber == nullptr)
    throw std::runtime_error("no participant for other systems on domain " +
                             std::to_string(options.domain) +
                             ": no network socket could be opened for it");
}

Foreign::~Foreign() = default;

WriterId Foreign::id() const {
  return to_id(impl_->participant->guid());
}

std::unique_ptr<Foreign::Writer> Foreign::writer(const ForeignTopic& topic) {
  return std::make_unique<FastWriter>(*impl_->publisher, impl_->topic(topic), topic);
}

std::unique_ptr<Foreign::Reader> Foreign::reader(const ForeignTopic& topic) {
  return std::make_unique<FastReader>(*impl_->subscriber, impl_->topic(topic), topic, impl_->wake);
}

}  // namespace saphira::bus
