// Which programs are there, by ticks of this one.
#include "peers.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

WriterId end_of(std::uint8_t program, std::uint8_t endpoint) {
  WriterId id{};
  id[0] = program;
  id[15] = endpoint;
  return id;
}

Peers::Program program(std::uint8_t number) {
  return Peers::program_of(end_of(number, 0));
}

class PeersTest : public testing::Test {
 protected:
  PeersTest() {
    peers_.add(ends_);
    peers_.match(ends_, end_of(1, 1));
    peers_.match(ends_, end_of(1, 2));
    peers_.match(ends_, end_of(2, 1));
    peers_.expect(program(1));
    peers_.tick({program(1)});
    wake_->clear();
  }
  void silence(int ticks) {
    for (int i = 0; i < ticks; ++i)
      peers_.tick({});
  }

  std::shared_ptr<Wake> wake_ = std::make_shared<Wake>();
  Peers peers_{wake_};
  Ends ends_{Ends::Side::writers};
};

TEST_F(PeersTest, SilentProgramIsLostOnceWithAllItsEnds) {
  silence(Peers::kSilent - 1);
  EXPECT_EQ(ends_.present(), 3U);
  EXPECT_FALSE(wake_->pending());
  peers_.tick({});
  EXPECT_TRUE(wake_->pending());
  EXPECT_TRUE(peers_.absent(program(1)));
  EXPECT_TRUE(peers_.any_absent(ends_));
  EXPECT_EQ(ends_.present(), 1U);
  EXPECT_EQ(peers_.take_lost(ends_), (std::vector<WriterId>{end_of(1, 1), end_of(1, 2)}));
  silence(10 * Peers::kSilent);
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
}

TEST_F(PeersTest, ProgramWithoutPresenceIsJudgedByDiscoveryAlone) {
  silence(10 * Peers::kSilentAtFirst);
  EXPECT_FALSE(peers_.absent(program(2)));
  peers_.take_lost(ends_);
  peers_.unmatch(ends_, end_of(2, 1));
  EXPECT_EQ(peers_.take_lost(ends_), std::vector<WriterId>{end_of(2, 1)});
}

TEST_F(PeersTest, ProgramThatIsHeardAgainIsThereAgain) {
  silence(Peers::kSilent);
  peers_.take_lost(ends_);
  wake_->clear();
  peers_.tick({program(1)});
  EXPECT_TRUE(wake_->pending());
  EXPECT_EQ(ends_.present(), 3U);
  EXPECT_FALSE(peers_.any_absent(ends_));
  silence(Peers::kSilent);  // and may be lost again
  EXPECT_EQ(peers_.take_lost(ends_).size(), 2U);
}

TEST_F(PeersTest, ProgramThatIsExpectedAndNotHeardHasMoreTime) {
  peers_.expect(program(2));
  silence(Peers::kSilentAtFirst - 1);
  EXPECT_FALSE(peers_.absent(program(2)));
  peers_.tick({});
  EXPECT_TRUE(peers_.absent(program(2)));
}

TEST_F(PeersTest, ProgramThatIsKilledWhileItJoinsIsLost) {
  peers_.join(program(2));  // its presence is never matched
  peers_.join(program(3));
  peers_.match(ends_, end_of(3, 1));
  silence(Peers::kSilentAtFirst - 1);
  EXPECT_FALSE(peers_.absent(program(2)));
  EXPECT_FALSE(peers_.absent(program(3)));
  peers_.take_lost(ends_);
  peers_.tick({});
  EXPECT_TRUE(peers_.absent(program(2)));
  EXPECT_EQ(peers_.take_lost(ends_), (std::vector<WriterId>{end_of(2, 1), end_of(3, 1)}));
  EXPECT_TRUE(peers_.any_absent(ends_));

  // Discovery ends the matches at last, and nothing is told twice or left.
  peers_.leave(program(2));
  peers_.unmatch(ends_, end_of(2, 1));
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
  EXPECT_FALSE(peers_.absent(program(2)));
  peers_.match(ends_, end_of(2, 1));  // of a program that sends no presence
  silence(Peers::kSilentAtFirst);
  EXPECT_FALSE(peers_.absent(program(2)));
}

TEST_F(PeersTest, ProgramThatJoinsIsNotExpectedBeforeAMatch) {
  peers_.join(program(4));  // of another robot
  silence(Peers::kSilentAtFirst);
  EXPECT_FALSE(peers_.absent(program(4)));
}

