#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

/// Where a simulated robot stands and who may talk to it.
struct HostOptions {
  std::string world;  ///< path of a world file
  std::string robot;  ///< path of a robot parameter file
  /// Path of the local socket that is listened on; see default_socket(). Without a port only.
  std::optional<std::string> socket;
  /// TCP port that is listened on instead; 0 takes a free one and logs which.
  std::optional<std::uint16_t> tcp;
  /// Numeric address that the port is bound to. The protocol has no password: whoever reaches the
  /// port drives the robot.
  std::string tcp_address = "127.0.0.1";
  std::uint64_t seed = 1;
  bool step = false;             ///< single-step from the start
  double rate = 1.0;             ///< times real time, in (0, 1000]; in single step it says nothing
  std::string trace;             ///< path of the trace file; empty: none
  std::optional<Pose> position;  ///< start_in_world; otherwise the world file's
  /// Takes lines for the log; may be empty. Called in the thread of run().
  std::function<void(const std::string&)> log;
};

/// $ROBOT_SOCKET, otherwise /tmp/saphira-robot-<uid> (manual 3.1).
std::string default_socket();

/// Serves a simulated robot until stop_fd is readable (it is not read). One client at a time: a
/// second one's connection is closed at once, and logged. May run in a thread beside others: no
/// signals, no globals but the files named.
///
/// FileError or std::runtime_error where the options or their files are wrong, or the socket or the
/// trace cannot be had.
void run(const HostOptions& options, int stop_fd);

}  // namespace saphira::sim
