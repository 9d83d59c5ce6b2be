#include <gtest/gtest.h>

#include "language_bench.hpp"

// Each goal modality of Figure 8, and the additions of PRS.

namespace saphira::intentions {
namespace {

void claim(Stage& stage, const std::string& name, bool holds) {
  stage.inputs.claims.push_back({ClaimEvent::Kind::kSaid,
                                 {9, name.size() > 1 ? std::uint64_t(name[1]) : 1U},
                                 "somebody",
                                 name,
                                 Value::truth(holds)});
  stage.step();
}

TEST(Modality, TestFailsWithAReasonUpToTheGoal) {
  Stage stage(
      "(defintention :it :goals '((INTEND :part ())))"
      "(defintention :part :goals '((TEST (> 1 2) :reason (format \"~a is too small\" 1))))");
  stage.begin(2);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(1).code, v1::CODE_ACTIVITY);
  EXPECT_EQ(stage.status(1).reason, "part: 1 is too small");
}

TEST(Modality, WhatFailsCanBeGoneAround) {
  Stage stage(
      activity("(INTEND :part () :else ((EXECUTE (say \"because ~a\" (reason))) (GOTO :other)))"
               "(FAIL \"not here\") (:other (TEST stalled :else (EXECUTE (say \"not stalled\"))))"
               "(SUCCEED \"~a\" (outcome))") +
      "(defintention :part :goals '((FAIL \"no way\")))");
  stage.begin(5);
  EXPECT_EQ(stage.messages, Names({"because no way", "not stalled"}));
  EXPECT_EQ(stage.status(1).reason, "failure");
}

TEST(Modality, WaitForAConditionAndItsLimit) {
  Stage stage(activity("(WAIT-FOR stalled :timeout 0.5s)", ":timeout 60s"));
  ASSERT_TRUE(stage.loaded.troubles.empty()) << errors(stage.loaded);
  stage.begin(3);
  EXPECT_EQ(stage.status(1).step, "waits until a wheel is stalled");
  stage.stall(true, 2);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);

  stage.inputs.robot.left_stalled = false;
  stage.ask(2, "it");
  stage.step(6);  // it begins in the first, and 5 cycles are its limit
  EXPECT_EQ(stage.status(2).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(2).code, v1::CODE_TIMEOUT);
  EXPECT_EQ(stage.status(2).reason, "waited 0.5 s for stalled");
}

TEST(Modality, StepsAreToldInWords) {
  const auto step_of = [](const std::string& goals) {
    Stage stage(activity(goals));
    stage.begin(3);
    return stage.status(1).step;
  };
  EXPECT_EQ(step_of("(WAIT-FOR nil :forever t)"), "waits");
  EXPECT_EQ(step_of("(WAIT-FOR (and stalled bumped) :timeout 9s)"),
            "waits for (and stalled bumped)");
  EXPECT_EQ(step_of("(MAINTAIN connected :by (WAIT 1s) (WAIT 9s))"), "while there is a robot");
}

TEST(Modality, TimeoutsOfBehaviorsAndActivities) {
  Stage stage(
      "(defintention :a :goals '((INTEND :GoToPos () :timeout 1s)))"
      "(defintention :b :timeout 1s :goals '((WAIT-FOR stalled)))"
      "(defintention :c :goals '((INTEND :b () :timeout 0.3s)))");
  stage.begin(1, "a", 10);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  stage.step(2);
  EXPECT_EQ(stage.status(1).reason, "GoToPos: not satisfied in 1 s");
  EXPECT_EQ(stage.status(1).code, v1::CODE_TIMEOUT);
  stage.begin(2, "b", 12);
  EXPECT_EQ(stage.status(2).reason, "not done in 1 s");
  stage.begin(3, "c", 5);
  EXPECT_EQ(stage.status(3).reason, "b: not done in 0.3 s");
}

