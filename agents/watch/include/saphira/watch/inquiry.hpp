#pragma once

#include <cstdint>
#include <string>

#include "saphira/watch/mind.hpp"

namespace saphira::watch {

constexpr double kMindPatience = 3.0;  ///< [s] for the first sample

/// Gathers all samples that explain a cycle.
class Inquiry {
 public:
  /// asked: a cycle; below 0: so many before the newest [0: the newest].
  Inquiry(bus::Node& node, std::int64_t asked) : asked_(asked), mind_(node, asked != 0) {}

  /// Takes samples. True where no others are waited for. Call after each wait.
  bool poll();
  /// Why there is no explanation; empty: there is one. After poll().
  std::string missing() const;
  situation::Situation situation() const { return mind_.situation(cycle_, asked_ != 0); }

 private:
  std::int64_t asked_;
  Mind mind_;
  std::uint64_t cycle_ = 0;
  Clock::time_point began_ = Clock::now();
  std::uint64_t oldest_ = 0;  ///< cycle: recall ends with its oldest
  Clock::time_point grown_ = began_;
};

}  // namespace saphira::watch
