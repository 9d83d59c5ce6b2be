#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

namespace saphira::test {

/// A bad line: listens on a local socket, connects to another for each client, and corrupts, drops
/// or doubles bytes in both directions, each with a third of the probability. Seeded.
class NoisyLine {
 public:
  NoisyLine(std::string listen_on, std::string connect_to, std::uint64_t seed);
  ~NoisyLine();
  NoisyLine(const NoisyLine&) = delete;
  NoisyLine& operator=(const NoisyLine&) = delete;

  /// Of a byte to, and from the robot; 0 at first.
  void set_probability(double to, double from) {
    probability_[0] = to;
    probability_[1] = from;
  }
  std::uint64_t hurt() const { return hurt_; }

 private:
  void run();
  void serve(int client);

  std::string path_;
  std::string target_;
  std::atomic<double> probability_[2]{0.0, 0.0};
  std::uint64_t seed_;
  int listener_ = -1;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> hurt_{0};
  std::thread thread_;
};

}  // namespace saphira::test
