// Functions about the people and colours that a camera sees.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/navigation.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::intentions {
namespace {

using lps::SeenThing;

class Seeing : public testing::Test {
 protected:
  Seeing() {
    add_navigation(functions);
    robot.connected = true;
    robot.pose_in_odom = {1.0, 0.0, 0.0};
    around.cycle = 100;
    around.things = &things;
    person(7, {4.0, 0.0, kPi}, 90);
    person(8, {1.0, 2.0, -kPi / 2}, 100);
    SeenThing blob;
    blob.id = 9;
    blob.kind = SeenThing::Kind::blob;
    blob.channel = 1;
    blob.pose_in_odom = {3.0, -2.0, 0.0};
    blob.range_known = false;
    blob.area = 0.02;
    blob.seen = 100;
    things.push_back(blob);
  }
  void person(std::uint32_t id, const Pose& pose, std::uint64_t seen) {
    SeenThing made;
    made.id = id;
    made.pose_in_odom = pose;
    made.velocity_in_odom = {0.3, 0.4};
    made.confidence = 0.9;
    made.seen = seen;
    things.push_back(made);
  }
  Value call(const std::string& name, const std::vector<Value>& arguments) {
    const Function* const function = functions.function(name);
    EXPECT_NE(function, nullptr) << name;
    return function->call({robot, around, beliefs, 1000}, arguments);
  }
  double number(const std::string& name, const std::vector<Value>& arguments) {
    const Value value = call(name, arguments);
    EXPECT_NE(value.number(), nullptr) << name << " gave " << to_text(value);
    return value.number() == nullptr ? 1e9 : *value.number();
  }

  Functions functions = core_functions();
  Beliefs beliefs{&functions};
  Robot robot;
  Surroundings around;
  std::vector<SeenThing> things;
};

TEST_F(Seeing, TheNearestOfItsKind) {
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 8 0)");
  robot.pose_in_odom = {3.0, 0.0, 0.0};
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 7 0)");
  EXPECT_EQ(to_text(call("seen", {"blob"})), "(thing 9 0)");
  EXPECT_EQ(to_text(call("seen", {"blob-b"})), "(thing 9 0)");
  EXPECT_TRUE(call("seen", {"blob-a"}).nil());
  EXPECT_TRUE(call("seen", {"door"}).nil());
  EXPECT_THROW(call("seen", {"blob-d"}), ActivityError);
  EXPECT_THROW(call("seen", {"cat"}), ActivityError);
}

TEST_F(Seeing, WhoIsOutOfSightDoesNotHideWhoIsInSight) {
  robot.pose_in_odom = {3.0, 0.0, 0.0};
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 7 0)");
  around.cycle = 101;  // now it has not seen him for more than a second
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 8 0)");
  around.cycle = 120;  // and nobody
  EXPECT_EQ(to_text(call("seen", {"person"})), "(thing 7 0)");
}

TEST_F(Seeing, AThingHasAPlaceADistanceAndABearing) {
  const Value ann = call("seen", {"person"});
  ASSERT_NE(call("place-of", {ann}).point(), nullptr);
  EXPECT_EQ(*call("place-of", {ann}).point(), (Point{{1.0, 2.0, -kPi / 2}, Frame::odom}));
  EXPECT_NEAR(number("distance-to", {ann}), 2.0, 1e-9);
  EXPECT_NEAR(number("bearing-of", {ann}), kPi / 2, 1e-9);
  EXPECT_NEAR(number("speed-of", {ann}), 0.5, 1e-9);
  EXPECT_NEAR(number("confidence-of", {ann}), 0.9, 1e-9);
  const Value later = call("predicted-place", {ann, 2.0});
  EXPECT_NEAR(later.point()->pose.x, 1.6, 1e-9);
  EXPECT_NEAR(later.point()->pose.y, 2.8, 1e-9);
}

TEST_F(Seeing, WhatWasSeenLastAndWhatIsForgotten) {
  robot.pose_in_odom = {3.0, 0.0, 0.0};
  const Value far = call("seen", {"person"});
  EXPECT_NEAR(number("seconds-unseen", {far}), 1.0, 1e-9);
  EXPECT_EQ(call("still-seen", {far}), far);
  things.clear();
  EXPECT_TRUE(call("still-seen", {far}).nil());
  EXPECT_TRUE(call("seconds-unseen", {far}).nil());
  EXPECT_TRUE(call("still-seen", {Value()}).nil());
  EXPECT_THROW(call("place-of", {far}), ActivityError);
  EXPECT_THROW(call("still-seen", {1.0}), ActivityError);
}

TEST_F(Seeing, OfABlobOnlyTheDirectionMayBeKnown) {
  const Value blob = call("seen", {"blob"});
  EXPECT_TRUE(call("range-known", {blob}).nil());
  EXPECT_TRUE(call("range-known", {call("seen", {"person"})}).truthy());
  EXPECT_NEAR(number("area-of", {blob}), 0.02, 1e-9);
  EXPECT_NEAR(number("bearing-of", {blob}), -kPi / 4, 1e-9);
}

TEST_F(Seeing, WithoutACameraNothingIsSeen) {
  const auto can_see = [&] {
    return functions.condition("can-see")->value({robot, around, beliefs, 1000}).truthy();
  };
  EXPECT_TRUE(can_see());
  around.things = nullptr;
  EXPECT_FALSE(can_see());
  EXPECT_TRUE(call("seen", {"person"}).nil());
}

TEST_F(Seeing, AReferenceReadsBack) {
  const Value ann = call("seen", {"person"});
  EXPECT_EQ(parse_value(to_text(ann)), ann);
}

}  // namespace
}  // namespace saphira::intentions
