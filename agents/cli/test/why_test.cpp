#include "saphira/cli/why.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "saphira/geometry/pose.hpp"

namespace saphira::cli {
namespace {

v1::RuleState rule(const std::string& name, double strength, v1::ControlAction action,
                   double value) {
  v1::RuleState result;
  result.name(name);
  result.strength(strength);
  result.action(action);
  result.value(value);
  return result;
}

v1::GoalId id(std::uint64_t number) {
  v1::GoalId result;
  result.writer(0xabc);
  result.number(number);
  return result;
}

/// A drive to a point past an obstacle on the right: KeepOff (1) steers left, GoToPos (3) drives
/// on.
class WhyTest : public ::testing::Test {
 protected:
  WhyTest() {
    scene.cycle = 100;
    v1::RobotState robot;
    robot.stamp().cycle(100);
    robot.velocity(0.3);
    scene.robot = robot;

    v1::Grant grant;
    grant.role(v1::ROLE_BEHAVIORS);
    grant.source("behaviors");
    grant.reason("behaviors is the strongest role with a live command");
    grant.guard(v1::GUARD_NONE);
    grant.velocity(0.3);
    scene.grant = grant;

    v1::BehaviorState keep_off;
    keep_off.name("KeepOff");
    keep_off.schema("KeepOff");
    keep_off.priority(1);
    keep_off.running(true);
    keep_off.turn_activity(0.7);
    keep_off.turn_weight(0.7);
    keep_off.recommends_turn(true);
    keep_off.turn(radians(20.0));
    keep_off.rules({rule("Obstacle-Right", 1.0, v1::CONTROL_TURN_LEFT, radians(20.0)),
                    rule("Obstacle-Left", 0.0, v1::CONTROL_TURN_RIGHT, radians(20.0))});
    v1::FuzzyVariable variable;
    variable.name("front_right");
    variable.value(1.0);
    keep_off.variables().push_back(variable);
    variable.name("front_left");
    variable.value(0.0);
    keep_off.variables().push_back(variable);

    v1::BehaviorState go;
    go.name("GoToPos");
    go.schema("GoToPos");
    go.priority(3);
    go.running(true);
    go.turn_activity(1.0);
    go.turn_weight(0.3);
    go.speed_activity(1.0);
    go.speed_weight(1.0);
    go.recommends_turn(true);
    go.turn(radians(-10.0));
    go.recommends_speed(true);
    go.speed(0.3);
    go.rules({rule("Right", 1.0, v1::CONTROL_TURN_RIGHT, radians(10.0)),
              rule("Left", 0.0, v1::CONTROL_TURN_LEFT, radians(10.0)),
              rule("Fast", 1.0, v1::CONTROL_SPEED, 0.3)});

    v1::Behaviors behaviors;
    behaviors.stamp().epoch(7);
    behaviors.stamp().cycle(100);
    behaviors.control(true);
    behaviors.behaviors({keep_off, go});
    behaviors.turning(true);
    behaviors.turn(radians(11.0));
    behaviors.moving(true);
    behaviors.speed(0.3);
    scene.behaviors = behaviors;

    v1::IntentionNode node;
    node.id(5);
    node.name("go_to1");
    node.schema("go_to");
    node.step("driving to (3.00, 1.00)");
    node.goal(id(2));
    v1::Intentions intentions;
    intentions.behavior_control(true);
    intentions.nodes({node});
    for (const char* name : {"KeepOff", "GoToPos"}) {
      v1::IntendedBehavior intended;
      intended.name(name);
      intended.schema(name);
      intended.running(true);
      intended.intention(5);
      intentions.behaviors().push_back(intended);
    }
    scene.intentions = intentions;

    v1::Goal goal;
    goal.id(id(2));
    goal.requester("saphira goal");
    goal.functor("go_to");
    v1::Argument position;
    position.name("position");
    position.kind(v1::ARGUMENT_POINT);
    position.point().x(3.0);
    position.point().y(1.0);
    position.frame(v1::FRAME_ODOM);
    goal.arguments({position});
    scene.goals = {goal};
    v1::GoalStatus status;
    status.id(id(2));
    status.functor("go_to");
    status.requester("saphira goal");
    status.state(v1::GOAL_UNDERWAY);
    scene.statuses = {status};

    v1::BehaviorSchema schema;
    schema.name("KeepOff");
    v1::RuleText text;
    text.name("Obstacle-Right");
    text.antecedent("front_right And Not front_left");
    schema.rules().push_back(text);
    text.name("Obstacle-Left");
    text.antecedent("front_left");
    schema.rules().push_back(text);
    scene.schemas = {schema};
  }

