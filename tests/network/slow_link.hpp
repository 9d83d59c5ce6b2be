#pragma once

#include <array>
#include <atomic>
#include <thread>

namespace saphira::test {

/// Two hosts within this machine, 10.77.0.1 and 10.77.0.2: network namespaces with nothing between
/// them but a link that delays, loses and can be cut. They go with the object.
class SlowLink {
 public:
  /// std::system_error where this is not allowed: it needs root (CAP_SYS_ADMIN and CAP_NET_ADMIN)
  /// and /dev/net/tun.
  SlowLink();
  ~SlowLink();
  SlowLink(const SlowLink&) = delete;
  SlowLink& operator=(const SlowLink&) = delete;

  /// [s] each way, and the part [0..1] of all frames that is lost, each way.
  void set(double delay, double loss) {
    delay_ = delay;
    loss_ = loss;
  }
  /// While it is cut nothing enters the link; what is on its way arrives.
  void cut(bool is_cut) { cut_ = is_cut; }

  /// The file descriptor of a host's network namespace, for setns.
  int network(int host) const { return networks_[static_cast<std::size_t>(host)]; }
  static const char* address(int host) { return host == 0 ? "10.77.0.1" : "10.77.0.2"; }

 private:
  void relay();

  std::array<int, 2> networks_{-1, -1};
  std::array<int, 2> taps_{-1, -1};
  std::atomic<double> delay_{0.0};
  std::atomic<double> loss_{0.0};
  std::atomic<bool> cut_{false};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace saphira::test
