#include "saphira/sim/movable.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/sim/scene.hpp"
#include "trouble.hpp"
#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::RobotParameters;

void run(Scene& scene, double seconds) {
  for (int i = 0; i < std::lround(seconds / kTick); ++i)
    scene.tick();
}

TEST(Movable, IsReadInItsFrame) {
  const World it = room(
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

TEST(Movable, WhoPointsStretchesOutAnArmForThatTime) {
  WorldScene scene(
      room("push 0 0 90 person ann 5000 -5000 wait 1 point -45 2 walk 5000 -6000 500 repeat pop\n"
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
  EXPECT_TRUE(
      test::has(test::trouble_of<FileError>([&] { load_world(floor, more); }), "more.wld:2:"));
}

TEST(Movable, MistakesAreNamedWithTheirPlaceAndWhatWasExpected) {
  const int mistakes = test::each_mistake("sim/test/mistakes.txt", room);
  EXPECT_EQ(mistakes, 39);
  for (const char* const well :
       {"post p 5000 100 100  box b 5000 1050 0 500 500 5  4000 800 6000 800",
        "3000 0 3000 2000  3000 2900 3000 10000  door d 3000 2000 3000 2900 90 person ann 1000 "
        "2450 "
        "walk 5000 2450 800 wait 1 walk 1000 2450 800 repeat",
        "person ann 5000 100"})
    EXPECT_NO_THROW(room(well)) << well;
}

// Everything at once, ten minutes, twice.
TEST(Movable, OneSceneOneCourse) {
  const World it = room(
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
