#include "saphira/intentions/schema.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "behavior_parameters.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

std::string complaint(const std::string& functor, const Arguments& arguments) {
  const Registry registry = built_in();
  Arguments complete;
  return check_arguments(*registry.find(functor), arguments, complete);
}

TEST(Schema, FillsInTheDefaults) {
  const Registry registry = built_in();
  Arguments complete;
  EXPECT_EQ(check_arguments(*registry.find("go_to"), {point("position", {3, 1, 0})}, complete), "");
  EXPECT_EQ(find(complete, "speed")->number, 0.3);
  EXPECT_EQ(find(complete, "radius")->number, 0.0);
  EXPECT_EQ(find(complete, "patience")->number, 20.0);
  EXPECT_EQ(find(complete, "nothing"), nullptr);
}

TEST(Schema, ANumberMayHaveItsUnit) {
  const Registry registry = built_in();
  Arguments complete;
  EXPECT_EQ(check_arguments(*registry.find("go_to"),
                            {point("position", {3, 1, 0}), text("speed", "20cm/s"),
                             text("radius", "0.5 m"), text("patience", "1min")},
                            complete),
            "");
  EXPECT_EQ(find(complete, "speed")->number, 0.2);
  EXPECT_EQ(find(complete, "radius")->number, 0.5);
  EXPECT_EQ(find(complete, "patience")->number, 60.0);
}

TEST(Schema, RefusesWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {nan, infinity, -infinity}) {
    EXPECT_NE(complaint("drive", {number("speed", wrong)}), "");
    EXPECT_NE(complaint("go_to", {point("position", {wrong, 0, 0})}), "");
    EXPECT_NE(complaint("go_to", {point("position", {0, wrong, 0})}), "");
    EXPECT_NE(complaint("go_to", {point("position", {0, 0, wrong})}), "");
  }
}

// Values that would make a file of goals unreadable, also where every kind is accepted.
TEST(Schema, RefusesPointsThatAreNowhere) {
  Schema schema;
  schema.name = "it";
  for (const bool any : {false, true}) {
    Parameter parameter;
    parameter.name = "where";
    parameter.kind = ArgumentKind::point;
    parameter.any = any;
    schema.parameters = {parameter};
    const auto refused = [&](const Pose& pose) {
      Arguments complete;
      return !check_arguments(schema, {point("where", pose, Frame::robot)}, complete).empty();
    };
    EXPECT_FALSE(refused({10e3, -10e3, -1e3}));
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity(), 1e13}) {
      EXPECT_TRUE(refused({wrong, 0, 0})) << wrong << any;
      EXPECT_TRUE(refused({0, -wrong, 0})) << wrong << any;
      EXPECT_TRUE(refused({0, 0, wrong})) << wrong << any;
    }
  }
}

TEST(Schema, MessagesDoNotRepeatWhateverIsSent) {
  const std::string name(10000, 'x');
  EXPECT_LT(complaint("drive", {number(name, 1)}).size(), 200U);
  EXPECT_EQ(complaint("stop", {number("a\nb\x1b", 1)}).find('\n'), std::string::npos);
}

TEST(Schema, AReloadedSchemaTakesThePlaceOfTheOldOne) {
  Registry registry = built_in();
  Schema schema;
  schema.name = "stop";
  schema.summary = "another";
  registry.add(schema);
  EXPECT_EQ(registry.find("stop")->summary, "another");
  EXPECT_EQ(registry.instead_of("stpo"),
            "did you mean stop? saphira goal activities lists the 6 that there are");
}

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
