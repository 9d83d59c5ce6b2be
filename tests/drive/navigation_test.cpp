// The library of activities (config/activities) in the simulated office floor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "drive/eyes.hpp"
#include "drive/whole.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

using intentions::GoalCode;
using intentions::GoalState;
using intentions::GoalStatus;
using saphira::Frame;
using saphira::text;

WholeOptions office(std::uint64_t seed = 1, const std::string& world = "office-floor") {
  WholeOptions options;
  options.map = "office-floor";
  options.drive.world = world;
  options.drive.seed = seed;
  return options;
}

bool is_in(const Whole& whole, const std::string& place) {
  const maps::Topology topology = whole.topology();
  const auto meant = topology.place(place);
  return std::any_of(meant->regions.begin(), meant->regions.end(), [&](std::size_t region) {
    return maps::contains(topology.regions()[region].area, whole.truth().position());
  });
}

/// People's answer to the robot's words. Each is given once, in the order of the list.
struct Answer {
  std::string to;  ///< a part of the robot's words
  std::string name;
  intentions::Value value;
  std::string speaker{};  ///< empty: not known
};

class People {
 public:
  explicit People(std::vector<Answer> answers) : answers_(std::move(answers)) {}

  void listen(Whole& whole) {
    for (; heard_ < whole.said().size(); ++heard_)
      if (next_ < answers_.size() &&
          whole.said()[heard_].find(answers_[next_].to) != std::string::npos) {
        whole.claim(answers_[next_].name, answers_[next_].value, answers_[next_].speaker);
        ++next_;
      }
  }
  bool all_answered() const { return next_ == answers_.size(); }

 private:
  std::vector<Answer> answers_;
  std::size_t heard_ = 0;
  std::size_t next_ = 0;
};

/// Runs until the goal has ended, among people who answer.
GoalStatus among(Whole& whole, People& people, const intentions::GoalId& goal, int cycles) {
  whole.advance_until(
      [&] {
        people.listen(whole);
        return whole.ended(goal);
      },
      cycles);
  return whole.status(goal);
}

const intentions::Value kYes = intentions::Value::truth(true);

bool said(const Whole& whole, const std::string& part) {
  return std::any_of(whole.said().begin(), whole.said().end(),
                     [&](const std::string& each) { return each.find(part) != std::string::npos; });
}

TEST(Whole, DrivesToAPointOfTheMapByWhatItBelievesAndTheSameEachTime) {
  const auto run = [](std::uint64_t seed) {
    Whole whole(office(seed));
    const auto status =
        whole.achieve("go_to", {saphira::point("position", {17.5, 8.0, 0.0}, Frame::map)}, 600);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
    EXPECT_LT((whole.truth().position() - Vec2(17.5, 8.0)).norm(), 0.4);
    EXPECT_EQ(whole.drive().contacts(), 0);
    EXPECT_TRUE(whole.at_rest());
    return whole.truth();
  };
  const Pose first = run(1);
  EXPECT_EQ(run(1), first);
  EXPECT_NE(run(2), first);
}

TEST(Navigation, AtItsEndItFacesAsAsked) {
  for (const double facing : {90.0, -170.0}) {
    for (const bool by_route : {false, true}) {
      Whole whole(office());
      const saphira::Argument heading = saphira::number("facing", radians(facing));
      const auto status =
          by_route ? whole.achieve("go-to-place", {text("place", "EJ-231"), heading}, 1200)
                   : whole.achieve(
                         "go_to",
                         {saphira::point("position", {17.5, 8.0, 0.0}, Frame::map), heading}, 700);
      EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
      EXPECT_NEAR(degrees(norm2_angle(whole.truth().th - radians(facing))), 0.0, 9.0) << by_route;
      EXPECT_TRUE(whole.at_rest());
    }
  }
}

// Within a tenth of the way and 2.5 cm of rolling out.
TEST(Navigation, AWayToANearPointEndsWithinATenthOfIt) {
  for (const Frame frame : {Frame::robot, Frame::map})
    for (const double way : {0.05, 0.1, 0.3, 1.0})
      for (const double bearing : {0.0, 90.0, 180.0}) {
        Whole whole(office());
        whole.achieve("go_to", {saphira::point("position", {17.1, 11.0, 0.0}, Frame::map)}, 600);
        const Pose start = whole.drive().seen().pose_in_odom;
        const Pose asked{way * std::cos(radians(bearing)), way * std::sin(radians(bearing)), 0.0};
        const auto status = whole.achieve(
            "go-to-place",
            {saphira::point("place", frame == Frame::map ? compose(whole.believed(), asked) : asked,
                            frame)},
            100);
        EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
        EXPECT_TRUE(status.reason.starts_with("arrived, 0.")) << status.reason;
        const Vec2 moved = to_frame(start, whole.drive().seen().pose_in_odom.position());
        EXPECT_LT((moved - asked.position()).norm(), 0.025 + 0.1 * way)
            << way << " m at " << bearing << ": " << moved.transpose();
        EXPECT_TRUE(whole.at_rest());
      }
}

// The simulated Pioneer is told whole degrees.
TEST(Navigation, ATurnEndsWithinATenthOfItselfOrTheRobotsOwnDegree) {
  for (const double angle : {1.3, -2.0, 3.0, -4.5, 5.0, -10.0, 90.5, -170.0}) {
    WholeOptions options = office();
    options.drive.errors = 0.0;
    Whole whole(options);
    whole.advance();
    const double before = whole.drive().seen().pose_in_odom.th;
    const auto status = whole.achieve(
        "turn_to",
        {saphira::point("position", {std::cos(radians(angle)), std::sin(radians(angle)), 0.0},
                        Frame::robot)},
        100);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
    const double turned = norm2_angle(whole.drive().seen().pose_in_odom.th - before);
    EXPECT_NEAR(degrees(turned), angle, 0.6) << status.reason;
  }
}

