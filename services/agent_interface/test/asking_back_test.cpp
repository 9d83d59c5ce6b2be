// The dialogue: questions of the robot, and the replies to them.
#include "dialogue_fixture.hpp"

namespace saphira::agent_interface {
namespace {

TEST_F(DialogueTest, AContradictionIsAskedBack) {
  hear("Flakey, EJ-231 is Karen's office");
  EXPECT_EQ(said("Flakey, EJ-233 is Karen's office", "Bob"),
            "Alice told me that EJ-231 is karen's office. Is it now EJ-233?");
  EXPECT_EQ(dialogue.knowledge().place_of("karen"), "EJ-231");
  EXPECT_EQ(said("yes", "Carol"), "");
  EXPECT_EQ(said("yes", "Bob"), "I know now that EJ-233 is karen's office");
  EXPECT_EQ(dialogue.knowledge().place_of("karen"), "EJ-233");
  hear("Flakey, EJ-231 is Karen's office");
  EXPECT_EQ(said("no"), "then I leave it as it is");
  EXPECT_EQ(dialogue.knowledge().place_of("karen"), "EJ-233");
}

TEST_F(DialogueTest, ADoubtIsItsOwnSpeakersAndEndsWithTheirNextSentenceOrInTime) {
  const std::string doubt = "Alice told me that EJ-231 is karen's office. Is it now EJ-233?";
  hear("Flakey, EJ-231 is Karen's office");
  situation.asked_about = "given";
  EXPECT_EQ(said("Flakey, EJ-233 is Karen's office", "Bob"), doubt);
  EXPECT_EQ(said("yes", "John"), "thank you");
  EXPECT_EQ(claims(), "given=yes");
  // Thanks are for the task. They end the doubt.
  EXPECT_EQ(said("here you are", "Bob"), "thank you");
  EXPECT_EQ(last.claims.at(0).name, "given");
  EXPECT_EQ(said("yes", "Bob"), "thank you");
  EXPECT_EQ(dialogue.knowledge().place_of("karen"), "EJ-231");
  situation.asked_about.clear();
  EXPECT_EQ(said("Flakey, EJ-233 is Karen's office", "Bob"), doubt);
  EXPECT_EQ(said("good morning", "Bob"), "");
  EXPECT_EQ(said("yes", "Bob"), "");
  EXPECT_EQ(said("Flakey, EJ-233 is Karen's office", "Bob"), doubt);
  now += 21.0;
  EXPECT_EQ(said("yes", "Bob"), "");
  EXPECT_EQ(said("Flakey, EJ-233 is Karen's office", "Bob"), doubt);
  now += 19.0;
  EXPECT_EQ(said("of course not", "Alice"), "");
  EXPECT_EQ(said("yes", "Bob"), "I know now that EJ-233 is karen's office");
}

TEST_F(DialogueTest, RepliesAreClaimedAsWhatWasAskedFor) {
  EXPECT_EQ(said("in EJ-233", "John"), "");
  situation.asked_about = "answer";
  EXPECT_EQ(said("she is in EJ-233", "John"), "thank you");
  EXPECT_EQ(claims(), "answer=EJ-233");
  hear("no, sorry");
  EXPECT_EQ(last.claims.at(0).value, "no");
  EXPECT_EQ(said("good morning"), "");
  EXPECT_EQ(said("ask Sam"), "nobody has told me where sam is");
  EXPECT_TRUE(last.claims.empty());
}

TEST_F(DialogueTest, RepliesAboutAPersonAreKept) {
  situation.asked_about = "answer";
  situation.asked_for = "Karen";
  EXPECT_EQ(said("she is in EJ-233", "John"), "thank you");
  EXPECT_EQ(claims(), "answer=EJ-233; place-of-karen=EJ-233");
  EXPECT_EQ(said("Flakey, where is Karen?"), "John said that karen is at EJ-233");
  EXPECT_EQ(dialogue.knowledge().all().at(0).time, now);
  hear("Flakey, Bob is in EJ-231");
  EXPECT_EQ(said("ask Bob", "John"), "thank you");
  EXPECT_EQ(last.claims.at(0).value, "bob");
  EXPECT_EQ(last.claims.at(1).list, std::vector<std::string>{"bob"});
  hear("no, sorry");
  EXPECT_EQ(last.claims.size(), 1u);
  // What an activity finds takes the place of what was said.
  dialogue.found({}, now);
  const Dialogue::Outputs out = dialogue.found({{"karen", "EJ-231", 70}}, now);
  ASSERT_EQ(out.claims.size(), 1u);
  EXPECT_EQ(out.claims[0].value, "EJ-231");
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "I found karen at EJ-231; John said that bob knows where karen is");
}

TEST_F(DialogueTest, AReplyAboutAnotherPersonIsNoAnswer) {
  situation.asked_about = "answer";
  situation.asked_for = "john";
  EXPECT_EQ(said("Alice is in EJ-233", "Bob"),
            "I know now that alice is at EJ-233, and still ask for john");
  EXPECT_EQ(claims(), "place-of-alice=EJ-233");
  EXPECT_EQ(said("John is in EJ-231", "Bob"), "thank you");
  EXPECT_EQ(claims(), "answer=EJ-231; place-of-john=EJ-231");
}

TEST_F(DialogueTest, WithTheKeywordAFactIsAFactAndMayAnswerTheQuestion) {
  situation.asked_about = "answer";
  situation.asked_for = "john";
  EXPECT_EQ(said("Flakey, Karen is in EJ-231"), "I know now that karen is at EJ-231");
  EXPECT_EQ(claims(), "place-of-karen=EJ-231");
  EXPECT_EQ(said("Flakey, John is in EJ-233"), "I know now that john is at EJ-233");
  EXPECT_EQ(claims(), "place-of-john=EJ-233; answer=EJ-233");
  EXPECT_EQ(said("Flakey, Karen knows where John is"), "I know now that karen knows where john is");
  EXPECT_EQ(last.claims.at(1).value, "karen");
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

/// Of two meanings of one sentence, the speaker chooses.
TEST_F(DialogueTest, OneOfSeveralMeaningsIsChosenByItsNumberOrItsWords) {
  std::string both = read_file(test::source("config/grammars/flakey.grammar"));
  both += "\ntyped turn(direction=left, degrees=90)\n  swerve\n";
  both += "typed turn(direction=right, degrees=90)\n  swerve\n";
  dialogue.use(Grammar(both, "test"));
  const std::string asks =
      "what? That may mean \"I turn 90 degrees to the left\", or \"I turn 90 degrees to the "
      "right\"";
  EXPECT_EQ(said("the second"), "");
  EXPECT_EQ(said("Flakey, swerve"), asks);
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(said("the second", "Bob"), "") << "a word of somebody else";
  EXPECT_EQ(said("the third"), "");
  EXPECT_EQ(said("the second"), "") << "another sentence has ended the question";
  EXPECT_EQ(said("Flakey, swerve"), asks);
  EXPECT_EQ(said("yes"), "which one?");
  EXPECT_EQ(said("the second one please"), "I turn 90 degrees to the right");
  EXPECT_EQ(last.goals.size(), 1u);
  dialogue.ended({last.goals.at(0).tag, true, "turned"});
  EXPECT_EQ(said("the second"), "") << "nothing is asked any more";
  EXPECT_EQ(said("Flakey, swerve"), asks);
  EXPECT_EQ(said("Flakey, I meant the first"), "I turn 90 degrees to the left");
  dialogue.ended({last.goals.at(0).tag, true, "turned"});
  EXPECT_EQ(said("Flakey, swerve"), asks);
  EXPECT_EQ(said("I turn 90 degrees to the left"), "I turn 90 degrees to the left");
  dialogue.ended({last.goals.at(0).tag, true, "turned"});
  EXPECT_EQ(said("Flakey, swerve"), asks);
  EXPECT_EQ(said("neither"), "then I leave it");
  EXPECT_EQ(said("Flakey, swerve"), asks);
  now += 21.0;
  EXPECT_EQ(said("the first"), "");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, EachSpeakerHasAQuestionOfTheirOwn) {
  hear("Flakey, EJ-231 is Karen's office", "Carol");
  EXPECT_EQ(said("Flakey, EJ-233 is Karen's office", "Bob"),
            "Carol told me that EJ-231 is karen's office. Is it now EJ-233?");
  EXPECT_EQ(said("Flakey, go to EJ-232"),
            "I know no place or person called ej-232; do you mean EJ-231?");
  EXPECT_EQ(said("yes", "Bob"), "I know now that EJ-233 is karen's office");
  EXPECT_EQ(said("yes"), "I go to EJ-231");
}

TEST_F(DialogueTest, AnotherTaskOrAStopEndsTheQuestionWhetherToDropOne) {
  hear("Flakey, get the mail from John");
  const std::string asks = "I am bringing the mail for Alice. Shall I drop that?";
  EXPECT_EQ(said("Flakey, go to EJ-233", "Bob"), asks);
  now += 21.0;
  EXPECT_EQ(said("yes", "Bob"), "") << "too late";
  EXPECT_EQ(said("Flakey, go to EJ-233", "Bob"), asks);
  hear("Flakey, turn left", "Carol");
  EXPECT_EQ(said("yes", "Carol"), "");
  hear("Flakey, get the book from John");
  EXPECT_EQ(said("yes", "Bob"), "") << "it is about a task that is over";
  EXPECT_EQ(said("Flakey, go to EJ-233", "Bob"),
            "I am bringing the book for Alice. Shall I drop that?");
  hear("Flakey, stop", "Carol");
  EXPECT_EQ(said("yes", "Bob"), "");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, TheTaskOfSomebodyElseIsDroppedOnlyAfterAQuestion) {
  hear("Flakey, get the mail from John");
  const std::uint64_t first = last.goals.at(0).tag;
  EXPECT_EQ(said("Flakey, go to EJ-233", "Bob"),
            "I am bringing the mail for Alice. Shall I drop that?");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(said("good morning", "Alice"), "");
  EXPECT_EQ(said("no", "Bob"), "good: I go on with the mail for Alice");
  hear("Flakey, go to EJ-233", "Bob");
  EXPECT_EQ(said("good morning", "Bob"), "");
  EXPECT_EQ(said("yes", "Bob"), "") << "another sentence of Bob has ended the question";
  hear("Flakey, go to EJ-233", "Bob");
  EXPECT_EQ(said("yes please", "Bob"),
            "I drop the mail for Alice: Bob said \"Flakey, go to EJ-233\" / I go to EJ-233");
  EXPECT_EQ(last.canceled, std::vector{first});
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
}

TEST_F(DialogueTest, ANameThatNothingHasIsAnsweredAtOnceWithTheNearest) {
  EXPECT_EQ(said("Flakey, go to Xyz"),
            "I know no place or person called xyz, but EJ-231, EJ-233, upper corridor. Which one, "
            "or where is xyz?");
  EXPECT_TRUE(last.goals.empty() && last.said.at(0).refused);
  EXPECT_EQ(said("Flakey, take the report to Karn"),
            "I know no place or person called karn; do you mean karen?");
  EXPECT_EQ(said("Flakey, get the report from Zoe"),
            "I know no place or person called zoe, but EJ-231, EJ-233, upper corridor. Which one, "
            "or where is zoe?");
  EXPECT_EQ(said("Flakey, find Jhon"), "I know no place or person called jhon; do you mean john?");
  EXPECT_EQ(said("Flakey, go to EK 231"),
            "I know no place or person called ek 231; do you mean EJ-231?");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(said("Flakey, go to EJ 233"), "I go to EJ-233");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
  EXPECT_EQ(said("Flakey, go to John"), "I drop the way to EJ-233 / I go to john");
  EXPECT_EQ(goals(), "find-person name=\"john\"");
  // Nobody goes to a zone.
  situation.map = maps::parse_map(
      std::string(kMap) + "ZONE (900) 9000, 1000, 0, 500, 500 keep-out \"lab\"\n", "map");
  EXPECT_EQ(said("Flakey, go to the lab"),
            "I know no place or person called lab, but EJ-231, EJ-233, upper corridor. Which one, "
            "or where is lab?");
  // Without a map the places are not known yet.
  situation.map = {};
  EXPECT_EQ(said("Flakey, EJ-231 is Bob's office"),
            "I know no place called ej-231: no map with names has come yet");
  hear("Flakey, take the report to Xyz");
  EXPECT_EQ(goals(), "deliver object=\"the report\" to=\"xyz\" sender=\"Alice\"");
}

TEST_F(DialogueTest, AQuestionBackIsAnsweredByItsSpeakerWithYesNoOrAName) {
  const std::string asks = "I know no place or person called ej-232; do you mean EJ-231?";
  EXPECT_EQ(said("Flakey, go to EJ-232"), asks);
  EXPECT_EQ(said("yes please", "Bob"), "");
  EXPECT_EQ(said("yes please"), "I go to EJ-231");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"");
  EXPECT_EQ(last.said.at(0).answers, (UtteranceId{7, 3}));
  EXPECT_EQ(said("yes"), "") << "nothing is asked any more";
  EXPECT_EQ(said("Flakey, go to EJ-232"), asks);
  EXPECT_EQ(said("no"), "then I leave it");
  EXPECT_EQ(said("yes"), "");
  EXPECT_EQ(said("Flakey, go to EJ-232"), asks);
  EXPECT_EQ(said("EJ-233"), "I drop the way to EJ-231 / I go to EJ-233");
  EXPECT_EQ(said("Flakey, go to EJ-232"), asks);
  EXPECT_EQ(said("no, I meant EJ-231"), "I drop the way to EJ-233 / I go to EJ-231");
  EXPECT_EQ(said("Flakey, go to EJ-232"), asks);
  EXPECT_EQ(said("lunch"), "") << "a word to somebody else";
  EXPECT_EQ(said("yes"), "");
  EXPECT_EQ(said("Flakey, go to EJ-232"), asks);
  now += 21.0;
  EXPECT_EQ(said("yes"), "");
  hear("Flakey, go to Xyz");
  EXPECT_EQ(said("yes"), "which one?");
  EXPECT_EQ(said("Flakey, EJ-233"), "I drop the way to EJ-231 / I go to EJ-233");
  hear("Flakey, Karen is in EJ-235");
  EXPECT_EQ(said("yes"), "I know now that karen is at EJ-231");
}

TEST_F(DialogueTest, ATaskIsCorrectedByAnotherNameAfterTheKeyword) {
  hear("Flakey, go to EJ-231");
  EXPECT_EQ(said("no, I meant EJ-233"), "") << "a word to somebody else";
  hear("Flakey, go to EJ-231");
  now += 60.0;
  EXPECT_EQ(said("Flakey, no, I meant EJ-233"), "I drop the way to EJ-231 / I go to EJ-233");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
  EXPECT_EQ(said("Flakey, turn left"),
            "I turn 90 degrees to the left, and then I go on with the way to EJ-233");
  EXPECT_EQ(said("Flakey, no, I meant EJ-231"), "what?");
}

TEST_F(DialogueTest, AnOrderAtTheEndOfAMessageIsAskedBack) {
  situation.map = maps::parse_map(std::string(kMap) + "POS (90) 1000, 1000, 0 \"start\"\n", "map");
  const std::string both = "Flakey, ask John where Karen is, and then go home";
  EXPECT_EQ(said(both),
            "\"and then go home\": shall I do that myself (yes), or is it what I am to say (no)?");
  EXPECT_TRUE(last.goals.empty());
  EXPECT_EQ(said("yes"), "I ask john where karen is, and then I go home, to start");
  EXPECT_EQ(goals(),
            "inquire person=\"john\" question=\"where Karen is\" sender=\"Alice\" "
            "back=\"upper corridor\"");
  hear(both);
  EXPECT_EQ(said("no"),
            "I drop the question to john, and what was to follow / I ask john where karen is and "
            "then go home");
  EXPECT_EQ(goals(),
            "inquire person=\"john\" question=\"where Karen is, and then go home\" "
            "sender=\"Alice\" back=\"upper corridor\"");
  hear("Flakey, ask John for the report and then go home");
  EXPECT_EQ(last.said.back().text,
            "I get the report from john and bring it here, and then I go home, to start");
  EXPECT_EQ(goals(),
            "deliver object=\"the report\" from=\"john\" to=\"upper corridor\" receiver=\"alice\"");
}

TEST_F(DialogueTest, AnOpenQuestionHasTheFirstClaimOnAnAnswer) {
  hear("Flakey, go to EJ-231");
  for (const char* const yes : {"Flakey, go ahead", "go ahead"}) {
    EXPECT_EQ(said("Flakey, go to EJ-233", "Bob"),
              "I am going to EJ-231 for Alice. Shall I drop that?");
    hear(yes, "Bob");
    EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"") << yes;
    hear("Flakey, stop");
    hear("Flakey, go to EJ-231");
  }
  EXPECT_EQ(said("Flakey, take the mail to Xyz", "Carol").substr(0, 39),
            "I know no place or person called xyz, b");
  hear("Flakey, the EJ-233", "Carol");
  EXPECT_EQ(goals(), "") << "it is another name for Xyz; the task is Alice's";
}