TEST(Modality, AndJoinsSplitDoesNot) {
  Stage stage(activity("(AND (WAIT-FOR *a*) (SEQ (WAIT-FOR *b*) (EXECUTE (say \"b\"))))"
                       "(SPLIT (SEQ (WAIT-FOR *c*) (EXECUTE (say \"c\")))"
                       "       (GOTO :aside))"
                       "(WAIT-FOR *d*) (GOTO :end)"
                       "(:aside (EXECUTE (say \"aside\"))) (:end)",
                       ":timeout 60s") +
              "(defintention :put :concurrent t :params (what)"
              " :goals '((IF (equal what 'a) (EXECUTE (setq *a* t)))"
              "          (IF (equal what 'b) (EXECUTE (setq *b* t)))"
              "          (IF (equal what 'c) (EXECUTE (setq *c* t)))"
              "          (IF (equal what 'd) (EXECUTE (setq *d* t)))))");
  auto put = [&, id = std::uint64_t{10}](const char* what) mutable {
    stage.ask(id++, "put", {text("what", what)});
    stage.step(8);
  };
  stage.ask(1, "it");
  put("b");
  EXPECT_EQ(stage.messages, Names({"b"}));
  EXPECT_EQ(stage.display(), "* it S2") << "joined only when both have ended";
  put("a");
  EXPECT_EQ(stage.messages, Names({"b", "aside"}));
  EXPECT_EQ(stage.display(), "* it S4");
  put("c");
  EXPECT_EQ(stage.messages, Names({"b", "aside", "c"}));
  put("d");
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
}

TEST(Modality, AReasonThatCannotBeComputedFails) {
  Stage stage(activity("(INTEND :part () :else (EXECUTE (say \"~a\" (reason))))") +
              "(defintention :part :goals '((= x nil) (SUCCEED \"~a\" (+ 1 x))))");
  stage.begin(5);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.messages.size(), 1U);
}

// The intentions of a SPLIT end, and are interrupted, with the enclosing goal.
TEST(Modality, ASplitStandsInTheGoalsAroundIt) {
  const std::string aside = "(SPLIT (SEQ (INTEND :Watch () :blocking nil) (INTEND :Follow ())))";
  const std::string rest = "(WAIT-FOR *x* :forever t)";
  Stage preserve(activity("(PRESERVE (not stalled) " + aside + rest +
                          " :else (EXECUTE (say \"broken\"))) (WAIT-FOR nil :forever t)"));
  preserve.begin(2);
  EXPECT_EQ(preserve.behaviors(), Names({"Watch", "Follow"}));
  preserve.stall(true);
  EXPECT_EQ(preserve.messages, Names({"broken"}));
  EXPECT_TRUE(preserve.behaviors().empty());

  // Also when the goal is over, and its intentions continue.
  Stage over(activity("(PRESERVE (not stalled) (SPLIT (INTEND :Watch () :blocking nil))" + rest +
                      " :else (EXECUTE (say \"broken\"))) (WAIT-FOR nil :forever t)"));
  over.begin(2);
  EXPECT_EQ(over.behaviors(), Names({"Watch"}));
  over.stall(true);
  EXPECT_TRUE(over.behaviors().empty());

  Stage all(activity("(AND (SEQ " + aside + ") (SEQ " + rest +
                     " (FAIL \"no\")) :else (= y 1)) (WAIT-FOR nil :forever t)"));
  all.begin(2);
  EXPECT_EQ(all.behaviors(), Names({"Watch", "Follow"}));
  claim(all, "*x*", true);
  EXPECT_TRUE(all.behaviors().empty());
  EXPECT_EQ(all.status(1).state, v1::GOAL_UNDERWAY);

  Stage maintain(
      activity("(MAINTAIN (not stalled) :by (SEQ (SPLIT (INTEND :Back ()))"
               " (WAIT-FOR (not stalled) :forever t)) " +
               aside + rest + ") (WAIT-FOR nil :forever t)"));
  maintain.begin(2);
  for (int i = 0; i < 2; ++i) {
    maintain.stall(true, 3);
    EXPECT_EQ(maintain.behaviors(), Names({"Back"}));
    maintain.stall(false, 2);
    EXPECT_EQ(maintain.behaviors(), Names({"Watch", "Follow"}));
  }
}

