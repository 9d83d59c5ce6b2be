// The dialogue: advice, and questions about it.
#include <cmath>

#include "dialogue_fixture.hpp"
#include "saphira/base/archive.hpp"

namespace saphira::agent_interface {
namespace {

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
  EXPECT_EQ(dialogue.forget(2).answer,
            (Answer{AnswerCode::refused, "nothing is known under 2: saphira knows lists what is"}));
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

TEST_F(DialogueTest, SeveralMayKnowWhereSomebodyIs) {
  hear("Flakey, John usually knows where Karen is");
  EXPECT_EQ(said("Flakey, Alice knows where Karen is", "Bob"),
            "I know now that alice knows where karen is");
  EXPECT_EQ(claims(), "knows-where-karen=john, alice");
  EXPECT_EQ(last.claims[0].list, (std::vector<std::string>{"john", "alice"}));
  EXPECT_EQ(said("Flakey, John knows where Karen is"), "I know: john knows where karen is");
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "Alice said that john knows where karen is; Bob said that alice knows where karen is");
  EXPECT_EQ(said("Flakey, John does not know where Karen is"),
            "I no longer believe that john knows where karen is; Bob said that alice knows where "
            "karen is");
  ASSERT_EQ(last.claims.size(), 2u);
  EXPECT_EQ(last.claims[0].value, "");
  EXPECT_EQ(last.claims[1].list, std::vector<std::string>{"alice"});
}

TEST_F(DialogueTest, WhereAPersonIsComesBeforeWhoKnowsAndAnOfficeIsAnOffice) {
  hear("Flakey, John knows where Karen is");
  EXPECT_EQ(said("Flakey, where is Karen's office?"), "nobody has told me where karen's office is");
  hear("Flakey, EJ-231 is Karen's office", "Bob");
  hear("Flakey, Karen is in EJ-233", "Carol");
  EXPECT_EQ(said("Flakey, where is Karen's office?"), "Bob said that EJ-231 is karen's office");
  EXPECT_EQ(said("Flakey, where is Karens office?"), "Bob said that EJ-231 is karen's office");
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "Carol said that karen is at EJ-233; Bob said that EJ-231 is karen's office; "
            "Alice said that john knows where karen is");
  EXPECT_EQ(said("Flakey, go to Karens office"), "I go to EJ-231");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\" whose=\"karen\"");
  EXPECT_EQ(said("Flakey, go to Johns office"), "nobody has told me where john's office is");
  EXPECT_EQ(said("Flakey, go to Bobs office"),
            "I know no place or person called bobs office, but EJ-231, EJ-233, upper corridor. "
            "Which one, or where is bobs office?");
}

TEST_F(DialogueTest, FactsAboutPeopleAreTakenBackInWords) {
  EXPECT_EQ(said("Flakey, Karen is not in EJ-231"), "I did not believe that karen is at EJ-231");
  EXPECT_EQ(said("Flakey, forget Karen's office"), "nobody has told me where karen's office is");
  EXPECT_EQ(said("Flakey, Karen left"), "nobody has told me where karen is");
  EXPECT_EQ(said("Flakey, forget Karen"), "nobody has told me anything about karen");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, Karen is in EJ-233");
  EXPECT_EQ(said("Flakey, Karen is not in EJ-231"),
            "I did not believe that karen is at EJ-231; Alice said that karen is at EJ-233; "
            "Alice said that EJ-231 is karen's office");
  EXPECT_EQ(
      said("Flakey, Karen isn't in EJ-233"),
      "I no longer believe that karen is at EJ-233; Alice said that EJ-231 is karen's office");
  EXPECT_EQ(claims(), "place-of-karen=; place-of-karen=EJ-231");
  EXPECT_EQ(said("Flakey, Karen's office is not EJ-233"),
            "I did not believe that EJ-233 is karen's office; Alice said that EJ-231 is karen's "
            "office");
  EXPECT_EQ(said("Flakey, Karen's office is not EJ-231"),
            "I no longer believe that EJ-231 is karen's office");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
  // nil also covers what an activity believes, until somebody says a place; over a restart, too.
  EXPECT_EQ(claims(), "place-of-karen=; place-of-karen=nil");
  Dialogue restarted{grammar()};
  restore(saved(dialogue), restarted);
  EXPECT_EQ(restarted.claims(), dialogue.claims());
  hear("Flakey, Karen is in EJ-233");
  ASSERT_EQ(dialogue.claims().size(), 1u);
  EXPECT_FALSE(dialogue.claims()[0].nil);
  EXPECT_EQ(said("Flakey, Karen is on holiday"), "I no longer believe that karen is at EJ-233");
  EXPECT_EQ(said("Flakey, Karen is not in the attic"), kNoAttic);
  hear("Flakey, this is Karen's office");
  hear("Flakey, John knows where Karen is");
  EXPECT_EQ(said("Flakey, this is not Karen's office"),
            "I no longer believe that EJ-231 is karen's office; Alice said that john knows where "
            "karen is");
  hear("Flakey, Karen is in EJ-233");
  EXPECT_EQ(said("Flakey, forget Karen"),
            "I no longer believe that john knows where karen is, nor that karen is at EJ-233");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
}

