#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "saphira/authority/arbiter.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/base/notes.hpp"
#include "saphira/geometry/edge.hpp"
#include "saphira/idl/system.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/reflector.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::bridge {

// ---- Inputs of the core.

/// A motor command, as it came from the bus.
struct DriveCommand {
  authority::Command command;  ///< without the time: the core sets it
  reflector::Motion motion;    ///< without the driver: the core sets it
  double contact_speed = 0.0;  ///< [m/s] for wanted contact; 0: none
  std::vector<Edge> edges;     ///< [odom] of the map of the behaviors, near the robot
  std::string wrong;           ///< the parts that could not be converted; empty: none
};

/// The error in the numbers of a motor command; empty: none. Any program may write such a command.
std::string trouble(const reflector::Motion& motion, double contact_speed);

/// The surroundings that the shell sees.
struct Surroundings {
  bool link_open = false;
  std::string link_trouble = {};  ///< why it is not open
  std::string address = {};       ///< of the robot, for people
  bool serial = false;            ///< the line is the same after a loss, and so is the session
  /// Another bridge with a robot of this name, in words; empty: none.
  std::string namesake = {};
  bool has_keeper = false;
  bool keeper_alive = false;
  int keeper_restarts = 0;
};

/// The entries of other programs. A service speaks for others; any other member for itself alone,
/// of those that it let in or refused, and no more than kMost a minute, since the audit ends where
/// it begins.
class Reports {
 public:
  static constexpr std::size_t kMost = 30;

  /// The entry to keep; nothing where it is dropped. now: [s]
  std::optional<v1::AuditEntry> take(v1::AuditEntry entry, const Checked& writer, double now);

 private:
  struct Minute {
    double began = 0.0;
    std::size_t entries = 0;
  };
  std::map<std::string, Minute> minutes_;  ///< by member
};

// ---- Outputs of the core. The order counts.

/// Bytes to the robot: one or more whole packets.
struct Send {
  protocol::Bytes bytes;
};
/// The newest packet was answered by the outputs so far. The caller passes the time to
/// Core::answered.
struct Answered {};
/// A robot has identified itself. The caller calls Core::open or Core::refuse_robot.
struct Identified {
  protocol::RobotIdentity robot;
};
/// A session begins: the caller describes the robot on the bus.
struct SessionBegan {
  v1::Stamp stamp;
  protocol::RobotIdentity robot;
};
/// A cycle begins.
struct CycleBegan {
  v1::Stamp stamp;
  reflector::State state;
  std::uint64_t bad_packets = 0;  ///< of this session
};
/// The driver's setpoints, before the guard.
struct DriverSetpoints {
  reflector::Setpoints setpoints;
  double distance_left = 0.0;  ///< [m] of a position
};
/// Any packet except an information packet, for serial lines and cameras.
struct OtherPacket {
  protocol::ServerPacket packet;
  v1::Stamp stamp;
};
/// A later answer to a request (Core::request).
struct LaterAnswer {
  std::uint64_t asker = 0;
  std::uint64_t number = 0;
  Answer answer;
  std::optional<reflector::Device> device{};  ///< none: of a stop
};
/// The requests to the devices, their reports or the shown state have changed.
struct DevicesChanged {
  std::vector<reflector::DeviceRequest> requests;
  reflector::Devices::Reports reports;
  protocol::Information information;
  v1::Stamp stamp;
};
/// A setting of the vision system that a request has changed.
struct VisionSet {
  std::string text;
};
struct GrantDecided {
  authority::Grant grant;
  DriverSetpoints told;
  authority::Guarded guarded;
  std::vector<authority::Refusal> refused;
  v1::Stamp stamp;
};
/// The keeper sends these bytes when the bridge falls silent.
struct WatchLink {
  protocol::Bytes stop;
};
/// The session is over: close the link; the keeper has nothing to watch.
struct CloseLink {
  std::string why;
};
/// Save over a restart.
struct KeepLatches {
  authority::Latches latches;
};
/// Save over a restart.
struct KeepOdometry {
  reflector::OdometryMemory memory;
};

/// The status of the service.
struct Condition {
  v1::ServiceState health = v1::SERVICE_RUNNING;
  std::string reason;
};
struct StatusReport {
  Condition condition;
  v1::Stamp stamp;
  std::uint64_t steps = 0;
  std::uint64_t late = 0;     ///< cycles whose answer did not come in time
  std::uint64_t refused = 0;  ///< motor commands
  /// Once a second: the time from a packet to the commands that answer it.
  struct Reaction {
    double mean = 0.0;  ///< [s]
    double max = 0.0;   ///< [s]
  };
  std::optional<Reaction> reaction;
};

using Output =
    std::variant<Send, Answered, Identified, SessionBegan, CycleBegan, OtherPacket, LaterAnswer,
                 DevicesChanged, VisionSet, GrantDecided, WatchLink, CloseLink, KeepLatches,
                 KeepOdometry, StatusReport, Note, v1::AuditEntry>;

}  // namespace saphira::bridge
