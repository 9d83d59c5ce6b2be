// The things seen in one picture.
#include "seen.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saphira/base/text.hpp"
#include "saphira/vision/blobs.hpp"
#include "saphira/vision/people.hpp"
#include "saphira/vision/picture.hpp"

namespace saphira::vision {
namespace {

std::string pgm(std::uint64_t cycle) {
  const sim::World world = room("");
  sim::Scene scene(world);
  scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
  sim::StereoRig rig;
  rig.columns = 64;
  rig.rows = 8;
  rig.pose_in_robot.th = 0.5;
  Random random(cycle);
  return sim::to_pgm(sim::render_stereo(scene, 0, rig, random), rig, cycle);
}

TEST(Picture, ComesInPieces) {
  const std::string bytes = pgm(7) + pgm(8);
  PictureStream stream;
  std::vector<StereoPicture> pictures;
  for (std::size_t i = 0; i < bytes.size(); i += 100) {
    stream.feed(std::string_view(bytes).substr(i, 100));
    while (auto picture = stream.take())
      pictures.push_back(*picture);
  }
  ASSERT_EQ(pictures.size(), 2U);
  EXPECT_EQ(pictures[0].cycle, 7U);
  EXPECT_EQ(pictures[1].cycle, 8U);
  EXPECT_EQ(pictures[0].columns, 64);
  EXPECT_EQ(pictures[0].rows, 8);
  EXPECT_NEAR(pictures[0].rig.focal, 32.0 / std::tan(radians(30.0)), 1e-4);
  EXPECT_DOUBLE_EQ(pictures[0].rig.baseline, 0.12);
  EXPECT_DOUBLE_EQ(pictures[0].rig.height, 1.0);
  EXPECT_DOUBLE_EQ(pictures[0].rig.pan, 0.5);
  // The right one stands beside the left one.
  EXPECT_EQ(pictures[0].right().row(3) - pictures[0].left().row(3), 64);
}

TEST(Picture, WhatIsNoneIsSaid) {
  for (const std::string text :
       {"GIF89a", "P5\n# other\n4 1\n255\n....", "P5\n# saphira stereo cycle=x\n4 1\n255\n",
        "P5\n# saphira stereo cycle=1 focal=0\n4 1\n255\n",
        "P5\n# saphira stereo cycle=1 pan=4\n4 1\n255\n",
        "P5\n# saphira stereo cycle=1 pan=nan\n4 1\n255\n",
        "P5\n# saphira stereo cycle=1 forward=inf\n4 1\n255\n", "P5\n# saphira stereo \n5 1\n255\n",
        "P5\n# saphira stereo \n4000000 1\n255\n", "P5\n# saphira stereo \n\n255\n"}) {
    PictureStream stream;
    stream.feed(text);
    EXPECT_THROW(stream.take(), FileError) << text;
  }
  PictureStream stream;
  EXPECT_FALSE(stream.take());
  stream.feed("P");
  EXPECT_FALSE(stream.take());
}

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

std::vector<Sight> people_in(const std::string& things, const Pose& robot = {2.0, 3.0, 0.0}) {
  return find_people(bands_of(things, robot));
}

TEST(People, AreFoundWhereTheyStand) {
  for (const auto& [away, aside] :
       {std::pair{1.2, 0.0}, {2.0, 0.5}, {2.5, -0.8}, {3.5, 0.7}, {4.0, 0.0}, {5.0, -1.0}}) {
    const auto found = people_in("person ann " + std::to_string(2000 + int(1000 * away)) + " " +
                                 std::to_string(3000 + int(1000 * aside)));
    ASSERT_EQ(found.size(), 1U) << away << " m away, " << aside << " m aside";
    EXPECT_NEAR(found[0].place_in_robot.x(), away, 3.0 * found[0].sigma_range) << away;
    EXPECT_NEAR(found[0].place_in_robot.y(), aside, 3.0 * found[0].sigma_across) << away;
    EXPECT_NEAR(found[0].width, 0.5, 0.2) << away;
  }
}

// In the distance at which the robot attends to somebody. Nearer the cameras match nothing, and a
// person is not expected to be seen.
TEST(People, AreFoundAsNearAsTheyCanBeExpected) {
  for (const double away : {0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4})
    for (const double aside : {-0.5, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.5}) {
      const Bands seen = bands_of("person ann " + std::to_string(2000 + std::lround(1000 * away)) +
                                  " " + std::to_string(3000 + std::lround(1000 * aside)));
      const bool expected = in_view(seen, {away, aside});
      const std::vector<Sight> found = find_people(seen);
      EXPECT_LE(expected ? 1U : 0U, found.size()) << away << " m away, " << aside << " m aside";
      if (away >= 0.9 && std::abs(aside) < 0.15) {
        EXPECT_TRUE(expected) << away << " m away, " << aside << " m aside";
      }
      if (away < 0.75) {
        EXPECT_FALSE(expected) << away << " m away, " << aside << " m aside";
      }
      for (const Sight& one : found)
        EXPECT_LT((one.place_in_robot - Vec2(away, aside)).norm(), 0.15) << away << ", " << aside;
    }
}

TEST(People, TwoAreTwo) {
  EXPECT_EQ(people_in("person ann 5000 2400 person ben 5200 3600").size(), 2U);
}

// A false person would be followed: walls, doors, boxes, posts and robots are none.
TEST(People, WhatIsNoneIsNoPerson) {
  const char* const things[] = {
      "",
      "box crate 4000 3000 0 400 600 5",
      "box cupboard 5000 3000 20 600 1200 50 tall 2000",
      "post can 4000 3000 250",
      "post pillar 4500 3000 60 tall 2200",
      "5000 2000 5000 3500",
      "5000 3200 5000 6000 5000 0 5000 2400",  // an opening
      "door d 5000 2500 5000 3400 -90",
  };
  for (const char* const each : things)
    for (const double heading : {0.0, 25.0, -40.0})
      EXPECT_TRUE(people_in(each, {2.0, 3.0, radians(heading)}).empty())
          << each << ", heading " << heading;
}

TEST(People, WhoIsBehindSomethingIsNotInView) {
  const Bands seen =
      bands_of("person ann 7000 3000 box cupboard 4000 3000 0 300 1200 50 tall 2000");
  EXPECT_FALSE(in_view(seen, {5.0, 0.0}));
  EXPECT_TRUE(in_view(seen, {4.0, 1.5}));
  EXPECT_FALSE(in_view(seen, {4.0, 4.0}));
  EXPECT_FALSE(in_view(seen, {-2.0, 0.0}));
}

}  // namespace
}  // namespace saphira::vision
