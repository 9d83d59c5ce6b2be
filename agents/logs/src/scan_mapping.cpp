#include "saphira/logs/scan_mapping.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "saphira/base/shortest_ways.hpp"
#include "saphira/geometry/axes.hpp"

namespace saphira::logs {

namespace {

Eigen::Matrix3d diagonal(double along, double across, double turn) {
  return Eigen::Vector3d(1.0 / (along * along), 1.0 / (across * across), 1.0 / (turn * turn))
      .asDiagonal();
}

Eigen::Matrix3d diagonal_covariance(double distance, double turn) {
  return Eigen::Vector3d(distance * distance, distance * distance, turn * turn).asDiagonal();
}

// Converts the information (or covariance) of a pose's (x, y, th) from the pose's reference frame
// into the pose's own frame.
Eigen::Matrix3d turned(const Eigen::Matrix3d& information, double th) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r.topLeftCorner<2, 2>() << std::cos(th), -std::sin(th), std::sin(th), std::cos(th);
  return r.transpose() * information * r;
}

// Points of one scan share their errors (the same beam pattern, the same wrong partners), so their
// information is smaller than that of independent measurements.
constexpr double kShared = 0.05;

// [m2] the variance of an unknown value.
constexpr double kNothing = 1e4;

Eigen::Matrix3d matched_information(const Alignment& alignment) {
  return turned(kShared * alignment.information, alignment.pose.th);
}

// Along bare walls the noise of the normals gives two scans some false information: it is removed.
Eigen::Matrix3d without_noise(const Eigen::Matrix3d& information) {
  constexpr double kLeast = 0.01;  // of the information across
  const auto axes = principal_axes(information.topLeftCorner<2, 2>());
  if (axes.eigenvalues()[0] > kLeast * axes.eigenvalues()[1])
    return information;
  Eigen::Matrix3d without = Eigen::Matrix3d::Identity();
  without.topLeftCorner<2, 2>() -=
      axes.eigenvectors().col(0) * axes.eigenvectors().col(0).transpose();
  return without * information * without;
}

bool leaves_open(const Eigen::Matrix3d& information) {
  return principal_axes(information.topLeftCorner<2, 2>()).eigenvalues()[0] < 10.0 / kNothing;
}

Scan thinned(const Scan& scan, std::size_t most) {
  if (scan.points.size() <= most)
    return scan;
  Scan out;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t i = k * scan.points.size() / most;
    out.points.push_back(scan.points[i]);
    out.normals.push_back(scan.normals[i]);
  }
  return out;
}

}  // namespace

ScanReference ScanMapper::reference(const std::vector<std::size_t>& nodes,
                                    std::size_t origin) const {
  ScanReference out;
  for (const std::size_t i : nodes)
    out.add(scans_[i], relative(poses_[origin], poses_[i]));
  out.arrange();
  return out;
}

std::vector<std::size_t> ScanMapper::along_path(std::size_t about, double back,
                                                double ahead) const {
  std::vector<std::size_t> out;
  std::size_t first = about;
  while (first > 0 && path_[about] - path_[first - 1] <= back)
    --first;
  for (std::size_t i = first; i < path_.size() && path_[i] - path_[about] <= ahead; ++i)
    out.push_back(i);
  return out;
}

Scan ScanMapper::stretch(std::size_t node, double back) const {
  Scan out;
  for (const std::size_t i : along_path(node, back, 0.0)) {
    const Pose in_node = relative(poses_[node], poses_[i]);
    const Pose turn{0.0, 0.0, in_node.th};
    for (std::size_t k = 0; k < scans_[i].points.size(); ++k) {
      out.points.push_back(transform(in_node, scans_[i].points[k]));
      out.normals.push_back(transform(turn, scans_[i].normals[k]));
    }
  }
  return out;
}

Eigen::Matrix3d ScanMapper::odom_information(const Pose& step) const {
  const double gone = std::hypot(step.x, step.y);
  const double distance = settings_.odom_distance + settings_.odom_distance_per_metre * gone;
  const double turn = settings_.odom_turn + settings_.odom_turn_per_metre * gone +
                      settings_.odom_turn_per_radian * std::abs(step.th);
  return diagonal(distance, distance, turn);
}

