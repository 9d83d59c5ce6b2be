#pragma once

#include <vector>

#include "saphira/idl/vision.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/vision/blobs.hpp"

namespace saphira::vision {

/// Channels in the mode for lines count as empty: a line is no thing.
Channels from_bus(const v1::VisionChannels& channels);
v1::Vision to_bus(const std::vector<lps::SeenThing>& things);

}  // namespace saphira::vision
