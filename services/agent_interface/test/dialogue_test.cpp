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

struct DialogueTest : testing::Test {
  DialogueTest() {
    situation.map = maps::parse_map(kMap, "test.map");
    situation.pose_in_map = Pose{3.5, 1.2, 0.0};
  }
  Grammar grammar() const {
    const std::string file = test::source("config/grammars/flakey.grammar");
    return Grammar(read_file(file), file);
  }
  Dialogue::Outputs hear(const std::string& text, const std::string& speaker = "Alice") {
    Utterance utterance{{7, ++number}, speaker, text};
    utterance.time = 1e9;
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

TEST_F(DialogueTest, ANewCommandTakesThePlaceOfTheOneBefore) {
  hear("Flakey, go to EJ-233");
  EXPECT_EQ(goals(), "go-to-place place=\"EJ-233\"");
  const std::uint64_t first = last.goals.at(0).tag;
  EXPECT_EQ(said("flakey stop"), "I stop");
  EXPECT_EQ(last.canceled, std::vector{first});
  EXPECT_TRUE(dialogue.ended({first, false, "withdrawn"}).said.empty());
}

TEST_F(DialogueTest, WhatIsNotUnderstoodIsAskedBackAndNotActedOn) {
  EXPECT_EQ(said("Flakey, go upstairs"), "what?");
  EXPECT_EQ(said("go forward"), "");
  Utterance mumbled{{7, 99}, "Alice", "flakey go forward", 0.3};
  const Dialogue::Outputs out = dialogue.hear(mumbled, situation);
  EXPECT_EQ(out.said.at(0).text, "what?");
  EXPECT_TRUE(out.goals.empty());
  EXPECT_EQ(said("Flakey, go to EJ-232"), "I know no place called ej-232; do you mean EJ-231?");
  EXPECT_EQ(said("Flakey, go forward 200 meters"), "I go up to 20 m at a time");
  EXPECT_TRUE(last.goals.empty());
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
            "I know now that bob's office is bob's office");
  ASSERT_EQ(last.namings.size(), 1u);
  EXPECT_EQ(last.namings[0].feature.id, 1235u);
  EXPECT_EQ(last.namings[0].feature.name, "bob's office");
  situation.pose_in_map.reset();
  EXPECT_EQ(said("Flakey, this is Ann's office"), "I do not know where I am on the map");
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

TEST_F(DialogueTest, WhatIsKnownIsAnsweredAndTakenBack) {
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, John usually knows where Karen is", "Bob");
  EXPECT_EQ(said("Flakey, where is Karen?"),
            "Alice said that EJ-231 is karen's office; Bob said that john knows where karen is");
  const Dialogue::Outputs out = dialogue.forget(2);
  EXPECT_EQ(out.claims.at(0).name, "knows-where-karen");
  EXPECT_EQ(out.claims.at(0).value, "");
  EXPECT_FALSE(dialogue.forget(2).learned);
  EXPECT_EQ(said("Flakey, where are you?"), "I am in upper corridor");
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
  EXPECT_EQ(said("Flakey, please stop going there!"), "I stop");
  EXPECT_EQ(last.canceled, std::vector{first});
  EXPECT_EQ(goals(), "stop ");
  EXPECT_EQ(said("Flakey, never stop"), "what?");
  EXPECT_TRUE(last.goals.empty());
}

TEST_F(DialogueTest, HazardsAreKnownUntilTheyAreGone) {
  EXPECT_EQ(said("Flakey, there's a water leak in this corridor"),
            "I know now that there is a water leak at upper corridor");
  EXPECT_EQ(said("Flakey, the water leak is gone"),
            "good: no water leak at upper corridor any more");
  EXPECT_TRUE(dialogue.knowledge().all().empty());
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
  hear("Flakey, the water leak is gone");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "hazards");
  EXPECT_EQ(last.claims[0].value, "");
}

TEST_F(DialogueTest, PlacesToKeepOutOfAreHazardsUntilTheRobotMayGoThere) {
  EXPECT_EQ(said("Flakey, keep out of EJ-233"), "I know now that I am to keep out of EJ-233");
  ASSERT_EQ(last.claims.size(), 1u);
  EXPECT_EQ(last.claims[0].name, "hazards");
  EXPECT_EQ(last.claims[0].value, "keep-out at EJ-233");
  EXPECT_EQ(said("Flakey, you may go to EJ-231"), "I knew of no keep-out at EJ-231");
  EXPECT_EQ(said("Flakey, you may enter this corridor"), "I knew of no keep-out at upper corridor");
  EXPECT_EQ(said("Flakey, you may go to EJ-233 again"), "good: I may go to EJ-233 again");
  EXPECT_EQ(last.claims.at(0).value, "");
  EXPECT_EQ(said("Flakey, keep out of the attic"), "I know no place called attic");
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
  EXPECT_EQ(last.namings[0].feature.id, 1235u);
  EXPECT_EQ(last.namings[0].feature.name, "Kitchen");
  EXPECT_EQ(said("Flakey, this room is called EJ-233"), "my map has EJ-233 at another place");
  EXPECT_TRUE(last.namings.empty());
  for (maps::Feature& feature : situation.map.features)
    if (feature.type == lps::PointType::corridor)
      feature.name.clear();
  EXPECT_EQ(said("Flakey, this corridor is the J-wing"), "I put it on my map: this is J-wing");
  EXPECT_EQ(last.namings.at(0).feature.type, lps::PointType::corridor);
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
  EXPECT_EQ(said("good morning"), "nobody has told me where good morning is");
  EXPECT_TRUE(last.claims.empty());
}

TEST_F(DialogueTest, KnowledgeOutlivesARestart) {
  hear("Flakey, EJ-231 is Karen's office");
  hear("Flakey, there is a spill in EJ-233");
  Dialogue restarted{grammar()};
  EXPECT_EQ(restarted.restore(dialogue.save() + "nonsense\n"), 1u);
  EXPECT_EQ(restarted.knowledge().all(), dialogue.knowledge().all());
  EXPECT_EQ(restarted.claims().size(), 2u);
}

}  // namespace
}  // namespace saphira::agent_interface
