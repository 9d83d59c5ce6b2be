#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::authority {

/// The body that is guarded.
struct Body {
  double radius = 0.0;                 ///< [m] of the hull, a circle
  double max_velocity = 0.0;           ///< [m/s]
  double max_rotation_velocity = 0.0;  ///< [rad/s]
  double deceleration = 0.0;           ///< [m/s2] of a stop
  /// [s] from an echo to the effect of a stop: half a round of the sonars, link, server.
  double reaction = 0.3;
  double sonar_range = 5.0;  ///< [m] no echo beyond
  bool sees_behind = false;  ///< some sonar within 60 degrees of straight back fires
  bool sees_ahead = true;    ///< the same of straight ahead
  double sweep_ahead = 0.0;  ///< [rad] by which it swings to cover the gap between its sonars ahead
  double sweep_behind = 0.0;  ///< [rad] the same of those behind
  /// [m] of the hull's path that its sonars have covered lately.
  double covered = std::numeric_limits<double>::infinity();
  bool knows_edges = false;  ///< the driver's map tells walls and door posts from people
};

/// The distances that the guard keeps from one kind of echo.
struct Clearance {
  double side_margin = 0.0;  ///< [m] width beside the hull's path that counts as ahead
  /// [m] An obstacle may reach this far beyond its echo. The hull stays this far away, but where it
  /// passes at `least`: there it approaches at `touch_velocity` at most.
  double reach = 0.0;
  double touch_velocity = 0.0;  ///< [m/s]
  double least = 0.0;           ///< [m] from the obstacle's echo to the sides of the hull's path
  /// [m] Of an echo's place: added to `reach` where the hull would come nearer than it is to any.
  double error = 0.0;
};

/// The guard's limits for one role. They come from the shape of a person: a sonar hears a shin, and
/// the person reaches some 0.2 m farther than the shin, ahead and aside.
struct GuardSettings {
  bool enabled = true;
  double max_velocity = 0.0;           ///< [m/s]; 0: the robot's own
  double max_blind_velocity = 0.15;    ///< [m/s] where no sonar has looked; 0: the robot's own
  double max_rotation_velocity = 0.0;  ///< [rad/s]; 0: the robot's own
  /// [m] The way counts as free no farther than this, even without echoes: a standing person is
  /// heard dependably up to 1.5 m.
  double dependable_range = 1.5;
  double margin = 0.25;  ///< [m] distance at which the hull stops before an obstacle ahead
  Clearance person{0.10, 0.25, 0.005, 0.22, 0.03};  ///< from an echo that is of no edge of the map
  Clearance anything{0.10, 0.15, 0.035, 0.10};      ///< from any echo, without a map
  Clearance edge{0.08, 0.15, 0.035, 0.0};           ///< from an edge of the map
  /// [m/s] An obstacle ahead may approach at this speed, so the robot slows early...
  double closing_velocity = 0.4;
  double careful_velocity = 0.05;  ///< [m/s] ...down to this speed
  /// [m] A person this near beside the path may step into it: passed at `beside_velocity` at most.
  double beside = 0.4;
  double beside_velocity = 0.15;       ///< [m/s]
  double max_contact_velocity = 0.15;  ///< [m/s] for a driver who wants contact; 0: never
  double slow_distance = 0.0;          ///< [m] below which slow_velocity holds; 0: none
  double slow_velocity = 0.15;         ///< [m/s]
};

enum class GuardAction { none, limit, slow, stop };

struct Guarded {
  double velocity = 0.0;           ///< [m/s]
  double rotation_velocity = 0.0;  ///< [rad/s]
  GuardAction action = GuardAction::none;
  std::string reason;
  /// The echo that is the reason, in the robot's frame; none: it is another one.
  std::optional<Vec2> obstacle = std::nullopt;
  bool sweep = false;  ///< the sonars have to cover more of the path, or the robot becomes slow

  SAPHIRA_ARCHIVE(velocity, rotation_velocity, action, reason, obstacle, sweep)
};

/// The greatest speed [m/s] from which the robot is down to `end` [m/s] after `distance` [m]. A
/// stop takes effect after `reaction` [s] with `deceleration` [m/s2], and the obstacle approaches
/// at `closing` [m/s] until then.
double approach_speed(double distance, double end, double reaction, double deceleration,
                      double closing = 0.0);

/// Limits a wanted motion to a safe one, for a robot that turns at `turning` [rad/s] meanwhile.
/// `points` are the echoes that may be a person's, `edges` those of the driver's map, in the
/// robot's frame. Pure. Not for the emergency stop, which stops anyway. Rotation on the spot is
/// never stopped: the hull is round, and turning is the way out. `contact_speed`: the driver wants
/// to touch an obstacle ahead, forward and at no more than this [m/s]; 0: no contact is wanted.
Guarded guard(const GuardSettings& settings, const Body& body, const std::vector<Vec2>& points,
              double velocity, double rotation_velocity, double turning = 0.0,
              double contact_speed = 0.0, const std::vector<Vec2>& edges = {});

/// Limits the speed by the age [s] of the command: the robot moves no further than kUnseenWay on a
/// decision from an old state. Up to `fresh` [s] a command counts as new, since it holds until the
/// next cycle's command comes.
Guarded slow_for_age(Guarded guarded, double age, double fresh);

}  // namespace saphira::authority
