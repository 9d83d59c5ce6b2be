#pragma once

#include <functional>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::test {

enum class Stereo {
  bands,    ///< ranges from a stereo system: no pictures, a hundredth of the time
  pictures  ///< rendered, with a census of each pair
};

/// Vision by saphira-vision with the robot's cameras (WholeOptions::sees): people by stereo, and
/// red, green and blue by the Fast Track.
std::function<std::vector<lps::SeenThing>(Drive&)> vision_eyes(Stereo stereo);

}  // namespace saphira::test
