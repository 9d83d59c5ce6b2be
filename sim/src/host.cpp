#include "saphira/sim/host.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "feeds.hpp"
#include "listener.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/full_disk.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/protocol/check.hpp"
#include "saphira/sim/resume.hpp"
#include "saphira/sim/simulation.hpp"
#include "saphira/sim/view.hpp"
#include "world_check.hpp"

namespace saphira::sim {

namespace {

using Clock = std::chrono::steady_clock;

// The lead of a client in single step over a viewer of its pictures.
constexpr std::size_t kPicturesInStep = 4;

// Silence after which a packet that has begun will not be completed.
constexpr double kGap = 0.050;  // [s]

// While time is paused a client hears this often that the simulator is there.
constexpr std::chrono::milliseconds kTells{500};

// Free running, time may be this far ahead of a client: less than the watchdog's two seconds. A
// client that is silent for kGivenUp by the wall clock is not waited for any more.
constexpr int kMostAhead = 10;    // [cycles]
constexpr double kGivenUp = 2.0;  // [s]

// Steps that wait for a client.
constexpr int kMostSteps = 100;

// Between two checks for a client at a terminal.
constexpr int kPollPeriod = 50;  // [ms]

// Bytes that may wait for a client that does not read. Beyond that it loses whole packets, the
// newest: they would be stale when it wakes.
constexpr std::size_t kMost = 65536;

/// `number` of the robot, from 1. Nothing for a terminal.
std::optional<Listener> listen(const HostOptions& options, std::size_t number) {
  if (options.terminal)
    return std::nullopt;
  if (!options.tcp)
    return Listener::local(numbered(options.socket.value_or(default_socket()), number));
  const std::size_t port = *options.tcp == 0 ? 0 : *options.tcp + number - 1;
  if (port > 65535)
    throw std::invalid_argument("port " + std::to_string(port) + ": expected at most 65535");
  return Listener::tcp(options.tcp_address, static_cast<std::uint16_t>(port));
}

class TraceFile {
 public:
  explicit TraceFile(const std::string& path) : path_(path) {
    if (path.empty())
      return;
    file_.reset(std::fopen(path.c_str(), "we"));
    if (!file_)
      fail_to_be("trace " + path, "written");
  }
  void write(const std::vector<TraceRow>& rows) {
    if (!file_)
      return;
    for (const TraceRow& row : rows) {
      const std::string text = (row.first ? trace_header() : "") + to_csv(row);
      std::fwrite(text.data(), 1, text.size(), file_.get());
    }
  }
  void flush() {
    if (file_ && (std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0))
      fail("trace " + path_);
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

// The strict checker on a robot's line: violations of the protocol's tables are appended to a file,
// a line each, at once and in one write, so that several simulators may share the file and a killed
// one has written all its findings.
class LineCheck {
 public:
  /// `prefix` begins each line.
  LineCheck(const std::string& path, std::string prefix,
            const protocol::RobotParameters& parameters)
      : prefix_(std::move(prefix)),
        file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)),
        checker_([parameters](const protocol::RobotIdentity&) { return parameters; }) {
    if (!file_)
      throw UnusableFile(cannot_be(path, "written"));
  }
  /// The time [s] as for the checker: only where the robot's time is the client's.
  void pass(protocol::Side side, protocol::ByteView bytes, std::optional<double> time) {
    checker_.feed(side, bytes, time);
    report();
  }
  /// The connection is closed: also writes the summary since the beginning.
  void disconnect() {
    checker_.disconnect();
    report();
    std::istringstream lines(checker_.summary());
    for (std::string line; std::getline(lines, line);)
      write(line);
  }

 private:
  void report() {
    for (; reported_ < checker_.findings().size(); ++reported_)
      write(to_string(checker_.findings()[reported_]));
  }
  void write(const std::string& text) const {
    const std::string line = prefix_ + text + "\n";
    [[maybe_unused]] const ssize_t size = ::write(file_.get(), line.data(), line.size());
  }

