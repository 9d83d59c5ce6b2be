#include "saphira/bus/node.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string_view>
#include <utility>

#include "internal.hpp"
#include "log.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/heartbeat.hpp"
#include "saphira/bus/status_words.hpp"

namespace saphira::bus {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::ptrdiff_t kMostRefused = 64;
constexpr std::size_t kLongestLog = 2000;  // characters

double to_seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// Of the whole process, as are its memory and its id: nodes that share one say the same.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return to_seconds(usage.ru_utime) + to_seconds(usage.ru_stime);
}

double resident_mb() {
  std::array<char, 128> text{};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return 0.0;
  const auto got = read(file, text.data(), text.size() - 1);
  close(file);
  unsigned long total = 0;
  unsigned long resident = 0;
  if (got <= 0 || std::sscanf(text.data(), "%lu %lu", &total, &resident) != 2)
    return 0.0;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

// Grandchildren inherit the environment but not the descriptor: its number may stand for another
// file by then.
int open_pipe() {
  const char* const text = std::getenv(kHeartbeatVariable);
  int fd = -1;
  unsigned long inode = 0;
  struct stat info {};
  if (text == nullptr || std::sscanf(text, "%d:%lu", &fd, &inode) != 2 || fstat(fd, &info) != 0 ||
      !S_ISFIFO(info.st_mode) || info.st_ino != inode)
    return -1;
  fcntl(fd, F_SETFD, FD_CLOEXEC);
  return fd;
}

/// Sends a heartbeat to the supervisor, if there is one. Never waits.
void send(const Heartbeat& beat) {
  static const int fd = open_pipe();
  if (fd >= 0)
      // A full pipe has enough heartbeats. Without a reader the supervisor is gone, and this
      // program will end soon.
      [[maybe_unused]]
    const auto written = write(fd, &beat, sizeof beat);
}

std::uint64_t random_instance() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32U) | device();
}

class TerminalReader : public RawReader {
 public:
  TerminalReader(std::unique_ptr<RawReader> reader, const TypeInfo& type)
      : reader_(std::move(reader)), type_(type), copy_(type.create(), type.destroy) {}

  void take(const std::function<void(const void*, const SampleInfo&)>& each) override {
    reader_->take([&](const void* sample, const SampleInfo& info) {
      type_.copy(sample, copy_.get());
      type_.make_printable(copy_.get());
      each(copy_.get(), info);
    });
  }
  std::vector<WriterId> take_lost() override { return reader_->take_lost(); }
  std::size_t matched() const override { return reader_->matched(); }

 private:
  std::unique_ptr<RawReader> reader_;
  const TypeInfo& type_;
  std::unique_ptr<void, void (*)(void*)> copy_;
};

}  // namespace

struct Node::Impl {
  explicit Impl(NodeOptions the_options) : options(std::move(the_options)) {
    status.instance = random_instance();
  }

  void start() {
    status.name = options.name;
    status.host = internal::host_name();
    status.pid = static_cast<std::uint32_t>(getpid());
    status.state = v1::SERVICE_STARTING;
    status.lockstep = options.lockstep;
    last_cpu = cpu_seconds();
    last_published = started;
    status_writer.emplace(transport->make_writer(
        topics::kStatus.name, internal::policies(topics::kStatus.qos, options.lockstep),
        type_of<v1::ServiceStatus>()));
    log_writer.emplace(transport->make_writer(
        topics::kLog.name, internal::policies(topics::kLog.qos, options.lockstep),
        type_of<v1::LogRecord>()));
    const char* const why = std::getenv(kRestartedVariable);
    if (why != nullptr && *why != 0)
      log(v1::LOG_WARNING, std::string(kStartedAgain) + why);
  }

  // To the supervisor. The bus does not show whether a program is deaf or is not heard.
  void beat(std::uint64_t flags) const {
    if (waits_for_robot(status))
      flags |= Heartbeat::kWaitsForRobot;
    if (writes_robot)
      flags |= Heartbeat::kWritesRobot;
    send({status.instance, status.stamp.epoch, status.stamp.cycle, flags});
  }

  void note_troubles() {
    for (auto& text : transport->take_troubles()) {
      ++health.incompatible;
      log(v1::LOG_ERROR, text);
      health.incompatible_text = std::move(text);
    }
    const internal::Refusals refusals = transport->take_refusals();
    status.refused_samples += refusals.samples;
    for (const auto& text : refusals.texts) {
      log(v1::LOG_WARNING, text);
      refused.push_back(text);
    }
    if (std::ssize(refused) > kMostRefused)
      refused.erase(refused.begin(), refused.end() - kMostRefused);
  }

  void log(v1::LogLevel level, std::string text) {
    // The text of a person's file or message may have a line without an end.
    if (text.size() > kLongestLog)
      text = text.substr(0, kLongestLog) + "... (" + std::to_string(text.size()) + " characters)";
    internal::write_log(level, options.name, text);
    if (level == v1::LOG_DEBUG)
      return;
    log_writer->write({.instance = status.instance,
                       .name = options.name,
                       .level = level,
                       .time_ns = unix_nanoseconds(),
                       .stamp = status.stamp,
                       .text = text});
  }

  const NodeOptions options;
  const std::shared_ptr<internal::Wake> wake = std::make_shared<internal::Wake>();
  std::unique_ptr<internal::Transport> transport;
  v1::ServiceStatus status;
  NodeHealth health;
  std::vector<std::string> refused;  ///< told by the log, and not taken yet
  std::optional<Writer<v1::ServiceStatus>> status_writer;
  std::optional<Writer<v1::LogRecord>> log_writer;
  const Clock::time_point started = Clock::now();
  Clock::time_point last_published;
  double last_cpu = 0.0;
  bool published = false;
  bool writes_robot = false;
  v1::ServiceState published_state = v1::SERVICE_STARTING;
  std::string published_reason;
};

