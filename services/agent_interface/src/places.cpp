// The part of the dialogue for places: what names, "this office", "here" and a pointing arm stand
// for.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "saphira/agent_interface/pointing.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kDoorInSight = 5.0;  // [m] "this office" is no farther

bool is_room(lps::PointType type) {
  return type == lps::PointType::office;
}

/// The direction of a point, seen from the robot.
std::string direction_of(const Vec2& from_robot) {
  const double angle =
      std::atan2(from_robot.y(), from_robot.x()) / std::numbers::pi * 180.0;  // [deg] left: > 0
  const std::string side = angle > 0.0 ? "left" : "right";
  const double off = std::abs(angle);
  return off < 22.5    ? "ahead of me"
         : off < 67.5  ? "ahead of me on the " + side
         : off < 112.5 ? "on my " + side
         : off < 157.5 ? "behind me on the " + side
                       : "behind me";
}

/// A name in the letters of the text that it is from.
std::string as_said(const std::string& name, const std::string& text) {
  const std::size_t at = lowered(text).rfind(name);
  return at == std::string::npos ? name : text.substr(at, name.size());
}

/// The corridor around the robot; or the room, otherwise the nearest doorway. Of a corridor and a
/// doorway, the one at which a person points.
const maps::Feature* feature_at(const maps::Map& map, const Vec2& position,
                                const std::optional<Pose>& arm, bool corridor) {
  if (corridor && arm)
    return area_at(map, *arm, true);
  for (const maps::Feature& feature : map.features)
    if ((corridor ? feature.type == lps::PointType::corridor : is_room(feature.type)) &&
        feature.width > 0.0 && maps::contains(feature, position))
      return &feature;
  return corridor ? nullptr
         : arm    ? doorway_at(map, *arm)
                  : nearest_door(map, position, kDoorInSight);
}

}  // namespace

const maps::Feature* nearest_door(const maps::Map& map, const Vec2& position, double within,
                                  const std::function<bool(const maps::Feature&)>& fits) {
  const maps::Feature* nearest = nullptr;
  for (const maps::Feature& feature : map.features) {
    const double distance = (feature.pose_in_map.position() - position).norm();
    if (feature.type != lps::PointType::door || distance >= within || !fits(feature))
      continue;
    nearest = &feature;
    within = distance;
  }
  return nearest;
}

std::string here(const Situation& situation) {
  return situation.pose_in_map ? place_at(situation.map, situation.pose_in_map->position())
                               : std::string();
}

std::string place_at(const maps::Map& map, const Vec2& position) {
  std::string corridor;
  for (const maps::Feature& feature : map.features) {
    if (feature.name.empty() || feature.width <= 0.0 || !maps::contains(feature, position))
      continue;
    if (is_room(feature.type))
      return feature.name;
    if (corridor.empty() && feature.type == lps::PointType::corridor)
      corridor = feature.name;
  }
  return corridor;
}

std::string way_to(const std::string& place, const Situation& situation) {
  if (place.empty() || !situation.pose_in_map)
    return place.empty() ? "" : place + " is on my map, but I do not know where I am on it";
  const Pose& robot = *situation.pose_in_map;
  if (place_at(situation.map, robot.position()) == place)
    return "I am in " + place;
  std::optional<Vec2> nearest;
  for (const maps::Feature& feature : situation.map.features) {
    const Vec2 from_robot = to_frame(robot, feature.pose_in_map.position());
    if (feature.name == place && (!nearest || from_robot.norm() < nearest->norm()))
      nearest = from_robot;
  }
  if (!nearest)
    return {};
  const long meters = std::lround(nearest->norm());
  return place + " is " +
         (meters < 1 ? std::string("less than a meter")
                     : "about " + std::to_string(meters) + (meters == 1 ? " meter" : " meters")) +
         " away, " + direction_of(*nearest);
}

std::string Dialogue::place(const std::string& name, const Situation& situation) const {
  for (const maps::Feature& feature : situation.map.features)
    if (!feature.name.empty() && lowered(feature.name) == name)
      return feature.name;
  return {};
}

std::string Dialogue::place_or_person(const std::string& name, const Situation& situation) const {
  const std::string known = place(name, situation);
  return known.empty() ? name : known;
}

std::string Dialogue::owner_in(const std::string& name) const {
  for (const char* const room : {" office", " room"}) {
    if (!name.ends_with(room))
      continue;
    std::string owner = name.substr(0, name.size() - std::string_view(room).size());
    if (knowledge_.knows(owner))
      return owner;
    if (owner.ends_with('s') && knowledge_.knows(owner.substr(0, owner.size() - 1)))
      return owner.substr(0, owner.size() - 1);
  }
  return {};
}

