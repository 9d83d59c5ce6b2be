#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "saphira/protocol/impossible.hpp"

namespace saphira::bridge {

/// Keeps the robot's impossible values, for the counter, the status and the log.
class Doubts {
 public:
  /// For a new connection.
  void reset() { *this = {}; }
  void add(const protocol::Impossible& impossible, double now);

  std::uint64_t count() const { return count_; }
  /// The newest doubt of the last seconds; empty: none.
  std::string newest(double now) const;
  /// New doubts, each once, and no more often than a person can read.
  std::optional<std::string> take_words(double now);

 private:
  std::uint64_t count_ = 0;
  std::string newest_;
  double at_ = 0.0;
  bool news_ = false;
  double told_ = -1e9;
};

}  // namespace saphira::bridge