TEST_F(DialogueTest, HazardsAreClaimedWithTheirPlacesSoThatRoutesAvoidThem) {
  // The machine's clock gives the time.
  setenv("TZ", "UTC", 1);
  tzset();
  hear("Flakey, there's a water leak in this corridor");
  hear("Flakey, there is a spill in EJ-233", "Bob");
  EXPECT_EQ(claims(), "hazards=water leak at upper corridor; spill at EJ-233");
  EXPECT_EQ(
      last.claims[0].source,
      "Alice said at 01:46 \"Flakey, there's a water leak in this corridor\"; Bob said at 01:46 "
      "\"Flakey, there is a spill in EJ-233\"");
  // From elsewhere: the known hazard is meant.
  EXPECT_EQ(said("Flakey, the spill is gone"), "good: no spill at EJ-233 any more");
  EXPECT_EQ(claims(), "hazards=; hazards=water leak at upper corridor");
  EXPECT_EQ(said("Flakey, the water leak is gone"),
            "good: no water leak at upper corridor any more");
  EXPECT_EQ(claims(), "hazards=");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
}

TEST_F(DialogueTest, PlacesToKeepOutOfAreHazardsUntilTheRobotMayGoThere) {
  EXPECT_EQ(said("Flakey, keep out of EJ-233"), "I know now that I am to keep out of EJ-233");
  EXPECT_EQ(claims(), "hazards=keep-out at EJ-233");
  EXPECT_EQ(said("Flakey, you may go to EJ-231"), "nobody told me to keep out of EJ-231");
  EXPECT_EQ(said("Flakey, you may enter this corridor"),
            "nobody told me to keep out of upper corridor");
  EXPECT_EQ(said("Flakey, you may go to EJ-233 again"), "good: I may go to EJ-233 again");
  EXPECT_EQ(last.claims.at(0).value, "");
  EXPECT_EQ(said("Flakey, keep out of the attic"), kNoAttic);
  hear("Flakey, EJ-231 is Karen's office");
  EXPECT_EQ(said("Flakey, stay out of Karen's office"),
            "I know now that I am to keep out of EJ-231");
}

TEST_F(DialogueTest, PlacesToGoSlowlyInAndToPreferAreAdviceUntilItIsWithdrawn) {
  EXPECT_EQ(said("Flakey, go slowly in EJ-233"), "I know now that I am to go slowly in EJ-233");
  EXPECT_EQ(said("Flakey, prefer this corridor"), "I know now that I am to prefer upper corridor");
  EXPECT_EQ(last.claims.at(0).value, "slow at EJ-233; preferred at upper corridor");
  EXPECT_EQ(said("Flakey, there is broken glass at EJ-231"),
            "I know now that there is broken glass at EJ-231");
  EXPECT_EQ(last.claims.at(0).value,
            "slow at EJ-233; preferred at upper corridor; broken glass at EJ-231");
  EXPECT_EQ(said("Flakey, you may go fast again here"),
            "I did not know that I am to go slowly in upper corridor");
  EXPECT_EQ(said("Flakey, you may go fast again in EJ-233"), "good: I may go fast in EJ-233 again");
  EXPECT_EQ(said("Flakey, no need to prefer the upper corridor"),
            "good: I need not prefer upper corridor any more");
  EXPECT_EQ(said("Flakey, the broken glass is gone"), "good: no broken glass at EJ-231 any more");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
}

