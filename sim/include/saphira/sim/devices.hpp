#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/vision.hpp"

namespace saphira::sim {

/// A gripper with paddles that open and close and a lift; each motion takes time.
class Gripper {
 public:
  void act(int action);  ///< protocol::GripperAction; others are ignored
  void cycle();          ///< 100 ms

  /// The byte of the information packet, as Player reads it: bit 0 open, 1 closed, 2 paddles
  /// moving, 4 lift up, 5 lift down, 6 lift moving.
  std::uint8_t bits() const;
  int action() const { return action_; }  ///< the last command

 private:
  /// A motion between two end stops.
  struct Axis {
    double position = 0.0;  // 0 to 1
    int direction = 0;
    void cycle(double step);
  };
  Axis paddles_{1.0, 0};  // 1: open
  Axis lift_;             // 1: up
  int action_ = 0;
};

/// The Fast Track Vision System (manual 9): three channels, each of which detects objects of one
/// color. It sends packets from the first VISION_COM of a connection on.
class FastTrack {
 public:
  /// A setting of protocol::parse_vision_setting; true for one. The line parameters are those of
  /// manual 9.1; a line's rows are the slices, counted from the bottom one.
  bool act(const std::string& text);
  void disconnect() { *this = {}; }

  bool on() const { return on_; }
  protocol::VisionPacket look(const Scene& scene, RobotNumber robot) const;

 private:
  struct Channel {
    protocol::VisionChannel::Mode mode = protocol::VisionChannel::Mode::kBlob;
    std::string color;
  };
  struct Lines {
    int bottom = 0;  // [pixels] the first row
    int slices = Camera{}.rows;
    int size = 1;  // [pixels] of a slice
    int mass = 1;  // [pixels] that make a segment
  };
  void find_line(const Blob& blob, const Camera& camera, protocol::VisionChannel& channel) const;

  bool on_ = false;
  Lines lines_;
  std::array<Channel, 3> channels_{{{{}, "red"}, {{}, "green"}, {{}, "blue"}}};
};

/// The devices of a robot besides wheels and sonars, and their packets on request: configuration,
/// encoders, I/O, gripper, gyro, joystick, battery. A request has the value 0 (no more), 1 (one, at
/// once) or 2 (one with each information packet).
class Devices {
 public:
  Devices(const protocol::RobotParameters& parameters, const std::string& name);

  enum class Answer {
    kTaken,
    kMissing,  ///< a command for a device that this robot does not have
    kNotMine,
  };
  /// Takes a command for a device. Its immediate packets are added to `out`.
  Answer act(const protocol::Command& command, const Robot& robot, protocol::Bytes& out);

  void tick();   ///< 10 ms
  void cycle();  ///< 100 ms
  /// The packets that were requested with each information packet.
  void add_packets(const Robot& robot, protocol::Bytes& out) const;
  /// Fills in its fields of the information packet.
  void reflect(protocol::InformationPacket& packet) const;
  /// The connection has been closed: all requests end.
  void disconnect();

  std::uint8_t digital_output() const { return digital_output_; }
  const Gripper& gripper() const { return gripper_; }
  int bump_stall() const { return bump_stall_; }  ///< bit 0: the front bumpers stall, 1: the rear

  // Inputs from the world.

  /// A bit for each pin. A changed bit is the event that ends a timer of its pin.
  void set_digital_input(std::uint8_t bits);
  std::uint8_t digital_input() const { return digital_input_; }
  /// The ports of analog inputs: a robot of PSOS has one, of which every packet tells.
  std::size_t analog_ports() const { return later_ ? kAnalogPorts : 1; }
  void set_analog(std::uint8_t value, std::size_t port = 0) { analogs_.at(port) = value; }
  std::uint8_t analog(std::size_t port) const {  ///< [5 V / 255]
    return port < analogs_.size() ? analogs_[port] : std::uint8_t{0};
  }
  double head() const;                            ///< [rad] direction of the cameras in the robot
  std::uint16_t timer() const { return timer_; }  ///< [ms] of the input timer; PSOS

 private:
  static constexpr std::size_t kAnalogPorts = 8;
  enum Request { kConfig, kEncoder, kIo, kGripper, kGyro, kJoystick, kBattery, kRequests };

  Answer act(const protocol::Integer& command, const Robot& robot, protocol::Bytes& out);
  bool has(Request request) const;
  Answer ask(Request request, int mode, const Robot& robot, protocol::Bytes& out);
  protocol::Bytes packet(Request request, const Robot& robot) const;

  protocol::RobotParameters parameters_;
  std::string name_;
  bool later_;  // than PSOS
  std::array<bool, kRequests> with_each_{};
  Gripper gripper_;
  std::uint8_t digital_output_ = 0;
  std::uint8_t digital_input_ = 0;
  std::array<std::uint8_t, kAnalogPorts> analogs_{};
  std::uint8_t analog_port_ = 0;
  std::uint16_t timer_ = 0;
  std::optional<std::uint8_t> timer_pin_;  ///< of a timer that runs
  std::uint16_t ptu_ = 0;                  ///< [us] as commanded
  double servo_ = 0.0;  ///< [us] where the servo of a head is; others are there at once
  int bump_stall_ = 0;
  int sounding_ = 0;
};

}  // namespace saphira::sim
