#include "saphira/cli/displays.hpp"

#include <gtest/gtest.h>

#include "saphira/geometry/pose.hpp"

namespace saphira::cli {
namespace {

v1::IntentionNode node(std::uint32_t id, std::uint32_t parent, bool blocking,
                       const std::string& schema, const std::string& name, const std::string& label,
                       const std::string& step = "") {
  return {.id = id,
          .parent = parent,
          .name = name,
          .schema = schema,
          .state = v1::INTENTION_RUNNING,
          .blocking = blocking,
          .label = label,
          .step = step};
}

v1::IntendedBehavior behavior(std::uint32_t intention, bool blocking, const std::string& schema,
                              const std::string& name) {
  return {.name = name, .schema = schema, .intention = intention, .blocking = blocking};
}

// The snapshot in the paper, without the next state: that may be the one for trouble.
TEST(IntentionsDisplay, IsFigure10) {
  v1::Intentions all{.behavior_control = true,
                     .behaviors = {behavior(1, true, "Avoid-Collision", "Collide"),
                                   behavior(3678, false, "Follow", "Follow-To-Target"),
                                   behavior(3678, false, "Orient", "Orient-To-Target"),
                                   behavior(3678, true, "Keep-Off-With-Target", "Keep-Off")},
                     .nodes = {node(1, 0, true, "Avoid", "Avoid1", "END"),
                               node(3674, 0, true, "Deliver-Object", "", "S171"),
                               node(3675, 3674, true, "Plan-And-Execute", "", "S146"),
                               node(3676, 3675, false, "Monitor-Planex", "", "CLEANUP"),
                               node(3679, 3675, true, "Follow-Path", "Follow-It", "S138"),
                               node(3677, 3679, true, "Corridor-To-Junction", "", "END"),
                               node(3678, 3677, true, "Follow-To-Target", "", "END")}};
  EXPECT_EQ(intentions_display(all, nullptr), R"(* Avoid (Avoid1)
  * Avoid-Collision (Collide) B
* Deliver-Object (I3674)
  * Plan-And-Execute (I3675)
    o Monitor-Planex (I3676)
    * Follow-Path (Follow-It)
      * Corridor-To-Junction (I3677)
        * Follow-To-Target (I3678)
          o Follow (Follow-To-Target) B
          o Orient (Orient-To-Target) B
          * Keep-Off-With-Target (Keep-Off) B
)");
}

TEST(Displays, TheInstanceIsInWords) {
  EXPECT_EQ(instance_words("rest#32"), "rest, instance 32");
  EXPECT_EQ(without_instance("rest#32"), "rest");
  for (const char* const name : {"rest", "#32", "rest#", "rest#x", "re#st"}) {
    EXPECT_EQ(instance_words(name), name);
    EXPECT_EQ(without_instance(name), name);
  }
  v1::Intentions all{.behavior_control = true,
                     .behaviors = {behavior(1, true, "Stop", "rest#32"),
                                   behavior(1, false, "GoToPos", "GoToPos#7")},
                     .nodes = {node(1, 0, true, "go_to", "go_to1", "S1")}};
  EXPECT_EQ(intentions_display(all, nullptr), R"(* go_to (go_to1)
  * Stop (rest, instance 32) B
  o GoToPos (instance 7) B
)");
  v1::BehaviorState state{.name = "rest#32", .schema = "Stop"};
  EXPECT_TRUE(behavior_display(state, nullptr, nullptr).starts_with("rest, instance 32 (Stop)\n"));
  v1::ProcessSet set{.service = "intentions"};
  v1::Process process{.name = "rest#32"};
  set.processes = {process};
  EXPECT_NE(processes_table({set}).find("rest, instance 32"), std::string::npos);
}

TEST(IntentionsDisplay, SaysBehindItWhatIsBeingDone) {
  v1::Intentions all{.behavior_control = false,
                     .nodes = {node(1, 0, true, "go_to", "go_to1", "S1", "driving to (3, 1)"),
                               node(2, 1, false, "watch", "w", "MONITOR", "waits for *failed*")}};
  all.nodes[1].state = v1::INTENTION_SUSPENDED;
  all.behaviors = {behavior(1, true, "GoToPos", "GoToPos")};
  v1::BehaviorSet behaviors;
  v1::BehaviorState state{
      .name = "GoToPos", .turn_activity = 0.5, .speed_activity = 1.0, .goal = 0.25};
  behaviors.behaviors = {state};
  EXPECT_EQ(intentions_display(all, &behaviors), R"(* go_to (go_to1)          driving to (3, 1)
  o watch (w)             suspended; waits for *failed*
  * GoToPos (GoToPos) B   activity 1.00, goal 0.25
behavior control is off
)");
  EXPECT_EQ(intentions_display({}, nullptr), "nothing is intended\n");
}

// The intentions service has its behaviors in the tree, as leaves.
TEST(IntentionsDisplay, HasABehaviorThatIsANodeOnce) {
  v1::Intentions all{
      .behavior_control = true,
      .nodes = {node(1, 0, true, "go_to", "go_to1", "S1"),
                node(2, 1, true, "GoToPos", "GoToPos", ""), node(3, 1, false, "Stop", "end", "B")}};
  all.nodes[2].state = v1::INTENTION_SUSPENDED;
  all.behaviors = {behavior(2, true, "GoToPos", "GoToPos")};
  EXPECT_EQ(intentions_display(all, nullptr), R"(* go_to (go_to1)
  * GoToPos (GoToPos) B
  o Stop (end) B          suspended
)");
}

TEST(IntentionsDisplay, ComesToAnEndWithWhatIsNoTree) {
  v1::Intentions all{.behavior_control = true,
                     .nodes = {node(1, 2, true, "a", "a", ""), node(2, 1, true, "b", "b", ""),
                               node(0, 0, true, "c", "c", "")}};
  EXPECT_NE(intentions_display(all, nullptr), "");
}

v1::BehaviorState keep_off() {
  v1::BehaviorState state{.name = "Keep Off",
                          .schema = "Keep Off",
                          .priority = 1,
                          .running = true,
                          .turn_activity = 1.0,
                          .speed_activity = 0.5,
                          .turn_weight = 0.5,
                          .speed_weight = 0.5,
                          .goal = 0.0,
                          .progress = 1.0,
                          .recommends_turn = true,
                          .turn = radians(-15.0),
                          .recommends_speed = true,
                          .speed = 0.2};
  v1::RuleState rule{.name = "Obstacle-Right",
                     .strength = 0.0,
                     .action = v1::CONTROL_TURN_LEFT,
                     .value = radians(5.0)};
  state.rules.push_back(rule);
  rule.name = "Caution";
  rule.strength = 0.5;
  rule.action = v1::CONTROL_DECELERATE;
  rule.value = 0.1;
  state.rules.push_back(rule);
  state.variables.push_back({.name = "front", .value = 0.5});
  return state;
}

TEST(BehaviorsDisplay, HasActivityAsABarAndRecommendationsToTheSides) {
  v1::BehaviorSet all{.control = true};
  v1::BehaviorState stop{.name = "end", .schema = "Stop", .priority = 4};
  all.behaviors = {keep_off(), stop};
  all.turning = true;
  all.turn = radians(-15.0);
  all.moving = true;
  all.speed = 0.4;
  EXPECT_EQ(behaviors_display(all),
            R"(              pri    turn              degrees      speed             m/s
* Keep Off    1    [========|>>>>====] 15 right   [    ====|>>>>    ] 0.20
o Stop (end)  4    [        |        ]            [        |        ]
= Summation        [        |>>>>    ] 15 right   [        |>>>>>>>>] 0.40
)");
  all.control = false;
  all.turning = false;
  all.moving = false;
  all.trouble = "Fly: unknown schema";
  EXPECT_TRUE(behaviors_display(all).ends_with(
      "  Summation        [        |        ] -          [        |        ] -\n"
      "behavior control is off: the summation does not drive\n"
      "cannot be had: Fly: unknown schema\n"))
      << behaviors_display(all);
}

TEST(BehaviorDisplay, AnUnknownNameGetsAGuessAndTheList) {
  const std::vector<std::string> names{"go-to-pos1", "Stop", "GoToPos", "Stop"};
  for (const char* const name : {"gotopos", "GoToPso", "GOTOPOS"})
    EXPECT_EQ(unknown_behavior(name, names),
              "no behavior \"" + std::string(name) +
                  "\": did you mean GoToPos? There are GoToPos, Stop, go-to-pos1");
  EXPECT_EQ(unknown_behavior("Fly", names),
            "no behavior \"Fly\". There are GoToPos, Stop, go-to-pos1");
  EXPECT_EQ(unknown_behavior("Fly", {}), "no behavior \"Fly\". There are none now");
}

TEST(BehaviorDisplay, IsFigure26) {
  v1::IntendedBehavior intended;
  v1::Argument sensitivity;
  sensitivity.name = "sensitivity";
  sensitivity.kind = v1::ARGUMENT_NUMBER;
  sensitivity.number = 2.0;
  intended.parameters = {sensitivity};
  v1::BehaviorSchema schema{.summary = "steers off what is ahead"};
  v1::BehaviorParameter distance;
  distance.name = "distance";
  distance.kind = v1::ARGUMENT_NUMBER;
  distance.usual = 0.75;
  schema.parameters = {distance};
  v1::RuleText text{.name = "Caution", .antecedent = "front", .action = "Slow Down"};
  schema.rules = {text};
  EXPECT_EQ(behavior_display(keep_off(), &intended, &schema), R"(Keep Off: steers off what is ahead

Params                         Running   1
  sensitivity = 2              Priority  1
  distance = 0.75 (as usual)   Act Turn  1.00   weight 0.50
                               Act Vel   0.50   weight 0.50
                               Goal      0.00
                               Progress  1.00

Rules
  Obstacle-Right  0.00 <   5.0 deg
  Caution         0.50 -  0.10 m/s   if front then Slow Down

Fuzzy variables
  front  0.50
)");
  EXPECT_NE(behavior_display(keep_off(), nullptr, nullptr), "");
}

TEST(SchemaDisplay, SaysWhatABehaviorThatIsNotIntendedTakesAndDoes) {
  v1::BehaviorSchema schema{
      .name = "KeepOff", .summary = "steers off what is ahead", .source = "keep-off.beh"};
  v1::BehaviorParameter parameter{
      .name = "distance", .meaning = "[m] at which it begins", .usual = 0.75};
  schema.parameters.push_back(parameter);
  parameter.name = "goal";
  parameter.required = true;
  parameter.meaning = "";
  schema.parameters.push_back(parameter);
  schema.rules.push_back({.name = "caution", .antecedent = "front", .action = "Slow Down"});
  EXPECT_EQ(schema_display(schema), R"(KeepOff: steers off what is ahead
It is loaded from keep-off.beh, and no goal or activity intends it now.

Params
  distance  usually 0.75  [m] at which it begins
  goal  required

Rules
  caution   if front then Slow Down
)");
}

TEST(BeliefsTable, SaysWhoSaidSoAndHowLongAgo) {
  v1::BeliefSet all{.stamp = {.cycle = 100}};
  v1::Belief belief{
      .name = "*failed-execution*", .value = "nil", .said_by = "plan-and-execute1", .since = 75};
  all.beliefs.push_back(belief);
  belief.name = "in-corridor";
  belief.value = "t";
  belief.said_by = "perception";
  belief.since = 100;
  all.beliefs.push_back(belief);
  EXPECT_EQ(beliefs_table(all), R"(NAME                VALUE  SINCE  SAID BY
*failed-execution*  nil    2.5 s  plan-and-execute1
in-corridor         t      0.0 s  perception
)");
  EXPECT_EQ(beliefs_table(all, "corridor"), R"(NAME         VALUE  SINCE  SAID BY
in-corridor  t      0.0 s  perception
)");
  EXPECT_EQ(beliefs_table(all, "door"), "");
}

TEST(ProcessesTable, IsFigure27ForAllServices) {
  v1::ProcessSet interpretation;
  interpretation.service = "interpretation";
  v1::Process process{.name = "grid",
                      .state = v1::PROCESS_RUNNING,
                      .number = 10,
                      .since = 1,
                      .effect = "puts readings into the grid"};
  interpretation.processes.push_back(process);
  process.name = "doors";
  process.state = v1::PROCESS_SUSPENDED;
  process.number = 0;
  process.since = 12;
  process.effect = "finds doors";
  interpretation.processes.push_back(process);
  v1::ProcessSet behaviors;
  behaviors.service = "behaviors";
  process.name = "executive";
  process.state = v1::PROCESS_INIT;
  process.since = 0;
  process.effect = "evaluates behaviors";
  behaviors.processes.push_back(process);
  EXPECT_EQ(processes_table({interpretation, behaviors}),
            R"(SERVICE         PROCESS    STATE  SINCE CYCLE  DOES
behaviors       executive  INIT             0  evaluates behaviors
interpretation  grid          10            1  puts readings into the grid
interpretation  doors      SUSP            12  finds doors
)");
  EXPECT_EQ(processes_table({}), "");
}

}  // namespace
}  // namespace saphira::cli