TEST_F(DialogueTest, AQuestionIsNoFact) {
  hear("Flakey, Karen is in EJ-233");
  const std::string asks = "is that a question? Without the question mark I take it as a fact";
  for (const char* const question :
       {"Flakey, Karen left?", "Flakey, Karen is in EJ-231?", "Flakey, John knows where Karen is?",
        "Flakey, there is a leak in EJ-231?", "Flakey, you can go to EJ-231?"})
    EXPECT_EQ(said(question), asks) << question;
  EXPECT_EQ(said("Flakey, could you keep out of EJ-231?"),
            "I know now that I am to keep out of EJ-231");
  EXPECT_EQ(said("Flakey, where is Karen?"), "Alice said that karen is at EJ-233");
}

TEST_F(DialogueTest, MyOfficeIsTheSpeakers) {
  EXPECT_EQ(said("Flakey, EJ-233 is my office", "John"), "I know now that EJ-233 is john's office");
  EXPECT_EQ(said("Flakey, EJ-233 is my office", ""), "I do not know who you are");
  EXPECT_EQ(said("Flakey, go to my office", "Karen"), "nobody has told me where karen's office is");
  hear("Flakey, go to my office", "John");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\" whose=\"john\"");
}

TEST_F(DialogueTest, AFindIsLearnedOnceAndNotWhereItIsOlderThanTheDialogue) {
  hear("Flakey, Karen is in EJ-233");
  dialogue.found({{"Karen", "EJ-231", 70}, {"John", "EJ-231", 71}}, now);
  EXPECT_EQ(dialogue.knowledge().place_of("karen"), "EJ-233");
  EXPECT_EQ(dialogue.knowledge().place_of("john"), "EJ-231");
  EXPECT_FALSE(dialogue.found({{"Karen", "EJ-231", 70}, {"John", "EJ-231", 71}}, now).changed);
  EXPECT_TRUE(dialogue.found({{"Karen", "EJ-231", 80}, {"John", "EJ-231", 71}}, now).changed);
  EXPECT_EQ(dialogue.knowledge().all().back().value, "EJ-231");
  EXPECT_EQ(dialogue.knowledge().all().back().about, "karen");
  EXPECT_EQ(dialogue.knowledge().all().back().time, now);
}

TEST_F(DialogueTest, KnowledgeOutlivesARestart) {
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, there is a spill in EJ-233");
  Dialogue restarted{grammar()};
  restore(saved(dialogue), restarted);
  EXPECT_EQ(restarted.knowledge().all(), dialogue.knowledge().all());
  EXPECT_EQ(restarted.claims().size(), 2u);
}

// Whose task it is, errands, and ways of several steps.

