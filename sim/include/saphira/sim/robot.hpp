#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "saphira/base/random.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

class Scene;

/// The time step of the dynamics. Live and single-step both move in these, so their physics is the
/// same.
inline constexpr double kTick = 0.010;  // [s]

/// A differential drive in a scene: a disc that is stopped by walls and by other robots.
///
/// Translation accelerates at a constant rate to the velocity that was set; a heading is reached by
/// a trapezoidal velocity function that is computed anew in every tick, so a new heading in the
/// middle of a turn is taken up smoothly (manual 5.5, Figure 5-2).
///
/// No wheel is faster than the fastest of two motions has it: straight on at the largest velocity
/// that the parameters allow, or on the spot at their largest rotation. Two velocities that ask for
/// more are made slower by the same factor, so that the arc stays. A turn to a heading is made as
/// fast as on the spot, and the robot drives more slowly meanwhile. No speed jumps: where the robot
/// cannot slow down so soon, the turn waits.
///
/// The wheels do what the motors want. The robot does what the wheels do, but that it changes its
/// speed by no more than tyres can hold, so that they slip when it stops in an emergency, and that
/// they slip while it pushes against what does not give. Other errors are in what the encoders say.
/// Per tick, with the true way ds and the true turn dth, dead reckoning measures (manual Table 3-1
/// names the parameters and does not define them):
///
///     way  = ds  + N(0, EncodeJitter * sqrt(|ds| * 1 m))
///     turn = dth + N(0, AngleJitter * sqrt(|dth| * 1 rad)) + drift * ds
///
/// so EncodeJitter 0.01 is a standard deviation of 1 cm after 1 m (and of 2 cm after 4 m),
/// AngleJitter 0.02 one of 0.02 rad after a turn of 1 rad, whatever the tick is. drift is
/// AngleDrift [rad/m], a constant of the robot whose sign the seed chooses: wheels unequal one way
/// or the other.
class Robot {
 public:
  /// Made by Scene::add_robot. start_in_world is the true pose at power-up; dead reckoning begins
  /// at (0, 0, 0).
  Robot(Scene& scene, std::size_t number, const protocol::RobotParameters& parameters,
        const Pose& start_in_world, std::uint64_t seed);

  // ---- Setpoints. The mode of control follows the command (manual 5.4.6, Table 5-8).

  void set_velocity(double velocity);  ///< [m/s]
  /// Translates by a way [m] of dead reckoning, by a trapezoid as turns are made.
  void move_by(double way);
  void set_heading(double heading_in_odom);              ///< [rad]
  void turn_by(double angle);                            ///< [rad] from the heading now
  void set_rotation_velocity(double velocity);           ///< [rad/s]
  void set_wheel_velocities(double left, double right);  ///< [m/s]
  /// Dead reckoning becomes (0, 0, 0); a heading that was set keeps its direction in the world.
  void set_origin();
  /// Stops and forgets all setpoints.
  void stop();
  /// The same as hard as the motors can; the wheels may slip.
  void emergency_stop();
  /// Motors without power (later robots' ENABLE): the robot brakes and takes setpoints up again
  /// when they have it, as after brake().
  void enable(bool on);
  /// Motors off and on again. While off the robot brakes; on again it takes up the velocity that
  /// was set last, at the heading that it then has (manual 5.4.4).
  void brake(bool on);

  // ---- What later robots let the client set; the parameter file's at first. Sizes, clamped to
  // what
  // ---- a robot can do at all.

  void set_max_velocity(double velocity);                                  ///< [m/s] of move_by
  double acceleration() const { return acceleration_; }                    ///< [m/s2]
  double deceleration() const { return deceleration_; }                    ///< [m/s2]
  double rotation_acceleration() const { return rotation_acceleration_; }  ///< [rad/s2]
  double rotation_deceleration() const { return rotation_deceleration_; }  ///< [rad/s2]
  void set_acceleration(double acceleration);                              ///< [m/s2]
  void set_deceleration(double deceleration);                              ///< [m/s2]
  void set_max_rotation_velocity(double velocity);      ///< [rad/s] of turns to a heading
  void set_rotation_acceleration(double acceleration);  ///< [rad/s2]
  void set_rotation_deceleration(double deceleration);  ///< [rad/s2]

  void tick();

  /// A hand lifts the robot to elsewhere; dead reckoning does not notice. Whether there was room.
  bool place(const Pose& pose_in_world);

  // ---- State.

