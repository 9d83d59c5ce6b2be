#include "saphira/sim/resume.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "process.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::sim {
namespace {

class ResumeTest : public testing::Test {
 protected:
  static World world() {
    return parse_world(
        "width 10000\nheight 10000\n0 0 10000 0\nposition 2000 2000 0\n"
        "person ann 5000 5000\nbox crate 7000 7000 0 400 600 5\n"
        "door d1 3000 9000 3900 9000 -90\n",
        "test.wld");
  }
  static void add_robot(Scene& scene) {
    scene.add_robot(protocol::load_parameters(test::source("config/robots/pioneer.p")),
                    {2.0, 2.0, 0.0}, 1);
  }

  const World world_ = world();
};

TEST_F(ResumeTest, EverythingIsWhereItWas) {
  Scene before(world_);
  add_robot(before);
  before.robot(0).set_velocity(0.3);
  for (int i = 0; i < 300; ++i)
    before.tick();
  ASSERT_TRUE(before.set_person("ann", {5.0, 6.0}));
  ASSERT_TRUE(before.set_box("crate", {8.0, 7.0, 0.5}));
  ASSERT_TRUE(before.set_door("d1", true));
  const std::string text = places_text(before, "here");

  Scene after(world_);
  add_robot(after);
  EXPECT_EQ(resume(after, text, "here"), "");
  EXPECT_GT(after.robot(0).pose_in_world().x, 2.5);
  EXPECT_EQ(after.robot(0).pose_in_world(), before.robot(0).pose_in_world());
  EXPECT_EQ(after.robot(0).pose_in_odom(), before.robot(0).pose_in_odom());
  EXPECT_EQ(after.robot(0).memory().charge, before.robot(0).memory().charge);
  EXPECT_FALSE(after.robot(0).moving());
  EXPECT_EQ(after.persons()[0].at, Vec2(5.0, 6.0));
  EXPECT_EQ(after.boxes()[0].pose_in_world, before.boxes()[0].pose_in_world);
  EXPECT_TRUE(after.doors()[0].opens);
}

TEST_F(ResumeTest, AnotherWorldStaysAsItIs) {
  Scene scene(world_);
  add_robot(scene);
  const std::string text = places_text(scene, "here");
  scene.robot(0).place({4.0, 4.0, 0.0});
  EXPECT_NE(resume(scene, text, "there"), "");
  EXPECT_EQ(scene.robot(0).pose_in_world().x, 4.0);
}

TEST_F(ResumeTest, ThingsWithoutAPlaceAreNamed) {
  Scene before(world_);
  add_robot(before);
  const std::string text = places_text(before, "here");
  Scene after(world_);
  EXPECT_EQ(resume(after, text, "here"), "robot 0");
  EXPECT_THROW(resume(after, text + "robot zero\n", "here"), std::runtime_error);
}

}  // namespace
}  // namespace saphira::sim
