#include "saphira/explore/explorer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saphira/base/shortest_ways.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::explore {

namespace {

using lps::PointType;
using maps::Feature;

constexpr double kNone = std::numeric_limits<double>::infinity();
// Two places of the driven way within this distance are connected [m].
constexpr double kStep = 0.8;
// Older readings [cycles] are from another place.
constexpr std::uint64_t kFresh = 10;
constexpr double kStraight = radians(10.0);  // of a sonar that looks ahead
constexpr double kThere = 1.5;               // [m] the robot has come back to the start
constexpr double kAtEdge = 0.35;             // [m] from a corner of the way over the free floor
// [m/m2] Longer on the same floor, the robot's drift costs more than what it still sees is worth.
constexpr double kWayOverFloor = 0.8;
constexpr double kBend = radians(5.0);
constexpr double kCorridors = 0.25;  // least share of a floor of corridors
constexpr double kHalfWidth = 1.0;   // [m] of corridors, about
constexpr double kDoubleDoor = 1.6;  // [m] a wider gap in a wall is no door

Vec2 ahead(const Vec2& point, double heading, double far) {
  return point + far * Vec2(std::cos(heading), std::sin(heading));
}

}  // namespace

Explorer::Explorer(Settings settings) : settings_(std::move(settings)), floor_(settings_.sonars) {}

const Output& Explorer::step(const Inputs& inputs) {
  if (!begun_) {
    begun_ = true;
    start_in_map_ = inputs.pose_in_map;
  }
  listen(inputs);
  floor_.add(inputs.pose_in_map, inputs.readings);
  if (output_.done)
    return output_;
  if (doing_ == Doing::looking)
    look(inputs);
  if (doing_ == Doing::choosing)
    choose(inputs);
  if (doing_ == Doing::going)
    go(inputs);
  if (doing_ == Doing::probing)
    probe(inputs);
  if (doing_ == Doing::roaming)
    roam(inputs);
  return output_;
}

void Explorer::listen(const Inputs& inputs) {
  for (const lps::SonarReading& reading : inputs.readings)
    heard_.push_back({reading.sonar, reading.echo ? reading.range : lps::kNothing, inputs.cycle,
                      inputs.pose_in_map.th});
  // The length of an opening at the side: a door is soon passed.
  const double moved = (inputs.pose_in_map.position() - listened_at_).norm();
  listened_at_ = inputs.pose_in_map.position();
  for (double& way : open_way_)
    way += std::min(moved, 0.2);  // more is the map's correction
  for (const lps::SonarReading& reading : inputs.readings)
    for (const lps::SonarMount& mount : settings_.sonars)
      if (mount.sonar == reading.sonar && reading.echo && reading.range < settings_.open_side &&
          std::abs(std::abs(mount.in_robot.th) - kPi / 2) < kStraight) {
        double& way = open_way_.at(mount.in_robot.th > 0.0 ? 0 : 1);
        if (way >= settings_.wide_door)
          gaps_.push_back({transform(inputs.pose_in_map, {-way / 2, 0.0}),
                           norm2_angle(inputs.pose_in_map.th + mount.in_robot.th),
                           "a gap in the wall", false, true, way < kDoubleDoor});
        way = 0.0;
      }
  // After a turn the sonars look elsewhere.
  std::erase_if(heard_, [&](const Heard& h) {
    return h.cycle + kFresh < inputs.cycle ||
           std::abs(norm2_angle(h.heading - inputs.pose_in_map.th)) > radians(8.0);
  });
}

bool Explorer::is_tried(const Lead& lead) const {
  return std::any_of(tried_.begin(), tried_.end(), [&](const Lead& tried) {
    const Vec2 off = tried.point - lead.point;
    const double along = std::abs(off.dot(ahead({0.0, 0.0}, lead.heading, 1.0)));
    const double across = std::sqrt(std::max(0.0, off.squaredNorm() - along * along));
    return along < settings_.tried + 0.8 &&
           across < (lead.door ? settings_.wide_door / 2 : settings_.tried) &&
           std::abs(norm2_angle(tried.heading - lead.heading)) < radians(45.0);
  });
}

