#include "saphira/mcp/lease.hpp"

#include <gtest/gtest.h>

namespace saphira::mcp {
namespace {

TEST(McpLease, AClientThatIsSilentForHalfAMinuteHasLeft) {
  Lease lease(100.0);
  EXPECT_FALSE(lease.is_over(129.9, false, true));
  EXPECT_TRUE(lease.is_over(130.0, false, true));
  lease.came(130.0);
  EXPECT_FALSE(lease.is_over(159.9, false, true));
  EXPECT_FALSE(lease.is_over(500.0, true, true)) << "a stream is open";
  EXPECT_FALSE(lease.is_over(529.9, false, true));
  EXPECT_TRUE(lease.is_over(530.0, false, true));
}

TEST(McpLease, AClientWhoseConnectionBreaksWithAGoalUnderwayHasLeftSoon) {
  Lease lease(100.0);
  EXPECT_FALSE(lease.is_over(200.0, true, true));
  lease.broke(200.0);
  EXPECT_FALSE(lease.is_over(201.4, false, true));
  EXPECT_TRUE(lease.is_over(201.5, false, true)) << "so that the robot stands within 3 s";
  EXPECT_FALSE(lease.is_over(229.9, false, false)) << "without a goal";
}

TEST(McpLease, AClientThatConnectsAgainKeepsItsGoal) {
  Lease lease(100.0);
  lease.broke(200.0);
  lease.came(201.0);
  EXPECT_FALSE(lease.is_over(230.9, false, true));
  EXPECT_TRUE(lease.is_over(231.0, false, true));
}

// A call that waits for the robot's tools begins its goal after the break.
TEST(McpLease, AGoalThatBeginsAfterTheBreakEndsAsWell) {
  Lease lease(100.0);
  lease.broke(100.0);
  EXPECT_FALSE(lease.is_over(103.0, false, false));
  EXPECT_TRUE(lease.is_over(103.1, false, true));
}

}  // namespace
}  // namespace saphira::mcp