  std::string prefix_;
  Fd file_;
  protocol::Checker checker_;
  std::size_t reported_ = 0;
};

std::string default_check() {
  const char* path = std::getenv("SAPHIRA_CHECK");
  return path != nullptr ? path : "";
}

// The ticks that are due by the wall clock. Time in which the whole process slept (stopped, or the
// machine suspended) is skipped, not made up.
class Pace {
 public:
  explicit Pace(double rate) : tick_(kTick / rate) {}

  void restart() {
    origin_ = Clock::now();
    done_ = 0;
  }
  int due() {
    const double elapsed = std::chrono::duration<double>(Clock::now() - origin_).count();
    const auto due = static_cast<std::int64_t>(elapsed / tick_) - done_;
    const auto most = static_cast<std::int64_t>(std::max(2.0 * kTicksPerPacket, 0.3 / tick_));
    if (due > most) {
      restart();
      return static_cast<int>(most);
    }
    done_ += std::max<std::int64_t>(due, 0);
    return static_cast<int>(std::max<std::int64_t>(due, 0));
  }
  /// The time until so many further ticks are due.
  double seconds_until(int ticks) const {
    const double at = static_cast<double>(done_ + ticks) * tick_;
    return at - std::chrono::duration<double>(Clock::now() - origin_).count();
  }

 private:
  double tick_;  // [s] of the wall clock
  Clock::time_point origin_ = Clock::now();
  std::int64_t done_ = 0;
};

// A timer that wakes poll(); between packets only clients' bytes need work.
class Timer {
 public:
  Timer() : fd_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
    if (!fd_)
      fail("timer");
  }
  void set(double seconds) const {
    const auto nanoseconds = static_cast<std::int64_t>(std::max(seconds, 1e-6) * 1e9);
    itimerspec spec{};
    spec.it_value.tv_sec = nanoseconds / 1'000'000'000;
    spec.it_value.tv_nsec = nanoseconds % 1'000'000'000;
    ::timerfd_settime(fd_.get(), 0, &spec, nullptr);
  }
  void clear() const {
    const itimerspec spec{};
    ::timerfd_settime(fd_.get(), 0, &spec, nullptr);
  }
  int fd() const { return fd_.get(); }

 private:
  Fd fd_;
};

// One robot's line: its listener, its client, its output queue, its files.
class Station {
 public:
  Station(const HostOptions& options, Simulation& simulation, RobotNumber number)
      : log_(options.log),
        prefix_(options.more.empty() ? "" : "robot " + std::to_string(number + 1) + ": "),
        patient_(options.rate == kMaxRate),
        real_time_(options.rate == 1.0),
        simulation_(simulation),
        number_(number),
        trace_(options.trace.empty() ? "" : numbered(options.trace, number + 1)),
        listener_(listen(options, number + 1)) {
    if (const std::string path = options.check.value_or(default_check()); !path.empty())
      check_.emplace(path, prefix_, server().parameters());
    const auto numbered_socket = [&](const std::optional<std::string>& socket) {
      return socket ? std::optional(numbered(*socket, number + 1)) : std::nullopt;
    };
    if (!options.stereo.empty() || options.stereo_socket)
      pictures_.emplace_back(stereo_pairs(options.seed + number),
                             options.stereo.empty() ? "" : numbered(options.stereo, number + 1),
                             numbered_socket(options.stereo_socket));
    if (options.camera_socket)
      pictures_.emplace_back(color_pictures(), "", numbered_socket(options.camera_socket));
    if (options.terminal)
      terminal_.emplace(numbered(*options.terminal, number + 1));
    log("listening on " + (terminal_ ? terminal_->name() : listener_->name()) +
        (options.step ? ", single-step" : ""));
  }

  void add_to(std::vector<pollfd>& fds) const {
    const auto events = static_cast<short>(output_.empty() ? POLLIN : POLLIN | POLLOUT);
    fds.push_back({line(), events, 0});  // poll skips those below zero
    fds.push_back({listener_ ? listener_->fd() : -1, POLLIN, 0});
  }
  void add_viewers_to(std::vector<pollfd>& fds) const {
    for (const PictureFeed& feed : pictures_)
      feed.add_to(fds);
  }
  /// Waits for a client to open the terminal, which poll() does not report.
  bool waits_for_terminal() const { return terminal_ && !terminal_open_; }
  bool packet_pending() const { return server().packet_pending(); }

