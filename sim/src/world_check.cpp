#include "world_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saphira/base/format.hpp"

namespace saphira::sim {

namespace {

// The least distance from a wall: half of its thickness.
constexpr double kInWall = 0.02;  // [m]
// A door's hinge and its latch are in walls.
constexpr double kFrame = 0.05;  // [m]
// Boxes and posts may stand against a wall.
constexpr double kAgainst = 0.005;  // [m]

std::string metres(const Vec2& point) {
  return format("(%.0f, %.0f)", point.x() * 1000.0, point.y() * 1000.0);
}

const Segment* wall_across(const World& world, const Segment& way) {
  for (const Segment& wall : world.segments)
    if (intersect(way, wall))
      return &wall;
  return nullptr;
}

std::optional<std::string> outside(const World& world, const Vec2& point) {
  if (point.x() >= 0.0 && point.y() >= 0.0 && point.x() <= world.width && point.y() <= world.height)
    return std::nullopt;
  return "expected a place in the world of " + metres({world.width, world.height}) + " mm, found " +
         metres(point);
}

// The place of a person, or of a person's target.
std::optional<std::string> trouble_of_place(const World& world, const Vec2& point) {
  if (const auto trouble = outside(world, point))
    return trouble;
  if (distance(world.segments, point) < kInWall)
    return "expected a place that is not in a wall, found " + metres(point);
  for (const PostPlan& post : world.movable.posts)
    if ((post.at - point).norm() < post.radius)
      return "expected a place that is not in the post \"" + post.look.name + "\", found " +
             metres(point);
  for (const BoxPlan& box : world.movable.boxes) {
    const Vec2 inside = to_frame(box.pose_in_world, point);
    if (std::abs(inside.x()) < box.length / 2.0 && std::abs(inside.y()) < box.width / 2.0)
      return "expected a place that is not in the box \"" + box.look.name + "\", found " +
             metres(point);
  }
  return std::nullopt;
}

std::optional<std::string> trouble_of_way(const World& world, const Vec2& from, const Vec2& to) {
  if (const Segment* wall = wall_across(world, {from, to}))
    return "expected a way that leads through no wall: from " + metres(from) + " to " + metres(to) +
           " stands the wall from " + metres(wall->from) + " to " + metres(wall->to);
  if (from != to)
    for (const PostPlan& post : world.movable.posts)
      if ((nearest_point(Segment{from, to}, post.at) - post.at).norm() < post.radius)
        return "expected a way that leads through no post: from " + metres(from) + " to " +
               metres(to) + " stands \"" + post.look.name + "\"";
  return std::nullopt;
}

}  // namespace

std::optional<std::string> trouble_of_start(const World& world, const Pose& start_in_world) {
  return trouble_of_place(world, start_in_world.position());
}

std::optional<std::string> trouble_of_person(const World& world, std::size_t person) {
  return trouble_of_place(world, world.movable.persons[person].at);
}

std::optional<std::string> trouble_of_leg(const World& world, std::size_t person,
                                          std::size_t number) {
  const PersonPlan& plan = world.movable.persons[person];
  Vec2 from = plan.at;
  for (std::size_t i = 0; i < number; ++i)
    if (plan.script[i].speed > 0.0)
      from = plan.script[i].to;
  if (const auto trouble = trouble_of_place(world, plan.script[number].to))
    return trouble;
  return trouble_of_way(world, from, plan.script[number].to);
}

std::optional<std::string> trouble_of_repeat(const World& world, std::size_t person) {
  const PersonPlan& plan = world.movable.persons[person];
  const auto walks = [](const PersonPlan::Leg& leg) { return leg.speed > 0.0; };
  const auto first = std::ranges::find_if(plan.script, walks);
  const auto last = std::find_if(plan.script.rbegin(), plan.script.rend(), walks);
  if (first == plan.script.end())
    return std::nullopt;
  return trouble_of_way(world, last->to, first->to);
}

std::optional<std::string> trouble_of_door(const World& world, std::size_t number) {
  const DoorPlan& door = world.movable.doors[number];
  for (const Vec2& end : {door.hinge, door.end})
    if (const auto trouble = outside(world, end))
      return trouble;
  const Vec2 frame = (door.end - door.hinge).normalized() * kFrame;
  if (const Segment* wall = wall_across(world, {door.hinge + frame, door.end - frame}))
    return "expected a door that no wall crosses, found the wall from " + metres(wall->from) +
           " to " + metres(wall->to);
  return std::nullopt;
}

std::optional<std::string> trouble_of_box(const World& world, std::size_t number) {
  const BoxPlan& box = world.movable.boxes[number];
  const double x = box.length / 2.0 - kAgainst;
  const double y = box.width / 2.0 - kAgainst;
  const std::array<Vec2, 4> corners{
      transform(box.pose_in_world, Vec2(x, y)), transform(box.pose_in_world, Vec2(-x, y)),
      transform(box.pose_in_world, Vec2(-x, -y)), transform(box.pose_in_world, Vec2(x, -y))};
  for (const Vec2& corner : corners)
    if (const auto trouble = outside(world, corner))
      return trouble;
  for (std::size_t i = 0; i < 4; ++i) {
    if (const Segment* wall = wall_across(world, {corners[i], corners[(i + 1) % 4]}))
      return "expected a box that stands in no wall, found the wall from " + metres(wall->from) +
             " to " + metres(wall->to);
  }
  return std::nullopt;
}

std::optional<std::string> trouble_of_post(const World& world, std::size_t number) {
  const PostPlan& post = world.movable.posts[number];
  if (const auto trouble = outside(world, post.at))
    return trouble;
  if (distance(world.segments, post.at) < post.radius - kAgainst)
    return "expected a post that stands in no wall, found one at " + metres(post.at);
  return std::nullopt;
}

}  // namespace saphira::sim
