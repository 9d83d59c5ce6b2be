// Tests of functors that goals.txt cannot express.
#include "saphira/intentions/functors.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench.hpp"

namespace saphira::intentions {
namespace {

std::vector<std::string> schemas(const std::vector<IntendedBehavior>& behaviors) {
  std::vector<std::string> names;
  names.reserve(behaviors.size());
  for (const IntendedBehavior& behavior : behaviors)
    names.push_back(behavior.schema + "/" + std::to_string(behavior.priority));
  return names;
}

TEST(GoTo, IntendsTheBehaviorsAndArrives) {
  Bench bench;
  bench.begin(1, "go_to", {point("position", {2.0, 1.0, 0.0}), number("speed", 0.4)});
  EXPECT_EQ(schemas(bench.out.behaviors),
            (std::vector<std::string>{"AvoidCollision/0", "KeepOff/1", "GoToPos/2", "Stop/3"}));
  const Arguments parameters = bench.out.behaviors[2].parameters;
  EXPECT_EQ(find(parameters, "goal")->point, (Pose{2.0, 1.0, 0.0}));
  EXPECT_EQ(find(parameters, "speed")->number, 0.4);
  EXPECT_EQ(find(parameters, "radius")->number, 0.15);
  EXPECT_EQ(bench.status(1).step, "driving to (2.00, 1.00)");
  double progress = 0.0;
  for (bench.step(); bench.state(1) == v1::GOAL_UNDERWAY && bench.cycle < 300; bench.step()) {
    EXPECT_GE(bench.status(1).progress, progress);
    progress = bench.status(1).progress;
  }
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED) << bench.status(1).reason;
  EXPECT_NE(bench.status(1).reason.find("arrived, 0."), std::string::npos);
  EXPECT_EQ(bench.status(1).progress, 1.0);
  EXPECT_TRUE(bench.out.behaviors.empty());
  EXPECT_LE((bench.world.robot.pose_in_odom.position() - Vec2(2.0, 1.0)).norm(), 0.15);
}

TEST(GoTo, TakesTheBehaviorsWordWithinReason) {
  Bench bench;
  bench.ask(1, "go_to", {point("position", {0.25, 0.0, 0.0}), number("radius", 0.15)});
  bench.world.held = true;
  bench.step();
  const std::string name = bench.out.behaviors.at(2).name;
  for (int i = 0; i < 3; ++i) {
    bench.world.levels = {{name, 0.95, 0.0}};
    bench.step_without_moving();
  }
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);

  Bench far;
  far.ask(1, "go_to", {point("position", {5.0, 0.0, 0.0}), number("radius", 0.15)});
  far.world.held = true;
  far.step();
  const std::string other = far.out.behaviors.at(2).name;
  for (int i = 0; i < 5; ++i) {
    far.world.levels = {{other, 1.0, 0.0}};
    far.step_without_moving();
  }
  EXPECT_EQ(far.state(1), v1::GOAL_UNDERWAY);
}

// Motion gives more readings. Without it, or without an end to it, a given pose would be an
// arrival.
TEST(GoTo, MovesAboutUntilWhatIsHeardConfirmsWhereItIs) {
  const auto arrives = [](Bench& bench) {
    bench.world.robot.odom_in_map = Pose{};
    bench.registration.state = v1::REGISTRATION_TRACKING;
    bench.registration.confidence = 0.5;
    bench.begin(1, "go_to", {point("position", {1.0, 0.0, 0.0}, Frame::map)});
    for (int i = 0; i < 100 && bench.status(1).step != "moving about to confirm where it is"; ++i)
      bench.step();
    bench.step(50);
    EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
    EXPECT_GT(bench.world.robot.pose_in_odom.x, 1.5) << "it moves about";
  };
  Bench bench;
  arrives(bench);
  bench.registration.confidence = 0.95;
  bench.step(200);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);
  EXPECT_NEAR(bench.world.robot.pose_in_odom.x, 1.0, 0.2);

  Bench never;
  arrives(never);
  for (int i = 0; i < 2000 && never.state(1) == v1::GOAL_UNDERWAY; ++i)
    never.step();
  EXPECT_EQ(never.state(1), v1::GOAL_FAILED);
  EXPECT_EQ(never.status(1).code, v1::CODE_NO_POSITION);
}

TEST(GoTo, AfterAPauseInItsTurnItIsAtItsPointAgainBeforeItTurns) {
  Bench bench;
  bench.begin(1, "go_to", {point("position", {2.0, 0.0, 0.0}), number("facing", 3.0)});
  for (int i = 0; i < 300 && !bench.status(1).step.starts_with("turning"); ++i)
    bench.step();
  bench.begin(2, "go_to", {point("position", {4.0, 1.0, 0.0})}, 5);
  bench.run(2, bench.cycle + 600);
  ASSERT_EQ(bench.state(2), v1::GOAL_SUCCEEDED);
  bench.run(1, bench.cycle + 600, bench.state(1));
  bench.run(1, bench.cycle + 600);
  EXPECT_EQ(bench.state(1), v1::GOAL_SUCCEEDED);
  EXPECT_LE((bench.world.robot.pose_in_odom.position() - Vec2(2.0, 0.0)).norm(), 0.2);
}