// Paper 3.5.1: the passage of the door begins while the robot still follows the corridor, so that
// it does not stop between the two. From leg to leg some behavior drives in every cycle.
TEST(Navigation, FromTheCorridorThroughTheDoorWithoutAStop) {
  Whole whole(office());
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-231")});
  double slowest = 1.0;
  bool both = false;
  bool passed = false;
  bool driving = false;
  int idle = 0;
  whole.advance_until(
      [&] {
        bool follows = false;
        bool passes = false;
        for (const auto& node : whole.intentions().nodes) {
          follows = follows || node.schema == "FollowCorridor";
          passes = passes || node.schema == "FollowDoor";
        }
        both = both || (follows && passes);
        if (passes)
          slowest = std::min(slowest, whole.drive().seen().velocity);
        passed = passed || passes;
        bool drives = false;
        bool stops = false;
        for (const auto& each : whole.intentions().behaviors) {
          drives = drives || each.schema == "FollowCorridor" || each.schema == "FollowDoor";
          stops = stops || (each.schema == "Stop" && each.priority == 0);
        }
        idle += driving && !drives && !stops && !whole.ended(goal);
        driving = driving || drives;
        return whole.ended(goal);
      },
      3000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-231"));
  EXPECT_TRUE(passed);
  EXPECT_TRUE(both);
  EXPECT_GT(slowest, 0.1);
  EXPECT_TRUE(driving);
  EXPECT_LE(idle, 2) << "between the end of the path and the stop, plan-and-execute ends";
  EXPECT_EQ(whole.drive().contacts(), 0);
}

TEST(Navigation, ItSaysHowFarItHasCome) {
  Whole whole(office());
  const auto goal = whole.ask("go-to-place", {saphira::number("place", 249.0)});
  std::vector<double> levels;
  whole.advance_until(
      [&] {
        levels.push_back(whole.status(goal).level);
        return whole.ended(goal);
      },
      2000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-249")) << "by its number, as a person types it";
  EXPECT_LT(levels[20], 0.2);
  EXPECT_NEAR(levels[levels.size() / 2], 0.5, 0.25);
  EXPECT_GT(levels[levels.size() - 20], 0.65);
  for (std::size_t i = 20; i + 20 < levels.size(); ++i)
    EXPECT_GE(levels[i + 10], levels[i] - 0.05) << i;
}

TEST(Navigation, APlaceThatTheMapDoesNotHaveIsRefusedInWords) {
  Whole whole(office());
  const GoalStatus status = whole.achieve("go-to-place", {text("place", "EJ-999")}, 100);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_NE(status.reason.find("EJ-999"), std::string::npos) << status.reason;
}

const char* const kClosed247 = "door d247 16500 13100 16500 14000 90\n";

// A robot that asks from beside the door, not from in front of it, takes the opened door for closed
// in about one of four cases. This one asks from in front of it.
TEST(Navigation, WhenTheDoorIsOpenedItGoesOn) {
  Whole whole(office(1, office_with("opened", kClosed247)));
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-247")});
  ASSERT_TRUE(whole.advance_until([&] { return said(whole, "Please open the way"); }, 3000));
  ASSERT_TRUE(whole.drive().scene().set_door("d247", true));
  whole.advance_until([&] { return whole.ended(goal); }, 3000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-247"));
  EXPECT_EQ(whole.drive().contacts(), 0);
}

// EJ-271 has two doors.
TEST(Navigation, AroundAClosedDoorItReplans) {
  Whole whole(office(1, office_with("two-doors", "door d271 28600 6000 29500 6000 -90\n")));
  const GoalStatus status = whole.achieve("go-to-place", {text("place", "EJ-271")}, 4000);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_TRUE(is_in(whole, "EJ-271"));
  EXPECT_FALSE(said(whole, "Please open the way"));
  EXPECT_EQ(whole.drive().contacts(), 0);
}

TEST(Navigation, APatrolLeavesOutAPlaceThatItDoesNotReach) {
  Whole whole(office(1, office_with("patrolled", kClosed247)));
  const GoalStatus status =
      whole.achieve("patrol", {text("places", "EJ-245, EJ-247, EJ-249")}, 6000);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason.find("1 rounds, 1 times without one of its places: no way"), 0u)
      << status.reason;
  EXPECT_TRUE(is_in(whole, "EJ-249"));
}

TEST(Navigation, APatrolOfAPlaceThatTheMapDoesNotHaveDoesNotBegin) {
  Whole whole(office());
  const GoalStatus status = whole.achieve("patrol", {text("places", "EJ-245, EJ-999")}, 100);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_NE(status.reason.find("EJ-999"), std::string::npos) << status.reason;
}

TEST(Ways, AreDrivenToATenthOfThemselves) {
  for (const double way : {0.1, 0.2, 0.3, 0.5, 1.0}) {
    Whole whole(office());
    whole.advance();
    const Pose before = whole.drive().seen().pose_in_odom;
    const GoalStatus status =
        whole.achieve("go_to", {saphira::point("position", {way, 0.0, 0.0}, Frame::robot)}, 600);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
    const Pose after = whole.drive().seen().pose_in_odom;
    EXPECT_NEAR((after.position() - before.position()).norm(), way, std::max(0.02, 0.1 * way))
        << way;
  }
}

TEST(Ways, AreDrivenAtASpeedToATenthOfThemselves) {
  for (const auto& [speed, way] :
       {std::pair{-0.1, 0.1}, {-0.1, 0.254}, {-0.15, 1.0}, {0.3, 0.2}, {0.4, 1.0}}) {
    Whole whole(office());
    whole.advance();
    const Pose before = whole.drive().seen().pose_in_odom;
    const GoalStatus status =
        whole.achieve("drive", {number("speed", speed), number("distance", way)}, 600);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
    for (int cycle = 0; cycle < 10; ++cycle)
      whole.advance();
    const Pose after = whole.drive().seen().pose_in_odom;
    EXPECT_NEAR(to_frame(before, after.position()).x(), std::copysign(way, speed),
                std::max(0.02, 0.1 * way))
        << speed;
  }
}

TEST(Mapping, AFloorThatTheRobotDoesNotUnderstandIsNotBuilt) {
  for (const std::uint64_t seed : {1, 2}) {
    WholeOptions options;
    options.drive.world = "cluttered";
    options.drive.seed = seed;
    options.map = "none";
    Whole whole(options);
    const GoalStatus status = whole.achieve("build-map", {}, 20000);
    EXPECT_EQ(status.state, v1::GOAL_FAILED) << seed << ": " << status.reason;
    EXPECT_NE(status.reason.find("does not lead back to its start"), std::string::npos)
        << status.reason;
  }
}

TEST(Mapping, EndsWithItsGoal) {
  WholeOptions options;
  options.drive.world = "cluttered";
  options.map = "none";
  Whole whole(options);
  const v1::GoalId goal = whole.ask("build-map");
  whole.advance_until([] { return false; }, 800);
  EXPECT_EQ(whole.registered().reason, "builds the map");
  whole.ask("stop");
  ASSERT_TRUE(whole.advance_until([&] { return whole.ended(goal); }, 3));
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_CANCELED);
  EXPECT_TRUE(whole.advance_until([&] { return !whole.registered().adds_features; }, 3));
  whole.advance();
  EXPECT_NE(whole.registered().reason, "builds the map");
}

GoalStatus go_to(Whole& whole, double x, double y) {
  return whole.achieve("go_to", {saphira::point("position", {x, y, 0.0}, Frame::map)}, 1500);
}

TEST(Navigation, ADoorThatWasPassedClosedIsAvoidedAndTakenAgainWhenItIsOpen) {
  WholeOptions options = office(1, office_with("passed", "door d271 28600 6000 29500 6000 -90\n"));
  options.drive.start_in_world = Pose{19.5, 7.0, 0.0};
  Whole whole(options);
  const std::vector<std::uint32_t>& closed = whole.registered().closed_doors;
  EXPECT_TRUE(closed.empty());
  ASSERT_EQ(go_to(whole, 31.5, 7.0).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(closed, std::vector<std::uint32_t>{1271});
  ASSERT_EQ(go_to(whole, 27.0, 7.0).state, v1::GOAL_SUCCEEDED);
  // Past it to the farther door, without a second look.
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-271")});
  double nearest = 10.0;  // to it, from the corridor's middle
  whole.advance_until(
      [&] {
        nearest = std::min(nearest, (whole.truth().position() - Vec2(29.05, 6.0)).norm());
        return whole.ended(goal);
      },
      3000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-271"));
  EXPECT_GT(nearest, 0.7);

  ASSERT_TRUE(whole.drive().scene().set_door("d271", true));
  ASSERT_EQ(whole.achieve("go-to-place", {text("place", "EJ-259")}, 4000).state,
            v1::GOAL_SUCCEEDED);
  EXPECT_TRUE(closed.empty()) << "it was passed on the way";
  EXPECT_EQ(whole.drive().contacts(), 0);
}

/// The office floor with additional lines of its map.
WholeOptions office_with_zones(const std::string& lines) {
  WholeOptions options = office();
  options.made_map = std::make_shared<const maps::Map>(maps::parse_map(
      read_file(config_folder() + "/maps/office-floor.map") + "\n" + lines + "\n", "zones.map"));
  return options;
}

bool does(const Whole& whole, const std::string& schema) {
  const auto& nodes = whole.intentions().nodes;
  return std::any_of(nodes.begin(), nodes.end(),
                     [&](const auto& node) { return node.schema == schema; });
}

const maps::Feature& zone_of(const Whole& whole) {
  return *maps::find(whole.map(), 900);
}

// Not only between two legs: here the robot has already begun to pass the door.
TEST(Zones, AKeepOutThatIsToldOnTheLastLegIsObeyed) {
  for (const char* const leg : {"corridor-to-door", "through-door"}) {
    Whole whole(office());
    const auto goal = whole.ask("go-to-place", {text("place", "EJ-231")});
    ASSERT_TRUE(whole.advance_until(
        [&] { return does(whole, leg) && whole.truth().position().y() > 24.0; }, 3000));
    ASSERT_FALSE(is_in(whole, "EJ-231"));
    whole.claim("hazards", "keep-out at EJ-231");
    bool inside = false;
    EXPECT_TRUE(whole.advance_until(
        [&] {
          inside = inside || is_in(whole, "EJ-231");
          return whole.ended(goal);
        },
        100));
    EXPECT_EQ(whole.status(goal).state, v1::GOAL_FAILED);
    EXPECT_EQ(whole.status(goal).reason,
              "room 231 (EJ-231) is in a place that people told me to keep out of");
    EXPECT_FALSE(inside) << leg;
    EXPECT_FALSE(said(whole, "Please open the way"));
    EXPECT_TRUE(whole.at_rest());
  }
}

TEST(Zones, ASlowZoneCapsTheSpeed) {
  Whole whole(office_with_zones("ZONE (900) 17500, 11000, 0, 3000, 3000 slow 100 \"kitchen\""));
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-265")});
  double fastest = 0.0;
  double outside = 0.0;
  std::string reason;
  whole.advance_until(
      [&] {
        const Vec2 at = whole.truth().position();
        const double velocity = whole.drive().seen().velocity;
        // The robot brakes behind the edge.
        if (at.y() < 12.1 && at.y() > 9.7) {
          fastest = std::max(fastest, velocity);
          reason = whole.intentions().limit_reason;
        } else {
          outside = std::max(outside, velocity);
        }
        return whole.ended(goal);
      },
      3000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_GT(fastest, 0.05);
  EXPECT_LT(fastest, 0.12);
  EXPECT_GT(outside, 0.25);
  EXPECT_EQ(reason, "slow zone \"kitchen\"");
}

TEST(Zones, OneWayForcesTheWayAround) {
  Whole whole(office_with_zones("ZONE (900) 17500, 11000, 90, 3000, 2000 one-way"));
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-265")});
  bool entered = false;
  bool east = false;
  whole.advance_until(
      [&] {
        entered = entered || maps::contains(zone_of(whole), whole.truth().position());
        east = east || is_in(whole, "upper corridor");
        return whole.ended(goal);
      },
      6000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_FALSE(entered);
  EXPECT_TRUE(east);
}

// Goals without a route: to a point, and on and on.
TEST(Zones, NoGoalEntersAKeepOut) {
  const std::string zone = "ZONE (900) 17500, 10000, 0, 4000, 2000 keep-out \"lab\"";
  for (const auto& [functor, arguments] :
       {std::pair<std::string, saphira::Arguments>{
            "go_to", {saphira::point("position", {17.5, 8.0, 0.0}, Frame::map)}},
        {"drive", {number("speed", 0.3)}},
        {"drive", {number("speed", 1.0)}},
        {"roam", {}}}) {
    Whole whole(office_with_zones(zone));
    const auto goal = whole.ask(functor, arguments);
    bool entered = false;
    whole.advance_until(
        [&] {
          entered = entered || maps::contains(zone_of(whole), whole.truth().position());
          return whole.ended(goal);
        },
        600);
    EXPECT_EQ(whole.status(goal).state, v1::GOAL_FAILED) << functor;
    EXPECT_EQ(whole.status(goal).reason, "it must not go on: keep-out zone \"lab\"") << functor;
    EXPECT_FALSE(entered) << functor;
  }
  Whole whole(office_with_zones(zone));
  const GoalStatus inside =
      whole.achieve("go_to", {saphira::point("position", {17.5, 10.0, 0.0}, Frame::map)}, 100);
  EXPECT_EQ(inside.state, v1::GOAL_REFUSED);
  EXPECT_EQ(inside.code, v1::CODE_NO_ROUTE);
  EXPECT_EQ(inside.reason, "(17.50, 10.00) on the map is in keep-out zone \"lab\"");
  const GoalStatus outside =
      whole.achieve("go_to", {saphira::point("position", {-5.0, 0.0, 0.0}, Frame::map)}, 100);
  EXPECT_EQ(outside.code, v1::CODE_NO_ROUTE);
  EXPECT_EQ(outside.reason, "(-5.00, 0.00) on the map is in no room or corridor of the map");
}

TEST(Navigation, ToAPointOfTheMapByARoute) {
  Whole whole(office());
  const GoalStatus there =
      whole.achieve("go-to-place", {saphira::point("place", {14.7, 25.0, 0.0}, Frame::map)}, 3000);
  EXPECT_EQ(there.state, v1::GOAL_SUCCEEDED) << there.reason;
  EXPECT_LT((whole.truth().position() - Vec2(14.7, 25.0)).norm(), 0.7);
}

// The demo's map has no furniture: what the robot hears of it must not deny the place.
TEST(Navigation, EveryRoomOfAFurnishedOfficeIsReachedAgainAndAgain) {
  for (const std::uint64_t seed : {1, 8, 14}) {
    WholeOptions options;
    options.drive.world = "office";
    options.drive.seed = seed;
    options.drive.guard = true;
    Whole whole(options);
    for (int round = 0; round < 2; ++round)
      for (const char* const room : {"N1", "S3", "N3", "S2", "N2", "S1"}) {
        const GoalStatus there = whole.achieve("go-to-place", {saphira::text("place", room)}, 6000);
        EXPECT_EQ(there.state, v1::GOAL_SUCCEEDED) << seed << ": " << room << ": " << there.reason;
        EXPECT_TRUE(is_in(whole, room)) << seed << ": " << room;
      }
    EXPECT_LE(whole.cycle(), 12 * 400) << seed;  // the guard seldom holds it beside a cupboard
    EXPECT_EQ(whole.drive().contacts(), 0);
  }
}

// The demo's way, past cupboards, a pillar and a crate that no map has.
TEST(Navigation, TheDemosWayKeepsTheDistanceFromWhichTheGuardDoesNotSlow) {
  std::uint64_t cycles = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    WholeOptions options;
    options.drive.world = "office";
    options.drive.seed = seed;
    options.drive.guard = true;
    Whole whole(options);
    const GoalStatus there =
        whole.achieve("go_to", {saphira::point("position", {16.0, 1.0, 0.0})}, 1500);
    EXPECT_EQ(there.state, v1::GOAL_SUCCEEDED) << seed << ": " << there.reason;
    EXPECT_EQ(whole.drive().contacts(), 0);
    cycles += whole.cycle();
  }
  EXPECT_LE(cycles, 8U * 850U);
}

TEST(Navigation, AThingIsPutOnTheMapAndTakenFromItWhenItIsCarriedOff) {
  WholeOptions options = office(1, office_with("box", "box crate 18200 10000 0 400 600 50\n"));
  options.adds_objects = true;
  Whole whole(options);
  const auto crate = [&]() -> const maps::Feature* {
    for (const maps::Feature& feature : whole.map().features)
      if (feature.type == lps::PointType::object && maps::distance_to(feature, {18.2, 10.0}) < 0.3)
        return &feature;
    return nullptr;
  };
  EXPECT_EQ(crate(), nullptr);
  const std::size_t before = whole.map().features.size();
  const maps::Map before_map = whole.map();
  const auto pass = [&](const std::function<bool()>& done) {
    for (int i = 0; i < 3 && !done(); ++i)
      for (const double y : {8.5, 14.0})
        EXPECT_EQ(go_to(whole, 17.3, y).state, v1::GOAL_SUCCEEDED);
    return done();
  };
  ASSERT_TRUE(pass([&] { return crate() != nullptr; }));
  const maps::Feature found = *crate();
  EXPECT_TRUE(found.learned);
  EXPECT_GT(found.id, 0U);
  EXPECT_EQ(whole.map().features.size(), before + 1) << "nothing else";
  EXPECT_TRUE(maps::same_places(whole.map(), before_map)) << "what is planned holds";

  ASSERT_TRUE(whole.drive().scene().set_box("crate", {14.0, 3.5, 0.0}));
  EXPECT_TRUE(pass([&] { return crate() == nullptr; }));
  EXPECT_EQ(whole.map().features.size(), before);
  EXPECT_EQ(whole.drive().contacts(), 0);
}

TEST(Navigation, WhoIsCarriedAwayOnTheWayFindsHimselfAndArrives) {
  Whole whole(office());
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-231")});
  whole.advance_until([&] { return whole.cycle() >= 100; }, 200);
  ASSERT_TRUE(whole.drive().robot().place({25.6, 12.0, kPi / 2}));
  whole.advance_until([&] { return whole.ended(goal); }, 6000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-231"));
}

// The other corridor has the same width, so that all readings of its walls fit the old place.
TEST(Navigation, WhoWasCarriedBetweenTwoGoalsDoesNotSucceedElsewhere) {
  constexpr int kStands = 30;  // [cycles]
  Whole whole(office());
  const auto stand = [&] { whole.advance_until([] { return false; }, kStands); };
  const GoalStatus first =
      whole.achieve("go-to-place", {saphira::point("place", {13.0, 25.0, 0.0}, Frame::map)}, 3000);
  ASSERT_EQ(first.state, v1::GOAL_SUCCEEDED) << first.reason;
  stand();
  ASSERT_TRUE(whole.drive().robot().place({25.6, 17.0, kPi / 2}));
  stand();
  const GoalStatus second = whole.achieve("go-to-place", {text("place", "1235")}, 9000);
  EXPECT_EQ(second.state, v1::GOAL_SUCCEEDED) << second.reason;
  EXPECT_LT((whole.truth().position() - Vec2(18.45, 26.0)).norm(), 2.0);
}

TEST(Navigation, AMoreImportantGoalInterruptsTheJourneyWhichThenGoesOn) {
  Whole whole(office());
  const auto goal = whole.ask("go-to-place", {text("place", "EJ-231")});
  whole.advance_until([&] { return whole.cycle() >= 100; }, 200);
  const auto other =
      whole.ask("go_to", {saphira::point("position", {17.5, 12.0, 0.0}, Frame::map)}, 5);
  whole.advance_until([&] { return whole.status(goal).state == v1::GOAL_SUSPENDED; }, 20);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUSPENDED);
  EXPECT_NE(whole.status(goal).reason.find("go_to"), std::string::npos);
  whole.advance_until([&] { return whole.ended(other); }, 1000);
  EXPECT_EQ(whole.status(other).state, v1::GOAL_SUCCEEDED) << whole.status(other).reason;
  whole.advance_until([&] { return whole.ended(goal); }, 4000);
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-231"));
  EXPECT_EQ(whole.drive().contacts(), 0);
}

// ---- People (paper 4.5, 4.6)

// Errands between people: from here, and with an answer.
TEST(People, WhatIsHandedOverHereIsBrought) {
  Whole whole(office());
  People people({{"Please give me the report", "given", kYes},
                 {"Here is the report from alice, please take it", "taken", kYes}});
  const auto goal = whole.ask(
      "deliver", {text("object", "the report"), text("to", "EJ-247"), text("sender", "alice")});
  const GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason, "the report was brought from alice to EJ-247");
  EXPECT_EQ(whole.said().at(0), "Please give me the report");
  EXPECT_TRUE(is_in(whole, "EJ-247"));
  EXPECT_EQ(whole.trouble(), "");
}

TEST(People, NobodyIsAskedForWhatCannotBeBrought) {
  Whole whole(office_with_zones("OFFICE (901) 60000, 10000, 0, 3000, 3000 \"N3\""));
  People people({{"Please give me the report", "given", kYes}});
  const auto goal = whole.ask("deliver", {text("object", "the report"), text("to", "N3")});
  const GoalStatus status = among(whole, people, goal, 100);
  EXPECT_EQ(status.state, v1::GOAL_FAILED) << status.reason;
  EXPECT_TRUE(status.reason.starts_with("the report cannot be brought: no way from "))
      << status.reason;
  EXPECT_TRUE(whole.said().empty());
}

TEST(People, AMessageWithoutAnAnswerOrAPlaceToReportAtIsTold) {
  Whole whole(office());
  whole.claim("place-of-karen", "EJ-247");
  People people({{"Is karen here?", "answer", "yes"}});
  const auto goal = whole.ask("tell", {text("person", "karen"), text("message", "it is late"),
                                       text("sender", "alice"), saphira::number("patience", 3.0)});
  const GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason, "karen was told, and did not answer");
  EXPECT_EQ(whole.said().back(), "karen, alice says: it is late");
  EXPECT_TRUE(is_in(whole, "EJ-247"));
}

TEST(People, APersonIsAskedAndTheAnswerComesBack) {
  Whole whole(office());
  whole.claim("place-of-john", "EJ-247");
  People people({{"Is john here?", "answer", "yes"},
                 {"john, alice asks where karen is?", "answer", "EJ-244"}});
  const auto goal =
      whole.ask("inquire", {text("person", "john"), text("question", "where karen is"),
                            text("sender", "alice"), text("back", "EJ-245")});
  const GoalStatus status = among(whole, people, goal, 9000);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason, "john, asked where karen is, said EJ-244");
  EXPECT_TRUE(is_in(whole, "EJ-245"));
  EXPECT_EQ(whole.trouble(), "");
}

TEST(People, WhoIsNotFoundIsReportedToo) {
  Whole whole(office());
  whole.claim("place-of-john", "EJ-247");
  People people({{"Is john here?", "answer", "no"}});
  const auto goal =
      whole.ask("inquire", {text("person", "john"), text("question", "where karen is"),
                            text("back", "EJ-245"), saphira::number("patience", 3.0)});
  const GoalStatus status = among(whole, people, goal, 9000);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason,
            "john was not asked: find-person: john is not to be found, neither at EJ-247");
  EXPECT_TRUE(is_in(whole, "EJ-245"));
}

