#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"

/// Registration of whole range scans with each other: for robots with a laser, where sonars give
/// features. Everything here is a pure function of its arguments.
namespace saphira::logs {

/// The points that a scan hit, in the robot's frame [m].
struct Scan {
  std::vector<Vec2> points;
  /// Unit normals of the surface, towards the sensor; zero where the neighbours make no line.
  std::vector<Vec2> normals;
  Vec2 sensor{0.0, 0.0};  ///< from where
};

/// How the beams of a scan lie, and which of them are used.
struct Beams {
  double first_angle = -kPi / 2;  ///< [rad] in the sensor's frame
  double step = radians(1.0);     ///< [rad] from beam to beam
  Pose sensor_in_robot;
  double min_range = 0.1;   ///< [m]
  double max_range = 20.0;  ///< [m] longer ones are no return, or too sparse to give a surface
};

Scan make_scan(const std::vector<double>& ranges, const Beams& beams);

/// Points of one or more scans in one frame, arranged for looking up the nearest.
class ScanReference {
 public:
  void add(const Scan& scan, const Pose& pose);
  /// To be called after the last add.
  void arrange();

  std::size_t size() const { return points_.size(); }
  const Vec2& point(std::size_t i) const { return points_[i]; }
  const Vec2& normal(std::size_t i) const { return normals_[i]; }
  /// The nearest point within `limit` [m] whose normal agrees within about 45 degrees.
  std::optional<std::size_t> nearest(const Vec2& at, const Vec2& normal, double limit) const;

 private:
  std::vector<Vec2> points_;
  std::vector<Vec2> normals_;
  // Cells of a grid over all points; the points of cell c are order_[start_[c] .. start_[c+1]).
  Vec2 origin_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<int> start_;
  std::vector<int> order_;
};

struct AlignSettings {
  int iterations = 25;
  double first_gate = 0.5;  ///< [m] partners farther away are none, at the first iteration
  double last_gate = 0.12;  ///< [m] and at the last ones
  double noise = 0.02;      ///< [m] of a point across its surface
  /// Of the guess, in the frame of the reference (x, y, th): holds what the scans leave open, as
  /// the way along a bare corridor. Zero: the guess is only a start.
  Eigen::Matrix3d guess_information = Eigen::Matrix3d::Zero();
};

struct Alignment {
  Pose pose;  ///< of the scan in the frame of the reference
  /// Of (x, y, th), from the surfaces alone.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double overlap = 0.0;  ///< share of the scan's points with a partner
  double rms = 0.0;      ///< [m] of these across the surface
};

/// Point to line registration (iterated closest point with robust weights) from a guess.
Alignment align(const ScanReference& reference, const Scan& scan, const Pose& guess,
                const AlignSettings& settings);

struct SearchWindow {
  double distance = 0.5;        ///< [m] to each side
  double turn = radians(15.0);  ///< to each side
  double turn_step = radians(1.0);
};

struct SearchResult {
  Pose pose;
  double score = 0.0;  ///< [0..1] mean likelihood of the scan's points
};

/// The evidence of a scan about points that were seen from elsewhere.
struct Sight {
  std::size_t agree = 0;    ///< it saw something there too
  std::size_t through = 0;  ///< it saw through them
};
/// The points are in the scan's frame. Those behind what it saw, and those beside, are not counted.
Sight look_at(const Scan& scan, const std::vector<Vec2>& points);

/// How likely a point is anywhere near a reference, with bounds for whole squares, so that the best
/// pose in a window is found without trying all (branch and bound: Olson, ICRA 2009; Hess et al.,
/// ICRA 2016).
class ScanField {
 public:
  explicit ScanField(const ScanReference& reference, int levels = 6);

  /// The best pose in the window about the guess that scores more than `at_least`.
  std::optional<SearchResult> search(const Scan& scan, const Pose& guess,
                                     const SearchWindow& window, double at_least) const;
  double score(const Scan& scan, const Pose& pose) const;
  /// How far from `best` the scan fits nearly as well, within a distance of `prior` (covariance of
  /// the position in the reference's frame): the mean square of the deviation, by all poses that
  /// have its heading. Large along a corridor, or where one room looks like the next.
  Eigen::Matrix2d slack(const Scan& scan, const Pose& best, const Vec2& expected,
                        const Eigen::Matrix2d& prior, double distance) const;

 private:
  // Highest likelihood in the square of 2^level cells to the right and up of a cell.
  float bound(int level, int column, int row) const;

  Vec2 origin_{0.0, 0.0};
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<float>> levels_;
};

}  // namespace saphira::logs
