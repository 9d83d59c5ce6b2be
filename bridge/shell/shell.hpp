#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera.hpp"
#include "device_topics.hpp"
#include "doubts.hpp"
#include "latch_file.hpp"
#include "other_programs.hpp"
#include "position_file.hpp"
#include "saphira/authority/arbiter.hpp"
#include "saphira/authority/echo_map.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/connection.hpp"
#include "saphira/reflector/reflector.hpp"
#include "saphira/transport/keeper.hpp"
#include "saphira/transport/link.hpp"

namespace saphira::bridge {

struct BridgeOptions {
  std::string robot_port = transport::default_address();
  std::string robots_folder = "config/robots";             ///< of the parameter files
  double lease = 0.3;                                      ///< [s] in lockstep cycles x 0.1
  double quiet = std::numeric_limits<double>::infinity();  ///< [s] authority::Settings
  bool guard = true;
  double contact_speed = 0.15;  ///< [m/s] at the most where a driver means contact; 0: never
  /// Keeps the odom frame over a restart, and with ".latched" behind its name an emergency stop;
  /// empty: none.
  std::string state_file;
  bool free_step = false;  ///< lockstep: step without a permit
  /// What is said to the camera of a Fast Track vision system at the start (manual 9.1), such as
  /// "pioneer_a_mode=2"; empty: it is not asked for packets.
  std::vector<std::string> vision;
  bool keeper = true;
};

/// The bridge as a service: one robot server on one side, the bus on the other.
class Shell {
 public:
  /// std::invalid_argument for a wrong option; std::runtime_error where the bus fails.
  Shell(const bus::NodeOptions& node, BridgeOptions options,
        std::shared_ptr<bus::MemoryBus> memory = nullptr);

  /// Until stop is requested. An exit code (bus::Exit).
  int run(const bus::Stop& stop);

 private:
  /// The clock of authority and reflector: BootClock live, cycles in lockstep.
  double time() const;
  int timeout_ms(double now) const;

  // The robot's side.
  void tend_link(double now);
  void beat(double now);
  void receive(double now);
  void packet(const protocol::Bytes& body, double now);
  void opened(double now);
  void information(const protocol::InformationPacket& packet, double now);
  void other(const protocol::ServerPacket& any, std::uint8_t type, double now);
  void heed(const protocol::ConfigPacket& set);
  bool send(const protocol::Bytes& packet, double now);
  void lost(const std::string& why, double now);
  /// Whether the loop was heard in time; if not, all that was received before counts as old.
  void mind_gap(double now);

  // The bus's side.
  void take_all(double now);
  struct Drive;
  bool take_drive(Drive& drive, double now);
  void take_resets();
  void keep_latches();

  // Between the two.
  void decide();
  double contact_speed_of(authority::Role role) const;
  void flush(double now);
  void step(double now);
  void publish_grant();
  bool motors_off() const;
  /// What the status says of the service, and why.
  struct Condition {
    v1::ServiceState state = v1::SERVICE_RUNNING;
    std::string reason;
  };
  Condition condition(double now) const;
  void publish_status(double now);
  void remember();

  bool in_memory_;
  BridgeOptions options_;
  bool lockstep_;
  std::unique_ptr<transport::Keeper> keeper_;
  bus::Node node_;

  bus::Writer<v1::RobotState> state_writer_;
  bus::Writer<v1::RobotDescription> description_writer_;
  bus::Writer<v1::Grant> grant_writer_;
  bus::Writer<v1::RobotState> state_recall_;
  bus::Writer<v1::Grant> grant_recall_;
  struct Drive {
    authority::Role role;
    bus::Reader<v1::MotorCommand> reader;
    reflector::Motion motion;     ///< of the newest accepted command
    bool follows_cycles = false;  ///< the same: answers each packet
    double contact_speed = 0.0;   ///< [m/s] the same: contact is meant
  };
  std::vector<Drive> drives_;
  bus::Reader<v1::EstopReset> resets_;
  bus::Reader<v1::StepPermit> permits_;
  OtherPrograms other_programs_;

  transport::Link link_;
  protocol::PacketParser parser_;
  Doubts doubts_;
  reflector::Connection connection_;
  reflector::Reflector reflector_;
  DeviceTopics devices_;
  std::optional<Camera> camera_;
  authority::Arbiter arbiter_;
  authority::EchoMap echoes_;
  authority::Body body_;
  std::vector<std::string> words_;                  ///< to be logged when the packets are out
  std::array<authority::GuardSettings, 5> guards_;  ///< by role

  std::uint64_t epoch_ = 0;  ///< 0: no session
  std::uint64_t last_epoch_ = 0;
  std::uint64_t last_odom_ = 0;
  std::optional<reflector::OdometryMemory> memory_;
  reflector::Slack slack_;
  PositionFile position_file_;
  LatchFile latch_file_;
  authority::Latches kept_;  ///< what the file has
  v1::Stamp stamp_;
  v1::RobotState newest_state_;
  v1::Stamp recalled_;  ///< of the newest state that was put where it is recalled
  authority::Grant grant_;
  authority::Guarded guarded_;
  std::vector<std::uint8_t> input_;

  // Steady seconds.
  double last_loop_ = 0.0;
  double last_bytes_ = 0.0;
  double last_packet_ = 0.0;
  double last_heard_ = 0.0;  ///< an information packet, though it could not be true
  double last_beat_ = 0.0;
  double keeper_new_until_ = 0.0;  ///< the status tells that the keeper was replaced
  double hold_off_ = 0.0;          ///< the robot is not asked before
  double expires_at_ = 0.0;        ///< the lease of the one who drives
  double flush_at_ = 0.0;  ///< what is due is sent then, if the driver says nothing before; 0: no
  bool link_silent_ = false;
  bool grant_changed_ = false;
  std::uint64_t bad_before_ = 0;  ///< of the parser, when the epoch began
  std::string robot_trouble_;     ///< why a connected robot is not served

  // Lockstep.
  std::uint64_t permit_ = 0;
  std::uint64_t answered_ = 0;  ///< the cycle that behaviors answered last
  bool stepping_ = false;       ///< a STEP is under way
  bool stepped_ = false;        ///< this cycle was decided and sent

  // Status, of the last second.
  double status_at_ = 0.0;
  double reaction_at_ = 0.0;
  double reaction_sum_ = 0.0;
  double reaction_max_ = 0.0;
  int reactions_ = 0;
  bool reacted_ = true;
  std::uint64_t late_ = 0;
  std::uint64_t malformed_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace saphira::bridge
