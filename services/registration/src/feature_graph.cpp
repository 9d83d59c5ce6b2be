#include "saphira/registration/feature_graph.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace saphira::registration {

namespace {

// A row of the linearized problem: at most nine variables.
struct Row {
  struct Part {
    int variable;
    double slope;
  };
  std::vector<Part> parts;
  double error = 0.0;  ///< in sigmas
};

class Problem {
 public:
  explicit Problem(int size) : gradient_(Eigen::VectorXd::Zero(size)) {
    for (int i = 0; i < size; ++i)
      hessian_.emplace_back(i, i, 1e-9);
  }

  void add(const Row& row, double weight) {
    for (const Row::Part& a : row.parts) {
      if (a.variable < 0)
        continue;
      gradient_(a.variable) -= weight * a.slope * row.error;
      for (const Row::Part& b : row.parts)
        if (b.variable >= 0 && b.variable <= a.variable)
          hessian_.emplace_back(a.variable, b.variable, weight * a.slope * b.slope);
    }
  }

  /// The step, and the covariance of the three variables from `pose` on, where requested.
  std::optional<Eigen::VectorXd> solve(int pose, Eigen::Matrix3d& covariance) const {
    const auto n = gradient_.size();
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(hessian_.begin(), hessian_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success)
      return std::nullopt;
    for (int k = 0; pose >= 0 && k < 3; ++k) {
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(n);
      unit(pose + k) = 1.0;
      covariance.col(k) = solver.solve(unit).segment<3>(pose);
    }
    Eigen::VectorXd step = solver.solve(gradient_);
    return step.allFinite() ? std::optional(std::move(step)) : std::nullopt;
  }

 private:
  std::vector<Eigen::Triplet<double>> hessian_;  ///< the lower half
  Eigen::VectorXd gradient_;
};

Vec2 turned(double angle, const Vec2& v) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

Vec2 left_of(const Vec2& v) {
  return {-v.y(), v.x()};
}

}  // namespace

Eigen::Matrix3d FeatureGraph::way_covariance(const Pose& way) const {
  const double length = std::hypot(way.x, way.y);
  const double along = 1e-6 + settings.way_error * settings.way_error * length;
  const double turn = 2.5e-7 + settings.heading_error * settings.heading_error * length +
                      settings.turn_error * settings.turn_error * std::abs(way.th);
  return Eigen::Vector3d(along, along, turn).asDiagonal();
}

