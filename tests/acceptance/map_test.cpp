// A goal on the map, over the whole system; and a service of perception that is killed on the way.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "system.hpp"

namespace saphira::test {
namespace {

class MapTest : public testing::Test {
 protected:
  /// Down the corridor of the office, which is 6 to 8 m north of the map's origin.
  v1::GoalId go_down_the_corridor() {
    v1::Goal goal;
    goal.functor("go_to");
    goal.arguments({bus::point("position", 11.5, 7.0, 0.0, v1::FRAME_MAP)});
    return system.goals().ask(goal);
  }
  bool wait_tracking(std::chrono::milliseconds limit) {
    return wait_until(
        [&] {
          if (auto newest = registrations.take_newest())
            registration = *newest;
          return registration.state() == v1::REGISTRATION_TRACKING && registration.odom() != 0;
        },
        limit);
  }
  /// How far the robot is from where registration has it [m].
  double error() {
    if (auto newest = registrations.take_newest())
      registration = *newest;
    const Truth truth = system.truth();
    return std::hypot(registration.pose_in_map().x() - truth.x,
                      registration.pose_in_map().y() - truth.y);
  }
  /// The goal's success, which is to come.
  void arrive(const v1::GoalId& goal) {
    const std::optional<v1::GoalStatus> status = system.wait_end(goal);
    ASSERT_TRUE(status) << system.output();
    EXPECT_EQ(status->state(), v1::GOAL_SUCCEEDED) << status->reason() << system.output();
    EXPECT_EQ(system.truth().contacts, 0);
    EXPECT_LT(error(), 0.3);
  }

  System system;
  bus::Reader<v1::Registration> registrations{system.node().reader(bus::topics::kRegistration)};
  v1::Registration registration;
};

TEST_F(MapTest, AGoalOnTheMapIsReached) {
  system.start_all();
  arrive(go_down_the_corridor());
  const Truth truth = system.truth();
  EXPECT_LT(std::hypot(truth.x - 11.5, truth.y - 7.0), 0.5);
}

TEST_F(MapTest, AThingOfTheMapThatIsNotThereIsTakenFromItOnTheWay) {
  system.start_all();
  ASSERT_TRUE(wait_tracking(std::chrono::seconds(30))) << system.output();
  auto maps = system.node().reader(bus::topics::kMap);
  auto requests = system.node().writer(bus::topics::kRegistrationRequest);
  std::optional<v1::Map> map;
  const auto has = [&](std::uint32_t id) {
    if (auto newest = maps.take_newest())
      map = std::move(newest);
    return map && std::any_of(map->artifacts().begin(), map->artifacts().end(),
                              [id](const v1::MapArtifact& each) { return each.id() == id; });
  };
  // By the wall of the corridor, where there is nothing.
  v1::RegistrationRequest request;
  request.source("test");
  request.action(v1::REGISTRATION_PUT);
  request.artifact().id(900);
  request.artifact().type(v1::ARTIFACT_OBJECT);
  request.artifact().pose_in_map().x(5.0);
  request.artifact().pose_in_map().y(7.7);
  request.artifact().length(0.5);
  request.artifact().width(0.5);
  ASSERT_TRUE(wait_until([&] { return requests.matched() > 0; }, std::chrono::seconds(10)));
  requests.write(request);
  ASSERT_TRUE(wait_until([&] { return has(900); }, std::chrono::seconds(10))) << system.output();
  // A goal goes on while the map changes; at the latest on the way back it is missed.
  arrive(go_down_the_corridor());
  if (has(900)) {
    v1::Goal back;
    back.functor("go_to");
    back.arguments({bus::point("position", 2.0, 7.0, 0.0, v1::FRAME_MAP)});
    arrive(system.goals().ask(back));
  }
  EXPECT_FALSE(has(900)) << system.output();
  EXPECT_TRUE(has(112)) << "what a person wrote and is there";
  EXPECT_NE(system.output().find("object 900 is taken from the map"), std::string::npos)
      << system.output();
}

class PerceptionLoss : public MapTest, public testing::WithParamInterface<const char*> {};

TEST_P(PerceptionLoss, AKilledServiceKnowsAgainWhereTheRobotIs) {
  system.start_all();
  const v1::GoalId goal = go_down_the_corridor();
  ASSERT_TRUE(system.wait_moving()) << system.output();
  ASSERT_TRUE(wait_until([&] { return system.truth().x > 4.0; }, std::chrono::seconds(30)))
      << system.output();
  ASSERT_TRUE(wait_tracking(std::chrono::seconds(5))) << system.output();
  const v1::Pose2 before = registration.odom_in_map();
  const std::uint64_t cycle = registration.stamp().cycle();
  system[GetParam()].signal(SIGKILL);
  system.start(GetParam());
  ASSERT_TRUE(wait_until(
      [&] {
        return wait_tracking(std::chrono::milliseconds(10)) &&
               registration.stamp().cycle() > cycle + 10;
      },
      std::chrono::seconds(10)))
      << system.output();
  // Two seconds of the robot's time at the most, and no jump.
  EXPECT_LE(registration.stamp().cycle(), cycle + 30) << system.output();
  EXPECT_NEAR(registration.odom_in_map().x(), before.x(), 0.15);
  EXPECT_NEAR(registration.odom_in_map().y(), before.y(), 0.15);
  EXPECT_NEAR(registration.odom_in_map().th(), before.th(), 0.05);
  arrive(goal);
}

INSTANTIATE_TEST_SUITE_P(EachOfThem, PerceptionLoss,
                         testing::Values("saphira-interpretation", "saphira-registration"));

}  // namespace
}  // namespace saphira::test