// True where a corridor or junction of the map continues in that direction.
bool Explorer::mapped_along(const maps::Map& map, const Vec2& point, double heading) const {
  const Vec2 there = ahead(point, heading, 2.5);
  return std::any_of(map.features.begin(), map.features.end(), [&](const Feature& f) {
    return (f.type == PointType::corridor || f.type == PointType::junction) &&
           maps::distance_to(f, there) < 0.1;
  });
}

std::vector<Explorer::Lead> Explorer::leads(const Inputs& inputs) const {
  std::vector<Lead> out;
  const auto offer = [&](Lead lead) {
    if (!is_tried(lead))
      out.push_back(std::move(lead));
  };
  std::vector<const Feature*> junctions;
  for (const Feature& f : inputs.map.features)
    if (f.type == PointType::junction)
      junctions.push_back(&f);
  for (const Feature& f : inputs.map.features) {
    if (f.type == PointType::corridor) {
      for (const bool upper : {true, false}) {
        const Vec2 end = upper ? maps::end_of(f) : maps::begin_of(f);
        const double heading = upper ? f.pose_in_map.th : norm2_angle(f.pose_in_map.th + kPi);
        // A corridor that ends where another comes from the side may go on behind it.
        const auto junction =
            std::find_if(junctions.begin(), junctions.end(),
                         [&](const Feature* j) { return maps::distance_to(*j, end) < 0.6; });
        const bool meets = junction != junctions.end();
        const Vec2 from = meets ? (*junction)->pose_in_map.position() : end;
        if (!meets || !mapped_along(inputs.map, from, heading))
          offer({from, heading, "the end of corridor " + std::to_string(f.id), false, false});
      }
    } else if (f.type == PointType::breach) {
      const double inwards = norm2_angle(f.pose_in_map.th + kPi);
      if (!mapped_along(inputs.map, f.pose_in_map.position(), inwards))
        offer({f.pose_in_map.position(), inwards, "opening " + std::to_string(f.id), false, true});
    }
  }
  for (const Lead& lead : seen_open_)
    if (!mapped_along(inputs.map, lead.point, lead.heading))
      offer(lead);
  return out;
}

/// A narrow corridor looks like a wide door. Beside the end of a corridor a way is no opening of
/// the map, since only one of its posts was seen.
std::vector<Explorer::Lead> Explorer::wide_doors(const Inputs& inputs) const {
  std::vector<Lead> out;
  for (const Lead& gap : gaps_) {
    const bool in_wall =
        std::any_of(inputs.map.features.begin(), inputs.map.features.end(), [&](const Feature& f) {
          return f.type == PointType::corridor && maps::contains(f, gap.point) &&
                 std::abs(std::sin(f.pose_in_map.th - gap.heading)) > std::cos(kStraight);
        });
    const bool known =
        std::any_of(inputs.map.features.begin(), inputs.map.features.end(), [&](const Feature& f) {
          return (f.type == PointType::door || f.type == PointType::breach) &&
                 (f.pose_in_map.position() - gap.point).norm() < settings_.tried;
        });
    if (in_wall && !known && !is_tried(gap) && !mapped_along(inputs.map, gap.point, gap.heading))
      out.push_back(gap);
  }
  for (const Feature& f : inputs.map.features) {
    const double inwards = norm2_angle(f.pose_in_map.th + kPi);
    const Lead lead{
        f.pose_in_map.position(), inwards, "door " + std::to_string(f.id), false, true, true};
    if (f.type == PointType::door && f.width >= settings_.wide_door && !is_tried(lead) &&
        !mapped_along(inputs.map, lead.point, inwards))
      out.push_back(lead);
  }
  return out;
}

// A corridor between a wall and boxes is no floor of corridors.
bool Explorer::mostly_room(const maps::Map& map) const {
  double corridors = 0.0;
  for (const Feature& f : map.features)
    if (f.type == PointType::corridor)
      corridors += f.length * f.width;
  return corridors < kCorridors * floor_.area();
}

