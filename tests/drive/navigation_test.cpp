// The library of activities (config/activities) in the simulated office floor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <optional>
#include <string>

#include "arguments.hpp"
#include "drive/eyes.hpp"
#include "drive/whole.hpp"
#include "lines.hpp"
#include "saphira/base/fnv1a.hpp"
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
  WholeOptions options{.map = "office-floor"};
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
  void add(Answer answer) { answers_.push_back(std::move(answer)); }
  bool all_answered() const { return next_ == answers_.size(); }

 private:
  std::vector<Answer> answers_;
  std::size_t heard_ = 0;
  std::size_t next_ = 0;
};

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
  whole.watch(goal, 3000, [&] {
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
  });
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
  whole.watch(goal, 2000, [&] { levels.push_back(whole.status(goal).level); });
  EXPECT_EQ(whole.status(goal).state, v1::GOAL_SUCCEEDED) << whole.status(goal).reason;
  EXPECT_TRUE(is_in(whole, "EJ-249")) << "by its number, as a person types it";
  EXPECT_LT(levels[20], 0.2);
  EXPECT_NEAR(levels[levels.size() / 2], 0.5, 0.25);
  EXPECT_GT(levels[levels.size() - 20], 0.65);
  for (std::size_t i = 20; i + 20 < levels.size(); ++i)
    EXPECT_GE(levels[i + 10], levels[i] - 0.05) << i;
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
  whole.watch(goal, 3000, [&] {
    nearest = std::min(nearest, (whole.truth().position() - Vec2(29.05, 6.0)).norm());
  });
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
    EXPECT_TRUE(whole.watch(goal, 100, [&] { inside = inside || is_in(whole, "EJ-231"); }));
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
  whole.watch(goal, 3000, [&] {
    const Vec2 at = whole.truth().position();
    const double velocity = whole.drive().seen().velocity;
    // The robot brakes behind the edge.
    if (at.y() < 12.1 && at.y() > 9.7) {
      fastest = std::max(fastest, velocity);
      reason = whole.intentions().limit_reason;
    } else {
      outside = std::max(outside, velocity);
    }
  });
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
  whole.watch(goal, 6000, [&] {
    entered = entered || maps::contains(zone_of(whole), whole.truth().position());
    east = east || is_in(whole, "upper corridor");
  });
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
    whole.watch(goal, 600, [&] {
      entered = entered || maps::contains(zone_of(whole), whole.truth().position());
    });
    EXPECT_EQ(whole.status(goal).state, v1::GOAL_FAILED) << functor;
    EXPECT_EQ(whole.status(goal).reason, "it must not go on: keep-out zone \"lab\"") << functor;
    EXPECT_FALSE(entered) << functor;
  }
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

// ---- People (paper 4.5, 4.6)

/// A line of the trace without its cycle, and without a generated name (I and a number).
std::string without_numbers(const std::string& line) {
  std::string out = line.substr(line.find(' ') + 1);
  const std::size_t open = out.find("(I");
  const std::size_t close = out.find(')', open);
  if (open != std::string::npos && out.find_first_not_of("0123456789", open + 2) == close)
    out.erase(open + 1, close - open - 1);
  return out;
}

std::string golden(const std::string& name) {
  return source("tests/golden/" + name + ".txt");
}

/// One case of errands.txt or golden.txt.
class Errand : public LinePlayer {
 public:
  /// [cycles] For the next players: the services go on with restored cores. 0: never.
  static inline std::uint64_t restores_every = 0;
  /// Of the newest one.
  static inline Fnv1a course;

