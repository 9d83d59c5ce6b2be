// A person stands in the robot's way, over the bus and in lockstep: simulator, bridge, perception,
// registration, behaviors, intentions. The simulator's trace is the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "lockstep.hpp"

namespace saphira::test {
namespace {

// A hall of 12 m by 6 m. The robot's way to the goal leads right through the person.
constexpr const char* kHall =
    "width 12000\nheight 6000\n"
    "500 500 11500 500\n11500 500 11500 5500\n11500 5500 500 5500\n500 5500 500 500\n"
    "position 1500 3000 0\n";
constexpr const char* kPerson = "person bob 5500 3000\n";
constexpr double kWay = 8.0;  // [m]

struct Drive {
  std::optional<v1::GoalStatus> status;
  std::vector<sim::TraceRow> rows;
  std::string output;
};

Drive drive(const std::string& world) {
  LockstepSystem system({.world = world, .robot = "p3dx"});
  const v1::GoalId id =
      system.ask(goal("go_to", {bus::point("position", kWay, 0.0, 0.0, v1::FRAME_ODOM)}));
  system.permit(1500);
  Drive result;
  result.status = system.wait_end(id);
  result.output = system.output();
  result.rows = sim::parse_trace(system.end(), "trace.csv");
  return result;
}

// [m] between the robot's middle and its start line as it passes the person.
double aside(const std::vector<sim::TraceRow>& rows) {
  const auto passes = std::find_if(rows.begin(), rows.end(), [](const sim::TraceRow& row) {
    return row.pose_in_world.x >= 5.5;
  });
  return passes == rows.end() ? 0.0 : std::abs(passes->pose_in_world.y - 3.0);
}

TEST(PeopleAcceptance, ArrivesBehindAPersonWhomItDoesNotTouch) {
  const Drive result = drive(std::string(kHall) + kPerson);
  ASSERT_TRUE(result.status);
  EXPECT_EQ(result.status->state, v1::GOAL_SUCCEEDED) << result.status->reason << "\n"
                                                      << result.output;
  ASSERT_FALSE(result.rows.empty());
  EXPECT_EQ(result.rows.back().contacts, 0);
  EXPECT_NEAR(result.rows.back().pose_in_world.x, 1.5 + kWay, 0.5);
  // Half a person and half a robot.
  EXPECT_GT(aside(result.rows), 0.15 + 0.2);
}

// Without him the same way is straight: the detour is due to him.
TEST(PeopleAcceptance, WayWithoutAPersonIsStraight) {
  const Drive result = drive(kHall);
  ASSERT_TRUE(result.status);
  EXPECT_EQ(result.status->state, v1::GOAL_SUCCEEDED) << result.status->reason;
  EXPECT_LT(aside(result.rows), 0.2);
}

}  // namespace
}  // namespace saphira::test