TEST(GoTo, AChangeInItsTurnEndsTheTurn) {
  Bench bench;
  bench.begin(1, "go_to", {point("position", {2.0, 0.0, 0.0}), number("facing", 3.0)});
  for (int i = 0; i < 300 && !bench.status(1).step.starts_with("turning"); ++i)
    bench.step();
  bench.begin(1, "go_to", {point("position", {4.0, 0.0, 0.0})});
  std::vector<std::string> names = schemas(bench.out.behaviors);
  std::ranges::sort(names);
  EXPECT_EQ(names,
            (std::vector<std::string>{"AvoidCollision/0", "GoToPos/2", "KeepOff/1", "Stop/3"}));
}

TEST(Drive, AJumpOfDeadReckoningIsNoWay) {
  Bench bench;
  bench.begin(1, "drive", {number("speed", 0.2), number("distance", 10.0)});
  bench.step(10);
  ++bench.world.robot.odom;
  bench.world.robot.pose_in_odom.x += 30.0;
  bench.step(10);
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY) << bench.status(1).reason;
}

TEST(Drive, WhereNothingIsDrivenTheDeadlineIsNoSuccess) {
  Bench bench;
  Goal goal = Bench::goal(1, "drive", {number("speed", 0.2)});
  goal.deadline = 3.0;
  bench.world.held = true;
  bench.write(goal);
  bench.step(50);
  EXPECT_EQ(bench.state(1), v1::GOAL_FAILED);
  EXPECT_EQ(bench.status(1).code, v1::CODE_DEADLINE);
}

// Without AvoidCollision the others would drive on.
TEST(Functors, FailWhereOneOfTheirBehaviorsCannotBeMade) {
  for (const char* const missing : {"AvoidCollision", "ConstantVelocity", "Stop"}) {
    Bench bench;
    bench.begin(1, "drive", {number("speed", 0.2)});
    for (const IntendedBehavior& behavior : bench.out.behaviors)
      if (behavior.schema == missing)
        bench.troubles.push_back({behavior.name, "its file is broken"});
    bench.step();
    EXPECT_EQ(bench.state(1), v1::GOAL_FAILED);
    EXPECT_EQ(bench.status(1).code, v1::CODE_ACTIVITY);
    EXPECT_EQ(bench.status(1).reason, std::string(missing) + ": its file is broken");
    EXPECT_TRUE(bench.out.behaviors.empty());
  }
}

TEST(GoTo, TimesAreToldAsCyclesOfTheRobot) {
  Bench bench;
  bench.cycle = 700;
  bench.step(20);
  bench.begin(1, "go_to", {point("position", {3.0, 0.0, 0.0})});
  const std::uint64_t begun = bench.cycle - 1;  // with the end of the cycle before
  ASSERT_FALSE(bench.out.nodes.empty());
  EXPECT_EQ(bench.executor.cycle_of(bench.out.nodes[0].since), begun);
  bench.step(5);
  EXPECT_EQ(bench.executor.cycle_of(bench.out.nodes[0].since), begun);
}

// The way around an obstacle leads away from the point. A small robot is slow, and gets on.
TEST(GoTo, HasMorePatienceWhileItGetsOn) {
  for (const double radius : {0.03, 0.3}) {
    Bench bench;
    bench.radius = radius;
    bench.ask(1, "go_to", {point("position", {3.0, 0.0, 0.0}), number("patience", 5.0)});
    bench.world.held = true;
    while (bench.cycle < 300 && (bench.cycle == 0 || bench.state(1) == v1::GOAL_UNDERWAY)) {
      bench.step();
      bench.world.robot.pose_in_odom.y += 0.005;  // 0.05 m/s past the obstacle
    }
    EXPECT_EQ(bench.state(1), v1::GOAL_FAILED);
    EXPECT_NEAR(static_cast<double>(bench.cycle), radius < 0.1 ? 150.0 : 50.0, 5.0);
  }
}

