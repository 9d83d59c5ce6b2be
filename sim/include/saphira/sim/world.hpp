#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/sim/corners.hpp"
#include "saphira/sim/movable.hpp"

namespace saphira::sim {

/// A wall, or a side of a thing: as high as the sonars look, without thickness.
struct Segment {
  Vec2 from{0.0, 0.0};  ///< [m] in the world
  Vec2 to{0.0, 0.0};
};

/// A round thing, as high as the sonars look: a robot, a person.
struct Disc {
  Vec2 centre{0.0, 0.0};  ///< [m] in the world
  double radius = 0.0;    ///< [m]
};

/// An obstacle of the world.
struct Things {
  std::vector<Segment> segments;
  std::vector<Disc> discs;
};

/// The surface that a ray meets.
struct Hit {
  double range = 0.0;      ///< [m]
  double incidence = 0.0;  ///< [rad] 0: along the normal of the segment, pi/2: grazing
};

/// Where in a world file something is said.
struct Place {
  int line = 1;
  int column = 1;
};

/// The parameters of sonars that a world file sets (directive sonar); else SonarModel's.
struct SonarPlan {
  std::optional<double> strength;  ///< [dB]
  std::optional<double> cloth;     ///< [dB]
  std::optional<double> spread;    ///< [dB]
};

/// A world description file (manual 3.3 and 11) in SI units; its frame `world` has its origin in
/// the lower left corner.
struct World {
  std::string file;
  double width = 0.0;   ///< [m]
  double height = 0.0;  ///< [m]
  std::vector<Segment> segments;
  std::vector<Corner> corners;  ///< of the segments
  std::optional<Pose> start;    ///< directive position: the robot's start_in_world
  Place start_place;
  std::vector<Place> robot_places;  ///< of movable.robots
  MovablePlans movable;             ///< what is no wall
  SonarPlan sonar;
  /// Oddities that do no harm, as lines to print ("file:line: ...").
  std::vector<std::string> warnings;
};

/// Reads the text of a world file; `file` names it in errors. What stands or walks in it is
/// checked against its walls. Width and height come first. Several
/// directives may stand on one line. A position (and a robot) is absolute, whatever has been pushed
/// (the manual gives relative coordinates to segments only). FileError where it is wrong.
World parse_world(std::string_view text, const std::string& file);

/// The same from a file, whose last line has a line break: it would not be noticed otherwise that a
/// file was cut off within a number. `things`: a second file of the same form, for what stands and
/// walks in that world besides; empty: none.
World load_world(const std::string& path, const std::string& things = "");

/// The point of the segment that is nearest to `point`.
Vec2 nearest_point(const Segment& segment, const Vec2& point);

/// The nearest point on any of the segments; nothing where there are none.
std::optional<Vec2> nearest_point(const std::vector<Segment>& segments, const Vec2& point);

/// The distance to the nearest of the segments; infinite where there are none.
double distance(const std::vector<Segment>& segments, const Vec2& point);

/// The nearest point on any of the things; nothing where there are none. Of a disc that the point
/// is in, the way out.
std::optional<Vec2> nearest_point(const Things& things, const Vec2& point);

/// The distance to the nearest of the things, negative in a disc; infinite where there are none.
double distance(const Things& things, const Vec2& point);

/// True where two segments have a point in common, be it an end; not where one lies upon the other.
bool intersect(const Segment& a, const Segment& b);

/// The first segment that a ray meets within `range`. `direction` is a unit vector.
std::optional<Hit> cast_ray(const std::vector<Segment>& segments, const Vec2& origin,
                            const Vec2& direction, double range);

/// The first thing that a ray meets within `range`. A ray from within a disc does not meet it.
std::optional<Hit> cast_ray(const Things& things, const Vec2& origin, const Vec2& direction,
                            double range);

/// The segments of a world that are near a moving point: the same answers as from all of them, at
/// the cost of those that matter.
class Neighbourhood {
 public:
  /// `reach` [m]: how far segments matter. The world outlives this object.
  Neighbourhood(const World& world, double reach) : world_(&world), reach_(reach) {}

  /// Every segment within the reach of `point`, and some that are not.
  const std::vector<Segment>& around(const Vec2& point);
  /// The same of the world's corners.
  const std::vector<const Corner*>& corners_around(const Vec2& point);

 private:
  void gather(const Vec2& point);

  const World* world_;
  double reach_;
  bool known_ = false;
  Vec2 centre_{0.0, 0.0};
  std::vector<Segment> segments_;
  std::vector<const Corner*> corners_;
};

}  // namespace saphira::sim
