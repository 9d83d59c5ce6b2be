// The dialogue where lines of dialogues.txt do not do.
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

TEST_F(DialogueTest, NobodyUsesUpTheIdsOfAnother) {
  const auto hear = [&](const char* person, const char* text) {
    return dialogue.hear(
        {.id = {7, 1}, .speaker = person, .text = text, .person = Identity{person, "agent"}},
        situation);
  };
  EXPECT_EQ(hear("mallory", "flakey go forward").goals.size(), 1u);
  EXPECT_EQ(hear("kate", "flakey stop").goals.size(), 1u);
  EXPECT_TRUE(hear("kate", "flakey stop").goals.empty());
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

TEST_F(DialogueTest, TheLaterStepsOfASequenceOutliveARestart) {
  hear("Flakey, go slowly to EJ-231, then to EJ-233");
  dialogue.asked(last.goals.at(0).tag, {9, 1}, "as written");
  Dialogue restarted{grammar()};
  restore(saved(dialogue), restarted);
  EXPECT_EQ(saved(restarted), saved(dialogue));
  EXPECT_EQ(claims(restarted.claims()), "pace=slow");
  last = restarted.ended({last.goals.at(0).tag, true, "arrived"});
  EXPECT_EQ(answer(), "done: arrived / I go to EJ-233, slowly");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
  EXPECT_EQ(claims(last.claims), "");
  last = restarted.ended({last.goals.at(0).tag, true, "arrived"});
  EXPECT_EQ(claims(last.claims), "pace=");
}

TEST_F(DialogueTest, AnOpenQuestionIsPutToTheAgentsThatKnowSuchFacts) {
  EXPECT_EQ(said("Flakey, where is Karen?"), "nobody has told me where karen is");
  situation.agents = {{"place_of", "calendar and badges"}};
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "nobody has told me where karen is; I ask calendar and badges, for 5 s at most");
  EXPECT_FALSE(last.said.at(0).end);
  ASSERT_EQ(last.asks.size(), 1u);
  const OpenQuestion asked = last.asks.front();
  EXPECT_EQ(describe(asked.request), "place_of person=\"karen\" place=?");
  EXPECT_EQ(asked.request.deadline, kAgentsPatience);
  last = dialogue.answered_by(asked, "badges", {AnswerCode::done, "", {text("place", "EJ-231")}},
                              situation);
  EXPECT_EQ(answer(), "badges says: karen is at EJ-231");
  EXPECT_EQ(last.said.at(0).answers, asked.asked.id);
  EXPECT_TRUE(last.said.at(0).end);
  last =
      dialogue.answered_by(asked, "badges", {AnswerCode::refused, "no badge of hers"}, situation);
  EXPECT_EQ(answer(), "no agent knows it: no badge of hers");
  EXPECT_TRUE(last.said.at(0).refused);
  hear("Flakey, Karen is in EJ-233");
  EXPECT_EQ(said("Flakey, where is Karen?"), "Alice said that karen is at EJ-233");
  EXPECT_TRUE(last.asks.empty());
}

TEST_F(DialogueTest, AnErrandWaitsForTheAgentsThatMayKnowThePerson) {
  const auto answered = [&](Answer answer) {
    last = dialogue.answered_by(OpenQuestion(last.asks.at(0)), "badges", answer, situation);
    return goals();
  };
  const Answer known{AnswerCode::done, "", {text("place", "EJ-231")}};
  hear("Flakey, get the report from Zoe");
  EXPECT_TRUE(last.asks.empty());
  situation.agents = {{"place_of", "badges"}};
  hear("Flakey, get the report from Zoe");
  EXPECT_TRUE(last.goals.empty());
  ASSERT_EQ(last.said.size(), 1u);
  EXPECT_FALSE(last.said[0].end);
  EXPECT_EQ(describe(last.asks.at(0).request), "place_of person=\"zoe\" place=?");
  EXPECT_EQ(answered(known),
            "deliver object=\"the report\" from=\"zoe\" to=\"upper corridor\" receiver=\"alice\"");
  hear("Flakey, go to Zoe");
  EXPECT_EQ(answered(known), "find-person name=\"zoe\"");
  // A place that the map does not have is none, and an answer alone begins nothing.
  for (const char* const place : {"", "Paris"}) {
    hear("Flakey, go to Zoe");
    EXPECT_EQ(answered({AnswerCode::done, "", {text("place", place)}}), "");
    EXPECT_TRUE(last.said.back().refused);
    EXPECT_TRUE(last.asks.empty());
    hear("Flakey, where is Zoe?");
    EXPECT_EQ(answered({AnswerCode::done, "", {text("place", place)}}), "");
    EXPECT_TRUE(last.said.back().refused);
  }
  hear("Flakey, go to Zoe");
  EXPECT_EQ(answered({AnswerCode::refused, "no badge of hers"}), "");
  EXPECT_TRUE(last.said.back().refused);
  // A stop ends the order, and so does another name.
  hear("Flakey, go to Zoe");
  const Dialogue::Outputs asked = last;
  hear("Flakey, stop", "Bob");
  last = asked;
  EXPECT_EQ(answered(known), "");
  hear("Flakey, go to Zoe");
  const Dialogue::Outputs again = last;
  hear("Flakey, no, EJ-233");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
  last = again;
  EXPECT_EQ(answered(known), "");
}

TEST_F(DialogueTest, AnOrderForLaterLetsItsActivityAskTheAgents) {
  situation.agents = {{"place_of", "badges"}};
  situation.now = now;
  hear("Flakey, in ten minutes go to Zoe");
  const OpenQuestion asked = last.asks.at(0);
  last = dialogue.answered_by(asked, "badges", {AnswerCode::done, "", {text("place", "EJ-231")}},
                              situation);
  EXPECT_EQ(goals(), "");
  situation.now += 601.0;
  last = dialogue.come_due(situation);
  EXPECT_EQ(goals(), "find-person name=\"zoe\"");
}

TEST_F(DialogueTest, AMeaningThatOnlyAnAgentKnowsIsAskedOfIt) {
  const std::string more = "weather(day)\n  what is the weather [on {day}]\n";
  dialogue.use(Grammar(read_file(test::source("config/grammars/flakey.grammar")) + more, "own"));
  EXPECT_EQ(said("Flakey, what is the weather?"),
            "I understand weather, and do not know how to do it");
  situation.agents = {{"weather", "oracle"}};
  EXPECT_EQ(said("Flakey, what is the weather?"), "I ask oracle, for 5 s at most");
  EXPECT_EQ(describe(last.asks.at(0).request), "weather day=?");
  last = dialogue.answered_by(last.asks.at(0), "oracle",
                              {AnswerCode::done, "fine", {text("day", "today")}}, situation);
  EXPECT_EQ(answer(), "oracle says: day=\"today\"; fine");
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
