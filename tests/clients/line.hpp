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

/// A packet as third-party clients make it: with separate code.
Wire packet(const Wire& body);
/// With an integer, by type 0x3B or 0x1B as they do.
Wire packet(std::uint8_t command, int argument);

/// In the hall of all robots here: a wall ahead, 3 m from the robot's middle.
inline const Pose kStart{4.0, 4.0, 0.0};

/// A simulated robot with a client's line on which time passes only when the client waits, and the
/// strict checker on it.
class Line {
 public:
  /// `file`: a robot of config/robots, in the hall.
  explicit Line(const std::string& file);
  Line& operator=(Line&&) = delete;

  void send(const Wire& bytes);
  /// Lets time pass [s] and collects received bytes.
  void wait(double seconds);
  double now() const { return time_; }  ///< [s]
  /// Waits until a body with that property has come, takes all up to it, and returns it; nothing
  /// after `seconds`.
  std::optional<Wire> expect(const std::function<bool(const Wire&)>& property, double seconds);
  /// The next complete body that was not taken yet; nothing without one.
  std::optional<Wire> next();

  const sim::Robot& robot() const { return server_.robot(); }
  const sim::Server& server() const { return server_; }
  const protocol::RobotParameters& parameters() const { return parameters_; }
  const Pose& start() const { return kStart; }

  /// The violations of the tables found by the checker, a line each; empty without any.
  std::string violations() const;
  const protocol::Checker& checker() const { return checker_; }

 private:
  void take();

  sim::World world_;
  protocol::RobotParameters parameters_;
  sim::Scene scene_;
  sim::Server server_;
  protocol::Checker checker_;
  double time_ = 0.0;
  Wire received_;
};

/// A subclass of robots in the client families' own parameter tables.
struct KnownRobot {
  const char* subclass;
  double angle;     ///< rad
  double distance;  ///< mm
  double velocity;  ///< mm/s
  double range;     ///< mm
  int sonars;
  bool moves;      ///< has MOVE and settable accelerations
  int front;       ///< a sonar that looks ahead
  double front_x;  ///< [mm] its place
};
const KnownRobot* find_known(const std::string& subclass);
const std::vector<KnownRobot>& all_known();
/// The robot's name as the name of a test: letters, digits and underscores.
std::string test_name(std::string robot);

}  // namespace saphira::test
