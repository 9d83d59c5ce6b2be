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
  // A scan becomes a node when the robot has gone on this far; others hang on the node before.
  double node_distance = 0.1;
  double node_turn = radians(5.0);

  // Dead reckoning, one sigma: constant, and per metre and radian.
  double odom_distance = 0.01;
  double odom_distance_per_metre = 0.10;
  double odom_turn = radians(0.5);
  double odom_turn_per_metre = radians(5.0);
  double odom_turn_per_radian = 0.15;

  double local_path = 4.0;       ///< the way back that a scan is matched with
  std::size_t local_nodes = 30;  ///< and at most so many nodes
  double good_overlap = 0.75;    ///< less than this after alignment: search wider
  double lost_overlap = 0.4;     ///< less than this: dead reckoning is all there is
  AlignSettings align;

  // Loop closure.
  double loop_path = 10.0;  ///< places that the robot left so far back along its path
  double loop_every = 0.5;  ///< looked for after so much path
  // The window is three sigmas of what the graph knows, and at least and at most:
  double loop_reach = 1.0;
  double loop_reach_limit = 20.0;
  double loop_turn = radians(8.0);
  double loop_turn_limit = radians(30.0);
  // The drift of matched scans, one sigma after one metre, growing with the root of the way: by
  // what real lasers do, which see floors that are not even and walls that are not plumb.
  double drift = 0.05;
  double drift_turn = radians(0.5);
  std::size_t loop_points = 150;  ///< the least that is seen of a place
  double loop_score = 0.55;       ///< least mean likelihood of the points
  double loop_overlap = 0.6;
  double loop_through = 0.1;  ///< the most of the points that are seen through
  double loop_slack = 0.25;   ///< [m] what fits as well so far away is not known at all
  double loop_agree_chi2 = 11.3;
};

/// The counts of ScanMapper.
struct ScanMapReport {
  std::size_t scans = 0;
  std::size_t nodes = 0;
  std::size_t searches = 0;   ///< times that alignment alone was not good enough
  std::size_t unmatched = 0;  ///< scans placed by dead reckoning alone
  std::size_t loop_candidates = 0;
  std::size_t loops = 0;  ///< accepted
};

/// Builds a consistent trajectory from scans and dead reckoning: each scan is matched with the
/// newest ones, loops are closed where a stretch of the way matches an older one and a second
/// stretch says the same, and a graph of all relations between poses is kept in equilibrium.
/// Deterministic; every call's cost is bounded but that of a closure and of refine().
class ScanMapper {
 public:
  explicit ScanMapper(const ScanMapSettings& settings = {}) : settings_(settings) {}

  /// The next scan, with dead reckoning's pose. Answers the present belief (frame of the first).
  Pose add(const Pose& pose_in_odom, Scan scan);
  /// Matches all neighbours with each other again and again, now that they are where they are:
  /// what one does after the drive.
  void refine(int rounds = 4);

  /// Of all scans so far, as known now.
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
  // Of the newest node's step, for what the graph knows.
  Eigen::Matrix3d step_covariance(const Pose& step) const;
  /// The covariance of nodes, seen from another: by the surest way through it.
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