  Errand() {
    course = {};
    events_ = {{"world", [this](auto& in) { world(in); }},
               {"floor",
                [this](auto& in) {
                  in >> options_.drive.world;
                  options_.map = rest(in);
                }},
               {"robot", [this](auto& in) { options_.drive.robot = rest(in); }},
               {"start", [this](auto& in) { options_.drive.start_in_world = pose_of(rest(in)); }},
               {"lost", [this](auto&) { options_.knows_pose = false; }},
               {"sees", [this](auto& in) { sees(rest(in)); }},
               {"zone", [this](auto& in) { options_ = office_with_zones(rest(in)); }},
               {"claim", [this](auto& in) { claim(in); }},
               {"answers", [this](auto& in) { answers(rest(in)); }},
               {"agents", [this](auto& in) { agents(rest(in)); }},
               {"ask", [this](auto& in) { goal_ = ask(in); }},
               {"also", [this](auto& in) { ask(in); }},
               {"cycles", [this](auto& in) { advance(read<int>(in), [] { return false; }); }},
               {"ends", [this](auto& in) { ends(in); }},
               {"as-stored", [this](auto& in) { as_stored(in); }},
               {"until-said", [this](auto& in) { until_said(in); }},
               {"open", [this](auto& in) { EXPECT_TRUE(scene().set_door(rest(in), true)); }},
               {"carry", [this](auto& in) { EXPECT_TRUE(robot().place(pose_of(rest(in)))); }},
               {"is-in", [this](auto& in) { EXPECT_TRUE(test::is_in(whole(), rest(in))); }},
               {"near", [this](auto& in) { near(in); }},
               {"said-times", [this](auto& in) { said_times(in); }},
               {"believed", [this](auto& in) { believed(rest(in)); }}};
    facts_ = {{"contacts", [this] { return std::to_string(whole().drive().contacts()); }},
              {"trouble", [this] { return whole().trouble(); }},
              {"answered", [this] { return yes(people_.all_answered()); }},
              {"said", [this] { return std::to_string(whole().said().size()); }},
              {"first said", [this] { return whole().said().at(0); }},
              {"last said", [this] { return whole().said().back(); }},
              {"at rest", [this] { return yes(whole().at_rest()); }},
              {"asking", [this] { return asking(); }}};
  }

