#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/base/random.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

/// How a sonar sees. A smooth wall is a mirror to it: heard where the beam meets it nearly head-on,
/// and otherwise not at all; what is heard of it from aside is its corners (README, "Against real
/// sonars").
struct SonarModel {
  double cone = radians(25.0);    ///< [rad] full width of the beam
  int rays = 9;                   ///< over the cone; the nearest echo counts
  double max_range = 5.0;         ///< [m] no echo beyond (manual 6.3.2)
  double min_range = 0.05;        ///< [m] nearer things read as this
  double noise = 0.003;           ///< [m] standard deviation of a range...
  double relative_noise = 0.003;  ///< ...plus this share of it
  double dropout = 0.005;         ///< probability that an echo is not heard
  /// [rad] A surface that is met at more than this from its normal throws the sound off: its echo
  /// is lost with probability specular_loss (one decision a firing).
  double critical_angle = radians(14.0);
  double specular_loss = 0.98;
  double corner_cone = radians(20.0);  ///< [rad] full width of the beam in which corners are heard
  double corner_loss = 0.04;           ///< probability that none is (one decision a firing)
};

struct SonarEcho {
  std::uint8_t number = 0;
  std::optional<double> range;  ///< [m]; nothing: no echo
};

/// The order in which they fire until a client says another: by number within each of so many equal
/// arrays, the arrays taking turns.
std::vector<std::uint8_t> default_polling(std::size_t sonars, int arrays);

/// The sonars of a robot, fired in the polling sequence. Arrays that a robot fires at the same time
/// take turns here, within the period of one: so many readings a second come as from the robot.
class Sonars {
 public:
  /// Of the robot `self`, which they do not see. The scene outlives them.
  Sonars(const Scene& scene, RobotNumber self, const protocol::RobotParameters& parameters,
         const SonarModel& model, std::uint64_t seed);

  /// Which sonars fire, over and over; those that the robot does not have are left out.
  void set_polling(const std::vector<std::uint8_t>& sequence);
  /// All of them, in order in each array.
  void set_default_polling();

  /// One tick of time; a reading if one was made in it.
  std::optional<SonarEcho> tick(const Pose& robot_in_world);

  /// One firing.
  SonarEcho fire(std::uint8_t number, const Pose& robot_in_world);

 private:
  void hear_corner(const Vec2& corner, const Vec2& origin, const Vec2& ahead,
                   std::optional<double>& nearest) const;

  const Scene* scene_;
  RobotNumber self_;
  std::vector<protocol::SonarUnit> units_;
  SonarModel model_;
  Neighbourhood near_;
  Random random_;
  std::vector<std::uint8_t> sequence_;
  std::size_t next_ = 0;
  int period_;        // [ticks] of one array
  int arrays_;        // firings in a period
  int progress_ = 0;  // to the next firing, when it has come to a period
  double reach_;      // [m] from the robot's middle
  Things in_beam_;
};

}  // namespace saphira::sim