TEST(People, WhereItIsNotToBeHadTheRobotAsksWhoHasIt) {
  Whole whole(office());
  People people({{"Please give me the key", "given", "no"},
                 {"Who has the key?", "who-has", "EJ-249"},
                 {"Please give me the key", "given", "yes"}});
  const auto goal = whole.ask("deliver", {text("object", "the key"), text("from", "EJ-247"),
                                          text("to", "EJ-250"), saphira::number("patience", 5.0)});
  const GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason, "nobody at EJ-250 took the key: the robot still has it");
  EXPECT_TRUE(people.all_answered());
}

/// The end of a delivery to Alice in EJ-247, of something that is given to the robot here; somebody
/// takes it, and others say whether she has it.
GoalStatus delivered_to_alice(const intentions::Value& taker, const std::string& she_has_it,
                              const std::string& says = {}) {
  Whole whole(office());
  People people({{"Please give me the report", "given", kYes, "Karen"},
                 {"Here is the report from karen for alice, please take it", "taken", taker},
                 {"Does alice have the report?", "answer", she_has_it, says}});
  const auto goal = whole.ask(
      "deliver", {text("object", "the report"), text("to", "EJ-247"), text("sender", "karen"),
                  text("receiver", "alice"), saphira::number("patience", 5.0)});
  GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(said(whole, "Does alice have"), taker != intentions::Value("alice"));
  return status;
}