// Dijkstra over the places that the robot has been at.
std::vector<std::size_t> Explorer::path(const std::vector<Vec2>& way, const Vec2& to,
                                        double& length) const {
  const std::size_t n = way.size();
  const auto shut = [&](std::size_t i) {
    return std::any_of(shut_.begin(), shut_.end(),
                       [&](const Vec2& p) { return (p - way[i]).norm() < 0.5; });
  };
  ShortestWays ways(n);
  ways.reach(n - 1, 0.0);
  std::optional<std::size_t> best;
  double best_far = kNone;
  while (const auto next = ways.next()) {
    // The nearest place; a longer way must be worth its cost.
    const double far = (way[*next] - to).norm() + 0.001 * ways.cost(*next);
    if (far < best_far) {
      best_far = far;
      best = next;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double step = (way[i] - way[*next]).norm();
      if (!ways.settled(i) && step <= kStep && (!shut(i) || shut(*next)))
        ways.reach(i, ways.cost(*next) + step, next);
    }
  }
  if (!best) {
    length = kNone;
    return {};
  }
  length = ways.cost(*best) + (way[*best] - to).norm();
  return ways.way_to(*best);
}

void Explorer::choose(const Inputs& inputs) {
  std::vector<Lead> open = leads(inputs);
  const auto corridors =
      std::count_if(inputs.map.features.begin(), inputs.map.features.end(),
                    [](const Feature& f) { return f.type == PointType::corridor; });
  if (open.empty() && corridors < settings_.least_corridors)
    for (const double turn : {0.0, kPi / 2, -kPi / 2, kPi}) {
      const Lead lead{inputs.pose_in_map.position(), norm2_angle(start_in_map_.th + turn),
                      "straight on", false, false};
      if (!is_tried(lead)) {
        open.push_back(lead);
        break;
      }
    }
  if (open.empty())
    open = wide_doors(inputs);
  in_room_ = in_room_ || (open.empty() && mostly_room(inputs.map));
  if (in_room_ && !roamed_) {
    doing_ = Doing::roaming;
    return;
  }
  if (open.empty() && settings_.home > 0.0) {
    // Along the first way, to see the same places again.
    std::size_t i = 0;
    for (double gone = 0.0; i + 1 < inputs.way.size() && gone < settings_.home; ++i)
      gone += (inputs.way[i + 1] - inputs.way[i]).norm();
    Lead home{inputs.way[i], start_in_map_.th, "the way back to the start", true, false};
    if (!home_)
      open.push_back(home);
    home_ = true;
  }
  std::optional<Lead> best;
  std::vector<std::size_t> best_path;
  double best_length = kNone;
  std::vector<Lead> unreached;
  for (const Lead& lead : open) {
    double length = 0.0;
    std::vector<std::size_t> way = path(inputs.way, lead.point, length);
    const double short_by = way.empty() ? kNone : (inputs.way[way.back()] - lead.point).norm();
    if (short_by > 5.0) {
      unreached.push_back(lead);
      continue;
    }
    if (length < best_length) {
      best_length = length;
      best = lead;
      best_path = std::move(way);
    }
  }
  if (!best && !shut_.empty() && reopened_ < settings_.reopen) {
    // The robot's own trouble may have closed the only way.
    ++reopened_;
    shut_.clear();
    home_ = false;  // also the way home
    return;
  }
  tried_.insert(tried_.end(), unreached.begin(), unreached.end());
  for (const Lead& lead : unreached)
    leave(lead, "no way leads there");
  if (!best) {
    if (open.empty())
      output_ = {true, std::nullopt, std::nullopt, 0.0, "nothing is left to explore"};
    return;  // looks again in the next cycle, without the lead that was given up
  }
  lead_ = best;
  path_.clear();
  for (const std::size_t i : best_path)
    path_.push_back(inputs.way[i]);
  doing_ = Doing::going;
  progress_cycle_ = inputs.cycle;
  progress_ = kNone;
  output_.reason = lead_->what;
}

