#include "behavior_parameters.hpp"

#include <gtest/gtest.h>

#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/functions.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

class BehaviorParametersTest : public testing::Test {
 protected:
  World world() const { return {robot, around, beliefs, 1}; }
  Pose goal_of(const BehaviorParameters& parameters) {
    EXPECT_TRUE(parameters.place(placed, world()));
    EXPECT_EQ(placed.at(0).frame, Frame::odom);
    return placed.at(0).point;
  }

  Robot robot;
  Surroundings around;
  Beliefs beliefs;
  Arguments placed;
};

TEST_F(BehaviorParametersTest, WhatIsGivenFromTheRobotStaysWhereItWas) {
  robot.pose_in_odom = {1.0, 0.0, 0.0};
  const BehaviorParameters parameters({{"goal", Value(Point{{2.0, 0.0, 0.0}, Frame::robot})}},
                                      "GoToPos", nullptr, world());
  EXPECT_EQ(goal_of(parameters), (Pose{3.0, 0.0, 0.0}));
  robot.pose_in_odom = {1.5, 0.0, 0.0};
  EXPECT_EQ(goal_of(parameters), (Pose{3.0, 0.0, 0.0}));
}

TEST_F(BehaviorParametersTest, APointOnTheMapIsWhereRegistrationSays) {
  const BehaviorParameters parameters({{"goal", Value(Point{{5.0, 0.0, 0.0}, Frame::map})}},
                                      "GoToPos", nullptr, world());
  EXPECT_FALSE(parameters.place(placed, world())) << "it has never been known";
  robot.odom_in_map = Pose{1.0, 0.0, 0.0};
  EXPECT_EQ(goal_of(parameters).x, 4.0);
  robot.odom_in_map = Pose{1.004, 0.0, 0.0};
  EXPECT_EQ(goal_of(parameters).x, 4.0) << "a few millimetres change no behavior";
  robot.odom_in_map = Pose{1.5, 0.0, 0.0};
  EXPECT_EQ(goal_of(parameters).x, 3.5);
  robot.odom_in_map.reset();
  EXPECT_EQ(goal_of(parameters).x, 3.5) << "lost: where it was";
}

TEST_F(BehaviorParametersTest, WhatMovesIsWhereItIsSeen) {
  std::vector<lps::SeenThing> things(1);
  things[0].id = 7;
  things[0].pose_in_odom = {2.0, 0.0, 0.0};
  around.things = &things;
  const Bindings given{{"goal", Value(Reference{Reference::Kind::kThing, 7, 0})}};
  const BehaviorParameters parameters(given, "GoToPos", nullptr, world());
  EXPECT_EQ(goal_of(parameters).x, 2.0);
  things[0].pose_in_odom.x = 2.5;
  EXPECT_EQ(goal_of(parameters).x, 2.5);
  things.clear();
  EXPECT_EQ(goal_of(parameters).x, 2.5) << "where it was seen last";
  EXPECT_THROW(BehaviorParameters(given, "GoToPos", nullptr, world()), ActivityError);
}

TEST_F(BehaviorParametersTest, AreSpelledAsTheBehaviorDoes) {
  const Bindings given{{"success-radius", Value(0.5)}};
  BehaviorParameters(given, "GoToPos", nullptr, world()).place(placed, world());
  EXPECT_EQ(placed.at(0).name, "success_radius") << "a guess while nobody has told";
  BehaviorSignature known{"GoToPos", std::vector<Parameter>(1)};
  known.parameters[0].name = "Success_Radius";
  placed.clear();
  BehaviorParameters(given, "GoToPos", &known, world()).place(placed, world());
  EXPECT_EQ(placed.at(0).name, "Success_Radius");
  EXPECT_THROW(BehaviorParameters({{"color", Value(1.0)}}, "GoToPos", &known, world()),
               ActivityError);
}

}  // namespace
}  // namespace saphira::intentions
