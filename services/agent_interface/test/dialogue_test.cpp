// The dialogue: orders, tasks and their ends.
#include <cmath>

#include "dialogue_fixture.hpp"
#include "saphira/base/archive.hpp"

namespace saphira::agent_interface {
namespace {

TEST_F(DialogueTest, AnUtteranceThatComesTwiceIsHeardOnce) {
  const Utterance utterance{{7, 1}, "Alice", "flakey go forward"};
  EXPECT_EQ(dialogue.hear(utterance, situation).goals.size(), 1u);
  EXPECT_TRUE(dialogue.hear(utterance, situation).goals.empty());
  Dialogue restarted{grammar()};
  restore(saved(dialogue), restarted);
  EXPECT_TRUE(restarted.hear(utterance, situation).goals.empty());
}

TEST_F(DialogueTest, TheReasonIsOfTheNewestGoalThatIsHeldUp) {
  EXPECT_EQ(said("Flakey, why are you standing?"), "I have nothing to do");
  situation.goals = {{"go_to", "console", v1::GOAL_FAILED, "the way is blocked"}};
  EXPECT_EQ(said("Flakey, why?"), "go_to for console failed: the way is blocked");
  situation.goals.push_back({"drive", "mcp", v1::GOAL_UNDERWAY, ""});
  EXPECT_EQ(said("Flakey, why?"), "drive for mcp is underway");
  situation.goals.insert(situation.goals.begin(),
                         {"explore", "", v1::GOAL_SUSPENDED, "drive is more important"});
  EXPECT_EQ(said("Flakey, why?"), "explore is suspended: drive is more important");
}

TEST_F(DialogueTest, TheReasonBeginsWithTheTaskAndItsOwner) {
  hear("Flakey, take the mail from EJ-231 to Alice");
  const std::uint64_t tag = last.goals.at(0).tag;
  situation.goals = {{"deliver", "", v1::GOAL_UNDERWAY, "", tag}};
  EXPECT_EQ(said("Flakey, why?"), "the delivery of the mail for Alice is underway");
  situation.goals[0].step = "through-door: passes a door or another opening";
  EXPECT_EQ(
      said("Flakey, why?", "Bob"),
      "the delivery of the mail for Alice is underway: the robot passes a door or another opening");
  situation.goals[0].step = "waits for a person";
  EXPECT_EQ(said("Flakey, why?"),
            "the delivery of the mail for Alice is underway: waits for a person");
  // The reason of the state goes before a note, and that before the step.
  situation.goals[0].note = "was begun anew at its first step";
  EXPECT_EQ(said("Flakey, why?"),
            "the delivery of the mail for Alice is underway: was begun anew at its first step");
  situation.goals[0].reason = "changed by its requester";
  EXPECT_EQ(said("Flakey, why?"),
            "the delivery of the mail for Alice is underway: changed by its requester");
  situation.goals[0] = {"deliver", "", v1::GOAL_SUSPENDED, "drive is more important", tag};
  EXPECT_EQ(said("Flakey, why?"),
            "the delivery of the mail for Alice is suspended: drive is more important");
}

TEST_F(DialogueTest, AfterAFailureAStopIsNotTheReason) {
  const std::string failed =
      "the delivery of the mail for Alice failed: nobody at EJ-231 gave the robot the mail";
  hear("Flakey, take the mail from EJ-231 to John");
  dialogue.ended({last.goals.at(0).tag, false, "nobody at EJ-231 gave the robot the mail"});
  situation.goals = {{"deliver", "", v1::GOAL_FAILED, "nobody at EJ-231 gave the robot the mail"}};
  EXPECT_EQ(said("Flakey, why?"), failed);
  hear("Flakey, stop", "Bob");
  const std::uint64_t stop = last.goals.at(0).tag;
  situation.goals.push_back({"stop", "", v1::GOAL_UNDERWAY, "", stop});
  EXPECT_EQ(said("Flakey, why?"), failed);
  dialogue.ended({stop, true, "the robot is at rest"});
  situation.goals.back() = {"stop", "", v1::GOAL_SUCCEEDED, "the robot is at rest"};
  EXPECT_EQ(said("Flakey, why?"), failed);
  // After a restart of the dialogue, too.
  Dialogue restarted{grammar()};
  EXPECT_EQ(restarted.hear({{9, 1}, "Alice", "Flakey, why?"}, situation).said.at(0).text,
            "deliver failed: nobody at EJ-231 gave the robot the mail");
  hear("Flakey, follow me", "Bob");
  situation.goals.push_back(
      {"follow-person", "", v1::GOAL_UNDERWAY, "waits for a person", last.goals.at(0).tag});
  EXPECT_EQ(said("Flakey, why?"), "the walk for Bob is underway: waits for a person");
  situation.goals.pop_back();
  hear("Flakey, turn left");
  dialogue.ended({last.goals.at(0).tag, true, "turned"});
  situation.goals.push_back({"turn_to", "", v1::GOAL_SUCCEEDED, "turned"});
  EXPECT_EQ(said("Flakey, why?"), "the turn for Alice is done: turned");
  hear("Flakey, stop");
  dialogue.ended({last.goals.at(0).tag, true, "at rest"});
  situation.goals = {{"stop", "", v1::GOAL_SUCCEEDED, "at rest"}};
  EXPECT_EQ(said("Flakey, why?"), "the stop for Alice is done: at rest");
}

TEST_F(DialogueTest, WhatTheRobotDoesIncludesTheGoalsOfOthers) {
  EXPECT_EQ(said("Flakey, what are you doing?"), "nothing that I was told");
  hear("Flakey, go to EJ-233");
  situation.goals = {{"go-to-place", "", v1::GOAL_SUSPENDED, ""},
                     {"turn_to", "mcp", v1::GOAL_SUCCEEDED, ""},
                     {"explore", "console", v1::GOAL_WAITING, ""},
                     {"drive", "mcp", v1::GOAL_UNDERWAY, ""}};
  EXPECT_EQ(said("Flakey, what are you doing?"),
            "for mcp: drive; I go to EJ-233; for console: explore, which is waiting");
}

TEST_F(DialogueTest, TheExamplesOfWhatItCanDoAreUnderstood) {
  std::string examples = said("Flakey, what can you do?");
  const std::string begin = "You can say, for example: ";
  ASSERT_TRUE(examples.starts_with(begin));
  examples = examples.substr(begin.size()) + "; ";
  const Grammar shipped = grammar();
  for (std::size_t end = 0; (end = examples.find("; ")) != std::string::npos;
       examples.erase(0, end + 2))
    EXPECT_EQ(shipped.understand("flakey " + examples.substr(0, end)).meanings.size(), 1u)
        << examples;
}

TEST_F(DialogueTest, StopStopsWhateverFollows) {
  hear("Flakey, go to EJ-233");
  const std::uint64_t first = last.goals.at(0).tag;
  EXPECT_EQ(said("Flakey, please stop going there!"), "I stop / I drop the way to EJ-233");
  EXPECT_EQ(last.canceled, std::vector{first});
  EXPECT_EQ(goals(), "stop");
  EXPECT_TRUE(dialogue.ended({first, false, "withdrawn"}).said.empty());
  EXPECT_EQ(said("Flakey, never stop"), "what?");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, AnUtteranceOfMoreThanAMinuteAgoIsNotActedOn) {
  situation.now = now + 60.1;
  EXPECT_EQ(said("Flakey, go forward"), "");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(last.note, "not acted on, since it is older than a minute: \"Flakey, go forward\"");
  situation.now = now + 59.9;
  EXPECT_EQ(said("Flakey, go forward"), "I go forward 1 m");
  EXPECT_EQ(last.note, "");
  situation.now = now + 60.1;
  now = 0.0;  // unknown
  EXPECT_EQ(said("Flakey, stop"), "I stop / I drop the move");
}

TEST_F(DialogueTest, AnActivityIsHeardWhileTheDialogueHasAGoal) {
  EXPECT_TRUE(dialogue.says("Is anybody here?", {3, 40}).said.empty());
  hear("Flakey, get the mail from John");
  const Dialogue::Outputs out = dialogue.says("Is anybody here?", {3, 41});
  ASSERT_EQ(out.said.size(), 1u);
  EXPECT_EQ(out.said[0].text, "Is anybody here?");
  EXPECT_EQ(out.said[0].answers, (UtteranceId{7, 1}));
  EXPECT_TRUE(out.changed);
  EXPECT_TRUE(dialogue.ended({last.goals.at(0).tag, true, "brought"}).changed);
  EXPECT_TRUE(dialogue.says("Is anybody here?", {3, 42}).said.empty());
}

TEST_F(DialogueTest, AGoalThatNoProgramTakesUpIsWithdrawnAndEndsItsSequence) {
  hear("Flakey, turn left and go forward");
  const std::uint64_t tag = last.goals.at(0).tag;
  EXPECT_TRUE(dialogue.without_status({tag}, 100.0).canceled.empty());
  EXPECT_TRUE(dialogue.without_status({tag}, 104.9).said.empty());
  const Dialogue::Outputs out = dialogue.without_status({tag}, 105.0);
  EXPECT_EQ(out.canceled, std::vector<std::uint64_t>{tag});
  ASSERT_EQ(out.said.size(), 1u);
  EXPECT_EQ(out.said[0].text,
            std::string("I could not: ") + kNotTakenUp + "; so the rest is not done");
  EXPECT_TRUE(out.goals.empty());
  EXPECT_TRUE(out.changed);
  EXPECT_TRUE(dialogue.without_status({}, 106.0).said.empty());
}

TEST_F(DialogueTest, AGoalWithAStatusIsTakenUpHoweverLongItLasts) {
  hear("Flakey, turn left");
  const std::uint64_t tag = last.goals.at(0).tag;
  EXPECT_TRUE(dialogue.without_status({tag}, 100.0).canceled.empty());
  EXPECT_TRUE(dialogue.without_status({}, 103.0).canceled.empty());  // it has a status
  // The time counts from the first look that finds it without one.
  EXPECT_TRUE(dialogue.without_status({tag}, 106.0).canceled.empty());
  EXPECT_EQ(dialogue.without_status({tag}, 111.0).canceled, std::vector<std::uint64_t>{tag});
}

TEST(Goals, ThePersonBehindTheWordsIsNamed) {
  WantedGoal goal;
  EXPECT_EQ(goal.requester(), "");
  goal.speaker = "Alice";
  EXPECT_EQ(goal.requester(), "Alice (by words)");
}

// The dialogue: questions of the robot, and the replies to them.

TEST_F(DialogueTest, RepliesAboutAPersonAreKept) {
  situation.asked_about = "answer";
  situation.asked_for = "Karen";
  EXPECT_EQ(said("she is in EJ-233", "John"), "thank you");
  EXPECT_EQ(claims(last.claims), "answer=EJ-233; place-of-karen=EJ-233");
  EXPECT_EQ(said("Flakey, where is Karen?"), "John said that karen is at EJ-233");
  EXPECT_EQ(dialogue.knowledge().all().at(0).time, now);
  hear("Flakey, Bob is in EJ-231");
  EXPECT_EQ(said("ask Bob", "John"), "thank you");
  EXPECT_EQ(last.claims.at(0).value, "bob");
  EXPECT_EQ(last.claims.at(1).list, std::vector<std::string>{"bob"});
  hear("no, sorry");
  EXPECT_EQ(last.claims.size(), 1u);
  // A finding of an activity replaces the sentence of a person.
  const Dialogue::Outputs out =
      dialogue.found({{Advice::Kind::person_at, "karen", "EJ-231", 0.2}}, now);
  ASSERT_EQ(out.claims.size(), 1u);
  EXPECT_EQ(out.claims[0].value, "EJ-231");
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "I found karen at EJ-231; John said that bob knows where karen is");
}

TEST_F(DialogueTest, SeveralMeaningsAreNamedInWords) {
  dialogue.use(
      Grammar("keyword: flakey\nno-names: is in\n"
              "person_at(person, place=this, owner) \"$person is at $place$owner\"\n"
              "  {person} is in {place} | {person} is in {owner}\n"
              "go_to(place) \"I go to $place\"\n  go {place}\n"
              "drive_to(place)\n  go {place}\nroll_to(place)\n  roll {place}\nrun_to(place)\n  "
              "roll {place}\n",
              "test"));
  EXPECT_EQ(said("flakey Karen is in Bob"),
            "what? That may mean \"karen is at bob\", or \"karen is at bob's office\"");
  EXPECT_EQ(said("flakey go EJ-231"), "what? That may mean several things");
  EXPECT_EQ(said("flakey roll EJ-231"), "what? That may mean several things");
}

// The dialogue: advice, and questions about it.

TEST_F(DialogueTest, WhatIsKnownIsAnsweredAndTakenBack) {
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, John usually knows where Karen is", "Bob");
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "Alice said that EJ-231 is karen's office; Bob said that john knows where karen is");
  const Dialogue::Outputs out = dialogue.forget(2);
  EXPECT_EQ(out.answer, (Answer{AnswerCode::done, "forgotten"}));
  EXPECT_EQ(out.claims.at(0).name, "knows-where-karen");
  EXPECT_EQ(out.claims.at(0).value, "");
  EXPECT_FALSE(dialogue.forget(2).changed);
  EXPECT_EQ(
      dialogue.forget(2).answer,
      (Answer{AnswerCode::refused, "nothing is known under 2 (saphira knows lists the facts)"}));
  EXPECT_EQ(said("Flakey, where are you?"), "I am in upper corridor");
}

