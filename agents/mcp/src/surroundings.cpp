#include "saphira/mcp/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::mcp {

namespace {

constexpr std::size_t kMostPlaces = 200;
constexpr std::size_t kMostSeen = 40;
constexpr std::size_t kMostFacts = 200;
constexpr std::size_t kLongestWords = 300;  // of a fact

Pose pose(const v1::Pose2& from) {
  return {from.x, from.y, from.th};
}

/// Two decimals are enough for a reader.
double rounded(double value) {
  return std::round(100.0 * value) / 100.0;
}

/// Such as 2026-11-26 12:30 UTC; empty where the time [s since 1970] is not known.
std::string date_of(double time) {
  return time > 0.0 && time < 1e11 ? utc_text(static_cast<std::int64_t>(time), "%Y-%m-%d %H:%M UTC")
                                   : std::string();
}

const char* kind_of(v1::ArtifactType type) {
  return word_of(type, {"object", "place", "wall", "corridor", "lane", "door", "junction", "room",
                        "end of an opening", "object", "zone"});
}

/// The direction of a bearing [rad, counter-clockwise from ahead] in words.
const char* direction(double bearing) {
  constexpr std::array<const char*, 8> kWords{"ahead",  "ahead left",   "left",  "behind left",
                                              "behind", "behind right", "right", "ahead right"};
  const auto eighth = static_cast<int>(std::lround(bearing / (kPi / 4.0)));
  return kWords[static_cast<std::size_t>((eighth + 8) % 8)];
}

bool on_map(const Surroundings& around) {
  return around.registration != nullptr && around.map != nullptr &&
         around.registration->state == v1::REGISTRATION_TRACKING;
}

std::string name_of(const v1::MapArtifact& artifact) {
  const std::string kind = kind_of(artifact.type);
  return artifact.name.empty() ? kind + " " + std::to_string(artifact.id)
                               : artifact.name + " (" + kind + ")";
}

const v1::MapArtifact* find(const v1::FloorMap& map, std::uint32_t id) {
  const auto& all = map.artifacts;
  const auto found = std::ranges::find_if(
      all, [&](const v1::MapArtifact& each) { return id != 0 && each.id == id; });
  return found == all.end() ? nullptr : &*found;
}

/// The nearest point of a wall; the middle of anything else. In the frame `robot`.
Vec2 nearest(const v1::Percept& percept, const Pose& robot_in_odom) {
  const Pose middle = relative(robot_in_odom, pose(percept.pose_in_odom));
  if (percept.type != v1::ARTIFACT_WALL)
    return middle.position();
  const Vec2 along(std::cos(middle.th), std::sin(middle.th));
  const double half = percept.length / 2.0;
  return middle.position() + along * std::clamp(-middle.position().dot(along), -half, half);
}

struct Seen {
  std::string name;
  Vec2 place;  ///< [m] in the frame `robot`
};

std::vector<Seen> percepts(const Surroundings& around, const Pose& robot) {
  std::vector<Seen> all;
  for (const v1::Percept& percept : around.perception->percepts) {
    if (percept.type == v1::ARTIFACT_BREAK)
      continue;
    std::string name = kind_of(percept.type);
    if (percept.type == v1::ARTIFACT_DOOR)
      name += format(percept.length > 0.0 ? ", closed, %.1f m wide" : ", open, %.1f m wide",
                     percept.width);
    if (percept.type == v1::ARTIFACT_WALL)
      name += format(", %.1f m long", percept.length);
    if (percept.type == v1::ARTIFACT_CORRIDOR)
      name += format(", %.1f m wide", percept.width);
    all.push_back({std::move(name), nearest(percept, robot)});
  }
  return all;
}

/// The side to which a person has just pointed.
const char* gesture(const v1::SeenThing& person, std::uint64_t now, const Pose& robot) {
  constexpr std::uint64_t kRecent = 20;  // [cycles]
  if (person.pointed == 0 || person.pointed + kRecent <= now)
    return "";
  const Vec2 sight = pose(person.pose_in_odom).position() - robot.position();
  const Vec2 arm(std::cos(person.points), std::sin(person.points));
  return cross(sight, arm) > 0.0 ? ", points left" : ", points right";
}

std::vector<Seen> people(const v1::Vision& vision, const Pose& robot) {
  std::vector<Seen> all;
  for (const v1::SeenThing& thing : vision.things)
    if (thing.range_known)
      all.push_back(
          {thing.kind == v1::SEEN_PERSON
               ? std::string("person") + gesture(thing, vision.stamp.cycle, robot)
               : "colour of channel " + std::string(1, static_cast<char>('A' + thing.channel)),
           relative(robot, pose(thing.pose_in_odom)).position()});
  return all;
}

/// The nearest echo of each direction, of the newest of each sonar.
std::vector<Seen> echoes(const v1::SonarBuckets& sonars, const Pose& robot) {
  std::map<std::string, Seen> nearest;
  for (const v1::SonarBucket& bucket : sonars.buckets) {
    if (!bucket.reading.echo)
      continue;
    const Pose then = relative(robot, pose(bucket.pose_in_odom));
    const Vec2 place = compose(then, {bucket.x, bucket.y, 0.0}).position();
    const auto [one, is_new] =
        nearest.try_emplace(direction(std::atan2(place.y(), place.x())), Seen{"echo", place});
    if (!is_new && place.norm() < one->second.place.norm())
      one->second.place = place;
  }
  std::vector<Seen> all;
  for (const auto& [where, seen] : nearest)
    all.push_back(seen);
  return all;
}

}  // namespace