  const Pose& pose_in_world() const { return pose_in_world_; }     ///< true
  const Pose& pose_in_odom() const { return pose_in_odom_; }       ///< dead reckoning
  double velocity() const { return velocity_; }                    ///< [m/s]
  double rotation_velocity() const { return rotation_velocity_; }  ///< [rad/s]
  double left_velocity() const;                                    ///< [m/s] of the wheel
  double right_velocity() const;                                   ///< [m/s] of the wheel
  /// Ways of the wheels [m] as the encoders have counted them since power-up.
  double left_way() const { return way_ - turned_ / rotation_per_difference_; }
  double right_way() const { return way_ + turned_ / rotation_per_difference_; }
  bool moving() const {
    return velocity_ != 0.0 || wheel_velocity_ != 0.0 || rotation_velocity_ != 0.0;
  }
  bool enabled() const { return enabled_; }

  double target_velocity() const;  ///< [m/s] in force: 0 while braked or without power
  bool controls_heading() const { return rotation_ == Rotation::kHeading; }
  /// [rad] in odom: the heading that was set, or the heading now while none is controlled.
  double target_heading() const;
  double target_rotation_velocity() const;  ///< [rad/s] 0 while a heading is controlled

  /// A motor pushed against something since clear_stalls().
  bool left_stalled() const { return left_stalled_; }
  bool right_stalled() const { return right_stalled_; }
  void clear_stalls() { left_stalled_ = right_stalled_ = false; }
  /// How often the robot has run into something. Pushing on, or sliding along, is the same time.
  int contacts() const { return contacts_; }

  /// Which of `switches` bumpers, that share the front (or rear) half of the hull, touch something:
  /// a bit each, the lowest the leftmost as the robot looks ahead.
  std::uint8_t bumpers(int switches, bool rear);

  double battery() const;  ///< [V]
  /// As if it had been charged, or drained, to that voltage at rest.
  void set_battery(double voltage);

  /// From the robot's hull to the nearest thing [m]; infinite in an empty world.
  double clearance() const;

  std::size_t number() const { return number_; }    ///< in its scene
  double radius() const { return radius_; }         ///< [m]
  double fastest() const { return max_velocity_; }  ///< [m/s] that its hull ever moves

 private:
  enum class Translation { kVelocity, kWay };
  enum class Rotation { kVelocity, kHeading };
  struct Motion {
    double forward = 0.0;  // [m/s]
    double turn = 0.0;     // [rad/s]
  };

  bool powered() const { return enabled_ && !braked_; }
  double wanted_velocity() const;
  double wanted_rotation_velocity() const;
  double wheel_share(double turn) const;  // [m/s] of the wheels
  // The same arc, no faster than the parameters allow.
  Motion possible(const Motion& wanted) const;
  Motion next_motion() const;  // of the wheels
  void move(double way, double turn);
  const Things& around();
  double free_part(const Things& things, const Vec2& way, double& clearance_after);

  Scene* scene_;
  std::size_t number_;
  Things around_;
  Neighbourhood near_;
  double radius_;
  double max_velocity_, max_rotation_velocity_;  // what the motors can
  double move_velocity_, turn_velocity_;         // what moves and turns use
  double acceleration_, deceleration_;
  double rotation_acceleration_, rotation_deceleration_;
  double max_acceleration_, max_rotation_acceleration_;  // what they can be set to
  double rotation_per_difference_;
  double max_wheel_velocity_;  // [m/s]
  double encode_jitter_, angle_jitter_, drift_;
  Random random_;

  Pose pose_in_world_;
  Pose pose_in_odom_;
  double velocity_ = 0.0;        // of the robot
  double wheel_velocity_ = 0.0;  // of the wheels' middle; another one while they slip
  double rotation_velocity_ = 0.0;
  double way_ = 0.0;     // [m] counted
  double turned_ = 0.0;  // [rad] counted

  Translation translation_ = Translation::kVelocity;
  double velocity_setpoint_ = 0.0;
  double way_setpoint_ = 0.0;
  Rotation rotation_ = Rotation::kVelocity;
  double rotation_setpoint_ = 0.0;
  double heading_setpoint_ = 0.0;
  bool braked_ = false;
  bool enabled_ = true;
  bool emergency_ = false;  // until it stands

  double full_voltage_;
  double charge_ = 1.0;  // of the battery

  bool left_stalled_ = false;
  bool right_stalled_ = false;
  bool in_contact_ = false;
  int contacts_ = 0;
  double free_way_ = 0.0;  // [m] robot and others together may go so far without touching
};

}  // namespace saphira::sim
