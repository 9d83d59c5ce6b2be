#include "dds_sieve.hpp"

#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>

#include "log.hpp"
#include "sieve.hpp"

namespace saphira::bus::internal {
namespace {

namespace rtps = eprosima::fastrtps::rtps;
namespace transport = eprosima::fastdds::rtps;

class Sieve : public transport::ChainingTransport {
 public:
  explicit Sieve(const SieveDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(rtps::SenderResource* low, const rtps::octet* buffer, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) override {
    return *descriptor_.mute || low->send(buffer, size, begin, end, timeout);
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* buffer,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    const auto sound = static_cast<std::uint32_t>(sound_length(buffer, size));
    if (sound == 0 || !plausible(buffer, sound))
      return;
    try {
      next->OnDataReceived(buffer, sound, local, remote);
    } catch (const std::exception& error) {
      write_log(v1::LOG_DEBUG, std::string("dropped a packet: ") + error.what());
    }
  }

 private:
  bool plausible(const rtps::octet* buffer, std::uint32_t size) {
    const std::scoped_lock lock(mutex_);
    return sequences_.plausible(buffer, size);
  }

  SieveDescriptor descriptor_;
  std::mutex mutex_;  // each port has a thread
  Sequences sequences_;
};

}  // namespace

transport::TransportInterface* SieveDescriptor::create_transport() const {
  return new Sieve(*this);
}

}  // namespace saphira::bus::internal
