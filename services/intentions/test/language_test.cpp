#include "saphira/intentions/language.hpp"

#include <gtest/gtest.h>

#include "language_bench.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::intentions {
namespace {

TEST(Activities, OneGoalSetForACycle) {
  Stage stage(
      activity("(EXECUTE (say \"one\")) ((EXECUTE (say \"two\")) (EXECUTE (say \"more\")))"
               "(:three (EXECUTE (say \"three\")))"));
  stage.begin();
  EXPECT_EQ(stage.messages, Names({"one"}));
  stage.step();
  EXPECT_EQ(stage.messages, Names({"one", "two", "more"}));
  EXPECT_EQ(stage.display(), "* it THREE");
  stage.step();
  EXPECT_EQ(stage.messages.back(), "three");
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
}

TEST(Activities, ParametersVariablesAndConditions) {
  Stage stage(
      activity("(= double (* 2 n)) (IF (> double 5) (GOTO :large))"
               "(SUCCEED \"small ~a\" double) (:large (SUCCEED \"large ~a\" double))",
               ":params ((n :number 1 :low 0 :high 9))"));
  stage.ask(1, "it", {number("n", 2.0)});
  stage.step(5);
  EXPECT_EQ(stage.status(1).reason, "small 4");
  stage.ask(2, "it", {number("n", 3.0)});
  stage.step(5);
  EXPECT_EQ(stage.status(2).reason, "large 6");
  stage.begin(3, "it", 5);
  EXPECT_EQ(stage.status(3).reason, "small 2");
  stage.ask(4, "it", {number("n", 10.0)});
  stage.step();
  EXPECT_EQ(stage.status(4).state, v1::GOAL_REFUSED);
  EXPECT_EQ(stage.status(4).reason, "argument \"n\": expected a number from 0 to 9, got 10");
}

TEST(Activities, BlockingUntilABehaviorIsSatisfiedWithoutAGap) {
  Stage stage(
      activity("(INTEND :go-to-pos ((goal . (point 1 2)) (speed . 300mm/s)) :name first)"
               "(INTEND :TurnTo ((goal . (point 1 2))) :name second :priority 1)"));
  stage.begin(5);
  ASSERT_EQ(stage.behaviors(), Names({"GoToPos"}));
  EXPECT_EQ(stage.out.behaviors[0].priority, 2);
  EXPECT_TRUE(stage.out.behaviors[0].blocking);
  EXPECT_EQ(find(stage.out.behaviors[0].parameters, "speed")->number, 0.3);
  EXPECT_EQ(stage.display(), "* it S2; * GoToPos B");
  stage.satisfy("first", 0.89, 5);
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
  stage.satisfy("first", 0.95, 1);
  EXPECT_EQ(stage.behaviors(), Names({"TurnTo"})) << "in the cycle in which the first ended";
  EXPECT_EQ(stage.out.behaviors[0].priority, 1);
  stage.satisfy("second", 1.0, 3);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  EXPECT_TRUE(stage.out.behaviors.empty());
}

TEST(Activities, WaitsThatLong) {
  Stage stage(activity("(WAIT 2s) (SUCCEED \"waited\")"));
  stage.begin(19);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  EXPECT_NE(stage.status(1).step.find("waits for 2s"), std::string::npos) << stage.status(1).step;
  stage.step(4);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.status(1).reason, "waited");
}

TEST(Activities, AThresholdLetsGoOnWhileTheBehaviorLasts) {
  Stage stage(
      activity("(INTEND :follow () :blocking 0.6 :name lane)"
               "(INTEND :follow-door () :name door) (UNINTEND 'lane)"));
  stage.ask(1, "it");
  stage.satisfy("lane", 0.5, 5);
  EXPECT_EQ(stage.behaviors(), Names({"Follow"}));
  stage.satisfy("lane", 0.7, 1);
  EXPECT_EQ(stage.behaviors(), Names({"Follow", "FollowDoor"}));
  stage.satisfy("lane", 1.0, 5);
  EXPECT_EQ(stage.behaviors(), Names({"Follow", "FollowDoor"}));
}

TEST(Activities, AFinishedChildIsPassedUpInTheSameCycle) {
  Stage stage(
      "(defintention :top :goals '((INTEND :middle ()) (INTEND :stop-here ())))"
      "(defintention :middle :goals '((INTEND :bottom ())))"
      "(defintention :bottom :goals '((INTEND :go-to-pos () :name go)))"
      "(defintention :stop-here :goals '((INTEND :halt () :name halt)))");
  stage.begin(1, "top");
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"})) << "begun at once, three levels deep";
  EXPECT_EQ(stage.display(), "* top S2; * middle END; * bottom END; * GoToPos B");
  stage.satisfy("go", 1.0);
  stage.step(2);  // reports may still be for the earlier intent
  EXPECT_EQ(stage.behaviors(), Names({"GoToPos"}));
  stage.step();
  EXPECT_EQ(stage.behaviors(), Names({"Halt"}));
}