TEST_F(DialogueTest, ACorrectionCorrectsWhateverIsOpen) {
  hear("Flakey, take the report from John to EJ-233");
  situation.asked_about = "given";
  EXPECT_EQ(
      said("no, I meant EJ-231"),
      "what? That may mean \"I get the report from ej-231 and bring it to ej-233\", or \"I get "
      "the report from john and bring it to ej-231\"");
  EXPECT_TRUE(last.claims.empty());
  hear("the second");
  EXPECT_EQ(goals(), "deliver object=\"the report\" from=\"john\" to=\"EJ-231\"");
  hear("Flakey, take this report to EJ-233");
  hear("no, I meant EJ-231");
  EXPECT_EQ(goals(), "deliver object=\"the report\" to=\"EJ-231\" sender=\"Alice\"");
  hear("I meant EJ-233", "Bob");
  EXPECT_TRUE(last.goals.empty()) << "it is not Bob's task";
  for (const Claimed& claim : last.claims)
    EXPECT_EQ(claim.name, "not-understood") << "a place is no answer";
}

TEST_F(DialogueTest, AWaitPausesAndGoOnEndsIt) {
  hear("Flakey, go to EJ-231");
  const std::uint64_t way = last.goals.at(0).tag;
  EXPECT_EQ(said("Flakey, wait a minute"),
            "I wait 1 minute, and then I go on with the way to EJ-231");
  EXPECT_EQ(goals(), "pause seconds=60");
  EXPECT_TRUE(last.canceled.empty());
  const std::uint64_t wait = last.goals.at(0).tag;
  EXPECT_EQ(said("Flakey, go on"), "done: I was told to go on / I go on with the way to EJ-231");
  EXPECT_EQ(last.canceled, std::vector{wait});
  EXPECT_EQ(said("Flakey, go on"), "good: I go on with the way to EJ-231");
  hear("Flakey, stop");
  EXPECT_EQ(last.canceled, std::vector{way});
  EXPECT_EQ(said("Flakey, go on"), "I go to EJ-231");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"");
  hear("Flakey, stop");
  hear("Flakey, go to EJ-233");
  dialogue.ended({last.goals.at(0).tag, true, "there"});
  EXPECT_EQ(said("Flakey, go on"), "there is nothing to go on with");
}

