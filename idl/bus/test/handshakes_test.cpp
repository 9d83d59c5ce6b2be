#include "handshakes.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

constexpr Handshakes::Program kOne{1};
constexpr Handshakes::Program kOther{2};

class HandshakesTest : public testing::Test {
 protected:
  HandshakesTest() { handshakes_.begin(kOne); }

  /// True where one of so many announcements is one too many.
  bool announce(int times, std::chrono::milliseconds apart = std::chrono::milliseconds(250)) {
    bool due = false;
    for (int i = 0; i < times; ++i)
      due = handshakes_.announced(kOne, now_ += apart) || due;
    return due;
  }

  Handshakes handshakes_;
  Handshakes::Time now_{std::chrono::hours(1)};
};

TEST_F(HandshakesTest, AfterAWhileOfAnnouncementsAloneTheProgramIsForgotten) {
  EXPECT_FALSE(announce(Handshakes::kPatience - 1));
  EXPECT_TRUE(announce(1));
  // And again, where it is found again and still not let in.
  EXPECT_FALSE(announce(Handshakes::kPatience - 1));
  EXPECT_TRUE(announce(1));
}

TEST_F(HandshakesTest, WhatWasLetInStays) {
  EXPECT_FALSE(announce(Handshakes::kPatience - 1));
  handshakes_.end(kOne);
  EXPECT_FALSE(announce(2 * Handshakes::kPatience));
}

TEST_F(HandshakesTest, FoundAgainItBeginsAnew) {
  EXPECT_FALSE(announce(Handshakes::kPatience - 1));
  handshakes_.end(kOne);
  handshakes_.begin(kOne);
  EXPECT_FALSE(announce(Handshakes::kPatience - 1));
}

TEST_F(HandshakesTest, ABurstIsOneAnnouncement) {
  EXPECT_FALSE(announce(10 * Handshakes::kPatience, std::chrono::milliseconds(1)));
}

TEST_F(HandshakesTest, OthersDoNotCount) {
  for (int i = 0; i < 2 * Handshakes::kPatience; ++i)
    EXPECT_FALSE(handshakes_.announced(kOther, now_ += std::chrono::milliseconds(250)));
}

}  // namespace
}  // namespace saphira::bus::internal
