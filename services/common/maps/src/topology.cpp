#include "saphira/maps/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/geometry/clip.hpp"

namespace saphira::maps {

namespace {

using lps::PointType;

// Corridors of a map end at the near wall of the corridor that they meet, or at the far one. Drawn
// by hand, or built by a robot, they may miss it by this [m].
constexpr double kReach = 0.6;
// [m] The lanes over a free floor are near to all of it (explore::FreeFloor).
constexpr double kBesideLane = 2.0;
// At a smaller angle two corridors follow one another and have no crossing [rad].
constexpr double kParallel = radians(30.0);
// Distances behind and before a door at which its regions are searched [m]: first near, to find a
// thin room, then farther, since walls have a thickness.
constexpr std::array<double, 4> kProbes{0.15, 0.3, 0.6, 1.0};

Vec2 middle(const std::vector<Vec2>& polygon) {
  Vec2 sum(0.0, 0.0);
  for (const Vec2& corner : polygon)
    sum += corner;
  return sum / static_cast<double>(polygon.size());
}

// A junction where the middle lines of two corridors cross, or would if they were a little longer.
std::optional<Feature> crossing(const Feature& a, const Feature& b) {
  const double angle = norm2_angle(b.pose_in_map.th - a.pose_in_map.th);
  if (std::abs(norm3_angle(angle)) < kParallel)
    return std::nullopt;
  const Vec2 u = a.pose_in_map.direction();
  const Vec2 v = b.pose_in_map.direction();
  const Vec2 between = b.pose_in_map.position() - a.pose_in_map.position();
  const double along_a = cross(between, v) / cross(u, v);
  const double along_b = cross(between, u) / cross(u, v);
  if (std::abs(along_a) > a.length / 2 + b.width / 2 + kReach ||
      std::abs(along_b) > b.length / 2 + a.width / 2 + kReach)
    return std::nullopt;
  Feature junction;
  junction.type = PointType::junction;
  const Vec2 at = a.pose_in_map.position() + along_a * u;
  junction.pose_in_map = {at.x(), at.y(), a.pose_in_map.th};
  junction.length = b.width;
  junction.width = a.width;
  return junction;
}

}  // namespace

bool same_places(const Map& a, const Map& b) {
  const auto next = [](auto it, auto end) {
    return std::find_if(it, end, [](const Feature& feature) {
      return feature.type != PointType::object && feature.type != PointType::wall &&
             feature.type != PointType::zone;
    });
  };
  auto i = next(a.features.begin(), a.features.end());
  auto k = next(b.features.begin(), b.features.end());
  for (; i != a.features.end() && k != b.features.end() && *i == *k;
       i = next(i + 1, a.features.end()), k = next(k + 1, b.features.end())) {
  }
  return i == a.features.end() && k == b.features.end();
}

std::vector<Vec2> corners(const Feature& feature, double margin) {
  const double l = feature.length / 2 + margin;
  const double w = feature.width / 2 + margin;
  return {transform(feature.pose_in_map, {-l, -w}), transform(feature.pose_in_map, {l, -w}),
          transform(feature.pose_in_map, {l, w}), transform(feature.pose_in_map, {-l, w})};
}

std::optional<std::string> outside(const Map& map, const Vec2& position, double margin) {
  if (map.features.empty())
    return std::nullopt;
  Vec2 low = map.features.front().pose_in_map.position();
  Vec2 high = low;
  for (const Feature& feature : map.features)
    for (const Vec2& corner : corners(feature)) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  const Vec2 edge(margin, margin);
  if ((position - (low - edge)).minCoeff() >= 0.0 && ((high + edge) - position).minCoeff() >= 0.0)
    return std::nullopt;
  const auto text = [](const Vec2& p) {
    return "(" + decimal(p.x(), 1) + ", " + decimal(p.y(), 1) + ")";
  };
  return "expected a place on the map, which goes from " + text(low) + " to " + text(high) +
         " m, got " + text(position);
}

// Sutherland and Hodgman 1974: cut by one edge after the other.
std::vector<Vec2> overlap(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  std::vector<Vec2> rest = a;
  for (std::size_t i = 0; i < b.size() && !rest.empty(); ++i) {
    const Vec2 from = b[i];
    const Vec2 along = b[(i + 1) % b.size()] - from;
    std::vector<Vec2> kept;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const Vec2 p = rest[k];
      const Vec2 q = rest[(k + 1) % rest.size()];
      const double side_p = cross(along, p - from);
      const double side_q = cross(along, q - from);
      if (side_p >= 0.0)
        kept.push_back(p);
      if ((side_p > 0.0 && side_q < 0.0) || (side_p < 0.0 && side_q > 0.0))
        kept.emplace_back(p + (q - p) * (side_p / (side_p - side_q)));
    }
    rest = std::move(kept);
  }
  return rest.size() < 3 ? std::vector<Vec2>{} : rest;
}

