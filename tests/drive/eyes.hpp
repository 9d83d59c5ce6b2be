#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::test {

/// Eyes that make no mistakes (WholeOptions::sees): people whom no wall hides, within 6 m and 30
/// degrees of straight ahead, and the largest patch of each channel's colour as the Fast Track sees
/// it. Who goes out of sight is believed to walk on for five seconds. What activities do with what
/// is seen, apart from how well it is seen.
std::function<std::vector<lps::SeenThing>(Drive&)> true_eyes(std::vector<std::string> colors = {});

}  // namespace saphira::test
