// The part of the dialogue for places: what names, "this office", "here" and a pointing arm stand
// for.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "saphira/agent_interface/pointing.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/maps/artifact_traits.hpp"
#include "saphira/maps/zones.hpp"
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

/// A name of a room, a way or a position. Nobody goes to zones, walls and things.
bool is_place(const maps::Feature& feature) {
  const maps::ArtifactTraits& traits = maps::traits(feature.type);
  return !feature.name.empty() &&
         (traits.region || traits.gate || feature.type == lps::PointType::position);
}

/// A name as it is heard: "EJ-231", "EJ 231" and "ej231" are one.
std::string letters_of(std::string_view name) {
  std::string letters = lowered(name);
  std::erase_if(letters, [](char c) { return c == '-' || c == '_' || blank(c); });
  return letters;
}

/// The number of a room as people say it: "231", "room 231", "number 231". Empty: no such words.
std::string room_number(const std::string& name) {
  std::vector<std::string> words = words_of(name);
  while (words.size() > 1 &&
         (words.front() == "room" || words.front() == "office" || words.front() == "number"))
    words.erase(words.begin());
  return words.size() == 1 && words.front().find_first_not_of("0123456789") == std::string::npos
             ? words.front()
             : std::string();
}

/// The only name that shares a word with the said one, as "EJ-231" with "number 231". Empty: none,
/// or several.
std::string only_with_word_of(const std::string& said, const std::vector<std::string>& names) {
  const auto parts = [](std::string name) {
    std::replace(name.begin(), name.end(), '-', ' ');
    return words_of(name);
  };
  const std::vector<std::string> wanted = parts(said);
  std::string found;
  for (const std::string& name : names) {
    const std::vector<std::string> words = parts(name);
    if (std::find_first_of(words.begin(), words.end(), wanted.begin(), wanted.end()) == words.end())
      continue;
    if (!found.empty())
      return {};
    found = name;
  }
  return found;
}