  // For free running: true where the client may still work on its last packets. The wait for it has
  // a limit.
  bool is_behind() const { return server().is_open() && cycles_ >= kMostAhead; }
  double seconds_until_given_up() const {
    return kGivenUp - std::chrono::duration<double>(Clock::now() - heard_).count();
  }
  void count_cycle() { ++cycles_; }

  bool sending() const { return !output_.empty(); }

  void gap() { simulation_.gap(number_); }
  void tell_status() { server().tell_status(); }

  void accept() {
    Fd fd = listener_->accept();
    if (!fd)
      return;
    if (client_) {
      log("a second client was refused: one at a time");
      return;
    }
    const int yes = 1;  // fails on a local socket, where it is not needed
    ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    // A larger buffer would let time run far ahead of a client.
    const int size = 4096;
    if (patient_)
      ::setsockopt(fd.get(), SOL_SOCKET, SO_SNDBUF, &size, sizeof size);
    client_ = std::move(fd);
    log("a client has connected");
  }

  /// Checks for a client at the terminal.
  void look_at_terminal() {
    if (!terminal_ || terminal_->is_open() == terminal_open_)
      return;
    terminal_open_ = !terminal_open_;
    log(terminal_open_ ? "a client has opened the terminal" : "the client has closed the terminal");
  }

  void read_client() {
    // The client's earlier bytes were taken before, in order.
    if (line() >= 0)
      send(server().take_output());
    if (line() < 0)
      return;
    std::array<std::uint8_t, 4096> buffer{};
    const ssize_t size = ::read(line(), buffer.data(), buffer.size());
    if (size > 0) {
      cycles_ = 0;
      heard_ = Clock::now();
      const protocol::ByteView bytes(buffer.data(), static_cast<std::size_t>(size));
      watch(protocol::Side::kClient, bytes);
      simulation_.receive(number_, bytes);
    } else if (!terminal_ && (size == 0 || (errno != EAGAIN && errno != EINTR))) {
      hang_up("the client has gone");
    }
  }

  /// Sends pending output, and writes pending rows.
  void write(bool live) {
    const protocol::Bytes fresh = server().take_output();
    if (line() >= 0)
      send(fresh);
    const auto rows = server().take_trace();
    trace_.write(rows);
    // Live, a person may be watching the file.
    if (!rows.empty() && (live || !client_))
      trace_.flush();
    // After the packet, which must not wait for the picture.
    for (PictureFeed& feed : pictures_)
      feed.serve(simulation_.scene(), number_, server().devices().head(), server().cycle(),
                 server().single_step() ? kPicturesInStep : 1);
  }

  /// Disconnects the client on request of the view.
  void drop() { hang_up("disconnected by the view"); }

  void end() {
    hang_up("stopped");
    trace_.write(server().take_trace());
    trace_.flush();
    const ServerCounters counters = server().counters();
    log("stopped; " + std::to_string(server().robot().contacts()) + " contacts, " +
        std::to_string(counters.bad_packets) + " bad packets, " +
        std::to_string(counters.unknown_commands) + " unknown commands");
  }

 private:
  void log(const std::string& text) const {
    if (log_)
      log_("info", prefix_ + text);
  }
  Server& server() const { return simulation_.server(number_); }
  /// The client's descriptor; below zero without one.
  int line() const { return terminal_ ? (terminal_open_ ? terminal_->fd() : -1) : client_.get(); }

  void watch(protocol::Side side, protocol::ByteView bytes) {
    if (!check_ || bytes.empty())
      return;
    std::optional<double> time;
    if (real_time_ && !server().single_step())
      time = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    check_->pass(side, bytes, time);
  }

  void send(const protocol::Bytes& fresh) {
    if (output_.size() + fresh.size() <= kMost) {
      watch(protocol::Side::kServer, fresh);
      output_.insert(output_.end(), fresh.begin(), fresh.end());
    }
    while (!output_.empty()) {
      const ssize_t size = terminal_ ? ::write(line(), output_.data(), output_.size())
                                     : ::send(line(), output_.data(), output_.size(), MSG_NOSIGNAL);
      if (size > 0) {
        output_.erase(output_.begin(), output_.begin() + size);
      } else if (errno == EINTR) {
        continue;
      } else {
        if (terminal_)
          lose_output();
        else if (errno != EAGAIN)
          hang_up("the client has gone");
        return;
      }
    }
  }

