#include "saphira/registration/presence.hpp"

#include <optional>

#include "saphira/geometry/clip.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::registration {
namespace {

using lps::PointType;
using maps::Feature;

constexpr double kMoved = 0.2;      // [m] a larger displacement is another object
constexpr double kOnTheWall = 0.3;  // [m] distance of an opening in a wall

/// The checked kinds of artifacts.
enum class Kind { none, thing, door };

Kind kind_of(const Feature& feature) {
  if (feature.id == 0)
    return Kind::none;
  const maps::ArtifactTraits& of_type = maps::traits(feature.type);
  using Missing = maps::ArtifactTraits::Missing;
  if (of_type.missing == Missing::stays ||
      (of_type.missing == Missing::learned && !feature.learned))
    return Kind::none;
  return of_type.gate ? Kind::door : Kind::thing;
}

/// The path of a sonar's axis through a rectangle [m]; nothing where it misses the rectangle made
/// smaller by `inside` on each side.
std::optional<Stretch> path_through(const Feature& box, const Pose& sensor, double inside) {
  const ToFrame to_box(box.pose_in_map);
  const Vec2 from = to_box(sensor.position());
  const Vec2 way = to_box(sensor.position() + sensor.direction()) - from;
  const Vec2 half(box.length / 2.0, box.width / 2.0);
  const Vec2 core = (0.3 * half).cwiseMax(half - Vec2(inside, inside));
  const auto path = clip(from, way, half);
  if (!path || path->from <= 0.0 || !clip(from, way, core))
    return std::nullopt;
  return path;
}

/// A wall as a box of 0.1 m.
Feature slab(const Feature& wall) {
  Feature slab = wall;
  slab.width = 0.1;
  return slab;
}

bool is_opening(const Feature& feature) {
  return feature.type == PointType::door || feature.type == PointType::breach ||
         feature.type == PointType::junction;
}

/// True where the map has an opening there.
bool in_an_opening(const maps::Map& map, const Vec2& at) {
  return std::any_of(map.features.begin(), map.features.end(), [&](const Feature& feature) {
    return is_opening(feature) && (feature.pose_in_map.position() - at).norm() <
                                      std::max(feature.length, feature.width) / 2.0 + kOnTheWall;
  });
}

}  // namespace

Presence::Watched& Presence::watch(const Feature& feature) {
  Watched& watched = watched_[feature.id];
  if (watched.feature.type != feature.type ||
      (watched.feature.pose_in_map.position() - feature.pose_in_map.position()).norm() > kMoved)
    watched = Watched{};
  watched.feature = feature;
  return watched;
}

void Presence::look_at(Watched& watched, const Look& look, const maps::Map& map) {
  const Feature& feature = watched.feature;
  const bool wall = feature.type == PointType::wall;
  const auto path =
      path_through(wall ? slab(feature) : feature, look.sensor_in_map, settings_.inside);
  if (!path || path->from > settings_.range)
    return;
  // A wall at a slant deflects the sound, and an echo may come from behind it.
  if (wall && (std::abs(std::sin(look.sensor_in_map.th - feature.pose_in_map.th)) <
                   std::cos(settings_.facing) ||
               in_an_opening(map, look.sensor_in_map.position() +
                                      path->from * look.sensor_in_map.direction())))
    return;
  if (look.range > path->to + settings_.behind) {
    take_look(watched.through, look.sensor_in_map, settings_.spacing);
  } else if (std::abs(look.range - path->from) < settings_.near &&
             take_look(watched.at, look.sensor_in_map, settings_.spacing) &&
             watched.at.size() > 2 * watched.through.size()) {
    // The object is there; count later looks through it anew.
    watched.through.clear();
    watched.at.clear();
  }
}

void Presence::look_at_door(Watched& watched, const Look& look, std::uint64_t cycle) {
  const Pose in_door = relative(watched.feature.pose_in_map, look.sensor_in_map);
  const double ahead = std::cos(in_door.th);
  if (in_door.x * ahead >= 0.0 || std::abs(ahead) < std::cos(settings_.slanted))
    return;
  const double way = -in_door.x / ahead;
  const double aside = std::abs(in_door.y + way * std::sin(in_door.th));
  if (way > settings_.range || aside + way * std::tan(settings_.beam) > watched.feature.width / 2.0)
    return;
  const bool open = look.range > way + settings_.door_behind;
  const bool closed = way < settings_.door_range &&
                      std::abs(look.range - way) < settings_.door_near &&
                      std::abs(ahead) > std::cos(settings_.facing);
  if (!open && !closed)
    return;
  // One look that disagrees makes the state doubtful.
  if (watched.score != 0 && open != (watched.score > 0)) {
    watched.score = 0;
    watched.agreeing.clear();
  }
  if (!take_look(watched.agreeing, look.sensor_in_map, settings_.door_spacing) &&
      cycle < watched.counted + settings_.again)
    return;
  watched.counted = cycle;
  watched.score += open ? 1 : -1;
  if (std::abs(watched.score) >= settings_.door_looks) {
    watched.score = open ? settings_.door_looks : -settings_.door_looks;
    watched.agreeing.clear();
  }
}

Presence::Changes Presence::step(const maps::Map& map, std::uint64_t cycle,
                                 const Vec2& robot_in_map, const std::vector<Look>& looks,
                                 const std::vector<std::uint32_t>& seen) {
  Changes changes;
  for (const Feature& feature : map.features) {
    const Kind kind = kind_of(feature);
    if (kind == Kind::none)
      continue;
    const bool is_seen = std::find(seen.begin(), seen.end(), feature.id) != seen.end();
    const double size = Vec2(feature.length, feature.width).norm() / 2.0;
    if (!is_seen &&
        (feature.pose_in_map.position() - robot_in_map).norm() > settings_.range + size + 0.5)
      continue;
    Watched& watched = watch(feature);
    if (is_seen)
      watched.score = settings_.door_looks;
    for (const Look& look : looks) {
      // Silence is no evidence: the object may have deflected the sound.
      if (!look.echo)
        continue;
      if (kind == Kind::door)
        look_at_door(watched, look, cycle);
      else
        look_at(watched, look, map);
    }
    if (kind == Kind::thing
            ? passed(watched)
            : feature.type == PointType::breach && watched.score == -settings_.door_looks) {
      changes.gone.push_back(feature.id);
      watched_.erase(feature.id);
    } else if (watched.score == -settings_.door_looks && closed_.insert(feature.id).second) {
      changes.closed.push_back(feature.id);
    } else if (watched.score == settings_.door_looks && closed_.erase(feature.id) != 0) {
      changes.opened.push_back(feature.id);
    }
  }
  // An artifact that is not on the map any more is no change.
  if (!closed_.empty())
    std::erase_if(closed_, [&](std::uint32_t id) { return maps::find(map, id) == nullptr; });
  return changes;
}

}  // namespace saphira::registration
