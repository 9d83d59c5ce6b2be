#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::test {

/// Perfect vision (WholeOptions::sees), for tests of activities apart from the quality of vision:
/// people who are not behind a wall, within 6 m and 30 degrees of straight ahead, and the largest
/// patch of each channel's colour as in the Fast Track. People out of sight are extrapolated for
/// five seconds.
std::function<std::vector<lps::SeenThing>(Drive&)> true_eyes(std::vector<std::string> colors = {});

}  // namespace saphira::test