  // Without a reader: as on a real line, old output is lost, and later output is fresh.
  void lose_output() {
    terminal_->forget();
    output_.clear();
  }

  void hang_up(const std::string& why) {
    output_.clear();
    if (!client_)
      return;
    client_.reset();
    simulation_.disconnect(number_);
    if (check_)
      check_->disconnect();
    log(why);
  }

  decltype(HostOptions::log) log_;
  std::string prefix_;
  bool patient_;
  bool real_time_;
  Simulation& simulation_;
  RobotNumber number_;
  TraceFile trace_;
  std::optional<Listener> listener_;
  std::optional<Terminal> terminal_;
  bool terminal_open_ = false;
  Fd client_;
  protocol::Bytes output_;
  std::optional<LineCheck> check_;
  std::vector<PictureFeed> pictures_;
  int cycles_ = 0;  // since the client's last bytes
  Clock::time_point heard_ = Clock::now();
};

class Serving : ViewedHost {
 public:
  /// `view`, which may be null, outlives it.
  Serving(const HostOptions& options, Simulation& simulation, ViewFeed* view)
      : simulation_(simulation),
        view_(view),
        unpaced_(options.rate == kMaxRate),
        pacing_{false, unpaced_ ? 1.0 : options.rate},
        pace_(options.rate) {
    for (RobotNumber i = 0; i < simulation.size(); ++i)
      stations_.push_back(std::make_unique<Station>(options, simulation, i));
    if (view_ == nullptr)
      return;
    choice_ = [worlds = options.worlds, robots = options.robots,
               world = std::filesystem::path(options.world).stem().string()] {
      using Names = std::vector<std::string>;
      return Choice{worlds ? worlds() : Names(), robots ? robots() : Names(), world};
    };
    view_->tell(describe_world(simulation.scene().world(), choice_()), true);
  }

  bool serve(int stop_fd, int most_ms) {
    int timeout = schedule();
    const auto at_most = [&](int limit) {
      timeout = timeout < 0 ? limit : std::min(timeout, limit);
    };
    for (const auto& station : stations_) {
      station->look_at_terminal();
      if (station->waits_for_terminal())
        at_most(kPollPeriod);
    }
    if (most_ms >= 0)
      at_most(most_ms);
    // In that order: stop, timer, then each robot's client and listener, then viewers.
    fds_.clear();
    fds_.push_back({stop_fd, POLLIN, 0});
    fds_.push_back({timer_.fd(), POLLIN, 0});
    for (const auto& station : stations_)
      station->add_to(fds_);
    for (const auto& station : stations_)
      station->add_viewers_to(fds_);
    if (view_ != nullptr)
      view_->add_to(fds_);
    if (::poll(fds_.data(), fds_.size(), timeout) < 0) {
      if (errno == EINTR)
        return true;
      fail("poll");
    }
    if (fds_[0].revents != 0)
      return false;
    step(fds_);
    take_steps();
    if (view_ != nullptr)
      serve_view();
    return true;
  }

  /// A world or robots requested at the view.
  std::optional<Load> take_load() { return std::exchange(load_, std::nullopt); }

  void end() {
    for (const auto& station : stations_)
      station->end();
  }

 private:
  static bool client_ready(const std::vector<pollfd>& fds, std::size_t station) {
    return fds[2 + 2 * station].revents != 0;
  }
  static bool listener_ready(const std::vector<pollfd>& fds, std::size_t station) {
    return fds[3 + 2 * station].revents != 0;
  }

  // Sets the timer to the next information packet, or to the end of a silence. Returns poll's
  // timeout [ms], without end below zero.
  int schedule() {
    const bool ran = running_;
    running_ = simulation_.runs() && !pacing_.paused;
    if (running_ && unpaced_)
      return patience();
    if (running_) {
      if (!ran)
        pace_.restart();
      timer_.set(pace_.seconds_until(simulation_.ticks_to_packet()));
      timed_ = true;
      return -1;
    }
    const bool pending = std::ranges::any_of(
        stations_, [](const auto& station) { return station->packet_pending(); });
    const bool tells = pacing_.paused && simulation_.runs();
    if (pending || tells) {
      const double rest = std::chrono::duration<double>(tells_at_ - Clock::now()).count();
      timer_.set(pending ? kGap : std::max(rest, 1e-3));
      timed_ = true;
    } else if (timed_) {
      timer_.clear();
      timed_ = false;
    }
    return -1;
  }

