#include "saphira/interpretation/interpretation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace saphira::interpretation {
namespace {

using lps::Percept;
using lps::PointType;
using lps::Side;

double square(double x) {
  return x * x;
}

void add_readings(const std::vector<const Return*>& firings, Percept& percept) {
  for (const Return* firing : firings) {
    percept.readings.push_back(firing->id);
    percept.seen = std::max(percept.seen, firing->id.cycle);
  }
}

/// The echoes of a stretch that count for one of its ends [m].
constexpr double kWitness = 0.8;

void add_witnesses(const Line& line, const Stretch& stretch, bool upper, Percept& percept) {
  const double end = upper ? stretch.to.u : stretch.from.u;
  for (const Return* firing : stretch.echoes)
    if (std::abs(line.u(firing->sonar) - end) < kWitness)
      add_readings({firing}, percept);
}

double angle_between(double a, double b) {
  return std::abs(norm2_angle(a - b));
}

// The distance of two percepts that may be the same object; none where they are not.
std::optional<double> apart(const Percept& a, const Percept& b) {
  if (a.type != b.type || a.side != b.side)
    return std::nullopt;
  const double way = (a.pose_in_odom.position() - b.pose_in_odom.position()).norm();
  if (a.type == PointType::wall || a.type == PointType::corridor) {
    const Pose from = relative(a.pose_in_odom, b.pose_in_odom);
    const double turn = std::min(std::abs(from.th), kPi - std::abs(from.th));
    if (turn > radians(15.0) || std::abs(from.y) > 0.3 ||
        std::abs(from.x) > (a.length + b.length) / 2.0)
      return std::nullopt;
    return way;
  }
  if (way > 0.45 || angle_between(a.pose_in_odom.th, b.pose_in_odom.th) > radians(30.0))
    return std::nullopt;
  return way;
}

}  // namespace

Tasks::Tasks(ProcessTable& table)
    : grid_(&table.add("occgrid", "puts sonar readings into the occupancy grid")),
      sides_(&table.add("side-segment", "joins echoes of the side sonars to segments")),
      walls_(&table.add("test-wall", "finds walls")),
      breaks_(&table.add("test-wall-break", "finds the ends of walls, doors and junctions")),
      corridors_(&table.add("corridor", "finds corridors")) {}

Interpretation::Interpretation(Settings settings, const Tasks* tasks)
    : settings_(std::move(settings)),
      tasks_(tasks),
      grid_(settings_.grid),
      sides_{SideView(settings_.side), SideView(settings_.side)} {}

void Interpretation::reset() {
  placed_ = false;
  travelled_ = 0.0;
  turned_ = 0.0;
  for (SideView& side : sides_)
    side.clear();
  others_.clear();
  standing_.clear();
  grid_.clear();
  output_ = {};
}

const Output& Interpretation::step(const Inputs& inputs) {
  if (!placed_)
    pose_in_odom_ = inputs.pose_in_odom;
  placed_ = true;
  cycle_ = inputs.cycle;
  const Pose before = pose_in_odom_;
  const Pose moved = relative(before, inputs.pose_in_odom);
  const bool steady = std::abs(moved.th) <= settings_.steady_turn;
  pose_in_odom_ = inputs.pose_in_odom;
  turned_ += std::abs(moved.th);
  travelled_ += std::hypot(moved.x, moved.y) + settings_.side.turn_cost * std::abs(moved.th);
  changed_ = {false, false};
  if (works(&Tasks::grid_))
    grid_.move_to(pose_in_odom_.position());
  for (std::size_t i = 0; i < inputs.readings.size(); ++i) {
    const double part = static_cast<double>(i + 1) / static_cast<double>(inputs.readings.size());
    take(inputs.readings[i], compose(before, {part * moved.x, part * moved.y, part * moved.th}),
         steady);
  }
  while (!others_.empty() && travelled_ - others_.front().travelled > settings_.side.aperture)
    others_.pop_front();
  if (tasks_)
    mind_tasks();
  interpret();
  output_.changed_tiles = works(&Tasks::grid_) ? grid_.changed() : std::vector<TileKey>();
  output_.dropped_tiles = works(&Tasks::grid_) ? grid_.dropped() : std::vector<TileKey>();
  return output_;
}