TEST(Modality, ASplitGoesOnBehindTheGoalThatItStoodIn) {
  Stage stage(
      activity("(SPLIT (INTEND :Watch ()))"
               "(PRESERVE (not stalled) (AND (SPLIT (INTEND :Follow ())) (= y 1))"
               " (WAIT-FOR *x* :forever t))"
               "(PRESERVE (not stalled) (WAIT-FOR nil :forever t) :else (= y 2))"
               "(WAIT-FOR nil :forever t)"));
  stage.begin(3);
  claim(stage, "*x*", true);
  stage.step(2);
  EXPECT_EQ(stage.behaviors(), Names({"Watch", "Follow"}));
  stage.stall(true, 2);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  EXPECT_EQ(stage.behaviors(), Names({"Watch", "Follow"})) << "they do not stand in what failed";
}

TEST(Modality, AGotoLeavesWhatItStandsIn) {
  for (const std::string goal :
       {"(AND (SEQ (WAIT-FOR *x* :forever t) (GOTO :end)) (INTEND :Follow ()))",
        "(PRESERVE t (AND (SEQ (WAIT-FOR *x* :forever t) (GOTO :end)) (INTEND :Follow ())))",
        "(MAINTAIN (not *x*) :by (GOTO :end) (INTEND :Follow ()))"}) {
    SCOPED_TRACE(goal);
    Stage stage(activity(goal + "(EXECUTE (say \"joined\"))"
                                "(:end (EXECUTE (say \"end\"))) (WAIT-FOR stalled :forever t)"));
    stage.begin(2);
    EXPECT_EQ(stage.behaviors(), Names({"Follow"}));
    claim(stage, "*x*", true);
    EXPECT_TRUE(stage.behaviors().empty());
    stage.step(4);
    EXPECT_EQ(stage.messages, Names({"end"})) << "once, and nothing that stands before it";
    EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
    EXPECT_EQ(stage.display(), "* it END");
  }
}

TEST(Modality, AndFailsWithOneOfItsGoalsAndEndsTheOthers) {
  Stage stage(activity("(AND (INTEND :Follow ()) (INTEND :part ())"
                       " :else (EXECUTE (say \"~a\" (reason)))) (WAIT-FOR stalled)",
                       ":timeout 60s") +
              "(defintention :part :goals '((WAIT-FOR *x*) (FAIL \"enough\")))");
  stage.begin(3);
  EXPECT_EQ(stage.behaviors(), Names({"Follow"}));
  stage.inputs.claims.push_back(
      {ClaimEvent::Kind::kSaid, {9, 1}, "somebody", "*x*", Value::truth(true)});
  stage.step(2);
  EXPECT_EQ(stage.messages, Names({"part: enough"}));
  EXPECT_TRUE(stage.behaviors().empty());
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
}

TEST(Modality, WhatIsNotWaitedForEndsWithItsParent) {
  Stage stage(activity("(INTEND :guard () :blocking nil) (INTEND :GoToPos () :name go)") +
              "(defintention :guard :goals '((INTEND :AvoidCollision () :blocking nil :priority 0)"
              "                              (WAIT-FOR stalled :forever t)))");
  stage.begin(3);
  EXPECT_EQ(stage.behaviors(), Names({"AvoidCollision", "GoToPos"}));
  EXPECT_EQ(stage.display(), "* it END; o guard END; o AvoidCollision B; * GoToPos B");
  stage.satisfy("go", 1.0, 3);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  EXPECT_TRUE(stage.out.nodes.empty());
}

TEST(Modality, UnintendEndsTheNearestOfThatNameAndWhoWaitedGoesOn) {
  Stage stage(activity("(INTEND :watch () :blocking nil)"
                       "(INTEND :follow () :name way)"
                       "(SUCCEED \"~a\" (outcome))") +
              "(defintention :follow :goals '((INTEND :GoToPos () :name way)))"
              "(defintention :watch :goals '((WAIT-FOR stalled :forever t) (UNINTEND 'way)))");
  stage.begin(4);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
  stage.inputs.robot.right_stalled = true;
  stage.step();
  EXPECT_TRUE(stage.behaviors().empty());
  stage.step();
  EXPECT_EQ(stage.status(1).reason, "removed");
}

