#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "saphira/base/random.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

class Scene;

/// The time step of the dynamics, the same live and in single step, so their physics is the same.
inline constexpr double kTick = 0.010;  // [s]

/// The state of a body that is elsewhere, as its own sensors have measured it.
struct Measured {
  Pose pose;                       ///< in coordinates of its own, which do not jump
  double velocity = 0.0;           ///< [m/s]
  double rotation_velocity = 0.0;  ///< [rad/s]
  double battery = 0.0;            ///< [V] 0: unknown
};

/// A differential drive in a scene: a disc that is stopped by walls and by other robots.
///
/// Translation accelerates at a constant rate to the set velocity. A turn to a heading follows a
/// trapezoidal velocity function that is computed anew in every tick, so a new heading in the
/// middle of a turn is taken smoothly (manual 5.5, Figure 5-2).
///
/// The wheels' speed limit is that of the faster of two motions: straight on at the largest
/// velocity of the parameters, or on the spot at their largest rotation. Two velocities beyond that
/// are scaled by the same factor, so that the arc stays. A turn to a heading is as fast as on the
/// spot, and the robot drives more slowly meanwhile. No speed jumps: where the robot cannot slow
/// down in time, the turn waits.
///
/// The wheels follow the motors. The robot follows the wheels, but changes its speed by no more
/// than the grip of the tyres. So the wheels slip in an emergency stop, and while the robot pushes
/// against a fixed obstacle. Other errors are in the encoders. Per tick, with the true way ds and
/// the true turn dth, dead reckoning measures (manual Table 3-1 names the parameters and does not
/// define them):
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
  /// Dead reckoning becomes (0, 0, 0); a heading setpoint keeps its direction in the world.
  void set_origin();
  /// Stops and forgets all setpoints.
  void stop();
  /// The same with the motors' hardest braking; the wheels may slip.
  void emergency_stop();
  /// Motors without power (later robots' ENABLE): the robot brakes, and follows its setpoints again
  /// with power, as after brake().
  void enable(bool on);
  /// Motors off and on again. While off the robot brakes; on again it takes the last velocity
  /// setpoint, at its present heading (manual 5.4.4).
  void brake(bool on);

  // ---- Settings of a later robot's client; the parameter file's at first. Absolute values,
  // ---- clamped to the robot's limits.

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

  /// The body is elsewhere and follows the motors, late: this is its state. From the first call on
  /// no motion is simulated, and turns to a heading are slow enough for the lag.
  void measure(const Measured& body);
  /// Stops at once, without braking.
  void halt();
  double motor_velocity() const { return wheel_velocity_; }              ///< [m/s]
  double motor_rotation_velocity() const { return rotation_velocity_; }  ///< [rad/s]

  /// A person carries the robot elsewhere; dead reckoning does not change. False without room
  /// there.
  bool place(const Pose& pose_in_world);

  /// The state that outlasts the simulator (HostOptions::state).
  struct Memory {
    Pose pose_in_world;
    Pose pose_in_odom;
    double charge = 1.0;  ///< of the battery
  };
  Memory memory() const { return {pose_in_world_, pose_in_odom_, charge_}; }
  /// Stands there, as after memory(). False without room there.
  bool resume(const Memory& memory);

  // ---- State.

  const Pose& pose_in_world() const { return pose_in_world_; }  ///< true
  const Pose& pose_in_odom() const { return pose_in_odom_; }    ///< dead reckoning
  /// [m/s]
  double velocity() const { return body_ ? body_->velocity : velocity_; }
  double rotation_velocity() const {  ///< [rad/s]
    return body_ ? body_->rotation_velocity : rotation_velocity_;
  }
  double left_velocity() const;   ///< [m/s] of the wheel
  double right_velocity() const;  ///< [m/s] of the wheel
  /// Ways of the wheels [m] as the encoders have counted them since power-up.
  double left_way() const { return way_ - turned_ / rotation_per_difference_; }
  double right_way() const { return way_ + turned_ / rotation_per_difference_; }
  bool moving() const {
    return velocity_ != 0.0 || wheel_velocity_ != 0.0 || rotation_velocity_ != 0.0 || body_moves();
  }
  bool enabled() const { return enabled_; }

  double target_velocity() const;  ///< [m/s] in force: 0 while braked or without power
  bool controls_heading() const { return rotation_ == Rotation::kHeading; }
  /// [rad] in odom: the heading setpoint, or the present heading while none is controlled.
  double target_heading() const;
  double target_rotation_velocity() const;  ///< [rad/s] 0 while a heading is controlled

  /// A motor pushed against an obstacle since clear_stalls().
  bool left_stalled() const { return left_stalled_; }
  bool right_stalled() const { return right_stalled_; }
  void clear_stalls() { left_stalled_ = right_stalled_ = false; }
  /// Number of contacts. Pushing on, or sliding along, is the same contact.
  int contacts() const { return contacts_; }

  /// The touching ones of `switches` bumpers that share the front (or rear) half of the hull: a bit
  /// each, the lowest the leftmost as the robot looks ahead.
  std::uint8_t bumpers(int switches, bool rear);

  double battery() const;  ///< [V]
  /// Sets the charge by the battery's voltage at rest.
  void set_battery(double voltage);

  /// From the robot's hull to the nearest obstacle [m]; infinite in an empty world.
  double clearance() const;

  std::size_t number() const { return number_; }    ///< in its scene
  double radius() const { return radius_; }         ///< [m]
  double fastest() const { return max_velocity_; }  ///< [m/s] the greatest speed of its hull

 private:
  enum class Translation { kVelocity, kWay };
  enum class Rotation { kVelocity, kHeading };
  struct Motion {
    double forward = 0.0;  // [m/s]
    double turn = 0.0;     // [rad/s]
  };

  bool body_moves() const;
  bool powered() const { return enabled_ && !braked_; }
  double wanted_velocity() const;
  double wanted_rotation_velocity() const;
  double wheel_share(double turn) const;  // [m/s] of the wheels
  // The same arc within the limits of the parameters.
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
  double max_velocity_, max_rotation_velocity_;  // the motors' limits
  double move_velocity_, turn_velocity_;         // of moves and turns
  double acceleration_, deceleration_;
  double rotation_acceleration_, rotation_deceleration_;
  double max_acceleration_, max_rotation_acceleration_;  // limits of their settings
  double rotation_per_difference_;
  double max_wheel_velocity_;  // [m/s]
  double encode_jitter_, angle_jitter_, drift_;
  Random random_;

  std::optional<Measured> body_;
  Pose origin_;  // of dead reckoning, in the body's coordinates
  Pose pose_in_world_;
  Pose pose_in_odom_;
  double velocity_ = 0.0;        // of the robot
  double wheel_velocity_ = 0.0;  // of the wheels' middle; different while they slip
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
  double free_way_ = 0.0;  // [m] way of the robot and others together without contact
};

}  // namespace saphira::sim