bool Interpretation::works(Process* Tasks::*task) const {
  return tasks_ == nullptr || (tasks_->*task)->works();
}

// Percepts of a suspended task are not updated any more: they are removed.
void Interpretation::mind_tasks() {
  if (!works(&Tasks::sides_)) {
    for (SideView& side : sides_)
      side.clear();
    others_.clear();
  }
  const std::size_t before = standing_.size();
  std::erase_if(standing_, [&](const Standing& standing) {
    if (!works(&Tasks::sides_))
      return true;
    switch (standing.percept.type) {
      case PointType::wall:
        return !works(&Tasks::walls_);
      case PointType::corridor:
        return !works(&Tasks::corridors_);
      default:
        return !works(&Tasks::breaks_);
    }
  });
  const auto resumed = [](const Process* task) { return task->works() && task->resumed(); };
  // All anew: also without a changed wall, a resumed task has results.
  if (standing_.size() != before || resumed(tasks_->walls_) || resumed(tasks_->breaks_) ||
      resumed(tasks_->corridors_))
    changed_ = {true, true};
}

void Interpretation::take(const lps::SonarReading& reading, const Pose& robot_in_odom,
                          bool steady) {
  const auto mount =
      std::find_if(settings_.sonars.begin(), settings_.sonars.end(),
                   [&](const lps::SonarMount& m) { return m.sonar == reading.sonar; });
  if (mount == settings_.sonars.end())
    return;
  const Pose sonar = compose(robot_in_odom, mount->in_robot);
  if (works(&Tasks::grid_))
    grid_.add(reading.sonar, sonar, reading.echo ? std::optional(reading.range) : std::nullopt);
  if (!works(&Tasks::sides_))
    return;
  const Return firing{sonar.position(), sonar.direction(),       reading.range, reading.echo,
                      steady,           {cycle_, reading.sonar}, travelled_,    turned_};
  const double bearing = norm2_angle(mount->in_robot.th);
  if (std::abs(std::abs(bearing) - kPi / 2.0) <= settings_.side_sector) {
    const std::size_t side = bearing > 0.0 ? 0 : 1;
    changed_[side] = sides_[side].add(firing) || changed_[side];
  } else if (reading.echo) {
    const bool moved =
        others_.empty() || std::none_of(others_.rbegin(), others_.rend(), [&](const Return& other) {
          return other.id.sonar == reading.sonar &&
                 (other.sonar - firing.sonar).norm() < settings_.side.step &&
                 other.axis.dot(firing.axis) > std::cos(settings_.side.turn);
        });
    if (moved)
      others_.push_back(firing);
  }
}

void Interpretation::interpret() {
  if (changed_[0] || changed_[1]) {
    // Both sides: their results refer to readings, of which the oldest are gone.
    for (SideView& side : sides_)
      side.interpret(travelled_, others_);
    for (Standing& standing : standing_)
      standing.seen = false;
    find_walls(0);
    find_walls(1);
    if (works(&Tasks::corridors_))
      find_corridors();
    std::erase_if(standing_, [](const Standing& standing) { return !standing.seen; });
    output_.percepts.clear();
    for (const Standing& standing : standing_)
      output_.percepts.push_back(standing.percept);
  }
  choose_beside();
}

