#include "saphira/interpretation/core.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace saphira::interpretation {
namespace {

const std::vector<lps::SonarMount> kSides{{0, {0.0, 0.0, kPi / 2.0}}, {6, {0.0, 0.0, -kPi / 2.0}}};

/// A robot that drives along a wall a metre to its left.
class CoreTest : public testing::Test {
 protected:
  Core::Outputs step() {
    ++inputs_.cycle;
    inputs_.new_robot = inputs_.cycle == 1 ? &sonars_ : nullptr;
    inputs_.pose_in_odom.x += 0.03;
    inputs_.readings = {{0, 1.0, true}};
    core_.processes().step(inputs_.cycle);
    Core::Outputs outputs = core_.step(inputs_);
    inputs_.new_frame = false;
    for (const TileKey& key : outputs.gone)
      EXPECT_EQ(told_.erase(key), 1U) << "only what was told can be gone";
    told_.insert(outputs.tiles.begin(), outputs.tiles.end());
    return outputs;
  }
  void drive(int cycles) {
    for (int i = 0; i < cycles; ++i)
      step();
  }

  std::vector<lps::SonarMount> sonars_ = kSides;
  Core core_;
  Core::Inputs inputs_;
  std::set<TileKey> told_;
};

TEST_F(CoreTest, TilesAreToldOnceASecond) {
  int told = 0;
  for (int i = 1; i <= 30; ++i) {
    const Core::Outputs outputs = step();
    EXPECT_TRUE(outputs.tiles.empty() || i % 10 == 0) << i;
    told += outputs.tiles.empty() ? 0 : 1;
  }
  EXPECT_EQ(told, 3);
  EXPECT_FALSE(told_.empty());
}

TEST_F(CoreTest, WhatWasSeenInAnotherFrameIsGone) {
  drive(100);
  ASSERT_FALSE(step().output->percepts.empty());
  inputs_.new_frame = true;
  EXPECT_TRUE(step().output->percepts.empty());
}

TEST_F(CoreTest, ATileOfANewFrameIsToldThoughItHasTheKeyOfAnOldOne) {
  drive(100);
  inputs_.new_frame = true;
  inputs_.pose_in_odom = {};
  drive(20);
  const std::vector<TileKey> tiles = core_.grid().tiles();
  EXPECT_EQ(told_, std::set<TileKey>(tiles.begin(), tiles.end()));
}

TEST_F(CoreTest, AnotherEpochTakesItsTilesAwayAndItsIdsGoOn) {
  drive(100);
  const auto newest = [](const Core::Outputs& outputs) {
    std::uint32_t id = 0;
    for (const lps::Percept& percept : outputs.output->percepts)
      id = std::max(id, percept.id);
    return id;
  };
  const std::uint32_t before = newest(step());
  ASSERT_GT(before, 0U);
  inputs_.cycle = 0;
  const Core::Outputs first = step();
  EXPECT_FALSE(first.gone.empty());
  EXPECT_TRUE(told_.empty());
  drive(100);
  EXPECT_GT(newest(step()), before);
}

TEST_F(CoreTest, AnotherRobotBeginsAnew) {
  drive(100);
  sonars_ = {{0, {0.1, 0.0, kPi / 2.0}}};
  inputs_.cycle = 0;
  EXPECT_TRUE(step().output->percepts.empty());
  EXPECT_FALSE(core_.processes().processes().empty());
}

}  // namespace
}  // namespace saphira::interpretation
