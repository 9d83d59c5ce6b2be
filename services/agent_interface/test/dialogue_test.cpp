#include "saphira/agent_interface/dialogue.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "process.hpp"

namespace saphira::agent_interface {
namespace {

constexpr const char* kMap = R"(
CORRIDOR (1) 5000, 1000, 0, 10000, 2000 "upper corridor"
OFFICE (231) 3000, 4000, 0, 4000, 4000 "EJ-231"
DOOR (1231) 3000, 2000, -90, 900 "EJ-231"
OFFICE (233) 7000, 4000, 0, 4000, 4000 "EJ-233"
DOOR (1233) 7000, 2000, -90, 900 "EJ-233"
DOOR (1235) 3000, 0, 90, 900
)";
constexpr const char* kNoAttic =
    "I know no place called attic, but EJ-231, EJ-233, upper corridor. Which one?";

struct DialogueTest : testing::Test {
  DialogueTest() {
    situation.map = maps::parse_map(kMap, "test.map");
    situation.pose_in_map = Pose{3.5, 1.2, 0.0};
    situation.findable = {"alice", "john", "karen"};
  }
  Grammar grammar() const {
    const std::string file = test::source("config/grammars/flakey.grammar");
    return Grammar(read_file(file), file);
  }
  Dialogue::Outputs hear(const std::string& text, const std::string& speaker = "Alice") {
    Utterance utterance{{7, ++number}, speaker, text};
    utterance.time = now;
    last = dialogue.hear(utterance, situation);
    return last;
  }
  /// The robot's answer, in one line.
  std::string said(const std::string& text, const std::string& speaker = "Alice") {
    std::string all;
    for (const Said& one : hear(text, speaker).said)
      all += (all.empty() ? "" : " / ") + one.text;
    return all;
  }
  /// The newest goals.
  std::string goals() const {
    std::string all;
    for (const WantedGoal& goal : last.goals)
      all += (all.empty() ? "" : "; ") + goal.functor + " " + describe(goal.arguments);
    return all;
  }

  Situation situation;
  Dialogue dialogue{grammar()};
  Dialogue::Outputs last;
  std::uint64_t number = 0;
  double now = 1e9;  ///< [s]
};

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
  EXPECT_EQ(restarted.restore(dialogue.save()), 0u);
  EXPECT_TRUE(restarted.hear(utterance, situation).goals.empty());
}

TEST_F(DialogueTest, ThisOfficeIsTheNearestDoorway) {
  EXPECT_EQ(said("Flakey, this is Karen's office"), "I know now that EJ-231 is karen's office");
  ASSERT_EQ(dialogue.knowledge().all().size(), 1u);
  EXPECT_EQ(dialogue.knowledge().all()[0].artifact, 1231u);
  EXPECT_EQ(dialogue.knowledge().all()[0].speaker, "Alice");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "place-of-karen");
  EXPECT_EQ(last.claims[0].value, "EJ-231");
  situation.pose_in_map = Pose{7.5, 4.0, 0.0};
  EXPECT_EQ(said("Flakey, this is John's office"), "I know now that EJ-233 is john's office");
}

TEST_F(DialogueTest, AnOfficeOnASideIsOnThatSideAndANamelessDoorwayGetsAName) {
  EXPECT_EQ(said("Flakey, the office on the left is Karen's"),
            "I know now that EJ-231 is karen's office");
  EXPECT_EQ(said("Flakey, the door on the right is Bob's office"),
            "I know now that bob's office is on my map");
  ASSERT_EQ(last.namings.size(), 1u);
  EXPECT_EQ(last.namings[0].id, 1235u);
  EXPECT_EQ(last.namings[0].name, "bob's office");
  situation.pose_in_map.reset();
  EXPECT_EQ(said("Flakey, this is Ann's office"), "I do not know where I am on the map");
}

// Paper 4.2. The nearest doorway is that of EJ-231.
TEST_F(DialogueTest, ThisOfficeIsTheOneAtWhichAPersonPoints) {
  const Pose alice(4.0, 1.4, 0.0);
  const auto points = [&](double degrees) {
    situation.pointing_in_map = Pose(alice.x, alice.y, degrees / 180.0 * std::numbers::pi);
  };
  points(20.0);
  EXPECT_EQ(said("Flakey, this is Karen's office"), "I know now that EJ-233 is karen's office");
  EXPECT_EQ(dialogue.knowledge().all().at(0).artifact, 1233u);
  points(-130.0);
  EXPECT_EQ(said("Flakey, this office is Bob's"), "I know now that bob's office is on my map");
  EXPECT_EQ(last.namings.at(0).id, 1235u);
  points(-10.0);
  EXPECT_EQ(said("Flakey, this is Ann's office"), "I know now that EJ-233 is ann's office");
  points(-60.0);
  EXPECT_EQ(said("Flakey, this is Tom's office"), "I know no doorway where you point");
  EXPECT_TRUE(last.claims.empty());
  EXPECT_EQ(said("Flakey, the office on the left is Tom's"),
            "I know now that EJ-231 is tom's office");
  situation.pose_in_map = Pose{7.5, 4.0, 0.0};  // in a room "this office" is the room
  EXPECT_EQ(said("Flakey, this is John's office"), "I know now that EJ-233 is john's office");
}

