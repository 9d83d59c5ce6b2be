#include "raw_writer.hpp"

#include <atomic>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/publisher/qos/PublisherQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <stdexcept>

#include "cdr.hpp"
#include "dds_network.hpp"
#include "node_options.hpp"

namespace saphira::bus::test {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

using Bytes = std::vector<std::uint8_t>;

class AnyBytes : public fdds::TopicDataType {
 public:
  AnyBytes(const std::string& name, bool keyed) {
    setName(name.c_str());
    m_typeSize = 4096;
    m_isGetKeyDefined = keyed;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const Bytes*>(data);
    payload->length = static_cast<std::uint32_t>(bytes.size());
    if (!bytes.empty())
      std::memcpy(payload->data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* /*payload*/, void* /*data*/) override {
    return false;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* handle, bool /*force_md5*/) override {
    handle->value[0] = 1;
    return true;
  }
};

}  // namespace

struct RawWriter::Impl {
  fdds::DomainParticipant* participant = nullptr;
  fdds::DataWriter* writer = nullptr;
};

RawWriter::RawWriter(const std::string& robot, const std::string& topic, const std::string& type,
                     bool keyed)
    : impl_(std::make_unique<Impl>()) {
  internal::set_up_library();
  const NodeOptions options = saphira::test::node_options("raw", robot);
  auto* factory = fdds::DomainParticipantFactory::get_instance();
  impl_->participant = factory->create_participant(
      options.domain, internal::participant_qos(options, internal::Side::local,
                                                std::make_shared<std::atomic<bool>>(false), nullptr,
                                                nullptr, nullptr, internal::Fleet(options)));
  fdds::TypeSupport(new AnyBytes(type, keyed)).register_type(impl_->participant);
  impl_->participant->enable();
  fdds::PublisherQos publisher_qos = fdds::PUBLISHER_QOS_DEFAULT;
  publisher_qos.partition().push_back(robot.c_str());
  fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = fdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().depth = 100;
  qos.resource_limits().max_samples = 0;
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.data_sharing().off();
  impl_->writer =
      impl_->participant->create_publisher(publisher_qos)
          ->create_datawriter(
              impl_->participant->create_topic(topic, type, fdds::TOPIC_QOS_DEFAULT), qos);
  if (impl_->writer == nullptr)
    throw std::runtime_error("no raw writer");
}

RawWriter::~RawWriter() {
  impl_->participant->delete_contained_entities();
  fdds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

bool RawWriter::matched() const {
  fdds::PublicationMatchedStatus status;
  impl_->writer->get_publication_matched_status(status);
  return status.current_count > 0;
}

bool RawWriter::write(Bytes bytes) {
  return impl_->writer->write(&bytes);
}

bool RawWriter::write(Bytes bytes, double ahead) {
  eprosima::fastrtps::Time_t now;
  eprosima::fastrtps::Time_t::now(now);
  const double time = static_cast<double>(now.to_ns()) * 1e-9 + ahead;
  return impl_->writer->write_w_timestamp(&bytes, fdds::HANDLE_NIL,
                                          eprosima::fastrtps::Time_t(time)) ==
         eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
}

namespace {

template <class Sample>
Bytes bytes_of(const Sample& sample) {
  Bytes bytes(internal::cdr_size(sample));
  internal::write_cdr(sample, reinterpret_cast<char*>(bytes.data()), bytes.size());
  return bytes;
}

}  // namespace

Bytes bytes_of_request(const std::string& functor) {
  return bytes_of(v1::Request{.functor = functor});
}

Bytes bytes_of_motor_command(double velocity, bool active) {
  return bytes_of(v1::MotorCommand{.active = active, .velocity = velocity});
}

}  // namespace saphira::bus::test
