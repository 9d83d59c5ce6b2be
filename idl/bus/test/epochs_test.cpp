// Which bridge's epochs are followed.
#include "epochs.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

using Verdict = Epochs::Verdict;
constexpr Epochs::Program kBridge{1};
constexpr Epochs::Program kOther{2};
constexpr Epochs::Program kStray{3};

class EpochsTest : public testing::Test {
 protected:
  EpochsTest() {
    epochs_.describe(kBridge, 1, 10);
    EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::adopt);
  }
  Epochs epochs_;
};

TEST(Epochs, StateWaitsForItsDescription) {
  Epochs epochs;
  EXPECT_EQ(epochs.judge(kBridge, 10), Verdict::wait);
  EXPECT_EQ(epochs.epoch(), 0U);
  epochs.describe(kBridge, 1, 10);
  EXPECT_EQ(epochs.judge(kBridge, 10), Verdict::adopt);
  EXPECT_EQ(epochs.judge(kBridge, 10), Verdict::take);
  EXPECT_EQ(epochs.epoch(), 10U);
}

TEST_F(EpochsTest, StrayIsNeverFollowed) {
  EXPECT_EQ(epochs_.judge(kStray, 77), Verdict::wait);
  EXPECT_EQ(epochs_.judge(kStray, 10), Verdict::wait);  // the right epoch of a wrong writer
  EXPECT_EQ(epochs_.epoch(), 10U);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::take);
}

TEST_F(EpochsTest, SecondBridgeIsRefusedUntilTheFirstIsGone) {
  epochs_.describe(kOther, 2, 20);
  EXPECT_EQ(epochs_.judge(kOther, 20), Verdict::foreign);
  EXPECT_FALSE(epochs_.useful(20));
  EXPECT_TRUE(epochs_.useful(10));
  epochs_.lose(kStray);
  EXPECT_EQ(epochs_.judge(kOther, 20), Verdict::foreign);
  epochs_.lose(kBridge);
  EXPECT_EQ(epochs_.judge(kOther, 20), Verdict::adopt);
  EXPECT_FALSE(epochs_.useful(10));
  // The first has come back, and the second goes: its epoch goes on.
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::foreign);
  epochs_.lose(kOther);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::adopt);
  EXPECT_TRUE(epochs_.useful(10));
}

TEST_F(EpochsTest, SecondBridgeThatClaimsTheSameEpochIsRefused) {
  epochs_.describe(kOther, 2, 10);
  EXPECT_EQ(epochs_.judge(kOther, 10), Verdict::foreign);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::take);
}

TEST_F(EpochsTest, BridgeWithANewParticipantGoesOnAtOnce) {
  constexpr Epochs::Program again{4};
  EXPECT_EQ(epochs_.judge(again, 10), Verdict::wait);
  epochs_.describe(again, 1, 10);
  EXPECT_EQ(epochs_.judge(again, 10), Verdict::take);
  EXPECT_TRUE(epochs_.useful(10));
  // The old one is missed later, and nobody else gets in.
  epochs_.lose(kBridge);
  epochs_.describe(kOther, 2, 20);
  EXPECT_EQ(epochs_.judge(kOther, 20), Verdict::foreign);
  EXPECT_EQ(epochs_.judge(again, 10), Verdict::take);
  epochs_.lose(again);
  EXPECT_EQ(epochs_.judge(kOther, 20), Verdict::adopt);
}

TEST_F(EpochsTest, BridgeIsHeardByTwoParticipants) {
  constexpr Epochs::Program network{4};
  epochs_.describe(network, 1, 10);
  EXPECT_EQ(epochs_.judge(network, 10), Verdict::take);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::take);
  epochs_.lose(network);
  epochs_.describe(kOther, 2, 20);
  EXPECT_EQ(epochs_.judge(kOther, 20), Verdict::foreign);
}

TEST_F(EpochsTest, UnknownInstancesAreDifferentBridges) {
  Epochs epochs;
  epochs.describe(kBridge, 0, 10);
  epochs.describe(kOther, 0, 20);
  EXPECT_EQ(epochs.judge(kBridge, 10), Verdict::adopt);
  EXPECT_EQ(epochs.judge(kOther, 20), Verdict::foreign);
}

TEST_F(EpochsTest, BridgeThatNappedGoesOnWithItsEpoch) {
  epochs_.lose(kBridge);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::take);
}

TEST_F(EpochsTest, NextEpochOfTheBridge) {
  EXPECT_TRUE(epochs_.useful(11));  // of a service that was quicker than we
  EXPECT_EQ(epochs_.judge(kBridge, 11), Verdict::wait);
  epochs_.describe(kBridge, 1, 11);
  EXPECT_EQ(epochs_.judge(kBridge, 11), Verdict::adopt);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::left);
  EXPECT_FALSE(epochs_.useful(10));
}

TEST_F(EpochsTest, ManyProgramsCostNoMore) {
  for (std::uint8_t i = 10; i < 250; ++i)
    epochs_.describe({i}, i, i);
  EXPECT_EQ(epochs_.judge(kBridge, 10), Verdict::take);
  EXPECT_EQ(epochs_.judge({249}, 249), Verdict::foreign);
}

}  // namespace
}  // namespace saphira::bus::internal
