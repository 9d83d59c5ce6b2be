#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/viewer/scene.hpp"

namespace saphira::viewer {

/// The topics that draw() takes something of.
const std::vector<std::string>& drawn_topics();
/// The messages of a sample of any topic, as bus::Echo gives it.
Scene::Messages draw(Scene& scene, const std::string& topic, const std::string& json,
                     std::int64_t time_ns);

}  // namespace saphira::viewer
