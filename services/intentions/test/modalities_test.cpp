#include <gtest/gtest.h>

#include "language_bench.hpp"

// Each goal modality of Figure 8, and the additions of PRS.

namespace saphira::intentions {
namespace {

TEST(Modality, WhatGoesOnHasItsPointsWhereTheyAreNow) {
  Stage stage(
      activity("(MAINTAIN (not stalled) :by (WAIT-FOR (not stalled) :forever t)"
               " (INTEND :GoToPos ((goal . p))))",
               ":params ((p :point))"));
  stage.inputs.robot.odom_in_map = Pose{};
  stage.ask(1, "it", {point("p", {3.0, 0.0, 0.0}, Frame::map)});
  stage.step(2);
  stage.stall(true, 2);
  EXPECT_TRUE(stage.behaviors().empty());
  stage.inputs.robot.left_stalled = false;
  stage.inputs.robot.odom_in_map = Pose{1.0, 0.0, 0.0};
  stage.step();
  EXPECT_EQ(find(stage.out.behaviors.at(0).parameters, "goal")->point, (Pose{2.0, 0.0, 0.0}));
}

TEST(Modality, APersonSwitchesABehaviorOffAndOn) {
  Stage stage(
      activity("(INTEND :Stop () :blocking nil) (INTEND :GoToPos () :name go :timeout 10)"));
  stage.begin(3);
  ASSERT_EQ(stage.behaviors(), Names({"Stop", "GoToPos"}));
  const std::uint32_t go = stage.out.nodes[2].id;
  EXPECT_FALSE(stage.executor->resume(go)) << "it is not off";
  ASSERT_TRUE(stage.executor->interrupt(go));
  stage.step(20);
  EXPECT_EQ(stage.behaviors(), Names({"Stop"})) << "the other goes on";
  EXPECT_EQ(stage.out.nodes[2].state, IntentionState::kSuspended);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY) << "no timeout has run meanwhile";
  // With its intention it is held as well: it stays off when that goes on.
  ASSERT_TRUE(stage.executor->interrupt(stage.out.nodes[0].id));
  stage.step(2);
  ASSERT_TRUE(stage.executor->resume(stage.out.nodes[0].id));
  stage.step(2);
  EXPECT_EQ(stage.behaviors(), Names({"Stop"}));
  ASSERT_TRUE(stage.executor->resume(go));
  stage.step(2);
  EXPECT_EQ(stage.behaviors(), Names({"Stop", "GoToPos"}));
  EXPECT_FALSE(stage.executor->interrupt(4711));
}

TEST(Modality, APersonInterruptsAndResumesAnIntention) {
  Stage stage(activity("(INTEND :part ())") +
              "(defintention :part :goals '((INTEND :GoToPos () :name go)))"
              "(defintention :other :goals '((EXECUTE (say \"other\"))))");
  stage.begin(3);
  const std::uint32_t part = stage.out.nodes[1].id;
  ASSERT_TRUE(stage.executor->interrupt(part));
  stage.step(3);
  EXPECT_TRUE(stage.behaviors().empty());
  EXPECT_EQ(stage.out.nodes[1].state, IntentionState::kSuspended);
  // Another goal comes and goes: an intention that a person holds stays held.
  stage.ask(2, "other", {}, 5);
  stage.step(10);
  EXPECT_TRUE(stage.behaviors().empty());
  ASSERT_TRUE(stage.executor->resume(part));
  EXPECT_FALSE(stage.executor->resume(part));
  stage.step();
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
}

TEST(Modality, LevelsAndTrends) {
  Stage stage(activity("(INTEND :GoToPos () :name go)"));
  stage.begin(4);
  for (int i = 0; i < 20; ++i) {
    stage.satisfy("go", 0.03 * i, 1);
  }
  EXPECT_NEAR(stage.status(1).level, 0.5, 0.1);
  EXPECT_EQ(stage.status(1).trend, v1::TREND_RISING);
  stage.step(40);
  EXPECT_EQ(stage.status(1).trend, v1::TREND_STEADY);
  stage.dispose(1);
  stage.step();
  // A goal with a lower level.
  stage.satisfy("go", 0.4);
  stage.level = 0.5;
  stage.begin(2, "it", 10);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_UNDERWAY);
  stage.satisfy("go", 0.6, 2);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.status(2).reason, "satisfied to 0.6, 0.5 was asked for");
}

