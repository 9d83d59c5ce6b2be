#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/base/random.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

/// The model of a sonar.
///
/// A wall is a mirror: its echo comes from the point where the sound meets it at a right angle,
/// whatever the sonar's direction, or not at all. The figures are from real sonars (README,
/// "Against real sonars").
///
/// All other objects (legs, posts, robots, edges, inner corners, narrow strips) answer with a
/// margin above the threshold of
///
///     strength - loss by the shape - loss by the material - 2 x loss by the beam - loss by the way
///
/// in dB (acoustics.hpp), and are heard with the probability Phi(margin / spread). The random part
/// stays the same for one sonar and one object for 0.3 s. The nearest heard object gives the range;
/// objects before it hide it.
struct SonarModel {
  double max_range = 5.0;         ///< [m] no echo beyond (manual 6.3.2)
  double noise = 0.002;           ///< [m] standard deviation of a range...
  double relative_noise = 0.002;  ///< ...plus this share of it
  double dropout = 0.005;         ///< probability that an echo is not heard
  /// [rad] A surface whose normal is within this angle of the sonar's axis is always heard...
  double critical_angle = radians(17.0);
  /// ...and beyond it less and less, down to never at lost_angle for the nearest surfaces, and at
  /// an angle smaller by the next member for each metre of distance.
  double lost_angle = radians(95.0);
  double lost_per_metre = radians(45.0);
  /// [dB] The margin of an unhindered wall on the axis above the threshold. Real ones are between
  /// 36 and 47. A world file may set it, as well as cloth and spread.
  double strength = 40.0;
  double cloth = 5.0;        ///< [dB] absorbed by people's clothes; 2 to 10
  double spread = 2.0;       ///< [dB] standard deviation of the strength of hard objects...
  double soft_spread = 5.0;  ///< ...and of soft ones
  double edge = 0.005;       ///< [m] radius of an edge...
  double jamb = 0.05;        ///< [m] ...and of the end of a wall, which stands for a door post
  /// [rad] full width of the beam for the direct sound of another robot's sonar
  double direct_cone = radians(20.0);
  /// Probability that a sonar hears a nearer echo of the sonar that fired before, in another array.
  /// Firings of one array are too far apart in time for that.
  double crosstalk = 0.01;
  /// Probability that a surface reflects sound at any angle: then the nearest of `rays` over `cone`
  /// counts.
  double roughness = 0.02;
  double cone = radians(25.0);  ///< [rad] full width
  int rays = 9;
};

/// The model with the parameters of a world.
SonarModel in_world(SonarModel model, const SonarPlan& plan);

/// [m/s] of sound.
inline constexpr double kSound = 343.0;

struct SonarEcho {
  std::uint8_t number = 0;
  std::optional<double> range;  ///< [m]; nothing: no echo
};

/// The firing order until a client sets another: by number within each of so many equal arrays, the
/// arrays taking turns.
std::vector<std::uint8_t> default_polling(std::size_t sonars, int arrays);

/// The sonars of a robot, fired in the polling sequence. Arrays that a robot fires at the same time
/// take turns here, within the period of one: the number of readings a second is the robot's.
///
/// Crosstalk: the sound of another robot's sonar that points this way counts as an echo, if it
/// comes before the true echo. A robot with several arrays at times hears the echo of the sonar
/// that fired before (SonarModel::crosstalk).
class Sonars {
 public:
  /// The sonars of the robot `self`, which they do not hear. The scene outlives them.
  Sonars(Scene& scene, RobotNumber self, const protocol::RobotParameters& parameters,
         const SonarModel& model, std::uint64_t seed);

  /// The firing sequence, repeated; sonars that the robot does not have are left out.
  void set_polling(const std::vector<std::uint8_t>& sequence);
  /// All of them, in order in each array.
  void set_default_polling();

  /// One tick of time; returns a reading, if any.
  std::optional<SonarEcho> tick(const Pose& robot_in_world);

  /// One firing.
  SonarEcho fire(std::uint8_t number, const Pose& robot_in_world);

 private:
  // The firing sonar, its pose, its angle for walls, and its nearest echo.
  struct Firing {
    std::uint8_t number = 0;
    Vec2 origin;
    Vec2 ahead;
    double aside = 0.0;             // [0, 1) from the critical angle to the lost one
    std::optional<double> nearest;  // [m]
  };
  void gather(const Vec2& robot, const Firing& firing);
  void hear_rough(const Pose& at, Firing& firing) const;
  void hear_surfaces(Firing& firing) const;
  void hear_wall(const Vec2& way, double range, Firing& firing) const;
  void hear_strip(const Segment& segment, const Surface& surface, Firing& firing) const;
  void hear_corners(const Vec2& robot, Firing& firing);
  void hear_disc(const Disc& disc, const Surface& surface, Firing& firing) const;
  // An echo from `way` away, whose shape loses shape() [dB]: called only where it matters.
  template <class Loss>
  void hear(const Vec2& way, double range, const Surface& surface, Firing& firing,
            const Loss& shape) const;
  // Random variation of the strength of one thing's echo [standard deviations].
  double luck(std::uint8_t number, std::uint32_t thing) const;
  // True where no object stands before that place, and it is nearer than the nearest echo.
  bool is_first(const Firing& firing, const Vec2& way, double range) const;
  bool in_direct_cone(const Firing& firing, const Vec2& way) const;
  void hear_others(Firing& firing) const;

  Scene* scene_;
  RobotNumber self_;
  std::vector<protocol::SonarUnit> units_;
  SonarModel model_;
  double min_range_;  // [m] nearer objects read as this
  Neighbourhood near_;
  Random random_;
  Random crosstalk_;  // separate, so that crosstalk does not shift the other draws
  std::vector<std::uint8_t> sequence_;
  std::size_t next_ = 0;
  int period_;          // [ticks] of one array
  int arrays_;          // firings in a period
  int progress_ = 0;    // towards the next firing, due at a period
  double reach_;        // [m] from the robot's middle
  double beam_cosine_;  // of the angle off the axis beyond which only walls are heard
  double direct_cosine_;
  std::optional<double> before_;  // [m] range of the last firing
  std::uint64_t seed_;
  std::uint64_t firings_ = 0;
  Echoes in_beam_;
};

}  // namespace saphira::sim
