#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "saphira/protocol/check.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/server.hpp"

namespace saphira::test {

using Wire = std::vector<std::uint8_t>;

/// A packet as others' clients make it: their own code, not ours.
Wire packet(const Wire& body);
/// With an integer, by type 0x3B or 0x1B as they do.
Wire packet(std::uint8_t command, int argument);

/// A simulated robot with a line on which time passes only when the client waits, and the strict
/// checker listening on it.
class Line {
 public:
  /// `file`: a robot of config/robots. It stands before a wall that is 3 m from its middle, in a
  /// hall.
  explicit Line(const std::string& file);

  void send(const Wire& bytes);
  /// Lets time pass [s] and collects what comes.
  void wait(double seconds);
  /// Waits until a body with that property has come, takes all up to it, and returns it; nothing
  /// when the time is up.
  std::optional<Wire> expect(const std::function<bool(const Wire&)>& property, double seconds);
  /// What has come and was not yet taken.
  std::optional<Wire> next();

  double now() const { return time_; }
  const sim::Robot& robot() const { return server_.robot(); }
  const sim::Server& server() const { return server_; }
  const protocol::RobotParameters& parameters() const { return parameters_; }
  const Pose& start() const { return start_; }

  /// What the checker has found, as text; empty when nothing is against the tables.
  std::string violations() const;
  const protocol::Checker& checker() const { return checker_; }

 private:
  void collect();

  sim::World world_;
  protocol::RobotParameters parameters_;
  Pose start_{4.0, 4.0, 0.0};
  sim::Scene scene_;
  sim::Server server_;
  protocol::Checker checker_;
  std::vector<std::uint8_t> received_;
  double time_ = 0.0;
};

/// What a client family knows of each subclass, from its own parameter tables.
struct KnownRobot {
  const char* subclass;
  double angle;     ///< rad
  double distance;  ///< mm
  double velocity;  ///< mm/s
  double range;     ///< mm
  int sonars;
  bool moves;      ///< has MOVE and settable accelerations
  int front;       ///< a sonar that looks ahead
  double front_x;  ///< [mm] where it stands
  double front_degrees;
};
const KnownRobot* find_known(const std::string& subclass);
const std::vector<KnownRobot>& all_known();

}  // namespace saphira::test
