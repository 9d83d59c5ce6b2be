#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/sim/devices.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/sonar.hpp"
#include "saphira/sim/trace.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

/// Ticks from one information packet to the next: 100 ms (manual 5.3).
inline constexpr int kTicksPerPacket = 10;

struct ServerOptions {
  std::uint64_t seed = 1;
  bool single_step = false;        ///< from the start; otherwise from the first STEP on
  std::string name = "Simulator";  ///< Table 5-7
  bool trace = false;              ///< true: rows are kept for take_trace()
  SonarModel sonar;
  /// True where this server alone advances the scene's time, in advance() and by STEP. With several
  /// servers on one scene a Simulation does that.
  bool keeps_time = true;
};

/// The counts of the client's packets, since the simulator started.
struct ServerCounters {
  std::uint64_t commands = 0;
  std::uint64_t unknown_commands = 0;  ///< unknown or unreadable; ignored
  /// Known commands that a robot of this generation, or this simulator, does not have; ignored.
  std::uint64_t unsupported_commands = 0;
  std::uint64_t watchdog_stops = 0;
  std::uint64_t bad_packets = 0;  ///< ignored, manual 5.1.3
};

/// A robot server without its line: bytes in, ticks of time in, bytes out. It answers as the
/// generation in the robot's file: PSOS as in the manual; P2OS and ARCOS with their commands,
/// bumpers, flags and packets. Their motors wait for ENABLE after OPEN.
///
/// States (manual 5.4): waiting for SYNC0, SYNC1, SYNC2; synchronized; open. A closed or lost
/// connection stops the robot and goes back to waiting; dead reckoning goes on from where it was.
///
/// In single step, time passes in receive(), 100 ms a STEP, and advance() does nothing.
class Server {
 public:
  /// Adds its robot to the scene, which outlives it. std::invalid_argument where the robot would
  /// stand in a wall.
  Server(Scene& scene, const protocol::RobotParameters& parameters, const Pose& start_in_world,
         const ServerOptions& options);

  /// Bytes from the client.
  void receive(protocol::ByteView bytes);
  /// Lets ticks of time pass. The world stands still while no client has opened it, except for a
  /// robot that is still coming to rest, up to the end of a cycle.
  void advance(int ticks);
  /// The robot's body is elsewhere (Robot::measure), and so are its sonars.
  void measure(const Measured& body);
  /// Newer readings of them; of those that are off, none count.
  void hear(const std::vector<SonarEcho>& echoes);
  /// The robot stops at once, whatever was commanded.
  void halt() { robot_.halt(); }
  /// The client is gone.
  void disconnect();
  /// The line has been silent for longer than any pause within a packet; see PacketParser::gap. In
  /// live mode advance() does this itself.
  void gap();
  /// Tells the client that it is there, while time stands.
  void tell_status();

  // ---- For a caller that keeps the time of several servers: Scene::tick() between the first two.

  void begin_tick();
  void end_tick();
  /// A tick of live time without input; see gap().
  void quiet_tick();
  /// The client has sent STEP and waits; its later packets wait as well.
  bool step_asked() const { return step_asked_; }
  /// The step is complete.
  void end_step();
  /// The connection has been closed in single step: the robot has to come to rest at once.
  bool rest_asked() const { return rest_asked_ && runs(); }

  /// The bytes for the client.
  protocol::Bytes take_output();
  /// Rows since the last call; none unless ServerOptions::trace.
  std::vector<TraceRow> take_trace();

  bool is_open() const { return state_ == State::kOpen; }
  bool single_step() const { return single_step_; }
  /// True where advance() would have an effect.
  bool runs() const { return is_open() ? !single_step_ : robot_.moving() || phase_ != 0; }
  /// Ticks until the next information packet.
  int ticks_to_packet() const { return kTicksPerPacket - phase_; }
  /// True where bytes of a packet wait for the rest of it.
  bool packet_pending() const { return parser_.pending(); }

  const Robot& robot() const { return robot_; }
  const protocol::RobotParameters& parameters() const { return parameters_; }
  std::uint64_t cycle() const { return cycle_; }
  /// The pose of each sonar [in the robot], and its newest range [m]; those that have fired.
  std::vector<std::pair<Pose, double>> beams() const;
  ServerCounters counters() const;
  const Devices& devices() const { return devices_; }
  Devices& devices() { return devices_; }

 private:
  enum class State { kSync0, kSync1, kSync2, kSynchronized, kOpen };

  void drain();
  void handle(const protocol::Bytes& body);
  bool synchronize(const protocol::Bytes& body);
  void act(const protocol::Command& command);
  bool drive(const protocol::Command& command);
  bool simulate(const protocol::Command& command);
  void set_sonars();
  void set_default_polling();
  protocol::SimStatusPacket sim_status() const;
  void open();
  void close();
  void tick();
  void step();
  void finish_cycle();
  protocol::InformationPacket information() const;
  void add_later_fields(protocol::InformationPacket& packet) const;
  void send(const protocol::Bytes& packet);

  protocol::RobotParameters parameters_;
  ServerOptions options_;
  Scene& scene_;
  Robot& robot_;
  Sonars sonars_;
  bool measured_ = false;             // the body is elsewhere
  std::vector<std::uint8_t> firing_;  // the sonars
  protocol::PacketParser parser_;
  protocol::Bytes output_;
  std::vector<TraceRow> trace_;

  State state_ = State::kSync0;
  bool single_step_;
  bool step_asked_ = false;
  bool rest_asked_ = false;
  std::uint64_t cycle_ = 0;
  int phase_ = 0;         // ticks since the last packet
  int silent_ticks_ = 0;  // since the last good packet came
  int quiet_ticks_ = 0;   // since the last byte came
  bool first_row_ = true;
  bool watchdog_ = false;  // has stopped the motors
  std::vector<protocol::RawSonar> readings_;
  std::map<std::uint8_t, std::uint16_t> newest_;  // of each sonar, for observers
  ServerCounters counters_;

  Devices devices_;
  FastTrack vision_;
  Pose start_in_world_;
  int watchdog_ticks_;
  bool later_;                         // a later generation than PSOS
  std::vector<std::uint8_t> polling_;  // the sequence without the arrays switched off by SONAR
  std::uint8_t sonar_arrays_on_ = 0xFF;
  bool sim_status_with_each_ = false;
  bool emergency_ = false;  // since the last motion command
};

}  // namespace saphira::sim