Vec2 begin_of(const Feature& feature) {
  return transform(feature.pose_in_map, {-feature.length / 2, 0.0});
}

Vec2 end_of(const Feature& feature) {
  return transform(feature.pose_in_map, {feature.length / 2, 0.0});
}

Vec2 on_axis(const Feature& feature, const Vec2& position, double margin) {
  const double half = std::max(0.0, feature.length / 2 - margin);
  const double x = to_frame(feature.pose_in_map, position).x();
  return transform(feature.pose_in_map, {std::clamp(x, -half, half), 0.0});
}

double length_inside(const Feature& feature, const Vec2& from, const Vec2& to, double margin) {
  const Vec2 a = to_frame(feature.pose_in_map, from);
  const Vec2 way = to_frame(feature.pose_in_map, to) - a;
  const Vec2 half(feature.length / 2 + margin, feature.width / 2 + margin);
  const auto inside = clip(a, way, half, {0.0, 1.0});
  return inside ? (inside->to - inside->from) * way.norm() : 0.0;
}

double distance_to(const Feature& feature, const Vec2& position) {
  return Rectangle(feature).distance(position);
}

Topology::Topology(const Map& map) {
  std::vector<Feature> gates;
  for (const Feature& feature : map.features) {
    const ArtifactTraits& of_type = traits(feature.type);
    if (of_type.region)
      regions_.push_back({*of_type.region, feature, {}});
    else if (of_type.gate)
      gates.push_back(feature);
    else if (feature.type == PointType::position)
      positions_.push_back(feature);
    else if (feature.type == PointType::wall)
      walls_.push_back(feature);
  }
  const std::size_t of_map = regions_.size();
  for (std::size_t a = 0; a < of_map; ++a)
    for (std::size_t b = a + 1; b < of_map; ++b) {
      if (regions_[a].kind != RegionKind::corridor || regions_[b].kind != RegionKind::corridor)
        continue;
      const auto junction = crossing(regions_[a].area, regions_[b].area);
      if (!junction)
        continue;
      const bool known = std::any_of(regions_.begin(), regions_.end(), [&](const Region& region) {
        return region.kind == RegionKind::junction &&
               distance_to(region.area, junction->pose_in_map.position()) < kReach;
      });
      if (!known)
        regions_.push_back({RegionKind::junction, *junction, {}});
    }
  for (const Region& region : regions_)
    boxes_.emplace_back(region.area);
  for (std::size_t a = 0; a < regions_.size(); ++a)
    for (std::size_t b = a + 1; b < regions_.size(); ++b)
      meet(a, b);
  for (const Feature& gate : gates)
    open(gate, gate.type == PointType::door ? LinkKind::door : LinkKind::opening);
}

void Topology::join(Link link) {
  regions_[link.a].links.push_back(links_.size());
  if (link.b)
    regions_[*link.b].links.push_back(links_.size());
  links_.push_back(link);
}