Result map_of(const Surroundings& around) {
  if (around.map == nullptr)
    return {"no map: registration has not been heard; go_to takes a point", Json::object(), false};
  Json value{
      {"map", around.map->source}, {"places", Json::array()}, {"closed_doors", Json::array()}};
  std::string text;
  Vec2 here(0.0, 0.0);
  if (on_map(around)) {
    const v1::Registration& registration = *around.registration;
    const Pose at = pose(registration.pose_in_map);
    here = at.position();
    const double sigma =
        std::sqrt(std::max(0.0, (registration.covariance.xx + registration.covariance.yy) / 2.0));
    const v1::MapArtifact* const in = find(*around.map, registration.environment);
    value["robot"] = {{"x", rounded(at.x)},
                      {"y", rounded(at.y)},
                      {"heading", rounded(at.th)},
                      {"sigma", rounded(sigma)},
                      {"in", in == nullptr ? Json() : Json(name_of(*in))}};
    text = "the robot is at (" +
           format("%.2f, %.2f) m, heading %.2f rad, sure to %.2f m", at.x, at.y, at.th, sigma) +
           (in == nullptr ? "" : ", in " + name_of(*in));
  } else {
    text = "the robot's place on the map is not known" +
           (around.registration == nullptr ? std::string() : ": " + around.registration->reason);
  }
  std::vector<const v1::MapArtifact*> named;
  for (const v1::MapArtifact& artifact : around.map->artifacts)
    if (!artifact.name.empty() && artifact.type != v1::ARTIFACT_DOOR &&
        artifact.type != v1::ARTIFACT_BREAK)
      named.push_back(&artifact);
  const auto distance = [&](const v1::MapArtifact* artifact) {
    return (pose(artifact->pose_in_map).position() - here).norm();
  };
  std::ranges::stable_sort(named,
                           [&](const auto* a, const auto* b) { return distance(a) < distance(b); });
  named.resize(std::min(named.size(), kMostPlaces));
  text += named.empty() ? "\nno place of the map has a name" : "\nplaces, nearest first:";
  for (const v1::MapArtifact* const place : named) {
    const v1::Pose2& at = place->pose_in_map;
    value["places"].push_back({{"name", place->name},
                               {"kind", kind_of(place->type)},
                               {"x", rounded(at.x)},
                               {"y", rounded(at.y)}});
    text += "\n" + name_of(*place) + format(" at (%.2f, %.2f)", at.x, at.y);
  }
  if (around.registration != nullptr)
    for (const std::uint32_t id : around.registration->closed_doors)
      if (const v1::MapArtifact* const door = find(*around.map, id)) {
        value["closed_doors"].push_back(name_of(*door));
        text += "\nclosed: " + name_of(*door);
      }
  return {text, value, false};
}

Result view_of(const Surroundings& around) {
  if (around.robot == nullptr)
    return {"no robot is heard", nullptr, true};
  const Pose robot = pose(around.robot->pose_in_odom);
  std::vector<Seen> all;
  const auto add = [&](std::vector<Seen> more) { all.insert(all.end(), more.begin(), more.end()); };
  if (around.perception != nullptr && around.perception->odom == around.robot->odom)
    add(percepts(around, robot));
  if (around.vision != nullptr && around.vision->odom == around.robot->odom)
    add(people(*around.vision, robot));
  if (around.sonars != nullptr && around.sonars->odom == around.robot->odom)
    add(echoes(*around.sonars, robot));
  std::ranges::stable_sort(
      all, [](const Seen& a, const Seen& b) { return a.place.norm() < b.place.norm(); });
  all.resize(std::min(all.size(), kMostSeen));
  Json value{{"seen", Json::array()}};
  std::string text;
  for (const Seen& seen : all) {
    const char* const where = direction(std::atan2(seen.place.y(), seen.place.x()));
    value["seen"].push_back({{"what", seen.name},
                             {"where", where},
                             {"distance", rounded(seen.place.norm())},
                             {"x", rounded(seen.place.x())},
                             {"y", rounded(seen.place.y())}});
    text +=
        (text.empty() ? "" : "\n") + format("%.2f m %s: ", seen.place.norm(), where) + seen.name;
  }
  return {text.empty() ? "nothing is near, or no sensor is heard" : text, value, false};
}

Result facts_of(const v1::Knowledge* knowledge) {
  if (knowledge == nullptr)
    return {"no program tells the robot's knowledge: saphira-dialogue may not run", nullptr, true};
  const auto& all = knowledge->known;
  Json value{{"known", Json::array()}};
  if (all.empty())
    return {"the robot was told nothing that it knows now", value, false};
  const std::size_t first = all.size() - std::min(all.size(), kMostFacts);
  std::string text = "what people told the robot, by number:";
  if (first > 0)
    text += "\n(older ones are left out: " + std::to_string(first) + ")";
  for (std::size_t i = first; i < all.size(); ++i) {
    const v1::Advice& advice = all[i];
    const std::string words = advice.words.substr(0, kLongestWords);
    const std::string said = advice.said.substr(0, kLongestWords);
    const std::string speaker =
        advice.speaker.empty() ? "somebody" : advice.speaker.substr(0, kLongestWords);
    const std::string date = date_of(advice.time);
    value["known"].push_back({{"number", advice.number},
                              {"what", words},
                              {"speaker", speaker},
                              {"time", date.empty() ? Json() : Json(date)},
                              {"said", said}});
    text += "\n" + std::to_string(advice.number) + ": " + words + " (by " + speaker +
            (date.empty() ? "" : ", " + date) + (said.empty() ? "" : ": \"" + said + "\"") + ")";
  }
  return {text, value, false};
}

}  // namespace saphira::mcp