TEST(People, ADeliveryIsDoneWhenTheOneWhomItWasForHasIt) {
  EXPECT_EQ(delivered_to_alice("alice", "no").reason,
            "the report was brought from karen to alice at EJ-247");
  EXPECT_EQ(delivered_to_alice("karen", "yes").state, v1::GOAL_SUCCEEDED);
  const GoalStatus taken = delivered_to_alice("karen", "no");
  EXPECT_EQ(taken.state, v1::GOAL_FAILED);
  EXPECT_EQ(taken.reason, "karen took the report, which was for alice");
  EXPECT_EQ(delivered_to_alice(kYes, "no").reason, "somebody took the report, which was for alice");
}

TEST(People, WhoGaveOrTookADeliveryIsNoWitnessOfIt) {
  for (const std::string witness : {"bob", "karen"})
    EXPECT_EQ(delivered_to_alice("bob", "yes", witness).reason,
              "bob took the report, which was for alice, and only " + witness +
                  " says that alice has it");
  for (const std::string witness : {"Alice", "John", ""})
    EXPECT_EQ(delivered_to_alice("bob", "yes", witness).state, v1::GOAL_SUCCEEDED);
}

TEST(People, WhoAnswersForSomebodyElseIsNamed) {
  const auto reason = [](const std::string& functor, const std::string& answer,
                         const std::string& speaker) {
    Whole whole(office());
    whole.claim("place-of-karen", "EJ-247");
    People people(
        {{"Is karen here?", "answer", "yes"}, {"karen, alice", "answer", answer, speaker}});
    const auto goal =
        whole.ask(functor, {text("person", "karen"), text("sender", "alice"),
                            functor == "tell" ? text("message", "it is late")
                                              : text("question", "if lunch is ready")});
    return among(whole, people, goal, 6000).reason;
  };
  EXPECT_EQ(reason("inquire", "does not know", "Bob"),
            "karen, asked if lunch is ready, did not answer; bob does not know");
  EXPECT_EQ(reason("inquire", "does not know", "Karen"),
            "karen, asked if lunch is ready, does not know");
  EXPECT_EQ(reason("inquire", "no", ""), "karen, asked if lunch is ready, said no");
  EXPECT_EQ(reason("tell", "yes", "Bob"), "karen was told, and did not answer; bob said yes");
  EXPECT_EQ(reason("tell", "yes", "Karen"), "karen was told, and said yes");
}

