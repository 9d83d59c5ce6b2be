#pragma once

#include <functional>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::test {

enum class Stereo {
  bands,    ///< of range, as a stereo system gives them: no pictures, a hundredth of the time
  pictures  ///< rendered, and a census of each pair
};

/// Eyes that see what saphira-vision makes of a robot's cameras (WholeOptions::sees): people by
/// stereo, and red, green and blue by the Fast Track.
std::function<std::vector<lps::SeenThing>(Drive&)> vision_eyes(Stereo stereo);

}  // namespace saphira::test