 private:
  /// The robot, from the first event that needs it on.
  Whole& whole() {
    if (!whole_)
      whole_.emplace(options_);
    return *whole_;
  }
  /// The robot's way to the last bit, and its orders.
  void note_course() {
    if (restores_every > 0 && whole().cycle() % restores_every == 0)
      whole().drive().services().each([](runtime::Service& service) {
        const std::string state = service.save();
        service.restore(state);
        EXPECT_EQ(service.save(), state);
      });
    const Pose truth = whole().truth();
    const v1::MotorCommand& command = whole().drive().commanded();
    for (const double value : {truth.x, truth.y, truth.th, command.velocity, command.heading})
      course.add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  sim::Scene& scene() { return whole().drive().scene(); }
  sim::Robot& robot() { return whole().drive().robot(); }
  void world(std::istringstream& in) {
    const auto name = read<std::string>(in);
    std::string more = rest(in) + "\n";
    if (const std::size_t line = more.find(" | "); line != std::string::npos)
      more.replace(line, 3, "\n  ");
    options_ = office(1, office_with(name, more));
  }
  void sees(const std::string& color) {
    options_.sees = color.empty() ? true_eyes() : true_eyes({color});
  }
  /// Names with commas between them are a list.
  static intentions::Value value_of(const std::string& text) {
    if (text == "truth")
      return kYes;
    if (text.find(',') == std::string::npos)
      return intentions::Value(text);
    intentions::Value::List names;
    std::istringstream in(text);
    for (std::string name; std::getline(in >> std::ws, name, ',');)
      names.emplace_back(name);
    return intentions::Value(std::move(names));
  }
  void claim(std::istringstream& in) {
    std::string name;
    in >> std::quoted(name);
    whole().claim(name, value_of(rest(in)));
  }
  void answers(const std::string& line) {
    const std::size_t arrow = line.find(" => ");
    std::istringstream in(line.substr(arrow + 4));
    const auto name = read<std::string>(in);
    const std::string value = rest(in);
    const std::size_t bar = std::min(value.find(" | "), value.size());
    people_.add({line.substr(0, arrow), name, value_of(value.substr(0, bar)),
                 value.substr(std::min(bar + 3, value.size()))});
  }
  /// Every question is answered with that place.
  void agents(const std::string& place) {
    place_ = place;
    if (!questions_) {
      bus::Node& node = whole().drive().node();
      questions_.emplace(node.reader(bus::topics::kSolve));
      replies_.emplace(node.writer(bus::topics::kSolved));
    }
  }
  void reply() {
    if (questions_)
      for (const auto& sample : questions_->take())
        replies_->write({.asker = sample.data.asker,
                         .number = sample.data.number,
                         .service = "board",
                         .code = v1::ANSWER_DONE,
                         .results = {bus::text("place", place_)}});
  }
  intentions::GoalId ask(std::istringstream& in) {
    const auto functor = read<std::string>(in);
    return whole().ask(functor, arguments_of(rest(in)));
  }
  bool advance(int cycles, const std::function<bool()>& done) {
    return whole().advance_until(
        [&] {
          people_.listen(whole());
          reply();
          for (const v1::Belief& one : whole().beliefs())
            believed_[one.name] = one.value;
          note_course();
          return done();
        },
        cycles);
  }
  /// Of the newest goal, in words, within so many cycles.
  std::string its_end(int cycles) {
    EXPECT_TRUE(advance(cycles, [&] { return whole().ended(goal_); }));
    const GoalStatus& status = whole().status(goal_);
    return std::string(word_of(status.state)) + ": " + status.reason;
  }
  void ends(std::istringstream& in) {
    const std::string end = its_end(read<int>(in));
    expect_like(end, rest(in));
  }
  /// The goal ends by the transitions, words and reason of its golden trace.
  void as_stored(std::istringstream& in) {
    const std::string end = its_end(read<int>(in));
    std::string trace;
    for (const std::string& line : whole().transitions())
      trace += without_numbers(line) + "\n";
    for (const std::string& line : whole().said())
      trace += "says: " + line + "\n";
    trace += end + "\n";
    EXPECT_EQ(whole().trouble(), "");
    const std::string file = golden(rest(in));
    if (std::getenv("SAPHIRA_RENEW_GOLDEN") != nullptr)
      std::ofstream(file) << trace;
    else
      EXPECT_EQ(trace, read_file(file)) << "SAPHIRA_RENEW_GOLDEN=1 stores it anew";
  }
  void until_said(std::istringstream& in) {
    const int cycles = read<int>(in);
    const std::string part = rest(in);
    EXPECT_TRUE(advance(cycles, [&] { return said(whole(), part); })) << part;
  }
  void near(std::istringstream& in) {
    const double x = read<double>(in);
    const double y = read<double>(in);
    EXPECT_LT((whole().truth().position() - Vec2(x, y)).norm(), read<double>(in));
  }
  void said_times(std::istringstream& in) {
    const int times = read<int>(in);
    const std::string words = rest(in);
    const auto is_said = [&](const std::string& text) { return is_like(text, words); };
    EXPECT_EQ(std::ranges::count_if(whole().said(), is_said), times) << words;
  }
  void believed(const std::string& line) {
    const std::size_t arrow = line.find(" => ");
    EXPECT_EQ(believed_[line.substr(0, arrow)], line.substr(arrow + 4));
  }
  std::string asking() {
    std::string all;
    for (const v1::Belief& belief : whole().beliefs())
      if (belief.name.starts_with("asking-"))
        all += (all.empty() ? "" : " ") + belief.name + "=" + belief.value;
    return all;
  }

  WholeOptions options_ = office();
  std::optional<Whole> whole_;
  People people_{{}};
  std::string place_;  ///< that agents name
  std::optional<bus::Reader<v1::Request>> questions_;
  std::optional<bus::Writer<v1::Answer>> replies_;
  intentions::GoalId goal_;
  std::map<std::string, std::string> believed_;  ///< with the newest value, also of gone ones
};

// In parts, so that they run side by side.
constexpr int kParts = 6;
class Errands : public ::testing::TestWithParam<int> {};

TEST_P(Errands, AreAsWritten) {
  const auto wanted = [](int number, const std::string&) { return number % kParts == GetParam(); };
  EXPECT_EQ(play<Errand>("tests/drive/errands.txt", '#', wanted), 43);
}

INSTANTIATE_TEST_SUITE_P(Parts, Errands, ::testing::Range(0, kParts));

// ---- Vision (paper 4.4, manual 9)

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
    EXPECT_NEAR((whole.drive().scene().persons()[0].at - whole.truth().position()).norm(), 1.2, 0.2)
        << robot;
    EXPECT_FALSE(whole.ended(goal)) << whole.status(goal).reason;
    EXPECT_TRUE(said(whole, "I follow the nearest person"));
    EXPECT_EQ(whole.drive().contacts(), 0);
  }
}

