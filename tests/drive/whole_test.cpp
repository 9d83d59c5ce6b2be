#include "drive/whole.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

namespace saphira::test {
namespace {

using intentions::GoalState;
using saphira::Frame;

WholeOptions office(std::uint64_t seed = 1) {
  WholeOptions options;
  options.drive.seed = seed;
  return options;
}

TEST(Whole, DrivesToAPointOfTheMapByWhatItBelievesAndTheSameEachTime) {
  const auto run = [](std::uint64_t seed) {
    Whole whole(office(seed));
    const auto status =
        whole.achieve("go_to", {saphira::point("position", {17.5, 8.0, 0.0}, Frame::map)}, 600);
    EXPECT_EQ(status.state, GoalState::kSucceeded) << status.reason;
    EXPECT_LT((whole.truth().position() - Vec2(17.5, 8.0)).norm(), 0.4);
    EXPECT_EQ(whole.drive().contacts(), 0);
    EXPECT_TRUE(whole.at_rest());
    return whole.truth();
  };
  const Pose first = run(1);
  EXPECT_EQ(run(1), first);
  EXPECT_NE(run(2), first);
}

TEST(Whole, GoesToAPlaceByItsName) {
  Whole whole(office());
  const auto status = whole.achieve("go-to-place", {saphira::text("place", "EJ-231")}, 3000);
  EXPECT_EQ(status.state, GoalState::kSucceeded) << status.reason;
  if (std::getenv("SAPHIRA_TALK"))
    for (const std::string& line : whole.transitions())
      std::cout << line << "\n";
  EXPECT_EQ(whole.drive().contacts(), 0);
  EXPECT_EQ(whole.trouble(), "");
  EXPECT_TRUE(whole.at_rest());
}

}  // namespace
}  // namespace saphira::test
