// "Go to room N2" over the whole system in lockstep: the goal on the bus, the activities from their
// files, their behaviors, the map and perception.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "lockstep.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

struct Office : LockstepSystem {
  Office()
      : LockstepSystem({.world = read_file(source("config/worlds/office.wld")),
                        .robot = "pioneer",
                        .map = "office"}) {}
};

TEST(NavigationAcceptance, GoesToARoomByItsName) {
  Office system;
  auto intentions = system.node.reader(bus::topics::kIntentions);
  auto drawings = system.node.reader(bus::topics::kDrawings);
  const v1::GoalId id = system.ask(goal("go-to-place", {bus::text("place", "N2")}));
  system.permit(1500);
  std::set<std::string> schemas;
  std::vector<v1::DrawnPoint> way;
  bool erased = false;
  const auto take_drawings = [&] {
    for (const auto& sample : drawings.take()) {
      if (sample.info.disposed)
        erased = true;
      else if (way.empty())
        way = sample.data.points;
    }
  };
  const std::optional<v1::GoalStatus> status = system.wait_end(id, [&] {
    take_drawings();
    for (const auto& sample : intentions.take())
      for (const v1::IntentionNode& node : sample.data.nodes)
        schemas.insert(node.schema);
  });
  ASSERT_TRUE(status) << system.output();
  EXPECT_EQ(status->state, v1::GOAL_SUCCEEDED) << status->reason << system.output();
  EXPECT_NE(status->reason.find("N2"), std::string::npos) << status->reason;
  for (const char* schema : {"go-to-place", "plan-and-execute", "monitor-planex", "follow-path",
                             "corridor-to-door", "through-door", "FollowCorridor", "FollowDoor"})
    EXPECT_TRUE(schemas.contains(schema)) << schema;
  // The way is drawn on the map, from the robot through the room's door, until its end.
  ASSERT_GE(way.size(), 2u);
  EXPECT_NEAR(way.front().x, 1.5, 0.3);
  EXPECT_TRUE(std::any_of(way.begin(), way.end(), [](const v1::DrawnPoint& at) {
    return std::hypot(at.x - 6.95, at.y - 8.0) < 0.3;
  }));
  EXPECT_TRUE(wait_until([&] {
    take_drawings();
    return erased;
  }));
  const sim::TraceRow truth = sim::parse_trace(system.end(), "trace.csv").back();
  EXPECT_EQ(truth.contacts, 0);
  EXPECT_GT(truth.pose_in_world.x, 4.5);
  EXPECT_LT(truth.pose_in_world.x, 9.0);
  EXPECT_GT(truth.pose_in_world.y, 8.0);
}

}  // namespace
}  // namespace saphira::test