Eigen::Matrix3d ScanMapper::step_covariance(const Pose& step) const {
  const double gone = std::hypot(step.x, step.y) + 0.1 * std::abs(step.th);
  Eigen::Matrix3d out = diagonal_covariance(settings_.drift * std::sqrt(gone),
                                            settings_.drift_turn * std::sqrt(gone));
  const PoseEdge& odometry = odometry_.back();
  if (!odometry.doubtful)  // the scan did not match
    return out + odometry.information.inverse();
  // Along bare walls scans have little information. The part below that of dead reckoning counts
  // with this factor: dead reckoning's own sigmas are cautious.
  constexpr double kPart = 0.25;
  const Eigen::Matrix3d both = (chain_.back().information + odometry.information).inverse();
  out.topLeftCorner<2, 2>() += kPart * both.topLeftCorner<2, 2>();
  return out;
}

Pose ScanMapper::add(const Pose& pose_in_odom, Scan scan) {
  ++report_.scans;
  if (poses_.empty()) {
    poses_.push_back({});
    scans_.push_back(std::move(scan));
    path_.push_back(0.0);
    steps_.push_back(Eigen::Matrix3d::Zero());
    loops_at_.emplace_back();
    last_odom_ = node_odom_ = pose_in_odom;
    hung_.push_back({0, {}});
    return {};
  }
  const std::size_t last = poses_.size() - 1;
  const Pose step = relative(last_odom_, pose_in_odom);
  last_odom_ = pose_in_odom;
  if (std::hypot(step.x, step.y) < 0.002 && std::abs(step.th) < radians(0.2)) {
    // The robot stands: no news, and no drift.
    believed_in_node_ = compose(believed_in_node_, step);
    hung_.push_back({last, believed_in_node_});
    return compose(poses_[last], believed_in_node_);
  }
  const Pose guess = compose(believed_in_node_, step);

  std::vector<std::size_t> near = along_path(last, settings_.local_path, 0.0);
  if (near.size() > settings_.local_nodes)
    near.erase(near.begin(), near.end() - static_cast<std::ptrdiff_t>(settings_.local_nodes));
  const ScanReference local = reference(near, last);
  AlignSettings settings = settings_.align;
  // Dead reckoning has a small weight beside the walls: it matters only along bare walls.
  settings.guess_information = turned(odom_information(step), -guess.th);
  Alignment found = align(local, scan, guess, settings);
  if (found.overlap < settings_.good_overlap) {
    const double gone = std::hypot(step.x, step.y);
    const SearchWindow window{0.15 + 0.3 * gone, radians(25.0) + 0.3 * std::abs(step.th),
                              radians(1.0)};
    const ScanField field(local, 4);
    const Scan few = thinned(scan, 120);
    if (const auto wide = field.search(few, guess, window, field.score(few, found.pose))) {
      settings.guess_information.setZero();
      const Alignment again = align(local, scan, wide->pose, settings);
      if (again.overlap > found.overlap)
        found = again;
    }
  }
  Pose believed = found.pose;
  const bool matched = found.overlap >= settings_.lost_overlap;
  if (!matched) {
    ++report_.unmatched;
    believed = guess;
  }

  if (std::hypot(believed.x, believed.y) < settings_.node_distance &&
      std::abs(believed.th) < settings_.node_turn) {
    believed_in_node_ = believed;
    hung_.push_back({last, believed});
    return compose(poses_[last], believed);
  }
  // A new node.
  const Pose odom_step = relative(node_odom_, pose_in_odom);
  node_odom_ = pose_in_odom;
  if (matched)
    chain_.push_back({last, last + 1, believed, matched_information(found), false});
  odometry_.push_back({last, last + 1, odom_step, odom_information(odom_step), matched});
  const double gone = std::hypot(believed.x, believed.y);
  steps_.push_back(step_covariance(believed));
  loops_at_.emplace_back();
  path_.push_back(path_[last] + gone);
  poses_.push_back(compose(poses_[last], believed));
  scans_.push_back(std::move(scan));
  believed_in_node_ = {};
  hung_.push_back({last + 1, {}});
  if (path_.back() - searched_at_ >= settings_.loop_every) {
    searched_at_ = path_.back();
    close_loops();
  }
  return poses_.back();
}

