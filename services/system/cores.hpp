#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/behaviors/core.hpp"
#include "saphira/intentions/core.hpp"
#include "saphira/interpretation/core.hpp"
#include "saphira/registration/core.hpp"

namespace saphira::system {

/// The robot's state in a cycle, as the bridge publishes it.
struct RobotCycle {
  std::uint64_t cycle = 0;
  std::uint64_t odom = 1;  ///< number of the odom frame
  Pose pose_in_odom;
  double velocity = 0.0;           ///< [m/s]
  double rotation_velocity = 0.0;  ///< [rad/s]
  double head = 0.0;               ///< [rad] direction of the cameras
  bool left_stalled = false;
  bool right_stalled = false;
  std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
};

/// The cores of the services in one loop, without the bus: in the step for cycle N each sees the
/// others' outputs of N-1, as on the bus. Values are passed unchanged. The bus rounds some to
/// float, so a robot on the bus differs in the last digits.
class Cores {
 public:
  struct Settings {
    behaviors::RobotModel robot;
    behaviors::Registry behaviors;
    double head_reach = 0.0;  ///< [rad] of the cameras, to either side
    bool interpretation = false;
    std::optional<registration::Core::Settings> registration;
    /// None: intend() sets the intent.
    std::optional<intentions::Core::Settings> intentions;
  };
  /// The outputs of the services for a cycle; empty for missing services.
  struct Said {
    behaviors::Core::Outputs behaviors;
    std::vector<lps::Percept> percepts;
    registration::Core::Outputs registration;
    std::uint64_t map_revision = 0;
    bool adds_features = false;  ///< registration adds percepts to the map
    intentions::Core::Outputs intentions;
    /// From a vision service; none: no camera.
    std::optional<std::vector<lps::SeenThing>> things;
    std::uint64_t cycle = 0;  ///< 0: no outputs yet
    Pose pose_in_odom;        ///< of the robot, in that cycle
  };

  explicit Cores(Settings settings);

  const Said& step(const RobotCycle& robot);
  const Said& said() const { return said_; }

  /// The intent from now on, without an intentions service.
  void intend(std::vector<behaviors::Intended> behaviors, bool control);
  /// The same behaviors, with control on or off (sfBehaviorControl, manual 7.4).
  void set_control(bool control);
  /// The vision service's output for the newest cycle.
  void see(std::vector<lps::SeenThing> things) { said_.things = std::move(things); }
  /// A goal, a claim: taken in the next step.
  void hear(intentions::GoalEvent goal);
  void hear(intentions::ClaimEvent claim);

  const behaviors::RobotModel& robot() const { return settings_.robot; }
  interpretation::Core& interpretation() { return interpretation_.value(); }
  registration::Core& registration() { return registration_.value(); }
  const registration::Core& registration() const { return registration_.value(); }
  intentions::Core& intentions() { return intentions_.value(); }

 private:
  behaviors::Core::Outputs step_behaviors(const RobotCycle& robot);
  void step_interpretation(const RobotCycle& robot, Said& now);
  void step_registration(const RobotCycle& robot, Said& now);
  intentions::Core::Outputs step_intentions(const RobotCycle& robot);
  void know_map();
  bool first() const { return said_.cycle == 0; }

  Settings settings_;
  behaviors::Core behaviors_;
  std::optional<interpretation::Core> interpretation_;
  std::optional<registration::Core> registration_;
  std::optional<intentions::Core> intentions_;
  std::optional<behaviors::Intent> intent_;
  intentions::Core::Heard heard_;
  std::vector<Request> asked_;
  std::uint64_t known_map_ = 0;  ///< the revision that intentions has
  Said said_;
};

/// The announcement of the behaviors service.
std::vector<intentions::BehaviorSignature> signatures_of(const behaviors::Registry& behaviors);

}  // namespace saphira::system
