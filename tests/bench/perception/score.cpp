#include "perception/score.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "saphira/base/places.hpp"

namespace saphira::test {
namespace {

using lps::PointType;

constexpr double kOnWall = 0.2;     // [m] tolerance of a wall
constexpr int kSamples = 20;        // along a wall
constexpr double kOnDoor = 0.3;     // [m] tolerance of a door's middle
constexpr double kDoorWidth = 0.4;  // [m]
constexpr double kOnCorner = 0.3;   // [m] one end
constexpr double kAskew = radians(5.0);
constexpr double kDoorAskew = radians(15.0);

double parallel(double a, double b) {
  const double off = std::abs(norm2_angle(a - b));
  return std::min(off, kPi - off);
}

double nearest_end(const sim::Things& things, const Vec2& at) {
  double least = 1e9;
  for (const sim::Segment& segment : things.segments)
    least = std::min({least, (segment.from - at).norm(), (segment.to - at).norm()});
  return least;
}

}  // namespace

Score::Score(Drive& drive, maps::Map map)
    : map_(std::move(map)), surfaces_([&drive](const Vec2& about) {
        sim::Things things{drive.world().segments, {}};
        drive.scene().add_movable(about, 12.0, drive.robot().number(), things);
        return things;
      }) {}

Pose Score::in_world(const lps::Percept& percept) const {
  const auto after = odom_in_world_.upper_bound(percept.seen);
  const auto at = after == odom_in_world_.begin() ? after : std::prev(after);
  return compose(at->second, percept.pose_in_odom);
}

bool Score::is_surface(const sim::Things& things, const Pose& middle,
                       const lps::Percept& wall) const {
  int hits = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double along = ((i + 0.5) / kSamples - 0.5) * wall.length;
    const Vec2 at = transform(middle, Vec2(along, 0.0));
    for (const sim::Segment& segment : things.segments) {
      const Vec2 way = segment.to - segment.from;
      if ((sim::nearest_point(segment, at) - at).norm() <= kOnWall &&
          parallel(std::atan2(way.y(), way.x()), middle.th) <= kAskew) {
        ++hits;
        break;
      }
    }
  }
  return hits >= 17;
}

const maps::Feature* Score::door_at(const Pose& at, double width) const {
  for (const maps::Feature& feature : map_.features)
    if ((feature.type == PointType::door || feature.type == PointType::breach) &&
        (feature.pose_in_map.position() - at.position()).norm() <= kOnDoor &&
        parallel(feature.pose_in_map.th, at.th) <= kDoorAskew &&
        std::abs(feature.width - width) <= kDoorWidth)
      return &feature;
  return nullptr;
}

bool Score::is_real(const lps::Percept& percept, const Pose& at) const {
  const sim::Things things = surfaces_(at.position());
  switch (percept.type) {
    case PointType::wall:
      return is_surface(things, at, percept);
    case PointType::door:
      return door_at(at, percept.width) != nullptr;
    case PointType::breach:
      return nearest_end(things, at.position()) <= kOnCorner;
    default:
      return false;
  }
}

void Score::look(const Drive& drive) {
  const Seen& seen = drive.seen();
  const std::vector<lps::Percept>& percepts = drive.percepts();
  odom_in_world_[seen.cycle] =
      compose(seen.true_pose_in_world, relative(seen.pose_in_odom, Pose{}));
  for (const lps::Percept& percept : percepts) {
    const auto known = judged_.find(percept.id);
    if (known != judged_.end() && percept.seen != seen.cycle)
      continue;
    const Pose at = in_world(percept);
    Judged& judged = judged_[percept.id];
    judged.type = percept.type;
    judged.real = judged.real && is_real(percept, at);
  }
  pass(seen, percepts);
}

void Score::pass(const Seen& seen, const std::vector<lps::Percept>& percepts) {
  for (std::size_t i = 0; i < map_.features.size(); ++i) {
    const maps::Feature& door = map_.features[i];
    if (door.type != PointType::door)
      continue;
    // Seen from the door: x away from its wall, y along it.
    const Pose robot = relative(door.pose_in_map, seen.true_pose_in_world);
    Passing& passing = passing_[i];
    const bool beside = std::abs(robot.x) > 0.3 && std::abs(robot.x) < 1.8 &&
                        std::abs(robot.y) < 1.2 && parallel(robot.th, kPi / 2.0) < radians(25.0) &&
                        seen.velocity > 0.05;
    if (beside && !passing.under_way && std::abs(robot.y) > 0.9) {
      passing.under_way = true;
      passing.entered = robot.y;
    } else if (passing.under_way && !beside) {
      passing.under_way = false;
      if (robot.y * passing.entered < 0.0 && std::abs(robot.y) > 0.9) {
        passing.waits = true;
        passing.until = seen.cycle + 40;
      }
    }
    if ((passing.under_way || passing.waits) && !passing.found)
      for (const lps::Percept& percept : percepts)
        if (percept.type == PointType::door && door_at(in_world(percept), percept.width) == &door &&
            seen.cycle - percept.seen < 60)
          passing.found = true;
    if (passing.waits && (passing.found || seen.cycle >= passing.until)) {
      ++passed_;
      found_ += passing.found ? 1 : 0;
      passing = {};
    }
  }
}

Count Score::count(PointType type) const {
  Count count;
  for (const auto& [id, judged] : judged_)
    if (judged.type == type) {
      ++count.reported;
      count.real += judged.real ? 1 : 0;
    }
  return count;
}

std::vector<Vec2> patrol(const std::string& world) {
  if (world == "office-floor")
    return {{17.5, 7.2},  {35.5, 7.0},  {25.6, 7.0}, {25.6, 25.0}, {17.5, 25.0},
            {11.0, 25.0}, {17.5, 25.0}, {17.5, 7.0}, {2.5, 7.0},   {17.5, 7.0}};
  if (world == "loop")
    return {{24.0, 2.0}, {24.0, 16.0}, {2.0, 16.0}, {2.0, 2.0}};
  if (world == "visitors" || world == "small-office")
    return {{9.6, 4.4}, {1.4, 4.4}};
  if (world == "cluttered")
    return {{2.0, 4.5}, {5.5, 4.7}, {7.4, 4.7}, {9.3, 5.2}, {7.4, 4.7}, {5.5, 4.7},
            {4.1, 5.5}, {3.9, 7.0}, {4.1, 5.5}, {2.0, 4.5}, {1.3, 2.5}};
  return {};
}

maps::Map map_of(const std::string& world) {
  return maps::load_map(find_file(config_folder() + "/maps", world, ".map"));
}

}  // namespace saphira::test