TEST_F(PeersTest, EndOfAnAbsentProgramIsNotLostASecondTime) {
  silence(Peers::kSilent);
  EXPECT_EQ(peers_.take_lost(ends_).size(), 2U);
  // Discovery drops it, in whatever order.
  peers_.unmatch(ends_, end_of(1, 1));
  peers_.forget(program(1));
  peers_.unmatch(ends_, end_of(1, 2));
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
  EXPECT_EQ(ends_.present(), 1U);
  // Found anew: nothing of its past is left.
  peers_.match(ends_, end_of(1, 1));
  EXPECT_EQ(ends_.present(), 2U);
  EXPECT_FALSE(peers_.absent(program(1)));
}

TEST_F(PeersTest, ProgramThatEndsInGoodOrderIsLostOnce) {
  peers_.forget(program(1));
  peers_.unmatch(ends_, end_of(1, 1));
  peers_.unmatch(ends_, end_of(1, 2));
  EXPECT_EQ(peers_.take_lost(ends_).size(), 2U);
  silence(Peers::kSilent);
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
}

TEST_F(PeersTest, MatchOfAnAbsentProgramCountsWhenItIsHeard) {
  silence(Peers::kSilent);
  peers_.match(ends_, end_of(1, 3));
  EXPECT_EQ(ends_.present(), 1U);
  peers_.tick({program(1)});
  EXPECT_EQ(ends_.present(), 4U);
}

TEST_F(PeersTest, ProgramThatIsHeardAgainReturnsWithTheEndsThatWereLost) {
  const std::vector<WriterId> both{end_of(1, 1), end_of(1, 2)};
  EXPECT_TRUE(peers_.take_returned(ends_).empty());
  silence(Peers::kSilent);
  EXPECT_TRUE(peers_.take_returned(ends_).empty());
  EXPECT_EQ(peers_.take_lost(ends_), both);
  peers_.tick({program(1)});
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
  EXPECT_EQ(peers_.take_returned(ends_), both);
  EXPECT_TRUE(peers_.take_returned(ends_).empty());
  // Of an end that is lost once more the return counts for nothing.
  silence(Peers::kSilent);
  EXPECT_EQ(peers_.take_lost(ends_), both);
  peers_.tick({program(1)});
  silence(Peers::kSilent);
  EXPECT_TRUE(peers_.take_returned(ends_).empty());
  EXPECT_EQ(peers_.take_lost(ends_), both);
}

TEST_F(PeersTest, ALossThatNobodyNoticedIsNone) {
  silence(Peers::kSilent);
  peers_.tick({program(1)});
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
  EXPECT_TRUE(peers_.take_returned(ends_).empty());
}

// Its match sends what it has declared.
TEST_F(PeersTest, AnEndThatIsMatchedLateAfterARestartDoesNotReturnByItself) {
  peers_.restart(ends_);
  peers_.match(ends_, end_of(1, 2));
  for (int i = 0; i < Peers::kRestart; ++i)
    peers_.tick({program(1)});
  EXPECT_EQ(peers_.take_lost(ends_), (std::vector<WriterId>{end_of(1, 1), end_of(2, 1)}));
  peers_.match(ends_, end_of(1, 1));
  EXPECT_EQ(ends_.present(), 2U);
  EXPECT_TRUE(peers_.take_returned(ends_).empty());
}

TEST_F(PeersTest, WhatWasAbsentBeforeARestartReturnsWhenItIsHeard) {
  silence(Peers::kSilent);
  EXPECT_EQ(peers_.take_lost(ends_).size(), 2U);
  peers_.restart(ends_);
  peers_.expect(program(1));
  peers_.match(ends_, end_of(1, 1));
  peers_.tick({program(1)});
  EXPECT_EQ(peers_.take_returned(ends_), std::vector<WriterId>{end_of(1, 1)});
}

TEST_F(PeersTest, AfterARestartWhatIsNotMatchedAgainIsLost) {
  peers_.restart(ends_);
  EXPECT_EQ(ends_.present(), 0U);
  peers_.match(ends_, end_of(1, 2));
  for (int i = 0; i < Peers::kRestart - 1; ++i)
    peers_.tick({program(1)});
  EXPECT_TRUE(peers_.take_lost(ends_).empty());
  peers_.tick({program(1)});
  EXPECT_EQ(peers_.take_lost(ends_), (std::vector<WriterId>{end_of(1, 1), end_of(2, 1)}));
  EXPECT_EQ(ends_.present(), 1U);
}

}  // namespace
}  // namespace saphira::bus::internal
