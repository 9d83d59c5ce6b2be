#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/maps/map.hpp"

namespace saphira::maps {

/// An occupancy grid to draw.
struct Raster {
  Pose lower_left_in_map;  ///< the corner of its first cell; rows run along the heading
  double cell = 0.1;       ///< [m]
  int width = 0;           ///< cells in a row
  int height = 0;          ///< rows
  /// Row by row: the probability of being occupied [0..1]; less than 0: unknown.
  std::vector<float> occupied;
};

/// A driven way.
struct Trajectory {
  std::string name;  ///< in the legend
  std::vector<Vec2> points_in_map;
};

/// Strokes of one kind.
struct Strokes {
  std::string name;   ///< in the legend; empty: not there
  std::string color;  ///< as SVG writes it
  double width = 0.06;
  std::vector<Vec2> lines;  ///< pairs of end points
};

/// Words in the picture.
struct Words {
  Vec2 at_in_map{0.0, 0.0};
  std::string text;
  std::string color;  ///< as SVG writes it
};

/// A percept, and its match on the map.
struct DrawnMatch {
  Vec2 seen_in_map{0.0, 0.0};
  Vec2 artifact_in_map{0.0, 0.0};
  bool accepted = true;
};

/// The robot's estimated place.
struct DrawnRobot {
  Pose pose_in_map;
  double radius = 0.22;  ///< [m]
  /// Variances of x and y and their covariance [m2]; drawn as an ellipse of two sigmas.
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
};

/// The contents of a picture of a map. All but the map may be empty.
struct Drawing {
  Map map;
  std::string title;
  std::set<std::uint32_t> closed_doors;  ///< ids, drawn black
  std::optional<Raster> raster;
  /// Pairs of end points: the walls of a simulated world, or percepts, drawn first.
  std::vector<Vec2> lines;
  std::vector<Trajectory> trajectories;
  /// Over the map and the ways.
  std::vector<Strokes> strokes;
  std::vector<Words> words;
  std::vector<DrawnMatch> matches;
  std::optional<DrawnRobot> robot;
};

/// The picture as an SVG document: y up, a frame in metres, a scale and a legend. Numbers are
/// rounded to a millimetre, so that the same drawing gives the same text.
std::string to_svg(const Drawing& drawing);

}  // namespace saphira::maps
