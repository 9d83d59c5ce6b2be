#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <memory>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include "dds_discovery.hpp"
#include "dds_guard.hpp"
#include "machines.hpp"
#include "peers.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

class Presence;

/// A participant and what is made of it.
class Session {
 public:
  Session(const NodeOptions& options, const std::shared_ptr<Wake>& wake, const Peers& peers,
          const std::shared_ptr<Machines>& machines, const std::shared_ptr<Guard>& guard);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  eprosima::fastdds::dds::Topic* topic(const char* name, const char* type);

  /// Ends without a farewell. The others drop what is silent when its lease is over; told of its
  /// end while they still send it what it missed, they may come to a deadlock (Fast DDS 2.9:
  /// matched_reader_remove against a writer's asynchronous thread).
  void mute() { *mute_ = true; }

  /// Tells the others from which machines this program hears announcements.
  void tell_heard(const std::string& machines);

  Discovery discovery;
  eprosima::fastdds::dds::DomainParticipant* participant = nullptr;
  eprosima::fastdds::dds::Publisher* publisher = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber = nullptr;

 private:
  void close();

  std::string told_heard_;
  const std::shared_ptr<std::atomic<bool>> mute_ = std::make_shared<std::atomic<bool>>(false);
};

/// Something of a session that is made again in the next one.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  virtual void open(Session& session) = 0;
  /// Before the session ends.
  virtual void close(Session& session) = 0;
};

/// What the endpoints of a node share; lives as long as the last of them. Ten times a second its
/// thread tells the others that this program is there, and looks whether they are.
///
/// A program that stood still for about as long as the lease of discovery, or longer, may have been
/// dropped by the others without having dropped them, and would not be heard again by some (Fast
/// DDS 2.9). It notices that it stood still and begins anew, with a participant that nobody knows.
class Bus {
 public:
  Bus(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> wake);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Opens it, now and in each session to come.
  void add(Endpoint& endpoint);
  void remove(Endpoint& endpoint);

  /// While it is held, the session is the same.
  std::shared_lock<std::shared_mutex> hold() const { return std::shared_lock(mutex_); }
  Session& session() const { return *session_; }
  const std::string& robot() const { return options_.robot; }
  /// As after a long sleep.
  void renew_soon();
  /// None on an open bus.
  const std::shared_ptr<Guard>& guard() const { return guard_; }
  /// Named peers from which nothing was heard lately.
  std::vector<std::string> silent_peers() const;

  const std::shared_ptr<Wake> wake;
  Peers peers;
  /// Whether a change of endpoints() wakes the node.
  void watch(bool on);

 private:
  void run();
  void note_sleep();
  void give_back();
  void renew();

  const NodeOptions options_;
  const std::shared_ptr<Guard> guard_;
  const std::shared_ptr<Machines> machines_;  // wan alone
  mutable std::shared_mutex mutex_;  // exclusive for who changes the session or the endpoints
  std::unique_ptr<Session> session_;
  std::unique_ptr<Presence> presence_;
  std::vector<Endpoint*> endpoints_;
  bool watched_ = false;
  std::set<std::string> addresses_;  // of this machine, when the session began

  std::mutex thread_mutex_;
  std::condition_variable ended_;
  bool ends_ = false;
  std::atomic<bool> renewal_due_{false};
  BootClock::time_point due_since_;
  BootClock::time_point last_turn_ = BootClock::now();
  BootClock::time_point gave_back_ = last_turn_;
  std::thread thread_;
};

}  // namespace saphira::bus::internal
