#include "dds_sieve.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <fastdds/rtps/common/LocatorList.hpp>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "introduction.hpp"
#include "log.hpp"
#include "saphira/security/documents.hpp"
#include "sieve.hpp"

namespace saphira::bus::internal {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
namespace transport = eprosima::fastdds::rtps;

// Between two announcements of a program.
constexpr std::chrono::milliseconds kOnce{50};

class Sieve : public transport::ChainingTransport {
 public:
  explicit Sieve(const SieveDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(rtps::SenderResource* low, const rtps::octet* buffer, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) override {
    if (*descriptor_.mute)
      return true;
    if (!is_announcement(buffer, size))
      return low->send(buffer, size, begin, end, timeout);
    if (!is_due(buffer, size))
      return true;
    std::vector<rtps::octet> sealed(buffer, buffer + size);
    if (descriptor_.guard)
      descriptor_.guard->seal().close(sealed, seal_time());
    const auto length = static_cast<std::uint32_t>(sealed.size());
    const bool sent = low->send(sealed.data(), length, begin, end, timeout);
    if (descriptor_.machines)
      announce(low, sealed.data(), length, timeout);
    return sent;
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* buffer,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    security::Seal::Opened opened{size, std::nullopt};
    if (descriptor_.guard)
      opened = descriptor_.guard->seal().open(buffer, size);
    const auto sound = static_cast<std::uint32_t>(sound_length(buffer, opened.size));
    if (sound == 0 || (descriptor_.ignore && descriptor_.ignore(sender_of(buffer), remote)))
      return;
    if (!plausible(buffer, sound)) {
      // Of a member too, after a while without a network.
      if (descriptor_.guard && !descriptor_.entrance->is_in(Entrance::prefix_at(sender_of(buffer))))
        drop(remote);
      return;
    }
    const bool announces = is_announcement(buffer, sound);
    if (announces && !meets(buffer, sound, !descriptor_.guard || opened.sealed)) {
      hear(remote);
      return;
    }
    const bool introduces = announces || (descriptor_.guard && is_handshake(buffer, sound));
    std::unique_lock<std::mutex> alone(introductions(), std::defer_lock);
    if (introduces)
      alone.lock();
    if (descriptor_.guard) {
      const Entrance::Prefix sender = Entrance::prefix_at(sender_of(buffer));
      if (const std::string member = descriptor_.guard->revoked(sender.data()); !member.empty()) {
        drop(remote, "they use the certificate of " + member + ", which is revoked");
        // Fast DDS 2.9 may hang where it forgets a participant in its handshake.
        if (descriptor_.entrance->is_in(sender))
          pass(next, farewell(sender.data()), local, remote);
        return;
      }
      if (!speaks_for_itself(buffer, sound)) {
        if (!is_farewell(buffer, sound))
          drop(remote);
        else if (opened.sealed && says_own_end(sender, remote))
          pass(next, farewell(sender.data()), local, remote);
        return;
      }
      const auto fate = fate_of(sender, announces, introduces, opened.sealed, remote);
      if (fate == Entrance::Fate::drops)
        return;
      if (introduces && !announces)
        descriptor_.entrance->limit(
            sender, security::robot_of({reinterpret_cast<const char*>(buffer), sound}));
      if (announces) {
        std::vector<rtps::octet> own(buffer, buffer + sound);
        if (fate == Entrance::Fate::waits)
          set_lease(own.data(), own.size(), Entrance::kLease);
        else
          renumber(own.data(), own.size());  // so that its own lease counts again
        hear(remote);
        pass(next, own, local, remote);
        return;
      }
    }
    if (announces)
      hear(remote);
    pass(next, buffer, sound, local, remote);
  }

 private:
  static std::string address_of(const rtps::Locator_t& place) {
    return place.kind == LOCATOR_KIND_UDPv4 ? rtps::IPLocator::toIPv4string(place) : "";
  }

  Entrance::Fate fate_of(const Entrance::Prefix& sender, bool announces, bool introduces,
                         std::optional<std::int64_t> sealed, const rtps::Locator_t& from) const {
    const auto now = BootClock::now();
    std::optional<Entrance::Sealed> seal;
    if (sealed)
      seal = {std::chrono::seconds(*sealed), std::chrono::seconds(unix_seconds() - *sealed)};
    return announces    ? descriptor_.entrance->announced(sender, address_of(from), now, seal)
           : introduces ? descriptor_.entrance->shakes_hands(sender, now)
                        : descriptor_.entrance->sends(sender, now);
  }

  /// True where a sealed farewell is of one that was let in. Fast DDS's encrypted farewell gets
  /// lost where not all keys were exchanged yet, as of a short command, which would then stay for
  /// its lease. The seal keeps strangers from it, and the address the members of other machines.
  bool says_own_end(const Entrance::Prefix& sender, const rtps::Locator_t& from) const {
    return descriptor_.entrance->is_in(sender) &&
           descriptor_.entrance->address_of(sender) == address_of(from);
  }

  /// Counts a dropped packet.
  void drop(const rtps::Locator_t& from, const std::string& proof = {}) const {
    descriptor_.entrance->drop(address_of(from), BootClock::now(), proof);
  }

  /// [s] since 1970. It never goes back, whatever the clock does: others take an announcement that
  /// is older than the one before for a repeated one.
  std::int64_t seal_time() {
    const std::scoped_lock lock(mutex_);
    return newest_seal_ = std::max(newest_seal_, unix_seconds());
  }

  /// An announcement from that machine.
  void hear(const rtps::Locator_t& remote) const {
    if (descriptor_.machines && remote.kind == LOCATOR_KIND_UDPv4)
      descriptor_.machines->hear(rtps::IPLocator::toIPv4string(remote),
                                 BootClock::now().time_since_epoch());
  }

  static void pass(transport::TransportReceiverInterface* next,
                   const std::vector<rtps::octet>& message, const rtps::Locator_t& local,
                   const rtps::Locator_t& remote) {
    pass(next, message.data(), static_cast<std::uint32_t>(message.size()), local, remote);
  }
  static void pass(transport::TransportReceiverInterface* next, const rtps::octet* buffer,
                   std::uint32_t size, const rtps::Locator_t& local,
                   const rtps::Locator_t& remote) {
    try {
      next->OnDataReceived(buffer, size, local, remote);
    } catch (const std::exception& error) {
      write_log(v1::LOG_DEBUG, "Fast DDS", std::string("dropped a packet: ") + error.what());
    }
  }

  /// To the other machines. Fast DDS sends each announcement several times at once.
  void announce(rtps::SenderResource* low, const rtps::octet* buffer, std::uint32_t size,
                const std::chrono::steady_clock::time_point& timeout) {
    rtps::LocatorList_t places = due_places();
    if (places.empty())
      return;
    rtps::Locators begin(places.begin());
    rtps::Locators end(places.end());
    low->send(buffer, size, &begin, &end, timeout);
  }

  /// Empty where the program has just announced itself.
  rtps::LocatorList_t due_places() {
    rtps::LocatorList_t places;
    const auto now = BootClock::now();
    const std::scoped_lock lock(mutex_);
    if (now - announced_ < kOnce)
      return places;
    announced_ = now;
    for (const std::string& address : descriptor_.machines->others(now.time_since_epoch()))
      for (const std::uint32_t port : descriptor_.ports) {
        rtps::Locator_t place;
        rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, address, port, place);
        // An assertion of Fast DDS's statistics requires that each place was opened.
        if (opened_.emplace(address, port).second)
          low_level_transport_->OpenOutputChannel(openers_, place);
        places.push_back(place);
      }
    return places;
  }

