#include "liar.hpp"

#include <condition_variable>
#include <fastdds/dds/core/status/StatusMask.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <mutex>
#include <thread>
#include <utility>

#include "dds_bus.hpp"
#include "dds_presence.hpp"
#include "dds_qos.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus::test {

namespace fdds = eprosima::fastdds::dds;

struct Liar::Impl {
  Impl(const NodeOptions& options, std::string the_allowed)
      : allowed(std::move(the_allowed)),
        wake(std::make_shared<internal::Wake>()),
        peers(wake),
        session(options, internal::Side::local, wake, peers, nullptr,
                internal::Guard::make(options), internal::Fleet(options)) {
    presence.open(session, false);
    ticks = std::jthread([this](const std::stop_token& stop) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      const std::chrono::milliseconds period(internal::Peers::kTickMs);
      do
        presence.tick();
      while (!std::condition_variable_any().wait_for(lock, stop, period,
                                                     [&] { return stop.stop_requested(); }));
    });
  }
  ~Impl() {
    ticks = {};
    presence.close(session);
  }
  Impl(Impl&&) = delete;
  Impl& operator=(Impl&&) = delete;

  const std::string allowed;
  const std::shared_ptr<internal::Wake> wake;
  internal::Peers peers;
  internal::Session session;
  /// As of any program that is there; by an instance of its own.
  internal::Presence presence{peers, reinterpret_cast<std::uintptr_t>(this)};
  std::jthread ticks;
};

namespace {

// Fast DDS adds the true one behind it, and takes the first.
template <class EndpointQos>
void lie(EndpointQos& qos, const std::string& topic) {
  qos.properties().properties().emplace_back("topic_name", topic);
}

}  // namespace

Liar::Liar(const NodeOptions& options, std::string allowed_topic)
    : impl_(std::make_unique<Impl>(options, std::move(allowed_topic))) {}

Liar::~Liar() = default;

bool Liar::add(const std::string& name, bool writes) {
  bool made = false;
  for_each_topic([&]<class T>(const Topic<T>& topic) {
    if (topic.name != name)
      return;
    const internal::Policies policies = internal::policies(topic.qos, false);
    auto* const dds_topic = impl_->session.topic(topic.name, type_of<T>().name);
    if (writes) {
      fdds::DataWriterQos qos = fdds::DATAWRITER_QOS_DEFAULT;
      set_common_qos(qos, policies, policies.writer_depth);
      lie(qos, impl_->allowed);
      made = impl_->session.publisher->create_datawriter(dds_topic, qos, nullptr,
                                                         fdds::StatusMask::none()) != nullptr;
    } else {
      fdds::DataReaderQos qos = fdds::DATAREADER_QOS_DEFAULT;
      set_common_qos(qos, policies, policies.reader_depth);
      lie(qos, impl_->allowed);
      made = impl_->session.subscriber->create_datareader(dds_topic, qos, nullptr,
                                                          fdds::StatusMask::none()) != nullptr;
    }
  });
  return made;
}

}  // namespace saphira::bus::test