void Explorer::go(const Inputs& inputs) {
  const Vec2 here = inputs.pose_in_map.position();
  // The farthest place that is straight ahead, without cutting a corner.
  while (path_.size() > 1) {
    const Vec2 next = path_[1] - here;
    const double along = next.dot(path_.front() - here) / std::max(1e-9, next.squaredNorm());
    const Vec2 off = path_.front() - here - std::clamp(along, 0.0, 1.0) * next;
    if ((path_.front() - here).norm() > 0.4 &&
        (next.norm() > (stuck_ > 0 ? 0.5 : settings_.look_ahead) || off.norm() > 0.2))
      break;
    path_.erase(path_.begin());
  }
  if (path_.size() <= 1 && (path_.empty() || (path_.front() - here).norm() < 0.6)) {
    if (lead_->home) {
      if ((lead_->point - here).norm() > kThere)
        leave(*lead_, "closed");
      finish(inputs);
      return;
    }
    doing_ = Doing::probing;
    probe_from_ = here;
    progress_cycle_ = inputs.cycle;
    progress_ = kNone;
    return;
  }
  note_progress(inputs);
  if (inputs.cycle > progress_cycle_ + 2 * settings_.patience) {
    doing_ = Doing::choosing;
    output_.look_at.reset();
    output_.point_in_map.reset();
    if (lead_->home)
      home_ = false;
    if (++stuck_ % 2 == 1)
      return;  // once more, closer to its earlier way
    // Closed since then: go around, if there is a way.
    shut_.push_back(path_.front());
    lead_.reset();
    stuck_ = 0;
    return;
  }
  head_for(path_.front(), inputs);
}

// A turn on the spot before a way back: in a wide turn the robot would drift into the next opening.
void Explorer::head_for(const Vec2& point, const Inputs& inputs) {
  const Vec2 there = to_frame(inputs.pose_in_map, point);
  const double bearing = std::abs(std::atan2(there.y(), there.x()));
  turning_ = bearing > (turning_ ? radians(25.0) : radians(60.0));
  output_.look_at = turning_ ? std::optional(point) : std::nullopt;
  output_.point_in_map = turning_ ? std::nullopt : std::optional(point);
  output_.speed = settings_.speed;
}

