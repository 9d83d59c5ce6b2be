#pragma once

#include <cstdint>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <map>
#include <mutex>

#include "dds_bus.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus::internal {

/// Says that this program is there, and hears which others are.
///
/// This is about processes that are gone: a program that is slow in one cycle is not, so a thread
/// beside its loop turns it. Neither Fast DDS's liveliness nor a deadline does it: they take a
/// program that slept for a witness of everybody else's death.
class Presence : public Endpoint, public eprosima::fastdds::dds::DataReaderListener {
 public:
  /// instance: as in ServiceStatus.
  Presence(Peers& peers, std::uint64_t instance);

  void open(Session& session) override;
  void close(Session& session) override;

  /// Ten times a second, from one thread.
  void tick();
  /// Of the programs that are expected, the one that was not heard for longest.
  BootClock::duration longest_silence(BootClock::time_point now) const;

  void on_subscription_matched(
      eprosima::fastdds::dds::DataReader* /*reader*/,
      const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;

 private:
  Peers& peers_;
  v1::Presence own_;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
  mutable std::mutex mutex_;
  std::map<Peers::Program, BootClock::time_point> heard_;
};

}  // namespace saphira::bus::internal
