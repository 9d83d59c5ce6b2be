#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"

namespace saphira::bench {

inline constexpr std::uint32_t kDomain = 198;

/// A node of a ping, beside the programs that are measured. `security` as in NodeOptions.
bus::NodeOptions ping_options(const std::string& program, const std::string& security);

/// Answers each command with a state of its number, until it is ended.
[[noreturn]] void echo(const std::string& security);

/// Two hops over the bus and nothing between: a command to another process (`echo`) and its state.
class RoundTrip {
 public:
  /// Waits for the other process; std::runtime_error without it.
  explicit RoundTrip(const std::string& security);

  void measure();
  /// [us]
  double quantile(double share) const;
  std::size_t answered() const { return times_.size(); }

 private:
  std::optional<double> ping(std::chrono::milliseconds limit);  // [us]

  bus::Node node_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Reader<v1::RobotState> states_;
  std::uint64_t number_ = 0;
  std::vector<double> times_;
};

}  // namespace saphira::bench
