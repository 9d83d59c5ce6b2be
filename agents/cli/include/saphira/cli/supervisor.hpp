#pragma once

#include <sys/types.h>

#include <chrono>
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
  std::string robot = {};  ///< the robot of its node; empty: it is not on the bus
};

/// The words as execv() takes them, with a null at the end.
std::vector<char*> pointers(std::vector<std::string>& words);

/// The environment of this process with those variables added or replaced, as NAME=VALUE.
std::vector<std::string> merged_environment(const std::map<std::string, std::string>& added);

/// The identity of a file, which differs from that of a later file with the same path.
std::string file_of(const std::string& path);

/// Runs programs: starts them in order, prints their lines, restarts ended ones (after 100 ms, then
/// twice as long each time up to 5 s; back to 100 ms after a run of 10 s), kills hanging or deaf
/// ones, by the watchdog, so that they are restarted, and stops all in the reverse order. The
/// children get SIGTERM from the kernel when the supervisor dies, and a process group each, so that
/// Ctrl-C reaches the supervisor alone.
///
/// For one thread, which must outlive the children (PR_SET_PDEATHSIG is about the thread).
class Supervisor {
 public:
  using Clock = std::chrono::steady_clock;
  /// A line of a child, or (from is empty) a message of the supervisor.
  using Print = std::function<void(std::string_view from, std::string_view line)>;

  struct Child {
    std::string name;
    pid_t pid = 0;  ///< 0: not running now
    int starts = 0;
    std::string ended;     ///< the way of its last end, in words
    bool crashed = false;  ///< at some time, by a fault of its own
  };

  Supervisor(std::vector<ChildSpec> children, Print print,
             std::chrono::milliseconds proven = std::chrono::seconds(10));
  /// Stops the running children.
  ~Supervisor();
  Supervisor& operator=(Supervisor&&) = delete;

  /// Starts every child. std::runtime_error when one cannot be started at all.
  void start();
  /// Waits for due work, for one of `wake_fds` or the timeout, and does the due work. A failed
  /// restart is tried again later.
  void step(std::chrono::milliseconds timeout, std::initializer_list<int> wake_fds = {});
  /// SIGTERM to each in the reverse order, the next when one has ended; SIGKILL to the rest after
  /// `limit`.
  void stop(std::chrono::milliseconds limit = std::chrono::seconds(2));

  /// Takes new versions: each child whose program file was replaced is ended and restarted, the
  /// next one after it has run for two seconds. Children stay if `objection` gives a reason.
  /// step() does the work.
  void renew(const std::function<std::string(const ChildSpec& child)>& objection);
  /// True while new versions are taken in.
  bool renews() const { return renewing_ || !to_renew_.empty(); }

  /// The running children, in words, for a new version of this program in this process. Their
  /// descriptors stay open over the exec().
  std::string hand_over() const;
  /// In place of start(): goes on with the children of hand_over(), and starts the others. Ends
  /// those that it has no use for. std::invalid_argument where the text is of another version.
  void take_over(const std::string& children);

  std::vector<Child> children() const;
  /// A child that ended with a usage error (exit code 2) right after its first start, before it had
  /// proven itself: its input is wrong, so a restart is of no use.
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
    std::optional<Clock::time_point> due;  ///< time of its restart
    std::chrono::milliseconds backoff{};
    bool misused = false;
    bool crashed = false;
    int beats = -1;       ///< the pipe of its heartbeats
    std::string trouble;  ///< the reason for its kill
    std::string file;     ///< identity of its program file at the start; see file_of()
    std::map<std::string, std::chrono::nanoseconds> waited;  ///< of its threads, see starved()
  };
  struct Stream {
    int fd;
    std::size_t slot;
    std::string line;
  };

  void launch(std::size_t index);
  void launch_again(std::size_t index);
  /// Sets the time of its restart: later each time, unless it had `proven` itself. Returns the
  /// delay.
  std::chrono::milliseconds put_off(Slot& slot, bool proven);
  void poll_once(std::chrono::milliseconds timeout, std::initializer_list<int> wake_fds = {});
  bool read_stream(Stream& stream);
  void reap(std::size_t index);
  void read_beats(std::size_t index);
  static std::chrono::nanoseconds starved(Slot& slot);
  void watch(BootClock::duration waited, std::chrono::milliseconds timeout);
  void renew_next();
  void say(const std::string& text) { print_({}, text); }

  std::vector<Slot> slots_;
  std::vector<Stream> streams_;  ///< outlive their child: a grandchild may hold them
  Print print_;
  std::chrono::milliseconds proven_;  ///< a child that ran this long starts afresh
  Watchdog watchdog_;
  Clock::time_point judged_;  ///< newest check for hanging children
  bool stopping_ = false;
  std::vector<std::size_t> to_renew_;    ///< the next one first
  std::optional<std::size_t> renewing_;  ///< ended for a new version, and not yet proven
};

}  // namespace saphira::cli
