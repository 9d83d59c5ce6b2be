// The registration service without a bus: its answers, decisions, memory and outputs.
#include "saphira/registration/core.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "process.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/text.hpp"
#include "saphira/maps/artifact_traits.hpp"

namespace saphira::registration {
namespace {

constexpr int kSonars = 16;
constexpr const char* kHall =
    "CORRIDOR (1) 10000, 0, 0, 20000, 2000 \"hall\"\n"
    "DOOR (2) 3000, 1000, -90, 900\n"
    "DOOR (3) 6000, 1000, -90, 900\n"
    "POS (6) 3500, 0, 0 \"start\"\n";

std::vector<lps::SonarMount> mounts() {
  std::vector<lps::SonarMount> result;
  for (int i = 0; i < kSonars; ++i)
    result.push_back({i, {0.0, 0.0, norm2_angle(2.0 * kPi * i / kSonars)}});
  return result;
}

/// A corridor of 2 m, whose walls the robot hears as it drives to and fro. Requests and lost links
/// come with a step.
class Robot {
 public:
  explicit Robot(std::uint64_t seed = 1) : random_(seed) {}

  Core::Outputs step(Core& core) {
    ++cycle_;
    if (std::exchange(drives_, true)) {
      truth_ = compose(truth_, {0.03, 0.0, 0.0});
      odom_ = compose(odom_, {0.03 * random_.normal(1.0, 0.03), 0.0, random_.normal(0.0, 0.001)});
    }
    Core::Inputs inputs;
    inputs.cycle = cycle_;
    if (std::exchange(is_new_, false))
      inputs.new_robot = &mounts_;
    inputs.odom = frame_;
    inputs.pose_in_odom = odom_;
    for (int sonar = 0; sonar < kSonars; ++sonar)
      inputs.readings.push_back(hear(sonar));
    if (cycle_ % 5 == 0)
      for (const double side : {1.0, -1.0})
        inputs.percepts.push_back(wall(side));
    core.processes().step(cycle_);
    return core.step(inputs);
  }
  /// A step without a way.
  Core::Outputs stand(Core& core) {
    drives_ = false;
    return step(core);
  }
  /// The link was lost and is there again.
  void reconnect() {
    is_new_ = true;
    cycle_ = 0;
  }
  /// Dead reckoning begins anew.
  void new_frame() {
    ++frame_;
    odom_ = {};
  }
  const Pose& truth() const { return truth_; }
  std::uint64_t frame() const { return frame_; }
  const Pose& pose_in_odom() const { return odom_; }

 private:
  lps::SonarReading hear(int sonar) {
    const double across = std::sin(truth_.th + 2.0 * kPi * sonar / kSonars);
    lps::SonarReading reading;
    reading.sonar = sonar;
    reading.echo = std::abs(across) > 0.95;
    reading.range = reading.echo ? random_.normal(1.0, 0.01) / std::abs(across) : 5.0;
    return reading;
  }
  lps::Percept wall(double side) {
    lps::Percept seen;
    seen.id = ++last_id_;
    seen.type = lps::PointType::wall;
    seen.pose_in_odom = compose(odom_, {0.0, side, side > 0.0 ? kPi : 0.0});
    seen.length = 1.5;
    seen.sigma_along = 0.03;
    seen.sigma_across = 0.03;
    seen.sigma_heading = radians(1.0);
    seen.confidence = 1.0;
    seen.seen = cycle_;
    seen.readings = {{cycle_, side > 0.0 ? 4 : 12}};
    return seen;
  }

