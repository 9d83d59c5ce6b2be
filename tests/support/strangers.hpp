#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace saphira::test {

/// Somebody without credentials who announces programs that there are none of: copies of an
/// announcement that was heard on the loopback of a DDS domain, each with another identifier.
class Strangers {
 public:
  /// Waits until a program of the domain announces itself; std::runtime_error where none does.
  explicit Strangers(unsigned domain);
  ~Strangers();
  Strangers& operator=(Strangers&&) = delete;

  /// Announces so many, at so many a second. `programs`: these again and again [0: each is another
  /// one].
  void announce(int count, int per_second, int programs = 0);

 private:
  int sender_;
  std::uint16_t port_;
  std::string heard_;
  std::mt19937_64 random_{1};
};

}  // namespace saphira::test