TEST_F(DialogueTest, HereIsWhereAPersonPoints) {
  situation.pointing_in_map = Pose{3.2, 1.4, std::numbers::pi / 2.0};
  EXPECT_EQ(said("Flakey, there is a water leak here"),
            "I know now that there is a water leak at EJ-231");
  situation.pointing_in_map = Pose{3.2, 1.4, 0.1};
  EXPECT_EQ(said("Flakey, there is a spill in this corridor"),
            "I know now that there is a spill at upper corridor");
  situation.pointing_in_map = Pose{3.2, 0.6, -std::numbers::pi / 2.0};
  EXPECT_EQ(said("Flakey, this is the Kitchen"), "I put it on my map: this is Kitchen");
  EXPECT_EQ(last.namings.at(0).id, 1235u);
  situation.map.features.push_back(
      {lps::PointType::corridor, 2, Pose{8.0, -3.0, -std::numbers::pi / 2.0}, 6.0, 2.0, "", false});
  situation.pointing_in_map = Pose{8.0, 0.8, -1.5};
  EXPECT_EQ(said("Flakey, this corridor is the J-wing"), "I put it on my map: this is J-wing");
  EXPECT_EQ(last.namings.at(0).id, 2u);
}

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
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "given");
  EXPECT_EQ(last.claims[0].value, "yes");
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

TEST_F(DialogueTest, SeveralMayKnowWhereSomebodyIs) {
  hear("Flakey, John usually knows where Karen is");
  EXPECT_EQ(said("Flakey, Alice knows where Karen is", "Bob"),
            "I know now that alice knows where karen is");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "knows-where-karen");
  EXPECT_EQ(last.claims[0].value, "john, alice");
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
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"");
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
  ASSERT_EQ(last.claims.size(), 2u);
  EXPECT_EQ(last.claims[0].name, "place-of-karen");
  EXPECT_EQ(last.claims[0].value, "");
  EXPECT_EQ(last.claims[1].value, "EJ-231");
  EXPECT_EQ(said("Flakey, Karen's office is not EJ-233"),
            "I did not believe that EJ-233 is karen's office; Alice said that EJ-231 is karen's "
            "office");
  EXPECT_EQ(said("Flakey, Karen's office is not EJ-231"),
            "I no longer believe that EJ-231 is karen's office");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
  // nil also covers what an activity believes, until somebody says a place; over a restart, too.
  ASSERT_EQ(last.claims.size(), 2u);
  EXPECT_EQ(last.claims[1].name, "place-of-karen");
  EXPECT_TRUE(last.claims[1].nil);
  Dialogue restarted{grammar()};
  EXPECT_EQ(restarted.restore(dialogue.save()), 0u);
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

TEST_F(DialogueTest, APlaceOfTheMapIsAnsweredWithItsDistanceAndDirection) {
  EXPECT_EQ(said("Flakey, where is EJ-233?"),
            "EJ-233 is about 4 meters away, ahead of me");  // its doorway
  situation.pose_in_map = Pose{7.0, 1.0, std::numbers::pi};
  EXPECT_EQ(said("Flakey, where is the EJ-233?"), "EJ-233 is about 1 meter away, on my right");
  EXPECT_EQ(said("Flakey, where is the upper corridor?"), "I am in upper corridor");
  situation.pose_in_map.reset();
  EXPECT_EQ(said("Flakey, where is EJ-233?"),
            "EJ-233 is on my map, but I do not know where I am on it");
  EXPECT_EQ(said("Flakey, where is the library?"), "nobody has told me where library is");
  hear("Flakey, there is a leak in EJ-231");
  EXPECT_EQ(said("Flakey, where is the leak?"), "Alice said that there is a leak at EJ-231");
  hear("Flakey, Karen is in EJ-231");
  EXPECT_EQ(said("Flakey, where is Karen?"), "Alice said that karen is at EJ-231");
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

TEST_F(DialogueTest, HazardsAreClaimedWithTheirPlacesSoThatRoutesAvoidThem) {
  // The machine's clock gives the time.
  setenv("TZ", "UTC", 1);
  tzset();
  hear("Flakey, there's a water leak in this corridor");
  hear("Flakey, there is a spill in EJ-233", "Bob");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "hazards");
  EXPECT_EQ(last.claims[0].value, "water leak at upper corridor; spill at EJ-233");
  EXPECT_EQ(
      last.claims[0].source,
      "Alice said at 01:46 \"Flakey, there's a water leak in this corridor\"; Bob said at 01:46 "
      "\"Flakey, there is a spill in EJ-233\"");
  // From elsewhere: the known hazard is meant.
  EXPECT_EQ(said("Flakey, the spill is gone"), "good: no spill at EJ-233 any more");
  ASSERT_EQ(last.claims.size(), 2u);
  EXPECT_EQ(last.claims[0].value, "");
  EXPECT_EQ(last.claims[1].value, "water leak at upper corridor");
  EXPECT_EQ(said("Flakey, the water leak is gone"),
            "good: no water leak at upper corridor any more");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "hazards");
  EXPECT_EQ(last.claims[0].value, "");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
}

