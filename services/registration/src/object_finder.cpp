#include "saphira/registration/object_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/maps/topology.hpp"

namespace saphira::registration {
namespace {

using lps::PointType;
using maps::Feature;

Vec2 middle_of(const std::vector<Look>& looks) {
  Vec2 sum(0.0, 0.0);
  for (const Look& look : looks)
    sum += look.end();
  return sum / static_cast<double>(looks.size());
}

/// Without the most distant twentieth at either end.
std::pair<double, double> extent(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 20;
  return {values[cut], values[values.size() - 1 - cut]};
}

}  // namespace

/// Candidates on the map get their ids; those removed from it are dropped.
void ObjectFinder::follow_map(const maps::Map& map) {
  for (Candidate& candidate : candidates_) {
    if (!candidate.told || candidate.told->id != 0)
      continue;
    for (const Feature& feature : map.features)
      if (feature.type == PointType::object && feature.learned &&
          feature.pose_in_map == candidate.told->pose_in_map)
        candidate.told->id = feature.id;
  }
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    return candidate.told && maps::find(map, candidate.told->id) == nullptr;
  });
}

/// The object of an echo from there: preferably one on the map. New echoes join it.
ObjectFinder::Candidate* ObjectFinder::candidate_at(const Vec2& position) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (std::any_of(candidates_[i].met.begin(), candidates_[i].met.end(), [&](const Look& look) {
          return (look.end() - position).norm() < settings_.same;
        }))
      near.push_back(i);
  if (near.empty())
    return nullptr;
  const auto told = std::find_if(near.begin(), near.end(),
                                 [&](std::size_t i) { return candidates_[i].told.has_value(); });
  std::size_t home = told == near.end() ? near.front() : *told;
  for (auto it = near.rbegin(); it != near.rend(); ++it) {
    if (*it == home || candidates_[*it].told)
      continue;
    const Candidate other = std::move(candidates_[*it]);
    candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(*it));
    home -= *it < home ? 1U : 0U;
    Candidate& one = candidates_[home];
    for (const Look& look : other.met)
      if (take_look(one.from, look.sensor_in_map, settings_.spacing))
        one.met.push_back(look);
    one.through += other.through;
    one.first = std::min(one.first, other.first);
    one.last = std::max(one.last, other.last);
  }
  return &candidates_[home];
}

/// True where a feature of the map may explain the echo, from anywhere in the cone.
bool ObjectFinder::is_explained(const maps::Map& map, const Field& field, const Look& look,
                                std::uint32_t own) const {
  if (!field.known(look.end()))
    return true;
  for (const double off : {0.0, -1.0, 1.0}) {
    const double bearing = look.sensor_in_map.th + off * settings_.beam;
    const Vec2 end =
        look.sensor_in_map.position() + look.range * Vec2(std::cos(bearing), std::sin(bearing));
    if (field.distance(end) < settings_.off)
      return true;
  }
  const Vec2 end = look.end();
  return std::any_of(map.features.begin(), map.features.end(), [&](const Feature& feature) {
    const bool counts =
        feature.type == PointType::object ? feature.id != own : maps::traits(feature.type).gate;
    return counts && maps::distance_to(feature, end) < settings_.off;
  });
}

/// An echo from behind a candidate shows that nothing stands there any more.
void ObjectFinder::look_through(const Look& look, const Candidate* met) {
  for (Candidate& candidate : candidates_) {
    if (&candidate == met || candidate.told)
      continue;
    const Vec2 to = to_frame(look.sensor_in_map, middle_of(candidate.met));
    if (to.x() > 0.0 && std::abs(to.y()) < settings_.least / 2.0 &&
        look.range > to.x() + settings_.same + settings_.least)
      ++candidate.through;
  }
}

bool ObjectFinder::is_thing(const Candidate& candidate) const {
  if (candidate.from.size() < settings_.looks ||
      candidate.last < candidate.first + settings_.time ||
      2 * candidate.through > candidate.from.size())
    return false;
  double span = 0.0;
  for (const Pose& pose : candidate.from)
    span = std::max(span, (pose.position() - candidate.from.front().position()).norm());
  return span >= settings_.span;
}

