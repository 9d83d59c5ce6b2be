#include "lps/shell/convert.hpp"

#include <algorithm>

#include "saphira/base/enum_pairs.hpp"

namespace saphira::lps {
namespace {

constexpr std::size_t kMostReadings = 64;  // the bound of Percept.readings

constexpr EnumPairs<PointType, v1::ArtifactType, 11> kTypes{{{
    {PointType::invalid, v1::ARTIFACT_INVALID},
    {PointType::position, v1::ARTIFACT_POSITION},
    {PointType::wall, v1::ARTIFACT_WALL},
    {PointType::corridor, v1::ARTIFACT_CORRIDOR},
    {PointType::lane, v1::ARTIFACT_LANE},
    {PointType::door, v1::ARTIFACT_DOOR},
    {PointType::junction, v1::ARTIFACT_JUNCTION},
    {PointType::office, v1::ARTIFACT_OFFICE},
    {PointType::breach, v1::ARTIFACT_BREAK},
    {PointType::object, v1::ARTIFACT_OBJECT},
    {PointType::zone, v1::ARTIFACT_ZONE},
}}};
constexpr auto kSides = pairs_by_name<Side, v1::Side>();

}  // namespace

PointType from_bus(v1::ArtifactType type) {
  return kTypes.ours(type, PointType::invalid);
}

v1::ArtifactType to_bus(PointType type) {
  return kTypes.theirs(type);
}

std::vector<SonarMount> mounts_from_bus(const v1::RobotDescription& description) {
  return converted(description.sonars, [](const v1::SonarPose& sonar) {
    return SonarMount{sonar.sonar, from_bus(sonar.pose_in_robot)};
  });
}

LpsSettings settings_from_bus(const v1::RobotDescription& description) {
  LpsSettings settings;
  settings.sonars = mounts_from_bus(description);
  settings.front_buffer = description.front_buffer;
  settings.side_buffer = description.side_buffer;
  settings.front_max_range = description.front_max_range;
  return settings;
}

std::vector<SonarReading> sonars_from_bus(const v1::RobotState& state) {
  return converted(state.sonars, [](const v1::SonarReading& reading) {
    return SonarReading{reading.sonar, reading.range, reading.echo};
  });
}

Percept from_bus(const v1::Percept& percept) {
  Percept result;
  result.id = percept.id;
  result.type = from_bus(percept.type);
  result.side = kSides.ours(percept.side, Side::none);
  result.pose_in_odom = from_bus(percept.pose_in_odom);
  result.length = percept.length;
  result.width = percept.width;
  result.sigma_along = percept.sigma_along;
  result.sigma_across = percept.sigma_across;
  result.sigma_heading = percept.sigma_heading;
  result.confidence = percept.confidence;
  result.since = percept.since;
  result.seen = percept.seen;
  const std::size_t count = std::min(percept.reading_cycles.size(), percept.reading_sonars.size());
  result.readings.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.readings.push_back({percept.reading_cycles[i], percept.reading_sonars[i]});
  return result;
}

v1::Percept to_bus(const Percept& percept) {
  v1::Percept result{.id = percept.id,
                     .type = to_bus(percept.type),
                     .side = kSides.theirs(percept.side),
                     .pose_in_odom = to_bus(percept.pose_in_odom),
                     .length = percept.length,
                     .width = percept.width,
                     .sigma_along = percept.sigma_along,
                     .sigma_across = percept.sigma_across,
                     .sigma_heading = percept.sigma_heading,
                     .confidence = percept.confidence,
                     .since = percept.since,
                     .seen = percept.seen};
  const std::size_t count = std::min(percept.readings.size(), kMostReadings);
  result.reading_cycles.reserve(count);
  result.reading_sonars.reserve(count);
  for (auto reading = percept.readings.end() - static_cast<std::ptrdiff_t>(count);
       reading != percept.readings.end(); ++reading) {
    result.reading_cycles.push_back(reading->cycle);
    result.reading_sonars.push_back(static_cast<std::uint8_t>(reading->sonar));
  }
  return result;
}

SeenThing from_bus(const v1::SeenThing& thing) {
  SeenThing result;
  result.id = thing.id;
  result.kind = thing.kind == v1::SEEN_BLOB ? SeenThing::Kind::blob : SeenThing::Kind::person;
  result.channel = result.kind == SeenThing::Kind::blob ? thing.channel : -1;
  result.pose_in_odom = from_bus(thing.pose_in_odom);
  result.velocity_in_odom = {thing.velocity_x, thing.velocity_y};
  result.range_known = thing.range_known;
  result.sigma = thing.sigma;
  result.width = thing.width;
  result.height = thing.height;
  result.area = thing.area;
  result.confidence = thing.confidence;
  result.since = thing.since;
  result.seen = thing.seen;
  result.points_in_odom = thing.points;
  result.pointed = thing.pointed;
  return result;
}

v1::SeenThing to_bus(const SeenThing& thing) {
  return {.id = thing.id,
          .kind = thing.kind == SeenThing::Kind::blob ? v1::SEEN_BLOB : v1::SEEN_PERSON,
          .channel = static_cast<std::uint8_t>(std::max(0, thing.channel)),
          .pose_in_odom = to_bus(thing.pose_in_odom),
          .velocity_x = thing.velocity_in_odom.x(),
          .velocity_y = thing.velocity_in_odom.y(),
          .range_known = thing.range_known,
          .sigma = thing.sigma,
          .width = thing.width,
          .height = thing.height,
          .area = thing.area,
          .confidence = thing.confidence,
          .since = thing.since,
          .seen = thing.seen,
          .points = thing.points_in_odom,
          .pointed = thing.pointed};
}

}  // namespace saphira::lps