// Straight on along the lead, and along its mapped part.
void Explorer::probe(const Inputs& inputs) {
  const Vec2 here = inputs.pose_in_map.position();
  // The lead has become a corridor: the corridor's middle is more accurate than the lead's.
  Vec2 point = lead_->point;
  double heading = lead_->heading;
  double mapped = -kNone;  // length of the map along the heading
  for (const Feature& f : inputs.map.features) {
    if (f.type != PointType::corridor || maps::distance_to(f, here) > settings_.beyond + 2.0)
      continue;
    const Pose in = relative({here.x(), here.y(), heading}, f.pose_in_map);
    if (std::abs(norm3_angle(in.th)) > radians(20.0) || std::abs(in.y) > 1.0)
      continue;
    const bool same_way = std::abs(in.th) < kPi / 2;
    point = f.pose_in_map.position();
    heading = same_way ? f.pose_in_map.th : norm2_angle(f.pose_in_map.th + kPi);
    mapped = in.x + f.length / 2;
  }
  in_corridor_ = mapped > -kNone;
  const Vec2 u = ahead({0.0, 0.0}, heading, 1.0);
  const double at = u.dot(here - point);
  const double from = u.dot(probe_from_ - point);
  const double gone = at - std::max(from, at + mapped);
  const double done = at - from;
  probed_ = done;
  if (progress_ == kNone || done > progress_ + settings_.min_progress) {
    progress_ = done;
    progress_cycle_ = inputs.cycle;
  }
  const bool stuck = inputs.cycle > progress_cycle_ + settings_.patience;
  const double off = std::abs(u.x() * (here - point).y() - u.y() * (here - point).x());
  const bool away = off > settings_.aside && done > (lead_->opening ? settings_.entering : 0.5);
  if (squeeze_ && done > *squeeze_ + 1.5) {
    squeeze_.reset();  // it was only an obstacle
    aside_ = 0.0;
  }
  const double turned = norm2_angle(inputs.pose_in_map.th - heading);
  // Within an opening the echo may be only its edge. Of a way that was heard from beside it often
  // is: the robot is not before its middle, and the behaviors find the way in.
  const bool begins = done < settings_.entering;
  const bool entering = lead_->opening && begins;
  const bool front = !squeeze_ && !(lead_->aside && begins) &&
                     off < (entering ? 0.3 : settings_.aside) &&
                     std::abs(turned) < radians(entering ? 15.0 : 35.0) &&
                     heard(-turned).value_or(lps::kNothing) < settings_.front;
  if (front && follow_bend(done, turned, inputs))
    return;
  if (lead_->door && !in_corridor_ &&
      (front || stuck || away || (done > settings_.in_door && !walled()))) {
    output_.reason = lead_->what + ": a room";
    open_ = true;  // the robot's place is not the end of a corridor
    finish(inputs);
    return;
  }
  if (front) {
    // The sides first: the obstacle ahead turns the robot away, perhaps into a door. Then on, since
    // the obstacle may be a box.
    look_from_ = point + at * u;
    output_.reason = lead_->what + ": something ahead";
    may_squeeze_ = true;
    ended_ = point + std::max(from, at + mapped) * u;
    begin_looking(inputs);
    look(inputs);
    return;
  }
  const double beyond = lead_->opening ? settings_.beyond_opening : settings_.beyond;
  // Between two walls it is in a corridor, even if the map is late.
  if (stuck || away || gone > (walled() ? 3.0 : 1.0) * beyond) {
    output_.reason = lead_->what + (stuck  ? ": closed"
                                    : away ? ": turned away"
                                           : ": open, and nothing follows");
    open_ = !stuck && !away;
    if (!open_ && lead_->opening && !in_corridor_) {
      leave(*lead_, stuck ? "closed" : "turned away");
    } else if (stuck && !squeeze_) {  // before a wall was heard: the way may go on
      Lead rest = *lead_;
      rest.point = here;
      rest.heading = heading;
      leave(rest, "closed");
    }
    // An end that the robot passed on the way into the open was tried too. One that turned it away
    // may be the wall of a corridor that lies aslant to the lead.
    if (in_corridor_ || !away)
      tried_.push_back(
          {point + std::max(from, at + mapped) * u, heading, lead_->what, false, false});
    else
      open_ = true;
    if (squeeze_) {
      finish(inputs);
      return;
    }
    look_from_ = point + at * u;
    begin_looking(inputs);
    look(inputs);
    return;
  }
  const double far = (entering ? 0.8 : 2.0) * settings_.look_ahead;
  head_for(point + (at + far) * u + aside_ * Vec2(-u.y(), u.x()), inputs);
}

// The walls of a way that lies aslant to its opening turn the robot: the lead turns with it.
bool Explorer::follow_bend(double done, double turned, const Inputs& inputs) {
  if (in_corridor_ || !lead_->door || done < settings_.in_door || !walled() ||
      std::abs(turned) < kBend || heard(0.0).value_or(lps::kNothing) < 2 * settings_.front)
    return false;
  tried_.push_back(*lead_);
  lead_->heading = inputs.pose_in_map.th;
  lead_->point = probe_from_ = inputs.pose_in_map.position();
  progress_ = kNone;
  return true;
}

// Along the path that is left.
void Explorer::note_progress(const Inputs& inputs) {
  double left = (path_.front() - inputs.pose_in_map.position()).norm();
  for (std::size_t i = 1; i < path_.size(); ++i)
    left += (path_[i] - path_[i - 1]).norm();
  if (left < progress_ - settings_.min_progress) {
    progress_ = left;
    progress_cycle_ = inputs.cycle;
  }
}

