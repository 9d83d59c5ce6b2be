#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::test {

/// Eyes that make no mistakes (WholeOptions::sees), for tests of activities apart from the quality
/// of vision: people whom no wall hides, within 6 m and 30 degrees of straight ahead, and the
/// largest patch of each channel's colour as the Fast Track sees it. People who go out of sight are
/// believed to walk on for five seconds.
std::function<std::vector<lps::SeenThing>(Drive&)> true_eyes(std::vector<std::string> colors = {});

}  // namespace saphira::test
