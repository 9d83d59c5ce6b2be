// A goal on the map, over the whole system, and the loss of a perception service on the way.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <optional>
#include <vector>

#include "lockstep.hpp"
#include "saphira/base/text.hpp"
#include "system.hpp"

namespace saphira::test {
namespace {

/// The corridor of the office is 6 to 8 m north of the map's origin; the robot starts at its west
/// end.
v1::Goal go_along_the_corridor(double x) {
  return goal("go_to", {bus::point("position", x, 7.0, 0.0, v1::FRAME_MAP)});
}

/// The true way of a robot that builds a map from nothing, in one process or in many.
std::string way_of_building(bool single_process) {
  constexpr std::uint64_t cycles = 600;
  LockstepSystem system{{.world = read_file(source("config/worlds/office.wld")),
                         .robot = "pioneer",
                         .map = "office",
                         .single_process = single_process}};
  bus::Reader<v1::Registration> registrations{system.node.reader(bus::topics::kRegistration)};
  system.ask(goal("build-map"));
  system.permit(cycles);
  v1::Registration newest;
  EXPECT_TRUE(wait_until(
      [&] {
        system.node.wait(std::chrono::milliseconds(10));
        if (auto sample = registrations.take_newest())
          newest = std::move(*sample);
        return newest.stamp.cycle >= cycles;
      },
      std::chrono::minutes(2)))
      << system.output();
  EXPECT_EQ(newest.reason, "builds the map") << system.output();
  return system.end();
}

// The requests of the activity to registration take effect in the same cycle in every run.
TEST(MapRequests, AreHeardInTheSameCycleInOneProcessAndInMany) {
  const std::string many = way_of_building(false);
  const std::vector<sim::TraceRow> rows = sim::parse_trace(many, "trace.csv");
  EXPECT_NE(rows.back().pose_in_world, rows.front().pose_in_world) << "it drives";
  EXPECT_EQ(many, way_of_building(true));
}

/// Live: the test measures the time until a killed service is back.
class PerceptionLoss : public testing::TestWithParam<const char*> {
 protected:
  bool wait_tracking(std::chrono::milliseconds limit) {
    return wait_until(
        [&] {
          if (auto newest = registrations.take_newest())
            registration = *newest;
          return registration.state == v1::REGISTRATION_TRACKING && registration.odom != 0;
        },
        limit);
  }

  System system;
  bus::Reader<v1::Registration> registrations{system.node().reader(bus::topics::kRegistration)};
  v1::Registration registration;
};

TEST_P(PerceptionLoss, AKilledServiceKnowsAgainWhereTheRobotIs) {
  system.start_all();
  const v1::GoalId goal = system.goals().ask(go_along_the_corridor(4.5));
  ASSERT_TRUE(system.wait_moving()) << system.output();
  ASSERT_TRUE(
      wait_until([&] { return system.truth().pose_in_world.x > 2.0; }, std::chrono::seconds(30)))
      << system.output();
  ASSERT_TRUE(wait_tracking(std::chrono::seconds(30))) << system.output();
  const v1::Pose2 before = registration.odom_in_map;
  const std::uint64_t cycle = registration.stamp.cycle;
  system[GetParam()].signal(SIGKILL);
  system.start(GetParam());
  ASSERT_TRUE(wait_until(
      [&] {
        return wait_tracking(std::chrono::milliseconds(10)) &&
               registration.stamp.cycle > cycle + 10;
      },
      std::chrono::seconds(30)))
      << system.output();
  // At most two seconds of robot time, and no jump.
  EXPECT_LE(registration.stamp.cycle, cycle + 30) << system.output();
  EXPECT_NEAR(registration.odom_in_map.x, before.x, 0.15);
  EXPECT_NEAR(registration.odom_in_map.y, before.y, 0.15);
  EXPECT_NEAR(registration.odom_in_map.th, before.th, 0.05);
  const std::optional<v1::GoalStatus> status = system.wait_end(goal);
  ASSERT_TRUE(status) << system.output();
  EXPECT_EQ(status->state, v1::GOAL_SUCCEEDED) << status->reason << system.output();
  EXPECT_EQ(system.truth().contacts, 0);
  ASSERT_TRUE(wait_tracking(std::chrono::seconds(30)));
  const Pose truth = system.truth().pose_in_world;
  EXPECT_LT(std::hypot(registration.pose_in_map.x - truth.x, registration.pose_in_map.y - truth.y),
            0.3);
}

INSTANTIATE_TEST_SUITE_P(EachOfThem, PerceptionLoss, testing::Values("saphira-registration"));

}  // namespace
}  // namespace saphira::test