  v1::BehaviorState& keep_off() { return scene.behaviors->behaviors()[0]; }
  v1::BehaviorState& go() { return scene.behaviors->behaviors()[1]; }
  std::string sentence() const { return why(scene).sentence; }
  std::string sentence(Wish wish) const { return why_not(scene, wish).sentence; }

  Scene scene;
};

const std::string kPurpose =
    "this is for the goal go_to(position=(3, 1) in odom), which saphira goal asked for.";

TEST_F(WhyTest, NamesBehaviorsRulesIntentionAndGoal) {
  EXPECT_EQ(sentence(),
            "The robot is told to drive ahead at 0.30 m/s and to turn 11 degrees to the left, "
            "because GoToPos wants 0.30 m/s (rule Fast, 1.00) and 10 degrees to the right (rule "
            "Right, 1.00; 30 % of the say), and KeepOff wants 20 degrees to the left (rule "
            "Obstacle-Right, 1.00; 70 % of the say); " +
                kPurpose);
}

// The intentions service has its behaviors in the tree, as leaves.
TEST_F(WhyTest, ABehaviorIsNotItsOwnPurpose) {
  const std::string before = sentence();
  v1::IntentionNode leaf;
  leaf.id(6);
  leaf.parent(5);
  leaf.label("B");
  for (v1::IntendedBehavior& intended : scene.intentions->behaviors()) {
    leaf.name(intended.name());
    leaf.schema(intended.schema());
    intended.intention(leaf.id());
    scene.intentions->nodes().push_back(leaf);
    leaf.id(leaf.id() + 1);
    leaf.label("");
  }
  EXPECT_EQ(sentence(), before);
}

TEST_F(WhyTest, DrawsTheTreeFromTheWheelsToTheGoal) {
  const std::string text = to_text(why(scene));
  EXPECT_EQ(
      text.substr(text.find("\n\n") + 2),
      R"(cycle 100: The robot is told to drive ahead at 0.30 m/s and to turn 11 degrees to the left
|- behaviors drives as behaviors: behaviors is the strongest role with a live command
|- the behaviors' blend of speeds: 0.30 m/s
|  `- GoToPos, priority 3, 100 % of the say: 0.30 m/s
|     |- rule Fast holds to 1.00: 0.30 m/s
|     `- for go_to: driving to (3.00, 1.00)
|        `- goal go_to(position=(3, 1) in odom) of saphira goal
`- the behaviors' blend of turns: 11 degrees to the left
   |- KeepOff, priority 1, 70 % of the say: 20 degrees to the left
   |  |- rule Obstacle-Right holds to 1.00: 20 degrees to the left
   |  |  `- if front_right And Not front_left: front_right 1.00, front_left 0.00
   |  `- for go_to, as above
   `- GoToPos, priority 3, 30 % of the say: 10 degrees to the right
      |- rule Right holds to 1.00: 10 degrees to the right
      `- for go_to, as above
)");
}

TEST_F(WhyTest, IsJsonForPrograms) {
  const auto json = nlohmann::json::parse(to_json(why(scene)));
  EXPECT_EQ(json.at("epoch"), 7);
  EXPECT_EQ(json.at("cycle"), 100);
  EXPECT_EQ(json.at("sentence"), sentence());
  // From the wheels down to the goal.
  const auto& speed = json.at("tree").at("because").at(1);
  EXPECT_EQ(speed.at("kind"), "speed");
  const auto& behavior = speed.at("because").at(0);
  EXPECT_EQ(behavior.at("kind"), "behavior");
  EXPECT_EQ(behavior.at("because").at(0).at("kind"), "rule");
  const auto& intention = behavior.at("because").at(1);
  EXPECT_EQ(intention.at("kind"), "intention");
  EXPECT_EQ(intention.at("because").at(0).at("kind"), "goal");
}

TEST_F(WhyTest, GoesUpTheWholeChainOfIntentions) {
  go().recommends_turn(false);
  scene.behaviors->behaviors({go()});
  scene.behaviors->turning(false);
  scene.intentions->nodes()[0].schema("follow-path");
  scene.intentions->nodes()[0].name("follow-it");
  scene.intentions->nodes()[0].parent(3);
  v1::IntentionNode root;
  root.id(3);
  root.name("plan-and-execute1");
  root.schema("plan-and-execute");
  root.label("S12");
  root.goal(id(2));
  scene.intentions->nodes().insert(scene.intentions->nodes().begin(), root);
  EXPECT_EQ(sentence(),
            "The robot is told to drive ahead at 0.30 m/s, straight on, because GoToPos wants 0.30 "
            "m/s (rule Fast, 1.00); follow-path (follow-it) intends it, as part of "
            "plan-and-execute, for the goal go_to(position=(3, 1) in odom), "
            "which saphira goal asked for.");
  EXPECT_NE(to_text(why(scene))
                .find("|     `- for follow-path (follow-it): driving to (3.00, 1.00)\n"
                      "|        `- for plan-and-execute, at S12\n"
                      "|           `- goal go_to("),
            std::string::npos)
      << to_text(why(scene));
}

TEST_F(WhyTest, TellsWhatItDoesWhereThatIsNotWhatItIsTold) {
  scene.robot->velocity(0.1);
  EXPECT_NE(sentence().find("11 degrees to the left (now it does 0.10 m/s), because"),
            std::string::npos)
      << sentence();
}

TEST_F(WhyTest, TheGuardComesFirst) {
  scene.grant->guard(v1::GUARD_STOP);
  scene.grant->guard_reason("something 0.12 m ahead: stopped (margin 0.20 m)");
  scene.grant->velocity(0.0);
  scene.robot->velocity(0.0);
  EXPECT_TRUE(sentence().starts_with(
      "The robot is told to turn on the spot, 11 degrees to the left, because the guard beside the "
      "robot stops it (something 0.12 m ahead: stopped (margin 0.20 m)), GoToPos wants 0.30 m/s"))
      << sentence();
  EXPECT_EQ(sentence(Wish::faster),
            "It does not go faster because the guard beside the robot stops it (something 0.12 m "
            "ahead: stopped (margin 0.20 m)); the behaviors want 0.30 m/s.");
}

TEST_F(WhyTest, ASlowNetworkIsSaidAndHowSlow) {
  scene.behaviors->input_age(0.6);
  scene.behaviors->speed_limit(0.3);
  scene.behaviors->limit_reason("the network, or a computer, is slow: intentions are 0.5 s old");
  const Explanation slow = why(scene);
  EXPECT_NE(slow.sentence.find("intentions are 0.5 s old, so it drives no faster than 0.30 m/s"),
            std::string::npos)
      << slow.sentence;
  EXPECT_NE(to_text(slow).find("- the network, or a computer, is slow"), std::string::npos);
  // Where it drives no faster anyway the sentence is about something else.
  scene.behaviors->limit_reason("");
  scene.grant->command_age(0.4);
  const Explanation slower = why(scene);
  EXPECT_EQ(slower.sentence.find("slow"), std::string::npos) << slower.sentence;
  EXPECT_NE(to_text(slower).find("what was intended was 0.6 s old"), std::string::npos)
      << to_text(slower);
  // Fresh, as on one machine.
  scene.behaviors->input_age(0.1);
  scene.grant->command_age(0.1);
  EXPECT_EQ(to_text(why(scene)).find("slow"), std::string::npos);
}

TEST_F(WhyTest, ACutLinkIsWhyNobodyDrives) {
  scene.grant->role(v1::ROLE_NONE);
  scene.grant->reason("behaviors (behaviors) does not want to drive");
  scene.behaviors->speed_limit(0.0);
  scene.behaviors->limit_reason(
      "no newer intent has come for 3 cycles: intentions, or the network to it, is gone");
  EXPECT_NE(why(scene).sentence.find("no newer intent has come for 3 cycles"), std::string::npos)
      << why(scene).sentence;
}

TEST_F(WhyTest, NobodyDrives) {
  scene.grant->role(v1::ROLE_NONE);
  scene.grant->reason("behaviors (behaviors) does not want to drive");
  scene.intentions->nodes().clear();
  scene.intentions->behaviors().clear();
  scene.statuses[0].state(v1::GOAL_SUCCEEDED);
  scene.statuses[0].reason("arrived, 0.10 m from the point");
  const std::string stands =
      "The robot stands because nobody drives it: behaviors (behaviors) does not want to drive; no "
      "goal is underway; the newest one, go_to(position=(3, 1) in odom) of saphira goal, "
      "succeeded: arrived, 0.10 m from the point.";
  EXPECT_EQ(sentence(), stands);
  EXPECT_EQ(sentence(Wish::turn_left),
            "It does not turn left because the behaviors do not drive it. " + stands);
  scene.statuses.clear();
  EXPECT_TRUE(sentence().ends_with("; nobody has asked for a goal.")) << sentence();
  scene.intentions->behavior_control(false);
  EXPECT_TRUE(sentence().ends_with("; behavior control is switched off.")) << sentence();
  scene.suspended = "execute-intentions of intentions";
  EXPECT_TRUE(sentence().ends_with("; execute-intentions of intentions is suspended."))
      << sentence();
  scene.missing = "behaviors";
  EXPECT_TRUE(sentence().ends_with("; behaviors is not on the bus.")) << sentence();
}

TEST_F(WhyTest, AGoalThatIsUnderwayAndIntendsNothing) {
  scene.grant->role(v1::ROLE_NONE);
  scene.grant->reason("nobody asked to drive");
  scene.intentions->behaviors().clear();
  scene.statuses[0].step("waits for the door to open");
  EXPECT_EQ(sentence(),
            "The robot stands because nobody drives it: nobody asked to drive; the goal "
            "go_to(position=(3, 1) in odom) of saphira goal is underway and intends no behavior "
            "now: waits for the door to open.");
}

TEST_F(WhyTest, APersonDrives) {
  scene.grant->role(v1::ROLE_TELEOP);
  scene.grant->source("saphira drive");
  scene.grant->velocity(0.2);
  EXPECT_EQ(sentence(),
            "The robot is told to drive at 0.20 m/s because saphira drive drives it (teleop).");
  EXPECT_TRUE(sentence(Wish::slower)
                  .starts_with("It does not go slower because the behaviors do "
                               "not drive it. The robot is told"));
  scene.grant->role(v1::ROLE_ESTOP);
  scene.grant->source("panel");
  scene.grant->estopped(true);
  scene.grant->estop_source("panel");
  EXPECT_EQ(sentence(),
            "The robot is told to stop: EMERGENCY STOP, pressed by panel: the robot stands until "
            "saphira estop reset.");
}

TEST_F(WhyTest, AutonomyWaitsToBeHandedTheRobotBack) {
  scene.grant->role(v1::ROLE_NONE);
  scene.grant->reason("keyboard (teleop) does not want to drive");
  scene.grant->waits_for_hand_back(true);
  EXPECT_NE(sentence().find("nobody drives it: keyboard (teleop) does not want to drive; autonomy "
                            "waits until the robot is handed back: saphira drive hand-back"),
            std::string::npos)
      << sentence();
}

TEST_F(WhyTest, NotKnown) {
  const Scene nothing;
  EXPECT_EQ(why(nothing).sentence, "Nothing is known of this cycle.");
  EXPECT_TRUE(why_not(nothing, Wish::faster).sentence.ends_with("Nothing is known of this cycle."));
  scene.behaviors.reset();
  EXPECT_EQ(sentence(), "What the behaviors computed in this cycle is not known.");
  EXPECT_NE(sentence(Wish::faster), "");
}

TEST_F(WhyTest, WithoutGoalsAndSchemasItTellsLess) {
  scene.goals.clear();
  scene.statuses.clear();
  scene.schemas.clear();
  EXPECT_TRUE(sentence().ends_with("for a goal of which nothing is known.")) << sentence();
  scene.intentions.reset();
  EXPECT_TRUE(sentence().ends_with("70 % of the say).")) << sentence();
}

TEST_F(WhyTest, NotSinceTheOtherWeighsMore) {
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: GoToPos would (rule Right, 10 degrees to the right), but "
            "KeepOff wants 20 degrees to the left (rule Obstacle-Right, 1.00; 70 % of the say).");
}

TEST_F(WhyTest, NotSinceNothingCallsForIt) {
  go().rules()[0].strength(0.0);
  go().recommends_turn(false);
  go().turn(0.0);
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: KeepOff would (rule Obstacle-Left, 20 degrees to the right), "
            "but finds no cause: if front_left: front_left 0.00.");
}