TEST_F(DialogueTest, OnlyAWholeNumberForgetsAdvice) {
  hear("Flakey, EJ-231 is Karen's office");
  for (const double wrong : {1.7, 0.0, -1.0, 0.5, 1e18, std::nan(""), -HUGE_VAL}) {
    const Dialogue::Outputs out = dialogue.forget(wrong);
    EXPECT_FALSE(out.changed) << wrong;
    EXPECT_EQ(out.answer.code, AnswerCode::bad_argument) << wrong;
  }
  EXPECT_EQ(dialogue.forget(1.7).answer.text,
            "argument \"number\": expected a whole number from 1 on (saphira knows lists them), "
            "found 1.7");
  EXPECT_EQ(dialogue.forget(1.0).answer, (Answer{AnswerCode::done, "forgotten"}));
}

TEST_F(DialogueTest, AFindIsLearnedOnceAndNotAgainAfterARestart) {
  constexpr auto kAt = Advice::Kind::person_at;
  const auto finds = [](std::optional<double> karen, std::optional<double> john) {
    return std::vector<Find>{{kAt, "karen", "EJ-231", karen}, {kAt, "john", "EJ-231", john}};
  };
  const auto newest = [&] { return dialogue.knowledge().all().back(); };
  hear("Flakey, Karen is in EJ-233");
  // The first finds of a service are as old as its memory.
  dialogue.found(finds(30.0, 40.0), now);
  EXPECT_EQ(dialogue.knowledge().place_of("karen"), "EJ-233");
  EXPECT_EQ(newest().about, "john");
  EXPECT_EQ(newest().time, now - 40.0);
  EXPECT_FALSE(dialogue.found(finds(31.0, 41.0), now).changed);
  EXPECT_TRUE(dialogue.found(finds(0.3, 42.0), now).changed);
  EXPECT_EQ(newest().value, "EJ-231");
  EXPECT_EQ(newest().about, "karen");
  EXPECT_EQ(newest().time, now - 0.3);
  // The claim that follows covers it, until intentions begins anew and has not heard the claim yet.
  EXPECT_FALSE(dialogue.found({}, now).changed);
  EXPECT_FALSE(dialogue.found(finds(60.0, 100.0), now + 60.0).changed);
  EXPECT_FALSE(dialogue.found({}, now).changed);
  EXPECT_FALSE(dialogue.found(finds(std::nullopt, std::nullopt), now + 60.0).changed);
  // It was found there again.
  EXPECT_TRUE(dialogue.found(finds(0.1, std::nullopt), now + 90.0).changed);
  EXPECT_EQ(newest().time, now + 90.0 - 0.1);
  hear("Flakey, Karen left");
  EXPECT_FALSE(dialogue.found({}, now).changed);
  EXPECT_FALSE(dialogue.found(finds(20.0, 100.0), now).changed);
}

