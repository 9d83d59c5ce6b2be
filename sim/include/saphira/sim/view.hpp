#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
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

// Requests.
struct PlaceRobot {
  RobotNumber robot = 0;
  Pose pose_in_world;
};
struct PlacePerson {
  std::string name;
  Vec2 at{0.0, 0.0};
};
struct RaiseArm {
  std::string name;
  std::optional<double> direction_in_world;  ///< [rad] [none: lowers it]
};
struct PlaceBox {
  std::string name;
  Pose pose_in_world;
};
struct SetDoor {
  std::string name;
  bool open = false;
};
/// A person at the robot's inputs.
struct SetInput {
  RobotNumber robot = 0;
  std::optional<std::uint8_t> digital;  ///< a bit for each pin
  std::size_t port = 0;                 ///< of `analog`
  std::optional<std::uint8_t> analog;   ///< [5 V / 255]
};
struct Pause {
  bool on = false;
};
struct StepOnce {};  ///< one information packet, while time is paused
struct SetRate {
  double rate = 1.0;  ///< times real time
};
struct Disconnect {
  RobotNumber robot = 0;
};
struct Load {
  std::string world;  ///< a name from Choice [empty: the same]
  std::string robot;  ///< likewise
};
struct ListFiles {};  ///< those that may be loaded, anew
using Wish = std::variant<PlaceRobot, PlacePerson, RaiseArm, PlaceBox, SetDoor, SetInput, Pause,
                          StepOnce, SetRate, Disconnect, Load, ListFiles>;

/// std::invalid_argument gives the expected form.
Wish parse_wish(std::string_view text);
/// Carries out a wish for the scene. Empty: done; otherwise the reason. The other wishes are the
/// host's.
std::string change_scene(Simulation& simulation, const Wish& wish);

}  // namespace saphira::sim