TEST_F(WhyTest, NotSinceTheHigherPriorityLeavesNoSay) {
  keep_off().turn_activity(1.0);
  keep_off().turn_weight(1.0);
  go().turn_weight(0.0);
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: GoToPos would (rule Right, 10 degrees to the right), but "
            "KeepOff is above it and leaves it no say.");
}

TEST_F(WhyTest, NotSinceItDoesNotCountItself) {
  go().turn_activity(0.0);
  go().turn_weight(0.0);
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: GoToPos would (rule Right, 10 degrees to the right), but says "
            "itself that it does not count now.");
}

TEST_F(WhyTest, NotSinceItIsSoLittle) {
  go().rules()[0].value(radians(0.3));
  EXPECT_EQ(
      sentence(Wish::turn_right),
      "It does not turn right: GoToPos would (rule Right, 0.3 degrees to the right), but that "
      "is as good as straight on.");
}

// A setpoint that is computed for a case that is not there is nobody's wish.
TEST_F(WhyTest, NotFasterByARuleThatDoesNotHold) {
  keep_off().rules().push_back(rule("slow_down", 0.0, v1::CONTROL_SPEED, 1.5));
  EXPECT_TRUE(sentence(Wish::faster).starts_with("It does not go faster, because no running"))
      << sentence(Wish::faster);
  keep_off().speed_activity(1.0);
  EXPECT_EQ(sentence(Wish::slower),
            "It does not go slower, because no running behavior wants that; GoToPos wants 0.30 m/s "
            "(rule Fast, 1.00).");
}

