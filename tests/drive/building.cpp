#include "drive/building.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "saphira/lps/point.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::test {

Building::Building(const DriveOptions& options, registration::MapBuilderSettings building)
    : drive(options),
      interpretation(with_sonars<interpretation::Settings>(drive)),
      builder(with_sonars(drive, std::move(building)), {}, drive.seen().true_pose_in_world),
      explorer(with_sonars<explore::Settings>(drive)) {}

void Building::perceive() {
  const Seen& seen = drive.advance();
  const auto& output = interpretation.step({seen.cycle, seen.pose_in_odom, seen.readings});
  builder.step({seen.cycle, 1, seen.pose_in_odom, output.percepts, seen.readings, std::nullopt});
  true_way.push_back(seen.true_pose_in_world.position());
  if (true_nodes_.size() < builder.graph().nodes.size())
    true_nodes_.push_back(true_way.back());
  worst = std::max(worst, (true_way.back() - builder.pose_in_map().position()).norm());
}

bool Building::advance() {
  perceive();
  const Seen& seen = drive.seen();
  const Pose& believed = builder.pose_in_map();
  const std::string before = explorer.output().reason;
  const std::vector<Vec2> way = builder.way();
  const explore::Output& order =
      explorer.step({seen.cycle, believed, builder.map(), way, seen.readings});
  if (order.point_in_map)
    drive.go_to(transform(seen.pose_in_odom, to_frame(believed, *order.point_in_map)), order.speed);
  else if (order.look_at)
    drive.turn_to(seen.pose_in_odom.th + lps::phi({to_frame(believed, *order.look_at).x(),
                                                   to_frame(believed, *order.look_at).y(), 0.0}));
  else
    drive.stop();
  if (std::getenv("SAPHIRA_TALK") != nullptr && order.reason != before)
    std::cout << seen.cycle << " at " << true_way.back().transpose() << ", believed "
              << believed.position().transpose() << ": " << order.reason << std::endl;
  return !order.done;
}

void Building::run(std::uint64_t limit, const std::function<void(Building&)>& each) {
  const std::uint64_t end = drive.seen().cycle + limit;
  while (drive.seen().cycle < end && advance())
    if (each)
      each(*this);
}

bool Building::drive_to(const Vec2& point_in_map, std::uint64_t limit) {
  for (std::uint64_t i = 0; i < limit; ++i) {
    perceive();
    const Pose& believed = builder.pose_in_map();
    if ((point_in_map - believed.position()).norm() < 0.35)
      return true;
    drive.go_to(transform(drive.seen().pose_in_odom, to_frame(believed, point_in_map)));
  }
  return false;
}

maps::Map Building::aligned_map() const {
  const std::vector<registration::GraphNode>& nodes = builder.graph().nodes;
  const auto count = static_cast<double>(true_nodes_.size());
  Vec2 believed{0.0, 0.0};
  Vec2 truth{0.0, 0.0};
  for (std::size_t i = 0; i < true_nodes_.size(); ++i) {
    believed += nodes[i].in_map.position() / count;
    truth += true_nodes_[i] / count;
  }
  Vec2 turn{0.0, 0.0};
  for (std::size_t i = 0; i < true_nodes_.size(); ++i) {
    const Vec2 from = nodes[i].in_map.position() - believed;
    const Vec2 to = true_nodes_[i] - truth;
    turn += Vec2(from.dot(to), from.x() * to.y() - from.y() * to.x());
  }
  const Pose turned{0.0, 0.0, std::atan2(turn.y(), turn.x())};
  const Vec2 moved = truth - transform(turned, believed);
  const Pose map_in_world{moved.x(), moved.y(), turned.th};
  maps::Map map = builder.map();
  for (maps::Feature& feature : map.features)
    feature.pose_in_map = compose(map_in_world, feature.pose_in_map);
  return map;
}

void Building::draw(const std::string& name) const {
  const char* folder = std::getenv("SAPHIRA_DRAW_TO");
  if (folder == nullptr)
    return;
  maps::Drawing drawing;
  drawing.map = builder.map();
  drawing.title = name + ", built by driving";
  for (const sim::Segment& wall : drive.world().segments) {
    drawing.lines.push_back(wall.from);
    drawing.lines.push_back(wall.to);
  }
  drawing.trajectories = {{"true", true_way}, {"believed", builder.way()}};
  const std::string file = std::string(folder) + "/" + name;
  std::ofstream(file + ".svg") << maps::to_svg(drawing);
  std::ofstream(file + ".map") << maps::to_text(builder.map());
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
