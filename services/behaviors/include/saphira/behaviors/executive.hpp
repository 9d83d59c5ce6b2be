#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "saphira/base/age.hpp"
#include "saphira/base/archived.hpp"
#include "saphira/behaviors/behavior.hpp"
#include "saphira/behaviors/blend.hpp"
#include "saphira/lps/local_perceptual_space.hpp"

namespace saphira::behaviors {

/// An intended behavior. The name is unique in its set.
struct Intended {
  std::string name;
  std::string schema;
  int priority = 0;  ///< 0 is the highest
  bool running = true;
  std::vector<Argument> parameters;

  bool operator==(const Intended&) const = default;
};

/// All intended behaviors, as of some cycle.
struct Intent {
  std::uint64_t cycle = 0;
  bool control = false;  ///< sfBehaviorControl (manual 7.4)
  std::vector<Intended> behaviors;
  double speed_limit = -1.0;   ///< [m/s] by zones of the map and by advice; below 0: none
  std::string limit_reason{};  ///< in words
};

struct Inputs {
  std::uint64_t cycle = 0;
  RobotNow robot;
  std::vector<lps::SonarReading> sonars;  ///< new ones, in firing order
  const Intent* intent = nullptr;         ///< the newest; nullptr where none has come
  /// [s] from a command's state to the command's effect, beyond the ordinary: the delay of the
  /// network from the robot and back.
  double delay = 0.0;
};

/// The state of one behavior.
struct BehaviorState {
  std::string name;
  std::string schema;
  bool running = false;
  Blended blended;  ///< its rules and its share; empty while it is not running
};

/// A requested behavior that could not be made.
struct Missing {
  std::string name;  ///< of the instance
  std::string reason;
  bool running = true;  ///< it should run
};

struct Output {
  bool control = false;
  std::vector<BehaviorState> behaviors;  ///< by priority, highest first; then by name
  Blend blend;
  std::vector<Missing> missing;
  std::string trouble;  ///< all errors, in words; empty: none

  /// The motor setpoints. Not active: the behaviors do not drive the robot now.
  bool active = false;
  std::string inactive_reason;
  double speed = 0.0;            ///< [m/s]
  double contact_speed = 0.0;    ///< [m/s] limit for wanted contact; 0: none
  double heading_in_odom = 0.0;  ///< [rad] (-pi, pi]

  double input_age = 0.0;     ///< [s] of the intent
  double speed_limit = -1.0;  ///< [m/s] from the age of all inputs, and intended; below 0: none
  std::string limit_reason;   ///< empty: the speed was not limited
  /// The late input, and its delay, while the robot has to drive more slowly for it; empty: none.
  std::string slow;
};

struct ExecutiveSettings {
  /// [cycles] without a newer intent, of whatever age, after which the intent ends: the sign of a
  /// killed service or a cut link.
  std::uint64_t intent_lease = 2;
};

/// The behavior executive (manual 7.4): keeps the LPS, makes the set of intended behaviors,
/// evaluates the running ones and blends them.
///
/// All behaviors are evaluated also while control is off, or the intent is too old to drive by.
/// While an intended behavior cannot be made the others do not drive: it may be the one that avoids
/// collisions.
///
/// Its inputs may be old: the intent over a slow network, and the robot's state when the network
/// lies between the robot and this service. The older the inputs, the slower the robot
/// (saphira/base/age.hpp). Behaviors see the robot at its place when the command takes effect.
class Executive {
 public:
  Executive(Registry registry, RobotModel model, ExecutiveSettings settings = {});

  Output step(const Inputs& inputs);
  /// Another epoch or another odom frame: forgets the LPS and all behaviors.
  void reset();
  /// As reset, for another robot.
  void reset(RobotModel model);

  const lps::LocalPerceptualSpace& lps() const { return lps_; }
  Registry& registry() { return registry_; }

  /// Its state but the registry. Restored behaviors are made by the registry.
  void archive(Archive& a);

 private:
  struct Instance {
    Intended intended;  ///< the newest request
    Parameters parameters;
    std::uint64_t revision = 0;  ///< of its schema
    std::unique_ptr<Behavior> behavior;
    bool initialised = false;

    SAPHIRA_ARCHIVE(intended, parameters, initialised)
  };
  /// Contact is wanted where every behavior that contributes to the speed wants it: the least of
  /// their limits. An active avoiding behavior forbids contact.
  double contact_speed(const std::vector<Blended>& blended) const;
  void sweep(const RobotNow& robot, Output& output);
  /// True where no newer intent has come for the lease.
  bool silent(const Inputs& inputs) const;
  /// The error from the intent's age; empty: none.
  std::string why_unheard(const Inputs& inputs) const;
  /// The reason why the behaviors may not drive; empty where they may.
  std::string why_inactive(const Inputs& inputs, bool running) const;
  /// Records the ages of the inputs, and limits the speed by them.
  void limit_speed(const Inputs& inputs, Output& output);
  static void obey_limit(const Inputs& inputs, Output& output);
  /// Puts the obstacle at a stalled wheel into the LPS.
  void feel(const RobotNow& robot);
  /// Makes the intended instances; returns the errors.
  std::string reconcile(const std::vector<Intended>& intended, const Pose& robot_in_odom);
  /// `same` is the instance of that name and schema; nullptr: none.
  std::string adopt(const Intended& intended, const Pose& robot_in_odom, Instance* same,
                    std::vector<Instance>& next);

  Registry registry_;
  RobotModel model_;
  ExecutiveSettings settings_;
  lps::LocalPerceptualSpace lps_;
  std::vector<Instance> instances_;
  // The intent that the instances were made from, and its errors.
  std::vector<Intended> reconciled_;
  std::uint64_t reconciled_revision_ = 0;
  std::string reconcile_trouble_;
  std::vector<Missing> missing_;
  std::uint64_t newest_intent_ = 0;  ///< its cycle
  std::uint64_t intent_came_ = 0;    ///< the cycle of its arrival
  std::uint64_t held_ = 0;           ///< [cycles] without motion, though it wants to drive
  bool backwards_ = false;           ///< the robot was told to go backwards in the cycle before
  PeakAge intent_age_;               ///< beyond the ordinary
};

}  // namespace saphira::behaviors
