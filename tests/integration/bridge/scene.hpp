#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "process.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/sim/trace.hpp"

namespace saphira::test {

/// A simulator, a bridge, and a driver on the bus, each of which a test may disturb. In lockstep
/// the robot steps up to its permit, as fast as the machine allows.
class Scene {
 public:
  explicit Scene(bool lockstep = false);

  /// 20 m x 20 m of free floor with the robot in the middle, unless a test writes another.
  std::string world = "width 20000 height 20000\nposition 10000 10000 0\n";
  std::vector<std::string> bridge_options;
  std::string robot_file = "pioneer.p";  ///< of the simulator; without a folder in config/robots
  /// Instead of the simulator's socket.
  std::string robot_port;

  void start_simulator();
  void start_bridge();
  void start() {
    start_simulator();
    start_bridge();
  }

  // ---- The driver. It publishes `command` on `role`'s topic, every 50 ms while the scene watches
  // and
  // ---- `drives` is set.
  void use(const bus::Topic<v1::MotorCommand>& role);
  v1::MotorCommand command;
  bool drives = false;
  bool follows_cycles = true;  ///< stamps its commands with the newest robot state
  void publish();
  /// In lockstep: permits the robot's steps up to that cycle.
  void permit(std::uint64_t last);

  /// Watches and drives until the condition holds; false when the time is up.
  bool until(const std::function<bool()>& condition,
             std::chrono::milliseconds limit = std::chrono::seconds(30));
  void watch(std::chrono::milliseconds time);
  /// Asks the bridge, and drives until the end of the request.
  v1::Answer ask(const bus::RequestTopic& topic, const std::string& functor,
                 const std::vector<v1::Argument>& arguments = {});

  v1::RobotState state;
  v1::Grant grant;
  std::optional<v1::RobotDescription> description;
  v1::ServiceStatus status;  ///< the bridge's
  v1::Devices devices;
  std::vector<v1::Grant> grants;
  std::vector<v1::RobotState> states;

  bool connected() const { return state.stamp.cycle > 0; }
  bool rests() const;

  /// The true states, from the simulator's trace; those of the newest connection alone.
  std::vector<sim::TraceRow> trace() const;
  std::vector<sim::TraceRow> whole_trace() const;
  /// In lockstep: ends the simulator, which completes its trace; returns the trace.
  std::vector<sim::TraceRow> end();
  std::string bridge_log() const { return bridge->output(); }

  TempDir folder;
  std::string robot = unique_robot();
  bus::Node node;
  std::unique_ptr<Process> simulator;
  std::unique_ptr<Process> bridge;

 private:
  void take();

  bool lockstep_;
  int runs_ = 0;
  bus::Reader<v1::RobotState> states_;
  bus::Reader<v1::RobotDescription> descriptions_;
  bus::Reader<v1::Grant> grants_;
  bus::Reader<v1::ServiceStatus> statuses_;
  bus::Reader<v1::Devices> devices_;
  bus::Writer<v1::StepPermit> permits_;
  std::optional<bus::Writer<v1::MotorCommand>> driver_;
  std::chrono::steady_clock::time_point published_;
};

/// Makes the command one of speeds: [m/s], and [rad/s] counter-clockwise.
void forward(v1::MotorCommand& command, double velocity, double rotation = 0.0);

/// The first true cycle at or after `cycle` with a standing robot; 0: none.
std::uint64_t stood_still(const std::vector<sim::TraceRow>& rows, std::uint64_t cycle);

}  // namespace saphira::test