  Random random_;
  const std::vector<lps::SonarMount> mounts_ = mounts();
  bool is_new_ = true;
  bool drives_ = true;
  std::uint64_t cycle_ = 0;
  std::uint64_t frame_ = 1;
  std::uint32_t last_id_ = 0;
  Pose truth_{3.5, 0.0, 0.0};
  Pose odom_;
};

Core::Settings settings(const std::string& text = kHall) {
  Core::Settings made;
  made.map = maps::parse_map(text, "hall.map");
  made.source = text.empty() ? "" : "hall.map";
  made.start = start_pose("start", made.map);
  return made;
}

Request request(const std::string& functor) {
  return {functor};
}

Answer act(Core& core, const Request& request) {
  return core.between({&request, 1}).front();
}

Request request(const std::string& functor, bool on) {
  return {functor, {{"on", on}}};
}

Request load(const std::string& text, const std::string& name = "other.map") {
  return {"load", {{"text", text}, {"name", name}}};
}

Request place(const Pose& pose_in_map) {
  return {"place", {{"position", PlacedPoint{pose_in_map, Frame::map}}}};
}

Request put(lps::PointType type, const Pose& pose_in_map, std::uint32_t id = 0) {
  return {"put",
          {{"id", static_cast<double>(id)},
           {"type", std::string(maps::traits(type).word)},
           {"position", PlacedPoint{pose_in_map, Frame::map}},
           {"length", 1.0},
           {"width", 1.0}}};
}

Request remove(std::uint32_t id) {
  return {"remove", {{"id", static_cast<double>(id)}}};
}

std::uint32_t id_of(const Answer& answer) {
  return static_cast<std::uint32_t>(number_of(answer.results, "id"));
}

bool says(const Notes& notes, const std::string& part) {
  return std::any_of(notes.lines().begin(), notes.lines().end(),
                     [&](const Note& note) { return note.text.find(part) != std::string::npos; });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A robot in the hall, whose map is loaded.
class RegistrationInAHall : public testing::Test {
 protected:
  /// So many steps on its way; returns the outputs of the last one.
  Core::Outputs drive(int steps) {
    Core::Outputs last;
    for (int i = 0; i < steps; ++i)
      last = robot.step(core);
    return last;
  }

  Core core{settings()};
  Robot robot;
};

TEST_F(RegistrationInAHall, RegistersFromTheStartOfTheMapAndSaysItOnce) {
  const Core::Outputs first = robot.stand(core);
  EXPECT_EQ(first.state, v1::REGISTRATION_TRACKING);
  EXPECT_TRUE(says(first.notes, "tracking"));
  EXPECT_EQ(first.environment, 1U);
  EXPECT_NEAR(first.pose_in_map.x, 3.5, 0.1);
  EXPECT_TRUE(robot.stand(core).notes.empty());
}

TEST(RegistrationCore, WithoutAStartTheRobotHasToBeFound) {
  Core::Settings unplaced = settings();
  unplaced.start.reset();
  Core core(unplaced);
  Robot robot;
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_UNPLACED);
}

TEST(RegistrationCore, AMapOnWhichNoRobotCanBeRegisteredIsRefused) {
  EXPECT_THROW(Core(settings("OFFICE (1) 0, 0, 0, 2000000, 2000000\n")), std::invalid_argument);
}

// Requests.

TEST(RegistrationCore, WhatNeedsARobotIsRefusedBeforeThereIsOne) {
  Core core(settings());
  for (const Request& one : {place({5.0, 0.0, 0.0}), request("find"), request("switch"),
                             request("add_features"), request("snap")})
    EXPECT_EQ(act(core, one).text, "there is no robot yet");
  EXPECT_EQ(act(core, put(lps::PointType::position, {5.0, 0.0, 0.0})).text, "");
  EXPECT_EQ(act(core, load(kHall)).text, "");
  EXPECT_EQ(act(core, request("delete")).text, "");
}

TEST_F(RegistrationInAHall, LoadsAMapAndKeepsTheOldOneWhereItIsBad) {
  robot.stand(core);
  const std::uint64_t revision = core.map_revision();
  EXPECT_TRUE(
      contains(act(core, load("CORRIDOR (1) 0, 0, 0, 10000\n", "bad.map")).text, "bad.map:1:"));
  EXPECT_TRUE(
      contains(act(core, load("OFFICE (1) 0, 0, 0, 2000000, 2000000\n")).text, "at most 25 ha"));
  EXPECT_EQ(core.map_revision(), revision);
  EXPECT_EQ(core.map_source(), "hall.map");
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_TRACKING);

