#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace saphira::cli {

/// Tells the service manager that has started this process (systemd, Type=notify) how it is. The
/// protocol is that of sd_notify(3): lines in a datagram to $NOTIFY_SOCKET. Without a manager
/// nothing happens.
class ServiceManager {
 public:
  /// Takes the two variables out of the environment, so that children do not use them.
  ServiceManager();

  /// Everything has been started.
  void ready(const std::string& status) const;
  void stopping() const;
  /// This process works: the manager starts it anew where that is not said in time.
  void alive() const;
  /// How often to say so; none: the manager does not ask for it.
  std::optional<std::chrono::milliseconds> period() const { return period_; }

 private:
  void send(const std::string& lines) const;

  std::string socket_;  ///< empty: there is no manager
  std::optional<std::chrono::milliseconds> period_;
};

}  // namespace saphira::cli
