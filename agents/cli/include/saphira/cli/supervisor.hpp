#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/boot_clock.hpp"
#include "saphira/cli/watchdog.hpp"

namespace saphira::cli {

/// A child of the supervisor.
struct ChildSpec {
  std::string name;
  std::vector<std::string> argv;                   ///< argv[0] is a path
  std::map<std::string, std::string> environment;  ///< added to our own
  bool restart = true;
  std::string robot = {};  ///< whose program it is on the bus; empty: it knows nothing of the bus
};

/// Runs programs: starts them in order, prints what they print line by line, starts again what
/// ends (after 100 ms, then twice as long each time up to 5 s; back to 100 ms once it has proven
/// itself by running for 10 s), kills what hangs or is deaf, as the watchdog has it, so that it is
/// started again, and stops all in the reverse order. The children get SIGTERM from
/// the kernel when the supervisor dies, and a process group each, so that Ctrl-C reaches the
/// supervisor alone.
///
/// For one thread, which must outlive the children (PR_SET_PDEATHSIG is about the thread).
class Supervisor {
 public:
  using Clock = std::chrono::steady_clock;
  /// A line that a child wrote, or (from is empty) something that the supervisor has to say.
  using Print = std::function<void(std::string_view from, std::string_view line)>;

  struct Child {
    std::string name;
    pid_t pid = 0;  ///< 0: not running now
    int starts = 0;
    std::string ended;     ///< how it ended last, in words
    bool crashed = false;  ///< at some time, by a fault of its own
  };

  Supervisor(std::vector<ChildSpec> children, Print print,
             std::chrono::milliseconds proven = std::chrono::seconds(10));
  /// Stops what still runs.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Starts every child. std::runtime_error when one cannot be started at all.
  void start();
  /// Waits for something to do, for one of `wake_fds` or the timeout, and does what is due. What
  /// cannot be started again now is tried again later.
  void step(std::chrono::milliseconds timeout, std::initializer_list<int> wake_fds = {});
  /// SIGTERM to each in the reverse order, the next one when it has ended; SIGKILL to what is left
  /// after `limit`.
  void stop(std::chrono::milliseconds limit = std::chrono::seconds(2));

  /// Takes in new versions: each child whose program is another file than the one that it was
  /// started from is ended and started again, the next one when it has run for two seconds. Those
  /// stay to which `objection` (of a program's path) has something to say, and those that are not
  /// on the bus, such as a simulator. The work is done by step().
  void renew(const std::function<std::string(const std::string& program)>& objection);

  std::vector<Child> children() const;
  /// A child that ended with a usage error (exit code 2) right after its first start, before it
  /// had proven itself: what it was given is wrong, so to start it again is of no use.
  std::optional<std::string> misused() const;
  /// True where no child runs and none will be started again.
  bool finished() const;

 private:
  struct Slot {
    ChildSpec spec;
    pid_t pid = 0;
    int pid_fd = -1;
    int starts = 0;
    std::string ended;
    Clock::time_point started;
    std::optional<Clock::time_point> due;  ///< when to start it again
    std::chrono::milliseconds backoff{};
    bool misused = false;
    bool crashed = false;
    int beats = -1;       ///< the pipe of its heartbeats
    std::string trouble;  ///< for which it was killed
    std::string file;     ///< which file it was started from; see file_of()
  };
  struct Stream {
    int fd;
    std::size_t slot;
    std::string line;
  };

  void launch(std::size_t index);
  void launch_again(std::size_t index);
  /// When to start it again: later each time, unless it had `proven` itself. Returns the delay.
  std::chrono::milliseconds put_off(Slot& slot, bool proven);
  void poll_once(std::chrono::milliseconds timeout, std::initializer_list<int> wake_fds = {});
  bool read_stream(Stream& stream);
  void reap(std::size_t index);
  void read_beats(std::size_t index);
  void watch(BootClock::duration waited, std::chrono::milliseconds timeout);
  void renew_next();
  void say(const std::string& text) { print_({}, text); }

  std::vector<Slot> slots_;
  std::vector<Stream> streams_;  ///< outlive their child: a grandchild may hold them
  Print print_;
  std::chrono::milliseconds proven_;  ///< a child that ran this long starts afresh
  Watchdog watchdog_;
  bool stopping_ = false;
  std::vector<std::size_t> to_renew_;    ///< the next one first
  std::optional<std::size_t> renewing_;  ///< ended for a new version, and not proven yet
};

}  // namespace saphira::cli
