#include "saphira/cli/goal_words.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "trouble.hpp"

namespace saphira::cli {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(GoalWords, Numbers) {
  for (const auto& [word, value] : {std::pair{"a=0.3", 0.3},
                                    {"a=-2", -2.0},
                                    {"a=+1.5", 1.5},
                                    {"a=1e-2", 0.01},
                                    {"a=.5", 0.5}}) {
    const v1::Argument argument = parse_argument(word);
    EXPECT_EQ(argument.name, "a");
    EXPECT_EQ(argument.kind, v1::ARGUMENT_NUMBER) << word;
    EXPECT_DOUBLE_EQ(argument.number, value);
  }
  EXPECT_DOUBLE_EQ(parse_argument("heading=-90deg").number, -kPi / 2);
}

TEST(GoalWords, Points) {
  const v1::Argument plain = parse_argument("position=3,-1.5");
  EXPECT_EQ(plain.kind, v1::ARGUMENT_POINT);
  EXPECT_EQ(plain.frame, v1::FRAME_ODOM);
  EXPECT_DOUBLE_EQ(plain.point.x, 3.0);
  EXPECT_DOUBLE_EQ(plain.point.y, -1.5);
  EXPECT_DOUBLE_EQ(plain.point.th, 0.0);
  const v1::Argument full = parse_argument("position=3,1,180deg@robot");
  EXPECT_EQ(full.frame, v1::FRAME_ROBOT);
  EXPECT_DOUBLE_EQ(full.point.th, kPi);
  EXPECT_EQ(parse_argument("p=1,2@map").frame, v1::FRAME_MAP);
  EXPECT_EQ(parse_argument("p=1,2@odom").frame, v1::FRAME_ODOM);
}

TEST(GoalWords, Text) {
  for (const char* word : {"a=kitchen", "a=room=4", "a=deg", "a=nan", "a=inf", "a=a,b", "a=@odom"})
    EXPECT_EQ(parse_argument(word).kind, v1::ARGUMENT_TEXT) << word;
  EXPECT_EQ(parse_argument("a=room=4").text, "room=4");
}

TEST(GoalWords, WhatIsWrongIsRefusedInWords) {
  for (const char* word :
       {"position", "=3", "a=", "position=1,2,3,4", "position=1,b", "position=1,2@moon",
        "position=1,", "position=1,2,@odom", "a-name-that-is-longer-than-31-chars=1"})
    EXPECT_THROW(parse_argument(word), std::invalid_argument) << word;
  EXPECT_THROW(parse_argument("a=" + std::string(256, 'x')), std::invalid_argument);
  EXPECT_TRUE(test::has(test::trouble([] { parse_argument("position=1,2@moon"); }),
                        "\"moon\" is not a frame"));
}

TEST(GoalWords, AWholeGoal) {
  const v1::Goal goal = parse_goal("go_to", {"position=3,1", "speed=0.3", "note=now"});
  EXPECT_EQ(goal.functor, "go_to");
  EXPECT_EQ(describe(goal), "go_to(position=(3, 1) in odom, speed=0.3, note=\"now\")");
  EXPECT_EQ(describe(parse_goal("stop", {})), "stop()");
  EXPECT_THROW(parse_goal("go_to", {"speed=1", "speed=2"}), std::invalid_argument);
  EXPECT_THROW(parse_goal("speed=1", {}), std::invalid_argument);
  std::vector<std::string> many;
  many.reserve(17);
  for (int i = 0; i < 17; ++i)
    many.push_back("a" + std::to_string(i) + "=1");
  EXPECT_THROW(parse_goal("go_to", many), std::invalid_argument);
}

TEST(GoalWords, ShortForms) {
  const auto said = [](const std::vector<std::string>& words) {
    return describe(parse_request(words));
  };
  EXPECT_EQ(said({"go", "3", "-1.5"}), "go_to(position=(3, -1.5) in odom)");
  EXPECT_EQ(said({"go", "3", "1", "speed=0.2"}), "go_to(position=(3, 1) in odom, speed=0.2)");
  EXPECT_EQ(said({"go", "3m", "-1.5m"}), "go_to(position=(3, -1.5) in odom)");
  EXPECT_EQ(said({"go", "3", "1m"}), "go_to(position=(3, 1) in odom)");
  EXPECT_EQ(said({"go", "3m"}), "go-to-place(place=\"3m\")");
  EXPECT_EQ(said({"go", "door", "124"}), "go-to-place(place=\"door 124\")");
  EXPECT_EQ(said({"go", "300cm", "-1500mm"}), "go_to(position=(3, -1.5) in odom)");
  EXPECT_EQ(said({"drive", "0.3m/s"}), said({"drive", "0.3"}));
  EXPECT_EQ(said({"drive", "30cm/s"}), said({"drive", "0.3"}));
  EXPECT_EQ(said({"turn", "to", "90deg"}), said({"turn", "to", "90"}));
  EXPECT_EQ(said({"go", "EJ-231"}), "go-to-place(place=\"EJ-231\")");
  EXPECT_EQ(said({"go", "to", "EJ-231"}), "go-to-place(place=\"EJ-231\")");
  EXPECT_EQ(said({"go", "meeting", "room"}), "go-to-place(place=\"meeting room\")");
  EXPECT_EQ(said({"go", "meeting room"}), "go-to-place(place=\"meeting room\")");
  EXPECT_EQ(said({"go", "to", "the", "room", "4", "speed=0.2"}),
            "go-to-place(place=\"the room 4\", speed=0.2)");
  EXPECT_EQ(said({"go-to-place", "place=meeting room"}), "go-to-place(place=\"meeting room\")");
  EXPECT_EQ(said({"drive", "0.3"}), "drive(speed=0.3)");
  EXPECT_EQ(said({"drive", "speed=0.3"}), "drive(speed=0.3)");
  EXPECT_EQ(said({"turn", "to", "180"}), "turn_to(heading=3.14159)");
  EXPECT_EQ(said({"turn", "to", "180deg"}), "turn_to(heading=3.14159)");
  EXPECT_EQ(said({"stop"}), "stop()");
  EXPECT_EQ(said({"follow", "who=ann"}), "follow(who=\"ann\")");
}

TEST(GoalWords, AFailureOffTheMapPointsToTheMap) {
  EXPECT_NE(advice_after_failure(parse_request({"go", "3", "1"})).find("X,Y@map"),
            std::string::npos);
  EXPECT_EQ(advice_after_failure(parse_request({"go_to", "position=3,1@map"})), "");
  EXPECT_EQ(advice_after_failure(parse_request({"go", "3,1@map"})), "");
  EXPECT_EQ(advice_after_failure(parse_request({"drive", "0.3"})), "");
}

TEST(GoalWords, WrongShortFormsAreRefused) {
  const std::vector<std::vector<std::string>> wrong{{},
                                                    {"go"},
                                                    {"go", "3"},
                                                    {"go", "3", "1", "2"},
                                                    {"go", "3", "b"},
                                                    {"drive"},
                                                    {"drive", "fast"},
                                                    {"drive", "90deg"},
                                                    {"drive", "0.3m"},
                                                    {"turn", "90"},
                                                    {"turn", "to", "1m"},
                                                    {"activitis"},
                                                    {"go", "3", "1deg"},
                                                    {"turn"},
                                                    {"turn", "to", "left"},
                                                    {"stop", "now"},
                                                    {"go_to", "3", "1"}};
  for (const auto& words : wrong)
    EXPECT_THROW(parse_request(words), std::invalid_argument) << testing::PrintToString(words);
}

}  // namespace
}  // namespace saphira::cli