TEST(Beliefs, TheOpenQuestionAndTheFindsAreHeeded) {
  Situation situation;
  situation.asked_about = "of before";
  const std::vector<Find> finds = heed({{"asking-about", "\"given\"", "deliver", 3},
                                        {"asking-for", "nil", "deliver", 3},
                                        {"place-of-karen", "\"EJ-231\"", "find-person", 70},
                                        {"place-of-john", "nil", "find-person", 71},
                                        {"place-of-bob", "\"EJ-233\"", "dialogue", 72},
                                        {"carries-the report", "\"EJ-233\"", "deliver", 72},
                                        {"carries-the mail", "nil", "deliver", 72},
                                        {"corridor-of-ann", "\"EJ-1\"", "find-person", 73}},
                                       situation);
  EXPECT_EQ(situation.asked_about, "given");
  EXPECT_EQ(situation.asked_for, "");
  EXPECT_EQ(finds, (std::vector<Find>{{"karen", "EJ-231", 70}}));
  ASSERT_EQ(situation.carried.size(), 1U);
  EXPECT_EQ(situation.carried[0].first, "the report");
  EXPECT_EQ(situation.carried[0].second, "EJ-233");
  heed({}, situation);
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

TEST_F(DialogueTest, ItSaysWhatItKnows) {
  EXPECT_EQ(said("Flakey, what do you know?"), "nobody has told me anything");
  EXPECT_EQ(said("Flakey, is there a leak?"), "nobody has told me of a leak");
  EXPECT_EQ(said("Flakey, who is in EJ-233?"), "nobody has told me who is in EJ-233");
  EXPECT_EQ(said("Flakey, who is in the attic?"), kNoAttic);
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, John is in EJ-233", "Bob");
  hear("Flakey, there is a water leak in this corridor");
  hear("Flakey, keep out of EJ-231");
  EXPECT_EQ(said("Flakey, what do you know?"),
            "I know 1 office, 1 place of a person, 2 hazards and rules for places; Alice said "
            "that I am to keep out of EJ-231; Alice said that there is a water leak at upper "
            "corridor; Bob said that john is at EJ-233");
  EXPECT_EQ(said("Flakey, is there a leak?"),
            "Alice said that there is a water leak at upper corridor");
  EXPECT_EQ(said("Flakey, is there a leak in EJ-233?"), "nobody has told me of a leak at EJ-233");
  EXPECT_EQ(said("Flakey, who is in EJ-233?"), "Bob said that john is at EJ-233");
  EXPECT_EQ(said("Flakey, who is in Karen's office?"), "Alice said that EJ-231 is karen's office");
  EXPECT_EQ(said("Flakey, are you lost?"), "no: I am in upper corridor");
  EXPECT_EQ(said("Flakey, you are in the upper corridor"), "I know: I am in upper corridor");
  EXPECT_EQ(said("Flakey, you are in EJ-233"),
            "I think that I am in upper corridor. To put me in EJ-233 I need the exact place: "
            "saphira map place X Y HEADING, or saphira map find");
  situation.pose_in_map.reset();
  EXPECT_EQ(said("Flakey, are you lost?"), "yes: I do not know where I am on the map");
}

// Names, and the robot's questions back.

TEST_F(DialogueTest, TheOwnerOfAnOfficeIsAnswered) {
  EXPECT_EQ(said("Flakey, whose office is this?"), "nobody has told me whose office EJ-231 is");
  hear("Flakey, this is Karen's office");
  const std::string told = "Alice said that EJ-231 is karen's office";
  EXPECT_EQ(said("Flakey, whose office is this?"), told);
  EXPECT_EQ(said("Flakey, who works here?"), told);
  EXPECT_EQ(said("Flakey, whose office is EJ-233?"), "nobody has told me whose office EJ-233 is");
  EXPECT_EQ(said("Flakey, is this Karen's office?"), "yes: " + told);
  EXPECT_EQ(said("Flakey, is this my office?", "Karen"), "yes: " + told);
  EXPECT_EQ(said("Flakey, is this John's office?"), "not that I know: " + told);
  EXPECT_EQ(said("Flakey, is Karen's office EJ-233?"), "no: " + told);
  EXPECT_EQ(said("Flakey, is the upper corridor Karen's office?"), "no: " + told)
      << "nobody is called corridor karen";
  EXPECT_EQ(said("Flakey, is Karen in EJ-233?"), told);
  EXPECT_EQ(said("Flakey, whose office is the attic?"), kNoAttic);
  situation.pose_in_map = Pose{3.0, 0.5, 0.0};
  EXPECT_EQ(said("Flakey, whose office is this?"),
            "this office has no name on my map, and nobody has told me whose it is");
  EXPECT_TRUE(last.namings.empty());
  EXPECT_EQ(dialogue.knowledge().all().size(), 1u);
}

}  // namespace
}  // namespace saphira::agent_interface