std::vector<Eigen::Matrix3d> ScanMapper::covariances(std::size_t from,
                                                     const std::vector<std::size_t>& of) const {
  const auto doubt = [](const Eigen::Matrix3d& m) { return m(0, 0) + m(1, 1) + 100.0 * m(2, 2); };
  // In the frame of `from`.
  std::vector<Eigen::Matrix3d> known(poses_.size(), Eigen::Matrix3d::Zero());
  ShortestWays ways(poses_.size());
  ways.reach(from, 0.0);
  std::size_t open = of.size();
  std::vector<char> wanted(poses_.size(), 0);
  for (const std::size_t i : of)
    wanted[i] = 1;
  const double c0 = std::cos(poses_[from].th);
  const double s0 = std::sin(poses_[from].th);
  for (auto next = ways.next(); next && open > 0; next = ways.next()) {
    const std::size_t i = *next;
    if (wanted[i] != 0)
      --open;
    // `step`: its covariance, in the frame of the node `frame`.
    const auto go = [&](std::size_t to, std::size_t frame, const Eigen::Matrix3d& step) {
      if (ways.settled(to))
        return;
      const double dx = poses_[to].x - poses_[i].x;
      const double dy = poses_[to].y - poses_[i].y;
      Eigen::Matrix3d lever = Eigen::Matrix3d::Identity();
      lever(0, 2) = -(-s0 * dx + c0 * dy);
      lever(1, 2) = c0 * dx + s0 * dy;
      const Eigen::Matrix3d covariance =
          lever * known[i] * lever.transpose() + turned(step, poses_[from].th - poses_[frame].th);
      if (ways.reach(to, doubt(covariance), i))
        known[to] = covariance;
    };
    if (i > 0)
      go(i - 1, i, steps_[i]);
    if (i + 1 < poses_.size())
      go(i + 1, i + 1, steps_[i + 1]);
    for (const std::size_t k : loops_at_[i]) {
      const PoseEdge& loop = loops_[k];
      go(loop.from == i ? loop.to : loop.from, loop.to, loop.information.inverse());
    }
  }
  std::vector<Eigen::Matrix3d> out;
  out.reserve(of.size());
  for (const std::size_t i : of)
    out.push_back(known[i]);
  return out;
}

double ScanMapper::through(const Closure& closure) const {
  // Each of the two places is compared with the other's points.
  constexpr double kAbout = 1.0;  // [m] of way
  Sight sum;
  const auto look = [&](std::size_t from, std::size_t at, const Pose& at_in_from) {
    for (const std::size_t i : along_path(at, kAbout, kAbout)) {
      if (i % 2 != at % 2)
        continue;
      const Pose pose = compose(at_in_from, relative(poses_[at], poses_[i]));
      std::vector<Vec2> points;
      points.reserve(scans_[i].points.size());
      for (const Vec2& p : scans_[i].points)
        points.push_back(transform(pose, p));
      const Sight sight = look_at(scans_[from], points);
      sum.agree += sight.agree;
      sum.through += sight.through;
    }
  };
  look(closure.from, closure.to, closure.to_in_from);
  look(closure.to, closure.from, relative(closure.to_in_from, {}));
  return static_cast<double>(sum.through) /
         static_cast<double>(std::max<std::size_t>(1, sum.through + sum.agree));
}

std::optional<ScanMapper::Closure> ScanMapper::find_closure(std::size_t pass, std::size_t here,
                                                            const Eigen::Matrix3d& covariance,
                                                            const Scan& query) const {
  const Eigen::Matrix2d prior = covariance.topLeftCorner<2, 2>();
  const double spread = std::sqrt(principal_axes(prior).eigenvalues().maxCoeff());
  const double reach =
      std::clamp(3.0 * spread + 0.3, settings_.loop_reach, settings_.loop_reach_limit);
  const double turn =
      std::clamp(3.0 * std::sqrt(covariance(2, 2)), settings_.loop_turn, settings_.loop_turn_limit);
  std::vector<std::size_t> old = along_path(pass, 3.0 + reach, 3.0 + reach);
  std::erase_if(old,
                [&](std::size_t i) { return path_[here] - path_[i] < settings_.loop_path - 4.0; });
  const ScanReference there = reference(old, pass);
  const ScanField field(there, 7);
  const Pose guess = relative(poses_[pass], poses_[here]);
  const Scan few = thinned(query, 300);
  const auto wide = field.search(few, guess, {reach, turn, radians(1.0)}, settings_.loop_score);
  if (!wide)
    return std::nullopt;
  AlignSettings settings = settings_.align;
  settings.first_gate = 0.25;
  const Alignment found = align(there, query, wide->pose, settings);
  if (found.overlap < settings_.loop_overlap)
    return std::nullopt;
  Pose pose = found.pose;
  const auto slack = principal_axes(field.slack(few, found.pose, guess.position(),
                                                prior + 0.04 * Eigen::Matrix2d::Identity(), reach));
  Eigen::Matrix2d position = Eigen::Matrix2d::Zero();
  const double free = settings_.loop_slack * settings_.loop_slack;
  if (slack.eigenvalues()[0] > free)
    return std::nullopt;
  for (int k = 0; k < 2; ++k) {
    const Vec2 along = slack.eigenvectors().col(k);
    const bool open = slack.eigenvalues()[k] > free;
    position += (open ? kNothing : slack.eigenvalues()[k]) * along * along.transpose();
    if (!open)
      continue;
    // The direction is not exact: an error of the graph along it shows across.
    constexpr double kDirection = radians(2.0);
    const Vec2 across(-along.y(), along.x());
    position += kDirection * kDirection * along.dot(prior * along) * across * across.transpose();
    // Along a corridor, or among rooms that look alike, one place is as good as the next: the
    // scans' result is applied to the place of the robot by the graph.
    const Vec2 start = pose.position() + along.dot(guess.position() - pose.position()) * along;
    settings.guess_information.topLeftCorner<2, 2>() =
        400.0 * along * along.transpose() / (settings.noise * settings.noise);
    const Alignment again = align(there, query, {start.x(), start.y(), pose.th}, settings);
    if (again.overlap < settings_.loop_overlap)
      return std::nullopt;
    pose = again.pose;
  }
  Closure closure{pass, here, pose, Eigen::Matrix3d::Zero(), 0, false};
  // In the frame of the pass up to here; a closure's covariance is in its own.
  Eigen::Matrix3d doubt =
      (kShared * found.information + 1e-3 * Eigen::Matrix3d::Identity()).inverse();
  doubt.topLeftCorner<2, 2>() += position;
  closure.covariance = turned(doubt, pose.th);
  if (through(closure) > settings_.loop_through)
    return std::nullopt;
  return closure;
}