TEST_F(DialogueTest, PlacesToKeepOutOfAreHazardsUntilTheRobotMayGoThere) {
  EXPECT_EQ(said("Flakey, keep out of EJ-233"), "I know now that I am to keep out of EJ-233");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "hazards");
  EXPECT_EQ(last.claims[0].value, "keep-out at EJ-233");
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

TEST_F(DialogueTest, ThingsAreBroughtToWhoIsNearTheirOwnRoom) {
  hear("Flakey, this is Alice's office");
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(goals(), "deliver object=\"the report\" from=\"karen\" to=\"EJ-231\"");
  situation.pose_in_map = Pose{9.5, 1.0, 0.0};
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(goals(), "deliver object=\"the report\" from=\"karen\" to=\"upper corridor\"");
  situation.pose_in_map = Pose{7.0, 4.0, 0.0};
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(goals(), "deliver object=\"the report\" from=\"karen\" to=\"EJ-233\"");
}

TEST_F(DialogueTest, TasksAreActivitiesWithPlacesOrPersons) {
  hear("Flakey, get the report from Karen");
  EXPECT_EQ(goals(), "deliver object=\"the report\" from=\"karen\" to=\"upper corridor\"");
  hear("Flakey, take the mail from EJ-231 to John");
  EXPECT_EQ(goals(), "deliver object=\"the mail\" from=\"EJ-231\" to=\"john\"");
  hear("Flakey, this is Karen's office");
  hear("Flakey, go to Karen's office");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"");
  EXPECT_EQ(said("Flakey, go to Bob's office"), "nobody has told me where bob's office is");
  hear("Flakey, look at me");
  EXPECT_EQ(dialogue.ended({last.goals.at(0).tag, false, "nobody was seen"}).said.at(0).text,
            "I could not: nobody was seen");
}

TEST_F(DialogueTest, RepliesAreClaimedAsWhatWasAskedFor) {
  EXPECT_EQ(said("in EJ-233", "John"), "");
  situation.asked_about = "answer";
  EXPECT_EQ(said("she is in EJ-233", "John"), "thank you");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "answer");
  EXPECT_EQ(last.claims[0].value, "EJ-233");
  hear("no, sorry");
  EXPECT_EQ(last.claims.at(0).value, "no");
  EXPECT_EQ(said("good morning"), "");
  EXPECT_EQ(said("ask Sam"), "nobody has told me where sam is");
  EXPECT_TRUE(last.claims.empty());
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
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
}

TEST_F(DialogueTest, AWayIsNothingToCarry) {
  EXPECT_EQ(said("Flakey, take the upper corridor to EJ-233"),
            "I find the way myself: say \"go to\" and the place");
  EXPECT_EQ(goals(), "");
}

TEST_F(DialogueTest, RepliesAboutAPersonAreKept) {
  situation.asked_about = "answer";
  situation.asked_for = "Karen";
  EXPECT_EQ(said("she is in EJ-233", "John"), "thank you");
  ASSERT_EQ(last.claims.size(), 2u);
  EXPECT_EQ(last.claims[0].name, "answer");
  EXPECT_EQ(last.claims[0].value, "EJ-233");
  EXPECT_EQ(last.claims[1].name, "place-of-karen");
  EXPECT_EQ(last.claims[1].value, "EJ-233");
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

TEST_F(DialogueTest, AReplyAboutAnotherPersonIsNoAnswer) {
  situation.asked_about = "answer";
  situation.asked_for = "john";
  EXPECT_EQ(said("Alice is in EJ-233", "Bob"),
            "I know now that alice is at EJ-233, and still ask for john");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "place-of-alice");
  EXPECT_EQ(said("John is in EJ-231", "Bob"), "thank you");
  EXPECT_EQ(last.claims.at(0).name, "answer");
  EXPECT_EQ(last.claims.at(0).value, "EJ-231");
  EXPECT_EQ(last.claims.at(1).name, "place-of-john");
}