void Interpretation::find_walls(std::size_t number) {
  const SideSettings& side_settings = settings_.side;
  const Side side = number == 0 ? Side::left : Side::right;
  const bool walls = works(&Tasks::walls_);
  const bool breaks = works(&Tasks::breaks_);
  for (const Wall& wall : sides_[number].walls()) {
    // Lines of the two sides have different numbers.
    const Lines lines{2 * wall.line + static_cast<std::uint32_t>(number), 0};
    const double doubt = wall.fit.sigma_heading;
    if (doubt > settings_.max_heading)
      hold(lines[0], doubt > settings_.max_opening_heading);
    if (doubt > settings_.max_opening_heading)
      continue;
    std::vector<bool> from_taken(wall.stretches.size(), false);
    std::vector<bool> to_taken(wall.stretches.size(), false);
    for (const Opening& opening : wall.openings) {
      const double width = opening.to.u - opening.from.u;
      if (width < side_settings.min_door ||
          width > (opening.depth > 0.0 ? side_settings.max_door : side_settings.max_junction))
        continue;
      if (breaks)
        stand(opening_percept(wall, opening, side), lines);
      to_taken[opening.before] = true;
      from_taken[opening.after] = true;
    }
    for (std::size_t i = 0; i < wall.stretches.size(); ++i) {
      const Stretch& stretch = wall.stretches[i];
      if (!stretch.own)
        continue;
      const double length = stretch.to.u - stretch.from.u;
      if (walls && doubt <= settings_.max_heading && !stretch.echoes.empty()) {
        const Stretch straight = straight_part(wall.fit.line, stretch, side_settings);
        if (straight.echoes.size() >= static_cast<std::size_t>(side_settings.min_echoes) &&
            straight.to.u - straight.from.u >= side_settings.min_length) {
          Percept percept = wall_percept(wall, straight, side);
          if (percept.confidence >= settings_.min_confidence)
            stand(std::move(percept), lines);
        }
      }
      if (!breaks || length < side_settings.end_run)
        continue;
      const auto enough = static_cast<std::size_t>(side_settings.min_through);
      if (!from_taken[i] && stretch.from.open && stretch.from.through.size() >= enough)
        stand(end_percept(wall, stretch, false, side), lines);
      if (!to_taken[i] && stretch.to.open && stretch.to.through.size() >= enough)
        stand(end_percept(wall, stretch, true, side), lines);
    }
  }
}

// The heading of a wall is doubtful after a turn: its earlier percept stays.
void Interpretation::hold(std::uint32_t line, bool openings_too) {
  for (Standing& standing : standing_) {
    const PointType type = standing.percept.type;
    if ((standing.lines[0] == line || standing.lines[1] == line) &&
        (openings_too || type == PointType::wall || type == PointType::corridor) &&
        travelled_ - standing.travelled <= settings_.side.aperture)
      standing.seen = true;
  }
}

void Interpretation::stand(Percept percept, const Lines& lines) {
  Standing* same = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Standing& standing : standing_) {
    if (standing.seen)
      continue;
    const auto way = apart(standing.percept, percept);
    if (way && *way < least) {
      same = &standing;
      least = *way;
    }
  }
  if (same) {
    percept.id = same->percept.id;
    percept.since = same->percept.since;
    // Only new percepts are placed anew: the robot may have turned since.
    if (percept.seen != same->percept.seen)
      *same = {std::move(percept), true, lines, travelled_};
    same->seen = true;
  } else {
    // Not below the cycle: a restarted service must not repeat an id.
    last_id_ = std::max(last_id_ + 1, static_cast<std::uint32_t>(cycle_));
    percept.id = last_id_;
    percept.since = std::min(cycle_, percept.seen);
    standing_.push_back({std::move(percept), true, lines, travelled_});
  }
}

double Interpretation::across_sigma(const Wall& wall, double u) const {
  return std::sqrt(square(wall.fit.sigma_offset) + square(settings_.least_offset) +
                   square(wall.fit.sigma_heading * (u - wall.fit.u_mean)));
}

// The possible drift of dead reckoning along the wall since an opening was seen.
double Interpretation::carried(const Line& line, const std::vector<const Return*>& through,
                               const Stretch& stretch) const {
  double way = 0.0;
  double turn = 0.0;
  for (const Return* echo : stretch.echoes) {
    way = std::max(way, std::abs(echo->travelled - through.front()->travelled));
    turn = std::max(turn, std::abs(echo->turned - through.front()->turned));
  }
  way = std::min(way, 2.0);
  const double aside = line.distance(through.front()->sonar);
  return std::sqrt(square(settings_.encoder) * way +
                   square(aside) * settings_.side.error.heading_variance(way, turn));
}

