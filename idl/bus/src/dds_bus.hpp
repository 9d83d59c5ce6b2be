#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include "addresses.hpp"
#include "dds_discovery.hpp"
#include "dds_guard.hpp"
#include "dds_network.hpp"
#include "machines.hpp"
#include "peers.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

class Presence;

/// A participant on one side, and the objects made from it.
class Session {
 public:
  /// std::runtime_error where it cannot be made.
  Session(const NodeOptions& options, Side side, const std::shared_ptr<Wake>& wake, Peers& peers,
          const std::shared_ptr<Machines>& machines, const std::shared_ptr<Guard>& guard,
          const Fleet& fleet);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  eprosima::fastdds::dds::Topic* topic(const char* name, const char* type);

  /// Ends without a farewell. The others drop a silent participant when its lease is over. If they
  /// learn of its end while they still send it missed samples, they may come to a deadlock (Fast
  /// DDS 2.9: matched_reader_remove against a writer's asynchronous thread).
  void mute() { *mute_ = true; }

  /// Tells the others from which machines this program hears announcements.
  void tell_heard(const std::string& machines);

  const Side side;
  const std::shared_ptr<Entrance> entrance;  ///< none on an open bus
  Discovery discovery;
  eprosima::fastdds::dds::DomainParticipant* participant = nullptr;
  eprosima::fastdds::dds::Publisher* publisher = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber = nullptr;

 private:
  void close();

  const NodeOptions& options_;
  std::string told_heard_;
  const std::shared_ptr<std::atomic<bool>> mute_ = std::make_shared<std::atomic<bool>>(false);
};

/// An object that has a part in each session, made again in the next one.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  /// after_sleep: the session before ended because this program slept.
  virtual void open(Session& session, bool after_sleep) = 0;
  /// Before the session ends. Also of a session in which it was not opened.
  virtual void close(Session& session) = 0;
};

/// The state that the endpoints of a node share; lives as long as the last of them. Ten times a
/// second its thread announces this program's presence, and checks that of the others.
///
/// There is a session on loopback, for the programs of this machine, and with the profiles lan and
/// wan one on the network, as soon as the machine has an address. When it gets another address, the
/// session on the network is made anew, and the one on loopback goes on.
///
/// A program that stood still for about as long as the lease of discovery, or longer, may have been
/// dropped by the others without having dropped them. Some would not hear it again (Fast DDS 2.9).
/// So the program detects the pause and begins anew, with participants that nobody knows.
class Bus {
 public:
  Bus(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> wake);
  ~Bus();

  /// Opens it, now and in each session to come.
  void add(Endpoint& endpoint);
  void remove(Endpoint& endpoint);

  /// The sessions do not change while the lock is held.
  std::shared_lock<std::shared_mutex> hold() const { return std::shared_lock(mutex_); }
  /// The existing sessions, under hold().
  template <class Each>
  void each_session(Each&& each) const {
    for (const auto& session : sessions_)
      if (session)
        each(*session);
  }
  const std::string& robot() const { return options_.robot; }
  /// Begins anew soon, as after a long sleep.
  void renew_soon();
  /// None on an open bus.
  const std::shared_ptr<Guard>& guard() const { return guard_; }
  /// As Census has them.
  std::vector<OtherProgram> others() const { return fleet_.others(BootClock::now()); }
  /// Named peers that were silent lately.
  std::vector<std::string> silent_peers() const;
  /// In words, the missing address: this machine's or that of a named peer.
  std::vector<std::string> waits() const;

  const std::shared_ptr<Wake> wake;
  Peers peers;
  /// True where a change of endpoints() wakes the node.
  void watch(bool on);

 private:
  struct Names;

  void run();
  void note_sleep();
  void give_back();
  void look_at_network();
  void tell_waits(std::chrono::nanoseconds now);
  std::unique_ptr<Session> make(Side side);
  void renew(Side side, bool after_sleep);
  void replace(Side side, std::unique_ptr<Session> fresh, bool after_sleep);
  void retire(std::unique_ptr<Session> old);
  std::unique_ptr<Session>& session(Side side) { return sessions_[static_cast<std::size_t>(side)]; }

  const NodeOptions options_;
  const Fleet fleet_;
  const std::shared_ptr<Guard> guard_;
  const std::shared_ptr<Machines> machines_;  // wan alone
  const std::shared_ptr<Names> names_;        // wan alone
  mutable std::shared_mutex
      mutex_;                   // exclusive for changes of a session or of an endpoint's part in it
  std::mutex endpoints_mutex_;  // before mutex_
  std::array<std::unique_ptr<Session>, 2> sessions_;  // by Side
  std::unique_ptr<Presence> presence_;
  std::vector<Endpoint*> endpoints_;
  bool watched_ = false;
  mutable std::mutex addresses_mutex_;
  Addresses addresses_;  // of this machine
  BootClock::time_point waits_since_;
  std::string told_;  // the waits in the last log message
  int turns_ = 0;

  std::mutex thread_mutex_;
  std::condition_variable ended_;
  bool ends_ = false;
  std::atomic<bool> renewal_due_{false};
  BootClock::time_point last_turn_ = BootClock::now();
  BootClock::time_point gave_back_ = last_turn_;
  std::thread thread_;
  std::thread retiring_;  // of the session before
};

}  // namespace saphira::bus::internal