TEST(People, AReplyThatIsNoAnswerIsAskedOnceMoreAndTold) {
  Whole whole(office());
  People people({{"Is bob here?", "not-understood", "karen: what do you want?"},
                 {"Is bob here?", "not-understood", "karen: pardon me?"}});
  const auto goal = whole.ask("find-person", {text("name", "bob"), text("places", "EJ-247"),
                                              saphira::number("patience", 3.0)});
  const GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason,
            "bob is not to be found, neither at EJ-247; not understood: karen: pardon me?");
  EXPECT_EQ(std::count(whole.said().begin(), whole.said().end(), "I do not understand that"), 1);
  EXPECT_EQ(std::count(whole.said().begin(), whole.said().end(), "Is bob here?"), 3);
}

TEST(People, WhatNobodyTookIsOnItsBack) {
  Whole whole(office());
  People people({{"Please give me the report", "given", kYes}});
  const auto goal = whole.ask("deliver", {text("object", "the report"), text("to", "EJ-247"),
                                          saphira::number("patience", 3.0)});
  std::string carried;
  whole.advance_until(
      [&] {
        people.listen(whole);
        for (const v1::Belief& one : whole.beliefs())
          if (one.name == "carries-the report")
            carried = one.value;
        return whole.ended(goal);
      },
      6000);
  EXPECT_EQ(whole.status(goal).reason, "nobody at EJ-247 took the report: the robot still has it");
  EXPECT_EQ(carried, "EJ-247");
}

