#include "saphira/maps/edit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "saphira/base/numbers.hpp"
#include "saphira/maps/artifact_traits.hpp"

namespace saphira::maps {

using lps::PointType;

std::optional<std::string> problem(const Feature& feature) {
  // A wall has no id in a file; here it may have one.
  Feature written = feature;
  written.id = traits(feature.type).id ? std::max(1U, feature.id) : 0;
  try {
    to_text({{written}});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return std::nullopt;
}

std::optional<std::string> problem(const Pose& pose_in_map) {
  if (!problem(Feature{PointType::position, 1, pose_in_map, 0.0, 0.0, ""}))
    return std::nullopt;
  return "expected a place within 10 km [m] of the map's origin and a heading [rad], got " +
         plain(pose_in_map.x) + ", " + plain(pose_in_map.y) + ", " + plain(pose_in_map.th);
}

bool same(const Feature& a, const Feature& b, const Sameness& sameness) {
  if (a.type != b.type)
    return false;
  const Pose between = relative(a.pose_in_map, b.pose_in_map);
  if (traits(a.type).straight) {
    // A line has no direction.
    const double angle = std::abs(norm3_angle(between.th));
    return angle < sameness.angle && std::abs(between.y) < sameness.distance &&
           std::abs(between.x) < (a.length + b.length) / 2;
  }
  const bool directed = traits(a.type).gate;
  return std::hypot(between.x, between.y) < sameness.distance &&
         (!directed || std::abs(between.th) < sameness.angle);
}

Editor::Editor(Map map) : map_(std::move(map)) {
  number();
}

void Editor::number() {
  for (const Feature& feature : map_.features)
    last_id_ = std::max(last_id_, feature.id);
  for (Feature& feature : map_.features)
    if (feature.id == 0)
      feature.id = ++last_id_;
}

std::size_t Editor::index_of(std::uint32_t id) const {
  const auto found = std::find_if(map_.features.begin(), map_.features.end(),
                                  [&](const Feature& f) { return f.id == id && id != 0; });
  return static_cast<std::size_t>(found - map_.features.begin());
}

std::uint32_t Editor::add(Feature feature) {
  const std::uint32_t id =
      feature.id == 0 || find(map_, feature.id) != nullptr || gone_.contains(feature.id)
          ? last_id_ + 1
          : feature.id;
  feature.id = id;
  if (const auto why = problem(feature))
    throw std::invalid_argument(*why);
  last_id_ = std::max(last_id_, id);
  map_.features.push_back(std::move(feature));
  ++revision_;
  return id;
}

bool Editor::change(std::uint32_t id, Feature feature) {
  const std::size_t index = index_of(id);
  if (index == map_.features.size())
    return false;
  feature.id = id;
  if (feature.type != map_.features[index].type)
    throw std::invalid_argument("expected another id than " + std::to_string(id) +
                                ", or a change of " + describe(map_.features[index]) +
                                ", which has it");
  if (const auto why = problem(feature))
    throw std::invalid_argument(*why);
  if (map_.features[index] == feature)
    return true;
  map_.features[index] = std::move(feature);
  ++revision_;
  return true;
}

bool Editor::remove(std::uint32_t id) {
  const std::size_t index = index_of(id);
  if (index == map_.features.size())
    return false;
  gone_.insert(id);
  map_.features.erase(map_.features.begin() + static_cast<std::ptrdiff_t>(index));
  ++revision_;
  return true;
}

void Editor::replace(Map map) {
  for (const Feature& feature : map_.features)
    if (find(map, feature.id) == nullptr)
      gone_.insert(feature.id);
  map_ = std::move(map);
  number();
  ++revision_;
}

}  // namespace saphira::maps
