#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "saphira/authority/arbiter.hpp"
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
  std::string robots_folder = "config/robots";  ///< of the parameter files
  double lease = 0.3;                           ///< [s] in lockstep cycles x 0.1
  double quiet = 2.0;                           ///< [s]
  bool guard = true;
  std::string state_file;  ///< keeps the odom frame over a restart; empty: none
  bool free_step = false;  ///< lockstep: step without a permit
  /// What is said to the camera of a Fast Track vision system at the start (manual 9.1), such as
  /// "pioneer_a_mode=2"; empty: it is not asked for packets.
  std::vector<std::string> vision;
  bool keeper = true;  ///< needs a process with one thread: not where services share a process
};

/// The bridge as a service: one robot server on one side, the bus on the other.
class Shell {
 public:
  /// std::invalid_argument for a wrong option; std::runtime_error where the bus fails. Forks the
  /// keeper before the node makes its threads.
  Shell(const bus::NodeOptions& node, BridgeOptions options,
        std::shared_ptr<bus::MemoryBus> memory = nullptr);
  ~Shell();

  /// Until stop is requested. An exit code (bus::Exit).
  int run(const bus::Stop& stop);

 private:
  /// The clock of authority and reflector: BootClock live, cycles in lockstep.
  double time() const;
  int timeout_ms(double now) const;

  // The robot's side.
  void tend_link(double now);
  void receive(double now);
  void packet(const protocol::Bytes& body, double now);
  void opened(double now);
  void information(const protocol::InformationPacket& packet, double now);
  void ask_vision(double now);
  void vision(const protocol::VisionPacket& packet);
  void other(const protocol::ServerPacket& any, protocol::ByteView body, double now);
  void told(const protocol::ConfigPacket& robot);
  bool motors_off() const;
  bool send(const protocol::Bytes& packet, double now);
  void lost(const std::string& why, double now);
  /// Whether the loop was heard in time; if not, all that was received before counts as old.
  void mind_gap(double now);

  // The bus's side.
  void take_all(double now);
  void take_others();
  struct Drive;
  bool take_drive(Drive& drive, double now);
  void take_devices();
  template <class T>
  void take_device(bus::Reader<T>& reader, v1::Device device);
  void publish_devices();

  // Between the two.
  void decide();
  void flush(double now);
  void step(double now);
  void publish_grant();
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
  };
  std::vector<Drive> drives_;
  bus::Writer<v1::Devices> devices_writer_;
  bus::Writer<v1::SerialData> serial_data_writer_;
  std::optional<bus::Writer<v1::VisionChannels>> channels_writer_;  ///< where there is a camera
  bus::Reader<v1::ServoCommand> servo_;
  bus::Reader<v1::GripperCommand> gripper_;
  bus::Reader<v1::DigitalOutputCommand> output_;
  bus::Reader<v1::AnalogCommand> analog_;
  bus::Reader<v1::TimerCommand> timer_;
  bus::Reader<v1::SonarCommand> sonar_;
  bus::Reader<v1::SoundCommand> sound_;
  bus::Reader<v1::ServerCommand> server_;
  bus::Reader<v1::SerialCommand> serial_;
  std::size_t device_writers_ = 0;  ///< that were matched at the last look
  bus::Reader<v1::StepPermit> permits_;
  bus::Reader<v1::ServiceStatus> statuses_;
  std::map<bus::WriterId, std::string> others_;  ///< bridges that serve a robot of this name

  transport::Link link_;
  protocol::PacketParser parser_;
  reflector::Connection connection_;
  reflector::Reflector reflector_;
  authority::Arbiter arbiter_;
  authority::Echoes echoes_;
  authority::Body body_;
  std::vector<std::string> words_;                  ///< to be logged when the packets are out
  std::array<authority::GuardSettings, 5> guards_;  ///< by role

  std::uint64_t epoch_ = 0;  ///< 0: no session
  std::uint64_t last_epoch_ = 0;
  std::uint64_t last_odom_ = 0;
  std::optional<reflector::OdometryMemory> memory_;
  reflector::Slack slack_;
  int state_fd_ = -1;
  v1::Stamp stamp_;
  v1::RobotState newest_state_;
  v1::Stamp recalled_;  ///< of the newest state that was put where it is recalled
  authority::Grant grant_;
  authority::Guarded guarded_;
  std::vector<std::uint8_t> input_;
  /// Of the information packet, what robot/devices shows; it is written when this changes.
  using Shown =
      std::tuple<std::uint8_t, std::uint8_t, std::optional<bool>, std::optional<bool>,
                 std::optional<std::uint16_t>, std::optional<std::uint8_t>, std::optional<double>,
                 std::optional<double>, std::uint8_t, std::optional<double>>;
  Shown shown_;

  // Steady seconds.
  double last_loop_ = 0.0;
  double last_bytes_ = 0.0;
  double last_packet_ = 0.0;
  double last_beat_ = 0.0;
  double hold_off_ = 0.0;    ///< the robot is not asked before
  double expires_at_ = 0.0;  ///< the lease of the one who drives
  double flush_at_ = 0.0;    ///< what is due is sent then, if the driver says nothing before; 0: no
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
  std::uint64_t vision_asked_ = 0;            ///< cycle
  std::deque<std::uint64_t> vision_packets_;  ///< cycles of those of the last second
};

}  // namespace saphira::bridge