TEST(Modality, UnintendMeansTheNewestAsStateDoes) {
  Stage stage(activity(
      "((INTEND :Follow () :blocking nil :name way) (INTEND :Go () :blocking nil :name way)"
      " (UNINTEND 'way)) (WAIT-FOR nil :forever t)"));
  stage.begin(2);
  EXPECT_EQ(stage.behaviors(), Names({"Follow"}));
}

TEST(Modality, AnActivityMayEndWhatItStandsIn) {
  Stage stage(activity("(INTEND :outer () :name outer) (SUCCEED \"~a\" (outcome))") +
              "(defintention :outer :goals '((INTEND :inner ()) (FAIL \"not this\")))"
              "(defintention :inner :goals '((UNINTEND 'outer) (WAIT-FOR stalled :forever t)))");
  stage.begin(3);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED) << stage.status(1).reason;
  EXPECT_EQ(stage.status(1).reason, "removed");
}

TEST(Modality, PreserveEndsItsGoalsWhenTheConditionBreaks) {
  Stage stage(
      activity("(PRESERVE (not stalled) (INTEND :GoToPos () :name go)"
               " :else (EXECUTE (say \"~a\" (reason)))) (EXECUTE (say \"on\"))"));
  stage.begin(3);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
  stage.stall(true);
  EXPECT_TRUE(stage.behaviors().empty());
  EXPECT_EQ(stage.messages, Names({"(not stalled) does not hold any more", "on"}));
}

TEST(Modality, MaintainRestoresAndGoesOn) {
  Stage stage(activity("(MAINTAIN (not stalled) :by (INTEND :back ())"
                       " (INTEND :walk ())) (EXECUTE (say \"there\"))") +
              "(defintention :walk :goals '((INTEND :GoToPos () :name go)"
              "                             (EXECUTE (say \"walked\"))))"
              "(defintention :back :goals '((INTEND :ConstantVelocity ((speed . -100mm/s)))))");
  stage.begin(3);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
  stage.stall(true);
  EXPECT_EQ(stage.behaviors(), Names({"ConstantVelocity"})) << "instead of what is maintained";
  stage.step(5);
  stage.inputs.robot.left_stalled = false;
  stage.satisfy("ConstantVelocity", 1.0, 2);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"})) << "it went on where it was";
  stage.satisfy("go", 1.0, 8);
  EXPECT_EQ(stage.messages, Names({"walked", "there"}));
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
}

TEST(Modality, MaintainWithinMaintainGoesOnWhenBothHold) {
  Stage stage(
      activity("(MAINTAIN *a* :by (INTEND :ByA () :blocking t)"
               " (MAINTAIN *b* :by (INTEND :ByB ())"
               "  (AND (SEQ (INTEND :Watch () :blocking nil) (= y 1)) (INTEND :GoToPos ()))))"));
  claim(stage, "*a*", true);
  claim(stage, "*b*", true);
  stage.begin(2);
  EXPECT_EQ(stage.behaviors(), Names({"Watch", "GoToPos"}));
  claim(stage, "*b*", false);
  EXPECT_EQ(stage.behaviors(), Names({"ByB"})) << "also what a branch that is over has begun";
  claim(stage, "*a*", false);
  EXPECT_EQ(stage.behaviors(), Names({"ByA"})) << "what restores the inner one waits too";
  claim(stage, "*a*", true);
  stage.satisfy("ByA", 1.0, 4);
  EXPECT_EQ(stage.behaviors(), Names({"ByB"})) << "the inner condition does not hold yet";
  claim(stage, "*b*", true);
  stage.satisfy("ByB", 1.0, 4);
  EXPECT_EQ(stage.behaviors(), Names({"Watch", "GoToPos"}));
}

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

TEST(Modality, MaintainFailsWhereItCannotRestore) {
  Stage stage(
      activity("(MAINTAIN (not stalled) :by (EXECUTE (say \"trying\"))"
               " (INTEND :GoToPos ()))"));
  stage.begin(3);
  stage.stall(true);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(1).reason, "(not stalled) could not be restored");
  EXPECT_EQ(stage.messages, Names({"trying"}));
}

