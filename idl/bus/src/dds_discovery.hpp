#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dds_guard.hpp"
#include "entrance.hpp"
#include "internal.hpp"
#include "machines.hpp"
#include "peers.hpp"

namespace saphira::bus::internal {

/// The discovered programs and endpoints, and the mismatches. Filled by Fast DDS's threads.
class Discovery : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  /// most_here: programs of this machine that others can find [0: any number].
  /// machines: gets the machines that each program hears; may be null.
  /// guard: identifies each program; entrance: learns which are let in; none on an open bus.
  Discovery(std::shared_ptr<Wake> wake, Peers& peers, std::shared_ptr<Machines> machines,
            std::shared_ptr<Guard> guard, std::shared_ptr<Entrance> entrance, std::size_t most_here)
      : wake_(std::move(wake)),
        peers_(peers),
        machines_(std::move(machines)),
        guard_(std::move(guard)),
        entrance_(std::move(entrance)),
        most_here_(most_here) {}
  ~Discovery() override;
  Discovery(Discovery&&) = delete;
  Discovery& operator=(Discovery&&) = delete;

  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant* /*participant*/,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void onParticipantAuthentication(
      eprosima::fastdds::dds::DomainParticipant* /*participant*/,
      eprosima::fastrtps::rtps::ParticipantAuthenticationInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant* /*participant*/,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant* /*participant*/,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;

  /// Fast DDS found an endpoint on the other side of this topic that does not match, by this
  /// policy. Fast DDS repeats that at each announcement, and may report it before our endpoint is
  /// made or the other one is discovered.
  void add_incompatible(const std::string& topic, bool own_writes,
                        eprosima::fastdds::dds::QosPolicyId_t policy);
  /// A sample that is not of the topic's type.
  void add_malformed(const std::string& topic, const eprosima::fastrtps::rtps::GUID_t& writer);
  void add_own(const EndpointEntry& own);
  void remove_own(const std::string& id);

  /// As Node has it.
  std::string bar() const;

  /// The identity of a sample's writer, as far as discovery knows; none on an open bus.
  std::shared_ptr<const Identity> identity_of(const eprosima::fastrtps::rtps::GUID_t& writer) const;

  /// As Transport has them.
  std::vector<EndpointEntry> endpoints() const;
  std::vector<ProgramEntry> programs() const;
  std::vector<std::string> take_troubles();
  Refusals take_refusals();
  void watch(bool on) { watched_ = on; }

 private:
  struct Program {
    std::string name;
    std::string host;
    std::string robot;
    std::string program;
    std::uint32_t pid = 0;  ///< 0: not built on this library
    std::string contract;
    int discovered = 0;  ///< times found minus times dropped
    std::chrono::steady_clock::time_point found = std::chrono::steady_clock::now();
    std::string subject;                       ///< announced; empty on an open bus
    std::shared_ptr<const Identity> identity;  ///< none on an open bus
  };

  EndpointEntry with_program(const eprosima::fastrtps::rtps::GUID_t& guid,
                             EndpointEntry endpoint) const;

  struct Incompatible {
    std::string topic;
    bool own_writes = false;
    std::string policy;
    // NOLINTNEXTLINE(modernize-use-nullptr): it is the compiler that compares with 0
    auto operator<=>(const Incompatible&) const = default;
  };

  /// Logs each pair of endpoints once; where no pair explains the mismatch in time, the policy
  /// once. False: not yet.
  bool tell_incompatible(const Incompatible& found, bool late, std::vector<std::string>& texts);

  void count_programs_here();
  void tell_refused(const eprosima::fastrtps::rtps::GuidPrefix_t& prefix, const Program& program);
  void tell_contract(const Program& program);
  /// The reason why a program may not have this endpoint, in words; empty: it may, or is not known.
  std::string why_denied(const eprosima::fastrtps::rtps::GUID_t& guid,
                         const EndpointEntry& endpoint) const;
  void tell_forbidden(const eprosima::fastrtps::rtps::GUID_t& guid, const EndpointEntry& endpoint);

  template <class Proxy>
  void put(const Proxy& proxy, bool writer, bool removed);
  void changed();

  const std::shared_ptr<Wake> wake_;
  Peers& peers_;
  const std::shared_ptr<Machines> machines_;
  const std::shared_ptr<Guard> guard_;
  const std::shared_ptr<Entrance> entrance_;
  const std::size_t most_here_;
  std::atomic<bool> watched_{false};
  mutable std::mutex mutex_;
  std::map<eprosima::fastrtps::rtps::GuidPrefix_t, Program> programs_;
  std::map<eprosima::fastrtps::rtps::GUID_t, EndpointEntry> endpoints_;
  std::vector<EndpointEntry> own_;
  std::map<Incompatible, std::chrono::steady_clock::time_point> incompatible_;  ///< since when
  std::set<std::pair<std::string, std::string>> told_;
  std::vector<std::string> troubles_;
  Refusals refusals_;
  std::string other_site_;  ///< to which a program says that it belongs
  int refused_told_ = 0;
  bool type_check_due_ = false;
};

}  // namespace saphira::bus::internal