  // Free running: the wait for clients [ms].
  int patience() {
    double wait = 0.0;
    waits_ = false;
    for (const auto& station : stations_) {
      if (station->sending())
        waits_ = true;
      else if (station->is_behind())
        wait = std::max(wait, station->seconds_until_given_up());
    }
    if (waits_)
      return -1;
    waits_ = wait > 0.0;
    return waits_ ? 1 + static_cast<int>(wait * 1000.0) : 0;
  }

  void step(const std::vector<pollfd>& fds) {
    const bool timer_ready = fds[1].revents != 0;
    if (timer_ready) {
      std::uint64_t count = 0;
      [[maybe_unused]] const auto size = ::read(timer_.fd(), &count, sizeof count);
    }
    // Time first, so that new bytes act now, not at the time of the packet before.
    if (running_ && !unpaced_)
      simulation_.advance(pace_.due());
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      if (client_ready(fds, i))
        stations_[i]->read_client();
      else if (timer_ready && !running_)
        stations_[i]->gap();
    }
    if (running_ && unpaced_ && !waits_) {
      simulation_.advance(kTicksPerPacket);
      for (const auto& station : stations_)
        station->count_cycle();
    }
    // A client that hears nothing would end the connection.
    if (pacing_.paused && Clock::now() >= tells_at_) {
      tells_at_ = Clock::now() + kTells;
      for (const auto& station : stations_)
        station->tell_status();
    }
    for (const auto& station : stations_)
      station->write(running_);
    for (std::size_t i = 0; i < stations_.size(); ++i)
      if (listener_ready(fds, i))
        stations_[i]->accept();
  }

  /// Without a client time does not pass, so a step waits for one, such as a bridge that has found
  /// the paused robot silent and connects again.
  void take_steps() {
    for (; steps_ > 0 && simulation_.runs(); --steps_) {
      simulation_.advance(kTicksPerPacket);
      for (const auto& station : stations_)
        station->write(true);
    }
  }

  void serve_view() {
    const bool asked =
        view_->serve([this] { return describe_world(simulation_.scene().world(), choice_()); },
                     [this](const std::string& text) { return obey(text); });
    const std::uint64_t ticks = simulation_.scene().ticks();
    if (!view_->watched() || (!asked && shown_ && ticks < *shown_ + kTicksPerPacket))
      return;
    shown_ = ticks;
    view_->tell(describe_scene(simulation_, pacing_), false);
  }

  /// Carries out a line from the view; returns the answer, as a line.
  std::string obey(const std::string& text) {
    try {
      const std::string trouble = sim::obey(text, simulation_, *this);
      return trouble.empty() ? std::exchange(answer_, {}) : complaint(trouble);
    } catch (const std::invalid_argument& error) {
      return complaint(error.what());
    }
  }
  std::string pause(bool on) override {
    pacing_.paused = on;
    steps_ = 0;
    return {};
  }
  std::string step_once() override {
    if (!pacing_.paused)
      return "time is not paused";
    steps_ = std::min(steps_ + 1, kMostSteps);
    take_steps();
    return {};
  }
  std::string set_rate(double rate) override {
    if (unpaced_)
      return "the simulator runs as fast as it can";
    pacing_.rate = rate;
    pace_ = Pace(rate);
    return {};
  }
  std::string disconnect(RobotNumber robot) override {
    stations_[robot]->drop();
    return {};
  }
  std::string load(Load wish) override {
    load_ = std::move(wish);
    return {};
  }
  std::string list_files() override {
    answer_ = describe_files(choice_());
    return {};
  }

