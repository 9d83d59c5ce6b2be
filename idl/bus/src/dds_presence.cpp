#include "dds_presence.hpp"

#include <chrono>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <set>
#include <stdexcept>

#include "dds_convert.hpp"
#include "dds_qos.hpp"
#include "dds_types.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus::internal {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

Presence::Presence(Peers& peers, std::uint64_t instance, fdds::Topic* topic,
                   fdds::Publisher* publisher, fdds::Subscriber* subscriber)
    : peers_(peers), instance_(instance), publisher_(publisher), subscriber_(subscriber) {
  const Policies policies = internal::policies(topics::kPresence.qos, false);
  fdds::DataWriterQos writer_qos = fdds::DATAWRITER_QOS_DEFAULT;
  set_common_qos(writer_qos, policies, policies.writer_depth);
  writer_qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
  fdds::DataReaderQos reader_qos = fdds::DATAREADER_QOS_DEFAULT;
  set_common_qos(reader_qos, policies, policies.reader_depth);
  if (topic != nullptr) {
    writer_ = publisher_->create_datawriter(topic, writer_qos, nullptr, fdds::StatusMask::none());
    reader_ = subscriber_->create_datareader(topic, reader_qos, this,
                                             fdds::StatusMask::subscription_matched());
  }
  if (writer_ == nullptr || reader_ == nullptr)
    throw std::runtime_error(std::string("no writer or reader on topic ") + topics::kPresence.name);
  thread_ = std::thread([this] { run(); });
}

Presence::~Presence() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  ended_.notify_one();
  thread_.join();
  reader_->set_listener(nullptr);
  subscriber_->delete_datareader(reader_);
  publisher_->delete_datawriter(writer_);
}

void Presence::on_subscription_matched(fdds::DataReader* /*reader*/,
                                       const fdds::SubscriptionMatchedStatus& status) {
  const auto program = Peers::program_of(to_id(status.last_publication_handle));
  if (status.current_count_change > 0)
    peers_.expect(program);
  else
    peers_.forget(program);
}

void Presence::run() {
  v1::Presence own;
  own.instance() = instance_;
  std::unique_lock lock(mutex_);
  while (!ends_) {
    ++own.count();
    writer_->write(&own);
    std::set<Peers::Program> heard;
    v1::Presence sample;
    fdds::SampleInfo info;
    while (reader_->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK)
      if (info.valid_data && !take_malformed())
        heard.insert(Peers::program_of(to_id(info.sample_identity.writer_guid())));
    peers_.tick(heard);
    ended_.wait_for(lock, std::chrono::milliseconds(Peers::kTickMs));
  }
}

}  // namespace saphira::bus::internal