TEST(FollowTrail, GoesAroundTheSameCornerAndToItsEnd) {
  Bench bench;
  bench.things.resize(1);
  bench.things[0].id = 7;
  // Ahead to (3, 0), then to the left; out of sight from (3, 2) on.
  const auto person = [&](std::uint64_t cycle) {
    const double way = 1.2 + 0.05 * static_cast<double>(cycle);
    return way < 3.0 ? Pose{way, 0.0, 0.0} : Pose{3.0, std::min(way - 3.0, 2.0), 0.0};
  };
  bench.ask(1, "follow-trail", {number("distance", 1.0), number("speed", 0.3)});
  for (int i = 0; i < 300; ++i) {
    const Pose place = person(bench.cycle + 1);
    bench.things[0].pose_in_odom = place;
    bench.things[0].velocity_in_odom = place.x < 3.0 ? Vec2(0.5, 0.0) : Vec2(0.0, 0.5);
    if (place.y < 2.0)
      bench.things[0].seen = bench.cycle + 1;
    bench.step();
    ASSERT_EQ(schemas(bench.out.behaviors), std::vector<std::string>{"AttendAtPos/2"});
    const Vec2 goal = find(bench.out.behaviors[0].parameters, "goal")->point.position();
    EXPECT_TRUE(std::abs(goal.y()) < 0.2 || goal.x() > 2.8) << goal.transpose();
    bench.world.robot.pose_in_odom.x = std::min(goal.x(), bench.world.robot.pose_in_odom.x + 0.03);
    if (bench.world.robot.pose_in_odom.x > 2.8)
      bench.world.robot.pose_in_odom.y =
          std::min(goal.y(), bench.world.robot.pose_in_odom.y + 0.03);
  }
  EXPECT_EQ(bench.state(1), v1::GOAL_UNDERWAY);
  EXPECT_EQ(bench.status(1).step, "going where it saw a person last");
  EXPECT_NEAR(find(bench.out.behaviors[0].parameters, "goal")->point.y, 1.95, 0.1);
  // A forgotten person: it faces where they went, and stands.
  bench.things.clear();
  bench.step();
  const Arguments& faces = bench.out.behaviors[0].parameters;
  EXPECT_NEAR(find(faces, "goal")->point.x, 3.0, 0.1);
  EXPECT_NEAR(find(faces, "goal")->point.y, 1.95 + 5.0, 0.1);
  EXPECT_EQ(find(faces, "radius")->number, 10.0);
}

TEST(FollowTrail, EndsWhereItSeesNobody) {
  Bench bench;
  bench.ask(1, "follow-trail", {});
  for (int i = 0; i < 29; ++i)
    bench.step();
  EXPECT_EQ(bench.status(1).step, "waiting until it sees a person");
  EXPECT_EQ(bench.status(1).level, 0.0);
  EXPECT_TRUE(bench.out.behaviors.empty());
  for (int i = 0; i < 3; ++i)
    bench.step();
  EXPECT_EQ(bench.state(1), v1::GOAL_FAILED);
}

TEST(FollowTrail, IsAsFastAsThePersonAtTheDistanceAndFasterBeyondIt) {
  const auto speed = [](double away, double leaves) {
    Bench bench;
    bench.things.resize(1);
    bench.things[0].id = 7;
    bench.things[0].pose_in_odom = {away, 0.0, 0.0};
    bench.things[0].velocity_in_odom = {leaves, 0.0};
    bench.things[0].seen = bench.cycle + 1;
    bench.begin(1, "follow-trail", {number("distance", 1.2), number("speed", 0.8)});
    const Arguments& intended = bench.out.behaviors.at(0).parameters;
    return find(intended, "radius")->number == 10.0 ? 0.0 : find(intended, "speed")->number;
  };
  EXPECT_EQ(speed(1.19, 0.3), 0.0);
  EXPECT_NEAR(speed(1.21, 0.3), 0.31, 1e-9);
  EXPECT_NEAR(speed(1.5, 0.3), 0.6, 1e-9);
  EXPECT_NEAR(speed(1.5, 0.0), 0.3, 1e-9);
  EXPECT_NEAR(speed(1.5, -0.5), 0.05, 1e-9) << "the robot waits for a person who approaches";
  EXPECT_NEAR(speed(3.0, 0.3), 0.8, 1e-9);
}

// Some robots do not report that their motors are off.
TEST(GoTo, AsksForTheMotorsOfARobotThatHasNotMovedAtAll) {
  const auto reason = [](double told, bool moves_first, bool stalled) {
    Bench bench;
    bench.ask(1, "go_to", {point("position", {3.0, 0.0, 0.0}), number("patience", 5.0)});
    bench.world.held = !moves_first;
    bench.world.robot.left_stalled = stalled;
    while (bench.cycle < 300 && (bench.cycle == 0 || bench.state(1) == v1::GOAL_UNDERWAY)) {
      bench.world.robot.target_velocity = told;
      bench.step();
      bench.world.held = bench.world.held || bench.cycle > 20;
    }
    EXPECT_EQ(bench.status(1).code, v1::CODE_BLOCKED);
    return bench.status(1).reason;
  };
  EXPECT_EQ(reason(0.3, false, false),
            "no nearer for 5 s, 3.00 m from the point; it has not moved at all: are its motors on? "
            "(saphira device motors on)");
  EXPECT_EQ(reason(0.0, false, false), "no nearer for 5 s, 3.00 m from the point");
  EXPECT_EQ(reason(0.3, false, true), "no nearer for 5 s, 3.00 m from the point");
  EXPECT_EQ(reason(0.3, true, false).find("motors"), std::string::npos);
}

}  // namespace
}  // namespace saphira::intentions
