#include "vision/shell/convert.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saphira::vision {
namespace {

TEST(Convert, ChannelsByTheirMode) {
  v1::VisionChannels sample;
  sample.channels.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    v1::VisionChannel& channel = sample.channels[i];
    channel.x = static_cast<std::int16_t>(-10 - static_cast<int>(i));
    channel.y = 5;
    channel.area = 100;
    channel.width = 8;
    channel.height = 12;
  }
  sample.channels[0].mode = v1::VISION_BLOB_BOX;
  sample.channels[1].mode = v1::VISION_BLOB;
  sample.channels[2].mode = v1::VISION_LINE;
  sample.channels[2].count = 9;
  const Channels channels = from_bus(sample);
  EXPECT_EQ(channels[0].x, -10);
  EXPECT_EQ(channels[0].y, 5);
  EXPECT_EQ(channels[0].area, 100);
  EXPECT_EQ(channels[0].width, 8);
  EXPECT_EQ(channels[0].height, 12);
  EXPECT_EQ(channels[1].x, -11);
  EXPECT_EQ(channels[1].height, 0);
  // Of a line the direction alone.
  EXPECT_EQ(channels[2].x, -12);
  EXPECT_EQ(channels[2].area, 9);
  EXPECT_EQ(channels[2].height, 0);
  const auto line = find_blobs({Patch{}, Patch{}, channels[2]});
  ASSERT_EQ(line.size(), 1U);
  EXPECT_FALSE(line[0].range_known);
  EXPECT_LT(std::abs(line[0].place_in_robot.y() - 2.0 * std::sin(radians(11.5 / 3.0))), 1e-6);
  EXPECT_EQ(from_bus(v1::VisionChannels{})[0].area, 0);
}

TEST(Convert, NoMoreThanTheContractTakes) {
  EXPECT_EQ(to_bus(std::vector<lps::SeenThing>(100)).things.size(), 64U);
}

}  // namespace
}  // namespace saphira::vision
