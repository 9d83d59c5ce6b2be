#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/sim/corners.hpp"
#include "saphira/sim/movable.hpp"

namespace saphira::sim {

/// A wall, or a side of a thing: up to the height of the sonars, without thickness.
struct Segment {
  Vec2 from{0.0, 0.0};  ///< [m] in the world
  Vec2 to{0.0, 0.0};
};

/// A round thing, up to the height of the sonars: a robot, a person.
struct Disc {
  Vec2 centre{0.0, 0.0};  ///< [m] in the world
  double radius = 0.0;    ///< [m]
};

/// An obstacle of the world.
struct Things {
  std::vector<Segment> segments;
  std::vector<Disc> discs;
};

/// A place in a world file.
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
  MovablePlans movable;             ///< all things except walls
  SonarPlan sonar;
  /// Harmless oddities, as lines to print ("file:line: ...").
  std::vector<std::string> warnings;
};

/// Reads the text of a world file; `file` names it in errors. Its things and people are checked
/// against its walls. Width and height come first. Several directives may stand on one line. A
/// position (and a robot) is absolute, in spite of pushed frames (the manual gives relative
/// coordinates to segments only). FileError where it is wrong.
World parse_world(std::string_view text, const std::string& file);

/// The same from a file, whose last line must have a line break: a file that was cut off within a
/// number would not be noticed otherwise. `things`: a second file of the same form, with further
/// things and people; empty: none.
World load_world(const std::string& path, const std::string& things = "");

/// The nearest point of the segment to `point`.
Vec2 nearest_point(const Segment& segment, const Vec2& point);

/// The nearest point on any of the segments; nothing without segments.
std::optional<Vec2> nearest_point(const std::vector<Segment>& segments, const Vec2& point);

/// The distance to the nearest of the segments; infinite without segments.
double distance(const std::vector<Segment>& segments, const Vec2& point);

/// The nearest point on any of the things; nothing without things. For a point within a disc, the
/// way out.
std::optional<Vec2> nearest_point(const Things& things, const Vec2& point);

/// The distance to the nearest of the things, negative in a disc; infinite without things.
double distance(const Things& things, const Vec2& point);

/// True where two segments have a common point, including ends; not where they are collinear.
bool intersect(const Segment& a, const Segment& b);

/// The distance of the first segment that a ray meets within `range` [m]. `direction` is a unit
/// vector.
std::optional<double> cast_ray(const std::vector<Segment>& segments, const Vec2& origin,
                               const Vec2& direction, double range);

/// The same of the nearest thing. A ray from within a disc does not meet the disc.
std::optional<double> cast_ray(const Things& things, const Vec2& origin, const Vec2& direction,
                               double range);

/// The segments of a world near a moving point: the same results as from all of them, at the cost
/// of the near ones.
class Neighbourhood {
 public:
  /// `reach` [m]: distance at which segments count. The world outlives this object.
  Neighbourhood(const World& world, double reach) : world_(&world), reach_(reach) {}

  /// Every segment within the reach of `point`, and some beyond.
  const std::vector<Segment>& around(const Vec2& point);
  /// The same for the world's corners.
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