  Simulation& simulation_;
  ViewFeed* view_;
  std::function<Choice()> choice_;      // of files, at present
  std::optional<std::uint64_t> shown_;  // [ticks] time of the newest view
  std::optional<Load> load_;
  std::string answer_;  // to a line from the view
  bool unpaced_;
  Pacing pacing_;
  Pace pace_;
  Timer timer_;
  std::vector<std::unique_ptr<Station>> stations_;
  std::vector<pollfd> fds_;
  int steps_ = 0;  // asked for, while time is paused
  Clock::time_point tells_at_;
  bool running_ = false;
  bool waits_ = false;  // for a client to read its output
  bool timed_ = false;
};

}  // namespace

void offer_files(HostOptions& options, const std::string& config) {
  namespace fs = std::filesystem;
  // By name: a folder's files; the earlier folders first.
  const auto found = [](const std::vector<std::string>& folders, const std::string& extension) {
    std::map<std::string, std::string> files;
    std::error_code none;
    for (const std::string& folder : folders)
      for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().extension() == extension)
          files.emplace(entry.path().stem(), entry.path());
    return files;
  };
  const auto names = [](const std::map<std::string, std::string>& files) {
    std::vector<std::string> all;
    for (const auto& [name, file] : files)
      all.push_back(name);
    return all;
  };
  // Anew at each request: a person may have written a file meanwhile.
  const auto finder = [found](const std::vector<std::string>& folders,
                              const std::string& extension) {
    return [=](const std::string& name) {
      const auto files = found(folders, extension);
      const auto file = files.find(name);
      if (file != files.end())
        return file->second;
      std::string expected;
      for (const auto& [each, path] : files)
        expected += (expected.empty() ? "" : ", ") + each;
      throw std::runtime_error("there is no file \"" + name + extension + "\": expected one of " +
                               expected);
    };
  };
  const std::vector<std::string> worlds{folder_of(options.world), config + "/worlds"};
  const std::vector<std::string> robots{folder_of(options.robot), config + "/robots"};
  options.worlds = [=] { return names(found(worlds, ".wld")); };
  options.robots = [=] { return names(found(robots, ".p")); };
  options.world_file = finder(worlds, ".wld");
  options.robot_file = finder(robots, ".p");
}

std::string default_socket() {
  if (const char* path = std::getenv("ROBOT_SOCKET"); path != nullptr && *path != '\0')
    return path;
  return "/tmp/saphira-robot-" + std::to_string(::getuid());
}

std::string default_terminal() {
  return "/tmp/saphira-robot-" + std::to_string(::getuid()) + ".tty";
}

std::string numbered(const std::string& path, std::size_t number) {
  if (number <= 1)
    return path;
  const std::size_t dot = path.find_last_of("./");
  const std::string text = "-" + std::to_string(number);
  // A name that begins with a dot has no ending.
  if (dot == std::string::npos || path[dot] == '/' || dot == 0 || path[dot - 1] == '/')
    return path + text;
  return path.substr(0, dot) + text + path.substr(dot);
}

struct Host::Parts {
  /// The world with its robots, which nobody serves yet.
  explicit Parts(const HostOptions& options) : world(load_world(options.world, options.things)) {
    add_robots(options);
  }
  Parts(const HostOptions& options, ViewFeed* view) : Parts(options) {
    serving.emplace(options, simulation, view);
  }
  void add_robots(const HostOptions& options);

  World world;
  Simulation simulation{world};
  std::optional<Serving> serving;
};

