#include "saphira/registration/map_builder.hpp"

#include <algorithm>
#include <cmath>

#include "built_corridors.hpp"
#include "saphira/lps/point.hpp"
#include "saphira/maps/topology.hpp"
#include "stretches.hpp"

namespace saphira::registration {

namespace {

using lps::PointType;
using maps::Feature;

// How many nodes back a percept may be attached.
constexpr std::size_t kRecent = 24;
// The map is rebuilt after this way [m], if there is news.
constexpr double kSettle = 1.0;
// Echoes from ahead that mark the end of a corridor: range and angle.
constexpr double kAhead = 1.8;
constexpr double kStraight = radians(10.0);
// Of a doorway that the robot drove through: the limits of its width, and the widest gap in the
// wall beside the end of a corridor that has one [m].
constexpr double kNarrowest = 0.6;
constexpr double kWidest = 1.2;
constexpr double kWidestGap = 2.0;
// Of a wall where none follows the grid [m]: places without corridors have furniture.
constexpr double kShortWall = 0.7;
constexpr double kSameWall = 0.3;
// Single echoes of known walls there: largest distance and angle of the sonar to its normal, and
// from the wall; one sigma.
constexpr double kHeard = 3.5;
constexpr double kFacing = radians(12.0);
constexpr double kHeardOff = 0.3;
constexpr double kHeardSigma = 0.08;
constexpr double kAnyHeading = 0.3;  // [rad] of the start, where the grid defines it

double off_grid(double heading) {
  return std::abs(heading - std::round(heading / (kPi / 2)) * (kPi / 2));
}

}  // namespace

MapBuilder::MapBuilder(MapBuilderSettings settings, maps::Map known, Pose start_in_map)
    : settings_(std::move(settings)),
      given_(known),
      editor_(std::move(known)),
      start_in_map_(start_in_map),
      pose_in_map_(start_in_map) {
  graph_.settings = settings_.graph;
  // The grid defines the map's orientation.
  if (settings_.snap_to_right_angle_grid && given_.features.empty())
    graph_.settings.start_heading = kAnyHeading;
}

void MapBuilder::snap(bool on) {
  settings_.snap_to_right_angle_grid = on;
  settings_.min_wall = on ? MapBuilderSettings{}.min_wall : kShortWall;
  settings_.same_wall = on ? MapBuilderSettings{}.same_wall : kSameWall;
  graph_.settings.start_heading = on ? kAnyHeading : FeatureGraphSettings{}.start_heading;
  news_ = true;
}

bool MapBuilder::step(const MapBuilderInputs& inputs) {
  drive(inputs);
  for (const lps::Percept& percept : inputs.percepts)
    if (percept.confidence >= settings_.least_confidence)
      news_ = take(percept, inputs.cycle) || news_;
  listen_ahead(inputs);
  if (!settings_.snap_to_right_angle_grid)
    hear_walls(inputs);
  pass();
  for (auto it = taken_.begin(); it != taken_.end();)
    it = it->second.cycle == inputs.cycle ? std::next(it) : taken_.erase(it);
  if (!news_ || way_ - settled_way_ < kSettle)
    return false;
  settle();
  return publish();
}

// Follows the robot, and adds nodes on its way.
void MapBuilder::drive(const MapBuilderInputs& inputs) {
  const bool jumped = placed_ && inputs.odom != odom_;
  if (placed_ && !jumped)
    way_ += (inputs.pose_in_odom.position() - pose_in_odom_.position()).norm();
  pose_in_odom_ = inputs.pose_in_odom;
  odom_ = inputs.odom;
  believed_ = inputs.pose_in_map.has_value();
  if (believed_)
    pose_in_map_ = *inputs.pose_in_map;
  else if (!placed_)
    pose_in_map_ = start_in_map_;
  else if (!jumped)
    pose_in_map_ =
        compose(graph_.nodes.back().in_map, relative(graph_.nodes.back().in_odom, pose_in_odom_));
  if (jumped)
    taken_.clear();
  if (placed_ && !jumped) {
    const Pose since = relative(graph_.nodes.back().in_odom, pose_in_odom_);
    if (std::hypot(since.x, since.y) < settings_.node_way &&
        std::abs(since.th) < settings_.node_turn)
      return;
  }
  if (believed_) {
    // As certain as a tracking registration.
    covariance_ = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  } else if (jumped) {
    covariance_ = Eigen::Vector3d(0.25, 0.25, 0.1).asDiagonal();
  } else if (placed_) {
    const GraphNode& last = graph_.nodes.back();
    const Vec2 way = pose_in_map_.position() - last.in_map.position();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn(0, 2) = -way.y();
    turn(1, 2) = way.x();
    covariance_ = turn * covariance_ * turn.transpose() +
                  graph_.way_covariance(relative(last.in_odom, pose_in_odom_));
  }
  graph_.nodes.push_back({pose_in_odom_, pose_in_map_, believed_, jumped});
  placed_ = true;
}

std::size_t MapBuilder::node_near(const Pose& in_odom) const {
  std::size_t best = graph_.nodes.size() - 1;
  double nearest = lps::distance(graph_.nodes[best].in_odom, in_odom);
  for (std::size_t back = 1; back < std::min(kRecent, graph_.nodes.size()); ++back) {
    const std::size_t i = graph_.nodes.size() - 1 - back;
    if (graph_.nodes[i + 1].broken)
      break;
    const double far = lps::distance(graph_.nodes[i].in_odom, in_odom);
    if (far < nearest) {
      nearest = far;
      best = i;
    }
  }
  return best;
}

SeenLine MapBuilder::seen_line(const lps::Percept& percept) const {
  SeenLine seen{.node = node_near(percept.pose_in_odom)};
  Pose wall = percept.pose_in_odom;
  const Pose& from = graph_.nodes[seen.node].in_odom;
  const bool right_of_it =
      percept.side == lps::Side::none ? lps::yo(wall, from) < 0.0 : percept.side == lps::Side::left;
  if (right_of_it)
    wall.th = norm2_angle(wall.th + kPi);
  seen.in_node = relative(from, wall);
  seen.length = percept.length;
  seen.sigma_across = std::max(0.02, percept.sigma_across);
  seen.sigma_heading = std::max(radians(0.5), percept.sigma_heading);
  return seen;
}

SeenPoint MapBuilder::seen_point(const lps::Percept& percept) const {
  SeenPoint seen;
  seen.node = node_near(percept.pose_in_odom);
  seen.in_node = relative(graph_.nodes[seen.node].in_odom, percept.pose_in_odom);
  seen.width = percept.width;
  seen.sigma_along = std::max(0.04, percept.sigma_along);
  seen.sigma_across = std::max(0.04, percept.sigma_across);
  return seen;
}

double MapBuilder::stray(const Vec2& direction) const {
  const double variance = direction.dot(covariance_.topLeftCorner<2, 2>() * direction);
  return std::min(settings_.most_stray, 3.0 * std::sqrt(std::max(0.0, variance)));
}

double MapBuilder::stray_heading() const {
  return std::min(settings_.most_heading - settings_.same_heading,
                  3.0 * std::sqrt(covariance_(2, 2)));
}

Stretches MapBuilder::stretches(const GraphLine& line) const {
  return seen_along({line.anchor.x(), line.anchor.y(), line.heading}, graph_, line);
}

std::optional<std::size_t> MapBuilder::match_line(const SeenLine& seen) const {
  const Pose wall = compose(graph_.nodes[seen.node].in_map, seen.in_node);
  std::optional<std::size_t> best;
  double nearest = 0.0;
  for (std::size_t i = 0; i < graph_.lines.size(); ++i) {
    const GraphLine& line = graph_.lines[i];
    if (line.seen.empty())
      continue;  // it has become part of another one
    const double turned = std::abs(norm2_angle(wall.th - line.heading));
    const double most_turned = settings_.same_heading + stray_heading();
    if (turned > most_turned)
      continue;
    const Vec2 from = wall.position() - line.anchor;
    const double across = std::abs(line.normal().dot(from) - line.offset);
    const double most_across = settings_.same_wall + stray(line.normal());
    if (across > most_across)
      continue;
    const double at = line.along().dot(from);
    double gap = 1e9;
    for (const auto& s : stretches(line))
      gap = std::min(gap, std::max(s.first - at, at - s.second) - seen.length / 2);
    if (gap > settings_.wall_gap)
      continue;
    // A stretch farther along the line must fit better.
    const double cost = across / most_across + turned / most_turned + 0.1 * std::max(0.0, gap);
    if (!best || cost < nearest) {
      best = i;
      nearest = cost;
    }
  }
  return best;
}

MapBuilder::Match MapBuilder::match_opening(const SeenPoint& seen, PointType type) const {
  const Pose opening = compose(graph_.nodes[seen.node].in_map, seen.in_node);
  Match best;
  double nearest = 1e9;
  double second = 1e9;
  double nearest_stray = 0.0;
  for (std::size_t i = 0; i < graph_.points.size(); ++i) {
    const Known& known = known_points_[i];
    if (graph_.points[i].seen.empty() || known.type != type ||
        std::abs(norm2_angle(opening.th - known.heading)) >
            2 * settings_.same_heading + stray_heading())
      continue;
    const Vec2 off = opening.position() - graph_.points[i].in_map;
    const double far = off.norm();
    const Vec2 direction = far > 0.0 ? Vec2(off / far) : Vec2(1.0, 0.0);
    const double may_stray = stray(direction);
    if (far >= settings_.same_opening + may_stray)
      continue;
    if (far < nearest) {
      second = nearest;
      nearest = far;
      nearest_stray = may_stray;
      best.index = i;
    } else {
      second = std::min(second, far);
    }
  }
  best.is_ambiguous = second - nearest < nearest_stray;
  return best;
}

bool MapBuilder::take_line(const lps::Percept& percept, std::uint64_t cycle) {
  const SeenLine seen = seen_line(percept);
  const auto known = taken_.find(percept.id);
  if (known != taken_.end()) {
    Taken& taken = known->second;
    GraphLine& line = graph_.lines[taken.index];
    taken.cycle = cycle;
    known_lines_[taken.index].last_way = way_;
    // The aperture moves on with the robot: after a while the same wall is seen from another place.
    if (way_ - taken.way < settings_.again_way) {
      line.seen[taken.seen] = seen;
      return false;
    }
    taken.way = way_;
    taken.seen = line.seen.size();
    line.seen.push_back(seen);
    return true;
  }
  auto index = match_line(seen);
  if (index && way_ - known_lines_[*index].last_way > settings_.closure_way)
    ++closures_;
  if (!index) {
    const Pose wall = compose(graph_.nodes[seen.node].in_map, seen.in_node);
    index = graph_.lines.size();
    graph_.lines.push_back({wall.position(), wall.th, 0.0, {}, false});
    known_lines_.emplace_back();
  }
  GraphLine& line = graph_.lines[*index];
  taken_[percept.id] = {true, *index, line.seen.size(), way_, cycle};
  line.seen.push_back(seen);
  known_lines_[*index].last_way = way_;
  return true;
}

bool MapBuilder::take_opening(const lps::Percept& percept, std::uint64_t cycle) {
  const SeenPoint seen = seen_point(percept);
  const auto known = taken_.find(percept.id);
  if (known != taken_.end()) {
    Taken& taken = known->second;
    taken.cycle = cycle;
    known_points_[taken.index].last_way = way_;
    known_points_[taken.index].found = true;
    known_points_[taken.index].only_driven = false;
    graph_.points[taken.index].seen[taken.seen] = seen;
    return false;
  }
  const Match match = match_opening(seen, percept.type);
  if (match.is_ambiguous)
    return false;  // the pose may improve in a while
  auto index = match.index;
  if (index && way_ - known_points_[*index].last_way > settings_.closure_way)
    ++closures_;
  if (!index) {
    const Pose opening = compose(graph_.nodes[seen.node].in_map, seen.in_node);
    index = graph_.points.size();
    graph_.points.push_back({opening.position(), {}});
    known_points_.push_back({.type = percept.type, .heading = opening.th});
  }
  GraphPoint& point = graph_.points[*index];
  taken_[percept.id] = {false, *index, point.seen.size(), way_, cycle};
  point.seen.push_back(seen);
  known_points_[*index].last_way = way_;
  known_points_[*index].found = true;
  return true;
}

bool MapBuilder::take(const lps::Percept& percept, std::uint64_t cycle) {
  switch (percept.type) {
    case PointType::wall:
      return take_line(percept, cycle);
    case PointType::door:
    case PointType::junction:
      return take_opening(percept, cycle);
    default:
      return false;  // ends of openings and corridors: their parts are here already
  }
}

// Without corridors, walls are seldom beside the robot for long: single echoes of known walls
// correct the way between, once for each place and wall.
void MapBuilder::hear_walls(const MapBuilderInputs& inputs) {
  const std::size_t node = graph_.nodes.size() - 1;
  for (const lps::SonarReading& reading : inputs.readings) {
    if (!reading.echo || reading.range > kHeard)
      continue;
    for (const lps::SonarMount& mount : settings_.sonars) {
      if (mount.sonar != reading.sonar)
        continue;
      const Pose sonar = compose(pose_in_map_, mount.in_robot);
      GraphLine* heard = nullptr;
      double nearest = kHeardOff;
      for (GraphLine& line : graph_.lines) {
        if (line.seen.empty() || line.seen.back().node == node ||
            -line.normal().dot(sonar.direction()) < std::cos(kFacing))
          continue;
        const Vec2 at = sonar.position() - reading.range * line.normal() - line.anchor;
        const double off = std::abs(line.normal().dot(at) - line.offset);
        const double along = line.along().dot(at);
        if (off >= nearest)
          continue;
        const Stretches seen = stretches(line);
        if (std::any_of(seen.begin(), seen.end(),
                        [&](const auto& s) { return along > s.first && along < s.second; })) {
          heard = &line;
          nearest = off;
        }
      }
      if (heard == nullptr)
        continue;
      const Vec2 at = sonar.position() - reading.range * heard->normal();
      heard->seen.push_back(
          {.node = node,
           .in_node = relative(graph_.nodes[node].in_map, {at.x(), at.y(), heard->heading}),
           .sigma_across = kHeardSigma,
           .sigma_heading = kPi});
      news_ = true;
    }
  }
}

// An echo straight ahead may be the end of a corridor.
void MapBuilder::listen_ahead(const MapBuilderInputs& inputs) {
  for (const lps::SonarReading& reading : inputs.readings) {
    if (!reading.echo || reading.range > kAhead)
      continue;
    for (const lps::SonarMount& mount : settings_.sonars) {
      if (mount.sonar != reading.sonar || std::abs(norm2_angle(mount.in_robot.th)) > kStraight)
        continue;
      const Vec2 echo = transform(mount.in_robot, {reading.range, 0.0});
      SeenPoint seen{.node = graph_.nodes.size() - 1};
      const Pose in_node = relative(graph_.nodes.back().in_odom, pose_in_odom_);
      const Vec2 at = transform(in_node, echo);
      seen.in_node = {at.x(), at.y(), in_node.th};
      ahead_.push_back(seen);
    }
  }
}

// Checks the doors that the robot passes: counted when it has gone on.
void MapBuilder::pass() {
  for (std::size_t i = 0; i < known_points_.size(); ++i) {
    Known& known = known_points_[i];
    if (known.only_driven)
      continue;
    const Vec2 at =
        to_frame({graph_.points[i].in_map.x(), graph_.points[i].in_map.y(), known.heading},
                 pose_in_map_.position());
    const bool abeam = at.x() > 0.3 && at.x() < 2.5 && std::abs(at.y()) < 0.3;
    if (abeam)
      known.beside = true;
    if (!known.beside || std::abs(at.y()) < 3.0)
      continue;
    if (known.found) {
      ++known.passes.seen;
      known.passes.missed = 0;
    } else {
      ++known.passes.missed;
      news_ = true;
    }
    known.beside = false;
    known.found = false;
  }
}

std::vector<std::uint32_t> MapBuilder::closed() const {
  std::vector<std::uint32_t> out;
  for (const auto& [id, point] : door_of_)
    if (known_points_[point].passes.missed >= 2)
      out.push_back(id);
  return out;
}

bool MapBuilder::remove(std::uint32_t id) {
  const Feature* const feature = maps::find(editor_.map(), id);
  if (feature == nullptr)
    return false;
  const Feature gone = *feature;
  const auto forget = [this](bool is_line, std::size_t index) {
    std::erase_if(taken_, [&](const auto& each) {
      return each.second.is_line == is_line && each.second.index == index;
    });
  };
  if (const auto door = door_of_.find(id); door != door_of_.end()) {
    graph_.points[door->second].seen.clear();
    forget(false, door->second);
    door_of_.erase(door);
  } else if (const auto wall = wall_of_.find(id); wall != wall_of_.end()) {
    // The rest of its line stays.
    std::erase_if(graph_.lines[wall->second].seen, [&](const SeenLine& seen) {
      const Pose at = compose(graph_.nodes[seen.node].in_map, seen.in_node);
      return std::abs(to_frame(gone.pose_in_map, at.position()).x()) < gone.length / 2;
    });
    forget(true, wall->second);
    wall_of_.erase(wall);
  }
  std::erase(own_, id);
  std::erase_if(given_.features, [id](const Feature& each) { return each.id == id; });
  return editor_.remove(id);
}

void MapBuilder::settle() {
  news_ = false;
  settled_way_ = way_;
  for (GraphLine& line : graph_.lines)
    line.on_grid = settings_.snap_to_right_angle_grid && !line.seen.empty() &&
                   off_grid(line.heading) < settings_.grid_tolerance &&
                   total(stretches(line)) > settings_.min_wall;
  graph_.optimize();
  if (!believed_)
    covariance_ = graph_.covariance;
  merge_lines();
  if (!believed_)
    pose_in_map_ =
        compose(graph_.nodes.back().in_map, relative(graph_.nodes.back().in_odom, pose_in_odom_));
}

// Merges two lines that have come to lie on one another.
void MapBuilder::merge_lines() {
  for (std::size_t a = 0; a < graph_.lines.size(); ++a)
    for (std::size_t b = a + 1; b < graph_.lines.size(); ++b) {
      GraphLine& first = graph_.lines[a];
      GraphLine& second = graph_.lines[b];
      if (first.seen.empty() || second.seen.empty() ||
          std::abs(norm2_angle(first.heading - second.heading)) > radians(3.0))
        continue;
      const auto parts = stretches(second);
      const double at = (parts.front().first + parts.back().second) / 2;
      const Vec2 middle = second.anchor + second.offset * second.normal() + at * second.along();
      const Vec2 from = middle - first.anchor;
      if (std::abs(first.normal().dot(from) - first.offset) > settings_.same_wall / 2)
        continue;
      const double half = (parts.back().second - parts.front().first) / 2;
      const double along = first.along().dot(from);
      double gap = 1e9;
      for (const auto& s : stretches(first))
        gap = std::min(gap, std::max(s.first - along, along - s.second) - half);
      if (gap > settings_.wall_gap)
        continue;
      const std::size_t moved = first.seen.size();
      first.seen.insert(first.seen.end(), second.seen.begin(), second.seen.end());
      second.seen.clear();
      known_lines_[a].last_way = std::max(known_lines_[a].last_way, known_lines_[b].last_way);
      for (auto& [id, taken] : taken_)
        if (taken.is_line && taken.index == b) {
          taken.index = a;
          taken.seen += moved;
        }
    }
}

/// The stretches of wall along one side of a corridor, in its frame.
Stretches MapBuilder::side_of(const Feature& hall, double side) const {
  return seen_along(hall.pose_in_map, graph_, graph_.lines, [&](const Pose& in) {
    return std::abs(side * in.y - hall.width / 2) < 2 * settings_.same_wall &&
           std::abs(norm3_angle(in.th)) < 2 * settings_.same_heading;
  });
}

/// A gap in a corridor's wall that the robot drove through at `x`. Beside the corridor's end it has
/// only one edge: the robot's way is its middle.
std::optional<MapBuilder::Doorway> MapBuilder::doorway(const Feature& hall, double side,
                                                       double x) const {
  double from = -hall.length / 2;
  double to = hall.length / 2;
  bool has_from = false;
  bool has_to = false;
  for (const auto& s : side_of(hall, side)) {
    if (s.first < x && s.second > x)
      return std::nullopt;
    if (s.second <= x) {
      from = std::max(from, s.second);
      has_from = true;
    } else if (!has_to) {
      to = std::min(to, s.first);
      has_to = true;
    }
  }
  if (!has_from && !has_to)
    return std::nullopt;
  Doorway found{(from + to) / 2, to - from};
  if (!has_from || !has_to)
    found = {x, 2.0 * (has_from ? x - from : to - x)};
  if (to - from > kWidestGap || found.width < kNarrowest || found.width > kWidest)
    return std::nullopt;
  return found;
}

// A doorway beside the end of a corridor has a wall on one side only, and is no percept. The robot
// that drove through knows it.
void MapBuilder::note_doorways(const std::vector<Feature>& halls) {
  for (std::size_t i = 1; i < graph_.nodes.size(); ++i) {
    if (graph_.nodes[i].broken || driven_through_.contains(i))
      continue;
    for (const Feature& hall : halls) {
      const Vec2 before = to_frame(hall.pose_in_map, graph_.nodes[i - 1].in_map.position());
      const Vec2 after = to_frame(hall.pose_in_map, graph_.nodes[i].in_map.position());
      const double side = before.y() + after.y() > 0.0 ? 1.0 : -1.0;
      const double outside_before = side * before.y() - hall.width / 2;
      const double outside_after = side * after.y() - hall.width / 2;
      if ((outside_before < 0.0) == (outside_after < 0.0))
        continue;
      const double x =
          before.x() + (after.x() - before.x()) * outside_before / (outside_before - outside_after);
      if (std::abs(x) > hall.length / 2)
        continue;
      const auto found = doorway(hall, side, x);
      if (!found)
        continue;
      driven_through_.insert(i);
      const Vec2 at = transform(hall.pose_in_map, {found->middle, side * hall.width / 2});
      const Pose pose{at.x(), at.y(), norm2_angle(hall.pose_in_map.th - side * kPi / 2)};
      const Vec2 behind = transform(pose, {-1.0, 0.0});
      const bool known =
          std::any_of(graph_.points.begin(), graph_.points.end(),
                      [&](const GraphPoint& point) {
                        return !point.seen.empty() && (point.in_map - at).norm() < kWidest / 2;
                      }) ||
          std::any_of(halls.begin(), halls.end(),
                      [&](const Feature& other) { return maps::contains(other, behind); });
      if (known)
        continue;
      const Pose in_node = relative(graph_.nodes[i].in_map, pose);
      graph_.points.push_back({at, {{i, in_node, found->width, 0.1, 0.1}}});
      known_points_.push_back({.type = PointType::door, .heading = pose.th, .only_driven = true});
    }
  }
}

// Makes the map from the graph. Rebuilt artifacts keep their ids.
bool MapBuilder::publish() {
  std::vector<Feature> fresh;
  std::vector<std::optional<std::size_t>> sources;  // line of a wall, point of an opening
  const auto add = [&](Feature feature, std::optional<std::size_t> source = std::nullopt) {
    if (maps::problem(feature))
      return;
    feature.learned = true;
    const bool given = std::any_of(given_.features.begin(), given_.features.end(),
                                   [&](const Feature& f) { return maps::same(f, feature); });
    if (given)
      return;
    fresh.push_back(std::move(feature));
    sources.push_back(source);
  };

  const std::vector<BuiltCorridor> found = find_corridors(graph_, ahead_, settings_);
  std::vector<Feature> halls;
  for (const Feature& feature : given_.features)
    if (feature.type == PointType::corridor)
      halls.push_back(feature);
  for (const BuiltCorridor& corridor : found) {
    Feature feature;
    feature.type = PointType::corridor;
    const Vec2 middle = (corridor.begin() + corridor.end()) / 2;
    feature.pose_in_map = {middle.x(), middle.y(), corridor.frame.th};
    feature.length = corridor.length();
    feature.width = corridor.width;
    halls.push_back(feature);
    add(feature);
  }
  // Their junctions: the graph of the halls so far knows where corridors meet.
  maps::Map halls_only;
  for (Feature hall : halls) {
    hall.id = static_cast<std::uint32_t>(halls_only.features.size() + 1);
    halls_only.features.push_back(hall);
  }
  std::vector<Feature> junctions;
  const maps::Topology topology(halls_only);
  for (const maps::Region& region : topology.regions())
    if (region.kind == maps::RegionKind::junction) {
      junctions.push_back(region.area);
      add(region.area);
    }
  note_doorways(halls);
  for (std::size_t i = 0; i < graph_.points.size(); ++i) {
    const GraphPoint& point = graph_.points[i];
    if (point.seen.empty())
      continue;
    Feature feature;
    feature.type = known_points_[i].type == PointType::door ? PointType::door : PointType::breach;
    feature.pose_in_map = {point.in_map.x(), point.in_map.y(), known_points_[i].heading};
    for (const SeenPoint& seen : point.seen)
      feature.width += seen.width / static_cast<double>(point.seen.size());
    // In the wall of its corridor, at a right angle to it.
    for (const Feature& hall : halls) {
      const Pose in = relative(hall.pose_in_map, feature.pose_in_map);
      const double side = in.y > 0.0 ? 1.0 : -1.0;
      if (std::abs(in.x) > hall.length / 2 || std::abs(side * in.y - hall.width / 2) > 0.4 ||
          std::abs(norm2_angle(in.th + side * kPi / 2)) > 2 * settings_.same_heading)
        continue;
      const Vec2 at = transform(hall.pose_in_map, {in.x, side * hall.width / 2});
      feature.pose_in_map = {at.x(), at.y(), norm2_angle(hall.pose_in_map.th - side * kPi / 2)};
      break;
    }
    const bool of_a_junction =
        std::any_of(junctions.begin(), junctions.end(), [&](const Feature& junction) {
          return maps::distance_to(junction, feature.pose_in_map.position()) < 0.5;
        });
    const Vec2 behind = transform(feature.pose_in_map, {-1.0, 0.0});
    const bool of_a_corridor = std::any_of(halls.begin(), halls.end(), [&](const Feature& hall) {
      return maps::contains(hall, behind) &&
             std::abs(norm3_angle(hall.pose_in_map.th - feature.pose_in_map.th)) < radians(30.0);
    });
    if (of_a_junction && (feature.type == PointType::breach || of_a_corridor))
      continue;  // another corridor is behind it
    add(feature, i);
  }
  // Walls where a corridor is not appropriate (manual 6.9.1).
  for (std::size_t i = 0; i < graph_.lines.size(); ++i) {
    const GraphLine& line = graph_.lines[i];
    if (line.seen.empty())
      continue;
    for (const auto& s : stretches(line)) {
      Feature wall;
      wall.type = PointType::wall;
      wall.length = s.second - s.first;
      const Vec2 middle =
          line.anchor + line.offset * line.normal() + (s.first + s.second) / 2 * line.along();
      wall.pose_in_map = {middle.x(), middle.y(), line.heading};
      const bool of_a_hall = std::any_of(halls.begin(), halls.end(), [&](const Feature& hall) {
        return maps::distance_to(hall, middle) < 0.4;
      });
      if (wall.length >= settings_.min_wall && !of_a_hall)
        add(wall, i);
    }
  }

  const std::uint64_t before = editor_.revision();
  std::vector<std::uint32_t> old = own_;
  own_.clear();
  door_of_.clear();
  wall_of_.clear();
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    std::size_t match = old.size();
    double nearest = 0.0;
    for (std::size_t k = 0; k < old.size(); ++k) {
      const Feature* feature = maps::find(editor_.map(), old[k]);
      if (feature == nullptr || !maps::same(*feature, fresh[i], {1.0, radians(15.0)}))
        continue;
      const double far = lps::distance(feature->pose_in_map, fresh[i].pose_in_map);
      if (match == old.size() || far < nearest) {
        match = k;
        nearest = far;
      }
    }
    std::uint32_t id = 0;
    if (match < old.size()) {
      id = old[match];
      old.erase(old.begin() + static_cast<std::ptrdiff_t>(match));
      editor_.change(id, fresh[i]);
    } else {
      id = editor_.add(fresh[i]);
    }
    own_.push_back(id);
    if (sources[i])
      (fresh[i].type == PointType::wall ? wall_of_ : door_of_)[id] = *sources[i];
  }
  for (const std::uint32_t id : old)
    editor_.remove(id);
  return editor_.revision() != before;
}

}  // namespace saphira::registration
