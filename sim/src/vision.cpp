#include "saphira/sim/vision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saphira::sim {

namespace {

// An object on the floor, in one direction of view.
struct Layer {
  double range = 0.0;   // [m]
  double height = 0.0;  // [m] of its top
  const std::string* color = nullptr;
};

const std::string kNoColor;

// Walls and things within the range of a viewer.
class View {
 public:
  View(const Scene& scene, RobotNumber self, const Vec2& eye, double range)
      : range_(range), eye_(eye) {
    for (const Segment& segment : scene.world().segments)
      add(segment, kWallHeight, kNoColor);
    for (const Door& door : scene.doors())
      add(scene.leaf(door), door.plan->look.height, door.plan->look.color);
    for (const Box& box : scene.boxes())
      for (const Segment& side : scene.sides(box))
        add(side, box.plan->look.height, box.plan->look.color);
    for (const Person& person : scene.persons())
      add(Disc{person.at, person.plan->radius}, person.plan->look.height, person.plan->look.color);
    for (const PostPlan& post : scene.world().movable.posts)
      add(Disc{post.at, post.radius}, post.look.height, post.look.color);
    for (RobotNumber i = 0; i < scene.robots(); ++i)
      if (i != self)
        add(Disc{scene.robot(i).pose_in_world().position(), scene.robot(i).radius()}, kRobotHeight,
            kNoColor);
  }

  /// All objects in a direction, the nearest first, up to a wall.
  const std::vector<Layer>& along(const Vec2& direction) {
    layers_.clear();
    for (const auto& [segment, layer] : segments_) {
      one_.segments.assign(1, segment);
      one_.discs.clear();
      meet(direction, layer);
    }
    for (const auto& [disc, layer] : discs_) {
      one_.segments.clear();
      one_.discs.assign(1, disc);
      meet(direction, layer);
    }
    std::ranges::stable_sort(layers_,
                             [](const Layer& a, const Layer& b) { return a.range < b.range; });
    return layers_;
  }

 private:
  // No robot of this project is much higher.
  static constexpr double kRobotHeight = 0.3;

  void add(const Segment& segment, double height, const std::string& color) {
    if ((nearest_point(segment, eye_) - eye_).norm() < range_)
      segments_.push_back({segment, {0.0, height, &color}});
  }
  void add(const Disc& disc, double height, const std::string& color) {
    if ((disc.centre - eye_).norm() < range_ + disc.radius)
      discs_.push_back({disc, {0.0, height, &color}});
  }
  void meet(const Vec2& direction, const Layer& layer) {
    if (const auto hit = cast_ray(one_, eye_, direction, range_)) {
      layers_.push_back(layer);
      layers_.back().range = *hit;
    }
  }

  double range_;
  Vec2 eye_;
  std::vector<std::pair<Segment, Layer>> segments_;
  std::vector<std::pair<Disc, Layer>> discs_;
  Things one_;
  std::vector<Layer> layers_;
};

// Rows from `low` to `high`, above the middle of the picture.
struct Strip {
  int low = 0;
  int high = 0;
};

// The pixels of a blob.
struct Patch {
  long area = 0;
  long x = 0;
  long y = 0;  // in half pixels
  int first = 0;
  int last = 0;
  int low = std::numeric_limits<int>::max();
  int high = std::numeric_limits<int>::min();
};

}  // namespace

std::optional<Blob> see_blob(const Scene& scene, RobotNumber robot, const Camera& camera,
                             std::string_view color) {
  const Pose eye = compose(scene.robot(robot).pose_in_world(), camera.pose_in_robot);
  View view(scene, robot, eye.position(), camera.range);
  const int half = camera.rows / 2;
  const auto row = [&](double height, double range) {
    return static_cast<int>(std::lround(std::atan2(height - camera.height, range) / camera.pixel));
  };
  Patch best;
  Patch patch;
  for (int column = 0; column < camera.columns; ++column) {
    const int x = column - camera.columns / 2;
    const double th = eye.th - (x + 0.5) * camera.pixel;
    int hidden = -half;  // rows below this are hidden by nearer objects
    std::vector<Strip> strips;
    for (const Layer& layer : view.along({std::cos(th), std::sin(th)})) {
      const int low = std::max(hidden, row(0.0, layer.range));
      const int high = std::min(half, row(layer.height, layer.range));
      if (high > low && *layer.color == color)
        strips.push_back({low, high});
      hidden = std::max(hidden, high);
    }
    if (strips.empty()) {
      patch = {};
      continue;
    }
    if (patch.area == 0)
      patch.first = x;
    patch.last = x;
    for (const Strip& strip : strips) {
      const int rows = strip.high - strip.low;
      patch.area += rows;
      patch.x += static_cast<long>(rows) * x;
      patch.y += static_cast<long>(rows) * (strip.high + strip.low);
      patch.low = std::min(patch.low, strip.low);
      patch.high = std::max(patch.high, strip.high);
    }
    if (patch.area > best.area)
      best = patch;
  }
  if (best.area == 0)
    return std::nullopt;
  const auto area = static_cast<double>(best.area);
  return Blob{static_cast<int>(std::lround(static_cast<double>(best.x) / area)),
              static_cast<int>(std::lround(static_cast<double>(best.y) / area / 2.0)),
              static_cast<int>(best.area), best.last - best.first + 1, best.high - best.low};
}

}  // namespace saphira::sim
