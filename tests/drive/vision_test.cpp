// The people and colours that the robot sees while it drives: the right ones, and no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "drive/vision_eyes.hpp"
#include "drive/whole.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

using Kind = lps::SeenThing::Kind;

struct Count {
  int reported = 0;  // people, cycle by cycle
  int right = 0;     // of them, less than 0.6 m from a person
  int visible = 0;
  int found = 0;  // of them
};

// True where `at` is in view, not behind another person or a wall; other objects do not count.
bool visible(Drive& drive, const Vec2& at) {
  const Pose robot = drive.seen().true_pose_in_world;
  const Vec2 in_robot = to_frame(robot, at);
  const double far = in_robot.norm();
  for (const sim::Person& other : drive.scene().persons()) {
    const Vec2 before = to_frame(robot, other.at);
    if (before.norm() < far - 0.1 &&
        std::abs(std::atan2(before.y(), before.x()) - std::atan2(in_robot.y(), in_robot.x())) <
            2.0 * other.plan->radius / before.norm())
      return false;
  }
  return in_robot.x() > 0.8 && far < 5.5 &&
         std::abs(std::atan2(in_robot.y(), in_robot.x())) < radians(22.0) &&
         !sim::cast_ray(drive.world().segments, robot.position(), (at - robot.position()) / far,
                        far);
}

// Drives round those points, or stands.
Count watch(const std::string& world, const std::optional<Pose>& start,
            const std::vector<Vec2>& points, int cycles) {
  Drive drive({.world = world, .start_in_world = start});
  const auto eyes = vision_eyes();
  Count count;
  std::size_t next = 0;
  int since = 0;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    if (!points.empty()) {
      const Pose pose = drive.seen().true_pose_in_world;
      if (++since > 150 || (points[next] - pose.position()).norm() < 0.4) {
        next = (next + 1) % points.size();
        since = 0;
      }
      drive.go_to(
          to_frame(compose(pose, relative(drive.seen().pose_in_odom, Pose{})), points[next]));
    }
    drive.advance();
    const auto things = eyes(drive);
    const Pose now =
        compose(drive.seen().true_pose_in_world, relative(drive.seen().pose_in_odom, Pose{}));
    const auto near = [&](const lps::SeenThing& thing, const Vec2& at) {
      return thing.kind == Kind::person &&
             (transform(now, thing.pose_in_odom.position()) - at).norm() < 0.6;
    };
    for (const lps::SeenThing& thing : things) {
      if (thing.kind != Kind::person || thing.seen != drive.seen().cycle)
        continue;
      ++count.reported;
      const bool right =
          std::any_of(drive.scene().persons().begin(), drive.scene().persons().end(),
                      [&](const sim::Person& person) { return near(thing, person.at); });
      count.right += right;
      if (!right && std::getenv("SAPHIRA_TALK"))
        std::cout << cycle << " robot " << drive.seen().true_pose_in_world.x << " "
                  << drive.seen().true_pose_in_world.y << " nobody at "
                  << transform(now, thing.pose_in_odom.position()).transpose() << " id " << thing.id
                  << " confidence " << thing.confidence << " width " << thing.width << "\n";
    }
    for (const sim::Person& person : drive.scene().persons())
      if (visible(drive, person.at)) {
        ++count.visible;
        count.found += std::any_of(things.begin(), things.end(), [&](const lps::SeenThing& thing) {
          return near(thing, person.at);
        });
      }
  }
  std::cout << "people reported " << count.reported << ", right " << count.right << ", visible "
            << count.visible << ", found " << count.found << "\n";
  return count;
}

const std::vector<Vec2> kFloor{
    {18.5, 25.0}, {12.0, 25.0}, {20.0, 25.0}, {17.5, 16.0}, {17.5, 25.0}};

TEST(VisionEyes, SeeNobodyWhereNobodyIs) {
  const Count count = watch("office-floor", std::nullopt, kFloor, 300);
  EXPECT_EQ(count.reported, 0);
}

// Ann walks up and down the corridor before the robot, Bob comes out of a side corridor and goes
// back.
TEST(VisionEyes, SeePeopleWalk) {
  const std::string world =
      office_with("people",
                  "person ann 17500 25400 walk 14500 25400 700 walk 14500 24700 700 "
                  "walk 18500 24700 700 walk 18500 25400 700 repeat\n"
                  "person bob 17100 21500 walk 17100 25900 800 walk 17100 21500 800 wait 1 repeat");
  const Count count = watch(world, Pose{13.0, 25.0, 0.0}, {}, 300);
  EXPECT_GT(count.visible, 200);
  EXPECT_GT(count.right, 0.98 * count.reported);
  EXPECT_GT(count.found, 0.85 * count.visible);
}

