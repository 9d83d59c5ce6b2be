#pragma once

#include <condition_variable>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <mutex>
#include <thread>

#include "peers.hpp"

namespace saphira::bus::internal {

/// Says ten times a second that this program is there, and notices which others do not.
///
/// It has a thread of its own: this is about processes that are gone, and a program that is slow
/// in one cycle is not. Neither Fast DDS's liveliness nor a deadline does it: they take a program
/// that slept for a witness of everybody else's death.
class Presence : public eprosima::fastdds::dds::DataReaderListener {
 public:
  /// instance: as in ServiceStatus. The topic's entities must outlive this.
  Presence(Peers& peers, std::uint64_t instance, eprosima::fastdds::dds::Topic* topic,
           eprosima::fastdds::dds::Publisher* publisher,
           eprosima::fastdds::dds::Subscriber* subscriber);
  ~Presence() override;
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

  void on_subscription_matched(
      eprosima::fastdds::dds::DataReader* /*reader*/,
      const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override;

 private:
  void run();

  Peers& peers_;
  const std::uint64_t instance_;
  eprosima::fastdds::dds::Publisher* const publisher_;
  eprosima::fastdds::dds::Subscriber* const subscriber_;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace saphira::bus::internal
