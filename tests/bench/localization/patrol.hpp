#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/interpretation/interpretation.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::test {

/// A simulated robot with interpretation and registration, cycle by cycle.
class Localizer {
 public:
  /// Registered from `pose_in_map` on; without one it has to find it. `drive.world` is a name or a
  /// file.
  Localizer(const DriveOptions& drive, maps::Map map, std::optional<Pose> pose_in_map);

  const registration::Output& advance();
  /// Dead reckoning turns by so much more than the robot does [rad/m]. To be called at the start.
  void bend(double turn_per_metre) { bent_ = turn_per_metre; }
  /// What stands where the map has nothing is looked for.
  void find_objects(bool find) { finds_objects_ = find; }
  /// Measures what interpretation and registration take, by a clock in seconds.
  void set_clock(std::function<double()> clock) { clock_ = std::move(clock); }
  double took() const { return took_; }  ///< [s] of the last cycle

  Drive& drive() { return drive_; }
  registration::Registration& registration() { return registration_; }
  Pose truth() const { return drive_.seen().true_pose_in_world; }
  Pose believed() const { return registration_.output().pose_in_map; }
  /// By dead reckoning alone, from the true start.
  Pose reckoned() const { return compose(start_, drive_.seen().pose_in_odom); }
  const std::vector<lps::Percept>& percepts() const { return percepts_; }

 private:
  Drive drive_;
  Pose start_;
  double bent_ = 0.0;
  bool finds_objects_ = false;
  Pose last_in_odom_;  // as the robot says it...
  Pose bent_in_odom_;  // ...and bent
  interpretation::Interpretation interpretation_;
  registration::Registration registration_;
  std::vector<lps::Percept> percepts_;
  std::function<double()> clock_;
  double took_ = 0.0;
};

/// How far off in each cycle.
struct Offs {
  std::vector<double> position;  // [m]
  std::vector<double> heading;   // [rad]
  void add(const Pose& believed, const Pose& truth);
};

/// Round the corridors of the office floor; `library`: and through the library.
std::vector<Vec2> office_tour(bool library = false);

struct PatrolResult {
  Offs registered;  ///< while it tracks
  Offs reckoned;
  double way = 0.0;          ///< [m]
  std::size_t reached = 0;   ///< points of the tour
  int not_tracking = 0;      ///< cycles
  std::vector<double> took;  ///< [s] of a cycle, where there is a clock
};
/// Drives by what it believes.
PatrolResult patrol(Localizer& robot, const std::vector<Vec2>& points, int cycles);

}  // namespace saphira::test
