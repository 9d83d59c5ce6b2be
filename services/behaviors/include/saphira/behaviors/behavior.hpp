#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/behaviors/fuzzy.hpp"
#include "saphira/behaviors/parameter.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"

namespace saphira {
class Archive;
}

namespace saphira::behaviors {

/// The properties of the robot that behaviors need; from its description.
struct RobotModel {
  double radius = 0.22;                 ///< [m] of the hull
  double max_velocity = 0.4;            ///< [m/s]
  double max_rotation_velocity = 1.75;  ///< [rad/s]
  double deceleration = 2.0;            ///< [m/s2] of a stop
  lps::LpsSettings lps;
};

/// Of a robot's parameter file: protocol::RobotParameters, which this library does not know.
template <class Parameters>
RobotModel model_of(const Parameters& parameters) {
  RobotModel model;
  model.radius = parameters.radius;
  model.max_velocity = parameters.max_velocity;
  model.max_rotation_velocity = parameters.max_rotation_velocity;
  model.deceleration = parameters.deceleration;
  model.lps.front_buffer = static_cast<std::size_t>(parameters.front_buffer);
  model.lps.side_buffer = static_cast<std::size_t>(parameters.side_buffer);
  model.lps.front_max_range = parameters.front_max_range;
  for (const auto& sonar : parameters.sonars)
    model.lps.sonars.push_back({sonar.number, sonar.pose_in_robot});
  return model;
}

/// The robot in this cycle.
struct RobotNow {
  Pose pose_in_odom;
  double velocity = 0.0;                ///< [m/s]
  double rotation_velocity = 0.0;       ///< [rad/s]
  double target_heading_in_odom = 0.0;  ///< [rad] the setpoint
  bool left_stalled = false;            ///< a wheel pushes against something
  bool right_stalled = false;
};

using lps::Side;

/// Values that behaviors pass to each other within a cycle: lower priorities are updated first, so
/// that avoiding behaviors know the wishes below them. Cleared every cycle.
struct Shared {
  /// The robot's course without obstacles: [rad] from its heading, and how far [m].
  std::optional<double> goal_bearing;
  double goal_distance = 0.0;
  /// sfPreferredTurnDir (manual 7.8): the side to turn to where the front is blocked.
  Side preferred_turn = Side::none;
};

/// The inputs of a behavior's update.
struct Context {
  const RobotModel& model;
  const RobotNow& robot;
  const lps::LocalPerceptualSpace& lps;
  std::uint64_t cycle;
  Shared& shared;
};

/// The control action of a rule (manual 7.2, 7.6.4).
enum class Action { turn_left, turn_right, accelerate, decelerate, speed };

struct Rule {
  std::string name;
  Fuzzy strength = 0.0;  ///< of the antecedent
  Action action = Action::speed;
  /// Turns: [rad], the size of the turn, not negative. Speed: [m/s] the setpoint. Accelerate and
  /// decelerate: [m/s] from the present velocity, not negative.
  double value = 0.0;
};

/// The behavior's weight on each channel, and the state of its goal (the Activity section of manual
/// 7.2).
struct Activity {
  Fuzzy turn = 0.0;
  Fuzzy speed = 0.0;
  Fuzzy goal = 0.0;
  Fuzzy progress = 0.0;
};

/// A lane that a behavior follows, to be drawn into the LPS as dotted lines (manual 7.8).
struct Lane {
  Pose in_robot;       ///< a point on it, directed along it
  double left = 0.0;   ///< [m] from the point's line to the edge on that side
  double right = 0.0;  ///< [m]
};

/// A part of the surroundings in which a behavior has found an object, to be drawn into the LPS
/// (manual 2.3.2.5) [m] [robot].
struct Area {
  double x_from = 0.0;
  double x_to = 0.0;
  double y_from = 0.0;
  double y_to = 0.0;
};

struct Evaluation {
  std::vector<Rule> rules;
  Activity activity;
  /// The variables of the update that the rules' antecedents and the activity name.
  std::vector<std::pair<std::string, double>> variables = {};
  std::optional<Lane> lane = {};
  std::vector<Area> areas = {};
  std::string trouble = {};  ///< the errors of this cycle; empty: none
};

/// One instance of a behavior: the update function of manual 7.6.2, and its memory.
///
/// Rules with opposite consequents should have disjoint antecedents: the blend averages them (paper
/// 3.1, footnote 3).
class Behavior {
 public:
  virtual ~Behavior() = default;
  /// Once, before the first update (manual 7.6.3). May start clocks by context.cycle.
  virtual void init(const Parameters& parameters, const Context& context);
  /// Every cycle in which the behavior runs. Reads the LPS, computes the fuzzy variables and from
  /// them the rules. Parameters may have changed since the last time.
  virtual Evaluation update(const Parameters& parameters, const Context& context) = 0;
  /// This instance replaces `old`, which ran with an earlier version of the schema. Called before
  /// init. May keep the memory of `old`.
  virtual void take_over(const Behavior& old);
  /// Saves and restores its memory, see Archive. Without this, a restored behavior begins anew.
  virtual void archive(Archive& /*a*/) {}
};

/// A rule in its written form, for people.
struct RuleSpec {
  std::string name;
  std::string antecedent;  ///< such as "front_left And Not front_right"
  std::string action;      ///< such as "Turn Right Sharply"
};

/// A kind of behavior: its parameters and its factory. For C++ behaviors that is a function;
/// behaviors in the behavior language have an interpreter (language.hpp).
struct Schema {
  std::string name;
  std::string summary;
  std::vector<ParameterSpec> parameters = {};
  std::function<std::unique_ptr<Behavior>()> make = {};
  std::vector<RuleSpec> rules = {};
  std::string source = {};     ///< the file that it comes from; empty: built in
  std::uint64_t revision = 0;  ///< set by the registry: another number for each version
};

class Registry {
 public:
  /// A schema of the same name is replaced. The executive replaces running instances by the new
  /// version, see Behavior::take_over.
  void add(Schema schema);
  /// Running instances stay. False for an unknown name.
  bool remove(const std::string& name);
  /// By its exact name; otherwise without regard to case, "-", "_" and a leading "sf":
  /// "follow-corridor" and "sfFollowCorridor" are FollowCorridor. nullptr: none.
  const Schema* find(const std::string& name) const;
  std::vector<std::string> names() const;
  /// Another number after each change.
  std::uint64_t revision() const { return revision_; }

 private:
  std::map<std::string, Schema> schemas_;
  std::map<std::string, std::string> plain_names_;
  std::uint64_t revision_ = 0;
};

/// The predefined behaviors of manual 7.8: those of config/behaviors at the first call.
/// std::runtime_error where they cannot be loaded.
Registry predefined();

}  // namespace saphira::behaviors