TEST_F(WhyTest, BehaviorsAreNamedAsShortAsCanBe) {
  go().name("go-to-pos#4");
  EXPECT_NE(sentence().find("because GoToPos wants"), std::string::npos) << sentence();
  keep_off().name("steer#5");
  EXPECT_NE(sentence().find("and steer (KeepOff) wants"), std::string::npos) << sentence();
  // Two that would have the same name.
  keep_off().schema("GoToPos");
  keep_off().name("GoToPos#5");
  EXPECT_NE(sentence().find("because go-to-pos#4 wants"), std::string::npos) << sentence();
  EXPECT_NE(sentence().find("and GoToPos#5 wants"), std::string::npos) << sentence();
}

TEST_F(WhyTest, NotSinceNoRuleWould) {
  EXPECT_EQ(sentence(Wish::faster),
            "It does not go faster, because no running behavior wants that; GoToPos wants 0.30 m/s "
            "(rule Fast, 1.00).");
  keep_off().rules().clear();
  go().rules({rule("Left", 1.0, v1::CONTROL_TURN_LEFT, radians(10.0))});
  EXPECT_TRUE(
      sentence(Wish::turn_right)
          .starts_with("It does not turn right, because no running behavior has a rule that "
                       "would; "))
      << sentence(Wish::turn_right);
}

TEST_F(WhyTest, ButItDoes) {
  EXPECT_TRUE(sentence(Wish::turn_left).starts_with("It does turn left. The robot is told to"));
  scene.robot->velocity(0.1);
  EXPECT_TRUE(sentence(Wish::faster).starts_with("It does go faster. The robot is told to"));
}

TEST(Wish, IsReadFromWords) {
  EXPECT_EQ(parse_wish({"turn", "left"}), Wish::turn_left);
  EXPECT_EQ(parse_wish({"turn", "right"}), Wish::turn_right);
  EXPECT_EQ(parse_wish({"faster"}), Wish::faster);
  EXPECT_EQ(parse_wish({"slower"}), Wish::slower);
  EXPECT_EQ(parse_wish({"turn"}), std::nullopt);
  EXPECT_EQ(parse_wish({}), std::nullopt);
}

}  // namespace
}  // namespace saphira::cli