TEST(People, WhoDoesNotKnowWhoHasItIsNobodysName) {
  Whole whole(office());
  People people({{"Please give me the key", "given", "no"}, {"Who has the key?", "who-has", "no"}});
  const auto goal = whole.ask("deliver", {text("object", "the key"), text("from", "EJ-247"),
                                          text("to", "EJ-250"), saphira::number("patience", 5.0)});
  const GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason, "the key is not at EJ-247, and nobody there knows who has it");
}

TEST(People, APlaceThatWasNotReachedWasNotVisited) {
  Whole whole(office_with_zones("OFFICE (901) 60000, 10000, 0, 3000, 3000 \"N3\""));
  People people({{"Is bob here?", "answer", "no"}});
  const auto search = [&](const std::string& places) {
    const auto goal = whole.ask("find-person", {text("name", "bob"), text("places", places),
                                                saphira::number("patience", 3.0)});
    return among(whole, people, goal, 6000).reason;
  };
  EXPECT_TRUE(search("N3").starts_with("bob was not looked for: N3: ")) << search("N3");
  EXPECT_TRUE(search("EJ-247, N3")
                  .starts_with("bob is not to be found, neither at EJ-247; not reached: N3: "));
}

/// The result of a search among people who give these answers.
GoalStatus found_from(Whole& whole, std::vector<Answer> answers, const std::string& name) {
  People people(std::move(answers));
  const auto goal =
      whole.ask("find-person", {text("name", name), saphira::number("patience", 4.0)});
  const GoalStatus status = among(whole, people, goal, 9000);
  EXPECT_TRUE(people.all_answered());
  EXPECT_EQ(whole.drive().contacts(), 0);
  return status;
}

TEST(People, APlaceOrAPersonThatIsNamedAtOnceIsNext) {
  Whole whole(office());
  whole.claim("place-of-john", "EJ-248");
  whole.claim("place-of-alice", "EJ-250");
  const GoalStatus status = found_from(whole,
                                       {{"Is john here?", "answer", "alice"},
                                        {"Is john here?", "answer", "EJ-246"},
                                        {"Is john here?", "answer", "yes"}},
                                       "john");
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason, "john is at EJ-246");
  EXPECT_FALSE(said(whole, "Who knows"));
}

intentions::Value knowers(std::vector<std::string> names) {
  intentions::Value::List all;
  for (std::string& name : names)
    all.emplace_back(std::move(name));
  return intentions::Value(std::move(all));
}

TEST(People, ThePlacesOfAllWhoKnowAreTried) {
  Whole whole(office());
  whole.claim("knows-where-karen", knowers({"john", "mr alda", "alice"}));
  whole.claim("place-of-john", "EJ-248");
  whole.claim("place-of-alice", "EJ-250");
  const GoalStatus status = found_from(whole,
                                       {{"Is karen here?", "answer", "no"},
                                        {"Who knows where karen is?", "answer", "no"},
                                        {"Is karen here?", "answer", "no"},
                                        {"Who knows where karen is?", "answer", "EJ-246"},
                                        {"Is karen here?", "answer", "yes"}},
                                       "karen");
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason, "karen is at EJ-246");
}

TEST(People, WhoKnowsAndHasNoPlaceIsFoundByThoseWhoKnowThat) {
  Whole whole(office());
  whole.claim("knows-where-karen", "john");
  whole.claim("knows-where-john", knowers({"alice"}));
  whole.claim("knows-where-alice", knowers({"karen", "bob"}));
  whole.claim("place-of-bob", "EJ-250");
  const GoalStatus status = found_from(whole,
                                       {{"Is alice here?", "answer", "no"},
                                        {"Who knows where alice is?", "answer", "EJ-248"},
                                        {"Is alice here?", "answer", "yes"},
                                        {"Who knows where john is?", "answer", "EJ-246"},
                                        {"Is john here?", "answer", "yes"},
                                        {"Who knows where karen is?", "answer", "EJ-244"},
                                        {"Is karen here?", "answer", "yes"}},
                                       "karen");
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << status.reason;
  EXPECT_EQ(status.reason, "karen is at EJ-244");
}

TEST(People, ThoseWhoKnowOfEachOtherAloneAreNoHelp) {
  Whole whole(office());
  whole.claim("knows-where-karen", knowers({"john"}));
  whole.claim("knows-where-john", knowers({"karen"}));
  const GoalStatus status = found_from(whole, {}, "karen");
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason,
            "nobody has said where karen may be, nor where those who know it may be: john");
  EXPECT_TRUE(whole.said().empty());
}