TEST(Modality, AnInterruptedGoalGoesOnWhereItWas) {
  Stage stage(activity("(EXECUTE (say \"begun\")) (INTEND :part ()) (EXECUTE (say \"over\"))",
                       ":timeout 3s") +
              "(defintention :part :goals '((EXECUTE (say \"part\"))"
              "                             (INTEND :GoToPos () :name go :timeout 2s)))"
              "(defintention :other :goals '((INTEND :TurnTo () :name turn)))");
  stage.begin(5);
  stage.ask(2, "other", {}, 1);
  stage.step(50);
  EXPECT_EQ(stage.behaviors(), Names({"TurnTo"}));
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUSPENDED);
  stage.satisfy("turn", 1.0, 2);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"})) << "no timeout has run meanwhile";
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  stage.satisfy("go", 1.0, 6);
  EXPECT_EQ(stage.messages, Names({"begun", "part", "over"})) << "nothing is done twice";
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
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

TEST(Modality, BehaviorControlIsBackWhenItsGoalIsOver) {
  Stage stage(activity("(EXECUTE (setq *behavior-control* nil)) (WAIT-FOR stalled :forever t)"));
  stage.begin();
  EXPECT_FALSE(stage.out.behavior_control);
  stage.step(3);
  EXPECT_FALSE(stage.out.behavior_control);
  stage.dispose(1);
  stage.step();
  EXPECT_TRUE(stage.out.behavior_control);
}

TEST(Modality, BehaviorControlIsBackWhenNobodyWantsItOff) {
  Stage stage(
      "(defintention :it :concurrent t"
      " :goals '((EXECUTE (setq *behavior-control* nil)) (WAIT-FOR *x* :forever t)"
      "          (EXECUTE (setq *behavior-control* t)) (WAIT-FOR nil :forever t)))");
  stage.begin();
  stage.begin(2, "it");
  stage.dispose(2);
  stage.step();
  EXPECT_FALSE(stage.out.behavior_control);
  stage.begin(3, "it");
  claim(stage, "*x*", true);
  stage.step(2);
  EXPECT_TRUE(stage.out.behavior_control);
  EXPECT_TRUE(stage.belief("*behavior-control*").truthy());
}

TEST(Modality, ABeliefWhileAnIntentionLastsEndsWithIt) {
  Stage stage(
      activity("(INTEND :part () :timeout 1s :else (= late t)) (WAIT-FOR nil :forever t)") +
      "(defintention :part :goals '((EXECUTE (believe-while 'asking \"x\"))"
      "                             (EXECUTE (believe 'kept \"y\"))"
      "                             (WAIT-FOR stalled :forever t)))"
      "(defintention :other :concurrent t :goals"
      " '((EXECUTE (believe-while 'asking \"mine\")) (EXECUTE (believe 'asking \"all\"))))");
  stage.begin(3);
  EXPECT_EQ(stage.belief("asking"), Value("x"));
  // Its own end.
  stage.step(20);
  EXPECT_TRUE(stage.belief("asking").nil());
  EXPECT_EQ(stage.belief("kept"), Value("y"));
  // The end of its goal.
  stage.dispose(1);
  stage.begin(2, "it", 3);
  EXPECT_EQ(stage.belief("asking"), Value("x"));
  stage.dispose(2);
  stage.step();
  EXPECT_TRUE(stage.belief("asking").nil());
  // As set afterwards for good.
  stage.begin(3, "other", 5);
  EXPECT_EQ(stage.belief("asking"), Value("all"));
}

TEST(Modality, ABehaviorThatCannotBeMadeFailsAlsoWhoDoesNotWaitForIt) {
  Stage stage(activity("(INTEND :part () :else (EXECUTE (say \"~a\" (reason))))") +
              "(defintention :part :goals '((INTEND :Avoid () :blocking nil)"
              "                             (INTEND :near () :blocking 0.5)"
              "                             (WAIT-FOR nil :forever t)))"
              "(defintention :near :level 1 :goals '((INTEND :GoToPos ())))");
  stage.begin(4);
  EXPECT_EQ(stage.behaviors(), Names({"Avoid", "GoToPos"}));
  stage.inputs.troubles = {{stage.out.behaviors.at(0).name, "it is broken"}};
  stage.step();
  EXPECT_EQ(stage.messages, Names({"Avoid: it is broken"}));
  EXPECT_TRUE(stage.behaviors().empty());
}

