#pragma once

#include <functional>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::test {

/// Vision by saphira-vision with the robot's cameras (WholeOptions::sees): people by stereo, and
/// red, green and blue by the Fast Track. Without `people` no pictures are made, which takes a
/// hundredth of the time.
std::function<std::vector<lps::SeenThing>(Drive&)> vision_eyes(bool people = true);

}  // namespace saphira::test