  EXPECT_EQ(act(core, load("CORRIDOR (7) 10000, 0, 0, 20000, 2000\n")).text, "");
  EXPECT_GT(core.map_revision(), revision);
  EXPECT_EQ(core.map_source(), "other.map");
  EXPECT_FALSE(core.map_changed());
  EXPECT_EQ(robot.stand(core).environment, 7U);
}

TEST_F(RegistrationInAHall, OnAnotherMapThePoseIsAGuess) {
  const Core::Outputs before = drive(100);
  ASSERT_GT(before.confidence, 0.9);
  // The same place on it by chance: the readings confirm the guess.
  EXPECT_EQ(act(core, load("CORRIDOR (7) 10000, 0, 0, 20000, 2000\n")).text, "");
  const Core::Outputs guess = robot.stand(core);
  EXPECT_EQ(guess.state, v1::REGISTRATION_TRACKING);
  EXPECT_NEAR(guess.pose_in_map.x, before.pose_in_map.x, 0.1);
  EXPECT_LE(guess.confidence, 0.5);
  EXPECT_TRUE(contains(guess.reason, "another map was loaded")) << guess.reason;
  const Core::Outputs later = drive(100);
  EXPECT_GT(later.confidence, 0.9);
  EXPECT_FALSE(contains(later.reason, "another map")) << later.reason;
}

TEST_F(RegistrationInAHall, OffAnotherMapThePoseIsForgotten) {
  drive(100);
  EXPECT_EQ(act(core, load("CORRIDOR (7) 60000, 0, 0, 20000, 2000\n")).text, "");
  const Core::Outputs after = robot.stand(core);
  EXPECT_EQ(after.state, v1::REGISTRATION_UNPLACED);
  EXPECT_EQ(after.confidence, 0.0);
  EXPECT_TRUE(contains(after.reason, "another map was loaded")) << after.reason;
  EXPECT_FALSE(core.remembered()->memory.placed);
}

TEST_F(RegistrationInAHall, AnEditOfTheMapLeavesThePoseInPeace) {
  drive(100);
  const std::uint32_t id = id_of(act(core, put(lps::PointType::position, {5.0, 0.0, 0.0})));
  EXPECT_GT(robot.step(core).confidence, 0.9);
  Request gone = request("remove");
  gone.arguments = {saphira::number("id", id)};
  EXPECT_EQ(act(core, gone).text, "");
  EXPECT_GT(robot.step(core).confidence, 0.9);
}

TEST_F(RegistrationInAHall, DeletesTheMap) {
  robot.stand(core);
  EXPECT_EQ(act(core, request("delete")).text, "");
  EXPECT_TRUE(core.map().features.empty());
  EXPECT_EQ(core.map_source(), "");
  EXPECT_FALSE(core.adds_features()) << "that is asked for, or of an empty map at the start";
}

TEST_F(RegistrationInAHall, PutsAndRemovesArtifacts) {
  robot.stand(core);
  const Answer made = act(core, put(lps::PointType::position, {5.0, 0.0, 0.0}));
  EXPECT_EQ(made.text, "");
  ASSERT_NE(maps::find(core.map(), id_of(made)), nullptr);
  EXPECT_TRUE(core.map_changed());
  const Request moved = put(lps::PointType::position, {6.0, 0.0, 0.0}, id_of(made));
  EXPECT_EQ(id_of(act(core, moved)), id_of(made));
  EXPECT_EQ(maps::find(core.map(), id_of(made))->pose_in_map.x, 6.0);

  const std::uint64_t revision = core.map_revision();
  EXPECT_TRUE(contains(act(core, put(lps::PointType::object, {9000.0, 9000.0, 0.0})).text,
                       "at most 25 ha"));
  EXPECT_EQ(act(core, remove(4711)).text, "no artifact (4711) in the map");
  EXPECT_EQ(core.map_revision(), revision);
  EXPECT_EQ(id_of(act(core, remove(2))), 2U);
  EXPECT_EQ(maps::find(core.map(), 2), nullptr);
}

TEST_F(RegistrationInAHall, PlacesTheRobotWhereItCanBe) {
  robot.stand(core);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Pose& wrong : {Pose{nan, 0.0, 0.0}, Pose{5.0, 1e13, 0.0}, Pose{5.0, 0.0, nan}})
    EXPECT_TRUE(contains(act(core, place(wrong)).text, "within 10 km"));
  EXPECT_NE(act(core, place({5.0, 40.0, 0.0})).text, "");
  EXPECT_NEAR(robot.stand(core).pose_in_map.x, 3.5, 0.1);
  EXPECT_EQ(act(core, place({8.0, 0.0, 0.0})).text, "");
  EXPECT_NEAR(robot.stand(core).pose_in_map.x, 8.0, 0.1);
}

