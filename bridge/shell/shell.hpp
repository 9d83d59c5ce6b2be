#pragma once

#include <poll.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera.hpp"
#include "latch_file.hpp"
#include "other_programs.hpp"
#include "position_file.hpp"
#include "requests/shell/desk.hpp"
#include "saphira/bridge/core.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/security/audit_file.hpp"
#include "saphira/transport/keeper.hpp"
#include "saphira/transport/link.hpp"

namespace saphira::bridge {

struct BridgeOptions {
  std::string robot_port = transport::default_address();
  std::string robots_folder = "config/robots";  ///< of the parameter files
  /// The parameter file of a robot that names its class and subclass, or the name of a file in that
  /// folder; empty: none. Other robots get theirs by their identity.
  std::string parameter_file;
  double lease = 0.3;                                      ///< [s] in lockstep cycles x 0.1
  double quiet = std::numeric_limits<double>::infinity();  ///< [s] authority::Settings
  bool guard = true;
  double contact_speed = 0.15;  ///< [m/s] at most, for a driver who wants contact; 0: never
  double guard_margin = 0.25;   ///< [m] CoreSettings
  /// Keeps the odom frame over a restart, and with ".latched" behind its name an emergency stop.
  /// With ".audit" behind it the audit is kept. Empty: none.
  std::string state_file;
  bool free_step = false;  ///< lockstep: step without a permit
  /// The commands to the camera of a Fast Track vision system at the start (manual 9.1), such as
  /// "pioneer_a_mode=2"; empty: none, so no packets are requested.
  std::vector<std::string> vision;
  bool keeper = true;
};

/// The options with the path of the parameter file. std::invalid_argument for a wrong one, or a
/// file that is not there.
BridgeOptions checked(BridgeOptions options);

/// The bridge as a service: one robot server on one side, the bus on the other. It carries bytes,
/// samples, files and the time to the core (saphira/bridge/core.hpp), and executes the core's
/// outputs.
class Shell {
 public:
  /// std::invalid_argument for a wrong option; std::runtime_error where the bus fails.
  Shell(const bus::NodeOptions& node, BridgeOptions options,
        std::shared_ptr<bus::MemoryBus> memory = nullptr);

  /// Runs until stop is requested. Returns an exit code (bus::Exit).
  int run(const bus::Stop& stop);

  // ---- The same in steps that never wait, for a caller with its own loop.

  /// Its inputs.
  struct Ready {
    bool link = true;
    bool bus = true;
  };
  /// Takes the inputs, and does all due work.
  void advance(Ready ready);
  /// The descriptors to poll before the next advance: the link (a descriptor below 0 while it is
  /// closed), and the bus.
  std::array<pollfd, 2> descriptors() const;
  /// The longest time to the next advance [ms].
  int timeout_ms() const;
  /// Stops the robot and releases it.
  void end();

 private:
  void tend_link();
  void receive();
  void take_all(double now);
  void take_requests(Desk& desk);
  void take_drives(authority::Role role, bus::Reader<v1::MotorCommand>& reader, double now);

  /// Executes the core's outputs until there are none.
  void work(double now);
  void deliver(double now);
  void perform(const Send& send, double now);
  void perform(const Answered&, double now);
  void perform(const Identified& identified, double now);
  void perform(const SessionBegan& session, double now);
  void perform(const CycleBegan& cycle, double now);
  void perform(const OtherPacket& other, double now);
  void perform(const LaterAnswer& later, double now);
  void perform(const DevicesChanged& changed, double now);
  void perform(const VisionSet& set, double now);
  void perform(const GrantDecided& decided, double now);
  void perform(const WatchLink& watch, double now);
  void perform(const CloseLink& close, double now);
  void perform(const KeepLatches& keep, double now);
  void perform(const KeepOdometry& keep, double now);
  void perform(const StatusReport& report, double now);
  void perform(const Note& note, double now);
  void perform(const v1::AuditEntry& entry, double now);
  void take_audit(double now);
  void tell_audit(const std::string& trouble);
  void tend_files(double now);
  Surroundings surroundings() const;
  bool link_is_open() const { return link_.state() == transport::Link::State::open; }

  BridgeOptions options_;
  bool lockstep_;
  std::unique_ptr<transport::Keeper> keeper_;
  bus::Node node_;

  bus::Writer<v1::RobotState> state_writer_ = node_.writer(bus::topics::kRobotState);
  bus::Writer<v1::SonarBuckets> buckets_writer_ = node_.writer(bus::topics::kSonarBuckets);
  bus::Writer<v1::RobotDescription> description_writer_ =
      node_.writer(bus::topics::kRobotDescription);
  bus::Writer<v1::Grant> grant_writer_ = node_.writer(bus::topics::kGrant);
  bus::Writer<v1::RobotState> state_recall_ = node_.writer(bus::topics::kRecallRobot);
  bus::Writer<v1::Grant> grant_recall_ = node_.writer(bus::topics::kRecallGrant);
  bus::Reader<v1::MotorCommand> estop_ = node_.reader(bus::topics::kDriveEstop);
  bus::Reader<v1::MotorCommand> teleop_ = node_.reader(bus::topics::kDriveTeleop);
  bus::Reader<v1::MotorCommand> direct_ = node_.reader(bus::topics::kDriveDirect);
  bus::Reader<v1::MotorCommand> behaviors_ = node_.reader(bus::topics::kDriveBehaviors);
  /// Of all desks.
  const Desk::Answers answers_ =
      std::make_shared<bus::Writer<v1::Answer>>(node_.writer(bus::topics::kRobotAnswers));
  Desk stops_;
  Desk resets_;                ///< of the emergency stop
  std::vector<Desk> devices_;  ///< in the order of reflector::Device
  bus::Writer<v1::Devices> devices_writer_ = node_.writer(bus::topics::kDevices);
  bus::Writer<v1::SerialData> serial_writer_ = node_.writer(bus::topics::kSerialData);
  bus::Reader<v1::StepPermit> permits_ = node_.reader(bus::topics::kStepPermit);
  OtherPrograms other_programs_;

  transport::Link link_;
  Core core_;
  std::optional<Camera> camera_;
  PositionFile position_file_;
  LatchFile latch_file_;
  bus::Reader<v1::AuditEntry> audit_reader_ = node_.reader(bus::topics::kAudit);
  std::optional<security::AuditFile> audit_file_;
  std::string audit_trouble_;
  Reports reports_;

  v1::RobotState newest_state_;
  v1::Stamp recalled_;  ///< of the newest state in recall
  std::vector<std::uint8_t> input_;
  double last_beat_ = 0.0;  ///< [s] of the keeper
  double begun_ = 0.0;      ///< [s]
  double tended_ = 0.0;     ///< [s]
};

}  // namespace saphira::bridge