// Bob stands nearer to the robot than Ann, who speaks, when it has come up to her.
TEST(Seeing, TheSpeakerIsFollowedNotTheNearestPerson) {
  WholeOptions options = office(1, office_with("speaker",
                                               "person ann 17300 11600\n"
                                               "  wait 15  walk 17100 7500 300  wait 100\n"
                                               "person bob 17800 12000\n"));
  options.drive.start_in_world = Pose{17.3, 14.2, -kPi / 2};
  options.sees = true_eyes();
  Whole whole(options);
  const auto& persons = whole.drive().scene().persons();
  const auto away = [&](int who) {
    return (persons[static_cast<std::size_t>(who)].at - whole.truth().position()).norm();
  };
  const auto goal = whole.ask("follow-person", {point("near", {17.3, 11.6, 0.0}, Frame::map)});
  whole.advance_until([&] { return said(whole, "Here I am"); }, 145);
  EXPECT_LT(away(1), away(0)) << "Bob is nearer";
  while (whole.cycle() < 400)
    whole.advance();
  EXPECT_FALSE(whole.ended(goal)) << whole.status(goal).reason;
  EXPECT_NEAR(away(0), 1.2, 0.2);
  EXPECT_GT(away(1), 2.0);
  EXPECT_EQ(whole.drive().contacts(), 0);
}

// ---- Golden traces: the exact course of each activity in a world of its own. To renew them after
// a deliberate change, set SAPHIRA_RENEW_GOLDEN=1 in the environment of this program.

const char* const kScenarios[] = {"go-to-place",
                                  "go-to-position",
                                  "through-the-library",
                                  "closed-door",
                                  "lost",
                                  "make-sure",
                                  "figure-9",
                                  "find-and-follow",
                                  "patrol",
                                  "patrol-places",
                                  "explore",
                                  "bump-and-go",
                                  "attend",
                                  "guide",
                                  "come-back",
                                  "pause",
                                  "tell",
                                  "inquire",
                                  "deliver",
                                  "follow-person",
                                  "search-person",
                                  "blob-search",
                                  "look",
                                  "build-map"};

class Golden : public ::testing::TestWithParam<const char*> {};

TEST_P(Golden, TheTransitionsAreThoseThatAreStored) {
  int played = 0;
  const int cases = play<Errand>("tests/drive/golden.txt", '#', [&](int, const std::string& name) {
    played += name == GetParam() ? 1 : 0;
    return name == GetParam();
  });
  EXPECT_EQ(cases, static_cast<int>(std::size(kScenarios)));
  EXPECT_EQ(played, 1);
}

const auto kNamed = [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
};
INSTANTIATE_TEST_SUITE_P(Library, Golden, ::testing::ValuesIn(kScenarios), kNamed);

class Restored : public ::testing::TestWithParam<const char*> {};

TEST_P(Restored, CoresGoOnAsTheOldOnesToTheLastBit) {
  const auto course = [](std::uint64_t restores_every) {
    Errand::restores_every = restores_every;
    play<Errand>("tests/drive/golden.txt", '#',
                 [](int, const std::string& name) { return name == GetParam(); });
    Errand::restores_every = 0;
    return Errand::course.text();
  };
  const std::string as_usual = course(0);
  EXPECT_EQ(course(50), as_usual);
}

INSTANTIATE_TEST_SUITE_P(Cores, Restored, ::testing::Values("deliver", "lost", "follow-person"),
                         kNamed);

TEST(RestoredCores, AStateOfAnotherVersionIsAnErrorAndChangesNothing) {
  Whole whole(office());
  whole.ask("go-to-place", {text("place", "EJ-231")});
  for (int i = 0; i < 100; ++i)
    whole.advance();
  int services = 0;
  whole.drive().services().each([&](runtime::Service& service) {
    ++services;
    const std::string state = service.save();
    for (const std::string& other :
         {"{\"another\":1," + state.substr(1), std::string("{\"another\":1}"), std::string("{}"),
          std::string("none"), state.substr(0, state.size() / 2)})
      EXPECT_THROW(service.restore(other), std::runtime_error) << other.substr(0, 60);
    EXPECT_EQ(service.save(), state);
  });
  EXPECT_EQ(services, 4);
}

TEST(GoldenTraces, EveryActivityThatIsShippedIsInOne) {
  std::string all;
  for (const char* const scenario : kScenarios)
    all += read_file(golden(scenario));
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