TEST(Modality, PointsOnTheMapAreGivenInOdomAsRegistrationGoes) {
  Stage stage(activity("(INTEND :GoToPos ((goal . p)))", ":params ((p :point))"));
  stage.inputs.robot.odom_in_map = Pose{10.0, 0.0, 0.0};
  stage.ask(1, "it", {point("p", {12.0, 3.0, 0.0}, Frame::map)});
  stage.step(2);
  EXPECT_EQ(find(stage.out.behaviors.at(0).parameters, "goal")->point, (Pose{2.0, 3.0, 0.0}));
  EXPECT_EQ(find(stage.out.behaviors.at(0).parameters, "goal")->frame, Frame::odom);
  stage.inputs.robot.odom_in_map = Pose{10.5, 0.0, 0.0};
  stage.step();
  EXPECT_EQ(find(stage.out.behaviors.at(0).parameters, "goal")->point, (Pose{1.5, 3.0, 0.0}));
  stage.inputs.robot.odom_in_map.reset();
  stage.step();
  EXPECT_EQ(find(stage.out.behaviors.at(0).parameters, "goal")->point, (Pose{1.5, 3.0, 0.0}));
}

TEST(Modality, AnActivityBeginsAnewWhenDeadReckoningDoes) {
  Stage stage(
      activity("(= here (robot)) (EXECUTE (say \"from ~a\" here))"
               "(INTEND :GoToPos ((goal . here)))"));
  stage.begin(4);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
  stage.inputs.robot.odom = 2;
  stage.inputs.robot.pose_in_odom = {5.0, 0.0, 0.0};
  stage.step(4);
  EXPECT_EQ(stage.messages, Names({"from (0, 0) in odom", "from (5, 0) in odom"}));
  EXPECT_EQ(find(stage.out.behaviors.at(0).parameters, "goal")->point.x, 5.0);
}

TEST(Modality, WhatRunsGoesOnWithTheSchemaThatItBeganWith) {
  Stage stage(activity("(WAIT-FOR stalled :forever t) (INTEND :part ())") +
              "(defintention :part :goals '((SUCCEED)))");
  stage.begin(2);
  const Loaded changed = load_text(
      "test.act", activity("(FAIL \"new\")") + "(defintention :part :goals '((FAIL \"new part\")))",
      *stage.options.functions, stage.executor->registry());
  ASSERT_TRUE(changed.ok()) << errors(changed);
  for (const Schema& schema : changed.schemas)
    stage.executor->add(schema);
  stage.step(2);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  stage.stall(true, 3);
  EXPECT_EQ(stage.status(1).reason, "part: new part") << "what it begins anew is the new one";
  stage.begin(2, "it", 3);
  EXPECT_EQ(stage.status(2).reason, "new");
}

// A question counts statements from then on, also repeated ones.
TEST(Modality, WhenABeliefWasSaid) {
  Stage stage(
      activity("(= since (now)) (= name (format \"an~a\" 'swer))"
               "(WAIT-FOR (and (belief-since name) (>= (belief-since name) since)) :timeout 60s)"
               "(EXECUTE (believe (format \"*~a*\" 'kept) (belief name)))"
               "(SUCCEED \"~a ~a ~a\" (yes (belief name)) *kept* (yes (belief 'other)))"));
  stage.inputs.claims.push_back({ClaimEvent::Kind::kSaid, {9, 1}, "a person", "answer", "yes"});
  stage.step(3);
  stage.begin(5);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  stage.inputs.claims.push_back({ClaimEvent::Kind::kSaid, {9, 2}, "a person", "answer", "Yes"});
  stage.step(4);
  EXPECT_EQ(stage.status(1).reason, "t Yes nil");
}

TEST(Modality, ClaimsOfThirdPartiesAreBeliefs) {
  Stage stage(activity("(WAIT-FOR (belief 'door-open) :forever t)"));
  stage.begin(3);
  stage.inputs.claims.push_back(
      {ClaimEvent::Kind::kSaid, {9, 1}, "a door", "door_open", Value::truth(true)});
  stage.step();
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  const auto all = stage.executor->beliefs().all();
  const auto claimed = std::find_if(all.begin(), all.end(),
                                    [](const Belief& each) { return each.name == "door_open"; });
  ASSERT_NE(claimed, all.end());
  EXPECT_EQ(claimed->said_by, "a door");
  EXPECT_EQ(claimed->since, 3);
  stage.inputs.claims.push_back({ClaimEvent::Kind::kWithdrawn, {9, 1}, "", "", {}});
  stage.step();
  EXPECT_TRUE(stage.belief("door_open").nil());
}

