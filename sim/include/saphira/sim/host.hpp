#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::sim {

/// Times real time, without a limit; see HostOptions::rate.
inline constexpr double kMaxRate = std::numeric_limits<double>::infinity();

class ViewFeed;

/// One more robot in the same world.
struct RobotOptions {
  std::string robot;             ///< path of a robot parameter file; empty: as the first robot
  std::optional<Pose> position;  ///< start_in_world; otherwise the world file's next one
};

/// A simulated robot's world, place and connections.
struct HostOptions {
  std::string world;  ///< path of a world file
  /// Path of a second file with further things and people in that world; empty: none.
  std::string things;
  std::string robot;  ///< path of a robot parameter file
  /// Path of the local socket for clients; see default_socket(). Without a port only.
  std::optional<std::string> socket;
  /// TCP port for clients instead; 0 takes a free one and logs it.
  std::optional<std::uint16_t> tcp;
  /// Numeric address of the port. The protocol has no password: anyone who reaches the port drives
  /// the robot.
  std::string tcp_address = "127.0.0.1";
  /// Path of a symbolic link to a pseudo-terminal for the client instead, like a serial line. Of
  /// further robots as with the socket.
  std::optional<std::string> terminal;
  std::uint64_t seed = 1;
  bool step = false;  ///< single-step from the start
  /// Times real time, in (0, 1000], or kMaxRate: as fast as the machine computes and the clients
  /// answer. Not used in single step.
  double rate = 1.0;
  std::string trace;             ///< path of the trace file; empty: none
  std::optional<Pose> position;  ///< start_in_world; otherwise the world file's
  /// The second robot, the third, ... Number n listens on the next port but n - 2, or on the socket
  /// with "-n" behind it, and its trace is written likewise: run-2.csv.
  std::vector<RobotOptions> more;
  /// File for violations of the protocol's tables, which are appended; none:
  /// that of $SAPHIRA_CHECK; empty: no check.
  std::optional<std::string> check;
  /// Folder for the pictures of the robot's stereo cameras, one each cycle; empty: none. Of further
  /// robots as with the trace: numbered().
  std::string stereo;
  /// Local socket that sends the same pictures to each client. README, "Vision".
  std::optional<std::string> stereo_socket;
  /// Local socket that sends pictures in colour, for people.
  std::optional<std::string> camera_socket;
  /// Local socket of the simulator's own view (view.hpp): the true state, and people's actions.
  std::optional<std::string> view_socket;
  /// File with the places of all that moves, written at the end and taken at the start, so that a
  /// new version goes on where this one ends; empty: none.
  std::string state;
  /// The names of the files that the view may load, looked for anew each time; absent: none.
  std::function<std::vector<std::string>()> worlds;
  std::function<std::vector<std::string>()> robots;
  /// The file of such a world or robot.
  std::function<std::string(const std::string& name)> world_file;
  std::function<std::string(const std::string& name)> robot_file;
  /// Takes lines for the log, with their level (log_line.hpp); may be empty. Called in the thread
  /// of run().
  std::function<void(std::string_view level, const std::string& text)> log;
};

/// The view may load the files that are shipped in `config`, and those beside the given world and
/// robot file, which come first; by their names without ending, and no others.
void offer_files(HostOptions& options, const std::string& config);

/// $ROBOT_SOCKET, otherwise /tmp/saphira-robot-<uid> (manual 3.1).
std::string default_socket();

/// /tmp/saphira-robot-<uid>.tty.
std::string default_terminal();

/// The name of a file or socket for robot `number`, which counts from 1: "run.csv", "run-2.csv".
std::string numbered(const std::string& path, std::size_t number);

/// Serves simulated robots, with one client each: a second client's connection is closed at once,
/// and logged. May run in a thread beside others: no signals, no globals except the named files.
class Host {
 public:
  /// FileError or std::runtime_error where the options or their files are wrong, or the socket or
  /// the trace cannot be opened.
  explicit Host(const HostOptions& options);
  ~Host();

  /// Serves inputs that are here, or come within so many milliseconds; below zero: without end.
  /// False where stop_fd is readable (it is not read).
  bool serve(int stop_fd, int most_ms = -1);
  /// Closes the clients' connections and ends the traces.
  void end();

 private:
  /// Loads another world or robot, by its name; where that fails everything stays as it is.
  void change(const std::string& world, const std::string& robot);
  void take_state();

  friend void check(const HostOptions& options);

  struct Parts;
  HostOptions options_;
  std::unique_ptr<ViewFeed> view_;
  std::unique_ptr<Parts> parts_;
};

/// Places the robots in their world as a host does, and opens nothing. Throws as a host does.
void check(const HostOptions& options);

/// Serves until stop_fd is readable.
void run(const HostOptions& options, int stop_fd);

}  // namespace saphira::sim
