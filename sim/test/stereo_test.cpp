// The pictures are fit for their purpose: a census stereo, written here after the paper of 1996
// (Zabih and Woodfill), finds the ranges in them.
#include "saphira/sim/stereo.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "world_scene.hpp"

namespace saphira::sim {
namespace {

World world(const std::string& things) {
  return parse_world(
      "width 10000 height 6000 0 0 0 6000 0 0 10000 0 0 6000 10000 6000 10000 0 10000 6000 " +
          things,
      "stereo.wld");
}

// A bit for each of the 7 x 7 neighbours that is darker than the middle.
std::uint64_t census(const GreyImage& image, int column, int row) {
  std::uint64_t bits = 0;
  for (int dy = -3; dy <= 3; ++dy)
    for (int dx = -3; dx <= 3; ++dx)
      bits = bits << 1U | (image.at(column + dx, row + dy) < image.at(column, row) ? 1U : 0U);
  return bits;
}

constexpr int kMost = 48;  // [pixels] of disparity
constexpr int kWindow = 4;
constexpr int kMargin = 3 + kWindow;

class Census {
 public:
  explicit Census(const GreyImage& image) : columns_(image.columns), rows_(image.rows) {
    words_.resize(image.pixels.size());
    for (int row = 3; row < rows_ - 3; ++row)
      for (int column = 3; column < columns_ - 3; ++column)
        words_[at(column, row)] = census(image, column, row);
  }
  int columns() const { return columns_; }
  // The difference of two windows.
  int cost(int column, const Census& other, int other_column, int row) const {
    int sum = 0;
    for (int dy = -kWindow; dy <= kWindow; ++dy)
      for (int dx = -kWindow; dx <= kWindow; ++dx)
        sum += std::popcount(words_[at(column + dx, row + dy)] ^
                             other.words_[other.at(other_column + dx, row + dy)]);
    return sum;
  }