/// A name in the letters of the text that it is from.
std::string as_said(const std::string& name, const std::string& text) {
  for (std::size_t at = text.size(); at-- > 0;)
    for (std::size_t size = 1; size <= 2 * name.size() && at + size <= text.size(); ++size)
      if (lowered(std::string_view(text).substr(at, size)) == name)
        return text.substr(at, size);
  return name;
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

const maps::Feature* nearest_of(const std::string& place, const Situation& situation) {
  const maps::Feature* nearest = nullptr;
  const auto way = [&](const maps::Feature& one) {
    return (one.pose_in_map.position() - situation.pose_in_map->position()).norm();
  };
  for (const maps::Feature& feature : situation.map.features)
    if (feature.name == place && (nearest == nullptr || way(feature) < way(*nearest)))
      nearest = &feature;
  return nearest;
}

std::string way_to(const std::string& place, const Situation& situation) {
  if (place.empty() || !situation.pose_in_map)
    return place.empty() ? "" : place + " is on my map, but I do not know where I am on it";
  const Pose& robot = *situation.pose_in_map;
  if (place_at(situation.map, robot.position()) == place)
    return "I am in " + place;
  const maps::Feature* const spot = nearest_of(place, situation);
  if (spot == nullptr)
    return {};
  const Vec2 nearest = to_frame(robot, spot->pose_in_map.position());
  const long meters = std::lround(nearest.norm());
  return place + " is " +
         (meters < 1 ? std::string("less than a meter")
                     : "about " + std::to_string(meters) + (meters == 1 ? " meter" : " meters")) +
         " away, " + direction_of(nearest);
}

std::string Dialogue::place(const std::string& name, const Situation& situation) const {
  const auto same = [&](const auto& form) -> std::string {
    for (const maps::Feature& feature : situation.map.features)
      if (is_place(feature) && form(feature.name) == form(name))
        return feature.name;
    return {};
  };
  std::string known = same(lowered);
  if (known.empty())
    known = same(letters_of);
  if (const std::string digits = in_digits(name); known.empty() && digits != name)
    return place(digits, situation);
  const Advice* const thing = knowledge_.find(Advice::Kind::person_at, "the " + name);
  if (known.empty() && thing != nullptr)
    return place(lowered(thing->value), situation);
  for (const std::string_view kind : {"room ", "office "})
    if (known.empty() && name.starts_with(kind))
      return place(name.substr(kind.size()), situation);
  const std::string number = room_number(name);
  if (!known.empty() || number.empty())
    return known;
  for (const maps::Feature& feature : situation.map.features)
    if (is_place(feature) && feature.name != known && feature.name.ends_with("-" + number)) {
      if (!known.empty())
        return {};  // two buildings have that number
      known = feature.name;
    }
  return known;
}

bool Dialogue::findable(const std::string& person, const Situation& situation) const {
  return knowledge_.findable(person) ||
         std::find(situation.findable.begin(), situation.findable.end(), person) !=
             situation.findable.end();
}

bool Dialogue::is_known(const std::string& name, const Situation& situation) const {
  return findable(name, situation) || !place(name, situation).empty() ||
         (!name.empty() && name == lowered(situation.asked_for));
}

std::string Dialogue::unknown(const std::string& name, bool people, const Situation& situation,
                              Outputs& out) const {
  constexpr std::size_t kShown = 4;
  std::vector<std::string> names;
  const auto add = [&](const std::string& one) {
    if (std::find(names.begin(), names.end(), one) == names.end())
      names.push_back(one);
  };
  // Numbers of offices say less than names, and corridors less than rooms.
  const auto rank = [](const maps::Feature& one) {
    const bool numbered = one.name.find_first_of("0123456789") != std::string::npos;
    return one.type == lps::PointType::corridor ? 2 : numbered ? 1 : 0;
  };
  for (int i = 0; i < 3; ++i)
    for (const maps::Feature& feature : situation.map.features)
      if (is_place(feature) && rank(feature) == i)
        add(feature.name);
  const std::size_t places = names.size();
  if (people) {
    for (const Advice& one : knowledge_.all())
      if (one.kind != Advice::Kind::hazard && knowledge_.findable(one.about))
        add(one.about);
    for (const std::string& one : situation.findable)
      add(one);
  }
  std::string meant = guess(name, names);
  if (meant.empty())
    meant = only_with_word_of(name, names);
  out.unknown = {name, meant, people};
  std::string text =
      std::string("I know no place ") + (people ? "or person " : "") + "called " + name;
  if (!meant.empty())
    return text + "; do you mean " + meant + "?";
  if (places == 0)
    return text + ": no map with names has come yet";
  names.resize(places);
  text += ", but " + saphira::joined(std::vector(
                         names.begin(),
                         names.begin() + static_cast<std::ptrdiff_t>(std::min(places, kShown))));
  if (places > kShown)
    text += " and " + std::to_string(places - kShown) + " more";
  return text + (people ? ". Which one, or where is " + name + "?" : ". Which one?");
}

maps::RouteResult Dialogue::allowed_way(const std::string& place,
                                        const Situation& situation) const {
  if (place.empty() || !situation.pose_in_map)
    return {};
  const maps::Topology floor(situation.map);
  maps::RouteSettings settings;
  const Claimed rules = hazards(wanted_.empty() ? tasks_.open() : wanted_);
  settings.zones = maps::all_zones(situation.map, floor, rules.value, rules.source);
  return maps::find_route(floor, situation.pose_in_map->position(), place, settings);
}

std::string Dialogue::kept_out(const std::string& place, const Situation& situation) const {
  const maps::Topology floor(situation.map);
  for (const Advice& one : knowledge_.all()) {
    if (one.kind != Advice::Kind::hazard || one.value != place)
      continue;
    const std::vector<maps::Zone> zones =
        maps::all_zones(maps::Map{}, floor, one.about + " at " + one.value);
    if (zones.empty() || zones.front().rule != maps::ZoneRule::keep_out)
      continue;
    const bool rule = maps::zone_rule(one.about).has_value();
    return describe(one) + ": " + source_of(one) + ". When I may go there, say \"" +
           (rule ? "you may go to " + place : "the " + one.about + " at " + place + " is gone") +
           "\"";
  }
  const maps::RouteResult allowed = allowed_way(place, situation);
  return allowed.route || !situation.pose_in_map ||
                 !maps::find_route(floor, situation.pose_in_map->position(), place).route
             ? std::string()
             : allowed.reason;
}

std::string Dialogue::hindrance(const WantedGoal& goal, const Situation& situation,
                                Outputs& out) const {
  constexpr std::array kStanding{"stop", "pause", "look"};
  if (!situation.estop.empty() &&
      std::find(kStanding.begin(), kStanding.end(), goal.functor) == kStanding.end())
    return "the emergency stop is pressed, by " + situation.estop +
           ": saphira estop reset releases it";
  constexpr std::array kPlacesAndPeople{"place", "from", "to", "person", "name"};
  if (std::none_of(situation.map.features.begin(), situation.map.features.end(), is_place))
    return {};  // no map has come
  for (const Argument& one : goal.arguments) {
    if (std::find(kPlacesAndPeople.begin(), kPlacesAndPeople.end(), one.name) ==
        kPlacesAndPeople.end())
      continue;
    std::string at = place(lowered(one.text), situation);
    if (at.empty() && !findable(one.text, situation))
      return unknown(one.text, true, situation, out);
    if (at.empty() && knowledge_.find(Advice::Kind::knows_where, one.text) == nullptr)
      at = place(lowered(knowledge_.place_of(one.text)), situation);
    if (const std::string why = at.empty() ? at : kept_out(at, situation); !why.empty())
      return why;
  }
  return {};
}

std::string Dialogue::thing(const std::string& name, const Situation& situation) {
  if (name == "it")
    return situation.carried.size() == 1 ? situation.carried.front().first : std::string();
  return is_aboard(name, situation) ? name : "the " + name;
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
    if (known.empty())
      wrong = unknown(name, false, situation, out);
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

std::string Dialogue::place_or_refusal(const Meaning& meaning, const Utterance& utterance,
                                       const Situation& situation, Outputs& out) const {
  std::uint32_t artifact = 0;
  std::string wrong;
  std::string place = referred(meaning, situation, out, artifact, wrong);
  if (place.empty())
    refuse(utterance, wrong, out);
  return place;
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
