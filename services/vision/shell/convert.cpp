#include "vision/shell/convert.hpp"

#include "lps/shell/convert.hpp"

namespace saphira::vision {
namespace {

constexpr std::size_t kMostThings = 64;  // the bound of Vision.things

}  // namespace

Channels from_bus(const v1::VisionChannels& channels) {
  Channels out;
  for (std::size_t i = 0; i < out.size() && i < channels.channels.size(); ++i) {
    const v1::VisionChannel& channel = channels.channels[i];
    out[i].x = channel.x;
    if (channel.mode == v1::VISION_LINE) {
      // Of a line its direction alone is known; each of its rows has a pixel at least.
      out[i].area = channel.count;
      continue;
    }
    out[i].y = channel.y;
    out[i].area = channel.area;
    if (channel.mode == v1::VISION_BLOB_BOX) {
      out[i].width = channel.width;
      out[i].height = channel.height;
    }
  }
  return out;
}

v1::Vision to_bus(const std::vector<lps::SeenThing>& things) {
  return {.things = converted(
              things, [](const auto& thing) { return lps::to_bus(thing); }, kMostThings)};
}

}  // namespace saphira::vision
