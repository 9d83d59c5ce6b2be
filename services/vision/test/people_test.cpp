#include "saphira/vision/people.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "seen.hpp"

namespace saphira::vision {
namespace {

std::vector<Sight> people_in(const std::string& things, const Pose& robot = {2.0, 3.0, 0.0}) {
  return find_people(bands_of(things, robot));
}

TEST(People, AreFoundWhereTheyStand) {
  for (const auto& [away, aside] :
       {std::pair{1.2, 0.0}, {2.0, 0.5}, {2.5, -0.8}, {3.5, 0.7}, {4.0, 0.0}, {5.0, -1.0}}) {
    const auto found = people_in("person ann " + std::to_string(2000 + int(1000 * away)) + " " +
                                 std::to_string(3000 + int(1000 * aside)));
    ASSERT_EQ(found.size(), 1U) << away << " m away, " << aside << " m aside";
    EXPECT_NEAR(found[0].place_in_robot.x(), away, 3.0 * found[0].sigma_range) << away;
    EXPECT_NEAR(found[0].place_in_robot.y(), aside, 3.0 * found[0].sigma_across) << away;
    EXPECT_NEAR(found[0].width, 0.5, 0.2) << away;
  }
}

// In the distance at which the robot attends to somebody. Nearer the cameras match nothing, and a
// person is not expected to be seen.
TEST(People, AreFoundAsNearAsTheyCanBeExpected) {
  for (const double away : {0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4})
    for (const double aside : {-0.5, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.5}) {
      const Bands seen = bands_of("person ann " + std::to_string(2000 + std::lround(1000 * away)) +
                                  " " + std::to_string(3000 + std::lround(1000 * aside)));
      const bool expected = in_view(seen, {away, aside});
      const std::vector<Sight> found = find_people(seen);
      EXPECT_LE(expected ? 1U : 0U, found.size()) << away << " m away, " << aside << " m aside";
      if (away >= 0.9 && std::abs(aside) < 0.15) {
        EXPECT_TRUE(expected) << away << " m away, " << aside << " m aside";
      }
      if (away < 0.75) {
        EXPECT_FALSE(expected) << away << " m away, " << aside << " m aside";
      }
      for (const Sight& one : found)
        EXPECT_LT((one.place_in_robot - Vec2(away, aside)).norm(), 0.15) << away << ", " << aside;
    }
}

TEST(People, TwoAreTwo) {
  EXPECT_EQ(people_in("person ann 5000 2400 person ben 5200 3600").size(), 2U);
}

// A false person would be followed: walls, doors, boxes, posts and robots are none.
TEST(People, WhatIsNoneIsNoPerson) {
  const char* const things[] = {
      "",
      "box crate 4000 3000 0 400 600 5",
      "box cupboard 5000 3000 20 600 1200 50 tall 2000",
      "post can 4000 3000 250",
      "post pillar 4500 3000 60 tall 2200",
      "5000 2000 5000 3500",
      "5000 3200 5000 6000 5000 0 5000 2400",  // an opening
      "door d 5000 2500 5000 3400 -90",
  };
  for (const char* const each : things)
    for (const double heading : {0.0, 25.0, -40.0})
      EXPECT_TRUE(people_in(each, {2.0, 3.0, radians(heading)}).empty())
          << each << ", heading " << heading;
}

TEST(People, WhoIsBehindSomethingIsNotInView) {
  const Bands seen =
      bands_of("person ann 7000 3000 box cupboard 4000 3000 0 300 1200 50 tall 2000");
  EXPECT_FALSE(in_view(seen, {5.0, 0.0}));
  EXPECT_TRUE(in_view(seen, {4.0, 1.5}));
  EXPECT_FALSE(in_view(seen, {4.0, 4.0}));
  EXPECT_FALSE(in_view(seen, {-2.0, 0.0}));
}

}  // namespace
}  // namespace saphira::vision
