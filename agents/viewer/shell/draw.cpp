#include "draw.hpp"

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::viewer {

namespace {

template <class T>
T read(const std::string& json) {
  T sample;
  bus::from_json(json, sample);
  return sample;
}

}  // namespace

const std::vector<std::string>& drawn_topics() {
  static const std::vector<std::string> topics{bus::topics::kRegistration.name,
                                               bus::topics::kRobotState.name,
                                               bus::topics::kRobotDescription.name,
                                               bus::topics::kSonarBuckets.name,
                                               bus::topics::kPerception.name,
                                               bus::topics::kGrid.name,
                                               bus::topics::kMap.name,
                                               bus::topics::kLog.name,
                                               bus::topics::kCameraPictures.name};
  return topics;
}

Scene::Messages draw(Scene& scene, const std::string& topic, const std::string& json,
                     std::int64_t time_ns) {
  const bool disposed = json.starts_with(bus::kDisposed);
  if (topic == bus::topics::kGrid.name) {
    return scene.take(
        read<v1::GridTile>(disposed ? "{" + json.substr(bus::kDisposed.size()) : json), disposed,
        time_ns);
  }
  if (disposed)
    return {};
  if (topic == bus::topics::kRobotState.name)
    return scene.take(read<v1::RobotState>(json), time_ns);
  if (topic == bus::topics::kRobotDescription.name)
    return scene.take(read<v1::RobotDescription>(json), time_ns);
  if (topic == bus::topics::kSonarBuckets.name)
    return Scene::take(read<v1::SonarBuckets>(json), time_ns);
  if (topic == bus::topics::kPerception.name)
    return Scene::take(read<v1::Perception>(json), time_ns);
  if (topic == bus::topics::kMap.name)
    return Scene::take(read<v1::FloorMap>(json), time_ns);
  if (topic == bus::topics::kLog.name)
    return Scene::take(read<v1::LogRecord>(json));
  if (topic == bus::topics::kCameraPictures.name)
    return Scene::take(read<v1::CameraPicture>(json), time_ns);
  if (topic == bus::topics::kRegistration.name)
    scene.take(read<v1::Registration>(json));
  return {};
}

}  // namespace saphira::viewer