void ScanMapper::close_loops() {
  const std::size_t here = poses_.size() - 1;
  // The nearest node of each earlier pass.
  std::vector<std::size_t> passes;
  double pass_end = -1e9;
  for (std::size_t i = 0; i < here && path_[here] - path_[i] > settings_.loop_path; ++i) {
    const double away = (poses_[i].position() - poses_[here].position()).norm();
    if (away > settings_.loop_reach_limit)
      continue;
    if (path_[i] - pass_end > 3.0)
      passes.push_back(i);
    else if (away < (poses_[passes.back()].position() - poses_[here].position()).norm())
      passes.back() = i;
    pass_end = path_[i];
  }
  if (passes.empty())
    return;
  const std::vector<Eigen::Matrix3d> known = covariances(here, passes);
  struct Candidate {
    std::size_t pass;
    double away;  // in sigmas, squared
    Eigen::Matrix3d covariance;
  };
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const Pose there = relative(poses_[here], poses_[passes[k]]);
    // The robot's place, seen from there: the same uncertainty with the lever between them.
    Eigen::Matrix3d lever = Eigen::Matrix3d::Identity();
    lever(0, 2) = there.y;
    lever(1, 2) = -there.x;
    Eigen::Matrix3d covariance = turned(lever * known[k] * lever.transpose(), there.th);
    covariance += 1e-4 * Eigen::Matrix3d::Identity();
    const Eigen::Matrix2d seen =
        covariance.topLeftCorner<2, 2>() + 0.5 * Eigen::Matrix2d::Identity();
    const Vec2 off = relative(poses_[passes[k]], poses_[here]).position();
    const double away = off.dot(seen.inverse() * off);
    if (away < 16.0)
      candidates.push_back({passes[k], away, covariance});
  }
  // The nearest ones are enough: they are connected already.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.away < b.away; });
  if (candidates.size() > 3)
    candidates.erase(candidates.begin() + 3, candidates.end());
  if (candidates.empty())
    return;
  const Scan query = stretch(here, 2.0);
  if (query.points.size() < settings_.loop_points)
    return;
  std::vector<Closure> agreed;
  for (const Candidate& candidate : candidates) {
    auto closure = find_closure(candidate.pass, here, candidate.covariance, query);
    if (!closure)
      continue;
    // Within the graph's uncertainty.
    const Pose off = relative(closure->to_in_from, relative(poses_[closure->from], poses_[here]));
    const Eigen::Vector3d e(off.x, off.y, off.th);
    const Eigen::Matrix3d expected =
        turned(candidate.covariance, closure->to_in_from.th) + closure->covariance;
    if (e.dot(expected.inverse() * e) > 16.0)
      continue;
    // Two agreeing ones, from different places, are accepted; a single one may be a look-alike.
    for (Closure& other : pending_) {
      const double apart = path_[here] - path_[other.to];
      if (apart > 8.0 || apart < 0.3)
        continue;
      const Pose by_other =
          compose(compose(relative(poses_[closure->from], poses_[other.from]), other.to_in_from),
                  relative(poses_[other.to], poses_[here]));
      const Pose between = relative(closure->to_in_from, by_other);
      const Eigen::Vector3d d(between.x, between.y, between.th);
      Eigen::Matrix3d doubt = closure->covariance +
                              turned(other.covariance, relative(poses_[other.to], poses_[here]).th);
      doubt.diagonal() += Eigen::Vector3d(0.01, 0.01, radians(1.0) * radians(1.0));
      if (d.dot(doubt.inverse() * d) > settings_.loop_agree_chi2)
        continue;
      ++closure->agreeing;
      ++other.agreeing;
      if (!other.accepted) {
        other.accepted = true;
        agreed.push_back(other);
      }
    }
    if (closure->agreeing > 0) {
      closure->accepted = true;
      agreed.push_back(*closure);
    }
    pending_.push_back(*closure);
  }
  std::erase_if(pending_, [&](const Closure& c) { return path_[here] - path_[c.to] > 8.0; });
  if (!agreed.empty())
    accept(agreed);
}

