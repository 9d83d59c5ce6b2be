#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "saphira/protocol/check.hpp"

namespace saphira::sim {

/// The strict checker on a simulated robot's line: violations of the protocol's tables are appended
/// to a file, a line each, at once and in one write, so that several simulators may share the file
/// and a killed one has written all its findings.
class LineCheck {
 public:
  /// `prefix` begins each line. std::runtime_error where the file cannot be written.
  LineCheck(const std::string& path, std::string prefix,
            const protocol::RobotParameters& parameters);
  ~LineCheck();
  LineCheck(const LineCheck&) = delete;
  LineCheck& operator=(const LineCheck&) = delete;

  /// The time [s] as for the checker: only where the robot's time is the client's.
  void pass(protocol::Side side, protocol::ByteView bytes, std::optional<double> time);
  /// The connection is closed: also writes the summary since the beginning.
  void disconnect();

 private:
  void report();
  void write(const std::string& text) const;

  std::string prefix_;
  int file_;
  protocol::Checker checker_;
  std::size_t reported_ = 0;
};

/// $SAPHIRA_CHECK, otherwise empty.
std::string default_check();

}  // namespace saphira::sim