void Host::Parts::add_robots(const HostOptions& options) {
  const auto warn = [&](const std::vector<std::string>& warnings) {
    if (options.log)
      for (const std::string& warning : warnings)
        options.log("warning", warning);
  };
  warn(world.warnings);
  if (!((options.rate > 0.0 && options.rate <= 1000.0) || options.rate == kMaxRate))
    throw std::invalid_argument(
        "rate: expected more than 0 and at most 1000 times real time, or \"max\"");
  const auto add = [&](const std::string& file, const std::optional<Pose>& start,
                       const std::optional<Place>& place, std::size_t number) {
    const protocol::RobotParameters parameters = protocol::load_parameters(file);
    warn(parameters.warnings);
    if (!start)
      throw std::invalid_argument(options.world + ": expected a directive " +
                                  (number == 0 ? "position" : "robot for each further robot") +
                                  ", or a position among the options");
    ServerOptions server_options;
    server_options.seed = options.seed + number;
    server_options.single_step = options.step;
    server_options.trace = !options.trace.empty();
    try {
      if (const auto trouble = trouble_of_start(world, *start); trouble && !place)
        throw std::invalid_argument(*trouble);
      simulation.add(parameters, *start, server_options);
    } catch (const std::invalid_argument& error) {
      if (place)
        throw FileError(options.world, place->line, place->column, error.what());
      throw std::invalid_argument("--position of robot " + std::to_string(number + 1) + ": " +
                                  error.what());
    }
  };
  if (options.position)
    add(options.robot, options.position, std::nullopt, 0);
  else
    add(options.robot, world.start, world.start_place, 0);
  for (std::size_t i = 0; i < options.more.size(); ++i) {
    const RobotOptions& robot = options.more[i];
    std::optional<Pose> start = robot.position;
    std::optional<Place> place;
    if (!start && i < world.movable.robots.size()) {
      start = world.movable.robots[i];
      place = world.robot_places[i];
    }
    add(robot.robot.empty() ? options.robot : robot.robot, start, place, i + 1);
  }
}

namespace {

std::string world_of(const HostOptions& options) {
  return options.world + "+" + options.things + "+" + options.robot;
}

}  // namespace

Host::Host(const HostOptions& options) : options_(options) {
  if (options_.view_socket)
    view_ = std::make_unique<ViewFeed>(*options_.view_socket);
  parts_ = std::make_unique<Parts>(options_, view_.get());
  take_state();
}
Host::~Host() = default;

bool Host::serve(int stop_fd, int most_ms) {
  if (!parts_->serving->serve(stop_fd, most_ms))
    return false;
  if (const auto load = parts_->serving->take_load())
    change(load->world, load->robot);
  return true;
}

void Host::change(const std::string& world, const std::string& robot) {
  HostOptions next = options_;
  if (!options_.world_file || !options_.robot_file)
    return view_->tell(complaint("nothing else can be loaded into this simulator"), true);
  try {
    if (!world.empty()) {
      next.world = options_.world_file(world);
      next.things.clear();
      next.position.reset();
    }
    if (!robot.empty())
      next.robot = options_.robot_file(robot);
    load_world(next.world, next.things);
    protocol::load_parameters(next.robot);
  } catch (const std::exception& error) {
    return view_->tell(complaint(error.what()), true);
  }
  parts_->serving->end();
  parts_.reset();  // its sockets are needed
  try {
    parts_ = std::make_unique<Parts>(next, view_.get());
    options_ = next;
  } catch (const std::exception& error) {
    parts_ = std::make_unique<Parts>(options_, view_.get());
    view_->tell(complaint(error.what()), true);
  }
}

void Host::end() {
  parts_->serving->end();
  if (options_.state.empty())
    return;
  const std::string text = places_text(parts_->simulation.scene(), world_of(options_));
  if (!replace_file(options_.state, sealed(text)) && options_.log)
    options_.log("error", cannot_be(options_.state, "written"));
}

void Host::take_state() {
  const std::string& file = options_.state;
  if (file.empty())
    return;
  const std::string damaged = read_or_set_aside(file, [&](const std::string& content) {
    const std::string without_place =
        resume(parts_->simulation.scene(), unsealed(content, file), world_of(options_));
    if (!without_place.empty() && options_.log)
      options_.log("warning", file + ": these begin at their start: " + without_place);
  });
  if (!damaged.empty() && options_.log)
    options_.log("warning", damaged);
  // It is of one end: a simulator that is killed begins anew.
  std::error_code none;
  std::filesystem::remove(file, none);
}

void check(const HostOptions& options) {
  const Host::Parts parts(options);
  if (!options.terminal && !options.tcp)
    for (std::size_t number = 1; number <= 1 + options.more.size(); ++number)
      expect_socket(numbered(options.socket.value_or(default_socket()), number));
  for (const auto& socket : {options.view_socket, options.stereo_socket, options.camera_socket})
    if (socket)
      expect_socket(*socket);
}

void run(const HostOptions& options, int stop_fd) {
  Host host(options);
  while (host.serve(stop_fd)) {
  }
  host.end();
}

}  // namespace saphira::sim