// To the edges of the seen floor, the nearest first.
void Explorer::roam(const Inputs& inputs) {
  const Vec2 here = inputs.pose_in_map.position();
  output_.reason = "explores the free floor";
  roamed_way_ += std::min(0.2, (here - roamed_at_).norm());
  roamed_at_ = here;
  if (edge_ &&
      ((*edge_ - here).norm() < kAtEdge || inputs.cycle > progress_cycle_ + settings_.patience)) {
    tried_edges_.push_back(*edge_);
    edge_.reset();
  }
  if (!edge_ || inputs.cycle > planned_ + kFresh) {
    planned_ = inputs.cycle;
    if (edge_)
      path_ = floor_.way_to(here, *edge_);
    if (!edge_ || path_.empty()) {
      const double most = kWayOverFloor * floor_.area();
      path_.clear();
      if (roamed_way_ < 2.0 * most)
        path_ = floor_.way_to_look(here, tried_edges_, roamed_way_ < most);
      progress_ = kNone;
      progress_cycle_ = inputs.cycle;
      edge_.reset();
      if (!path_.empty())
        edge_ = path_.back();
    }
  }
  if (!edge_) {
    roamed_ = true;
    doing_ = Doing::choosing;
    output_.point_in_map.reset();
    output_.look_at.reset();
    return;
  }
  while (path_.size() > 1 && (path_.front() - here).norm() < kAtEdge)
    path_.erase(path_.begin());
  note_progress(inputs);
  head_for(path_.front(), inputs);
}

void Explorer::leave(const Lead& lead, const std::string& why) {
  left_.push_back(lead);
  left_.back().what += " (" + why + ")";
}

std::vector<std::string> Explorer::left(const maps::Map& map) const {
  std::vector<std::string> out;
  for (const Lead& lead : left_)
    if (!lead.door && (lead.home || !mapped_along(map, lead.point, lead.heading)) &&
        std::find(out.begin(), out.end(), lead.what) == out.end())
      out.push_back(lead.what);
  return out;
}

bool Explorer::walled() const {
  return std::all_of(open_way_.begin(), open_way_.end(),
                     [&](double way) { return way < settings_.gap_in_walls; });
}

std::optional<double> Explorer::heard(double bearing) const {
  std::vector<double> ranges;
  for (const lps::SonarMount& mount : settings_.sonars)
    if (std::abs(norm2_angle(mount.in_robot.th - bearing)) < kStraight)
      for (const Heard& h : heard_)
        if (h.sonar == mount.sonar)
          ranges.push_back(h.range);
  if (ranges.empty())
    return std::nullopt;
  std::sort(ranges.begin(), ranges.end());
  return ranges[ranges.size() / 2];
}

bool Explorer::passable() const {
  return heard(radians(30.0)).value_or(lps::kNothing) > 2 * settings_.front ||
         heard(radians(-30.0)).value_or(lps::kNothing) > 2 * settings_.front;
}

// The free way of the sonars that look ahead to one side (1: left).
double Explorer::room(double side) const {
  double sum = 0.0;
  for (const double bearing : {15.0, 30.0})
    sum += std::min(2 * settings_.front, heard(side * radians(bearing)).value_or(0.0));
  return sum;
}

// Other ways may begin at the end of this one.
void Explorer::begin_looking(const Inputs& inputs) {
  doing_ = Doing::looking;
  looks_ = {norm2_angle(lead_->heading + kPi / 2), norm2_angle(lead_->heading - kPi / 2)};
  open_aside_ = false;
  look_cycle_ = inputs.cycle;
  steady_cycle_ = 0;
  // Ways that begin in a room are doors.
  const bool any = std::any_of(inputs.map.features.begin(), inputs.map.features.end(),
                               [](const Feature& f) { return f.type == PointType::corridor; });
  if (any && !in_corridor_)
    looks_.clear();
  if (lead_->opening && !in_corridor_)  // an opening that was met aslant
    for (const double aslant : {kPi / 4, -kPi / 4})
      looks_.push_back(norm2_angle(lead_->heading + aslant));
  aligned_ = std::abs(norm2_angle(inputs.pose_in_map.th - lead_->heading)) < radians(12.0);
  turned_ = !aligned_;
  if (aligned_)
    listen_aside(inputs);
}

