// The dialogue: orders, tasks and their ends.
#include <numbers>

#include "dialogue_fixture.hpp"
#include "saphira/base/archive.hpp"

namespace saphira::agent_interface {
namespace {

TEST_F(DialogueTest, ACommandIsParaphrasedAndThenCarriedOut) {
  EXPECT_EQ(said("Flakey, go forward 2 meters"), "I go forward 2 m");
  EXPECT_EQ(goals(), "go_to position=(2, 0, 0)");
  EXPECT_FALSE(last.said.at(0).end);
  const Dialogue::Outputs end = dialogue.ended({last.goals.at(0).tag, true, "arrived"});
  EXPECT_EQ(end.said.at(0).text, "done: arrived");
  EXPECT_EQ(end.said.at(0).answers, (UtteranceId{7, 1}));
  EXPECT_TRUE(end.said.at(0).end);
}

TEST_F(DialogueTest, WhatIsNotUnderstoodIsAskedBackAndNotActedOn) {
  EXPECT_EQ(said("Flakey, go upstairs"), "what?");
  EXPECT_EQ(said("go forward"), "");
  Utterance mumbled{{7, 99}, "Alice", "flakey go forward", 0.3};
  const Dialogue::Outputs out = dialogue.hear(mumbled, situation);
  EXPECT_EQ(out.said.at(0).text, "what?");
  EXPECT_TRUE(out.goals.empty());
  EXPECT_EQ(said("Flakey, go to EJ-232"),
            "I know no place or person called ej-232; do you mean EJ-231?");
  EXPECT_EQ(said("Flakey, go forward 200 meters"), "I go up to 20 m at a time");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, AStopNeedsNeitherTheKeywordNorConfidence) {
  for (const char* const sentence : {"stop", "Hey, stop!", "Flakey, a child! Stop!"}) {
    EXPECT_EQ(said("Flakey, go forward 2 meters"), "I go forward 2 m") << sentence;
    const std::uint64_t moves = last.goals.at(0).tag;
    const Dialogue::Outputs out = dialogue.hear({{8, ++number}, "Bob", sentence, 0.1}, situation);
    ASSERT_EQ(out.goals.size(), 1U) << sentence;
    EXPECT_EQ(out.goals.at(0).functor, "stop");
    EXPECT_EQ(out.canceled, std::vector{moves}) << sentence;
    dialogue.ended({out.goals.at(0).tag, true, ""});
  }
  EXPECT_EQ(said("don't stop"), "");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, WordsOfWhichARecognizerIsNotCertainAreReadBackBeforeItActs) {
  const auto heard = [&](const std::string& text, double confidence) {
    last = dialogue.hear({{7, ++number}, "Alice", text, confidence}, situation);
    return last.said.empty() ? "" : last.said.at(0).text;
  };
  EXPECT_EQ(heard("flakey turn left", 0.79), "did you say \"flakey turn left\"?");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(heard("yes", 0.79), "what?");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(heard("yes", 0.8), "I turn 90 degrees to the left");
  EXPECT_EQ(last.goals.size(), 1U);
  heard("flakey turn right", 0.6);
  EXPECT_EQ(heard("no", 1.0), "then I leave it");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(heard("flakey turn left", 0.49), "what?");
  heard("flakey turn right", 0.8);
  EXPECT_EQ(last.goals.size(), 1U);
}

TEST_F(DialogueTest, ANumberMayHaveItsUnit) {
  EXPECT_EQ(said("Flakey, go forward 2m"), "I go forward 2 m");
  EXPECT_EQ(goals(), "go_to position=(2, 0, 0)");
  EXPECT_EQ(said("Flakey, go forward 50cm"), "I drop the move / I go forward 50 cm");
  EXPECT_EQ(goals(), "go_to position=(0.5, 0, 0)");
  EXPECT_NE(said("Flakey, turn left 45deg").find("I turn 45 degrees to the left"),
            std::string::npos);
}

TEST_F(DialogueTest, ARefusalSaysSo) {
  for (const char* const sentence :
       {"Flakey, go upstairs", "Flakey, go to EJ-232", "Flakey, go forward 200 meters",
        "Flakey, go forward 0 meters", "Flakey, turn left 300 degrees", "Flakey, go home"}) {
    hear(sentence);
    ASSERT_EQ(last.said.size(), 1U) << sentence;
    EXPECT_TRUE(last.said.at(0).refused && last.said.at(0).end) << last.said.at(0).text;
  }
  for (const char* const sentence :
       {"Flakey, where are you", "Flakey, what do you know", "Flakey, what are you doing",
        "Flakey, EJ-231 is Karen's office", "Flakey, go forward 2 meters"}) {
    hear(sentence);
    ASSERT_FALSE(last.said.empty()) << sentence;
    for (const Said& one : last.said)
      EXPECT_FALSE(one.refused) << one.text;
  }
  EXPECT_FALSE(dialogue.ended({last.goals.at(0).tag, false, "blocked"}).said.at(0).refused);
  // A question to people waits for their reply.
  said("Flakey, EJ-233 is Karen's office");
  EXPECT_TRUE(last.said.at(0).refused) << last.said.at(0).text;
}

TEST_F(DialogueTest, AnUtteranceThatComesTwiceIsHeardOnce) {
  const Utterance utterance{{7, 1}, "Alice", "flakey go forward"};
  EXPECT_EQ(dialogue.hear(utterance, situation).goals.size(), 1u);
  EXPECT_TRUE(dialogue.hear(utterance, situation).goals.empty());
  Dialogue restarted{grammar()};
  restore(saved(dialogue), restarted);
  EXPECT_TRUE(restarted.hear(utterance, situation).goals.empty());
}

TEST_F(DialogueTest, TheReasonIsOfTheNewestGoalThatIsHeldUp) {
  using State = KnownGoal::State;
  EXPECT_EQ(said("Flakey, why are you standing?"), "I have nothing to do");
  situation.goals = {{"go_to", "console", State::failed, "the way is blocked"}};
  EXPECT_EQ(said("Flakey, why?"), "go_to of console failed: the way is blocked");
  situation.goals.push_back({"drive", "mcp", State::underway, ""});
  EXPECT_EQ(said("Flakey, why?"), "drive of mcp is underway");
  situation.goals.insert(situation.goals.begin(),
                         {"explore", "", State::suspended, "drive is more important"});
  EXPECT_EQ(said("Flakey, why?"), "explore is suspended: drive is more important");
}

TEST_F(DialogueTest, TheReasonBeginsWithTheTaskAndItsOwner) {
  using State = KnownGoal::State;
  hear("Flakey, take the mail from EJ-231 to Alice");
  const std::uint64_t tag = last.goals.at(0).tag;
  situation.goals = {{"deliver", "", State::underway, "", tag}};
  EXPECT_EQ(said("Flakey, why?"), "the mail for Alice is underway");
  situation.goals[0].step = "through-door: passes a door or another opening";
  EXPECT_EQ(said("Flakey, why?", "Bob"),
            "the mail for Alice is underway: the robot passes a door or another opening");
  situation.goals[0].step = "waits for a person";
  EXPECT_EQ(said("Flakey, why?"), "the mail for Alice is underway: waits for a person");
  // The reason of the state goes before a note, and that before the step.
  situation.goals[0].note = "was begun anew at its first step";
  EXPECT_EQ(said("Flakey, why?"),
            "the mail for Alice is underway: was begun anew at its first step");
  situation.goals[0].reason = "changed by its requester";
  EXPECT_EQ(said("Flakey, why?"), "the mail for Alice is underway: changed by its requester");
  situation.goals[0] = {"deliver", "", State::suspended, "drive is more important", tag};
  EXPECT_EQ(said("Flakey, why?"), "the mail for Alice is suspended: drive is more important");
}

TEST_F(DialogueTest, AfterAFailureAStopIsNotTheReason) {
  using State = KnownGoal::State;
  const std::string failed = "the mail for Alice failed: nobody at EJ-231 gave the robot the mail";
  hear("Flakey, take the mail from EJ-231 to John");
  dialogue.ended({last.goals.at(0).tag, false, "nobody at EJ-231 gave the robot the mail"});
  situation.goals = {{"deliver", "", State::failed, "nobody at EJ-231 gave the robot the mail"}};
  EXPECT_EQ(said("Flakey, why?"), failed);
  hear("Flakey, stop", "Bob");
  const std::uint64_t stop = last.goals.at(0).tag;
  situation.goals.push_back({"stop", "", State::underway, "", stop});
  EXPECT_EQ(said("Flakey, why?"), failed);
  dialogue.ended({stop, true, "the robot is at rest"});
  situation.goals.back() = {"stop", "", State::over, "the robot is at rest"};
  EXPECT_EQ(said("Flakey, why?"), failed);
  // After a restart of the dialogue, too.
  Dialogue restarted{grammar()};
  EXPECT_EQ(restarted.hear({{9, 1}, "Alice", "Flakey, why?"}, situation).said.at(0).text,
            "deliver failed: nobody at EJ-231 gave the robot the mail");
  hear("Flakey, follow me", "Bob");
  situation.goals.push_back(
      {"follow-person", "", State::underway, "waits for a person", last.goals.at(0).tag});
  EXPECT_EQ(said("Flakey, why?"), "the walk for Bob is underway: waits for a person");
  situation.goals.pop_back();
  hear("Flakey, turn left");
  dialogue.ended({last.goals.at(0).tag, true, "turned"});
  situation.goals.push_back({"turn_to", "", State::over, "turned"});
  EXPECT_EQ(said("Flakey, why?"), "the turn for Alice is done: turned");
  hear("Flakey, stop");
  dialogue.ended({last.goals.at(0).tag, true, "at rest"});
  situation.goals = {{"stop", "", State::over, "at rest"}};
  EXPECT_EQ(said("Flakey, why?"), "the stop for Alice is done: at rest");
}

TEST_F(DialogueTest, WhatTheRobotDoesIncludesTheGoalsOfOthers) {
  EXPECT_EQ(said("Flakey, what are you doing?"), "nothing that I was told");
  hear("Flakey, go to EJ-233");
  situation.goals = {{"go-to-place", "", KnownGoal::State::suspended, ""},
                     {"turn_to", "mcp", KnownGoal::State::over, ""},
                     {"explore", "console", KnownGoal::State::waiting, ""},
                     {"drive", "mcp", KnownGoal::State::underway, ""}};
  EXPECT_EQ(said("Flakey, what are you doing?"),
            "I go to EJ-233; for console: explore, which is waiting; for mcp: drive");
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
  EXPECT_EQ(goals(), "stop ");
  EXPECT_TRUE(dialogue.ended({first, false, "withdrawn"}).said.empty());
  EXPECT_EQ(said("Flakey, never stop"), "what?");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, ThingsAreBroughtToWhoIsNearTheirOwnRoom) {
  hear("Flakey, this is Alice's office");
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(goals(),
            "deliver object=\"the report\" from=\"karen\" to=\"EJ-231\" receiver=\"alice\"");
  situation.pose_in_map = Pose{9.5, 1.0, 0.0};
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(
      goals(),
      "deliver object=\"the report\" from=\"karen\" to=\"upper corridor\" receiver=\"alice\"");
  situation.pose_in_map = Pose{7.0, 4.0, 0.0};
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(goals(),
            "deliver object=\"the report\" from=\"karen\" to=\"EJ-233\" receiver=\"alice\"");
}

TEST_F(DialogueTest, WhoeverTakesSomethingIsNamed) {
  situation.asked_about = "taken";
  EXPECT_EQ(said("thank you", "Karen"), "thank you");
  ASSERT_EQ(last.claims.size(), 1U);
  EXPECT_EQ(last.claims[0].value, "karen");
  hear("thank you", "");
  EXPECT_EQ(last.claims.at(0).value, "yes");
  hear("alice has it", "Karen");
  EXPECT_EQ(last.claims.at(0).value, "alice");
  hear("no", "Karen");
  EXPECT_EQ(last.claims.at(0).value, "no");
  situation.asked_about = "given";
  hear("here you are", "Karen");
  EXPECT_EQ(last.claims.at(0).value, "yes");
}

TEST_F(DialogueTest, AReplyThatIsNoAnswerIsTold) {
  situation.asked_about = "answer";
  EXPECT_EQ(said("what do you want?", "Bob"), "");
  EXPECT_EQ(claims(), "not-understood=Bob: what do you want?");
  situation.asked_about.clear();
  hear("what do you want?", "Bob");
  EXPECT_TRUE(last.claims.empty()) << "people talk to each other";
}

TEST_F(DialogueTest, WhatIsOnItsBackIsNotForgotten) {
  situation.carried = {{"the report", "EJ-231"}};
  EXPECT_EQ(said("Flakey, where is the report?"), "I have it: I was to bring it to EJ-231");
  EXPECT_EQ(said("Flakey, who has the report?"), "I have it: I was to bring it to EJ-231");
  EXPECT_EQ(said("Flakey, where is the mail?"), "nobody has told me where mail is");
  hear("Flakey, take the report to John");
  EXPECT_EQ(said("Flakey, stop"), "I stop / I drop the report / I still have the report");
}

TEST_F(DialogueTest, TasksAreActivitiesWithPlacesOrPersons) {
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(
      goals(),
      "deliver object=\"the report\" from=\"karen\" to=\"upper corridor\" receiver=\"alice\"");
  hear("Flakey, take the mail from EJ-231 to John");
  EXPECT_EQ(goals(), "deliver object=\"the mail\" from=\"EJ-231\" to=\"john\"");
  hear("Flakey, this is Karen's office");
  hear("Flakey, go to Karen's office");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\" whose=\"karen\"");
  EXPECT_EQ(said("Flakey, go to Bob's office"), "nobody has told me where bob's office is");
  hear("Flakey, look at me");
  EXPECT_EQ(dialogue.ended({last.goals.at(0).tag, false, "nobody was seen"}).said.at(0).text,
            "I could not: nobody was seen");
}

TEST_F(DialogueTest, AWayIsNothingToCarry) {
  EXPECT_EQ(said("Flakey, take the upper corridor to EJ-233"),
            "I find the way myself: say \"go to\" and the place");
  EXPECT_EQ(goals(), "");
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

TEST_F(DialogueTest, ItLooksWithItsHeadOrTurns) {
  EXPECT_EQ(said("Flakey, look left"), "I look left");
  EXPECT_EQ(last.goals.at(0).functor, "turn_to") << "its cameras are fixed";
  EXPECT_EQ(said("Flakey, look ahead"), "my cameras always look ahead");
  EXPECT_TRUE(last.goals.empty());
  situation.turns_cameras = true;
  EXPECT_EQ(said("Flakey, look behind you"), "I drop the look / I look back");
  EXPECT_EQ(last.goals.at(0).functor, "look");
  EXPECT_DOUBLE_EQ(last.goals.at(0).arguments.at(0).number, std::numbers::pi);
  EXPECT_EQ(said("Flakey, look to the right"), "I drop the look / I look right");
  EXPECT_DOUBLE_EQ(last.goals.at(0).arguments.at(0).number, -std::numbers::pi / 2.0);
}

TEST_F(DialogueTest, WhatIsGivenToTheRobotHereIsBrought) {
  EXPECT_EQ(said("Flakey, take this report to Karen"), "I take the report to karen");
  EXPECT_EQ(goals(), "deliver object=\"the report\" to=\"karen\" sender=\"Alice\"");
  EXPECT_TRUE(last.goals.at(0).lasting);
  EXPECT_EQ(said("Flakey, take the mail to Karen's office"),
            "nobody has told me where karen's office is");
  hear("Flakey, EJ-231 is Karen's office");
  EXPECT_EQ(said("Flakey, take the mail to Karen's office"),
            "I drop the report / I take the mail to EJ-231");
  EXPECT_EQ(goals(), "deliver object=\"the mail\" to=\"EJ-231\" sender=\"Alice\"");
}

TEST_F(DialogueTest, EachSentenceOfAMeaningIsAnnounced) {
  EXPECT_EQ(said("Flakey, go forward a bit"), "I go forward 0.3 m");
  EXPECT_EQ(said("Flakey, take this to Karen"), "I drop the move / I take the parcel to karen");
}

TEST_F(DialogueTest, MessagesAndQuestionsGoToAPersonAndTheirAnswerComesBack) {
  EXPECT_EQ(said("Flakey, tell Karen that John's meeting isn't at five."),
            "I tell karen: John's meeting isn't at five");
  EXPECT_EQ(goals(),
            "tell person=\"karen\" message=\"John's meeting isn't at five\" sender=\"Alice\" "
            "back=\"upper corridor\"");
  EXPECT_EQ(said("Flakey, ask John where Karen is"),
            "I drop the message to karen / I ask john where karen is");
  EXPECT_EQ(goals(),
            "inquire person=\"john\" question=\"where Karen is\" sender=\"Alice\" "
            "back=\"upper corridor\"");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
  situation.pose_in_map.reset();
  hear("Flakey, ask Karen if she has the report");
  EXPECT_EQ(goals(),
            "inquire person=\"karen\" question=\"if she has the report\" sender=\"Alice\" "
            "back=\"\"");
  situation.asked_about = "answer";
  hear("Flakey, EJ-233 is John's office");
  EXPECT_EQ(said("ask John", "Carol"), "thank you");
  EXPECT_EQ(last.claims.at(0).value, "john");
}

TEST_F(DialogueTest, StepsAreDoneOneAfterAnotherOrNotAtAll) {
  EXPECT_EQ(said("Flakey, go to EJ-231 and then go to the attic"),
            "I know no place or person called attic, but EJ-231, EJ-233, upper corridor. Which "
            "one, or where is attic?");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(said("Flakey, go to EJ-233 and wait there"), "I go to EJ-233, and then I wait there");
  const Dialogue::Outputs there = dialogue.ended({last.goals.at(0).tag, true, "arrived"});
  EXPECT_EQ(there.goals.at(0).functor, "pause");
  EXPECT_EQ(said("Flakey, explore", "Bob"), "I am waiting for Alice. Shall I drop that?");
}

TEST_F(DialogueTest, ItComesBackToWhereItsTaskBegan) {
  EXPECT_EQ(said("Flakey, come back"),
            "I do not know where that is: my map has no place called home or start");
  EXPECT_EQ(said("Flakey, go home"),
            "I do not know where that is: my map has no place called home or start");
  hear("Flakey, go to EJ-233");
  situation.pose_in_map = Pose{7.0, 4.0, 0.0};
  dialogue.ended({last.goals.at(0).tag, true, "arrived"});
  EXPECT_EQ(said("Flakey, come back"), "I go back to upper corridor");
  EXPECT_EQ(goals(), "come-back place=\"upper corridor\" spot=(3.5, 1.2, 0)");
  dialogue.ended({last.goals.at(0).tag, true, "arrived"});
  EXPECT_EQ(said("Flakey, go to EJ-231 and come back"),
            "I go to EJ-231, and then I go back to EJ-233");
  hear("Flakey, stop");
  situation.map = maps::parse_map(std::string(kMap) + "POS (90) 1000, 1000, 0 \"start\"\n", "map");
  EXPECT_EQ(said("Flakey, go home"), "I go home, to start");
  EXPECT_EQ(goals(), "go-to-place place=\"start\"");
}

TEST_F(DialogueTest, ItShowsTheWayWaitsAndPatrols) {
  hear("Flakey, EJ-231 is Karen's office");
  EXPECT_EQ(said("Flakey, show me Karen's office"), "I go to EJ-231 slowly; please come with me");
  EXPECT_EQ(goals(), "guide place=\"EJ-231\"");
  EXPECT_EQ(said("Flakey, wait five minutes", "Bob"),
            "I wait 5 minutes, and then I go on with the way to EJ-231 for Alice");
  EXPECT_EQ(goals(), "pause seconds=300");
  EXPECT_EQ(last.goals.at(0).priority, 1);
  EXPECT_EQ(said("Flakey, wait 500 minutes", "Bob"), "I wait for up to an hour");
  EXPECT_EQ(said("Flakey, take me to the attic"), kNoAttic);
  EXPECT_EQ(said("Flakey, patrol"),
            "I drop the way to EJ-231 / I drop the wait for Bob: Alice said \"Flakey, patrol\" / I "
            "patrol this corridor");
  EXPECT_EQ(goals(), "patrol ");
  EXPECT_EQ(said("Flakey, turn left 0 degrees"), "that is no turn");
  EXPECT_EQ(said("Flakey, go forward 0 meters"), "that is no way to go");
  EXPECT_EQ(said("Flakey, go forward 0 cm"), "that is no way to go");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(said("Flakey, go to the nearest door"),
            "the nearest door with a name is that of EJ-231: say go to EJ-231");
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

}  // namespace
}  // namespace saphira::agent_interface