TEST(Activities, AnAgentIsAskedAndItsAnswerUsed) {
  Stage stage(
      "(defintention :where :params (name)\n"
      "  :goals '((ASK q place-of ((person . name) (place . nil)) :timeout 5)\n"
      "           (SUCCEED \"~a\" (answer q 'place))))\n"
      "(defintention :anyway :params (name)\n"
      "  :goals '((ASK q place-of ((person . name)) :timeout 5 :else (GOTO :without))\n"
      "           (SUCCEED \"~a\" (answer q 'place))\n"
      "           (:without (SUCCEED \"not told: ~a\" (answer-text q)))))");
  std::map<std::uint64_t, Answer> answers;
  stage.inputs.around.answers = &answers;
  const auto asks = [&](std::uint64_t id, const std::string& functor) {
    stage.ask(id, functor, {text("name", "karen")});
    for (int i = 0; i < 5; ++i) {
      stage.step();
      if (!stage.out.questions.empty())
        return stage.out.questions.at(0);
    }
    return Request{};
  };
  const Request first = asks(1, "where");
  EXPECT_EQ(first.functor, "place-of");
  ASSERT_EQ(first.arguments.size(), 2U);
  EXPECT_EQ(first.arguments[0], text("person", "karen"));
  EXPECT_EQ(first.arguments[1].kind, ArgumentKind::unbound);
  stage.step(10);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  EXPECT_TRUE(stage.out.questions.empty()) << "it is asked once";
  answers[first.number] = {AnswerCode::done, "", {text("place", "EJ-231")}};
  stage.step(2);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.status(1).reason, "EJ-231");

  const Request refused = asks(2, "where");
  EXPECT_NE(refused.number, first.number);
  answers[refused.number] = {AnswerCode::refused, "nobody has told me", {}};
  stage.step(2);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(2).reason, "nobody has told me");

  const Request silence = asks(3, "anyway");
  EXPECT_NE(silence.number, 0U);
  stage.step(60);
  EXPECT_EQ(stage.status(3).state, v1::GOAL_SUCCEEDED);
  EXPECT_EQ(stage.status(3).reason, "not told: nobody has answered");
  asks(4, "where");
  stage.step(60);
  EXPECT_EQ(stage.status(4).reason, "waited 5 s for an answer to place-of");
}

TEST(Activities, Figure9RunsFromItsFile) {
  const std::string folder = std::getenv("SAPHIRA_SOURCE_DIR");
  Functions functions = core_functions();
  functions.add("find-path", 2, 2, "", [](const World&, Values arguments) {
    return *arguments[1].text() == "nowhere" ? Value()
                                             : Value(Value::List{arguments[0], arguments[1]});
  });
  functions.add("why-no-path", 2, 2, "",
                [](const World&, Values arguments) { return "no way to " + *arguments[1].text(); });
  Stage stage(read_file(folder + "/config/activities/figure-9.act") + R"(
    (defintention :follow-path
      :params (path)
      :goals '((EXECUTE (say "following ~a" path))
               (INTEND :follow () :name way)))
    (defintention :spoil :concurrent t :goals '((EXECUTE (setq *failed-execution* t)))))",
              functions);
  stage.ask(1, "plan_and_execute", {text("dest", "nowhere")});
  stage.step(6);
  EXPECT_TRUE(stage.messages.empty()) << "it does not know where it is";
  stage.inputs.robot.odom_in_map = Pose{};
  stage.step(8);
  EXPECT_EQ(stage.messages, Names({"Planning path to nowhere", "No passable routes"}));
  EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(1).reason, "no way to nowhere");

  stage.messages.clear();
  stage.ask(2, "plan-and-execute", {text("dest", "EJ-231")});
  stage.step(5);
  EXPECT_EQ(stage.messages, Names({"Planning path to EJ-231", "following nil, EJ-231"}));
  stage.step();
  EXPECT_EQ(stage.display(),
            "* plan-and-execute S6; o monitor-planex CLEANUP; * follow-path END; * Follow B");
  // A signalled failure: the monitor ends the following, and the plan is made anew.
  stage.begin(3, "spoil", 4);
  EXPECT_EQ(stage.messages.size(), 3U);
  EXPECT_EQ(stage.messages.back(), "Planning path to EJ-231");
  stage.step(6);
  EXPECT_EQ(stage.messages.back(), "following nil, EJ-231");
  EXPECT_TRUE(stage.belief("*failed-execution*").nil());
  stage.satisfy("way", 1.0, 8);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_SUCCEEDED);
}

// The planner and the check of zones may disagree, since the check does not know the way so far.
TEST(Activities, PlansThatAZoneForbidsAgainAndAgainFailWithTheZone) {
  const std::string folder = std::string(std::getenv("SAPHIRA_SOURCE_DIR")) + "/config/activities/";
  Functions functions = *all_functions();
  bool forbidden = true;
  functions.add("find-path", 2, 2, "",
                [](const World&, Values arguments) { return Value(Value::List{arguments[1]}); });
  functions.add("hazard-on", 1, 1, "", [&](const World&, Values) {
    return forbidden ? Value("keep-out zone 7") : Value();
  });
  functions.add("zones-on", 1, 1, "", [](const World&, Values) { return Value(); });
  functions.add("leg", 1, 1, "", [](const World&, Values) { return Value("done"); });
  Stage stage(read_file(folder + "figure-9.act") + read_file(folder + "navigation.act"), functions);
  stage.inputs.robot.odom_in_map = Pose{};
  stage.ask(1, "plan-and-execute", {text("dest", "lab")});
  stage.step(100);
  EXPECT_EQ(stage.messages, Names(4, "Planning path to lab"));
  EXPECT_EQ(stage.status(1).state, v1::GOAL_FAILED);
  EXPECT_EQ(stage.status(1).reason, "the way is not allowed: keep-out zone 7");

  // Two refusals, as for a zone that people have just told of, are no failure.
  stage.messages.clear();
  stage.ask(2, "plan-and-execute", {text("dest", "lab")});
  for (int i = 0; i < 100 && stage.messages.size() < 3; ++i)
    stage.step();
  forbidden = false;
  stage.step(20);
  EXPECT_EQ(stage.status(2).state, v1::GOAL_SUCCEEDED) << stage.status(2).reason;
  EXPECT_TRUE(stage.belief("*refusals*").nil());
}

}  // namespace
}  // namespace saphira::intentions
