#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "saphira/base/age.hpp"
#include "saphira/behaviors/behavior.hpp"
#include "saphira/behaviors/blend.hpp"
#include "saphira/lps/local_perceptual_space.hpp"

namespace saphira::behaviors {

/// A behavior that is to be there. The name is unique in its set.
struct Intended {
  std::string name;
  std::string schema;
  int priority = 0;  ///< 0 is the highest
  bool running = true;
  std::vector<Argument> parameters;

  bool operator==(const Intended&) const = default;
};

/// All that is intended, as of some cycle.
struct Intent {
  std::uint64_t cycle = 0;
  bool control = false;  ///< sfBehaviorControl (manual 7.4)
  std::vector<Intended> behaviors;
};

struct Inputs {
  std::uint64_t cycle = 0;
  RobotNow robot;
  std::vector<lps::SonarReading> sonars;  ///< new ones, in firing order
  const Intent* intent = nullptr;         ///< the newest; nullptr where none has come
  /// [s] from the cycle that a command answers until it comes to work, beyond the ordinary: what
  /// the network takes from the robot and back to it.
  double delay = 0.0;
};

/// One behavior as it stands.
struct BehaviorState {
  std::string name;
  std::string schema;
  bool running = false;
  Blended blended;  ///< its rules and its share; empty when it is not running
};

/// A behavior that was asked for and could not be made.
struct Missing {
  std::string name;  ///< of the instance
  std::string reason;
  bool running = true;  ///< it was to run
};

struct Output {
  bool control = false;
  std::vector<BehaviorState> behaviors;  ///< by priority, highest first; then by name
  Blend blend;
  std::vector<Missing> missing;
  std::string trouble;  ///< all that is wrong, in words; empty: nothing

  /// The motor setpoints. Not active: the robot is not to be driven by behaviors now.
  bool active = false;
  std::string inactive_reason;
  double speed = 0.0;            ///< [m/s]
  double contact_speed = 0.0;    ///< [m/s] contact is meant, at no more than this; 0: none is
  double heading_in_odom = 0.0;  ///< [rad] (-pi, pi]

  double input_age = 0.0;     ///< [s] of the intent
  double speed_limit = -1.0;  ///< [m/s] that the age of all that it acts on allows; below 0: none
  std::string limit_reason;   ///< empty: the speed was not limited
  /// The input that is late, and by how much, while the robot has to drive more slowly for it;
  /// empty: nothing is.
  std::string slow;
};

struct ExecutiveSettings {
  /// [cycles] without a newer intent, however old it is, after which nobody is taken to intend
  /// anything: that is how a service that was killed, or a link that was cut, shows.
  std::uint64_t intent_lease = 2;
};

/// The behavior executive (manual 7.4): keeps the LPS, makes the set of behaviors what is intended,
/// evaluates those that run and blends them.
///
/// All behaviors are evaluated also while control is off, or the intent is too old to drive by.
/// While one that is to run cannot be made the others do not drive: it may be the one that looks
/// out.
///
/// Its inputs may be old: the intent when it comes over a slow network, and the robot's state
/// when the network lies between the robot and this. The older, the slower the robot
/// (saphira/base/age.hpp), and behaviors see the robot where it will be when the command works.
class Executive {
 public:
  Executive(Registry registry, RobotModel model, ExecutiveSettings settings = {});

  Output step(const Inputs& inputs);
  /// Another epoch or another odom frame: forgets the LPS and all behaviors.
  void reset();
  /// As reset, for another robot.
  void reset(RobotModel model);

  const lps::LocalPerceptualSpace& lps() const { return lps_; }
  const RobotModel& model() const { return model_; }
  Registry& registry() { return registry_; }

 private:
  struct Instance {
    Intended intended;  ///< as it was asked for last
    Parameters parameters;
    std::uint64_t revision = 0;  ///< of its schema
    std::unique_ptr<Behavior> behavior;
    bool initialised = false;
  };
  /// Contact is meant where every behavior with a say on the speed means it: the least of what they
  /// allow. One that avoids, and has something to say, forbids it.
  double contact_speed(const std::vector<Blended>& blended) const;
  /// No newer intent has come for the lease.
  bool silent(const Inputs& inputs) const;
  /// The trouble with the intent's age; empty where nothing is.
  std::string why_unheard(const Inputs& inputs) const;
  /// Why the behaviors are not to drive; empty where they are.
  std::string why_inactive(const Inputs& inputs, bool running) const;
  /// Takes note of how old everything is, and cuts the speed to what that allows.
  void limit_speed(const Inputs& inputs, Output& output);
  /// Puts what a stalled wheel touches into the LPS.
  void feel(const RobotNow& robot);
  /// Makes the instances what is intended; returns what was wrong.
  std::string reconcile(const std::vector<Intended>& intended, const Pose& robot_in_odom);
  /// `same` is the instance of that name and schema; nullptr where there is none.
  std::string adopt(const Intended& intended, const Pose& robot_in_odom, Instance* same,
                    std::vector<Instance>& next);

  Registry registry_;
  RobotModel model_;
  ExecutiveSettings settings_;
  lps::LocalPerceptualSpace lps_;
  std::vector<Instance> instances_;
  // The intent that the instances were made from, and its mistakes.
  std::vector<Intended> reconciled_;
  std::uint64_t reconciled_revision_ = 0;
  std::string reconcile_trouble_;
  std::vector<Missing> missing_;
  std::uint64_t newest_intent_ = 0;  ///< its cycle
  std::uint64_t intent_came_ = 0;    ///< the cycle in which it was there first
  bool backwards_ = false;           ///< the robot was told so in the cycle before
  PeakAge intent_age_;               ///< beyond the ordinary
};

}  // namespace saphira::behaviors