TEST_F(DialogueTest, ALoadThatIsTakenOffIsGoneUntilTheRobotGetsItAnew) {
  const std::string thing = "the report";
  situation.carried = {{thing, "EJ-231"}};
  const std::vector<Find> aboard{{Advice::Kind::has, thing, kRobot, 50.0}};
  EXPECT_FALSE(dialogue.found(aboard, now).changed);
  EXPECT_EQ(said("Flakey, I took the report"),
            "I know now that alice has the report; so I no longer carry it");
  EXPECT_EQ(claims(last.claims), "carries-the report=nil");
  // The belief is heard again before the claim.
  EXPECT_FALSE(dialogue.found({}, now).changed);
  EXPECT_FALSE(dialogue.found(aboard, now).changed);
  EXPECT_EQ(claims(dialogue.claims()), "carries-the report=nil");
  const Dialogue::Outputs out = dialogue.found({{Advice::Kind::has, thing, kRobot, 0.1}}, now);
  EXPECT_EQ(claims(out.claims), "carries-the report=");
  EXPECT_EQ(claims(dialogue.claims()), "");
}

// Whose task it is, errands, and ways of several steps.

TEST(Beliefs, TheOpenQuestionAndTheFindsAreHeeded) {
  Situation situation;
  situation.asked_about = "of before";
  v1::BeliefSet set{};
  set.stamp.cycle = 1000;
  for (const auto& [name, value, said_by, since] :
       std::vector<std::tuple<std::string, std::string, std::string, std::uint64_t>>{
           {"asking-about", "\"given\"", "deliver", 970},
           {"asking-for", "nil", "deliver", 970},
           {"place-of-karen", "\"EJ-231\"", "find-person", 300},
           {"place-of-john", "nil", "find-person", 290},
           {"place-of-ann", "\"EJ-235\"", "find-person", 0},
           {"place-of-bob", "\"EJ-233\"", "dialogue", 280},
           {"carries-the report", "\"EJ-233\"", "deliver", 280},
           {"carries-the mail", "nil", "deliver", 280},
           {"corridor-of-ann", "\"EJ-1\"", "find-person", 270}})
    set.beliefs.push_back({.name = name, .value = value, .said_by = said_by, .since = since});
  const std::vector<Find> finds = heed(set, 2.0, situation);
  EXPECT_EQ(situation.asked_about, "given");
  EXPECT_EQ(situation.asked_for, "");
  EXPECT_EQ(finds, (std::vector<Find>{{Advice::Kind::person_at, "karen", "EJ-231", 72},
                                      {Advice::Kind::person_at, "ann", "EJ-235", {}},
                                      {Advice::Kind::has, "the report", kRobot, 74}}));
  ASSERT_EQ(situation.carried.size(), 1U);
  EXPECT_EQ(situation.carried[0].first, "the report");
  EXPECT_EQ(situation.carried[0].second, "EJ-233");
  heed(v1::BeliefSet{}, 0.0, situation);
  EXPECT_EQ(situation.asked_about, "");
}

