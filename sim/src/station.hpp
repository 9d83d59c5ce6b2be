#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "feeds.hpp"
#include "listener.hpp"
#include "pace.hpp"
#include "saphira/base/full_disk.hpp"
#include "saphira/base/text.hpp"
#include "saphira/protocol/check.hpp"
#include "saphira/sim/host.hpp"
#include "saphira/sim/simulation.hpp"

namespace saphira::sim {

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
    [[maybe_unused]] const ssize_t size = ::write(file_, line.data(), line.size());
  }

  std::string prefix_;
  Descriptor file_;
  protocol::Checker checker_;
  std::size_t reported_ = 0;
};

// One robot's line: its listener, its client, its output queue, its files.
class Station {
 public:
  Station(const HostOptions& options, Simulation& simulation, RobotNumber number);

  void add_to(std::vector<pollfd>& fds) const;
  void add_viewers_to(std::vector<pollfd>& fds) const {
    for (const PictureFeed& feed : pictures_)
      feed.add_to(fds);
  }
  /// Waits for a client to open the terminal, which poll() does not report.
  bool waits_for_terminal() const { return terminal_ && !terminal_open_; }
  bool packet_pending() const { return server().packet_pending(); }

  // For free running: true where the client may still work on its last packets. The wait for it has
  // a limit.
  bool is_behind() const;
  double seconds_until_given_up() const;
  void count_cycle() { ++cycles_; }

  bool sending() const { return !output_.empty(); }

  void gap() { simulation_.gap(number_); }
  void tell_status() { server().tell_status(); }

  void accept();

  /// Checks for a client at the terminal.
  void look_at_terminal();

  void read_client();

  /// Sends pending output, and writes pending rows.
  void write(bool live);

  /// Disconnects the client on request of the view.
  void drop() { hang_up("disconnected by the view"); }

  void end();

 private:
  using Clock = Pace::Clock;

  void log(const std::string& text) const {
    if (log_)
      log_("info", prefix_ + text);
  }
  Server& server() const { return simulation_.server(number_); }
  /// The client's descriptor; below zero without one.
  int line() const {
    return terminal_ ? (terminal_open_ ? terminal_->fd() : -1) : static_cast<int>(client_);
  }

  void watch(protocol::Side side, protocol::ByteView bytes);

  void send(const protocol::Bytes& fresh);

  // Without a reader: as on a real line, old output is lost, and later output is fresh.
  void lose_output() {
    terminal_->forget();
    output_.clear();
  }

  void hang_up(const std::string& why);

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
  Descriptor client_;
  protocol::Bytes output_;
  std::optional<LineCheck> check_;
  std::vector<PictureFeed> pictures_;
  int cycles_ = 0;  // since the client's last bytes
  Clock::time_point heard_ = Clock::now();
};

}  // namespace saphira::sim