// Paper 4.4: the head scans, and stays on the person while the robot turns and comes near.
TEST(VisionEyes, AHeadFindsAPersonBehindTheRobotAndStaysOnThem) {
  WholeOptions options;
  options.drive.world = office_with("behind", "person ann 17500 10500");
  options.drive.robot = "pioneer-head";
  options.drive.start_in_world = Pose{17.5, 14.0, radians(60.0)};
  options.map = "office-floor";
  options.sees = vision_eyes();
  Whole whole(options);
  const auto goal = whole.ask("attend-person");
  const auto seen = [&] {
    const std::vector<lps::SeenThing>& things = whole.drive().things();
    return std::any_of(things.begin(), things.end(),
                       [](const lps::SeenThing& thing) { return thing.kind == Kind::person; });
  };
  whole.advance_until(seen, 100);
  ASSERT_TRUE(seen());
  EXPECT_LT(std::abs(degrees(norm2_angle(whole.truth().th - radians(60.0)))), 3.0)
      << "the head turned, the robot did not";
  int cycles = 0;
  double worst = 0.0;
  whole.watch(goal, 600, [&] {
    const Vec2 ann = to_frame(whole.truth(), {17.5, 10.5});
    const double off = std::atan2(ann.y(), ann.x()) - whole.drive().seen().head;
    if (++cycles > 15 && !whole.ended(goal))
      worst = std::max(worst, std::abs(norm2_angle(off)));
  });
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_LT(degrees(worst), 15.0) << "of 30 degrees to the edge of the picture";
  EXPECT_NEAR((Vec2(17.5, 10.5) - whole.truth().position()).norm(), 1.0, 0.4);
  for (int i = 0; i < 30; ++i)
    whole.advance();
  EXPECT_NEAR(whole.drive().seen().head, 0.0, radians(3.0)) << "ahead again";
}

// The demo with cameras (deployments/seeing.yaml): whenever one asks, the robot finds the person,
// who may walk away or come up to it, and follows.
TEST(VisionEyes, ThePersonOfTheDemoIsFollowedWheneverOneAsks) {
  const std::string world =
      world_with("small-office", "demo", read_file(config_folder() + "/people/walker.wld"));
  for (const int wait : {150, 297}) {
    WholeOptions options;
    options.drive.world = world;
    options.drive.robot = wait < 200 ? "pioneer" : "pioneer-head";
    options.drive.start_in_world = Pose{0.85, 4.4, 0.0};
    options.drive.guard = true;
    options.drive.seed = static_cast<std::uint64_t>(wait);
    options.map = "small-office";
    options.sees = vision_eyes();
    Whole whole(options);
    for (int cycle = 0; cycle < wait; ++cycle)
      whole.advance();
    const auto status = whole.achieve("follow-person", {saphira::number("seconds", 10.0)}, 900);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED)
        << status.reason << ", asked after " << wait << " cycles";
    EXPECT_LT((whole.drive().scene().persons()[0].at - whole.truth().position()).norm(), 4.0)
        << wait;
    EXPECT_EQ(whole.drive().contacts(), 0) << wait;
  }
}

// A Pioneer 1 drives at 0.4 m/s at most. Ann walks away from it, around a corner, and waits.
TEST(VisionEyes, APersonWhoWalksAwayAroundACornerIsFollowed) {
  for (const char* const robot : {"pioneer", "p3dx"}) {
    WholeOptions options;
    options.drive.world = office_with(
        "corner", "person ann 17500 12000 wait 4 walk 17500 7000 600 walk 24000 7000 600 wait 99");
    options.drive.robot = robot;
    options.drive.start_in_world = Pose{17.5, 14.0, radians(-90.0)};
    options.drive.guard = true;
    options.map = "office-floor";
    options.sees = vision_eyes();
    Whole whole(options);
    const auto goal = whole.ask("follow-person");
    const auto distance = [&] {
      return (whole.drive().scene().persons()[0].at - whole.truth().position()).norm();
    };
    const auto with_ann = [&] { return whole.truth().x > 22.0 && distance() < 1.3; };
    whole.advance_until([&] { return whole.ended(goal) || with_ann(); }, 900);
    EXPECT_TRUE(with_ann()) << robot << ": " << whole.status(goal).reason;
    EXPECT_EQ(whole.drive().contacts(), 0);
  }
}

// Manual 9.3, search_and_go_blob: behind its back at first.
TEST(VisionEyes, AColorIsSearchedForAndApproached) {
  WholeOptions options;
  options.drive.world = office_with("can", "post can 17800 10500 80 color red tall 300");
  options.drive.start_in_world = Pose{17.5, 14.0, radians(90.0)};
  options.map = "office-floor";
  options.sees = vision_eyes(false);
  Whole whole(options);
  const auto status = whole.achieve("blob-search", {saphira::text("channel", "a")}, 1800);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_LT((whole.truth().position() - Vec2(17.8, 10.5)).norm(), 0.8);
  EXPECT_EQ(whole.drive().contacts(), 0);
}

// An obstacle before the colour is not the colour.
TEST(VisionEyes, SomethingOnTheWayToAColorIsPassed) {
  for (const double distance : {0.6, 1.0}) {
    WholeOptions options;
    options.drive.world = office_with(
        "can", "post can 17800 10500 80 color red tall 300\npost bin 17600 12000 100 tall 200");
    options.drive.start_in_world = Pose{17.5, 14.0, radians(-90.0)};
    options.map = "office-floor";
    options.sees = vision_eyes(false);
    Whole whole(options);
    const auto status =
        whole.achieve("blob-search",
                      {saphira::text("channel", "a"), saphira::number("distance", distance)}, 1800);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
    EXPECT_NEAR((whole.truth().position() - Vec2(17.8, 10.5)).norm(), distance, 0.2);
    EXPECT_EQ(whole.drive().contacts(), 0);
  }
}

}  // namespace
}  // namespace saphira::test