// Along the way the sonars look aside: a turn to either side would be of no use, and would cost
// more dead reckoning than driving.
void Explorer::listen_aside(const Inputs& inputs) {
  // A way aside is as wide as a corridor: its middle is not at the wall in front.
  const double front = heard(0.0).value_or(lps::kNothing);
  look_from_ = ahead(look_from_, lead_->heading, front < kHalfWidth ? front - kHalfWidth : 0.0);
  std::erase_if(looks_, [&](double heading) {
    const auto range = heard(norm2_angle(heading - lead_->heading));
    if (!range)
      return false;
    const bool left = norm2_angle(heading - lead_->heading) > 0.0;
    const bool wide = turned_ || open_way_.at(left ? 0 : 1) > settings_.wider_than_a_door;
    hear_aside(*range, heading, !wide, inputs);
    return true;
  });
}

void Explorer::hear_aside(double range, double heading, bool narrow, const Inputs& inputs) {
  if (range <= settings_.open_side)
    return;
  open_aside_ = open_aside_ || !narrow;
  Lead side{look_from_, heading,     narrow ? "a narrow way aside" : "a way aside", false, false,
            narrow,     in_corridor_};
  if (!mapped_along(inputs.map, look_from_, heading) && !is_tried(side))
    seen_open_.push_back(side);
}

// Turns to a heading of the map. True when the robot has looked there for a while, or cannot.
bool Explorer::looked(double heading, const Inputs& inputs) {
  output_.look_at = ahead(inputs.pose_in_map.position(), heading, 5.0);
  if (std::abs(norm2_angle(inputs.pose_in_map.th - heading)) > radians(6.0)) {
    steady_cycle_ = 0;
    return inputs.cycle >= look_cycle_ + 2 * settings_.patience;
  }
  if (steady_cycle_ == 0)
    steady_cycle_ = inputs.cycle;
  return inputs.cycle > steady_cycle_ + kFresh;
}

void Explorer::look(const Inputs& inputs) {
  const Pose& pose = inputs.pose_in_map;
  output_.point_in_map.reset();
  while (!looks_.empty() && mapped_along(inputs.map, look_from_, looks_.front())) {
    open_aside_ = true;
    looks_.erase(looks_.begin());
  }
  if (looks_.empty()) {
    output_.look_at.reset();
    if (may_squeeze_ && !open_aside_ && passable()) {
      // No way to the sides: the obstacle may be a box. Pass it on the side with more room.
      aside_ = (room(1.0) > room(-1.0) ? 1.0 : -1.0) * settings_.by_a_box;
      squeeze_ = probed_;
      doing_ = Doing::probing;
      progress_cycle_ = inputs.cycle;
    } else {
      if (may_squeeze_)
        tried_.push_back({ended_, lead_->heading, lead_->what, false, false});
      finish(inputs);
    }
    may_squeeze_ = false;
    return;
  }
  if (!aligned_) {
    if (!looked(lead_->heading, inputs))
      return;
    aligned_ = true;
    if (steady_cycle_ != 0)
      listen_aside(inputs);
    look_cycle_ = inputs.cycle;
    steady_cycle_ = 0;
    return;
  }
  if ((look_from_ - pose.position()).norm() > 0.45 && steady_cycle_ == 0 &&
      inputs.cycle < look_cycle_ + settings_.patience / 2) {
    output_.look_at.reset();  // back into the middle first
    output_.point_in_map = look_from_;
    output_.speed = settings_.speed;
    return;
  }
  const double heading = looks_.front();
  if (!looked(heading, inputs))
    return;
  if (steady_cycle_ != 0)
    hear_aside(heard(0.0).value_or(0.0), heading, false, inputs);
  looks_.erase(looks_.begin());
  look_cycle_ = inputs.cycle;
  steady_cycle_ = 0;
}

void Explorer::finish(const Inputs& inputs) {
  tried_.push_back(*lead_);
  // Also at its end: the end of a corridor has moved on with the robot. In the open the map may
  // only be late.
  Lead here = *lead_;
  here.point = inputs.pose_in_map.position();
  if (!open_)
    tried_.push_back(here);
  open_ = false;
  lead_.reset();
  stuck_ = 0;
  output_.look_at.reset();
  squeeze_.reset();
  aside_ = 0.0;
  doing_ = Doing::choosing;
  output_.point_in_map.reset();
}

}  // namespace saphira::explore