void ScanMapper::accept(const std::vector<Closure>& closures) {
  bool news = false;
  for (const Closure& closure : closures) {
    loops_at_[closure.from].push_back(loops_.size());
    loops_at_[closure.to].push_back(loops_.size());
    loops_.push_back(
        {closure.from, closure.to, closure.to_in_from, closure.covariance.inverse(), true});
    ++report_.loops;
    // A closure without news does not change the graph.
    news = news || chi2(loops_.back(), poses_) > 1.0;
  }
  if (news)
    optimize(poses_, all_edges(), 15, 10.0);
}

std::vector<PoseEdge> ScanMapper::all_edges() const {
  std::vector<PoseEdge> edges = chain_;
  edges.insert(edges.end(), odometry_.begin(), odometry_.end());
  edges.insert(edges.end(), loops_.begin(), loops_.end());
  return edges;
}

void ScanMapper::refine(int rounds) {
  if (poses_.size() < 3)
    return;
  optimize(poses_, all_edges(), 30, 10.0);
  for (int round = 0; round < rounds; ++round) {
    std::vector<PoseEdge> edges;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      // The nodes before, and the nearest of each other pass in the same direction.
      std::vector<std::size_t> partners;
      for (std::size_t back = 1; back <= 3 && back <= i; ++back)
        partners.push_back(i - back);
      std::vector<std::size_t> passes;
      double pass_end = -1e9;
      const auto rate = [&](std::size_t j) {
        const Pose off = relative(poses_[i], poses_[j]);
        return std::hypot(off.x, off.y) + std::abs(off.th);
      };
      for (std::size_t j = 0; j + 4 < i && path_[i] - path_[j] > 1.0; ++j) {
        const Pose off = relative(poses_[i], poses_[j]);
        if (std::hypot(off.x, off.y) > 2.0 || std::abs(off.th) > radians(70.0))
          continue;
        if (path_[j] - pass_end > 1.0)
          passes.push_back(j);
        else if (rate(j) < rate(passes.back()))
          passes.back() = j;
        pass_end = path_[j];
      }
      std::stable_sort(passes.begin(), passes.end(),
                       [&](std::size_t a, std::size_t b) { return rate(a) < rate(b); });
      if (passes.size() > 6)
        passes.resize(6);
      partners.insert(partners.end(), passes.begin(), passes.end());
      for (const std::size_t j : partners) {
        ScanReference there;
        there.add(scans_[j], {});
        there.arrange();
        AlignSettings settings = settings_.align;
        settings.first_gate = round == 0 ? 0.3 : 0.15;
        settings.last_gate = round == 0 ? 0.12 : 0.1;
        const Alignment found = align(there, scans_[i], relative(poses_[j], poses_[i]), settings);
        if (found.overlap < 0.4)
          continue;
        edges.push_back({j, i, found.pose, without_noise(matched_information(found)), true});
      }
    }
    edges.insert(edges.end(), chain_.begin(), chain_.end());
    edges.insert(edges.end(), odometry_.begin(), odometry_.end());
    // Closures with an open direction have no more information than the pairs here, and less
    // accuracy.
    std::copy_if(loops_.begin(), loops_.end(), std::back_inserter(edges),
                 [](const PoseEdge& e) { return !leaves_open(e.information); });
    optimize(poses_, edges, 30, 5.0);
  }
}

std::vector<Pose> ScanMapper::trajectory() const {
  std::vector<Pose> out;
  out.reserve(hung_.size());
  for (const Hung& h : hung_)
    out.push_back(compose(poses_[h.node], h.in_node));
  return out;
}

}  // namespace saphira::logs
