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
#include <stdexcept>
#include <utility>

#include "dds_network.hpp"
#include "dds_presence.hpp"
#include "dds_types.hpp"
#include "log.hpp"
#include "saphira/bus/program.hpp"

namespace saphira::bus::internal {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

namespace {

constexpr std::uint32_t kMaxDomain = 232;
// After so long a silence somebody may be about to drop us, or we somebody.
constexpr std::chrono::seconds kLongSleep{kLease - std::chrono::seconds(15)};
// A turn of the thread that took so long was a sleep.
constexpr std::chrono::seconds kSleep{1};
// How long a machine that wakes may take until its network is as it was.
constexpr std::chrono::seconds kNetworkReturns{10};

// The period of returning free memory to the system. It takes some ms, for which other threads may
// wait when they allocate.
constexpr std::chrono::seconds kGiveBack{30};

bool is_loopback(const std::string& address) {
  return address.starts_with("127.");
}

}  // namespace

Session::Session(const NodeOptions& options, const std::shared_ptr<Wake>& wake, const Peers& peers,
                 const std::shared_ptr<Machines>& machines, const std::shared_ptr<Guard>& guard)
    : discovery(wake, peers, machines, guard,
                options.profile == Profile::wan ? kProgramsPerPeer : 0) {
  if (options.domain > kMaxDomain)
    throw std::runtime_error("domain " + std::to_string(options.domain) + " is not in [0, " +
                             std::to_string(kMaxDomain) + "]");
  set_up_library();
  auto* factory = fdds::DomainParticipantFactory::get_instance();
  participant =
      factory->create_participant(options.domain, participant_qos(options, mute_, machines, guard),
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
  qos.user_data() = user_data(machines);
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
      guard_(Guard::make(options)),
      machines_(options.profile == Profile::wan
                    ? std::make_shared<Machines>(own_addresses(), peer_addresses(options))
                    : nullptr),
      session_(std::make_unique<Session>(options, wake, peers, machines_, guard_)),
      presence_(std::make_unique<Presence>(peers, instance)),
      addresses_(own_addresses()) {
  add(*presence_);
  thread_ = std::thread([this] { run(); });
}

Bus::~Bus() {
  {
    const std::scoped_lock lock(thread_mutex_);
    ends_ = true;
  }
  ended_.notify_one();
  thread_.join();
  remove(*presence_);
}

void Bus::add(Endpoint& endpoint) {
  const std::unique_lock lock(mutex_);
  endpoint.open(*session_);
  endpoints_.push_back(&endpoint);
}

void Bus::remove(Endpoint& endpoint) {
  const std::unique_lock lock(mutex_);
  std::erase(endpoints_, &endpoint);
  endpoint.close(*session_);
}

void Bus::watch(bool on) {
  const std::unique_lock lock(mutex_);
  watched_ = on;
  session_->discovery.watch(on);
}

void Bus::renew_soon() {
  renewal_due_ = true;
}

std::vector<std::string> Bus::silent_peers() const {
  return machines_ ? machines_->silent(BootClock::now().time_since_epoch())
                   : std::vector<std::string>{};
}

void Bus::run() {
  std::unique_lock lock(thread_mutex_);
  while (!ends_) {
    lock.unlock();
    presence_->tick();
    if (machines_)
      session_->tell_heard(machines_->heard(BootClock::now().time_since_epoch()));
    if (guard_)
      guard_->look(options_.name);
    note_sleep();
    give_back();
    if (renewal_due_)
      renew();
    lock.lock();
    ended_.wait_for(lock, std::chrono::milliseconds(Peers::kTickMs), [this] { return ends_; });
  }
}

void Bus::note_sleep() {
  const auto now = BootClock::now();
  const auto turn = now - std::exchange(last_turn_, now);
  if (turn < kSleep || renewal_due_)
    return;
  if (turn > kLongSleep || presence_->longest_silence(now) > kLongSleep) {
    renewal_due_ = true;
    due_since_ = now;
  }
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

void Bus::renew() {
  // A machine that has just been woken may have no network yet, and a participant never finds one
  // that comes later.
  const auto addresses = own_addresses();
  const bool as_before =
      std::includes(addresses.begin(), addresses.end(), addresses_.begin(), addresses_.end());
  const bool any = std::any_of(addresses.begin(), addresses.end(),
                               [](const std::string& address) { return !is_loopback(address); });
  if (options_.profile != Profile::host && !as_before &&
      (!any || BootClock::now() - due_since_ < kNetworkReturns))
    return;
  if (machines_)
    machines_->forget_told();  // by programs that the new session has to find again
  std::unique_ptr<Session> fresh;
  try {
    fresh = std::make_unique<Session>(options_, wake, peers, machines_, guard_);
  } catch (const std::exception& error) {
    write_log(v1::LOG_WARNING, options_.name + ": " + error.what() + "; tried again");
    return;
  }
  try {
    const std::unique_lock lock(mutex_);
    session_->mute();
    for (Endpoint* endpoint : endpoints_)
      endpoint->close(*session_);
    session_ = std::move(fresh);
    session_->discovery.watch(watched_);
    for (Endpoint* endpoint : endpoints_)
      endpoint->open(*session_);
    addresses_ = addresses;
    renewal_due_ = false;
  } catch (const std::exception& error) {
    // Half of the endpoints are better than a program that nobody restarts, and worse than none.
    write_log(v1::LOG_ERROR, options_.name + ": could not begin anew: " + error.what());
    std::_Exit(kExitBroken);
  }
  write_log(v1::LOG_WARNING, options_.name + ": began anew on the bus");
  wake->signal();
}

}  // namespace saphira::bus::internal