Percept Interpretation::wall_percept(const Wall& wall, const Stretch& stretch, Side side) const {
  const Line& line = wall.fit.line;
  Percept percept;
  percept.type = PointType::wall;
  percept.side = side;
  const double u = (stretch.from.u + stretch.to.u) / 2.0;
  percept.length = stretch.to.u - stretch.from.u;
  const Vec2 middle = line.at(u);
  // Along it in the robot's direction: from the first echo to the last.
  const Return* first = stretch.echoes.front();
  const Return* last = stretch.echoes.back();
  const Vec2 along = first->travelled <= last->travelled ? line.along() : Vec2(-line.along());
  percept.pose_in_odom = {middle.x(), middle.y(), std::atan2(along.y(), along.x())};
  percept.sigma_heading = std::hypot(wall.fit.sigma_heading, settings_.least_heading);
  percept.sigma_across = across_sigma(wall, u);
  percept.sigma_along = stretch.from.open && stretch.to.open
                            ? std::hypot(stretch.from.sigma, stretch.to.sigma) / 2.0
                            : percept.length / 2.0;
  add_readings(stretch.echoes, percept);
  const double n = static_cast<double>(stretch.echoes.size());
  percept.confidence = n / (n + 1.0) * (1.0 - 0.3 * square(wall.fit.rms / settings_.side.max_rms));
  return percept;
}

Percept Interpretation::end_percept(const Wall& wall, const Stretch& stretch, bool upper,
                                    Side side) const {
  const Line& line = wall.fit.line;
  const End& end = upper ? stretch.to : stretch.from;
  Percept percept;
  percept.type = PointType::breach;
  percept.side = side;
  const Vec2 at = line.at(end.u);
  percept.pose_in_odom = {at.x(), at.y(), std::atan2(-line.normal.y(), -line.normal.x())};
  percept.sigma_heading = std::hypot(wall.fit.sigma_heading, settings_.least_heading);
  percept.sigma_along = across_sigma(wall, end.u);
  add_witnesses(line, stretch, upper, percept);
  for (const Return* firing : end.through)
    if (std::abs(line.u(firing->sonar) - end.u) < kWitness)
      add_readings({firing}, percept);
  add_readings(end.posts, percept);
  percept.sigma_across = std::hypot(end.sigma, carried(line, end.through, stretch));
  const double n = static_cast<double>(end.through.size());
  percept.confidence = n / (n + 1.0) * (end.posts.empty() ? 0.8 : 0.95);
  return percept;
}

Percept Interpretation::opening_percept(const Wall& wall, const Opening& opening, Side side) const {
  const Line& line = wall.fit.line;
  const End& from = opening.from;
  const End& to = opening.to;
  Percept percept;
  percept.side = side;
  percept.length = opening.depth;
  percept.width = to.u - from.u;
  percept.type = percept.width <= settings_.side.max_door ? PointType::door : PointType::junction;
  const double u = (from.u + to.u) / 2.0;
  const Vec2 at = line.at(u);
  percept.pose_in_odom = {at.x(), at.y(), std::atan2(-line.normal.y(), -line.normal.x())};
  percept.sigma_heading = std::hypot(wall.fit.sigma_heading, settings_.least_heading);
  percept.sigma_along = across_sigma(wall, u);
  add_readings(opening.through, percept);
  add_witnesses(line, wall.stretches[opening.before], true, percept);
  add_witnesses(line, wall.stretches[opening.after], false, percept);
  add_readings(from.posts, percept);
  add_readings(to.posts, percept);
  percept.sigma_across =
      std::hypot(std::hypot(from.sigma, to.sigma) / 2.0,
                 std::max(carried(line, opening.through, wall.stretches[opening.before]),
                          carried(line, opening.through, wall.stretches[opening.after])));
  const double n = static_cast<double>(opening.through.size());
  percept.confidence =
      n / (n + 1.0) * (from.posts.empty() ? 0.9 : 1.0) * (to.posts.empty() ? 0.9 : 1.0);
  return percept;
}