TEST_F(RegistrationInAHall, FindsAndSwitches) {
  robot.stand(core);
  EXPECT_EQ(act(core, request("switch", false)).text, "");
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_OFF);
  EXPECT_EQ(act(core, request("switch", true)).text, "");
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_TRACKING);
  EXPECT_EQ(act(core, request("find")).text, "");
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_UNPLACED);
}

TEST_F(RegistrationInAHall, AddsFeaturesAndSnapsAsItIsAsked) {
  robot.stand(core);
  EXPECT_FALSE(core.adds_features());
  EXPECT_TRUE(core.snaps());
  EXPECT_EQ(act(core, request("add_features", true)).text, "");
  EXPECT_EQ(act(core, request("snap", false)).text, "");
  EXPECT_TRUE(core.adds_features());
  EXPECT_FALSE(core.snaps());
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_TRACKING)
      << "on a map that is known it is registered";
}

TEST(RegistrationCore, WhatItCanBeAskedForIsDeclared) {
  for (Request one : {load(kHall), request("delete"), put(lps::PointType::door, {5.0, 0.0, 0.0}),
                      remove(4), place({5.0, 0.0, 0.0}), request("find"), request("switch", true),
                      request("add_features", false), request("snap", true)})
    EXPECT_FALSE(refusal(Core::functors(), one)) << describe(one);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (Request one : {request("sing"), request("switch"), remove(0), place({nan, 0.0, 0.0}),
                      put(lps::PointType::invalid, {5.0, 0.0, 0.0})})
    EXPECT_TRUE(refusal(Core::functors(), one)) << describe(one);
}

TEST(RegistrationCore, WhatItCanBeAskedForIsDocumented) {
  EXPECT_TRUE(contains(read_file(test::source("docs/requests.md")), help(Core::functors())))
      << help(Core::functors());
}

// A map from nothing.

TEST(RegistrationCore, WhileAMapIsBuiltWhatWouldBeLostIsRefused) {
  Core core(settings(""));
  Robot robot;
  const Core::Outputs first = robot.step(core);
  EXPECT_EQ(first.reason, "builds the map");
  EXPECT_TRUE(core.adds_features());
  for (const char* const action : {"remove", "find", "switch"})
    EXPECT_EQ(act(core, request(action)).text,
              "the map is being built: switch that off first (features off)");
  for (int i = 0; i < 300; ++i)
    robot.step(core);
  ASSERT_FALSE(core.map().features.empty());
  EXPECT_TRUE(core.map_changed());
  // Building keeps the places that were put, and the walls that were built.
  const std::size_t built = core.map().features.size();
  EXPECT_EQ(act(core, put(lps::PointType::position, {1.0, 0.5, 0.0})).text, "");
  EXPECT_EQ(act(core, request("snap", false)).text, "");
  EXPECT_EQ(core.map().features.size(), built + 1);
  // Registration uses the built map, with the robot at the same place.
  const Pose before = robot.stand(core).pose_in_map;
  EXPECT_EQ(act(core, request("add_features", false)).text, "");
  const Core::Outputs after = robot.stand(core);
  EXPECT_EQ(after.state, v1::REGISTRATION_TRACKING);
  EXPECT_NE(after.reason, "builds the map");
  EXPECT_TRUE(
      std::any_of(core.map().features.begin(), core.map().features.end(), [](const auto& one) {
        return one.pose_in_map == Pose{1.0, 0.5, 0.0};
      }));
  EXPECT_NEAR(after.pose_in_map.x, before.x, 0.1);
  EXPECT_NEAR(after.pose_in_map.y, before.y, 0.1);
  // A robot that is started there again knows where it is.
  const std::optional<Pose> start = start_pose("start", core.map());
  ASSERT_TRUE(start);
  EXPECT_NEAR(start->x, first.pose_in_map.x, 0.1);
  EXPECT_NEAR(start->y, first.pose_in_map.y, 0.1);
}