TEST(Modality, ABehaviorThatCannotBeMadeFailsItsIntention) {
  Stage stage(activity("(INTEND :Fly () :name fly)"));
  stage.begin(2);
  stage.inputs.troubles = {{stage.out.behaviors.at(0).name, "there is no behavior \"Fly\""}};
  stage.step();
  EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(1).reason, "Fly: there is no behavior \"Fly\"");
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

TEST(Modality, ConcurrentGoalsAreUnderwayBesideTheOneThatDrives) {
  Stage stage(
      "(defintention :watch :concurrent t :goals '((WAIT-FOR stalled :forever t)))"
      "(defintention :go :goals '((INTEND :GoToPos () :name go)))");
  stage.ask(1, "watch");
  stage.ask(2, "go");
  stage.ask(3, "watch", {}, 9);
  stage.step();
  for (const std::uint64_t id : {1U, 2U, 3U})
    EXPECT_EQ(stage.status(id).state, v1::GOAL_UNDERWAY) << id;
  stage.stall(true);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_UNDERWAY);
}

TEST(Modality, AConcurrentActivityDoesNotDrive) {
  Stage stage(
      "(defintention :behavior :concurrent t :goals '((INTEND :Follow () :blocking nil)))"
      "(defintention :within :concurrent t :goals '((INTEND :drives ())))"
      "(defintention :drives :goals '((INTEND :Follow ())))"
      "(defintention :functor :concurrent t :goals '((INTEND :drive ((speed . 0.1)))))");
  stage.ask(1, "behavior");
  stage.ask(2, "within");
  stage.ask(3, "functor");
  stage.begin(4, "drives", 3);
  EXPECT_EQ(stage.status(1).reason, "a concurrent activity does not drive");
  EXPECT_EQ(stage.status(2).reason, "drives: a concurrent activity does not drive");
  EXPECT_EQ(stage.status(3).reason, "drive: a concurrent activity does not drive");
  EXPECT_EQ(stage.status(4).state, v1::GOAL_UNDERWAY);
  EXPECT_EQ(stage.behaviors(), Names({"Follow"}));
}

TEST(Modality, TheEndOfAConcurrentGoalIsNoStepForTheOneThatDrives) {
  Stage stage(activity("(:again (EXECUTE (say \"tick\")) (GOTO :again))") +
              "(defintention :watch :concurrent t :goals '((WAIT-FOR stalled :forever t)))");
  stage.ask(1, "it");
  stage.begin(2, "watch", 3);
  stage.stall(true);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.messages.size(), 4U);
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

TEST(Modality, HowMuchIsDoneIsItsOwnOrTheLevel) {
  Stage stage(activity("(= x 0.25) (WAIT-FOR stalled :forever t)", ":level x") +
              "(defintention :with :level 0.25 :progress (/ nothing 2) :concurrent t"
              " :goals '((= nothing 1.5) (WAIT-FOR stalled :forever t)))");
  stage.ask(1, "it");
  stage.begin(2, "with", 12);
  EXPECT_EQ(stage.status(1).progress, 0.25);
  EXPECT_EQ(stage.status(2).level, 0.25);
  EXPECT_EQ(stage.status(2).progress, 0.75);
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
  EXPECT_EQ(wide.status(1).reason, "it has begun 1024 intentions already");

  Stage driving(activity("(:again (INTEND :Follow () :blocking nil)) (GOTO :again)"));
  driving.begin(3000);
  EXPECT_EQ(driving.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(driving.status(1).reason,
            "there are 256 behaviors already: does an activity begin others without end?");

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
  EXPECT_EQ(parallel.status(1).reason, "more than 64 goals in parallel");

  Stage bomb("(defintention :it :goals '((AND (INTEND :it ()) (INTEND :it ()))))");
  bomb.begin(200);
  EXPECT_EQ(bomb.status(1).state, v1::GOAL_FAILED);

  Stage lists(
      activity("(:again (= x (list x x)) (= y (format \"~a~a~a\" y y \"abc\"))) (GOTO :again)"));
  lists.begin(200);
  EXPECT_EQ(lists.status(1).reason, "a list of more than 4096 values");
}

}  // namespace
}  // namespace saphira::intentions
