#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"

/// Registration of whole range scans with each other: for robots with a laser instead of sonars
/// with features. All functions are pure.
namespace saphira::logs {

/// The points of a scan, in the robot's frame [m].
struct Scan {
  std::vector<Vec2> points;
  /// Unit normals of the surface, towards the sensor; zero where the neighbours form no line.
  std::vector<Vec2> normals;
  Vec2 sensor{0.0, 0.0};  ///< the sensor's place
};

/// The angles of a scan's beams, and the used ranges.
struct Beams {
  double first_angle = -kPi / 2;  ///< [rad] in the sensor's frame
  double step = radians(1.0);     ///< [rad] from beam to beam
  Pose sensor_in_robot;
  double min_range = 0.1;   ///< [m]
  double max_range = 20.0;  ///< [m] longer ones are no return, or too sparse for a surface
};

Scan make_scan(const std::vector<double>& ranges, const Beams& beams);

/// Points of one or more scans in one frame, for searches of the nearest.
class ScanReference {
 public:
  void add(const Scan& scan, const Pose& pose);
  /// Call after the last add.
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
  double first_gate = 0.5;  ///< [m] largest distance of partners, at the first iteration
  double last_gate = 0.12;  ///< [m] and at the last ones
  double noise = 0.02;      ///< [m] of a point across its surface
  /// Of the guess, in the frame of the reference (x, y, th): fixes directions that the scans leave
  /// open, such as the way along a bare corridor. Zero: the guess is only a start.
  Eigen::Matrix3d guess_information = Eigen::Matrix3d::Zero();
};

struct Alignment {
  Pose pose;  ///< of the scan in the frame of the reference
  /// Of (x, y, th), from the surfaces alone.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double overlap = 0.0;  ///< share of the scan's points with a partner
  double rms = 0.0;      ///< [m] distance of these across the surface
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

/// The evidence of a scan about points seen from another place.
struct Sight {
  std::size_t agree = 0;    ///< the scan has points there too
  std::size_t through = 0;  ///< the scan saw through them
};
/// The points are in the scan's frame. Points behind the scan's own, and beside its view, do not
/// count.
Sight look_at(const Scan& scan, const std::vector<Vec2>& points);

/// The likelihood of points near a reference, with bounds for whole squares, so that the best pose
/// in a window is found without trying all (branch and bound: Olson, ICRA 2009; Hess et al., ICRA
/// 2016).
class ScanField {
 public:
  explicit ScanField(const ScanReference& reference, int levels = 6);

  /// The best pose in the window about the guess with a score above `at_least`.
  std::optional<SearchResult> search(const Scan& scan, const Pose& guess,
                                     const SearchWindow& window, double at_least) const;
  double score(const Scan& scan, const Pose& pose) const;
  /// The distance from `best` at which the scan fits nearly as well, limited by `prior` (covariance
  /// of the position in the reference's frame): the mean square of the deviation, over all poses
  /// with the same heading. Large along a corridor, or among rooms that look alike.
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
