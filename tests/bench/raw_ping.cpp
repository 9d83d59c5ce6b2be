// A two-hop ping over bare Fast DDS: one process writes a RobotState, another answers from its
// listener with a MotorCommand. The reference for the reaction time of the system: the same
// payloads, QoS and network (best effort, KEEP_LAST 1, UDP on loopback), and nothing between.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bench.hpp"
#include "dds_types.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/topics.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/quantile.hpp"

namespace {

namespace fdds = eprosima::fastdds::dds;
namespace v1 = saphira::v1;
using Clock = std::chrono::steady_clock;

// One side: writes Out, passes each In to a function, in the receiving thread.
template <class Out, class In>
class Side : public fdds::DataReaderListener, public fdds::DataWriterListener {
 public:
  Side(std::uint32_t domain, const char* out, const char* in, std::function<void(const In&)> each)
      : each_(std::move(each)) {
    fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    participant_ = fdds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (participant_ == nullptr)
      throw std::runtime_error("no participant");
    for (const fdds::TypeSupport& type : saphira::bus::internal::all_types())
      type.register_type(participant_);
    auto* out_topic =
        participant_->create_topic(out, saphira::bus::type_of<Out>().name, fdds::TOPIC_QOS_DEFAULT);
    auto* in_topic =
        participant_->create_topic(in, saphira::bus::type_of<In>().name, fdds::TOPIC_QOS_DEFAULT);
    fdds::DataWriterQos writer_qos = fdds::DATAWRITER_QOS_DEFAULT;
    writer_qos.reliability().kind = fdds::BEST_EFFORT_RELIABILITY_QOS;
    writer_qos.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
    writer_qos.data_sharing().off();
    fdds::DataReaderQos reader_qos = fdds::DATAREADER_QOS_DEFAULT;
    reader_qos.data_sharing().off();
    writer_ = participant_->create_publisher(fdds::PUBLISHER_QOS_DEFAULT)
                  ->create_datawriter(out_topic, writer_qos, this);
    reader_ = participant_->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT)
                  ->create_datareader(in_topic, reader_qos, this);
    if (writer_ == nullptr || reader_ == nullptr)
      throw std::runtime_error("no endpoints");
  }
  ~Side() override {
    participant_->delete_contained_entities();
    fdds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  void write(Out& sample) { writer_->write(&sample); }
  bool matched() const { return matches_ == 2; }

  void on_data_available(fdds::DataReader* reader) override {
    fdds::SampleInfo info;
    while (reader->take_next_sample(&in_, &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
      if (info.valid_data)
        each_(in_);
  }
  void on_subscription_matched(fdds::DataReader* /*reader*/,
                               const fdds::SubscriptionMatchedStatus& status) override {
    matches_ += status.current_count_change;
  }
  void on_publication_matched(fdds::DataWriter* /*writer*/,
                              const fdds::PublicationMatchedStatus& status) override {
    matches_ += status.current_count_change;
  }

 private:
  std::function<void(const In&)> each_;
  In in_;
  std::atomic<int> matches_{0};
  fdds::DomainParticipant* participant_ = nullptr;
  fdds::DataWriter* writer_ = nullptr;
  fdds::DataReader* reader_ = nullptr;
};

using Robot = Side<v1::RobotState, v1::MotorCommand>;
using Service = Side<v1::MotorCommand, v1::RobotState>;

// As sent by the bridge and the behaviors on the way to a goal.
v1::RobotState robot_state() {
  v1::RobotState state;
  state.sonars.resize(2);
  return state;
}
v1::MotorCommand motor_command() {
  return {.source = "behaviors"};
}

[[noreturn]] void answer(std::uint32_t domain) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  auto command = motor_command();
  Service* self = nullptr;
  std::mutex ready;
  std::unique_lock lock(ready);
  Service service(domain, "ping/command", "ping/state", [&](const v1::RobotState& state) {
    { const std::scoped_lock wait(ready); }
    command.stamp = state.stamp;
    self->write(command);
  });
  self = &service;
  lock.unlock();
  for (;;)
    pause();
}

std::vector<double> ping(std::uint32_t domain, double hz, int count) {
  std::mutex mutex;
  std::condition_variable arrived;
  std::uint64_t answered = 0;
  Robot robot(domain, "ping/state", "ping/command", [&](const v1::MotorCommand& command) {
    const std::scoped_lock lock(mutex);
    answered = command.stamp.cycle;
    arrived.notify_one();
  });
  auto state = robot_state();
  const auto once = [&](std::uint64_t cycle, std::chrono::milliseconds limit) {
    state.stamp.cycle = cycle;
    const auto start = Clock::now();
    robot.write(state);
    std::unique_lock lock(mutex);
    const bool there = arrived.wait_for(lock, limit, [&] { return answered == cycle; });
    return there ? std::chrono::duration<double, std::micro>(Clock::now() - start).count() : -1.0;
  };
  // The first answers show that both sides have found each other.
  std::uint64_t cycle = 0;
  int warm = 0;
  for (int i = 0; i < 600 && warm < 5; ++i)
    warm += once(++cycle, std::chrono::milliseconds(50)) > 0 ? 1 : 0;
  if (warm < 5)
    throw std::runtime_error("no answer from the other process");
  std::vector<double> us;
  auto next = Clock::now();
  for (int i = 0; i < count; ++i) {
    if (hz > 0) {
      next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / hz));
      std::this_thread::sleep_until(next);
    }
    if (const double took = once(++cycle, std::chrono::milliseconds(1000)); took > 0)
      us.push_back(took);
  }
  return us;
}

}  // namespace

int main(int argc, char** argv) {
  saphira::CommandLine app{"Two-hop ping over bare Fast DDS between two processes"};
  double hz = 10.0;
  int count = 300;
  std::uint32_t domain = 199;
  bool json = false;
  app.add_option("--hz", hz, "Pings a second; 0: one after the other");
  app.add_option("--count", count, "How many");
  app.add_option("--domain", domain, "DDS domain");
  app.add_flag("--json", json, "One object: us (each ping), p50_us, p99_us");
  if (const auto code = app.parse(argc, argv))
    return *code;
  // Before anything of DDS is there: a fork takes no threads along.
  const pid_t child = fork();
  if (child == 0)
    answer(domain);
  int code = 0;
  try {
    const auto us = ping(domain, hz, count);
    saphira::bench::print({{"us", us},
                           {"p50_us", saphira::test::quantile(us, 0.5)},
                           {"p99_us", saphira::test::quantile(us, 0.99)}},
                          json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "saphira-bench-raw-ping: %s\n", error.what());
    code = 1;
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return code;
}
