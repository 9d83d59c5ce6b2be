#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/sim/simulation.hpp"

namespace saphira::sim {

// The simulator's own view: the true state, for people who look at the simulator and not through
// the robot's sensors, and their actions on it. One JSON object a line, both ways; README, "View".

/// The loadable files, by name.
struct Choice {
  std::vector<std::string> worlds;
  std::vector<std::string> robots;
  std::string world;  ///< the loaded one
};
/// The names as a line of their own.
std::string describe_files(const Choice& choice);

/// The static part: walls and posts of the world, and the loadable files.
std::string describe_world(const World& world, const Choice& choice);

/// The moving part, at present. Meters, radians, in the world.
struct Pacing {
  bool paused = false;
  double rate = 1.0;
};
std::string describe_scene(const Simulation& simulation, const Pacing& pacing);

/// The reason why a request failed.
std::string complaint(const std::string& text);

/// Other files for the simulator.
struct Load {
  std::string world;  ///< a name from Choice [empty: the same]
  std::string robot;  ///< likewise
};

/// The acts of the simulator's host that a request may ask for. Each returns the reason why it is
/// not done; empty: done.
class ViewedHost {
 public:
  virtual std::string pause(bool on) = 0;
  virtual std::string step_once() = 0;                    ///< one information packet, while paused
  virtual std::string set_rate(double rate) = 0;          ///< times real time
  virtual std::string disconnect(RobotNumber robot) = 0;  ///< of a robot that is there
  virtual std::string load(Load wish) = 0;
  virtual std::string list_files() = 0;  ///< those that may be loaded, anew

 protected:
  ~ViewedHost() = default;
};

/// Carries out a request. Empty: done; otherwise the reason. std::invalid_argument gives the
/// expected form.
std::string obey(std::string_view request, Simulation& simulation, ViewedHost& host);

}  // namespace saphira::sim