double FeatureGraph::optimize(int iterations) {
  // Variables: the nodes' poses, the lines' headings and offsets, the points, the drift.
  std::vector<int> of_node(nodes.size(), -1);
  int size = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!nodes[i].fixed) {
      of_node[i] = size;
      size += 3;
    }
  const int of_lines = size;
  size += 2 * static_cast<int>(lines.size());
  const int of_points = size;
  size += 2 * static_cast<int>(points.size());
  const int of_drift = size++;
  const auto part = [&](std::size_t node, int k) {
    return of_node[node] < 0 ? -1 : of_node[node] + k;
  };
  const std::vector<GraphNode> before = nodes;

  for (int iteration = 0; iteration < iterations; ++iteration) {
    Problem problem(size);
    const auto pull = [&](int variable, double error, double sigma) {
      problem.add({{{variable, 1.0 / sigma}}, error / sigma}, 1.0);
    };
    pull(of_drift, drift, settings.drift_error);
    bool first = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].fixed)
        continue;
      const bool from_before = i > 0 && !nodes[i].broken;
      if (!from_before) {
        // The start, or a new beginning of dead reckoning: near its estimated place.
        const double position = first ? settings.start_position : 0.5;
        const double heading = first ? settings.start_heading : 0.3;
        pull(of_node[i], nodes[i].in_map.x - before[i].in_map.x, position);
        pull(of_node[i] + 1, nodes[i].in_map.y - before[i].in_map.y, position);
        pull(of_node[i] + 2, norm2_angle(nodes[i].in_map.th - before[i].in_map.th), heading);
        first = false;
        continue;
      }
      first = false;
      const Pose& from = nodes[i - 1].in_map;
      const Pose& to = nodes[i].in_map;
      const Pose way = relative(nodes[i - 1].in_odom, nodes[i].in_odom);
      const double length = std::hypot(way.x, way.y);
      const Eigen::Matrix3d noise = way_covariance(way);
      const double sigma_way = std::sqrt(noise(0, 0));
      const double sigma_turn = std::sqrt(noise(2, 2));
      const Vec2 moved = turned(from.th, {way.x, way.y});
      const Vec2 error = to.position() - from.position() - moved;
      const Vec2 slope = left_of(moved);
      for (int k = 0; k < 2; ++k) {
        const double s = 1.0 / sigma_way;
        problem.add({{{part(i, k), s}, {part(i - 1, k), -s}, {part(i - 1, 2), -slope(k) * s}},
                     error(k) * s},
                    1.0);
      }
      const double s = 1.0 / sigma_turn;
      problem.add({{{part(i, 2), s}, {part(i - 1, 2), -s}, {of_drift, length * s}},
                   norm2_angle(to.th - from.th - way.th + drift * length) * s},
                  1.0);
    }
    // Cauchy: a distant measurement probably belongs to another object.
    const auto doubtful = [&](const Row& a, const Row& b) {
      const double far =
          (a.error * a.error + b.error * b.error) / (settings.kernel * settings.kernel);
      const double weight = 1.0 / (1.0 + far);
      problem.add(a, weight);
      problem.add(b, weight);
    };
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const GraphLine& line = lines[l];
      const int heading = of_lines + 2 * static_cast<int>(l);
      const Vec2 n = line.normal();
      for (const SeenLine& seen : line.seen) {
        const Pose& node = nodes[seen.node].in_map;
        const Vec2 out = turned(node.th, seen.in_node.position());
        const Vec2 from_anchor = node.position() + out - line.anchor;
        const double across = 1.0 / seen.sigma_across;
        const double turn = 1.0 / seen.sigma_heading;
        doubtful({{{part(seen.node, 0), n.x() * across},
                   {part(seen.node, 1), n.y() * across},
                   {part(seen.node, 2), n.dot(left_of(out)) * across},
                   {heading, -line.along().dot(from_anchor) * across},
                   {heading + 1, -across}},
                  (n.dot(from_anchor) - line.offset) * across},
                 {{{heading, turn}, {part(seen.node, 2), -turn}},
                  norm2_angle(line.heading - node.th - seen.in_node.th) * turn});
      }
      if (line.on_grid) {
        const double off = line.heading - std::round(line.heading / (kPi / 2)) * (kPi / 2);
        pull(heading, off, settings.grid_error);
      }
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
      const int at = of_points + 2 * static_cast<int>(p);
      for (const SeenPoint& seen : points[p].seen) {
        const Pose& node = nodes[seen.node].in_map;
        const Vec2 out = turned(node.th, seen.in_node.position());
        const Vec2 error = node.position() + out - points[p].in_map;
        const double normal = node.th + seen.in_node.th;
        const Vec2 u(std::cos(normal), std::sin(normal));
        const auto row = [&](const Vec2& axis, double sigma) {
          const double s = 1.0 / sigma;
          return Row{{{part(seen.node, 0), axis.x() * s},
                      {part(seen.node, 1), axis.y() * s},
                      {part(seen.node, 2), axis.dot(left_of(out)) * s},
                      {at, -axis.x() * s},
                      {at + 1, -axis.y() * s}},
                     axis.dot(error) * s};
        };
        doubtful(row(u, seen.sigma_along), row(left_of(u), seen.sigma_across));
      }
    }

    const auto step = problem.solve(nodes.empty() ? -1 : of_node.back(), covariance);
    if (!step)
      break;  // stays where it is
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (of_node[i] >= 0) {
        Pose& pose = nodes[i].in_map;
        pose.x += (*step)(of_node[i]);
        pose.y += (*step)(of_node[i] + 1);
        pose.th = norm2_angle(pose.th + (*step)(of_node[i] + 2));
      }
    for (std::size_t l = 0; l < lines.size(); ++l) {
      lines[l].heading =
          norm2_angle(lines[l].heading + (*step)(of_lines + 2 * static_cast<int>(l)));
      lines[l].offset += (*step)(of_lines + 2 * static_cast<int>(l) + 1);
    }
    for (std::size_t p = 0; p < points.size(); ++p)
      points[p].in_map += step->segment<2>(of_points + 2 * static_cast<int>(p));
    drift += (*step)(of_drift);
    if (step->lpNorm<Eigen::Infinity>() < 1e-5)
      break;
  }
  double moved = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    moved = std::max(moved, (nodes[i].in_map.position() - before[i].in_map.position()).norm());
  return moved;
}

}  // namespace saphira::registration
