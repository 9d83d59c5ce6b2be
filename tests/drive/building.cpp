#include "drive/building.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "saphira/lps/point.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::test {

namespace {

constexpr std::uint64_t kLook = 50;  // [cycles] between two looks at the graph

WholeOptions from_nothing(const DriveOptions& drive) {
  return WholeOptions{.drive = drive, .map = "none"};
}

}  // namespace

Building::Building(const DriveOptions& options)
    : whole(from_nothing(options)), goal_(whole.ask("build-map")) {}

void Building::run(std::uint64_t limit, const std::function<void()>& each) {
  for (std::uint64_t i = 0; i < limit && !whole.ended(goal_); ++i) {
    whole.advance();
    note();
    if (each)
      each();
  }
}

void Building::note() {
  odom_and_truth_.emplace_back(whole.drive().seen().pose_in_odom, whole.truth().position());
  const registration::MapBuilder* const builder = whole.drive().registration().builder();
  if (builder == nullptr)
    return;
  worst = std::max(worst, (whole.truth().position() - whole.believed().position()).norm());
  closures = builder->closures();
  if (whole.cycle() % kLook != 0)
    return;
  way_ = {};
  auto at = odom_and_truth_.begin();
  for (const registration::GraphNode& node : builder->graph().nodes) {
    const auto same = std::find_if(at, odom_and_truth_.end(),
                                   [&](const auto& one) { return one.first == node.in_odom; });
    if (same == odom_and_truth_.end())
      continue;
    at = same;
    way_.believed.push_back(node.in_map.position());
    way_.truth.push_back(same->second);
  }
}

maps::Map Building::aligned_map() const {
  const auto count = static_cast<double>(way_.truth.size());
  Vec2 believed{0.0, 0.0};
  Vec2 truth{0.0, 0.0};
  for (std::size_t i = 0; i < way_.truth.size(); ++i) {
    believed += way_.believed[i] / count;
    truth += way_.truth[i] / count;
  }
  Vec2 turn{0.0, 0.0};
  for (std::size_t i = 0; i < way_.truth.size(); ++i) {
    const Vec2 from = way_.believed[i] - believed;
    const Vec2 to = way_.truth[i] - truth;
    turn += Vec2(from.dot(to), from.x() * to.y() - from.y() * to.x());
  }
  const Pose turned{0.0, 0.0, std::atan2(turn.y(), turn.x())};
  const Vec2 moved = truth - transform(turned, believed);
  const Pose map_in_world{moved.x(), moved.y(), turned.th};
  maps::Map map = whole.map();
  for (maps::Feature& feature : map.features)
    feature.pose_in_map = compose(map_in_world, feature.pose_in_map);
  return map;
}

void Building::draw(const std::string& name) const {
  const char* folder = std::getenv("SAPHIRA_DRAW_TO");
  if (folder == nullptr)
    return;
  maps::Drawing drawing;
  drawing.map = whole.map();
  drawing.title = name + ", built by driving";
  for (const sim::Segment& wall : whole.drive().world().segments) {
    drawing.lines.push_back(wall.from);
    drawing.lines.push_back(wall.to);
  }
  drawing.trajectories = {{"true", way_.truth}, {"believed", way_.believed}};
  const std::string file = std::string(folder) + "/" + name;
  std::ofstream(file + ".svg") << maps::to_svg(drawing);
  std::ofstream(file + ".map") << maps::to_text(whole.map());
}

MapScore score(const maps::Map& built, const maps::Map& reference) {
  using lps::PointType;
  MapScore score;
  std::vector<bool> used(built.features.size(), false);
  for (const maps::Feature& corridor : reference.features) {
    if (corridor.type != PointType::corridor)
      continue;
    ++score.corridors;
    double best = 1e9;
    for (std::size_t i = 0; i < built.features.size(); ++i) {
      const maps::Feature& f = built.features[i];
      if (f.type != PointType::corridor)
        continue;
      const Pose in = relative(corridor.pose_in_map, f.pose_in_map);
      if (std::abs(norm3_angle(in.th)) > radians(4.0) || std::abs(in.y) > 0.4 ||
          std::abs(f.width - corridor.width) > 0.3 ||
          std::abs(in.x) > (f.length + corridor.length) / 2)
        continue;
      used[i] = true;
      double off = 0.0;
      for (const double sign : {1.0, -1.0}) {
        const double end = sign * corridor.length / 2;
        const double d = in.x + sign * f.length / 2 - end;
        const Vec2 at = transform(corridor.pose_in_map, {end, 0.0});
        double least = std::abs(d);
        for (const maps::Feature& j : reference.features)
          if (j.type == PointType::junction && maps::distance_to(j, at) < 0.1)
            for (const double square : {j.length, -j.length})
              least = std::min(least, std::abs(d - square));
        off += least;
      }
      best = std::min(best, off / corridor.length);
    }
    if (best < 1.0)
      score.worst_length = std::max(score.worst_length, best);
    if (best <= 0.03)
      ++score.corridors_found;
    else
      score.text += " corridor " + std::to_string(corridor.id) + " by " + std::to_string(best);
  }
  for (std::size_t i = 0; i < built.features.size(); ++i)
    if (built.features[i].type == PointType::corridor && !used[i] &&
        std::none_of(reference.features.begin(), reference.features.end(), [&](const auto& room) {
          // An aisle between shelves is one, too.
          return room.type == PointType::office &&
                 maps::contains(room, built.features[i].pose_in_map.position());
        })) {
      ++score.corridors_false;
      score.text += " false corridor " + std::to_string(built.features[i].id);
    }
  std::vector<bool> real(built.features.size(), false);
  for (const maps::Feature& door : reference.features) {
    if (door.type != PointType::door)
      continue;
    ++score.doors;
    bool found = false;
    for (std::size_t i = 0; i < built.features.size(); ++i) {
      const maps::Feature& f = built.features[i];
      const Pose in = relative(door.pose_in_map, f.pose_in_map);
      if (f.type == PointType::door && std::hypot(in.x, in.y) < 0.3 &&
          std::abs(in.th) < radians(15.0) && std::abs(f.width - door.width) < 0.4)
        real[i] = found = true;
    }
    if (found)
      ++score.doors_found;
    else
      score.text += " door " + std::to_string(door.id);
  }
  for (std::size_t i = 0; i < built.features.size(); ++i)
    if (built.features[i].type == PointType::door && !real[i]) {
      ++score.doors_false;
      score.text += " false door " + std::to_string(built.features[i].id);
    }
  return score;
}

}  // namespace saphira::test
