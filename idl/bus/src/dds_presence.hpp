#pragma once

#include <array>
#include <cstdint>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <map>
#include <mutex>

#include "dds_bus.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus::internal {

/// Announces the presence of this program, and watches that of the others.
///
/// Presence detects processes that are gone. A program that is slow in one cycle is not gone, so a
/// thread beside its loop sends the presence. Fast DDS's liveliness and deadline do not fit: after
/// a program's own sleep they report all others as dead.
class Presence : public Endpoint {
 public:
  /// instance: as in ServiceStatus.
  Presence(Peers& peers, std::uint64_t instance);

  void open(Session& session, bool after_sleep) override;
  void close(Session& session) override;

  /// Ten times a second, from one thread.
  void tick();
  /// The longest silence among the expected programs.
  BootClock::duration longest_silence(BootClock::time_point now) const;

 private:
  /// Its endpoints on one side.
  struct Part : eprosima::fastdds::dds::DataReaderListener {
    void on_subscription_matched(
        eprosima::fastdds::dds::DataReader* /*reader*/,
        const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override {
      owner->matched(side, status);
    }
    Presence* owner = nullptr;
    Side side = Side::local;
    eprosima::fastdds::dds::DataWriter* writer = nullptr;
    eprosima::fastdds::dds::DataReader* reader = nullptr;
  };
  void matched(Side side, const eprosima::fastdds::dds::SubscriptionMatchedStatus& status);

  Peers& peers_;
  v1::Presence own_;
  std::mutex parts_mutex_;     // before mutex_
  std::array<Part, 2> parts_;  // by Side
  mutable std::mutex mutex_;
  struct Heard {
    Side side = Side::local;
    BootClock::time_point last;
  };
  std::map<Peers::Program, Heard> heard_;
};

}  // namespace saphira::bus::internal
