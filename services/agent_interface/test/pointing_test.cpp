#include "saphira/agent_interface/pointing.hpp"

#include <gtest/gtest.h>

#include "process.hpp"
#include "saphira/agent_interface/dialogue.hpp"
#include "saphira/base/text.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/stereo.hpp"
#include "saphira/vision/vision.hpp"

namespace saphira::agent_interface {
namespace {

lps::SeenThing person(double x, double y, double points, std::uint64_t pointed) {
  lps::SeenThing thing;
  thing.pose_in_odom = Pose(x, y, 1.0);
  thing.points_in_odom = points;
  thing.pointed = pointed;
  return thing;
}

TEST(Pointing, IsTheNewestArmOfTheLastTwoSecondsOnTheMap) {
  const Pose odom_in_map(10.0, 0.0, kPi / 2.0);
  const auto arm = [&](const std::vector<lps::SeenThing>& things) {
    return pointing(things, 100, odom_in_map, {10.0, 0.0});
  };
  EXPECT_FALSE(arm({}));
  EXPECT_FALSE(arm({person(2.0, 0.0, 0.5, 0), person(2.0, 0.0, 0.5, 80)}));
  const auto one = arm({person(2.0, 0.0, 0.5, 0), person(2.0, 1.0, 0.5, 81)});
  ASSERT_TRUE(one);
  EXPECT_NEAR((one->position() - Vec2(9.0, 2.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(one->th, 0.5 + kPi / 2.0, 1e-12);
  EXPECT_NEAR(arm({person(1.0, 0.0, 0.1, 90), person(2.0, 0.0, 0.2, 91)})->y, 2.0, 1e-12);
  EXPECT_NEAR(arm({person(2.0, 0.0, 0.1, 90), person(1.0, 0.0, 0.2, 90)})->y, 1.0, 1e-12);
}

TEST(Pointing, ADoorwayIsInTheDirectionOfTheArm) {
  const maps::Map map = maps::parse_map(
      "CORRIDOR (1) 5000, 1000, 0, 10000, 2000\nDOOR (2) 3000, 2000, -90, 900\n"
      "DOOR (3) 6000, 2000, -90, 900\nDOOR (4) 3500, 0, 90, 900\n",
      "test.map");
  const auto at = [&](double x, double y, double degrees) {
    const maps::Feature* const door = doorway_at(map, {x, y, radians(degrees)});
    return door == nullptr ? 0U : door->id;
  };
  EXPECT_EQ(at(3.2, 1.4, 90.0), 2U);
  EXPECT_EQ(at(3.2, 1.4, 75.0), 2U);
  EXPECT_EQ(at(3.2, 1.4, 10.0), 3U) << "the farther one, at which the arm points";
  EXPECT_EQ(at(3.2, 1.4, -90.0), 4U) << "the farther side";
  EXPECT_EQ(at(3.2, 1.4, 180.0), 0U);
  EXPECT_EQ(at(0.5, 1.0, 10.0), 2U) << "the nearer of two in one direction";
}

// The office floor: Alice stands before the robot, in a corridor with doorways on both sides.
TEST(Pointing, FromPicturesToKnowledge) {
  struct Case {
    const char* points;
    const char* office;
  };
  const auto text = [](const char* path) { return read_file(test::source(path)); };
  const maps::Map map = maps::parse_map(text("config/maps/office-floor.map"), "office-floor.map");
  const Pose robot_in_map(17.5, 14.8, radians(-90.0));
  for (const Case& one : {Case{"", "EJ-245"},
                          {"point -30 100", "EJ-248"},
                          {"point 150 100", "EJ-247"},
                          {"point -90 100", "EJ-245"}}) {
    const sim::World world = sim::parse_world(
        text("config/worlds/office-floor.wld") + "\nperson alice 17500 12700 " + one.points,
        "office-floor.wld");
    sim::Scene scene(world);
    scene.add_robot({}, robot_in_map, 1);
    const sim::StereoRig rig;
    Random random(5);
    vision::Vision eyes;
    vision::PictureStream stream;
    for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) {
      stream.feed(sim::to_pgm(sim::render_stereo(scene, 0, rig, random), rig, cycle));
      eyes.see(stream.take().value(), Pose{});
    }
    Situation situation;
    situation.map = map;
    situation.pose_in_map = robot_in_map;
    situation.pointing_in_map =
        pointing(eyes.things(15, Pose{}), 15, robot_in_map, robot_in_map.position());
    Dialogue dialogue(Grammar(text("config/grammars/flakey.grammar"), "flakey.grammar"));
    dialogue.hear({{1, 1}, "Alice", "Flakey, this is Karen's office"}, situation);
    EXPECT_EQ(dialogue.knowledge().place_of("karen"), one.office) << one.points;
  }
}

}  // namespace
}  // namespace saphira::agent_interface
