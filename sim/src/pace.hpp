#pragma once

#include <sys/timerfd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "listener.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/server.hpp"

namespace saphira::sim {

// The ticks that are due by the wall clock. Time in which the whole process slept (stopped, or the
// machine suspended) is skipped, not made up.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

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
    ::timerfd_settime(fd_, 0, &spec, nullptr);
  }
  void clear() const {
    const itimerspec spec{};
    ::timerfd_settime(fd_, 0, &spec, nullptr);
  }
  int fd() const { return fd_; }

 private:
  Descriptor fd_;
};

}  // namespace saphira::sim