TEST(People, TheQuestionEndsWithTheActivityThatAsks) {
  Whole whole(office());
  std::map<std::string, std::string> asking;
  const auto advance_until = [&](const std::function<bool()>& done) {
    whole.advance_until(
        [&] {
          asking.clear();
          for (const v1::Belief& belief : whole.beliefs())
            if (belief.name.starts_with("asking-"))
              asking[belief.name] = belief.value;
          return done();
        },
        20);
  };
  const auto goal = whole.ask("ask", {text("question", "Is karen here?"), text("whom", "karen")});
  advance_until([&] { return asking.size() == 2; });
  EXPECT_EQ(asking["asking-about"], "answer");
  EXPECT_EQ(asking["asking-for"], "karen");
  whole.ask("stop");
  advance_until([&] { return whole.ended(goal) && asking.empty(); });
  EXPECT_TRUE(whole.ended(goal));
  EXPECT_TRUE(asking.empty());
}

TEST(People, WhoIsNowhereIsNotFoundAndTheReasonSaysWhere) {
  Whole whole(office());
  People people({{"Is bob here?", "answer", "no"}});
  const auto goal = whole.ask("find-person", {text("name", "bob"), text("places", "EJ-247, EJ-249"),
                                              saphira::number("patience", 3.0)});
  const GoalStatus status = among(whole, people, goal, 6000);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason, "bob is not to be found, neither at EJ-247, EJ-249");
  const GoalStatus unknown = whole.achieve("find-person", {text("name", "eve")}, 100);
  EXPECT_EQ(unknown.reason, "nobody has said where eve may be");
}

TEST(People, AQuestionIsAskedAgainAndWhatWasSaidBeforeIsNoAnswer) {
  Whole whole(office());
  whole.claim("answer", "no");
  whole.advance();
  const GoalStatus silent =
      whole.achieve("ask",
                    {text("question", "Is it late?"), saphira::number("patience", 2.0),
                     saphira::number("times", 3.0)},
                    200);
  EXPECT_EQ(silent.state, v1::GOAL_FAILED);
  EXPECT_EQ(silent.reason, "nobody answered the question: Is it late?");
  EXPECT_EQ(whole.said().size(), 3U);
  People people({{"What time is it?", "time", "half past nine"}});
  const auto goal = whole.ask("ask", {text("question", "What time is it?"), text("about", "time")});
  const GoalStatus status = among(whole, people, goal, 200);
  EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(status.reason, "half past nine");
}

// ---- Vision (paper 4.4, manual 9)

const char* const kAnnInTheCorridor =
    "person ann 17500 10500\n"
    "  wait 10  walk 17500 7000 300  walk 24000 7000 300  wait 100\n";

// She is around the corner before the robot can follow.
const char* const kQuickAnn =
    "person ann 17500 10500\n"
    "  wait 20  walk 17500 7000 1600  walk 25600 7000 1600  walk 25600 10650 1600  wait 100\n";

// A Pioneer 1 drives no faster than she walks, and does not make up for its late start.
TEST(Seeing, APersonWhoWalksIsNotLeftBehind) {
  for (const auto& [robot, most] : {std::pair{"pioneer", 2.0}, {"p3dx", 2.8}}) {
    WholeOptions options =
        office(1, office_with("walking-ann",
                              "person ann 17500 13000\n"
                              "  wait 10  walk 17500 7000 400  walk 25000 7000 400  wait 100\n"));
    options.drive.robot = robot;
    options.drive.start_in_world = Pose{17.5, 14.2, -kPi / 2};
    options.sees = true_eyes();
    Whole whole(options);
    const auto goal = whole.ask("follow-person");
    double nearest = most;
    double farthest = 0.0;
    while (whole.cycle() < 480) {
      whole.advance();
      const double away = (whole.drive().scene().persons()[0].at - whole.truth().position()).norm();
      nearest = std::min(nearest, away);
      farthest = std::max(farthest, away);
    }
    EXPECT_GT(nearest, 0.8) << robot;
    EXPECT_LT(farthest, most) << robot;
    EXPECT_NEAR((whole.drive().scene().persons()[0].at - whole.truth().position()).norm(), 1.0, 0.2)
        << robot;
    EXPECT_FALSE(whole.ended(goal)) << whole.status(goal).reason;
    EXPECT_TRUE(said(whole, "I follow the nearest person"));
    EXPECT_EQ(whole.drive().contacts(), 0);
  }
}

TEST(Seeing, WithoutACameraOrAPersonItSaysSo) {
  Whole blind(office());
  EXPECT_EQ(blind.achieve("attend-person", {}, 100).reason,
            "the robot has no camera, or nobody looks at its pictures");
  WholeOptions options = office();
  options.sees = true_eyes();
  Whole alone(options);
  const GoalStatus status = alone.achieve("attend-person", {}, 1000);
  EXPECT_EQ(status.state, v1::GOAL_FAILED);
  EXPECT_EQ(status.reason, "no person is to be seen all around");
  EXPECT_TRUE(said(alone, "I can't find you!"));
  EXPECT_TRUE(alone.at_rest());
}

const char* const kRedBox = "box crate 17800 10000 0  300 300 50 tall 500 color red\n";

// ---- Golden traces: the exact course of each activity in a world of its own. To renew them after
// a deliberate change, set SAPHIRA_RENEW_GOLDEN=1 in the environment of this program.

struct Scenario {
  std::string name;
  WholeOptions options;
  std::string functor;
  saphira::Arguments arguments;
  int cycles = 3000;
  std::vector<Answer> answers{};
  std::vector<std::pair<std::string, std::string>> claims{};  ///< claims before the start
};