TEST_F(DialogueTest, APlaceAloneIsOneToGoTo) {
  for (const char* const sentence :
       {"Flakey, EJ-231 please", "Flakey, to EJ-231", "Flakey, EJ-231", "Flakey, go to room 231",
        "Flakey, 231 please", "Flakey, let's go to EJ-231"}) {
    Dialogue fresh{grammar()};
    std::swap(dialogue, fresh);
    hear(sentence);
    EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"") << sentence;
  }
}

TEST_F(DialogueTest, ItGoesSlowlyUntilItMayGoFasterAgain) {
  EXPECT_EQ(said("Flakey, slower please"), "I go slowly");
  EXPECT_EQ(claims(), "pace=slow");
  situation.is_slow = true;
  EXPECT_EQ(said("Flakey, go faster"), "I go as fast as before");
  EXPECT_EQ(last.claims.at(0).value, "");
  situation.is_slow = false;
  EXPECT_EQ(said("Flakey, faster"), "I go no faster than the task asks for");
}

TEST_F(DialogueTest, ANameAloneMayCallAPersonWhileTheRobotWaits) {
  situation.asked_about = "answer";
  situation.asked_for = "john";
  for (const char* const sentence : {"John?", "John", "Flakey, John"}) {
    EXPECT_EQ(said(sentence, "Bob"), "yes, I ask where john is") << sentence;
    EXPECT_TRUE(last.claims.empty() && last.goals.empty());
  }
  EXPECT_EQ(said("in EJ-233?", "Bob"),
            "is that a question? Without the question mark I take it as an answer");
  EXPECT_TRUE(last.claims.empty());
  EXPECT_EQ(said("Karen?", "Bob"), "");
  EXPECT_EQ(said("Flakey, the EJ-233", "Bob"), "thank you");
  EXPECT_EQ(last.claims.at(0).value, "EJ-233");
  situation.asked_about = "given";
  situation.asked_for.clear();
  for (const char* const sentence : {"John?", "John", "lunch"}) {
    EXPECT_EQ(said(sentence, "Bob"), "") << sentence;
    EXPECT_TRUE(last.claims.empty());
  }
}

}  // namespace
}  // namespace saphira::agent_interface