// Two regions that are beside one another without a door between them.
void Topology::meet(std::size_t a, std::size_t b) {
  if (regions_[b].kind == RegionKind::corridor ||
      (regions_[a].kind == RegionKind::room && regions_[b].kind == RegionKind::junction))
    std::swap(a, b);
  const Region& first = regions_[a];
  const Region& second = regions_[b];
  const bool room = first.kind == RegionKind::room || second.kind == RegionKind::room;
  const bool lane = first.area.type == PointType::lane || second.area.type == PointType::lane;
  if (first.kind == RegionKind::junction && second.kind == RegionKind::junction)
    return;
  // A wall divides a room from its neighbour, unless both are the same room. A lane is a way
  // through a room.
  if (room && !lane &&
      (first.kind != second.kind || first.area.name.empty() || first.area.name != second.area.name))
    return;
  const bool crossed =
      !room && first.kind == second.kind && crossing(first.area, second.area).has_value();
  if (crossed && !lane)
    return;  // by their junction
  // Side by side, corridors have a wall between them.
  if (first.kind == RegionKind::corridor && second.kind == RegionKind::corridor && !lane &&
      std::abs(relative(first.area.pose_in_map, second.area.pose_in_map).y) >
          std::max(first.area.width, second.area.width) / 2)
    return;
  const double margin = room ? 0.05 : kReach / 2;
  const auto common = overlap(corners(first.area, margin), corners(second.area, margin));
  if (common.empty())
    return;
  Vec2 at = middle(common);
  if (first.kind == RegionKind::corridor && second.kind == RegionKind::junction)
    at = on_axis(first.area, second.area.pose_in_map.position());
  join({LinkKind::meeting, 0, {at.x(), at.y(), 0.0}, 0.0, a, b, {}});
}

void Topology::open(const Feature& gate, LinkKind kind) {
  // The normal points to the corridor's side.
  const auto probe = [&](double sign, std::optional<std::size_t> other) {
    for (const double far : kProbes) {
      std::optional<std::size_t> found;
      for (const std::size_t region : at(transform(gate.pose_in_map, {sign * far, 0.0}))) {
        // The target behind a door is hardly ever the junction of two corridors.
        const bool better = !found || (regions_[*found].kind == RegionKind::junction &&
                                       regions_[region].kind == RegionKind::corridor);
        if (region != other && better)
          found = region;
      }
      if (found)
        return found;
    }
    return std::optional<std::size_t>{};
  };
  Link link{kind, gate.id, gate.pose_in_map, gate.width, 0, std::nullopt, gate.name};
  const auto front = probe(1.0, std::nullopt);
  const auto back = probe(-1.0, front);
  if (!front && !back)
    return;  // a door of nothing that the map knows
  if (front) {
    link.a = *front;
    link.b = back;
  } else {
    link.a = *back;
    link.pose_in_map.th = norm2_angle(gate.pose_in_map.th + kPi);
  }
  join(link);
}

std::vector<std::size_t> Topology::at(const Vec2& position_in_map) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < regions_.size(); ++i)
    if (boxes_[i].contains(position_in_map))
      found.push_back(i);
  return found;
}

/// True where a wall of the map is between.
bool Topology::walled(const Vec2& from_in_map, const Vec2& to_in_map) const {
  return std::any_of(walls_.begin(), walls_.end(), [&](const Feature& wall) {
    const Vec2 from = to_frame(wall.pose_in_map, from_in_map);
    const Vec2 to = to_frame(wall.pose_in_map, to_in_map);
    return from.y() * to.y() < 0.0 &&
           std::abs(from.x() + (to.x() - from.x()) * from.y() / (from.y() - to.y())) <
               wall.length / 2;
  });
}

std::optional<std::size_t> Topology::region_at(const Vec2& position_in_map,
                                               double tolerance) const {
  const auto rank = [&](std::size_t i) {
    return regions_[i].kind == RegionKind::junction   ? 0
           : regions_[i].kind == RegionKind::corridor ? 1
                                                      : 2;
  };
  std::optional<std::size_t> best;
  double nearest = 0.0;
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const Feature& area = regions_[i].area;
    const double far = boxes_[i].distance(position_in_map);
    const bool beside = tolerance > 0.0 && area.type == PointType::lane && far < kBesideLane &&
                        !walled(position_in_map, on_axis(area, position_in_map));
    if (far > tolerance && !beside)
      continue;
    if (!best || far < nearest || (far == nearest && rank(i) < rank(*best))) {
      best = i;
      nearest = far;
    }
  }
  return best;
}

