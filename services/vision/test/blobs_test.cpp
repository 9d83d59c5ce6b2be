#include "saphira/vision/blobs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "seen.hpp"

namespace saphira::vision {
namespace {

Channels look(const std::string& things, bool boxes = true) {
  const sim::World world = room(things);
  sim::Scene scene(world);
  scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
  Channels channels;
  const char* const colors[] = {"red", "green", "blue"};
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (const auto blob = sim::see_blob(scene, 0, sim::Camera{}, colors[i])) {
      channels[i] = {blob->x, blob->y, blob->area, blob->width, blob->height};
      if (!boxes)
        channels[i].width = channels[i].height = 0;
    }
  return channels;
}

TEST(Blobs, TheFootOnTheFloorTellsTheRange) {
  for (const auto& [away, aside] : {std::pair{1.4, 0.0}, {1.8, 0.4}, {2.5, -0.6}, {3.5, 0.3}}) {
    const auto found =
        find_blobs(look("post can " + std::to_string(2000 + int(1000 * away)) + " " +
                        std::to_string(3000 + int(1000 * aside)) + " 100 color green tall 300"));
    ASSERT_EQ(found.size(), 1U) << away;
    EXPECT_EQ(found[0].channel, 1);
    ASSERT_TRUE(found[0].range_known) << away;
    // Its front: a radius before its middle.
    EXPECT_NEAR(found[0].place_in_robot.norm(), std::hypot(away, aside) - 0.1,
                2.5 * found[0].sigma_range)
        << away;
    EXPECT_NEAR(std::atan2(found[0].place_in_robot.y(), found[0].place_in_robot.x()),
                std::atan2(aside, away), radians(1.5))
        << away;
    EXPECT_NEAR(found[0].width, 0.2, 0.05) << away;
    EXPECT_NEAR(found[0].height, 0.3, 0.06) << away;
  }
}

TEST(Blobs, AKnownHeightTellsTheRange) {
  ColorCamera camera;
  camera.heights[0] = 0.5;
  const auto found = find_blobs(look("box crate 5000 3000 0 400 600 5 color red tall 500"), camera);
  ASSERT_EQ(found.size(), 1U);
  ASSERT_TRUE(found[0].range_known);
  EXPECT_NEAR(found[0].place_in_robot.x(), 2.8, 0.3);
}

TEST(Blobs, WithoutABoxOnlyTheDirectionIsKnown) {
  const auto found = find_blobs(look("post can 4000 3500 100 color blue tall 300", false));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].channel, 2);
  EXPECT_FALSE(found[0].range_known);
  EXPECT_NEAR(std::atan2(found[0].place_in_robot.y(), found[0].place_in_robot.x() - 0.15),
              std::atan2(0.5, 1.85), radians(1.0));
}

TEST(Blobs, WhatIsNotThereIsNotSeen) {
  EXPECT_TRUE(find_blobs(look("")).empty());
  EXPECT_TRUE(find_blobs(look("post can 1000 3000 100 color red")).empty());  // behind it
}

}  // namespace
}  // namespace saphira::vision
