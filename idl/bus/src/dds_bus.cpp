#include "dds_bus.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/qos/PublisherQos.hpp>
#include <fastdds/dds/subscriber/qos/SubscriberQos.hpp>
#include <random>
#include <ranges>
#include <stdexcept>
#include <utility>

#include "dds_presence.hpp"
#include "dds_types.hpp"
#include "log.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/program.hpp"

namespace saphira::bus::internal {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

namespace {

// The highest domain: above it, port numbers would exceed 65535.
constexpr std::uint32_t kMaxDomain = 231;
// After a silence of this length, other programs may drop this one, or this one them.
constexpr std::chrono::seconds kLongSleep{kLease - std::chrono::seconds(15)};
// A turn of the thread that took this long was a sleep.
constexpr std::chrono::seconds kSleep{1};
// Turns of the thread between two looks at the machine's addresses.
constexpr int kTurnsToLook = 2;
// The time after which a wait for the network is logged.
constexpr std::chrono::seconds kTellWait{3};
// Between two lookups of the names of silent peers.
constexpr std::chrono::seconds kLookUp{5};

// The period of returning free memory to the system. It takes some ms, for which other threads may
// wait when they allocate.
constexpr std::chrono::seconds kGiveBack{30};

}  // namespace

/// Looks up the addresses of the peers, in a thread of its own: a lookup may take seconds.
struct Bus::Names {
  static void look_up(std::shared_ptr<Names> names, std::shared_ptr<Machines> machines,
                      const std::vector<std::string>& peers) {
    if (peers.empty() || names->busy.exchange(true))
      return;
    std::thread([names = std::move(names), machines = std::move(machines), peers] {
      for (const std::string& peer : peers)
        if (const std::string address = internal::look_up(peer); !address.empty())
          machines->name(peer, address);
      names->busy = false;
    }).detach();
  }