/// Aligned with the nearest wall, as objects indoors. A cone meets an object before its axis does,
/// and meets its faces only; the rest is behind them.
Feature ObjectFinder::outline(const Candidate& candidate, const Field& field) const {
  const Field::Nearest wall = field.nearest(middle_of(candidate.met));
  Feature thing;
  thing.type = PointType::object;
  thing.learned = true;
  thing.id = candidate.told ? candidate.told->id : 0;
  const double along = std::atan2(wall.towards.y(), wall.towards.x()) + kPi / 2.0;
  thing.pose_in_map.th = norm2_angle(2.0 * along) / 2.0;
  const Vec2 axes[2] = {thing.pose_in_map.direction(),
                        {-std::sin(thing.pose_in_map.th), std::cos(thing.pose_in_map.th)}};
  Vec2 middle(0.0, 0.0);
  double sizes[2];
  for (int i = 0; i < 2; ++i) {
    std::vector<double> values;
    double wide = 0.0;
    double seen_along = 0.0;
    for (const Look& look : candidate.met) {
      const Vec2 ahead = look.sensor_in_map.direction();
      values.push_back(look.end().dot(axes[i]));
      seen_along += ahead.dot(axes[i]) / static_cast<double>(candidate.met.size());
      wide += look.range * std::tan(settings_.beam) * (1.0 - std::abs(ahead.dot(axes[i]))) /
              static_cast<double>(candidate.met.size());
    }
    auto [low, high] = extent(std::move(values));
    const double off = std::min(wide, (high - low) / 2.0);
    low += off;
    high -= off;
    if (const double less = settings_.least - (high - low); less > 0.0) {
      const double behind = std::clamp(0.5 + seen_along, 0.0, 1.0);
      low -= (1.0 - behind) * less;
      high += behind * less;
    }
    middle += (low + high) / 2.0 * axes[i];
    sizes[i] = high - low;
  }
  thing.pose_in_map.x = middle.x();
  thing.pose_in_map.y = middle.y();
  thing.length = sizes[0];
  thing.width = sizes[1];
  return thing;
}

std::vector<Feature> ObjectFinder::step(const maps::Map& map, const Field& field,
                                        std::uint64_t cycle, const std::vector<Look>& looks) {
  follow_map(map);
  std::vector<Feature> news;
  for (const Look& look : looks) {
    if (!look.echo)
      continue;
    Candidate* candidate = look.range > settings_.range ? nullptr : candidate_at(look.end());
    look_through(look, candidate);
    if (look.range > settings_.range ||
        is_explained(map, field, look,
                     candidate != nullptr && candidate->told ? candidate->told->id : 0))
      continue;
    if (candidate == nullptr) {
      if (candidates_.size() >= settings_.candidates)
        continue;
      candidate = &candidates_.emplace_back();
      candidate->first = cycle;
    }
    candidate->last = cycle;
    if (!take_look(candidate->from, look.sensor_in_map, settings_.spacing))
      continue;
    candidate->met.push_back(look);
    while (candidate->met.size() > settings_.kept) {
      candidate->met.erase(candidate->met.begin());
      candidate->from.erase(candidate->from.begin());
    }
    std::optional<Feature>& told = candidate->told;
    if ((told && told->id == 0) || !is_thing(*candidate))
      continue;
    const Feature thing = outline(*candidate, field);
    if (std::max(thing.length, thing.width) > settings_.most)
      continue;
    if (told &&
        (thing.pose_in_map.position() - told->pose_in_map.position()).norm() < settings_.clearer &&
        std::abs(thing.length - told->length) < settings_.clearer &&
        std::abs(thing.width - told->width) < settings_.clearer)
      continue;
    told = thing;
    news.push_back(thing);
  }
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    return !candidate.told &&
           (candidate.last + settings_.patience < cycle ||
            (candidate.through > 3 && 2 * candidate.through > candidate.from.size()));
  });
  return news;
}

}  // namespace saphira::registration
