#include "saphira/intentions/gaze.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "saphira/intentions/beliefs.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

class GazeTest : public testing::Test {
 protected:
  GazeTest() {
    around.head_reach = radians(150.0);
    around.things = &things;
    things.resize(1);
    things[0].id = 7;
  }
  void watch(Value value) { beliefs.set("gaze", std::move(value), "test", 0); }
  /// The next cycle; the head turns at once unless it is stuck.
  std::optional<double> step() {
    ++around.cycle;
    const auto asked = gaze.step({robot, around, beliefs, 0});
    if (asked && !stuck)
      robot.head = *asked;
    return asked;
  }
  double degrees_after(int cycles) {
    for (int i = 0; i < cycles; ++i)
      step();
    return degrees(robot.head);
  }

  Gaze gaze;
  Robot robot;
  Surroundings around;
  Beliefs beliefs;
  std::vector<lps::SeenThing> things;
  bool stuck = false;
};

const Value kPerson(Reference{Reference::Kind::kThing, 7, 0});

TEST_F(GazeTest, FixedCamerasAreLeftAlone) {
  around.head_reach = 0.0;
  watch(radians(90.0));
  EXPECT_EQ(step(), std::nullopt);
}

TEST_F(GazeTest, ADirectionIsAskedForOnceAndEndsAhead) {
  EXPECT_EQ(step(), std::nullopt);
  step();
  watch(radians(90.0));
  EXPECT_EQ(step(), radians(90.0));
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(step(), std::nullopt);
  watch({});
  EXPECT_EQ(step(), 0.0);
}

TEST_F(GazeTest, ADirectionBeyondTheReachIsTheReach) {
  watch(radians(-179.0));
  EXPECT_NEAR(degrees_after(5), -150.0, 1e-9);
}

TEST_F(GazeTest, KeepsAPersonInTheMiddleWhileBothMove) {
  watch(kPerson);
  robot.velocity = 0.3;
  robot.rotation_velocity = radians(30.0);
  things[0].velocity_in_odom = {0.0, 1.0};
  Pose& person = things[0].pose_in_odom;
  person = {3.0, -1.0, 0.0};
  double worst = 0.0;
  for (int i = 0; i < 40; ++i) {
    robot.pose_in_odom.x += 0.1 * robot.velocity * std::cos(robot.pose_in_odom.th);
    robot.pose_in_odom.y += 0.1 * robot.velocity * std::sin(robot.pose_in_odom.th);
    robot.pose_in_odom.th += 0.1 * robot.rotation_velocity;
    person.y += 0.1;
    step();
    const Pose seen = relative(robot.pose_in_odom, person);
    if (i > 5)
      worst = std::max(worst, std::abs(norm2_angle(std::atan2(seen.y, seen.x) - robot.head)));
  }
  EXPECT_LT(degrees(worst), 12.0) << "of 30 degrees to the edge of the picture";
}

TEST_F(GazeTest, StaysOnItsSideOfAPersonBehind) {
  watch(kPerson);
  things[0].pose_in_odom = {-2.0, 0.3, 0.0};
  EXPECT_NEAR(degrees_after(5), 150.0, 1e-9);
  things[0].pose_in_odom = {-2.0, -0.3, 0.0};
  EXPECT_NEAR(degrees_after(5), 150.0, 1e-9)
      << "no turn through 300 degrees for a step to the side";
  things[0].pose_in_odom = {0.0, -2.0, 0.0};
  EXPECT_NEAR(degrees_after(5), -90.0, 1e-9);
}

TEST_F(GazeTest, LooksAheadWhenThePersonIsForgotten) {
  watch(kPerson);
  things[0].pose_in_odom = {0.0, 2.0, 0.0};
  EXPECT_NEAR(degrees_after(5), 90.0, 1e-9);
  things.clear();
  EXPECT_NEAR(degrees_after(5), 0.0, 1e-9);
}

TEST_F(GazeTest, APointOnTheMapNeedsThePlaceOfTheRobot) {
  watch(Point{{0.0, 5.0, 0.0}, Frame::map});
  EXPECT_EQ(degrees_after(5), 0.0);
  robot.odom_in_map = Pose{0.0, 0.0, radians(45.0)};
  EXPECT_NEAR(degrees_after(5), 45.0, 1e-9);
}

TEST_F(GazeTest, AHeadThatHasNotTurnedIsAskedAgain) {
  stuck = true;
  watch(radians(90.0));
  int asked = 0;
  for (int i = 0; i < 45; ++i)
    asked += step() ? 1 : 0;
  EXPECT_EQ(asked, 3);
}

TEST_F(GazeTest, OthersMayTurnTheHeadWhileNothingIsWatched) {
  watch(radians(30.0));
  step();
  step();
  watch({});
  EXPECT_EQ(degrees_after(5), 0.0);
  robot.head = radians(60.0);
  EXPECT_NEAR(degrees_after(50), 60.0, 1e-9);
  watch(0.0);
  EXPECT_EQ(degrees_after(50), 0.0);
}

TEST_F(GazeTest, AnotherEpochBeginsWithTheHeadAsItIs) {
  watch(radians(90.0));
  EXPECT_NEAR(degrees_after(5), 90.0, 1e-9);
  around.cycle = 0;
  robot.head = 0.0;
  EXPECT_EQ(step(), std::nullopt) << "two cycles are between requests";
  EXPECT_EQ(step(), radians(90.0));
}

}  // namespace
}  // namespace saphira::intentions
