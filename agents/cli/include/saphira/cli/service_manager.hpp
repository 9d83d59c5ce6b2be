#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace saphira::cli {

/// Reports the state of this process to the service manager that has started it (systemd,
/// Type=notify). The protocol is that of sd_notify(3): lines in a datagram to $NOTIFY_SOCKET. No
/// effect without a manager.
class ServiceManager {
 public:
  /// Takes the two variables out of the environment, so that children do not use them.
  ServiceManager();

  /// Puts the variables back, for another program in this process.
  void restore() const;
  /// Everything has been started.
  void ready(const std::string& status) const;
  void stopping() const;
  /// A sign of life: without it in time, the manager restarts this process.
  void alive() const;
  /// The period of the sign of life; none: the manager does not require it.
  std::optional<std::chrono::milliseconds> period() const { return period_; }

 private:
  void send(const std::string& lines) const;

  std::string socket_;  ///< empty: no manager
  std::string microseconds_;
  std::optional<std::chrono::milliseconds> period_;
};

}  // namespace saphira::cli
