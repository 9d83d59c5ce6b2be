#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/logs/pose_graph.hpp"
#include "saphira/logs/scan_matching.hpp"

namespace saphira::logs {

/// Tunables of ScanMapper. Lengths in metres, angles in radians.
struct ScanMapSettings {
  // A scan becomes a node after this motion; others belong to the node before.
  double node_distance = 0.1;
  double node_turn = radians(5.0);

  // Dead reckoning, one sigma: constant, and per metre and radian.
  double odom_distance = 0.01;
  double odom_distance_per_metre = 0.10;
  double odom_turn = radians(0.5);
  double odom_turn_per_metre = radians(5.0);
  double odom_turn_per_radian = 0.15;

  double local_path = 4.0;       ///< the length of way that a scan is matched with
  std::size_t local_nodes = 30;  ///< and at most so many nodes
  double good_overlap = 0.75;    ///< below it after alignment: search wider
  double lost_overlap = 0.4;     ///< below it: dead reckoning alone
  AlignSettings align;

  // Loop closure.
  double loop_path = 10.0;  ///< least way since a place that counts for a closure
  double loop_every = 0.5;  ///< way between two searches
  // The window: three sigmas of the graph, within these limits:
  double loop_reach = 1.0;
  double loop_reach_limit = 20.0;
  double loop_turn = radians(8.0);
  double loop_turn_limit = radians(30.0);
  // The drift of matched scans, one sigma after one metre, growing with the root of the way: as
  // observed with real lasers, on uneven floors and with walls that are not vertical.
  double drift = 0.05;
  double drift_turn = radians(0.5);
  std::size_t loop_points = 150;  ///< least number of seen points of a place
  double loop_score = 0.55;       ///< least mean likelihood of the points
  double loop_overlap = 0.6;
  double loop_through = 0.1;  ///< largest share of points that a scan sees through
  double loop_slack = 0.25;   ///< [m] a second fit at this distance makes the direction unknown
  double loop_agree_chi2 = 11.3;
};

/// The counts of ScanMapper.
struct ScanMapReport {
  std::size_t scans = 0;
  std::size_t unmatched = 0;  ///< scans placed by dead reckoning alone
  std::size_t loops = 0;      ///< closed
};

/// Builds a consistent trajectory from scans and dead reckoning: each scan is matched with the
/// newest ones; a loop is closed where a stretch of the way matches an older one and a second
/// stretch agrees; a graph of all relations between poses is kept optimal. Deterministic; every
/// call's cost is bounded, except a closure and refine().
class ScanMapper {
 public:
  explicit ScanMapper(const ScanMapSettings& settings = {}) : settings_(settings) {}

  /// The next scan, with dead reckoning's pose. Returns the present estimate (frame of the first).
  Pose add(const Pose& pose_in_odom, Scan scan);
  /// Matches all neighbours with each other repeatedly, from the final poses: after the drive.
  void refine(int rounds = 4);

  /// The poses of all scans so far, by the present estimate.
  std::vector<Pose> trajectory() const;
  const std::vector<Pose>& nodes() const { return poses_; }
  const std::vector<Scan>& node_scans() const { return scans_; }
  const ScanMapReport& report() const { return report_; }

 private:
  struct Hung {
    std::size_t node = 0;
    Pose in_node;
  };
  struct Closure {
    std::size_t from = 0;
    std::size_t to = 0;
    Pose to_in_from;
    Eigen::Matrix3d covariance;  ///< of to_in_from, in its own frame
    std::size_t agreeing = 0;
    bool accepted = false;
  };

  // A reference of the nodes, in the frame of the node `origin`.
  ScanReference reference(const std::vector<std::size_t>& nodes, std::size_t origin) const;
  std::vector<std::size_t> along_path(std::size_t about, double back, double ahead) const;
  Scan stretch(std::size_t node, double back) const;
  Eigen::Matrix3d odom_information(const Pose& step) const;
  // The covariance of the newest node's step, for the graph.
  Eigen::Matrix3d step_covariance(const Pose& step) const;
  /// The covariance of nodes relative to another, by the most certain path.
  std::vector<Eigen::Matrix3d> covariances(std::size_t from,
                                           const std::vector<std::size_t>& of) const;
  std::optional<Closure> find_closure(std::size_t pass, std::size_t here,
                                      const Eigen::Matrix3d& covariance, const Scan& query) const;
  double through(const Closure& closure) const;
  void close_loops();
  void accept(const std::vector<Closure>& closures);
  std::vector<PoseEdge> all_edges() const;

  ScanMapSettings settings_;
  std::vector<Pose> poses_;   // of the nodes
  std::vector<Scan> scans_;   // of the nodes
  std::vector<double> path_;  // length of the way up to each node
  std::vector<PoseEdge> chain_;
  std::vector<PoseEdge> odometry_;
  std::vector<PoseEdge> loops_;
  std::vector<Eigen::Matrix3d> steps_;  // covariance of each node's step from the one before
  std::vector<std::vector<std::size_t>> loops_at_;
  std::vector<Closure> pending_;
  std::vector<Hung> hung_;
  Pose last_odom_;
  Pose node_odom_;
  Pose believed_in_node_;
  double searched_at_ = 0.0;
  ScanMapReport report_;
};

}  // namespace saphira::logs