TEST(Claims, AValueIsWrittenInTheLanguageOfActivities) {
  EXPECT_EQ(literal(Claimed{"place-of-karen", "karen's \"office\"", ""}), "\"karen's  office \"");
  EXPECT_EQ(literal(Claimed{"knows-where-karen", "john, bob", "", {"john", "bob"}}),
            "(\"john\" \"bob\")");
  EXPECT_EQ(literal(Claimed{"place-of-karen", "nil", "", {}, true}), "nil");
}

TEST_F(DialogueTest, AProgramThatLooksForAPersonGetsTheirPlace) {
  EXPECT_EQ(dialogue.place_of("karen"),
            (Answer{AnswerCode::refused, "nobody has told me where karen is"}));
  hear("Flakey, EJ-231 is Karen's office");
  EXPECT_EQ(dialogue.place_of("karen"), (Answer{AnswerCode::done, "", {text("place", "EJ-231")}}));
}

// Names, and the robot's questions back.

// The dialogue: places, and those that it keeps out of.

TEST_F(DialogueTest, WhatIsNamelessOnTheMapGetsAName) {
  EXPECT_EQ(said("Flakey, this is the kitchen"), "on my map this is EJ-231");
  EXPECT_EQ(said("Flakey, this corridor is the J-wing"), "on my map this is upper corridor");
  situation.pose_in_map = Pose{3.0, 0.5, 0.0};
  EXPECT_EQ(said("Flakey, this is the Kitchen"), "I put it on my map: this is Kitchen");
  ASSERT_EQ(last.namings.size(), 1u);
  EXPECT_EQ(last.namings[0].id, 1235u);
  EXPECT_EQ(last.namings[0].name, "Kitchen");
  EXPECT_EQ(said("Flakey, this room is called EJ-233"), "my map has EJ-233 at another place");
  EXPECT_TRUE(last.namings.empty());
  for (maps::Feature& feature : situation.map.features)
    if (feature.type == lps::PointType::corridor)
      feature.name.clear();
  EXPECT_EQ(said("Flakey, this corridor is the J-wing"), "I put it on my map: this is J-wing");
  EXPECT_EQ(last.namings.at(0).type, lps::PointType::corridor);
}

TEST(Naming, ANamedDoorwayIsPutOnTheMapAsItIs) {
  maps::Feature door;
  door.id = 12;
  door.type = lps::PointType::door;
  door.pose_in_map = {1.0, 2.0, 0.5};
  door.width = 0.9;
  door.name = "bob's office";
  door.learned = true;
  const Request request = put_on_map(door);
  EXPECT_EQ(describe(request),
            "put id=12 type=\"DOOR\" position=(1, 2, 0.5) length=0 width=0.9 name=\"bob's office\" "
            "learned=yes");
  EXPECT_EQ(request.arguments.at(2).frame, Frame::map);
}

}  // namespace
}  // namespace saphira::agent_interface
