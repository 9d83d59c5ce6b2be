#include "saphira/logs/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace saphira::logs {

namespace {

Eigen::Vector3d deviation(const PoseEdge& edge, const std::vector<Pose>& poses) {
  const Pose off = relative(edge.to_in_from, relative(poses[edge.from], poses[edge.to]));
  return {off.x, off.y, off.th};
}

double cost(const std::vector<Pose>& poses, const std::vector<PoseEdge>& edges, double kernel) {
  double sum = 0.0;
  for (const PoseEdge& edge : edges) {
    const double c = chi2(edge, poses);
    sum += edge.doubtful ? kernel * kernel * std::log1p(c / (kernel * kernel)) : c;
  }
  return sum;
}

}  // namespace

double chi2(const PoseEdge& edge, const std::vector<Pose>& poses) {
  const Eigen::Vector3d e = deviation(edge, poses);
  return e.dot(edge.information * e);
}

GraphReport optimize(std::vector<Pose>& poses, const std::vector<PoseEdge>& edges, int iterations,
                     double kernel) {
  GraphReport report;
  report.before = report.after = cost(poses, edges, kernel);
  if (poses.size() < 2)
    return report;
  using Sparse = Eigen::SparseMatrix<double>;
  const auto size = static_cast<Eigen::Index>(3 * (poses.size() - 1));
  Eigen::SimplicialLDLT<Sparse> solver;
  bool analyzed = false;
  double damping = 1e-6;
  for (; report.iterations < iterations; ++report.iterations) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(36 * edges.size() + static_cast<std::size_t>(size));
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
    const auto put = [&](std::size_t i, std::size_t k, const Eigen::Matrix3d& block) {
      if (i == 0 || k == 0)
        return;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(static_cast<int>(3 * (i - 1)) + r, static_cast<int>(3 * (k - 1)) + c,
                               block(r, c));
    };
    for (const PoseEdge& edge : edges) {
      const Pose& from = poses[edge.from];
      const Pose& to = poses[edge.to];
      const Eigen::Vector3d e = deviation(edge, poses);
      const double c = std::cos(from.th);
      const double s = std::sin(from.th);
      const double cz = std::cos(edge.to_in_from.th);
      const double sz = std::sin(edge.to_in_from.th);
      Eigen::Matrix3d turn;  // from the frame of `from` into that of the measured pose
      turn << cz, sz, 0.0, -sz, cz, 0.0, 0.0, 0.0, 1.0;
      const double dx = to.x - from.x;
      const double dy = to.y - from.y;
      Eigen::Matrix3d by_from;
      by_from << -c, -s, -s * dx + c * dy, s, -c, -c * dx - s * dy, 0.0, 0.0, -1.0;
      Eigen::Matrix3d by_to;
      by_to << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
      const Eigen::Matrix3d a = turn * by_from;
      const Eigen::Matrix3d d = turn * by_to;
      const double weight =
          edge.doubtful ? 1.0 / (1.0 + e.dot(edge.information * e) / (kernel * kernel)) : 1.0;
      const Eigen::Matrix3d w = weight * edge.information;
      put(edge.from, edge.from, a.transpose() * w * a);
      put(edge.from, edge.to, a.transpose() * w * d);
      put(edge.to, edge.from, d.transpose() * w * a);
      put(edge.to, edge.to, d.transpose() * w * d);
      if (edge.from > 0)
        b.segment<3>(static_cast<Eigen::Index>(3 * (edge.from - 1))) += a.transpose() * w * e;
      if (edge.to > 0)
        b.segment<3>(static_cast<Eigen::Index>(3 * (edge.to - 1))) += d.transpose() * w * e;
    }
    Sparse h(size, size);
    h.setFromTriplets(entries.begin(), entries.end());
    Sparse diagonal(size, size);
    diagonal.setIdentity();
    bool better = false;
    double gain = 0.0;
    for (int attempt = 0; attempt < 6 && !better; ++attempt) {
      const Sparse damped = h + damping * diagonal;
      if (!analyzed)
        solver.analyzePattern(damped);
      analyzed = true;
      solver.factorize(damped);
      if (solver.info() != Eigen::Success) {
        damping = std::max(1e-3, 100.0 * damping);
        continue;
      }
      const Eigen::VectorXd step = solver.solve(-b);
      std::vector<Pose> moved = poses;
      for (std::size_t i = 1; i < moved.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(3 * (i - 1));
        moved[i].x += step[at];
        moved[i].y += step[at + 1];
        moved[i].th = norm2_angle(moved[i].th + step[at + 2]);
      }
      const double now = cost(moved, edges, kernel);
      if (now <= report.after) {
        gain = report.after - now;
        poses = std::move(moved);
        report.after = now;
        damping = std::max(1e-9, 0.1 * damping);
        better = true;
      } else {
        damping = std::max(1e-3, 100.0 * damping);
      }
    }
    if (!better || gain < 1e-6 * (1.0 + report.after))
      break;
  }
  return report;
}

}  // namespace saphira::logs
