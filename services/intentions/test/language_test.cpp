#include "saphira/intentions/language.hpp"

#include <gtest/gtest.h>

#include "language_bench.hpp"
#include "lines.hpp"
#include "saphira/base/text.hpp"
#include "saphira/intentions/navigation.hpp"

namespace saphira::intentions {
namespace {

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

// The compiler's messages.

Registry with_behaviors() {
  Registry registry = built_in();
  BehaviorSignature follow{"FollowCorridor", {}};
  Parameter corridor;
  corridor.name = "corridor";
  corridor.required = true;
  Parameter goal;
  goal.name = "goal";
  follow.parameters = {corridor, goal};
  registry.know_behaviors({follow});
  return registry;
}

Loaded load(const std::string& text) {
  return load_activities({{"a.act", text}}, core_functions(), with_behaviors());
}

/// "3:7 message" of each trouble.
std::vector<std::string> troubles(const std::string& text) {
  std::vector<std::string> all;
  for (const Diagnostic& trouble : load(text).troubles)
    all.push_back(std::to_string(trouble.line) + ":" + std::to_string(trouble.column) + " " +
                  (trouble.error ? "" : "warning: ") + trouble.message);
  return all;
}

using List = std::vector<std::string>;

std::string goals(const std::string& goals) {
  return "(defintention :it :params (dest) :goals '(\n" + goals + "))";
}

/// A source, and its troubles behind it.
class Mistakes {
 public:
  void take(const std::string& line) {
    const bool of_goals = line.starts_with("goals ");
    if (of_goals || line.starts_with("file ")) {
      finish();
      std::string text = line.substr(line.find(' ') + 1);
      for (std::size_t at = 0; (at = text.find("\\n", at)) != std::string::npos;)
        text.replace(at, 2, "\n");
      left_ = troubles(of_goals ? goals(text) : text);
    } else if (left_.empty()) {
      ADD_FAILURE() << "no such trouble: " << line;
    } else {
      EXPECT_EQ(left_.front(), line);
      left_.erase(left_.begin());
    }
  }
  void finish() const { EXPECT_EQ(left_, List()) << "before this"; }

 private:
  List left_;
};

TEST(ActivityErrors, AreAsWritten) {
  EXPECT_EQ(test::play<Mistakes>("services/intentions/test/mistakes.txt"), 10);
}

TEST(ActivityErrors, ShowThePlaceWithACaret) {
  const Loaded loaded = load("(defintention :it\n  :goals '((GOTO :nowhere)))\n");
  ASSERT_EQ(loaded.troubles.size(), 1U);
  EXPECT_TRUE(loaded.schemas.empty());
  EXPECT_EQ(loaded.troubles[0].text(),
            "a.act:2:18: no goal-set has the label :nowhere\n"
            "      :goals '((GOTO :nowhere)))\n"
            "                     ^");
}

TEST(ActivityErrors, BehaviorsThatAreNotKnownYetAreDoubtful) {
  const Registry registry = built_in();
  const Loaded loaded = load_activities(
      {{"a.act", goals("(INTEND :follow ())\n(INTEND :follow ())")}}, core_functions(), registry);
  EXPECT_TRUE(loaded.ok());
  ASSERT_EQ(loaded.troubles.size(), 1U) << "told once";
  Registry all = registry;
  all.add(loaded.schemas[0]);
  all.know_behaviors({});
  const auto later = check_references(all);
  ASSERT_EQ(later.size(), 2U);
  EXPECT_EQ(later[0].message, "unknown schema \"follow\": neither an activity nor a behavior");
}

TEST(ActivityErrors, AFileMayNameWhatAnotherOneHas) {
  const Loaded loaded = load_activities({{"a.act", "(defintention :a :goals '((INTEND :b ())))"},
                                         {"b.act", "(defintention :b :goals '((INTEND :a ())))"},
                                         {"c.act", "(defintention :c :goals '((INTEND :d ())))"}},
                                        core_functions(), with_behaviors());
  ASSERT_EQ(loaded.troubles.size(), 1U);
  EXPECT_EQ(loaded.troubles[0].file, "c.act");
  EXPECT_EQ(loaded.schemas.size(), 2U) << "only the broken one is left out";
}

TEST(ActivityValues, ReadWhatTheyWrite) {
  for (const char* const text :
       {"nil", "t", "2.5", "-1e-07", "follow-it", "\"a \\\"b\\\" c\"", "\"1\"", "(a 1 (b nil))",
        "(point 1 2.5 -0.5 :map)", "(region 3 12)", "(thing 8 0)", "\"\"", "\"T\""})
    EXPECT_EQ(to_text(parse_value(text)), text);
  EXPECT_EQ(parse_value("()"), Value());
  EXPECT_EQ(parse_value("90deg").number() != nullptr, true);
  EXPECT_THROW(parse_value("(a"), FileError);
  EXPECT_THROW(parse_value(""), FileError);
  EXPECT_THROW(parse_value("a b"), FileError);
  EXPECT_THROW(parse_value("\"a\vb\""), FileError);
  EXPECT_EQ(to_text(parse_value("\"a\tb\"")), "\"a b\"");
}

}  // namespace
}  // namespace saphira::intentions