TEST(RegistrationCore, WhileAMapIsBuiltTheRobotCanBePlaced) {
  Core core(settings(""));
  Robot robot;
  robot.step(core);
  EXPECT_EQ(act(core, place({7.0, -2.0, 0.0})).code, AnswerCode::done);
  const Core::Outputs placed = robot.stand(core);
  EXPECT_EQ(placed.reason, "builds the map");
  EXPECT_NEAR(placed.pose_in_map.x, 7.0, 0.1);
  EXPECT_NEAR(placed.pose_in_map.y, -2.0, 0.1);
  for (int i = 0; i < 300; ++i)
    robot.step(core);
  const std::size_t built = core.map().features.size();
  ASSERT_GT(built, 0U);
  // The map is kept, and additions go on from the new place.
  const Pose before = robot.stand(core).pose_in_map;
  EXPECT_EQ(act(core, place({before.x + 1.0, before.y, before.th})).code, AnswerCode::done);
  EXPECT_NEAR(robot.stand(core).pose_in_map.x, before.x + 1.0, 0.1);
  EXPECT_GE(core.map().features.size(), built);
  EXPECT_TRUE(core.adds_features());
}

TEST(RegistrationCore, BuildingThatNobodyAsksForAgainEnds) {
  Core core(settings(""));
  Core unlimited(settings(""));
  Robot robot;
  Robot other;
  Request lease = request("add_features", true);
  lease.arguments.push_back(saphira::number("lease", 1.0));
  robot.step(core);
  other.step(unlimited);
  act(unlimited, request("add_features", true));
  for (int i = 0; i < 300; ++i) {
    if (i % 5 == 0) {
      EXPECT_EQ(act(core, lease).text, "");
    }
    EXPECT_EQ(robot.step(core).reason, "builds the map");
    other.step(unlimited);
  }
  EXPECT_FALSE(core.map().features.empty());
  EXPECT_EQ(core.map(), unlimited.map()) << "it was built in one piece";
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(core.adds_features());
    EXPECT_EQ(robot.step(core).reason, "builds the map");
  }
  EXPECT_FALSE(core.adds_features());
  EXPECT_EQ(robot.step(core).reason.find("builds"), std::string::npos);
  EXPECT_FALSE(maps::named(core.map(), lps::PointType::position, "start").empty());
}

TEST(RegistrationCore, AMapThatIsLoadedEndsTheBuilding) {
  Core core(settings(""));
  Robot robot;
  for (int i = 0; i < 300; ++i)
    robot.step(core);
  EXPECT_EQ(act(core, load(kHall)).text, "");
  EXPECT_NE(robot.stand(core).reason, "builds the map");
  EXPECT_EQ(core.map_source(), "other.map");
  EXPECT_NE(maps::find(core.map(), 2), nullptr);
}

// Links, frames and micro-tasks.

TEST_F(RegistrationInAHall, WhatWasAskedForOutlastsTheLink) {
  robot.stand(core);
  act(core, request("switch", false));
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_OFF);
  robot.reconnect();
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_OFF);
  act(core, request("switch", true));
  act(core, request("find"));
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_UNPLACED);
  robot.reconnect();
  EXPECT_EQ(robot.stand(core).state, v1::REGISTRATION_UNPLACED) << "it may be far from the start";
}

TEST_F(RegistrationInAHall, ALinkThatIsThereAgainLeavesTheRobotWhereItWas) {
  drive(100);
  const Pose before = robot.stand(core).pose_in_map;
  EXPECT_GT(before.x, 5.5);
  robot.reconnect();
  const Core::Outputs after = robot.stand(core);
  EXPECT_EQ(after.state, v1::REGISTRATION_TRACKING);
  EXPECT_NEAR(after.pose_in_map.x, before.x, 0.05);
}

