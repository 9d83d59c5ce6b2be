#include "dds_presence.hpp"

#include <algorithm>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <set>
#include <stdexcept>

#include "dds_convert.hpp"
#include "dds_qos.hpp"
#include "dds_types.hpp"

namespace saphira::bus::internal {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

Presence::Presence(Peers& peers, std::uint64_t instance) : peers_(peers) {
  own_.instance() = instance;
}

void Presence::open(Session& session) {
  const Policies policies = internal::policies(topics::kPresence.qos, false);
  fdds::DataWriterQos writer_qos = fdds::DATAWRITER_QOS_DEFAULT;
  set_common_qos(writer_qos, policies, policies.writer_depth);
  writer_qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
  fdds::DataReaderQos reader_qos = fdds::DATAREADER_QOS_DEFAULT;
  set_common_qos(reader_qos, policies, policies.reader_depth);
  auto* topic = session.topic(topics::kPresence.name, type_of<v1::Presence>().name);
  if (topic != nullptr) {
    writer_ =
        session.publisher->create_datawriter(topic, writer_qos, nullptr, fdds::StatusMask::none());
    reader_ = session.subscriber->create_datareader(topic, reader_qos, this,
                                                    fdds::StatusMask::subscription_matched());
  }
  if (writer_ == nullptr || reader_ == nullptr)
    throw std::runtime_error(std::string("no writer or reader on topic ") + topics::kPresence.name);
}

void Presence::close(Session& session) {
  reader_->set_listener(nullptr);
  session.subscriber->delete_datareader(reader_);
  session.publisher->delete_datawriter(writer_);
  reader_ = nullptr;
  writer_ = nullptr;
  const std::scoped_lock lock(mutex_);
  for (const auto& [program, since] : heard_)
    peers_.forget(program);
  heard_.clear();
}

void Presence::on_subscription_matched(fdds::DataReader* /*reader*/,
                                       const fdds::SubscriptionMatchedStatus& status) {
  const auto program = Peers::program_of(to_id(status.last_publication_handle));
  const std::scoped_lock lock(mutex_);
  if (status.current_count_change > 0) {
    heard_[program] = BootClock::now();
    peers_.expect(program);
  } else {
    heard_.erase(program);
    peers_.forget(program);
  }
}

void Presence::tick() {
  ++own_.count();
  writer_->write(&own_);
  std::set<Peers::Program> heard;
  v1::Presence sample;
  fdds::SampleInfo info;
  while (reader_->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK)
    if (!take_malformed() && info.valid_data)
      heard.insert(Peers::program_of(to_id(info.sample_identity.writer_guid())));
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& program : heard)
      if (const auto known = heard_.find(program); known != heard_.end())
        known->second = BootClock::now();
  }
  peers_.tick(heard);
}

BootClock::duration Presence::longest_silence(BootClock::time_point now) const {
  const std::scoped_lock lock(mutex_);
  BootClock::duration longest{0};
  for (const auto& [program, last] : heard_)
    longest = std::max(longest, now - last);
  return longest;
}

}  // namespace saphira::bus::internal
