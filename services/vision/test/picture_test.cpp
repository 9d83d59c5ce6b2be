#include "saphira/vision/picture.hpp"

#include <gtest/gtest.h>

#include "saphira/base/text.hpp"
#include "seen.hpp"

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

}  // namespace
}  // namespace saphira::vision
