#include "saphira/situation/why.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "office.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/situation/sentence.hpp"

namespace saphira::situation {
namespace {

using test::id;
using test::rule;

class WhyTest : public ::testing::Test {
 protected:
  v1::BehaviorState& keep_off() { return scene.behaviors->behaviors[0]; }
  v1::BehaviorState& go() { return scene.behaviors->behaviors[1]; }
  std::string sentence() const { return why(scene).sentence; }
  std::string sentence(Wish wish) const { return why_not(scene, wish).sentence; }

  Situation scene = test::driving();
};

// The intentions service has its behaviors in the tree, as leaves.
TEST_F(WhyTest, ABehaviorIsNotItsOwnPurpose) {
  const std::string before = sentence();
  v1::IntentionNode leaf{.id = 6, .parent = 5, .label = "B"};
  for (v1::IntendedBehavior& intended : scene.intentions->behaviors) {
    leaf.name = intended.name;
    leaf.schema = intended.schema;
    intended.intention = leaf.id;
    scene.intentions->nodes.push_back(leaf);
    leaf.id = leaf.id + 1;
    leaf.label = "";
  }
  EXPECT_EQ(sentence(), before);
}

TEST_F(WhyTest, DrawsTheTreeFromTheWheelsToTheGoal) {
  const std::string text = to_text(why(scene));
  EXPECT_EQ(
      text.substr(text.find("\n\n") + 2),
      R"(cycle 1000: The robot is told to drive ahead at 0.30 m/s and to turn 11 degrees to the left
|- behaviors drives as behaviors: no stronger driver sends commands
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

v1::Belief karens_office() {
  return {.name = "place-of-karen",
          .value = "\"EJ-231\"",
          .said_by = "Alice said at 10:02 \"Flakey, EJ-231 is Karen's office\""};
}

TEST_F(WhyTest, NamesWhatPeopleHaveToldAboutWhatItDoes) {
  v1::IntentionNode& node = scene.intentions->nodes[0];
  node.schema = "find-person";
  node.arguments = "name=karen, patience=15";
  const v1::Belief told = karens_office();
  v1::Belief other = told;
  other.name = "place-of-john";
  other.value = "\"EJ-233\"";
  v1::Belief seen = told;
  seen.said_by = "perception";
  scene.beliefs = {seen, told, other};
  const std::string text = to_text(why(scene));
  const std::string line = told.said_by + " (place-of-karen: \"EJ-231\")";
  EXPECT_NE(text.find(line), std::string::npos) << text;
  EXPECT_EQ(text.find(line), text.rfind(line)) << "once";
  EXPECT_EQ(text.find("john"), std::string::npos) << text;
  EXPECT_EQ(text.find("perception"), std::string::npos) << text;
}

TEST_F(WhyTest, ABehaviorIsNotSetAgainstItself) {
  v1::BehaviorState& follow = scene.behaviors->behaviors[1];
  follow.name = "follow#3";
  follow.schema = "follow";
  follow.speed = 0.18;
  follow.rules = {test::rule("on_course", 0.8, v1::CONTROL_SPEED, 0.21)};
  scene.behaviors->speed = scene.grant->velocity = scene.robot->velocity = 0.18;
  EXPECT_EQ(why_not(scene, Wish::faster).sentence,
            "It does not go faster: follow would (rule on_course, 0.21 m/s), but all its rules "
            "together want 0.18 m/s.");
  // Another one does stand against it.
  v1::BehaviorState& other = scene.behaviors->behaviors[0];
  other.recommends_speed = true;
  other.speed = 0.1;
  other.speed_weight = 0.5;
  other.rules = {test::rule("near", 1.0, v1::CONTROL_SPEED, 0.1)};
  EXPECT_EQ(why_not(scene, Wish::faster).sentence,
            "It does not go faster: follow would (rule on_course, 0.21 m/s), but KeepOff wants "
            "0.10 m/s (rule near).");
}

TEST_F(WhyTest, APlaceOfTwoPersonsIsGroundedInTheOneThatWasMeant) {
  v1::IntentionNode& node = scene.intentions->nodes[0];
  node.schema = "go-to-place";
  node.arguments = "place=EJ-231, speed=0.3, whose=karen";
  const v1::Belief told = karens_office();
  v1::Belief other = told;
  other.name = "place-of-john";
  other.said_by = "Bob said at 10:03 \"Flakey, John is in EJ-231\"";
  scene.beliefs = {other, told};
  std::string text = to_text(why(scene));
  EXPECT_NE(text.find("place-of-karen"), std::string::npos) << text;
  EXPECT_EQ(text.find("place-of-john"), std::string::npos) << text;
  // The goal has the arguments of the first intention.
  node.arguments = "";
  scene.goals[0].functor = "go-to-place";
  v1::Argument place;
  place.name = "place";
  place.kind = v1::ARGUMENT_TEXT;
  place.text = "EJ-231";
  v1::Argument whose = place;
  whose.name = "whose";
  whose.text = "karen";
  scene.goals[0].arguments = {place, whose};
  text = to_text(why(scene));
  EXPECT_NE(text.find("place-of-karen"), std::string::npos) << text;
  EXPECT_EQ(text.find("place-of-john"), std::string::npos) << text;
  scene.goals[0].arguments = {place};
  text = to_text(why(scene));
  EXPECT_EQ(text.find("place-of-"), std::string::npos) << "nobody was named: " << text;
}

// A C program's behaviors and intentions are its own, and serve no goal.
TEST_F(WhyTest, NamesTheProgramWhoseBehaviorsDrive) {
  scene.own_mind = true;
  scene.grant->role = v1::ROLE_DIRECT;
  scene.grant->source = "follower";
  scene.intentions->nodes[0].goal = {};
  scene.intentions->nodes[0].schema = "find and follow";
  scene.intentions->nodes[0].name = "find and follow";
  test::remove(scene, "behaviors");
  EXPECT_TRUE(sentence().ends_with("; behaviors of the program follower, for find and follow."))
      << sentence();
  const std::string text = to_text(why(scene));
  EXPECT_NE(text.find("`- of the program follower"), std::string::npos) << text;
  EXPECT_EQ(text.find("goal"), std::string::npos) << text;
  EXPECT_EQ(text.find("not on the bus"), std::string::npos) << text;
}

TEST_F(WhyTest, IsJsonForPrograms) {
  const auto json = nlohmann::json::parse(to_json(why(scene)));
  EXPECT_EQ(json.at("epoch"), 7);
  EXPECT_EQ(json.at("cycle"), 1000);
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
  go().recommends_turn = false;
  scene.behaviors->behaviors = {go()};
  scene.behaviors->turning = false;
  scene.intentions->nodes[0].schema = "follow-path";
  scene.intentions->nodes[0].name = "follow-it";
  scene.intentions->nodes[0].parent = 3;
  v1::IntentionNode root{.id = 3,
                         .name = "plan-and-execute1",
                         .schema = "plan-and-execute",
                         .label = "S12",
                         .goal = id(2)};
  scene.intentions->nodes.insert(scene.intentions->nodes.begin(), root);
  EXPECT_EQ(sentence(),
            "The robot is told to drive ahead at 0.30 m/s, straight on: GoToPos wants 0.30 m/s "
            "(rule Fast); for go_to(position=(3, 1) in odom) of saphira goal, by follow-path "
            "(follow-it).");
  EXPECT_NE(to_text(why(scene))
                .find("|     `- for follow-path (follow-it): driving to (3.00, 1.00)\n"
                      "|        `- for plan-and-execute\n"
                      "|           `- goal go_to("),
            std::string::npos)
      << to_text(why(scene));
}

TEST_F(WhyTest, ZonesAreNamed) {
  scene.behaviors->speed_limit = 0.1;
  scene.behaviors->limit_reason = "slow zone \"kitchen\"";
  EXPECT_NE(sentence().find("slow zone \"kitchen\", so it drives no faster than 0.10 m/s"),
            std::string::npos)
      << sentence();
  scene.behaviors->limit_reason = "";
  v1::Belief detour;
  detour.name = "detour";
  detour.value = R"("around keep-out zone \"lab\"")";
  scene.beliefs.push_back(detour);
  EXPECT_EQ(sentence().find("keep-out"), std::string::npos) << "there is no path";
  v1::IntentionNode path{.id = 4711};
  path.schema = "follow-path";
  path.state = v1::INTENTION_RUNNING;
  scene.intentions->nodes.push_back(path);
  EXPECT_NE(sentence().find("it takes the way around keep-out zone \"lab\""), std::string::npos)
      << sentence();
}

TEST_F(WhyTest, ASlowNetworkIsSaidAndHowSlow) {
  scene.behaviors->input_age = 0.6;
  scene.behaviors->speed_limit = 0.3;
  scene.behaviors->limit_reason = "the network, or a computer, is slow: intentions are 0.5 s old";
  const Explanation slow = why(scene);
  EXPECT_NE(slow.sentence.find("intentions are 0.5 s old, so it drives no faster than 0.30 m/s"),
            std::string::npos)
      << slow.sentence;
  EXPECT_NE(to_text(slow).find("- the network, or a computer, is slow"), std::string::npos);
  // Without an effect on the speed as well.
  scene.behaviors->limit_reason = "";
  scene.grant->command_age = 0.4;
  const Explanation slower = why(scene);
  EXPECT_NE(slower.sentence.find("what was intended was 0.6 s old"), std::string::npos)
      << slower.sentence;
  EXPECT_NE(to_text(slower).find("what was intended was 0.6 s old"), std::string::npos)
      << to_text(slower);
  // Fresh, as on one machine.
  scene.behaviors->input_age = 0.1;
  scene.grant->command_age = 0.1;
  EXPECT_EQ(to_text(why(scene)).find("slow"), std::string::npos);
}

TEST_F(WhyTest, NotKnown) {
  const Situation nothing;
  EXPECT_EQ(why(nothing).sentence, "Nothing is known of this cycle.");
  EXPECT_EQ(why_not(nothing, Wish::faster).sentence,
            "It is not known whether it is to go faster. Nothing is known of this cycle.");
  scene.behaviors.reset();
  EXPECT_EQ(sentence(),
            "The robot is told to drive ahead at 0.30 m/s and to turn 11 degrees to the left: "
            "behaviors drives it; its reasons are not known.");
  EXPECT_TRUE(sentence(Wish::faster).starts_with("It is not known whether it is to go faster"));
}

TEST_F(WhyTest, WithoutGoalsAndSchemasItTellsLess) {
  scene.goals.clear();
  scene.statuses.clear();
  scene.schemas.clear();
  EXPECT_TRUE(sentence().ends_with("for a goal of which nothing is known.")) << sentence();
  scene.intentions.reset();
  EXPECT_TRUE(sentence().ends_with("KeepOff wants 20 degrees to the left.")) << sentence();
}

// The sentence stays short, however long names and reasons are.
TEST_F(WhyTest, SentencesAreShort) {
  const std::string endless(500, 'x');
  scene.grant->guard = v1::GUARD_SLOW;
  scene.grant->guard_reason = endless;
  scene.behaviors->limit_reason = endless;
  scene.goals[0].requester = endless;
  go().name = endless;
  for (const v1::Role role : {v1::ROLE_NONE, v1::ROLE_TELEOP, v1::ROLE_BEHAVIORS}) {
    scene.grant->role = role;
    scene.grant->source = endless;
    EXPECT_LT(sentence().size(), kLongestSentence);
    for (const Wish wish : {Wish::turn_left, Wish::turn_right, Wish::faster, Wish::slower})
      EXPECT_LT(sentence(wish).size(), kLongestSentence);
  }
}

TEST_F(WhyTest, NotSinceNothingCallsForIt) {
  go().rules[0].strength = 0.0;
  go().recommends_turn = false;
  go().turn = 0.0;
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: KeepOff would (rule Obstacle-Left, 20 degrees to the right), "
            "but finds no cause: if front_left: front_left 0.00.");
}

TEST_F(WhyTest, NotSinceTheHigherPriorityLeavesNoSay) {
  keep_off().turn_activity = 1.0;
  keep_off().turn_weight = 1.0;
  go().turn_weight = 0.0;
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: GoToPos would (rule Right, 10 degrees to the right), but "
            "KeepOff has a higher priority and decides alone.");
}

TEST_F(WhyTest, NotSinceItDoesNotCountItself) {
  go().turn_activity = 0.0;
  go().turn_weight = 0.0;
  EXPECT_EQ(sentence(Wish::turn_right),
            "It does not turn right: GoToPos would (rule Right, 10 degrees to the right), but says "
            "itself that it does not count now.");
}

TEST_F(WhyTest, NotSinceItIsSoLittle) {
  go().rules[0].value = radians(0.3);
  EXPECT_EQ(
      sentence(Wish::turn_right),
      "It does not turn right: GoToPos would (rule Right, 0.3 degrees to the right), but that "
      "turn is too small to matter.");
}

// A setpoint for a case that does not hold is no wish.
TEST_F(WhyTest, NotFasterByARuleThatDoesNotHold) {
  keep_off().rules.push_back(rule("slow_down", 0.0, v1::CONTROL_SPEED, 1.5));
  EXPECT_TRUE(sentence(Wish::faster).starts_with("It does not go faster: no running"))
      << sentence(Wish::faster);
  keep_off().speed_activity = 1.0;
  EXPECT_EQ(sentence(Wish::slower),
            "It does not go slower: no running behavior wants that; GoToPos wants 0.30 m/s (rule "
            "Fast).");
}

TEST_F(WhyTest, BehaviorsAreNamedAsShortAsCanBe) {
  go().name = "go-to-pos#4";
  EXPECT_NE(sentence().find(": GoToPos wants"), std::string::npos) << sentence();
  keep_off().name = "steer#5";
  EXPECT_NE(sentence().find(", steer (KeepOff) wants"), std::string::npos) << sentence();
  // Two that would have the same name.
  keep_off().schema = "GoToPos";
  keep_off().name = "GoToPos#5";
  EXPECT_NE(sentence().find(": go-to-pos#4 wants"), std::string::npos) << sentence();
  EXPECT_NE(sentence().find(", GoToPos#5 wants"), std::string::npos) << sentence();
  keep_off().running = false;
  EXPECT_NE(sentence().find(": GoToPos wants"), std::string::npos) << sentence();
}

TEST_F(WhyTest, IntentionsAndTurnsAreToldInWords) {
  v1::IntentionNode root{.id = 9, .schema = "watch", .goal = id(2)};
  v1::IntentionNode& own = scene.intentions->nodes[0];
  own.parent = 9;
  own.name = "rest#32";
  own.schema = "idle";
  scene.intentions->nodes.push_back(root);
  go().rules = {rule("Right", 1.0, v1::CONTROL_TURN_RIGHT, 0.0)};
  const std::string text = to_text(why(scene));
  EXPECT_NE(text.find("for idle (rest): "), std::string::npos) << text;
  EXPECT_NE(text.find("rule Right holds to 1.00: straight on"), std::string::npos) << text;
}

TEST_F(WhyTest, NotSinceNoRuleWould) {
  keep_off().rules.clear();
  go().rules = {rule("Left", 1.0, v1::CONTROL_TURN_LEFT, radians(10.0))};
  EXPECT_TRUE(
      sentence(Wish::turn_right)
          .starts_with("It does not turn right: no running behavior has a rule that would; "))
      << sentence(Wish::turn_right);
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
}  // namespace saphira::situation