  std::atomic<bool> busy{false};
  BootClock::time_point looked;
};

Session::Session(const NodeOptions& options, Side the_side, const std::shared_ptr<Wake>& wake,
                 Peers& peers, const std::shared_ptr<Machines>& machines,
                 const std::shared_ptr<Guard>& guard, const Fleet& fleet)
    : side(the_side),
      // Strangers must not know the seed: it decides which of them displace each other.
      entrance(
          guard ? std::make_shared<Entrance>(std::random_device{}(),
                                             !guard->seal().has_keys() ? Entrance::Seal::unknown
                                             : guard->seal_required()  ? Entrance::Seal::required
                                                                       : Entrance::Seal::preferred)
                : nullptr),
      // Each side hears of its own programs; those of this machine are heard on loopback.
      discovery(wake, peers, side == Side::network ? machines : nullptr, guard, entrance,
                side == Side::local && options.profile == Profile::wan ? kProgramsPerPeer : 0),
      options_(options) {
  if (options.domain > kMaxDomain)
    throw std::runtime_error("domain " + std::to_string(options.domain) + " is not in [0, " +
                             std::to_string(kMaxDomain) + "]");
  set_up_library();
  auto* factory = fdds::DomainParticipantFactory::get_instance();
  participant = factory->create_participant(
      options.domain,
      participant_qos(options, side, mute_, side == Side::network ? machines : nullptr, guard,
                      entrance, fleet),
      &discovery, fdds::StatusMask::none());
  if (participant == nullptr)
    throw std::runtime_error("no participant on domain " + std::to_string(options.domain) +
                             ": Fast DDS refused the settings" +
                             (guard ? " or the credentials in " + options.security : ""));
  for (auto& type : all_types())
    type.register_type(participant);
  fdds::PublisherQos publisher_qos = fdds::PUBLISHER_QOS_DEFAULT;
  fdds::SubscriberQos subscriber_qos = fdds::SUBSCRIBER_QOS_DEFAULT;
  if (!options.robot.empty()) {
    publisher_qos.partition().push_back(options.robot.c_str());
    subscriber_qos.partition().push_back(options.robot.c_str());
  }
  if (participant->enable() == ReturnCode_t::RETCODE_OK) {
    if (entrance)  // it hears its own announcements
      entrance->let_in(Entrance::prefix_at(participant->guid().guidPrefix.value));
    publisher = participant->create_publisher(publisher_qos);
    subscriber = participant->create_subscriber(subscriber_qos);
  }
  if (publisher == nullptr || subscriber == nullptr) {
    close();
    throw std::runtime_error("no bus on domain " + std::to_string(options.domain) +
                             ": no network socket could be opened for it");
  }
}

Session::~Session() {
  close();
}

void Session::close() {
  participant->set_listener(nullptr);
  participant->delete_contained_entities();
  fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

void Session::tell_heard(const std::string& machines) {
  if (machines == told_heard_)
    return;
  fdds::DomainParticipantQos qos = participant->get_qos();
  qos.user_data() = user_data(options_, machines);
  if (participant->set_qos(qos) == ReturnCode_t::RETCODE_OK)
    told_heard_ = machines;
}

fdds::Topic* Session::topic(const char* name, const char* type) {
  if (auto* description = participant->lookup_topicdescription(name))
    return dynamic_cast<fdds::Topic*>(description);
  return participant->create_topic(name, type, fdds::TOPIC_QOS_DEFAULT);
}

Bus::Bus(const NodeOptions& options, std::uint64_t instance, std::shared_ptr<Wake> the_wake)
    : wake(std::move(the_wake)),
      peers(wake),
      options_(options),
      fleet_(options_),
      guard_(Guard::make(options)),
      machines_(options.profile == Profile::wan ? std::make_shared<Machines>() : nullptr),
      names_(options.profile == Profile::wan ? std::make_shared<Names>() : nullptr),
      presence_(std::make_unique<Presence>(peers, instance)),
      addresses_(options.interface) {
  if (machines_)
    for (const std::string& peer : options.peers)
      machines_->name(peer, is_address(peer) ? peer : std::string());
  session(Side::local) = make(Side::local);
  add(*presence_);
  look_at_network();
  thread_ = std::thread([this] { run(); });
}

Bus::~Bus() {
  {
    const std::scoped_lock lock(thread_mutex_);
    ends_ = true;
  }
  ended_.notify_one();
  thread_.join();
  if (retiring_.joinable())
    retiring_.join();
  remove(*presence_);
}

void Bus::add(Endpoint& endpoint) {
  const std::scoped_lock list(endpoints_mutex_);
  const std::unique_lock lock(mutex_);
  try {
    each_session([&](Session& session) { endpoint.open(session, false); });
  } catch (...) {
    each_session([&](Session& session) { endpoint.close(session); });
    throw;
  }
  endpoints_.push_back(&endpoint);
}

void Bus::remove(Endpoint& endpoint) {
  const std::scoped_lock list(endpoints_mutex_);
  const std::unique_lock lock(mutex_);
  std::erase(endpoints_, &endpoint);
  each_session([&](Session& session) { endpoint.close(session); });
}

void Bus::watch(bool on) {
  const std::unique_lock lock(mutex_);
  watched_ = on;
  each_session([&](Session& session) { session.discovery.watch(on); });
}

void Bus::renew_soon() {
  renewal_due_ = true;
}

std::vector<std::string> Bus::silent_peers() const {
  return machines_ ? machines_->silent(BootClock::now().time_since_epoch())
                   : std::vector<std::string>{};
}

std::vector<std::string> Bus::waits() const {
  std::vector<std::string> all;
  if (options_.profile == Profile::host)
    return all;
  {
    const std::scoped_lock lock(addresses_mutex_);
    if (std::string wait = addresses_.wait(); !wait.empty())
      all.push_back(std::move(wait));
  }
  if (machines_)
    for (const std::string& peer : machines_->unknown())
      all.push_back("the address of peer " + peer +
                    " is not known: no host of this name was found; it is looked up again");
  return all;
}

void Bus::run() {
  std::unique_lock lock(thread_mutex_);
  while (!ends_) {
    lock.unlock();
    presence_->tick();
    if (guard_)
      guard_->look(options_.name);
    note_sleep();
    give_back();
    if (renewal_due_.exchange(false)) {
      if (machines_)
        machines_->forget_told();  // by programs that the new session has to find again
      renew(Side::local, true);
      renew(Side::network, true);
      write_log(v1::LOG_WARNING, options_.name, "began anew on the bus");
    }
    if (++turns_ % kTurnsToLook == 0)
      look_at_network();
    lock.lock();
    ended_.wait_for(lock, std::chrono::milliseconds(Peers::kTickMs), [this] { return ends_; });
  }
}

void Bus::note_sleep() {
  const auto now = BootClock::now();
  const auto turn = now - std::exchange(last_turn_, now);
  if (turn >= kSleep && (turn > kLongSleep || presence_->longest_silence(now) > kLongSleep))
    renewal_due_ = true;
}

// Makes the session on the network when the machine has an address for it, and keeps the names of
// peers.
void Bus::look_at_network() {
  if (options_.profile == Profile::host)
    return;
  const auto now = BootClock::now();
  const auto time = now.time_since_epoch();
  const Addresses::Devices seen = network_addresses();
  bool due = false;
  {
    const std::scoped_lock lock(addresses_mutex_);
    due = addresses_.due(seen, time);
  }
  if (machines_) {
    const auto own = std::views::keys(seen);
    machines_->be({own.begin(), own.end()});
    if (now - names_->looked >= kLookUp || names_->looked == BootClock::time_point()) {
      names_->looked = now;
      std::vector<std::string> sought = machines_->unknown();
      for (std::string& peer : machines_->silent(time))
        if (!is_address(peer))
          sought.push_back(std::move(peer));
      Names::look_up(names_, machines_, sought);
    }
  }
  if (due)
    renew(Side::network, false);
  if (machines_) {
    const auto lock = hold();
    if (const auto& network = sessions_[static_cast<std::size_t>(Side::network)])
      network->tell_heard(machines_->heard(time));
  }
  tell_waits(time);
}

void Bus::tell_waits(std::chrono::nanoseconds now) {
  const std::string text = joined(waits(), "; ");
  if (text == told_) {
    waits_since_ = {};
    return;
  }
  const BootClock::time_point here{std::chrono::duration_cast<BootClock::duration>(now)};
  if (waits_since_ == BootClock::time_point())
    waits_since_ = here;
  if (!text.empty() && here - waits_since_ < kTellWait)
    return;
  waits_since_ = {};
  told_ = text;
  if (text.empty())
    write_log(v1::LOG_INFO, options_.name, "is on the network");
  else
    write_log(v1::LOG_WARNING, options_.name, text);
}

// A burst of samples or goals leaves free memory between blocks that are in use. malloc alone never
// returns it to the system.
void Bus::give_back() {
#ifdef __GLIBC__
  if (last_turn_ - gave_back_ < kGiveBack)
    return;
  gave_back_ = last_turn_;
  ::malloc_trim(0);
#endif
}

std::unique_ptr<Session> Bus::make(Side side) {
  return std::make_unique<Session>(options_, side, wake, peers, machines_, guard_, fleet_);
}

void Bus::renew(Side side, bool after_sleep) {
  if (side == Side::network && options_.profile == Profile::host)
    return;
  if (side == Side::network) {
    const std::scoped_lock lock(addresses_mutex_);
    // A machine that has just been woken may have no network yet: look_at_network() will see it.
    if (addresses_.usable().empty() && after_sleep && !session(side))
      return;
  }
  std::unique_ptr<Session> fresh;
  try {
    fresh = make(side);
  } catch (const std::exception& error) {
    write_log(v1::LOG_WARNING, options_.name, std::string(error.what()) + "; tried again");
    if (side == Side::local) {
      renewal_due_ = true;
      return;
    }
    const std::scoped_lock lock(addresses_mutex_);
    addresses_.failed(BootClock::now().time_since_epoch());
    return;
  }
  replace(side, std::move(fresh), after_sleep);
  if (side == Side::network) {
    const std::scoped_lock lock(addresses_mutex_);
    addresses_.made();
  }
  wake->signal();
}

// One endpoint after the other, so that a write waits for one at the most.
void Bus::replace(Side side, std::unique_ptr<Session> fresh, bool after_sleep) {
  const std::scoped_lock list(endpoints_mutex_);
  std::unique_ptr<Session>& current = session(side);
  if (current)
    current->mute();
  fresh->discovery.watch(watched_);
  try {
    for (Endpoint* endpoint : endpoints_) {
      const std::unique_lock lock(mutex_);
      if (current)
        endpoint->close(*current);
      endpoint->open(*fresh, after_sleep);
    }
  } catch (const std::exception& error) {
    // A program with half of its endpoints is better than one that nobody restarts, and worse than
    // one that has ended.
    write_log(v1::LOG_ERROR, options_.name, std::string("could not begin anew: ") + error.what());
    std::_Exit(kExitBroken);
  }
  {
    const std::unique_lock lock(mutex_);
    std::swap(current, fresh);
  }
  retire(std::move(fresh));
}

// In a thread of its own: the end of a session may take long, and the others need not wait.
void Bus::retire(std::unique_ptr<Session> old) {
  if (!old)
    return;
  if (retiring_.joinable())
    retiring_.join();
  retiring_ = std::thread([old = std::move(old)]() mutable { old.reset(); });
}

}  // namespace saphira::bus::internal