  /// Fast DDS 2.9 prepares a handshake in variables that the threads of all ports share, without a
  /// lock (SecurityManager::match_builtin_endpoints). Where two programs are found at once, one of
  /// them is never let in. On an open bus each thread that finds a program takes one of four spare
  /// proxies and then waits for the readers of discovery, which wait for a spare proxy: four
  /// threads at once never end (EDPSimple::assignRemoteEndpoints). Programs in one process call
  /// each other directly, so one lock serves the process.
  static std::mutex& introductions() {
    static std::mutex mutex;
    return mutex;
  }

  bool plausible(const rtps::octet* buffer, std::uint32_t size) {
    const std::scoped_lock lock(mutex_);
    return sequences_.plausible(buffer, size, BootClock::now());
  }

  /// True where an own announcement is to be sent.
  bool is_due(const rtps::octet* buffer, std::uint32_t size) {
    const auto own = announced(buffer, size);
    const std::scoped_lock lock(mutex_);
    return !own || descriptor_.fleet.is_due(own->data, BootClock::now());
  }

  /// True for the announcement or farewell of a program that this one exchanges with. `proven`: of
  /// a member of the site.
  bool meets(const rtps::octet* buffer, std::uint32_t size, bool proven) {
    const auto other = announced(buffer, size);
    if (!other)
      return true;
    const std::scoped_lock lock(mutex_);
    if (!descriptor_.fleet.meets(*other)) {
      if (proven)
        descriptor_.fleet.note(*other, BootClock::now());
      return false;
    }
    const auto* const prefix = reinterpret_cast<const char*>(sender_of(buffer));
    descriptor_.fleet.hear({prefix, Entrance::Prefix{}.size()}, BootClock::now());
    return true;
  }

  SieveDescriptor descriptor_;
  std::mutex mutex_;  // each port has a thread, and several threads send
  BootClock::time_point announced_;
  std::int64_t newest_seal_ = 0;
  std::set<std::pair<std::string, std::uint32_t>> opened_;
  transport::SendResourceList openers_;
  Sequences sequences_;
};

}  // namespace

transport::TransportInterface* SieveDescriptor::create_transport() const {
  return new Sieve(*this);
}

}  // namespace saphira::bus::internal