/// The destination "here" of things to bring. A corridor is long: there it is the speaker's own
/// place, if its doorway is near.
std::string Dialogue::bring_to(const Utterance& utterance, const Situation& situation) const {
  const std::string own =
      place(lowered(knowledge_.place_of(lowered(utterance.speaker))), situation);
  if (!situation.pose_in_map)
    return own;
  const Vec2 robot = situation.pose_in_map->position();
  const bool in_room = std::any_of(
      situation.map.features.begin(), situation.map.features.end(),
      [&](const maps::Feature& one) { return is_room(one.type) && maps::contains(one, robot); });
  const bool near = !own.empty() && nearest_door(situation.map, robot, kDoorInSight,
                                                 [&](const maps::Feature& door) {
                                                   return door.name == own;
                                                 }) != nullptr;
  const std::string place = here(situation);
  return place.empty() || (near && !in_room) ? own : place;
}

std::string Dialogue::referred(const Meaning& meaning, const Situation& situation, Outputs& out,
                               std::uint32_t& artifact, std::string& wrong) const {
  const std::string name = slot(meaning, "place");
  const std::string written = place(name, situation).empty() ? owner_in(name) : std::string();
  const std::string owner = written.empty() ? slot(meaning, "owner") : written;
  const std::string side = slot(meaning, "side");
  if (!owner.empty()) {
    const Advice* const office = knowledge_.find(Advice::Kind::office_of, owner);
    if (office == nullptr)
      wrong = "nobody has told me where " + owner + "'s office is";
    return office == nullptr ? std::string() : office->value;
  }
  if (side.empty() && name != "this" && !name.empty()) {
    const std::string known = place(name, situation);
    if (known.empty()) {
      std::vector<std::string> names;
      for (const maps::Feature& feature : situation.map.features)
        if (!feature.name.empty())
          names.push_back(lowered(feature.name));
      const std::string meant = guess(name, names);
      wrong = "I know no place called " + name +
              (meant.empty() ? "" : "; do you mean " + place(meant, situation) + "?");
    }
    return known;
  }
  if (!situation.pose_in_map) {
    wrong = kLost;
    return {};
  }
  // "This office" is the nearest doorway (paper 4.5), or before that the room around the robot. A
  // person may point at a doorway or area (paper 4.2).
  const Pose& robot = *situation.pose_in_map;
  const std::optional<Pose>& arm = situation.pointing_in_map;
  if (meaning.functor != "office_of") {
    const maps::Feature* const area = arm ? area_at(situation.map, *arm, false) : nullptr;
    const std::string name_here = area != nullptr ? area->name : here(situation);
    if (name_here.empty())
      wrong = "where I am has no name on the map";
    return name_here;
  }
  if (side.empty())
    for (const maps::Feature& feature : situation.map.features)
      if (is_room(feature.type) && !feature.name.empty() &&
          maps::contains(feature, robot.position())) {
        artifact = feature.id;
        return feature.name;
      }
  const bool points = arm && side.empty();
  const maps::Feature* const nearest =
      points ? doorway_at(situation.map, *arm)
             : nearest_door(situation.map, robot.position(), kDoorInSight,
                            [&](const maps::Feature& door) {
                              const double left = to_frame(robot, door.pose_in_map.position()).y();
                              return side.empty() || (side == "left" ? left > 0.0 : left < 0.0);
                            });
  if (nearest == nullptr) {
    wrong = points         ? "I know no doorway where you point"
            : side.empty() ? "I know no doorway here"
                           : "I know no doorway here on the " + side;
    return {};
  }
  artifact = nearest->id;
  if (!nearest->name.empty())
    return nearest->name;
  out.namings.push_back(*nearest);
  out.namings.back().name = slot(meaning, "person") + "'s office";
  return out.namings.back().name;
}

/// A name for the nameless room, doorway or corridor at the robot. A name that the map has stays.
bool Dialogue::naming(const Meaning& meaning, const Utterance& utterance,
                      const Situation& situation, Outputs& out) {
  if (meaning.functor != "name_of")
    return false;
  const std::string name = as_said(slot(meaning, "name"), utterance.text);
  const bool corridor = slot(meaning, "kind") == "corridor";
  const std::string known = place(lowered(name), situation);
  if (!situation.pose_in_map) {
    refuse(utterance, kLost, out);
    return true;
  }
  const maps::Feature* const feature = feature_at(situation.map, situation.pose_in_map->position(),
                                                  situation.pointing_in_map, corridor);
  if (feature == nullptr) {
    refuse(utterance,
           std::string("I know no ") + (corridor ? "corridor" : "room or doorway") +
               (situation.pointing_in_map ? " where you point" : " here"),
           out);
  } else if (feature->name == known && !known.empty()) {
    say(utterance, "I know: this is " + feature->name, true, out);
  } else if (!feature->name.empty()) {
    refuse(utterance, "on my map this is " + feature->name, out);
  } else if (!known.empty()) {
    refuse(utterance, "my map has " + known + " at another place", out);
  } else {
    out.namings.push_back(*feature);
    out.namings.back().name = name;
    say(utterance, "I put it on my map: this is " + name, true, out);
  }
  return true;
}

}  // namespace saphira::agent_interface
