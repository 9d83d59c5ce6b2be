#include "saphira/teleop/pilot.hpp"

#include <gtest/gtest.h>

namespace saphira::teleop {
namespace {

constexpr std::uint64_t kCycle = 90;  ///< on the person's screen

Order held(double velocity = 0.3) {
  Order order;
  order.active = true;
  order.velocity = velocity;
  order.cycle = kCycle;
  order.source = "ann";
  return order;
}
v1::Stamp stamp(std::uint64_t cycle) {
  return {.epoch = 7, .cycle = cycle};
}

TEST(Pilot, SaysNothingBeforeThePersonDrives) {
  Pilot pilot("console");
  EXPECT_FALSE(pilot.drive({}, stamp(100)));
  ASSERT_TRUE(pilot.drive(held(), stamp(100)));
  const auto after = pilot.drive({}, stamp(100));
  ASSERT_TRUE(after) << "a release that got lost comes again";
  EXPECT_FALSE(after->active);
  EXPECT_EQ(after->source, "ann");
}

TEST(Pilot, ACommandAnswersWhatThePersonSees) {
  Pilot pilot("console");
  const auto first = pilot.drive(held(), stamp(100));
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->active);
  EXPECT_EQ(first->stamp.epoch, 7U);
  EXPECT_EQ(first->stamp.cycle, kCycle);
  EXPECT_EQ(first->translation, v1::TRANSLATION_VELOCITY);
  EXPECT_EQ(first->velocity, 0.3);
  const auto second = pilot.drive(held(), stamp(80));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->stamp.cycle, 80U) << "the future cannot be answered";
  EXPECT_GT(second->number, first->number);
  EXPECT_EQ(pilot.drive({}, stamp(100))->stamp.cycle, 100U);
}

TEST(Pilot, TurnsByAnAngleOrAtASpeed) {
  Pilot pilot("keyboard");
  Order order = held();
  order.rotation = 0.5;
  EXPECT_EQ(pilot.drive(order, stamp(100))->rotation, v1::ROTATION_VELOCITY);
  EXPECT_EQ(pilot.drive(order, stamp(100))->rotation_velocity, 0.5);
  order.turn = {0.2, 12};
  const auto turn = pilot.drive(order, stamp(100));
  EXPECT_EQ(turn->rotation, v1::ROTATION_RELATIVE_HEADING);
  EXPECT_EQ(turn->heading, 0.2);
  EXPECT_EQ(turn->move, 12U);
}

TEST(Pilot, HandingBackIsRepeatedAndEndsWhenThePersonDrives) {
  Pilot pilot("keyboard");
  const auto hand_backs = [&] {
    int count = 0;
    for (int i = 0; i < 10; ++i)
      count += pilot.drive({}, stamp(100))->hand_back ? 1 : 0;
    return count;
  };
  pilot.hand_back();
  EXPECT_EQ(hand_backs(), 4);
  pilot.hand_back();
  EXPECT_FALSE(pilot.drive(held(), stamp(100))->hand_back);
  EXPECT_EQ(hand_backs(), 0);
}

TEST(Pilot, PressesUntilTheStopIsLatchedAndLetsGo) {
  Pilot pilot("console");
  EXPECT_FALSE(pilot.stop(false));
  EXPECT_FALSE(pilot.stop(true)) << "somebody else's";
  pilot.press("ann");
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(pilot.stop(false)->active) << i;
  EXPECT_EQ(pilot.stop(false)->source, "ann");
  for (int i = 0; i < 4; ++i)
    ASSERT_FALSE(pilot.stop(true)->active) << i;
  EXPECT_FALSE(pilot.stop(true));
}

TEST(Pilot, KnowsThatItIsRefused) {
  Pilot pilot("console");
  pilot.drive(held(), stamp(100));
  v1::Grant grant;
  v1::Refusal refusal{.role = v1::ROLE_TELEOP, .source = "bob", .reason = "another one drives"};
  grant.refused = {refusal};
  pilot.heard(grant, 1.0);
  EXPECT_EQ(pilot.refusal(1.0), "") << "somebody else is";
  refusal.source = "ann";
  grant.refused = {refusal};
  pilot.heard(grant, 1.0);
  EXPECT_EQ(pilot.refusal(1.2), "another one drives");
  EXPECT_EQ(pilot.refusal(1.5), "");
}

}  // namespace
}  // namespace saphira::teleop
