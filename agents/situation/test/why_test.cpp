#include "saphira/situation/why.hpp"

#include <gtest/gtest.h>

#include "office.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::situation {
namespace {

TEST(Why, DrawsTheTreeFromTheWheelsToTheGoal) {
  const std::string text = to_text(why(test::driving()));
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

TEST(Why, IsJsonForPrograms) {
  const auto json = test::Json::parse(to_json(why(test::driving())));
  EXPECT_EQ(json.at("epoch"), 7);
  EXPECT_EQ(json.at("cycle"), 1000);
  EXPECT_EQ(json.at("sentence"), why(test::driving()).sentence);
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

// However long names and reasons are.
TEST(Why, SentencesAreShort) {
  const std::string endless(500, 'x');
  Situation scene = test::driving();
  scene.grant->guard = v1::GUARD_SLOW;
  scene.grant->guard_reason = endless;
  scene.grant->source = endless;
  scene.behaviors->limit_reason = endless;
  scene.behaviors->behaviors[1].name = endless;
  scene.goals[0].requester = endless;
  for (const v1::Role role : {v1::ROLE_NONE, v1::ROLE_TELEOP, v1::ROLE_BEHAVIORS}) {
    scene.grant->role = role;
    EXPECT_LT(why(scene).sentence.size(), kLongestSentence);
    for (const Wish wish : {Wish::turn_left, Wish::turn_right, Wish::faster, Wish::slower})
      EXPECT_LT(why_not(scene, wish).sentence.size(), kLongestSentence);
  }
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
