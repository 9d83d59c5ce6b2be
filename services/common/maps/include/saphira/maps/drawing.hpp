#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/maps/map.hpp"

namespace saphira::maps {

/// An occupancy grid as it is drawn.
struct Raster {
  Pose lower_left_in_map;  ///< the corner of its first cell; rows run along the heading
  double cell = 0.1;       ///< [m]
  int width = 0;           ///< cells in a row
  int height = 0;          ///< rows
  /// Row by row: the probability of being occupied [0..1]; less than 0: nothing is known.
  std::vector<float> occupied;
};

/// A way that was driven.
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

/// Something seen, and what it was taken for.
struct DrawnMatch {
  Vec2 seen_in_map{0.0, 0.0};
  Vec2 artifact_in_map{0.0, 0.0};
  bool accepted = true;
};

/// Where the robot believes to be.
struct DrawnRobot {
  Pose pose_in_map;
  double radius = 0.22;  ///< [m]
  /// Variances of x and y and their covariance [m2]; drawn as an ellipse of two sigmas.
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
};

/// The contents of a picture of a map. All but the map may be left empty.
struct Drawing {
  Map map;
  std::string title;
  std::set<std::uint32_t> closed_doors;  ///< ids, drawn black
  std::optional<Raster> raster;
  /// Pairs of end points: the walls of a simulated world, or percepts, under all else.
  std::vector<Vec2> lines;
  std::vector<Trajectory> trajectories;
  /// Over the map and the ways.
  std::vector<Strokes> strokes;
  std::vector<Words> words;
  std::vector<DrawnMatch> matches;
  std::optional<DrawnRobot> robot;
};

/// A picture of it as an SVG document: y up, a frame in metres, a scale and a legend. Numbers are
/// rounded to a millimetre, so that the same drawing is the same text.
std::string to_svg(const Drawing& drawing);

}  // namespace saphira::maps