std::string Topology::no_place(std::string_view name) const {
  constexpr std::size_t kShown = 10;
  std::vector<std::string> names;
  const auto add = [&](const std::string& known) {
    if (!known.empty() && std::find(names.begin(), names.end(), known) == names.end())
      names.push_back(known);
  };
  for (const Region& region : regions_)
    add(region.area.name);
  for (const Feature& position : positions_)
    add(position.name);
  for (const Link& link : links_)
    add(link.name);
  // A map that the robot built has no names.
  const auto add_id = [&](std::string known) {
    std::replace(known.begin(), known.end(), ' ', '-');
    add(known);
  };
  for (std::size_t i = 0; i < regions_.size(); ++i)
    if (regions_[i].area.id != 0 && regions_[i].area.name.empty())
      add_id(text(i));
  for (const Link& link : links_)
    if (link.id != 0 && link.name.empty() && !link.b)
      add_id(text(link));
  std::string out = "the map has no place \"" + std::string(name) + '"';
  if (const std::string meant = did_you_mean(name, names); !meant.empty())
    return out + meant;
  out += names.empty() ? ", and none that has a name" : ": it has ";
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    out += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kShown)
    out += " and " + std::to_string(names.size() - kShown) + " more (saphira map show)";
  return out;
}

std::optional<Place> Topology::place(std::string_view name_or_id) const {
  if (name_or_id.empty())
    return std::nullopt;
  if (const auto named = place_called(name_or_id))
    return named;
  // "door 12" or "door-12".
  if (constexpr std::string_view article = "the "; name_or_id.starts_with(article))
    return place(name_or_id.substr(article.size()));
  const std::size_t blank = name_or_id.find_last_of(" -");
  if (blank == std::string_view::npos)
    return std::nullopt;
  auto by_id = place_called(name_or_id.substr(blank + 1));
  const std::string meant =
      lowered(name_or_id.substr(0, blank)) + " " + std::string(name_or_id.substr(blank + 1));
  if (by_id && (by_id->name == meant || by_id->name.starts_with(meant + " ")))
    return by_id;
  return std::nullopt;
}

std::optional<Place> Topology::place_called(std::string_view name_or_id) const {
  const std::uint32_t id = number_in<std::uint32_t>(name_or_id).value_or(0);

  const auto search = [&](const auto& meant) -> std::optional<Place> {
    Place place;
    for (std::size_t i = 0; i < regions_.size(); ++i)
      if (meant(regions_[i].area))
        place.regions.push_back(i);
    if (!place.regions.empty()) {
      place.name = text(place.regions.front());
      return place;
    }
    for (const Feature& position : positions_) {
      if (!meant(position))
        continue;
      place.regions = at(position.pose_in_map.position());
      place.point = position.pose_in_map.position();
      place.name = "position " + std::to_string(position.id);
      if (!position.name.empty())
        place.name += " (" + position.name + ")";
      return place;
    }
    for (const Link& link : links_) {
      if (!meant(link))
        continue;
      place.regions = {link.a};
      place.point = transform(link.pose_in_map, {0.6, 0.0});
      place.name = text(link);
      return place;
    }
    return std::nullopt;
  };

  if (id != 0)
    if (auto found = search([&](const auto& artifact) { return artifact.id == id; }))
      return found;
  if (auto found = search([&](const auto& artifact) { return artifact.name == name_or_id; }))
    return found;
  const std::string small = lowered(name_or_id);
  return search([&](const auto& artifact) { return lowered(artifact.name) == small; });
}

std::string Topology::text(const Link& link) {
  return (link.kind == LinkKind::door ? "door " : "opening ") + std::to_string(link.id);
}

std::string Topology::text(std::size_t region) const {
  const Feature& area = regions_[region].area;
  std::string out = area.type == PointType::corridor ? "corridor"
                    : area.type == PointType::lane   ? "lane"
                    : area.type == PointType::office ? "room"
                                                     : "junction";
  if (area.id != 0)
    out += " " + std::to_string(area.id);
  if (!area.name.empty())
    out += " (" + area.name + ")";
  return out;
}

}  // namespace saphira::maps
