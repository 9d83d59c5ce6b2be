#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "saphira/protocol/packet.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/server.hpp"

namespace saphira::sim {

/// One scene and the robot servers in it, with one time. The comments on a single server
/// (server.hpp) hold for each server here.
///
/// In single step, time passes when every connected client has sent STEP: each waits for the
/// slowest. With ServerOptions::single_step it first passes when every robot has been opened once,
/// so that the order of connection makes no difference. Clients that have gone are not waited for.
class Simulation {
 public:
  /// The world outlives it.
  explicit Simulation(const World& world) : scene_(world) {}

  /// Adds a robot; returns its number. std::invalid_argument where it would touch an obstacle.
  RobotNumber add(const protocol::RobotParameters& parameters, const Pose& start_in_world,
                  ServerOptions options);

  std::size_t size() const { return servers_.size(); }
  const Server& server(RobotNumber number) const { return *servers_[number].server; }
  /// For its line alone: take_output, take_trace.
  Server& server(RobotNumber number) { return *servers_[number].server; }
  const Scene& scene() const { return scene_; }
  Scene& scene() { return scene_; }

  // As for a server.
  void receive(RobotNumber number, protocol::ByteView bytes);
  void disconnect(RobotNumber number);
  void gap(RobotNumber number);
  void advance(int ticks);
  bool runs() const;
  int ticks_to_packet() const;

 private:
  struct Member {
    std::unique_ptr<Server> server;
    bool was_open = false;
    bool waited_for = false;  // before the first step
  };

  void tick();
  void settle();
  bool step_due() const;

  Scene scene_;
  std::vector<Member> servers_;
};

}  // namespace saphira::sim