TEST_F(RegistrationInAHall, InAnotherOdometryFrameThePoseIsAGuessUntilTheReadingsFitIt) {
  drive(100);
  const Core::Outputs before = robot.stand(core);
  robot.new_frame();
  const Core::Outputs after = robot.stand(core);
  EXPECT_NEAR(after.pose_in_map.x, before.pose_in_map.x, 0.1);
  EXPECT_GT(after.covariance(0, 0), before.covariance(0, 0));
  EXPECT_EQ(after.state, v1::REGISTRATION_LOST);
  EXPECT_NE(after.reason.find("dead reckoning has begun anew"), std::string::npos) << after.reason;
  EXPECT_TRUE(core.remembered()->memory.placed) << "a restart now has the same guess";
  EXPECT_NE(core.remembered()->memory.odom, robot.frame());
  Core::Outputs later = after;
  for (int i = 0; i < 100 && later.state != v1::REGISTRATION_TRACKING; ++i)
    later = robot.step(core);
  EXPECT_EQ(later.state, v1::REGISTRATION_TRACKING);
}

TEST(RegistrationCore, AZoneIsPutWithItsRule) {
  Core core(settings());
  Request zone = put(lps::PointType::zone, {5.0, 0.0, 0.0});
  zone.arguments.push_back({"rule", std::string("slow")});
  zone.arguments.push_back({"speed", 0.15});
  const Answer made = act(core, zone);
  EXPECT_EQ(made.text, "");
  const maps::Feature* const feature = maps::find(core.map(), id_of(made));
  ASSERT_NE(feature, nullptr);
  EXPECT_EQ(feature->rule, maps::ZoneRule::slow);
  EXPECT_DOUBLE_EQ(feature->speed, 0.15);
  zone.arguments.back().number = 0.0;
  EXPECT_TRUE(contains(act(core, zone).text, "a speed of a slow zone"));
}

TEST_F(RegistrationInAHall, APoseThatWasOnlyToldIsHalfTrusted) {
  const Core::Outputs told = robot.stand(core);
  EXPECT_EQ(told.state, v1::REGISTRATION_TRACKING);
  EXPECT_LE(told.confidence, 0.5);
  EXPECT_NE(told.reason.find("as it was told"), std::string::npos) << told.reason;
  const Core::Outputs later = drive(100);
  EXPECT_GT(later.confidence, 0.9);
}

TEST_F(RegistrationInAHall, ASuspendedProcessDoesNothingUntilItIsResumed) {
  const auto ask = [&](const char* process, ProcessAction action) {
    EXPECT_EQ(core.processes().request(process, action), "");
    return robot.stand(core);
  };
  EXPECT_EQ(robot.stand(core).environment, 1U);
  EXPECT_EQ(ask("test-environment", ProcessAction::suspend).environment, 0U);
  EXPECT_EQ(ask("test-environment", ProcessAction::resume).environment, 1U);
  const Core::Outputs suspended = ask("test-match", ProcessAction::suspend);
  EXPECT_EQ(suspended.state, v1::REGISTRATION_OFF);
  EXPECT_EQ(suspended.reason, "test-match is suspended: the pose goes on by dead reckoning");
  EXPECT_EQ(ask("test-match", ProcessAction::resume).state, v1::REGISTRATION_TRACKING);
}

// State that outlives the core.

TEST_F(RegistrationInAHall, ARestartGoesOnFromWhatWasRemembered) {
  EXPECT_FALSE(core.remembered()) << "before the first robot there is nothing";
  drive(100);
  const std::uint32_t id = id_of(act(core, put(lps::PointType::position, {5.0, 0.0, 0.0})));
  const Pose before = robot.stand(core).pose_in_map;
  Core next(settings(), restored<Remembered>(saved(*core.remembered())));
  EXPECT_NE(maps::find(next.map(), id), nullptr);
  EXPECT_TRUE(next.map_changed());
  robot.reconnect();
  const Core::Outputs after = robot.stand(next);
  EXPECT_EQ(after.state, v1::REGISTRATION_TRACKING);
  EXPECT_NEAR(after.pose_in_map.x, before.x, 0.05);
}

