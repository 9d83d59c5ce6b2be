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
/// middle of a turn is taken up smoothly (manual 5.5, Figure 5-2). The wheels do what the motors
/// want but for contact: errors are in what the encoders say. Per tick, with the true way ds and
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

  void set_velocity(double velocity);                    ///< [m/s]
  void set_heading(double heading_in_odom);              ///< [rad]
  void turn_by(double angle);                            ///< [rad] from the heading now
  void set_rotation_velocity(double velocity);           ///< [rad/s]
  void set_wheel_velocities(double left, double right);  ///< [m/s]
  /// Dead reckoning becomes (0, 0, 0); a heading that was set keeps its direction in the world.
  void set_origin();
  /// Stops and forgets all setpoints.
  void stop();
  /// Motors off and on again. While off the robot brakes; on again it takes up the velocity that
  /// was set last, at the heading that it then has (manual 5.4.4).
  void brake(bool on);

  void tick();

  // ---- State.

  const Pose& pose_in_world() const { return pose_in_world_; }     ///< true
  const Pose& pose_in_odom() const { return pose_in_odom_; }       ///< dead reckoning
  double velocity() const { return velocity_; }                    ///< [m/s]
  double rotation_velocity() const { return rotation_velocity_; }  ///< [rad/s]
  double left_velocity() const;
  double right_velocity() const;
  bool moving() const { return velocity_ != 0.0 || rotation_velocity_ != 0.0; }

  double target_velocity() const;  ///< [m/s] in force: 0 while braked
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

  /// From the robot's hull to the nearest thing [m]; infinite in an empty world.
  double clearance() const;

  std::size_t number() const { return number_; }    ///< in its scene
  double radius() const { return radius_; }         ///< [m]
  double fastest() const { return max_velocity_; }  ///< [m/s] that its hull ever moves

 private:
  enum class Rotation { kVelocity, kHeading };

  double wanted_rotation_velocity() const;
  void move(double way, double turn);
  const Things& around();
  double free_part(const Things& things, const Vec2& way, double& clearance_after);

  Scene* scene_;
  std::size_t number_;
  Things around_;
  Neighbourhood near_;
  double radius_;
  double max_velocity_, max_rotation_velocity_;
  double acceleration_, deceleration_;
  double rotation_acceleration_, rotation_deceleration_;
  double rotation_per_difference_;
  double encode_jitter_, angle_jitter_, drift_;
  Random random_;

  Pose pose_in_world_;
  Pose pose_in_odom_;
  double velocity_ = 0.0;
  double rotation_velocity_ = 0.0;

  double velocity_setpoint_ = 0.0;
  Rotation rotation_ = Rotation::kVelocity;
  double rotation_setpoint_ = 0.0;
  double heading_setpoint_ = 0.0;
  bool braked_ = false;

  bool left_stalled_ = false;
  bool right_stalled_ = false;
  bool in_contact_ = false;
  int contacts_ = 0;
  double free_way_ = 0.0;  // [m] robot and others together may go so far without touching
};

}  // namespace saphira::sim