TEST_F(DialogueTest, WithTheKeywordAFactIsAFactAndMayAnswerTheQuestion) {
  situation.asked_about = "answer";
  situation.asked_for = "john";
  EXPECT_EQ(said("Flakey, Karen is in EJ-231"), "I know now that karen is at EJ-231");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "place-of-karen");
  EXPECT_EQ(said("Flakey, John is in EJ-233"), "I know now that john is at EJ-233");
  ASSERT_EQ(last.claims.size(), 2u);
  EXPECT_EQ(last.claims[0].name, "place-of-john");
  EXPECT_EQ(last.claims[1].name, "answer");
  EXPECT_EQ(last.claims[1].value, "EJ-233");
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

TEST_F(DialogueTest, KnowledgeOutlivesARestart) {
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, there is a spill in EJ-233");
  Dialogue restarted{grammar()};
  EXPECT_EQ(restarted.restore(dialogue.save() + "nonsense\n"), 1u);
  EXPECT_EQ(restarted.knowledge().all(), dialogue.knowledge().all());
  EXPECT_EQ(restarted.claims().size(), 2u);
}

// Whose task it is, errands, and ways of several steps.

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

TEST(Beliefs, TheOpenQuestionAndTheFindsAreHeeded) {
  Situation situation;
  situation.asked_about = "of before";
  const std::vector<Find> finds = heed({{"asking-about", "\"given\"", "deliver", 3},
                                        {"asking-for", "nil", "deliver", 3},
                                        {"place-of-karen", "\"EJ-231\"", "find-person", 70},
                                        {"place-of-john", "nil", "find-person", 71},
                                        {"place-of-bob", "\"EJ-233\"", "dialogue", 72},
                                        {"corridor-of-ann", "\"EJ-1\"", "find-person", 73}},
                                       situation);
  EXPECT_EQ(situation.asked_about, "given");
  EXPECT_EQ(situation.asked_for, "");
  EXPECT_EQ(finds, (std::vector<Find>{{"karen", "EJ-231", 70}}));
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

TEST(Goals, ThePersonBehindTheWordsIsNamed) {
  WantedGoal goal;
  EXPECT_EQ(goal.requester(), "");
  goal.speaker = "Alice";
  EXPECT_EQ(goal.requester(), "Alice (by words)");
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
  EXPECT_EQ(said("Flakey, go to office 231"),
            "I know no place or person called office 231; do you mean EJ-231?");
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
  EXPECT_EQ(goals(), "deliver object=\"the report\" from=\"john\" to=\"upper corridor\"");
}

TEST_F(DialogueTest, APlaceToKeepOutOfIsRefusedAtOnceWithTheReason) {
  // The machine's clock gives the time.
  setenv("TZ", "UTC", 1);
  tzset();
  hear("Flakey, keep out of EJ-233", "Bob");
  const std::string kept_out =
      "I am to keep out of EJ-233: Bob said at 01:46 \"Flakey, keep out of EJ-233\". When I may go "
      "there, say \"you may go to EJ-233\"";
  for (const char* const sentence :
       {"Flakey, go to EJ-233", "Flakey, take the report to EJ-233", "Flakey, show me EJ-233",
        "Flakey, get the report from EJ-233", "Flakey, go to EJ-231 and go to EJ-233"}) {
    EXPECT_EQ(said(sentence), kept_out);
    EXPECT_TRUE(last.goals.empty() && last.said.at(0).refused) << sentence;
  }
  hear("Flakey, Karen is in EJ-233");
  EXPECT_EQ(said("Flakey, find Karen"), kept_out);
  hear("Flakey, John knows where Karen is");
  EXPECT_EQ(said("Flakey, find Karen"), "I look for karen") << "John may know another place";
  hear("Flakey, you may go to EJ-233");
  EXPECT_EQ(said("Flakey, go to EJ-233"), "I drop the search for karen / I go to EJ-233");
  hear("Flakey, there is a spill in EJ-233");
  EXPECT_EQ(said("Flakey, go to EJ-233"),
            "there is a spill at EJ-233: Alice said at 01:46 \"Flakey, there is a spill in "
            "EJ-233\". When I may go there, say \"the spill at EJ-233 is gone\"");
  hear("Flakey, the floor is wet in EJ-231");
  hear("Flakey, go to EJ-231");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"") << "it may go there, slowly";
}

TEST_F(DialogueTest, APlaceBehindAKeepOutIsRefusedAtOnce) {
  situation.map = maps::parse_map(
      std::string(kMap) + "ZONE (900) 5200, 1000, 0, 800, 2000 keep-out \"works\"\n", "map");
  EXPECT_NE(said("Flakey, go to EJ-233").find("keep-out zone \"works\""), std::string::npos)
      << last.said.at(0).text;
  EXPECT_TRUE(last.goals.empty());
  hear("Flakey, go to EJ-231");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-231\"");
}

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
