#include "dds_sieve.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <fastdds/rtps/common/LocatorList.hpp>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "log.hpp"
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
    const bool sent = low->send(buffer, size, begin, end, timeout);
    if (descriptor_.machines && is_announcement(buffer, size))
      announce(low, buffer, size, timeout);
    return sent;
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* buffer,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    const auto sound = static_cast<std::uint32_t>(sound_length(buffer, size));
    if (sound == 0 || (descriptor_.ignore && descriptor_.ignore(sender_of(buffer), remote)) ||
        !plausible(buffer, sound))
      return;
    std::unique_lock<std::mutex> alone;
    if (descriptor_.guard) {
      if (descriptor_.guard->revoked(sender_of(buffer))) {
        const auto gone = farewell(sender_of(buffer));
        pass(next, gone.data(), static_cast<std::uint32_t>(gone.size()), local, remote);
        return;
      }
      if (is_forgeable(buffer, sound))
        return;
      if (is_announcement(buffer, sound) || is_handshake(buffer, sound))
        alone = std::unique_lock(introductions());
    }
    if (descriptor_.machines && remote.kind == LOCATOR_KIND_UDPv4 && is_announcement(buffer, sound))
      descriptor_.machines->hear(rtps::IPLocator::toIPv4string(remote),
                                 BootClock::now().time_since_epoch());
    pass(next, buffer, sound, local, remote);
  }

 private:
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
  /// them is never let in. Programs in one process call each other directly, so one lock serves the
  /// process.
  static std::mutex& introductions() {
    static std::mutex mutex;
    return mutex;
  }

  bool plausible(const rtps::octet* buffer, std::uint32_t size) {
    const std::scoped_lock lock(mutex_);
    return sequences_.plausible(buffer, size, BootClock::now());
  }

  SieveDescriptor descriptor_;
  std::mutex mutex_;  // each port has a thread, and several threads send
  BootClock::time_point announced_;
  std::set<std::pair<std::string, std::uint32_t>> opened_;
  transport::SendResourceList openers_;
  Sequences sequences_;
};

}  // namespace

transport::TransportInterface* SieveDescriptor::create_transport() const {
  return new Sieve(*this);
}

}  // namespace saphira::bus::internal
