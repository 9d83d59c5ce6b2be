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
  own_.instance = instance;
  for (Part& part : parts_)
    part.owner = this;
}

void Presence::open(Session& session, bool /*after_sleep*/) {
  const std::scoped_lock parts(parts_mutex_);
  Part& part = parts_[static_cast<std::size_t>(session.side)];
  part.side = session.side;
  const Policies policies = internal::policies(topics::kPresence.qos, false);
  fdds::DataWriterQos writer_qos = fdds::DATAWRITER_QOS_DEFAULT;
  set_common_qos(writer_qos, policies, policies.writer_depth);
  writer_qos.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
  fdds::DataReaderQos reader_qos = fdds::DATAREADER_QOS_DEFAULT;
  set_common_qos(reader_qos, policies, policies.reader_depth);
  auto* topic = session.topic(topics::kPresence.name, type_of<v1::Presence>().name);
  if (topic != nullptr) {
    part.writer =
        session.publisher->create_datawriter(topic, writer_qos, nullptr, fdds::StatusMask::none());
    part.reader = session.subscriber->create_datareader(topic, reader_qos, &part,
                                                        fdds::StatusMask::subscription_matched());
  }
  if (part.writer == nullptr || part.reader == nullptr)
    throw std::runtime_error(std::string("no writer or reader on topic ") + topics::kPresence.name);
}

void Presence::close(Session& session) {
  const std::scoped_lock parts(parts_mutex_);
  Part& part = parts_[static_cast<std::size_t>(session.side)];
  if (part.reader != nullptr) {
    part.reader->set_listener(nullptr);
    session.subscriber->delete_datareader(part.reader);
  }
  if (part.writer != nullptr)
    session.publisher->delete_datawriter(part.writer);
  part.reader = nullptr;
  part.writer = nullptr;
  const std::scoped_lock lock(mutex_);
  std::erase_if(heard_, [&](const auto& known) {
    if (known.second.side != session.side)
      return false;
    peers_.forget(known.first);
    return true;
  });
}

void Presence::matched(Side side, const fdds::SubscriptionMatchedStatus& status) {
  const auto program = Peers::program_of(to_id(status.last_publication_handle));
  const std::scoped_lock lock(mutex_);
  if (status.current_count_change > 0) {
    heard_[program] = {side, BootClock::now()};
    peers_.expect(program);
  } else {
    heard_.erase(program);
    peers_.forget(program);
  }
}

void Presence::tick() {
  ++own_.count;
  std::set<Peers::Program> heard;
  {
    const std::scoped_lock parts(parts_mutex_);
    for (const Part& part : parts_) {
      if (part.writer == nullptr || part.reader == nullptr)
        continue;
      // Loopback loses no packets, and on it each program hears every other one of its robot.
      if (part.side == Side::network || own_.count % 2 == 0)
        part.writer->write(&own_);
      v1::Presence sample;
      fdds::SampleInfo info;
      while (part.reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK)
        if (!take_malformed() && info.valid_data)
          heard.insert(Peers::program_of(to_id(info.sample_identity.writer_guid())));
    }
  }
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& program : heard)
      if (const auto known = heard_.find(program); known != heard_.end())
        known->second.last = BootClock::now();
  }
  peers_.tick(heard);
}

BootClock::duration Presence::longest_silence(BootClock::time_point now) const {
  const std::scoped_lock lock(mutex_);
  BootClock::duration longest{0};
  for (const auto& [program, known] : heard_)
    longest = std::max(longest, now - known.last);
  return longest;
}

}  // namespace saphira::bus::internal
