#include "lps/shell/convert.hpp"

#include <algorithm>
namespace saphira::lps {
namespace {

constexpr std::size_t kMostReadings = 64;  // the bound of Percept.readings

}  // namespace

PointType from_bus(v1::ArtifactType type) {
  return kPairs<PointType, v1::ArtifactType>.ours(type, PointType::invalid);
}

v1::ArtifactType to_bus(PointType type) {
  return kPairs<PointType, v1::ArtifactType>.theirs(type);
}

std::vector<SonarMount> mounts_from_bus(const v1::RobotDescription& description) {
  return converted(description.sonars, [](const v1::SonarPose& sonar) {
    return SonarMount{sonar.sonar, from_bus(sonar.pose_in_robot)};
  });
}

LpsSettings settings_from_bus(const v1::RobotDescription& description) {
  auto settings = translated<LpsSettings>(description);
  settings.sonars = mounts_from_bus(description);
  return settings;
}

std::vector<SonarReading> sonars_from_bus(const v1::RobotState& state) {
  return translated<std::vector<SonarReading>>(state.sonars);
}

Percept from_bus(const v1::Percept& percept) {
  auto result = translated<Percept>(percept);
  const std::size_t count = std::min(percept.reading_cycles.size(), percept.reading_sonars.size());
  result.readings.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.readings.push_back({percept.reading_cycles[i], percept.reading_sonars[i]});
  return result;
}

v1::Percept to_bus(const Percept& percept) {
  auto result = translated<v1::Percept>(percept);
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
  auto result = translated<SeenThing>(thing);
  if (result.kind != SeenThing::Kind::blob)
    result.channel = -1;
  result.velocity_in_odom = {thing.velocity_x, thing.velocity_y};
  result.points_in_odom = thing.points;
  return result;
}

v1::SeenThing to_bus(const SeenThing& thing) {
  auto result = translated<v1::SeenThing>(thing);
  result.channel = static_cast<std::uint8_t>(std::max(0, thing.channel));
  result.velocity_x = thing.velocity_in_odom.x();
  result.velocity_y = thing.velocity_in_odom.y();
  result.points = thing.points_in_odom;
  return result;
}

}  // namespace saphira::lps
