#include "saphira/sim/stereo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "world_scene.hpp"

namespace saphira::sim {
namespace {

World world(const std::string& things) {
  return parse_world(
      "width 10000 height 6000 0 0 0 6000 0 0 10000 0 0 6000 10000 6000 10000 0 10000 6000 " +
          things,
      "stereo.wld");
}

// A picture without noise, of a robot in the world; its measurements in rows around one.
class View {
 public:
  explicit View(const std::string& things) : scene_(world(things)) {
    scene_.add_robot({}, {2.0, 3.0, 0.0}, 1);
    rig_.noise = rig_.gain_difference = 0.0;
    Random random(5);
    pair_ = render_stereo(scene_, 0, rig_, random);
  }
  // [m] The depth by which the columns of the left picture from there on fit best into the right
  // one.
  double depth(int row, int column, int columns) const {
    double best = 0.0;
    long least = std::numeric_limits<long>::max();
    for (int disparity = 1; disparity <= 48; ++disparity) {
      long sum = 0;
      for (int dy = -3; dy <= 3; ++dy)
        for (int x = column; x < column + columns; ++x)
          sum += std::abs(pair_.left.at(x, row + dy) - pair_.right.at(x - disparity, row + dy));
      if (sum < least) {
        least = sum;
        best = rig_.focal() * rig_.baseline / disparity;
      }
    }
    return best;
  }
  // Half a pixel of matching and another of rounding.
  void expect(double truth, double range) const {
    EXPECT_LE(std::abs(rig_.focal() * rig_.baseline * (1.0 / range - 1.0 / truth)), 1.0)
        << range << " is not " << truth;
  }
  int row(double height, double away) const {
    return static_cast<int>(0.5 * rig_.rows - (height - rig_.height) * rig_.focal() / away);
  }
  // Of the left picture, whose camera stands to the left of the robot's middle.
  int column(double aside, double away) const {
    return static_cast<int>(0.5 * rig_.columns -
                            (aside - rig_.baseline / 2.0) * rig_.focal() / away);
  }

 private:
  WorldScene scene_;
  StereoRig rig_;
  StereoPair pair_;
};

TEST(Stereo, APersonIsBeforeTheWallAtTorsoHeight) {
  for (const double away : {1.5, 2.5, 4.0}) {
    const View view("person ann " + std::to_string(static_cast<int>(2000 + 1000 * away)) + " 3000");
    const double front = away - 0.25;
    for (const double height : {1.0, 1.2, 1.4}) {
      SCOPED_TRACE(std::to_string(away) + " m away, at " + std::to_string(height));
      view.expect(front, view.depth(view.row(height, front), view.column(0.0, away) - 7, 15));
      if (away > 2.0)  // else the ceiling hides the wall in these rows
        view.expect(8.0, view.depth(view.row(height, front), 70, 40));
    }
  }
}

TEST(Stereo, TheFloorsDisparityIsThatOfItsDistance) {
  const View view("");
  for (const double away : {4.6, 3.1})
    view.expect(away, view.depth(view.row(0.0, away), 60, 240));
}

TEST(Stereo, ABoxIsSeenWithItsLidAndHidesWhatIsBehind) {
  const View view("box crate 4000 3000 0 400 600 5");
  // Its front is 1.8 m away, from the floor to 0.5 m; its lid reaches to 2.2 m.
  for (const auto& [height, away] : {std::pair{0.25, 1.8}, {0.5, 2.0}, {0.9, 8.0}})
    view.expect(away, view.depth(view.row(height, away), view.column(0.0, 2.0) - 15, 31));
}

// From 1.35 to 1.45 m above the floor, with the far wall below it.
TEST(Stereo, AnArmIsABarBesideThePerson) {
  for (const double side : {1.0, -1.0}) {
    const View view("person ann 4000 3000 point " + std::to_string(90 * int(side)) + " 100");
    const auto expect = [&](double truth, double height, double aside) {
      SCOPED_TRACE(std::to_string(height) + " m high, " + std::to_string(aside) + " m aside");
      view.expect(truth, view.depth(view.row(height, 2.0), view.column(aside, 2.0) - 4, 9));
    };
    for (const double out : {0.4, 0.7}) {
      expect(2.0, 1.40, side * out);
      expect(8.0, 1.20, side * out);
      expect(8.0, 1.40, -side * out);
    }
    expect(8.0, 1.40, side * 0.95);
  }
}

TEST(Stereo, ASeedDecidesThePicture) {
  WorldScene scene(world("person ann 5000 3000 post can 4000 3500 100"));
  scene.add_robot({}, {2.0, 3.0, 0.1}, 1);
  const StereoRig rig;
  const auto picture = [&](std::uint64_t seed) {
    Random random(seed);
    return to_pgm(render_stereo(scene, 0, rig, random), rig, 7);
  };
  EXPECT_EQ(picture(1), picture(1));
  EXPECT_NE(picture(1), picture(2));
  const std::string text = picture(1);
  EXPECT_TRUE(text.starts_with("P5\n# saphira stereo cycle=7 focal=277.12"));
  const std::size_t pixels = std::size_t{640} * 240;
  EXPECT_EQ(text.substr(text.size() - pixels - 12, 12), "640 240\n255\n");
  // The noise is the rig's: the difference of two seeds has twice its variance.
  Random one(1);
  Random two(2);
  const StereoPair a = render_stereo(scene, 0, rig, one);
  const StereoPair b = render_stereo(scene, 0, rig, two);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.left.pixels.size(); ++i) {
    const double difference = static_cast<double>(a.left.pixels[i]) - b.left.pixels[i];
    sum += difference * difference;
  }
  EXPECT_NEAR(std::sqrt(sum / 2.0 / static_cast<double>(a.left.pixels.size())), rig.noise, 0.1);
}

}  // namespace
}  // namespace saphira::sim
