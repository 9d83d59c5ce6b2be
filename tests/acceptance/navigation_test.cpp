// "Go to room N2" over the whole system: the goal on the bus, the activities from their files, the
// behaviors that they intend, the map and what is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "system.hpp"

namespace saphira::test {
namespace {

TEST(NavigationAcceptance, GoesToARoomByItsName) {
  System system;
  auto intentions = system.node().reader(bus::topics::kIntentions);
  auto drawings = system.node().reader(bus::topics::kDrawings);
  system.start_all();
  v1::Goal goal;
  goal.functor("go-to-place");
  goal.arguments({bus::text("place", "N2")});
  const v1::GoalId id = system.goals().ask(goal);
  std::set<std::string> schemas;
  std::vector<v1::DrawnPoint> way;
  bool erased = false;
  const auto take_drawings = [&] {
    for (const auto& sample : drawings.take()) {
      if (sample.info.disposed)
        erased = true;
      else if (way.empty())
        way = sample.data.points();
    }
  };
  const std::optional<v1::GoalStatus> status = system.wait_end(id, [&] {
    take_drawings();
    for (const auto& sample : intentions.take())
      for (const v1::IntentionNode& node : sample.data.nodes())
        schemas.insert(node.schema());
  });
  ASSERT_TRUE(status) << system.output();
  EXPECT_EQ(status->state(), v1::GOAL_SUCCEEDED) << status->reason() << system.output();
  EXPECT_NE(status->reason().find("N2"), std::string::npos) << status->reason();
  for (const char* schema : {"go-to-place", "plan-and-execute", "monitor-planex", "follow-path",
                             "corridor-to-door", "through-door", "FollowCorridor", "FollowDoor"})
    EXPECT_TRUE(schemas.contains(schema)) << schema;
  // The way is drawn on the map, from the robot through the room's door, until it has been gone.
  ASSERT_GE(way.size(), 2u);
  EXPECT_NEAR(way.front().x(), 1.5, 0.3);
  EXPECT_TRUE(std::any_of(way.begin(), way.end(), [](const v1::DrawnPoint& at) {
    return std::hypot(at.x() - 6.95, at.y() - 8.0) < 0.3;
  }));
  EXPECT_TRUE(wait_until([&] {
    take_drawings();
    return erased;
  }));
  const Truth truth = system.truth();
  EXPECT_EQ(truth.contacts, 0);
  EXPECT_GT(truth.x, 4.5);
  EXPECT_LT(truth.x, 9.0);
  EXPECT_GT(truth.y, 8.0);
  EXPECT_TRUE(system.wait_still());
}

// It means contact, and the guard is on: it touches the wall, slowly.
TEST(NavigationAcceptance, BumpAndGoBumps) {
  System system;
  system.start_all();
  v1::Goal goal;
  goal.functor("turn_to");  // to the corridor's wall, 0.8 m away
  goal.arguments({bus::number("heading", 1.57)});
  ASSERT_TRUE(system.wait_end(system.goals().ask(goal))) << system.output();
  goal.functor("bump-and-go");
  goal.arguments({bus::number("bumps", 1.0)});
  const v1::GoalId id = system.goals().ask(goal);
  Truth before;
  std::optional<double> speed_of_contact;
  const std::optional<v1::GoalStatus> status = system.wait_end(id, [&] {
    const Truth truth = system.truth();
    if (truth.contacts > 0 && !speed_of_contact)
      speed_of_contact = before.velocity;
    before = truth;
  });
  ASSERT_TRUE(status) << system.output();
  EXPECT_EQ(status->state(), v1::GOAL_SUCCEEDED) << status->reason() << system.output();
  EXPECT_EQ(status->reason(), "ran into 1 things");
  ASSERT_TRUE(speed_of_contact) << "it touched nothing";
  EXPECT_LE(*speed_of_contact, 0.12);
}

}  // namespace
}  // namespace saphira::test