std::vector<Scenario> scenarios() {
  std::vector<Scenario> all;
  all.push_back({"go-to-place", office(), "go-to-place", {text("place", "EJ-231")}});
  Scenario across{"go-to-position", office(), "go-to-place", {text("place", "start")}};
  across.options.drive.start_in_world = Pose{19.5, 16.5, 0.0};
  all.push_back(across);
  Scenario library{"through-the-library", office(), "go-to-place", {text("place", "EJ-261")}};
  library.options.drive.start_in_world = Pose{7.0, 27.5, 0.0};
  all.push_back(library);
  all.push_back({"closed-door",
                 office(1, office_with("golden", kClosed247)),
                 "go-to-place",
                 {text("place", "EJ-247"), saphira::number("patience", 5.0)}});
  Scenario lost{"lost", office(), "go-to-place", {text("place", "EJ-245")}};
  lost.options.knows_pose = false;
  all.push_back(lost);
  all.push_back({"make-sure", office(), "make-sure", {}});
  all.push_back({"figure-9", office(), "plan-and-execute", {text("dest", "EJ-249")}});
  all.push_back({"find-and-follow", office(), "find-and-follow", {}});
  all.push_back({"patrol", office(), "patrol", {}});
  all.push_back({"patrol-places", office(), "patrol", {text("places", "EJ-249, EJ-250")}});
  all.push_back({"explore", office(), "explore", {}, 6000});
  Scenario bump{"bump-and-go", office(), "bump-and-go", {saphira::number("bumps", 2)}};
  bump.options.map = "arena";
  bump.options.drive.world = "arena";
  all.push_back(bump);
  all.push_back(
      {"attend",
       office(),
       "attend",
       {saphira::point("position", {17.5, 10.0, 0.0}, Frame::map), saphira::number("seconds", 1)}});
  all.push_back({"guide", office(), "guide", {text("place", "EJ-249")}});
  all.push_back({"come-back",
                 office(),
                 "come-back",
                 {text("place", "EJ-249"), saphira::point("spot", {17.5, 8.0, 0.0}, Frame::map)}});
  all.push_back({"pause", office(), "pause", {saphira::number("seconds", 2.0)}});
  Scenario tell{"tell",
                office(),
                "tell",
                {text("person", "karen"), text("message", "it is late"), text("back", "EJ-250")},
                6000};
  tell.answers = {{"Is karen here?", "answer", "yes"},
                  {"karen, somebody says: it is late", "answer", "no"}};
  tell.claims = {{"place-of-karen", "EJ-249"}};
  all.push_back(tell);
  Scenario inquire{"inquire",
                   office(),
                   "inquire",
                   {text("person", "john"), text("question", "where karen is")},
                   6000};
  inquire.answers = {{"Is john here?", "answer", "yes"},
                     {"john, somebody asks where karen is?", "answer", "EJ-244"}};
  inquire.claims = {{"place-of-john", "EJ-249"}};
  all.push_back(inquire);
  // The most complicated plan that Flakey executed: to Karen's office, where she is not; to John's
  // place, to ask him for her place; to her, for the report; and back with it.
  Scenario deliver{"deliver",
                   office(),
                   "deliver",
                   {text("object", "the report"), text("from", "karen"), text("to", "EJ-250")},
                   6000};
  deliver.answers = {
      {"Is karen here?", "answer", "no"},   {"Who knows where karen is?", "answer", "john"},
      {"Is karen here?", "answer", "no"},   {"Who knows where karen is?", "answer", "EJ-244"},
      {"Is karen here?", "answer", "yes"},  {"Please give me the report", "given", kYes},
      {"Here is the report", "taken", kYes}};
  deliver.claims = {{"place-of-karen", "EJ-248"}, {"place-of-john", "EJ-246"}};
  all.push_back(deliver);
  Scenario follow{"follow-person",
                  office(1, office_with("golden-ann", kAnnInTheCorridor)),
                  "follow-person",
                  {saphira::number("seconds", 50.0)}};
  follow.options.sees = true_eyes();
  all.push_back(follow);
  Scenario search_person{"search-person",
                         office(1, office_with("golden-quick-ann", kQuickAnn)),
                         "follow-person",
                         {saphira::number("seconds", 50.0)}};
  search_person.options.sees = true_eyes();
  all.push_back(search_person);
  Scenario search{
      "blob-search", office(1, office_with("golden-crate", kRedBox)), "blob-search", {}};
  search.options.sees = true_eyes({"red"});
  search.options.drive.start_in_world = Pose{17.5, 14.0, kPi / 2};
  all.push_back(search);
  Scenario look{"look", office(), "look", {saphira::number("angle", -1.0)}};
  look.options.drive.robot = "pioneer-head";
  all.push_back(look);
  Scenario build{"build-map", {}, "build-map", {}, 9000};
  build.options.drive.world = "loop";
  all.push_back(build);
  return all;
}

class Golden : public ::testing::TestWithParam<Scenario> {};

/// A line of the trace without its cycle, and without a generated name (I and a number).
std::string without_numbers(const std::string& line) {
  std::string out = line.substr(line.find(' ') + 1);
  const std::size_t open = out.find("(I");
  const std::size_t close = out.find(')', open);
  if (open != std::string::npos && out.find_first_not_of("0123456789", open + 2) == close)
    out.erase(open + 1, close - open - 1);
  return out;
}

TEST_P(Golden, TheTransitionsAreThoseThatAreStored) {
  const Scenario& scenario = GetParam();
  Whole whole(scenario.options);
  for (int i = 0; i < 5; ++i)  // registration has checked
    whole.advance();
  for (const auto& [name, value] : scenario.claims)
    whole.claim(name, value);
  People people(scenario.answers);
  const auto goal = whole.ask(scenario.functor, scenario.arguments);
  among(whole, people, goal, scenario.cycles);
  std::string trace;
  for (const std::string& line : whole.transitions())
    trace += without_numbers(line) + "\n";
  for (const std::string& line : whole.said())
    trace += "says: " + line + "\n";
  const GoalStatus& status = whole.status(goal);
  trace += std::string(word_of(status.state)) + ": " + status.reason + "\n";
  EXPECT_TRUE(whole.ended(goal));
  EXPECT_EQ(whole.trouble(), "");
  const char* const source = std::getenv("SAPHIRA_SOURCE_DIR");
  ASSERT_NE(source, nullptr);
  const std::string file = std::string(source) + "/tests/golden/" + scenario.name + ".txt";
  if (std::getenv("SAPHIRA_RENEW_GOLDEN") != nullptr) {
    std::ofstream(file) << trace;
    return;
  }
  EXPECT_EQ(trace, read_file(file)) << "SAPHIRA_RENEW_GOLDEN=1 stores it anew";
}

INSTANTIATE_TEST_SUITE_P(Library, Golden, ::testing::ValuesIn(scenarios()), [](const auto& each) {
  std::string name = each.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(GoldenTraces, EveryActivityThatIsShippedIsInOne) {
  const char* const source = std::getenv("SAPHIRA_SOURCE_DIR");
  ASSERT_NE(source, nullptr);
  std::string all;
  for (const Scenario& scenario : scenarios())
    all += read_file(std::string(source) + "/tests/golden/" + scenario.name + ".txt");
  Whole whole(office());
  const auto known = whole.drive().node().reader(bus::topics::kActivitySchemas).take_newest();
  ASSERT_TRUE(known);
  EXPECT_EQ(known->trouble, "");
  for (const v1::ActivitySchema& schema : known->schemas)
    if (!schema.source.empty()) {
      EXPECT_NE(all.find(schema.name + " ("), std::string::npos) << schema.name;
    }
}

}  // namespace
}  // namespace saphira::test
