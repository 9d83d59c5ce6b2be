#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>

namespace saphira {

/// A clock that also counts while the machine sleeps (CLOCK_BOOTTIME), unlike the steady clock, by
/// which a lease or a silence would be too short. For shells.
struct BootClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<BootClock>;
  static constexpr bool is_steady = true;  // NOLINT(readability-identifier-naming): of every clock

  static time_point now() {
    timespec t{};
    ::clock_gettime(CLOCK_BOOTTIME, &t);
    return time_point(std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec));
  }
  /// [s]
  static double seconds() {
    return std::chrono::duration<double>(now().time_since_epoch()).count();
  }
};

/// [ns] since 1970, by the machine's clock.
inline std::int64_t unix_nanoseconds() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// The same in seconds.
inline double unix_time() {
  return static_cast<double>(unix_nanoseconds()) * 1e-9;
}

/// The same in whole seconds, for dates.
inline std::int64_t unix_seconds() {
  return static_cast<std::int64_t>(unix_time());
}

}  // namespace saphira