void Interpretation::find_corridors() {
  for (const Wall& left : sides_[0].walls())
    for (const Wall& right : sides_[1].walls()) {
      const Line& a = left.fit.line;
      const Line& b = right.fit.line;
      // Their normals look away from the robot, to opposite sides.
      const double cosine = -a.normal.dot(b.normal);
      if (left.fit.sigma_heading > settings_.max_heading ||
          right.fit.sigma_heading > settings_.max_heading)
        continue;
      if (cosine < std::cos(settings_.parallel))
        continue;
      Vec2 normal = (a.normal - b.normal).normalized();  // to the left
      const Vec2 along(normal.y(), -normal.x());
      const auto reach = [&](const Wall& wall) {
        const Vec2 from = wall.fit.line.at(wall.stretches.front().from.u);
        const Vec2 to = wall.fit.line.at(wall.stretches.back().to.u);
        return std::minmax({along.dot(from), along.dot(to)});
      };
      const auto one = reach(left);
      const auto two = reach(right);
      const double low = std::max(one.first, two.first);
      const double high = std::min(one.second, two.second);
      if (high - low < settings_.min_overlap)
        continue;
      const double t = (low + high) / 2.0;
      // The walls at t: normal and along are nearly the lines' own.
      const auto across = [&](const Line& line) {
        return (line.offset - t * line.normal.dot(along)) / line.normal.dot(normal);
      };
      const double y_left = across(a);
      const double y_right = across(b);
      const double width = y_left - y_right;
      if (width < settings_.min_corridor || width > settings_.max_corridor)
        continue;
      Percept percept;
      percept.type = PointType::corridor;
      const Vec2 middle = t * along + (y_left + y_right) / 2.0 * normal;
      percept.pose_in_odom = {middle.x(), middle.y(), std::atan2(along.y(), along.x())};
      percept.length = high - low;
      percept.width = width;
      percept.sigma_along = percept.length / 2.0;
      percept.sigma_across =
          std::max(across_sigma(left, a.u(middle)), across_sigma(right, b.u(middle)));
      percept.sigma_heading = std::hypot(std::max(left.fit.sigma_heading, right.fit.sigma_heading),
                                         settings_.least_heading);
      double n = 0.0;
      for (const Wall* wall : {&left, &right})
        for (const Stretch& stretch : wall->stretches) {
          add_readings(stretch.echoes, percept);
          n += static_cast<double>(stretch.echoes.size());
        }
      percept.confidence = n / (n + 2.0);
      stand(std::move(percept), {2 * left.line, 2 * right.line + 1});
    }
}

void Interpretation::choose_beside() {
  output_.left_wall.reset();
  output_.right_wall.reset();
  double nearest[2] = {0.0, 0.0};
  for (const Percept& percept : output_.percepts) {
    if (percept.type != PointType::wall)
      continue;
    const Pose robot = relative(percept.pose_in_odom, pose_in_odom_);
    const bool is_left = percept.side == Side::left;
    const double off = std::abs(robot.th);
    if (std::abs(robot.x) > percept.length / 2.0 + settings_.beside ||
        std::min(off, kPi - off) > radians(30.0) ||
        is_left != (std::abs(robot.th) < kPi / 2.0 ? robot.y < 0.0 : robot.y > 0.0))
      continue;
    auto& chosen = is_left ? output_.left_wall : output_.right_wall;
    double& best = nearest[is_left ? 0 : 1];
    if (!chosen || std::abs(robot.y) < best) {
      chosen = percept;
      best = std::abs(robot.y);
    }
  }
}

}  // namespace saphira::interpretation