TEST_F(RegistrationInAHall, InAnotherFrameAtTheStartOfTheDeploymentNothingIsInDoubt) {
  robot.stand(core);
  Core next(settings(), core.remembered());
  robot.reconnect();
  robot.new_frame();
  const Core::Outputs after = robot.stand(next);
  EXPECT_EQ(after.state, v1::REGISTRATION_TRACKING);
  EXPECT_LE(after.confidence, 0.5);
}

TEST_F(RegistrationInAHall, ARestartKnowsTheMapThatWasLoadedAndNoStartOnIt) {
  robot.stand(core);
  act(core, load("CORRIDOR (5) 0, 0, 0, 30000, 2000\n", "a;b  c.map"));
  act(core, request("find"));
  robot.stand(core);
  Core next(settings(), core.remembered());
  EXPECT_EQ(next.map_source(), "a;b  c.map");
  EXPECT_FALSE(next.map_changed());
  robot.reconnect();
  EXPECT_EQ(robot.stand(next).state, v1::REGISTRATION_UNPLACED);
}

TEST_F(RegistrationInAHall, ARestartKnowsThatTheMapWasDeleted) {
  robot.stand(core);
  act(core, request("delete"));
  robot.stand(core);
  const Core next(settings(), restored<Remembered>(saved(*core.remembered())));
  EXPECT_EQ(next.map_source(), "");
  EXPECT_TRUE(next.map().features.empty());
}

TEST_F(RegistrationInAHall, WhatWasRememberedOfAnotherMapDoesNotCount) {
  robot.stand(core);
  act(core, put(lps::PointType::position, {5.0, 0.0, 0.0}));
  Core::Settings other = settings();
  other.source = "another.map";
  EXPECT_EQ(Core(other, core.remembered()).map(), Core(other).map());
}

TEST(RegistrationCore, WhileAMapIsBuiltTheBuildersPoseIsRemembered) {
  Core core(settings(""));
  Robot robot;
  Core::Outputs newest;
  for (int i = 0; i < 200; ++i)
    newest = robot.step(core);
  const std::optional<Remembered> remembered = core.remembered();
  ASSERT_TRUE(remembered);
  EXPECT_TRUE(remembered->memory.placed);
  EXPECT_EQ(remembered->memory.pose_in_map, newest.pose_in_map);
  EXPECT_EQ(remembered->memory.odom, robot.frame());
  EXPECT_EQ(remembered->memory.pose_in_odom, robot.pose_in_odom());
  EXPECT_EQ(remembered->map, core.map());
}

/// The events of a core on its way, by cycle.
void happen(int cycle, Core& core, Robot& robot) {
  switch (cycle) {
    case 40:
      act(core, put(lps::PointType::position, {5.0, 0.0, 0.0}));
      break;
    case 80:
      robot.new_frame();
      break;
    case 120:
      core.processes().request("test-match", ProcessAction::suspend, 15);
      break;
    case 160:
      act(core, request("add_features", true));
      break;
    case 200:
      robot.reconnect();
      break;
    case 240:
      act(core, request("add_features", false));
      break;
    case 280:
      act(core, request("find"));
      break;
    default:
      break;
  }
}

TEST(RegistrationCore, TheSameInputsGiveTheSameOutputs) {
  for (const char* map : {kHall, ""}) {
    Core a(settings(map));
    Core b(settings(map));
    Robot robot_a(3);
    Robot robot_b(3);
    for (int i = 0; i < 320; ++i) {
      happen(i, a, robot_a);
      happen(i, b, robot_b);
      ASSERT_EQ(robot_a.step(a), robot_b.step(b)) << i;
      ASSERT_EQ(a.map(), b.map()) << i;
      ASSERT_EQ(a.map_revision(), b.map_revision()) << i;
      ASSERT_EQ(a.remembered(), b.remembered()) << i;
    }
  }
}

}  // namespace
}  // namespace saphira::registration
