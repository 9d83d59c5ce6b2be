#pragma once

#include <array>
#include <atomic>
#include <thread>

namespace saphira::test {

/// Two hosts within this machine, 10.77.0.1 and 10.77.0.2: network namespaces with only a link
/// between them, which delays, loses and can be cut. They end with the object.
class SlowLink {
 public:
  /// std::system_error without the rights: it needs root (CAP_SYS_ADMIN and CAP_NET_ADMIN) and
  /// /dev/net/tun.
  SlowLink();
  ~SlowLink();
  SlowLink(const SlowLink&) = delete;
  SlowLink& operator=(const SlowLink&) = delete;

  /// [s] delay, and share [0..1] of lost frames, each way.
  void set(double delay, double loss) {
    delay_ = delay;
    loss_ = loss;
  }
  /// While it is cut no frame enters the link; frames on their way arrive.
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
