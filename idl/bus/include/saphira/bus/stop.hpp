#pragma once

#include <atomic>

namespace saphira::bus {

/// Ends a program's loops: by request() from any thread, or by signals after
/// stop_on_signals().
class Stop {
 public:
  Stop();
  ~Stop();
  Stop(const Stop&) = delete;
  Stop& operator=(const Stop&) = delete;

  void request();
  bool requested() const { return requested_.load(std::memory_order_acquire); }
  int fd() const { return fd_; }  ///< readable from the request on

 private:
  int fd_;
  std::atomic<bool> requested_{false};
};

/// SIGINT, SIGTERM and SIGHUP request this stop, which must outlive the signals. One a process.
/// Where this stop has not ended 30 s after the last of them, the program is ended hard.
void stop_on_signals(Stop& stop);

}  // namespace saphira::bus
