#include "saphira/console/detour.hpp"

#include <gtest/gtest.h>

namespace saphira::console {
namespace {

TEST(Detour, IsWantedForAWhileAfterAnOldCycle) {
  Detour detour;
  EXPECT_FALSE(detour.wanted(0.0));
  detour.shows(97, 100, 1.0);
  EXPECT_FALSE(detour.wanted(1.0)) << "a near link";
  detour.shows(106, 110, 2.0);
  EXPECT_TRUE(detour.wanted(2.0));
  detour.shows(129, 130, 4.0);
  EXPECT_TRUE(detour.wanted(11.9));
  EXPECT_FALSE(detour.wanted(12.0));
}

TEST(Detour, NothingIsSentIntoACutLink) {
  Detour detour;
  detour.shows(100, 130, 1.0);
  EXPECT_TRUE(detour.wanted(1.0));
  detour.shows(100, 131, 1.1);
  EXPECT_FALSE(detour.wanted(1.1));
  detour.shows(135, 140, 2.0);
  EXPECT_TRUE(detour.wanted(2.0));
}

TEST(Detour, ACycleOfAnotherEpochIsNotOld) {
  Detour detour;
  detour.shows(5000, 3, 1.0);
  EXPECT_FALSE(detour.wanted(1.0));
}

}  // namespace
}  // namespace saphira::console
