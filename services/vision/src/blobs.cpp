#include "saphira/vision/blobs.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::vision {
namespace {

constexpr int kLeast = 4;            // [pixels] of area: smaller ones are noise
constexpr double kPixelError = 0.7;  // one sigma, of an edge
constexpr double kUncertain = 0.3;   // of the range: above it the range counts as unknown
constexpr double kNearest = 0.1;     // [m]
constexpr double kSomewhere = 2.0;   // [m] where the range is unknown
constexpr double kFarthest = 10.0;   // [m]

struct Range {
  double range = 0.0;
  double sigma = 0.0;
};

// By the angle from the horizon down to the foot.
std::optional<Range> by_foot(const Patch& patch, const ColorCamera& camera) {
  if (patch.height == 0)
    return std::nullopt;
  const double foot = patch.y - patch.height / 2.0;
  if (foot <= -camera.rows / 2.0 + 1.0 || foot >= -1.0)
    return std::nullopt;  // cut off by the picture's edge, or not below the horizon
  const double range = camera.height / std::tan(-foot * camera.pixel);
  return Range{range, range * range / camera.height * kPixelError * camera.pixel};
}

std::optional<Range> by_size(const Patch& patch, double height, const ColorCamera& camera) {
  const double half = patch.height / 2.0;
  if (patch.height < 2 || patch.y + half >= camera.rows / 2.0 - 1.0 ||
      patch.y - half <= -camera.rows / 2.0 + 1.0)
    return std::nullopt;
  const double range = height / (std::tan((patch.y + half) * camera.pixel) -
                                 std::tan((patch.y - half) * camera.pixel));
  return Range{range, range * range / height * 1.4 * kPixelError * camera.pixel};
}

}  // namespace

std::vector<Sight> find_blobs(const Channels& channels, const ColorCamera& camera) {
  std::vector<Sight> sights;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Patch& patch = channels[i];
    if (patch.area < kLeast)
      continue;
    const auto range =
        camera.heights[i] ? by_size(patch, *camera.heights[i], camera) : by_foot(patch, camera);
    Sight sight;
    sight.kind = lps::SeenThing::Kind::blob;
    sight.channel = static_cast<int>(i);
    sight.area = std::min(1.0, static_cast<double>(patch.area) / camera.columns / camera.rows);
    sight.range_known = range && range->sigma < kUncertain * range->range &&
                        range->range > kNearest && range->range < kFarthest;
    const double far = sight.range_known ? range->range : kSomewhere;
    const double bearing = -(patch.x + 0.5) * camera.pixel;
    // The range is along the floor, in the direction of the patch.
    sight.place_in_robot =
        Vec2(camera.forward, 0.0) + far * Vec2(std::cos(bearing), std::sin(bearing));
    sight.sigma_range = sight.range_known ? 0.03 + range->sigma : kSomewhere;
    sight.sigma_across = 0.02 + far * 2.0 * camera.pixel;
    if (sight.range_known) {
      sight.width = 2.0 * far * std::tan(patch.width * camera.pixel / 2.0);
      sight.height = camera.heights[i].value_or(
          camera.height + far * std::tan((patch.y + patch.height / 2.0) * camera.pixel));
    }
    sights.push_back(sight);
  }
  return sights;
}

bool in_view(const ColorCamera& camera, const Vec2& place_in_robot) {
  const Vec2 from_eye = place_in_robot - Vec2(camera.forward, 0.0);
  return std::abs(std::atan2(from_eye.y(), from_eye.x())) <
             (camera.columns / 2.0 - 3.0) * camera.pixel &&
         from_eye.norm() < kFarthest / 2.0;
}

}  // namespace saphira::vision
