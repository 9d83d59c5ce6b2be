#include "saphira/sim/movable.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "broken_text.hpp"
#include "process.hpp"
#include "saphira/sim/scene.hpp"
#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

World world(const std::string& things) {
  return parse_world(
      "width 10000 height 10000 0 0 10000 0 10000 0 10000 10000 10000 10000 0 10000 0 10000 0 0\n" +
          things,
      "things.wld");
}

void run(Scene& scene, double seconds) {
  for (int i = 0; i < std::lround(seconds / kTick); ++i)
    scene.tick();
}

TEST(Movable, IsReadInItsFrame) {
  const World it = world(
      "push 1000 2000 90\n"
      "person ann 500 0 tall 1600 wide 600 color red walk 1500 0 800 wait 2.5 repeat\n"
      "door d1 0 0 900 0 -90 open 5 close 10 period 20\n"
      "box crate 1000 -1000 0 600 400 5\n"
      "post ball 2000 0 100 color orange\n"
      "pop robot 3000 4000 180");
  ASSERT_EQ(it.movable.persons.size(), 1U);
  const PersonPlan& ann = it.movable.persons[0];
  EXPECT_EQ(ann.look.name, "ann");
  EXPECT_EQ(ann.look.color, "red");
  EXPECT_DOUBLE_EQ(ann.look.height, 1.6);
  EXPECT_DOUBLE_EQ(ann.radius, 0.3);
  EXPECT_NEAR((ann.at - Vec2(1.0, 2.5)).norm(), 0.0, 1e-12);
  ASSERT_EQ(ann.script.size(), 2U);
  EXPECT_NEAR((ann.script[0].to - Vec2(1.0, 3.5)).norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(ann.script[0].speed, 0.8);
  EXPECT_DOUBLE_EQ(ann.script[1].wait, 2.5);
  EXPECT_TRUE(ann.repeats);
  const DoorPlan& door = it.movable.doors.at(0);
  EXPECT_NEAR((door.end - Vec2(1.0, 2.9)).norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(door.swing, -kPi / 2);
  EXPECT_EQ(door.schedule.size(), 2U);
  EXPECT_DOUBLE_EQ(door.period, 20.0);
  const BoxPlan& box = it.movable.boxes.at(0);
  EXPECT_NEAR((box.pose_in_world.position() - Vec2(2.0, 3.0)).norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(box.pose_in_world.th, kPi / 2);
  EXPECT_DOUBLE_EQ(box.look.height, kBoxHeight);
  EXPECT_EQ(it.movable.posts.at(0).look.color, "orange");
  EXPECT_EQ(it.movable.robots.at(0), (Pose{3.0, 4.0, kPi}));
}

TEST(Movable, WhoLeadsWaitsForTheRobot) {
  const World it = world("person ann 2000 5000 lead 8000 5000 500 position 2000 2000 0");
  Scene scene(it);
  const Person& ann = scene.persons()[0];
  run(scene, 5.0);
  EXPECT_EQ(ann.at, Vec2(2.0, 5.0)) << "no robot is there";
  scene.add_robot(RobotParameters{}, Pose{3.0, 3.5, 0.0}, 1);
  run(scene, 20.0);
  EXPECT_GT(ann.at.x(), 4.9);
  EXPECT_LT(ann.at.x(), 5.1) << "2.5 m from a robot that stays where it is";
}

TEST(Movable, WhoPointsStretchesOutAnArmForThatTime) {
  WorldScene scene(
      world("push 0 0 90 person ann 5000 -5000 wait 1 point -45 2 walk 5000 -6000 500 repeat pop\n"
            "person ben 2000 2000 point 180 1000"));
  const Person& ann = scene.persons()[0];
  EXPECT_FALSE(arm(ann));
  EXPECT_EQ(scene.persons()[1].points, kPi) << "from the beginning";
  run(scene, 1.5);
  ASSERT_TRUE(arm(ann));
  const double diagonal = std::sqrt(0.5);
  EXPECT_NEAR((arm(ann)->from - Vec2(5.0 + 0.2 * diagonal, 5.0 + 0.2 * diagonal)).norm(), 0.0,
              1e-9);
  EXPECT_NEAR((arm(ann)->to - Vec2(5.0 + 0.8 * diagonal, 5.0 + 0.8 * diagonal)).norm(), 0.0, 1e-9);
  Things around;
  scene.add_movable(ann.at, 2.0, kNobody, around);
  EXPECT_EQ(around.segments.size(), 0U) << "no robot is so high";
  run(scene, 2.0);
  EXPECT_FALSE(arm(ann)) << "she walks";
  EXPECT_TRUE(scene.set_arm("ann", 1.0));
  run(scene, 0.5);
  EXPECT_EQ(ann.points, 1.0);
  run(scene, 2.0);
  EXPECT_FALSE(ann.points) << "the script goes on";
  EXPECT_FALSE(scene.set_arm("carl", 1.0));
}

TEST(Movable, OfASecondFileIsPutIntoTheWorldAndItsMistakesNameThatFile) {
  const test::TempDir folder;
  const std::string more = folder.path("more.wld");
  std::ofstream(more) << "; Ann\nperson ann 17500 13000\n";
  const std::string floor = test::source("config/worlds/office-floor.wld");
  const World both = load_world(floor, more);
  EXPECT_EQ(both.file, floor);
  EXPECT_EQ(both.segments.size(), load_world(floor).segments.size());
  ASSERT_EQ(both.movable.persons.size(), 1U);
  std::ofstream(more) << "; in a wall\nperson ann 16500 12000\n";
  try {
    load_world(floor, more);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_NE(std::string(error.what()).find("more.wld"), std::string::npos) << error.what();
  }
}

/// A mistake in the line behind the world's size.
struct BrokenLine {
  const char* text;
  int column;
  const char* expected;
};

class BrokenThing : public ::testing::TestWithParam<BrokenLine> {};

TEST_P(BrokenThing, SaysWhereAndWhatWasExpected) {
  test::expect_mistake({GetParam().text, 2, GetParam().column, GetParam().expected}, world);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenThing,
    ::testing::Values(
        BrokenLine{"person", 7, "a name"}, BrokenLine{"person ann x 0", 12, "x of the person"},
        BrokenLine{"walk 0 0 800", 1, "person before this walk"},
        BrokenLine{"stubborn", 1, "person before this stubborn"},
        BrokenLine{"point 90 5", 1, "person before this point"},
        BrokenLine{"person ann 1000 1000 point left 5", 28, "direction in degrees"},
        BrokenLine{"person ann 0 0 walk 1 1 0", 25, "speed"},
        BrokenLine{"person ann 0 0 repeat", 16, "walk, lead, wait or point"},
        BrokenLine{"lead 0 0 800", 1, "person before this lead"},
        BrokenLine{"person ann 0 0 person ann 1 1", 23, "another name"},
        BrokenLine{"door d 0 0 5 0 90", 14, "wider"},
        BrokenLine{"door d 0 0 900 0 200", 18, "swing"},
        BrokenLine{"door d 0 0 900 0 90 open 5 close 4", 34, "in order"},
        BrokenLine{"door d 0 0 900 0 90 period 5", 21, "open or close"},
        BrokenLine{"door d 0 0 900 0 90 open 5 period 4", 35, "no shorter"},
        BrokenLine{"box b 0 0 0 600", 16, "width"}, BrokenLine{"box b 0 0 0 600 0 5", 17, "width"},
        BrokenLine{"post p 0 0", 11, "radius"}, BrokenLine{"color red", 1, "before this color"},
        BrokenLine{"robot 0 0", 10, "theta"}, BrokenLine{"tall 5", 1, "before this tall"},
        BrokenLine{"post a 1 1 60 wide 600", 15, "before this wide"},
        // Mistakes with respect to the walls.
        BrokenLine{"position 5000 -10 0", 1, "in the world"},
        BrokenLine{"robot 10001 5000 0", 1, "in the world"},
        BrokenLine{"position 5 5000 0", 1, "not in a wall"},
        BrokenLine{"post p 5000 5000 100 position 5050 5000 0", 22, "not in the post \"p\""},
        BrokenLine{"robot 5000 5000 0 box b 5000 5100 45 500 500 5", 1, "not in the box \"b\""},
        BrokenLine{"person ann 12000 5000", 1, "in the world"},
        BrokenLine{"person ann 5000 10", 1, "not in a wall"},
        BrokenLine{"person ann 1000 1000 walk 1000 -500 800", 22, "in the world"},
        BrokenLine{"person ann 1000 1000 walk 5000 1000 800 3000 0 3000 2000", 22, "no wall"},
        BrokenLine{"3000 0 3000 2000 person ann 1000 1000 wait 2 walk 1000 3000 800 "
                   "walk 5000 3000 800 walk 5000 500 800 repeat",
                   102, "no wall"},
        BrokenLine{"person ann 1000 1000 walk 5000 1000 800 post p 3000 1050 60", 22, "no post"},
        BrokenLine{"door d 1000 2000 2000 2000 90 1500 0 1500 5000", 1, "no wall"},
        BrokenLine{"door d 9500 2000 10500 2000 90", 1, "in the world"},
        BrokenLine{"box b 5000 200 0 600 500 5", 1, "in the world"},
        BrokenLine{"box b 5000 1000 0 600 500 5 4000 1000 6000 1100", 1, "in no wall"},
        BrokenLine{"post p 5000 50 100", 1, "in no wall"}));

// Valid: against a wall, through a closed door, and in the walls of furniture.
TEST(Movable, WhatStandsCloseIsNotRefused) {
  EXPECT_NO_THROW(world("post p 5000 100 100  box b 5000 1050 0 500 500 5  4000 800 6000 800"));
  EXPECT_NO_THROW(
      world("3000 0 3000 2000  3000 2900 3000 10000  door d 3000 2000 3000 2900 90 "
            "person ann 1000 2450 walk 5000 2450 800 wait 1 walk 1000 2450 800 repeat"));
  EXPECT_NO_THROW(world("person ann 5000 100"));
}

TEST(Movable, PeopleWalkByTheirScripts) {
  WorldScene scene(
      world("person ann 1000 1000 walk 3000 1000 1000 wait 1 walk 1000 1000 500 repeat"));
  run(scene, 1.0);
  EXPECT_NEAR(scene.persons()[0].at.x(), 2.0, 0.011);
  run(scene, 1.5);
  EXPECT_NEAR(scene.persons()[0].at.x(), 3.0, 1e-9);  // waits
  run(scene, 2.5);
  EXPECT_NEAR(scene.persons()[0].at.x(), 2.0, 0.011);
  run(scene, 3.0);
  EXPECT_NEAR(scene.persons()[0].at.x(), 2.0, 0.04);  // and again
}

TEST(Movable, PeopleWaitForRobotsAndRobotsStopAtPeople) {
  WorldScene scene(world("person ann 1000 5000 walk 8000 5000 1000 stubborn"));
  Robot& robot = scene.add_robot({}, {4.0, 5.0, kPi}, 1);
  run(scene, 3.5);
  EXPECT_NEAR(scene.persons()[0].at.x(), 4.0 - 0.22 - 0.25 - 0.1, 0.011);
  EXPECT_GT(robot.clearance(), 0.09);
  robot.set_velocity(0.3);
  run(scene, 2.0);
  EXPECT_EQ(robot.contacts(), 1);
  EXPECT_NEAR(robot.clearance(), 0.0, 1e-6);
  robot.set_velocity(-0.3);
  run(scene, 3.0);
  EXPECT_GT(scene.persons()[0].at.x(), 3.9) << "walks on when the way is free";
}

TEST(Movable, SomebodyWhoWaitedLongGoesElsewhere) {
  WorldScene scene(world("person ann 1000 5000 walk 8000 5000 1000 walk 3000 8000 1000 stubborn"));
  scene.add_robot({}, {4.0, 5.0, kPi}, 1);
  run(scene, 6.0);
  EXPECT_NEAR(scene.persons()[0].at.y(), 5.0, 1e-9) << "waits";
  run(scene, 4.0);
  EXPECT_NEAR(scene.persons()[0].at.y(), 8.0, 1e-9) << "gave this way up";
}

TEST(Movable, PeoplePassARobotInTheirWay) {
  // In a hall 2 m wide; the robot stands still, or comes.
  for (const double speed : {0.0, 0.3}) {
    WorldScene scene(
        world("0 4000 10000 4000 0 6000 10000 6000 person ann 1000 5000 walk 9000 5000 1000"));
    Robot& robot = scene.add_robot({}, {speed > 0.0 ? 8.0 : 5.0, 4.7, kPi}, 1);
    robot.set_velocity(speed);
    const Person& ann = scene.persons()[0];
    double gap = 1.0;
    double wall = 1.0;
    for (int i = 0; i < 2000; ++i) {
      scene.tick();
      gap = std::min(gap, (ann.at - robot.pose_in_world().position()).norm() - 0.22 - 0.25);
      wall = std::min(wall, 1.0 - std::abs(ann.at.y() - 5.0) - 0.25);
    }
    EXPECT_EQ(ann.at, Vec2(9.0, 5.0)) << speed;
    EXPECT_GE(gap, 0.08) << speed;
    EXPECT_GE(wall, 0.10) << speed;
  }
}

TEST(Movable, WithoutRoomPeopleGoBackAndLetTheRobotPass) {
  // In a hall 1.2 m wide. The robot comes at 0.1 m/s.
  WorldScene scene(
      world("0 4400 10000 4400 0 5600 10000 5600 person ann 3000 5000 walk 9000 5000 1000"));
  Robot& robot = scene.add_robot({}, {6.0, 5.0, kPi}, 1);
  robot.set_velocity(0.1);
  const Person& ann = scene.persons()[0];
  run(scene, 22.0);
  EXPECT_NEAR(robot.pose_in_world().x, 3.8, 0.05);
  EXPECT_EQ(robot.contacts(), 0);
  EXPECT_LT(ann.at.x(), 3.0) << "behind the place where she began";
  EXPECT_NEAR(ann.at.y(), 5.0, 1e-9);
}

TEST(Movable, PeopleStepIntoADoorwayAndLetTheRobotPass) {
  // In a hall 1.6 m wide with a doorway of 1 m. The robot comes.
  WorldScene scene(
      world("0 4200 4500 4200 5500 4200 10000 4200 0 5800 10000 5800"
            " person ann 1000 5000 walk 9000 5000 1000"));
  Robot& robot = scene.add_robot({}, {8.0, 5.0, kPi}, 1);
  robot.set_velocity(0.3);
  const Person& ann = scene.persons()[0];
  run(scene, 7.0);
  EXPECT_LT(ann.at.y(), 4.45);
  EXPECT_NEAR(ann.at.x(), 5.0, 0.25);
  run(scene, 13.0);
  EXPECT_EQ(robot.contacts(), 0);
  EXPECT_NEAR(robot.pose_in_world().x, 2.0, 0.1) << "it did not stop";
  EXPECT_EQ(ann.at, Vec2(9.0, 5.0));
}

TEST(Movable, PeopleWhoGiveUpALegWalkThroughNoWall) {
  // The robot stops in the mouth of the doorway in which she waits.
  WorldScene scene(
      world("0 4200 4500 4200 5500 4200 10000 4200 0 5800 10000 5800 person ann 1000 5000"
            " walk 9000 5000 1000 walk 1000 4600 1000 repeat"));
  Robot& robot = scene.add_robot({}, {8.0, 5.0, kPi}, 1);
  const Person& ann = scene.persons()[0];
  double nearest = 1.0;
  const auto run_for = [&](double seconds, double velocity) {
    robot.set_velocity(velocity);
    for (int i = 0; i < static_cast<int>(seconds / kTick); ++i) {
      scene.tick();
      nearest = std::min(nearest, distance(scene.world().segments, ann.at));
    }
  };
  run_for(10.0, 0.3);
  EXPECT_LT(ann.at.y(), 4.45);
  run_for(60.0, 0.0);
  run_for(14.0, 0.3);
  EXPECT_GT(nearest, 0.2);
  EXPECT_GT(ann.at.y(), 4.55) << "she went on";
  EXPECT_EQ(robot.contacts(), 0);
}

TEST(Movable, PeopleStepIntoNoWallAndNobodyElse) {
  // Beside the robot are a wall, and another person.
  WorldScene scene(
      world("0 4600 10000 4600 person ann 1000 5000 walk 9000 5000 1000 person bob 5000 5800"));
  const Robot& robot = scene.add_robot({}, {5.0, 5.0, 0.0}, 1);
  const Person& ann = scene.persons()[0];
  for (int i = 0; i < 2000; ++i) {
    scene.tick();
    ASSERT_GE(ann.at.y() - 4.6, 0.25) << i;
    ASSERT_GE((ann.at - scene.persons()[1].at).norm(), 0.5) << i;
    ASSERT_GE((ann.at - robot.pose_in_world().position()).norm(), 0.25 + 0.22) << i;
  }
  EXPECT_LT(ann.at.x(), 4.0) << "there is no room";
}

TEST(Movable, DoorsKeepTheirSchedule) {
  WorldScene scene(world("door d 5000 5000 5900 5000 90 open 1 close 4 period 10"));
  const auto end = [&] { return scene.leaf(scene.doors()[0]).to; };
  EXPECT_NEAR((end() - Vec2(5.9, 5.0)).norm(), 0.0, 1e-9);
  for (int round = 0; round < 3; ++round) {
    run(scene, 1.5);
    EXPECT_NEAR((end() - Vec2(5.0, 5.0)).norm(), 0.9, 1e-9);
    EXPECT_NEAR(scene.doors()[0].angle, kPi / 4, 0.02) << round;
    run(scene, 1.0);
    EXPECT_NEAR((end() - Vec2(5.0, 5.9)).norm(), 0.0, 1e-9) << round;
    run(scene, 3.0);
    EXPECT_NEAR((end() - Vec2(5.9, 5.0)).norm(), 0.0, 1e-9) << round;
    run(scene, 4.5);
  }
  EXPECT_TRUE(scene.set_door("d", true));
  EXPECT_FALSE(scene.set_door("e", true));
  run(scene, 0.9);
  EXPECT_GT(scene.doors()[0].angle, 1.0);
}

TEST(Movable, ADoorStopsAtARobot) {
  WorldScene scene(world("door d 5000 5000 5900 5000 90"));
  Robot& robot = scene.add_robot({}, {5.5, 5.6, 0.0}, 1);
  scene.set_door("d", true);
  run(scene, 5.0);
  EXPECT_GT(scene.doors()[0].angle, 0.1);
  EXPECT_LT(scene.doors()[0].angle, 1.0);
  EXPECT_GE(robot.clearance(), -1e-9);
  robot.set_velocity(-0.4);
  run(scene, 5.0);
  EXPECT_NEAR(scene.doors()[0].angle, kPi / 2, 1e-9);
}

TEST(Movable, PeopleOpenDoors) {
  WorldScene scene(
      world("5000 0 5000 4500 5000 5500 5000 10000\n"
            "door d 5000 4500 5000 5500 -90 person ann 3000 5000 walk 8000 5000 1000"));
  run(scene, 10.0);
  EXPECT_NEAR(scene.persons()[0].at.x(), 8.0, 1e-9);
  EXPECT_TRUE(scene.doors()[0].opens);
}

TEST(Movable, RobotsPushBoxes) {
  const World it = world("box b 5000 5000 0 400 600 5");
  Scene scene(it);
  Robot& robot = scene.add_robot({}, {4.0, 5.0, 0.0}, 1);
  robot.set_velocity(0.3);
  for (int i = 0; i < 1000; ++i) {
    scene.tick();
    ASSERT_GE(robot.clearance(), -1e-9) << i;
  }
  const Pose box = scene.boxes()[0].pose_in_world;
  EXPECT_NEAR(box.x, robot.pose_in_world().x + 0.22 + 0.2, 1e-3);
  EXPECT_GT(box.x, 6.0);
  EXPECT_NEAR(box.y, 5.0, 1e-6);
  EXPECT_NEAR(box.th, 0.0, 1e-6);
  EXPECT_EQ(robot.contacts(), 0);
  // Against the wall it holds.
  run(scene, 30.0);
  EXPECT_NEAR(scene.boxes()[0].pose_in_world.x, 9.8, 0.01);
  EXPECT_EQ(robot.contacts(), 1);
  EXPECT_TRUE(robot.left_stalled());
  EXPECT_EQ(robot.velocity(), 0.0);
}

TEST(Movable, ABoxThatIsPushedAsideTurns) {
  WorldScene scene(world("box b 5000 5000 0 400 600 5"));
  Robot& robot = scene.add_robot({}, {4.0, 5.2, 0.0}, 1);
  robot.set_velocity(0.3);
  for (int i = 0; i < 300; ++i) {
    scene.tick();
    ASSERT_GE(robot.clearance(), -1e-9) << i;
  }
  EXPECT_LT(scene.boxes()[0].pose_in_world.th, -0.2);
  EXPECT_GT(scene.boxes()[0].pose_in_world.x, 5.02);
}

TEST(Movable, HeavyBoxesStand) {
  WorldScene scene(world("box b 5000 5000 0 400 600 50"));
  Robot& robot = scene.add_robot({}, {4.0, 5.0, 0.0}, 1);
  robot.set_velocity(0.3);
  run(scene, 10.0);
  EXPECT_EQ(scene.boxes()[0].pose_in_world, (Pose{5.0, 5.0, 0.0}));
  EXPECT_EQ(robot.contacts(), 1);
}

// Everything at once, ten minutes, twice.
TEST(Movable, OneSceneOneCourse) {
  const World it = world(
      "person ann 1000 1000 walk 9000 1000 900 walk 9000 9000 1200 walk 1000 1000 700 repeat\n"
      "person bob 9000 8000 walk 1000 8000 900 wait 3 walk 9000 8000 900 repeat\n"
      "door d 5000 4500 5000 5500 -90 open 5 close 15 period 20\n"
      "box b 3000 3000 20 400 600 5 box c 7000 3000 60 500 500 2 post p 6000 7000 200");
  const auto course = [&] {
    Scene scene(it);
    RobotParameters parameters;
    parameters.encode_jitter = parameters.angle_jitter = 0.02;
    Random random(5);
    for (int i = 0; i < 6; ++i)
      scene.add_robot(parameters, {2.0 + i, 2.0, 1.0 * i}, static_cast<std::uint64_t>(i + 1));
    std::vector<double> out;
    for (int i = 0; i < 60000; ++i) {
      if (i % 100 == 0) {
        Robot& robot = scene.robot(random.next() % 6U);
        robot.set_velocity(random.uniform(-0.2, 0.4));
        robot.set_rotation_velocity(random.uniform(-1.0, 1.0));
      }
      scene.tick();
      for (RobotNumber r = 0; i % 10 == 0 && r < 6; ++r)
        EXPECT_GE(scene.robot(r).clearance(), -0.002) << i;
      if (testing::Test::HasFailure())
        break;
    }
    for (RobotNumber r = 0; r < 6; ++r) {
      out.push_back(scene.robot(r).pose_in_odom().x);
      out.push_back(scene.robot(r).contacts());
    }
    for (const Box& box : scene.boxes())
      out.push_back(box.pose_in_world.x + box.pose_in_world.th);
    for (const Person& person : scene.persons())
      out.push_back(person.at.x());
    return out;
  };
  const auto one = course();
  EXPECT_EQ(one, course());
  EXPECT_NE(one[12], 3.0 + radians(20.0)) << "nobody has pushed the box";
}

}  // namespace
}  // namespace saphira::sim