Node::Node(NodeOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {
  impl_->transport =
      impl_->options.dry_run
          ? internal::make_memory_transport(impl_->options, make_memory_bus(), impl_->wake)
          : internal::make_dds_transport(impl_->options, impl_->status.instance, impl_->wake);
  impl_->start();
}

Node::Node(NodeOptions options, std::shared_ptr<MemoryBus> memory)
    : impl_(std::make_unique<Impl>(std::move(options))) {
  impl_->transport =
      internal::make_memory_transport(impl_->options, std::move(memory), impl_->wake);
  impl_->start();
}

Node::~Node() {
  if (impl_->status.stamp.cycle > 0)
    internal::has_worked() = true;
  impl_->beat(Heartbeat::kEnds);
  // A clean end: nobody has to wait until the status is old.
  if (impl_->published) {
    impl_->status_writer->dispose(impl_->status);
    impl_->status_writer->wait_acknowledged(100);
  }
}

std::unique_ptr<RawWriter> Node::make_writer(const char* topic, Qos qos, const TypeInfo& type) {
  impl_->writes_robot |= std::string_view(topic) == topics::kRobotState.name;
  return impl_->transport->make_writer(topic, internal::policies(qos, impl_->options.lockstep),
                                       type);
}

std::unique_ptr<RawReader> Node::make_reader(const char* topic, Qos qos, const TypeInfo& type) {
  auto reader =
      impl_->transport->make_reader(topic, internal::policies(qos, impl_->options.lockstep), type);
  if (impl_->options.for_terminal)
    reader = std::make_unique<TerminalReader>(std::move(reader), type);
  return reader;
}

int Node::wake_fd() const {
  return impl_->wake->fd();
}
void Node::wake() {
  impl_->wake->signal();
}
void Node::clear_wake() {
  impl_->wake->clear();
}

bool Node::wait(std::chrono::milliseconds timeout, const Stop* stop) {
  if (!impl_->wake->rest()) {
    impl_->wake->clear();
    return true;
  }
  const auto end = Clock::now() + timeout;
  std::array<pollfd, 2> fds{{{impl_->wake->fd(), POLLIN, 0}, {-1, POLLIN, 0}}};
  if (stop != nullptr)
    fds[1].fd = stop->fd();
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    const int ready = poll(fds.data(), fds.size(), static_cast<int>(std::max<long>(0, left)));
    if (ready > 0)
      break;
    if (ready == 0)
      return false;
    if (errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "poll");
  }
  impl_->wake->clear();
  return true;
}

bool Node::spin(std::chrono::microseconds limit) {
  const auto end = Clock::now() + limit;
  impl_->wake->rouse();
  while (!impl_->wake->pending()) {
    if (Clock::now() >= end)
      return !impl_->wake->rest();
    sched_yield();
  }
  impl_->wake->rest();
  return true;
}

void Node::rouse() {
  impl_->wake->rouse();
}

void Node::begin_anew() {
  impl_->transport->renew();
}

std::vector<std::string> Node::network_waits() const {
  return impl_->transport->network_waits();
}

std::vector<std::string> Node::silent_peers() const {
  return impl_->transport->silent_peers();
}

std::string Node::bar() const {
  return impl_->transport->bar();
}

std::optional<Identity> Node::identity() const {
  return impl_->transport->identity();
}

std::vector<std::string> Node::take_refused() {
  return std::exchange(impl_->refused, {});
}

const NodeOptions& Node::options() const {
  return impl_->options;
}
std::uint64_t Node::instance() const {
  return impl_->status.instance;
}

NodeHealth Node::health() const {
  impl_->note_troubles();
  return impl_->health;
}

v1::ServiceStatus& Node::status() {
  return impl_->status;
}

bool Node::publish_status() {
  Impl& self = *impl_;
  const auto now = Clock::now();
  const double since = std::chrono::duration<double>(now - self.last_published).count();
  if (self.published && since < 1.0 && self.status.state == self.published_state &&
      self.status.reason == self.published_reason)
    return false;
  self.note_troubles();
  self.status.incompatible = self.health.incompatible;
  self.status.uptime = std::chrono::duration<double>(now - self.started).count();
  self.status.rss_mb = resident_mb();
  // A share over too short a time would show only the resolution of the clock.
  if (since > 0.5) {
    const double cpu = cpu_seconds();
    self.status.cpu_percent = 100.0 * (cpu - self.last_cpu) / since;
    self.last_cpu = cpu;
    self.last_published = now;
  }
  v1::ServiceStatus told = self.status;
  for (const std::string& notice : self.transport->notices())
    told.reason += (told.reason.empty() ? "" : "; ") + notice;
  self.status_writer->write(told);
  self.beat(0);
  self.published_state = self.status.state;
  self.published_reason = self.status.reason;
  self.published = true;
  return true;
}

void Node::log(v1::LogLevel level, const std::string& text) {
  impl_->log(level, text);
}

namespace internal {

Transport& transport_of(Node& node) {
  return node.transport();
}
Wake& wake_of(Node& node) {
  return *node.impl_->wake;
}

std::atomic<bool>& has_worked() {
  static std::atomic<bool> worked{false};
  return worked;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0)
    return "unknown";
  return name.data();
}

}  // namespace internal

internal::Transport& Node::transport() {
  return *impl_->transport;
}

}  // namespace saphira::bus
