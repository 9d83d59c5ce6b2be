#include <gtest/gtest.h>

#include "language_bench.hpp"

// Goal modalities where lines of activities.txt do not do.

namespace saphira::intentions {
namespace {

TEST(Modality, WhatRunsGoesOnWithTheSchemaThatItBeganWith) {
  Stage stage(activity("(WAIT-FOR stalled :forever t) (INTEND :part ())") +
              "(defintention :part :goals '((SUCCEED)))");
  stage.begin(2);
  const Loaded changed =
      load_activities({{"test.act", activity("(FAIL \"new\")") +
                                        "(defintention :part :goals '((FAIL \"new part\")))"}},
                      *stage.options.functions, stage.executor->registry());
  ASSERT_TRUE(changed.ok()) << errors(changed);
  for (const Schema& schema : changed.schemas)
    stage.executor->registry().add(schema);
  stage.step(2);
  EXPECT_EQ(stage.status(1).state, v1::GOAL_UNDERWAY);
  stage.stall(true, 3);
  EXPECT_EQ(stage.status(1).reason, "part: new part") << "what it begins anew is the new one";
  stage.begin(2, "it", 3);
  EXPECT_EQ(stage.status(2).reason, "new");
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

// Each begins two that wait, up to the limit, and then fails with the reason.
TEST(Modality, ACrowdHasABound) {
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
}

}  // namespace
}  // namespace saphira::intentions
