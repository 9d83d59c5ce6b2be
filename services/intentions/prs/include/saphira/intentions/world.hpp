#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/idl/map.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::lps {
class LocalPerceptualSpace;
struct Percept;
struct SeenThing;
struct SonarReading;
}  // namespace saphira::lps
namespace saphira::maps {
struct Map;
class Topology;
}  // namespace saphira::maps

namespace saphira::intentions {

class Beliefs;
struct KnownZones;
struct Reference;
class Value;

/// Cycles of 100 ms since the robot's connection: the only time here. Negative for events before
/// the service began.
using Ticks = std::int64_t;
inline constexpr double kTick = 0.1;  ///< [s]
constexpr double in_seconds(Ticks ticks) {
  return kTick * static_cast<double>(ticks);
}

/// The robot's state in a cycle.
struct Robot {
  bool connected = false;
  bool has_power = true;   ///< of its motors
  std::uint64_t odom = 0;  ///< number of the odom frame
  Pose pose_in_odom{};
  double velocity = 0.0;           ///< [m/s]
  double rotation_velocity = 0.0;  ///< [rad/s]
  double head = 0.0;               ///< [rad] direction of the cameras; 0: ahead
  /// The origin of odom on the map; none while the robot's place on the map is unknown.
  std::optional<Pose> odom_in_map{};
  bool left_stalled = false;
  bool right_stalled = false;
  std::uint16_t bumpers = 0;            ///< as in the packet
  double target_velocity = 0.0;         ///< [m/s] the setpoint that was sent last
  double target_heading_in_odom = 0.0;  ///< [rad] the robot's own setpoint
};

/// Limits for rest, with room for the rounding of the packet.
inline constexpr double kRestVelocity = 0.02;          ///< [m/s]
inline constexpr double kRestRotation = radians(3.0);  ///< [rad/s]

/// True where the robot neither drives nor turns.
bool at_rest(const Robot& robot);

/// Registration's output.
struct Registered {
  std::optional<v1::RegistrationState> state;  ///< none: there is no registration
  Pose pose_in_map;                            ///< of the robot; while lost: the best guess
  double confidence = 0.0;                     ///< [0..1]
  std::uint32_t environment = 0;               ///< the artifact around the robot; 0: none known
  bool adds_features = false;                  ///< new percepts are added to the map
  std::set<std::uint32_t> closed_doors;        ///< by id: those that were closed when last seen
};

/// Knowledge beside the robot's state. The pointers' targets outlive the step.
struct Surroundings {
  const lps::LocalPerceptualSpace* lps = nullptr;       ///< none: no sensors
  const std::vector<lps::Percept>* percepts = nullptr;  ///< none: no interpretation
  /// People and colours; none: no camera, or no vision service.
  const std::vector<lps::SeenThing>* things = nullptr;
  bool sees_colors = false;
  std::uint64_t cycle = 0;  ///< of the robot, as in the percepts
  Registered registration;
  std::shared_ptr<const maps::Topology> topology;  ///< none: no map
  std::shared_ptr<const maps::Map> map;            ///< the source of the topology
  /// New sonar readings of this cycle; none: no sensors.
  const std::vector<lps::SonarReading>* readings = nullptr;
  std::uint64_t map_revision = 0;
  double robot_radius = 0.0;  ///< [m] of its hull, a circle; 0: unknown
  double deceleration = 0.0;  ///< [m/s2] of a stop; 0: unknown
  double head_reach = 0.0;    ///< [rad] turn of the cameras to either side; 0: they are fixed
  /// Answers of agents, by the number of the question; none: no agents.
  const std::map<std::uint64_t, Answer>* answers = nullptr;
  bool stop_confirmed = true;  ///< the bridge has carried out the newest stop
  std::string
      other_driver{};  ///< a person or program that drives in a stronger role; empty: nobody
  /// The zones of the map and by advice, once somebody has asked for them (skills/src/zones.hpp).
  mutable std::shared_ptr<const KnownZones> zones;
};

/// The world of activities in a cycle: the input of the functions of their language.
struct World {
  const Robot& robot;
  const Surroundings& around;
  const Beliefs& beliefs;
  Ticks now = 0;

  /// The robot on the map; none while its place is unknown.
  std::optional<Pose> robot_in_map() const {
    if (!robot.odom_in_map)
      return std::nullopt;
    return compose(*robot.odom_in_map, robot.pose_in_odom);
  }

  /// True where the readings do not confirm the robot's place on the map: too little evidence for
  /// any position.
  bool unsure_of_position() const {
    constexpr double kSure = 0.9;
    return around.registration.state == v1::REGISTRATION_TRACKING &&
           around.registration.confidence < kSure;
  }
};

/// The same point in another frame; none where the conversion goes over the map and the robot's
/// place on it is unknown.
std::optional<Pose> in_frame(const Pose& pose, Frame from, Frame to, const Robot& robot);

/// The person or blob of that number among the present ones; nullptr where it is gone.
const lps::SeenThing* seen_thing(const World& world, std::uint64_t id);

/// True where there is a map, and the reference is to its present revision.
bool current(const World& world, const Reference& reference);

/// The name of a value; an artifact has its name on the map.
std::string name_of(const World& world, const Value& value);

}  // namespace saphira::intentions