TEST(Modality, WhatAnActivityHasSaidIsNewsAlsoWhereItSaysItAgain) {
  Beliefs beliefs;
  beliefs.set("*x*", 1.0, "it", 1);
  const std::uint64_t revision = beliefs.revision();
  beliefs.set("*x*", 1.0, "it", 2);
  EXPECT_EQ(beliefs.revision(), revision);
  beliefs.take({ClaimEvent::Kind::kSaid, {9, 1}, "somebody", "*x*", 2.0}, 3);
  EXPECT_EQ(*beliefs.stored("*x*")->value.number(), 2.0);
  beliefs.set("*x*", 1.0, "it", 4);
  EXPECT_EQ(*beliefs.stored("*x*")->value.number(), 1.0);
  beliefs.take({ClaimEvent::Kind::kSaid, {9, 2}, "somebody", "*y*", 2.0, 5}, 7);
  EXPECT_EQ(beliefs.stored("*y*")->since, 2) << "it came late";
}

TEST(Modality, NothingGrowsWithoutBound) {
  Stage round(activity("(:again (SPLIT (INTEND :part ()))) (GOTO :again)") +
              "(defintention :part :goals '((SUCCEED)))");
  round.begin(2500);
  EXPECT_EQ(round.status(1).state, v1::GOAL_UNDERWAY) << round.status(1).reason;
  EXPECT_LT(round.out.nodes.size(), 10U);

  Stage deep("(defintention :it :goals '((INTEND :it ())))");
  deep.begin(3);
  EXPECT_EQ(deep.status(1).state, v1::GOAL_FAILED);
  EXPECT_NE(deep.status(1).reason.find("64 deep"), std::string::npos) << deep.status(1).reason;

  Stage wide(activity("(:again (INTEND :part () :blocking nil)) (GOTO :again)") +
             "(defintention :part :goals '((WAIT-FOR stalled :forever t)))");
  wide.begin(3000);
  EXPECT_EQ(wide.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(wide.status(1).reason, "it has begun 1024 intentions already (test.act, line 1)");

  Stage driving(activity("(:again (INTEND :Follow () :blocking nil)) (GOTO :again)"));
  driving.begin(3000);
  EXPECT_EQ(driving.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(driving.status(1).reason,
            "there are 256 behaviors already: does an activity begin others without end? "
            "(test.act, line 1)");

  // Each begins two that wait, up to the limit, and then fails with the reason.
  Stage crowd(
      "(defintention :it :goals '((INTEND :half () :blocking nil) (INTEND :half ())))"
      "(defintention :half :goals '((SPLIT (INTEND :many ()) (INTEND :many ()))"
      " (WAIT-FOR stalled :forever t)))"
      "(defintention :many :goals '((:again (INTEND :one () :blocking nil)) (GOTO :again)))"
      "(defintention :one :goals '((SPLIT (INTEND :two ()) (INTEND :two ()))"
      " (WAIT-FOR stalled :forever t)))"
      "(defintention :two :goals '((WAIT-FOR stalled :forever t)))",
      core_functions(), 300);
  crowd.ask(1, "it");
  std::size_t most = 0;
  for (int i = 0; i < 100; ++i) {
    crowd.step();
    most = std::max(most, crowd.out.nodes.size());
  }
  EXPECT_LE(most, 300U);
  EXPECT_GE(most, 200U) << "the bound was not tried";

  Stage parallel(activity("(:again (SPLIT (WAIT-FOR stalled :forever t))) (GOTO :again)"));
  parallel.begin(300);
  EXPECT_EQ(parallel.status(1).reason, "more than 64 goals in parallel (test.act, line 1)");

  Stage bomb("(defintention :it :goals '((AND (INTEND :it ()) (INTEND :it ()))))");
  bomb.begin(200);
  EXPECT_EQ(bomb.status(1).state, v1::GOAL_FAILED);

  Stage lists(
      activity("(:again (= x (list x x)) (= y (format \"~a~a~a\" y y \"abc\"))) (GOTO :again)"));
  lists.begin(200);
  EXPECT_EQ(lists.status(1).reason, "a list of more than 4096 values (test.act, line 1)");
}

}  // namespace
}  // namespace saphira::intentions