 private:
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  int columns_;
  int rows_;
  std::vector<std::uint64_t> words_;
};

// The best match of a pixel of `from` in `to`, `sign` to the left or the right of it.
std::optional<int> match(const Census& from, const Census& to, int column, int row, int sign) {
  int best = 0;
  int least = 1 << 30;
  for (int disparity = 0; disparity <= kMost; ++disparity) {
    const int other = column + sign * disparity;
    if (other < kMargin || other >= to.columns() - kMargin)
      break;
    if (const int cost = from.cost(column, to, other, row); cost < least) {
      least = cost;
      best = disparity;
    }
  }
  return least < 1 << 30 ? std::optional(best) : std::nullopt;
}

// Ranges [m] along one row of the left picture; nothing where left and right disagree.
std::vector<std::optional<double>> ranges(const StereoPair& pair, const StereoRig& rig, int row) {
  const Census left(pair.left);
  const Census right(pair.right);
  std::vector<std::optional<double>> out(static_cast<std::size_t>(rig.columns));
  for (int column = kMargin; column < rig.columns - kMargin; ++column) {
    const auto disparity = match(left, right, column, row, -1);
    if (!disparity || *disparity == 0)
      continue;
    const auto back = match(right, left, column - *disparity, row, 1);
    if (back && std::abs(*back - *disparity) <= 1)
      out[static_cast<std::size_t>(column)] = rig.focal() * rig.baseline / *disparity;
  }
  return out;
}

struct Found {
  int right = 0;    // columns with the right range
  int matched = 0;  // with any
  int all = 0;
};

// Half a pixel of matching and another of rounding.
bool fits(const StereoRig& rig, double range, double truth) {
  return std::abs(rig.focal() * rig.baseline * (1.0 / range - 1.0 / truth)) <= 1.0;
}

TEST(Stereo, CensusFindsAPersonsBandsAtTorsoHeight) {
  for (const double away : {1.5, 2.5, 4.0}) {
    WorldScene scene(
        world("person ann " + std::to_string(static_cast<int>(2000 + 1000 * away)) + " 3000"));
    scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
    const StereoRig rig;
    Random random(5);
    const StereoPair pair = render_stereo(scene, 0, rig, random);
    int bands = 0;
    for (const double height : {1.0, 1.2, 1.4}) {
      const double front = away - 0.25;
      const int row = rig.rows / 2 - static_cast<int>((height - rig.height) * rig.focal() / front);
      const auto band = ranges(pair, rig, row);
      // Her middle 0.3 m, and the wall 8 m away far from her.
      Found person;
      Found wall;
      const double middle =
          0.5 * rig.columns + 0.5 * rig.baseline * rig.focal() / away;  // of the left eye
      for (int column = kMargin + 1; column < rig.columns - kMargin - 1; ++column) {
        const double aside = (column + 0.5 - middle) / rig.focal();  // [m] for a depth of 1
        const auto& range = band[static_cast<std::size_t>(column)];
        Found* where = std::abs(aside * away) < 0.15                                 ? &person
                       : std::abs(aside * away) > 0.5 && std::abs(aside * 8.0) < 2.5 ? &wall
                                                                                     : nullptr;
        if (where == nullptr)
          continue;
        const double x = aside * away;
        const double truth = where == &person ? away - std::sqrt(0.25 * 0.25 - x * x) : 8.0;
        ++where->all;
        where->matched += range.has_value();
        where->right += range && fits(rig, *range, truth);
      }
      EXPECT_GT(person.matched, 0.8 * person.all) << away << " m away, at " << height;
      EXPECT_GT(person.right, 0.9 * person.matched) << away << " m away, at " << height;
      if (wall.all > 0) {
        EXPECT_GT(wall.right, 0.8 * wall.all) << away << " m away, at " << height;
      }
      // As wide as a person: within half a metre behind her front.
      int wide = 0;
      for (const auto& range : band)
        wide += range && *range < away + 0.5 && *range > away - 0.5;
      const double width = wide * away / rig.focal();
      if (width > 0.35 && width < 0.7)
        ++bands;
    }
    // The paper's tracker needs two bands of three for a person.
    EXPECT_GE(bands, 2) << away << " m away";
  }
}

TEST(Stereo, TheFloorsDisparityIsThatOfItsDistance) {
  WorldScene scene(world(""));
  scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
  const StereoRig rig;
  Random random(5);
  const StereoPair pair = render_stereo(scene, 0, rig, random);
  for (const int row : {rig.rows / 2 + 60, rig.rows / 2 + 90}) {
    const double truth = rig.height * rig.focal() / (row + 0.5 - 0.5 * rig.rows);
    Found floor;
    const auto band = ranges(pair, rig, row);
    for (int column = kMost + kMargin; column < rig.columns - kMargin; ++column) {
      const auto& range = band[static_cast<std::size_t>(column)];
      ++floor.all;
      floor.right += range && fits(rig, *range, truth);
    }
    EXPECT_GT(floor.right, 0.8 * floor.all) << truth << " m";
  }
}

TEST(Stereo, ABoxIsSeenWithItsLidAndHidesWhatIsBehind) {
  const World it = world("box crate 4000 3000 0 400 600 5");
  Scene scene(it);
  scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
  StereoRig rig;
  rig.noise = 0.0;
  Random random(5);
  const StereoPair pair = render_stereo(scene, 0, rig, random);
  const auto row = [&](double height, double away) {
    return static_cast<int>(0.5 * rig.rows - (height - rig.height) * rig.focal() / away);
  };
  // Its front is 1.8 m away, from the floor to 0.5 m; its lid reaches to 2.2 m.
  const auto front = ranges(pair, rig, row(0.25, 1.8));
  const auto lid = ranges(pair, rig, row(0.5, 2.0));
  const auto behind = ranges(pair, rig, row(0.9, 8.0));
  const int middle = rig.columns / 2 + static_cast<int>(0.5 * rig.baseline * rig.focal() / 2.0);
  Found found[3];
  for (int column = middle - 15; column <= middle + 15; ++column) {
    const auto i = static_cast<std::size_t>(column);
    found[0].right += front[i] && fits(rig, *front[i], 1.8);
    found[1].right += lid[i] && fits(rig, *lid[i], 2.0);
    found[2].right += behind[i] && fits(rig, *behind[i], 8.0);
  }
  for (const Found& one : found)
    EXPECT_GT(one.right, 24) << &one - found;
}

// From 1.35 to 1.45 m above the floor, with the far wall below it.
TEST(Stereo, AnArmIsABarBesideThePerson) {
  for (const double side : {1.0, -1.0}) {
    WorldScene scene(
        world("person ann 4000 3000 point " + std::to_string(90 * int(side)) + " 100"));
    scene.add_robot({}, {2.0, 3.0, 0.0}, 1);
    const StereoRig rig;
    Random random(5);
    const StereoPair pair = render_stereo(scene, 0, rig, random);
    // The left eye's column of a point beside her.
    const auto column = [&](double aside) {
      return static_cast<std::size_t>(0.5 * rig.columns -
                                      (aside - rig.baseline / 2.0) * rig.focal() / 2.0);
    };
    const auto range = [&](double height, double aside) {
      const int row = rig.rows / 2 - static_cast<int>((height - rig.height) * rig.focal() / 2.0);
      return ranges(pair, rig, row)[column(aside)].value_or(0.0);
    };
    for (const double out : {0.4, 0.7}) {
      EXPECT_TRUE(fits(rig, range(1.40, side * out), 2.0)) << side << ", " << out;
      EXPECT_TRUE(fits(rig, range(1.20, side * out), 8.0)) << side << ", " << out;
      EXPECT_TRUE(fits(rig, range(1.40, -side * out), 8.0)) << side << ", " << out;
    }
    EXPECT_TRUE(fits(rig, range(1.40, side * 0.95), 8.0)) << side;
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
