#include "saphira/story/cast.hpp"

#include <gtest/gtest.h>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::story {
namespace {

std::string answer(Cast& cast, const std::string& said, const std::string& place) {
  const auto line = cast.answer(said, place);
  return line ? line->speaker + ": " + line->text : "";
}

TEST(Cast, PeopleAnswerWhereTheyAreByWhatTheyHaveAndKnow) {
  const std::string file = test::source("config/people/report.people");
  Cast cast(read_file(file), file);
  ASSERT_EQ(cast.lines().size(), 5u);
  EXPECT_EQ(cast.lines()[1].text, "Flakey, EJ-243 is Karen's office");
  EXPECT_EQ(answer(cast, "Is karen here?", "EJ-243"), "");
  EXPECT_EQ(answer(cast, "Is karen here?", "EJ-245"), "john: no, sorry");
  EXPECT_EQ(answer(cast, "Who knows where karen is?", "EJ-245"), "john: in the kitchen");
  EXPECT_EQ(answer(cast, "Who knows where bob is?", "EJ-245"), "john: I don't know");
  EXPECT_EQ(answer(cast, "Is karen here?", "kitchen"), "karen: yes");
  EXPECT_EQ(answer(cast, "Please give me the report", "kitchen"), "karen: here you are");
  EXPECT_FALSE(cast.has("karen", "report"));
  EXPECT_EQ(answer(cast, "Please give me the report", "kitchen"), "karen: no, sorry");
  EXPECT_EQ(answer(cast, "Here is the report from karen, please take it", "EJ-247"),
            "alice: thank you");
  EXPECT_TRUE(cast.has("alice", "report"));
}

TEST(Cast, WhoeverAnObjectIsForTakesItAndThePeopleKnowWhoHasIt) {
  const std::string text =
      "PERSON karen N1\nHAS report\nPERSON alice N1\nGETS report\nPERSON bob N2\n";
  Cast cast(text, "f");
  answer(cast, "Please give me the report", "N1");
  EXPECT_EQ(cast.handed_over(), "") << "the robot has it";
  EXPECT_FALSE(cast.all_got());
  EXPECT_EQ(answer(cast, "Here is the report from karen, please take it", "N1"),
            "karen: thank you");
  EXPECT_EQ(answer(cast, "Does alice have the report?", "N1"), "karen: no");
  EXPECT_EQ(cast.handed_over(), "") << "its owner has it again";
  EXPECT_FALSE(cast.all_got());
  answer(cast, "Please give me the report", "N1");
  EXPECT_EQ(answer(cast, "Here is the report from karen for alice, please take it", "N1"),
            "alice: thank you");
  EXPECT_EQ(answer(cast, "Does alice have the report?", "N1"), "karen: yes");
  EXPECT_EQ(cast.handed_over(), "alice has the report");
  EXPECT_TRUE(cast.all_got());
  answer(cast, "Please give me the report", "N1");
  answer(cast, "Here is the report from karen for alice, please take it", "N2");
  EXPECT_EQ(cast.handed_over(), "bob has the report");
  EXPECT_FALSE(cast.all_got());
}

TEST(Cast, ALineMayWaitForTheRobotAtAPlace) {
  const std::string file = test::source("config/people/introduction.people");
  const Cast cast(read_file(file), file);
  EXPECT_EQ(cast.deployment(), "seeing-office");
  EXPECT_EQ(cast.things(), test::source("config/people/introduction.wld"));
  ASSERT_GE(cast.lines().size(), 2U);
  EXPECT_FALSE(cast.lines()[0].near);
  ASSERT_TRUE(cast.lines()[1].near);
  EXPECT_EQ(cast.lines()[1].near->place, "EJ-249");
  EXPECT_EQ(cast.lines()[1].near->distance, 1.6);
  EXPECT_EQ(Cast("", "f").deployment(), "office");
}

TEST(Cast, MistakesNameLineAndColumn) {
  const auto parse = [](const std::string& text) { Cast(text, "f"); };
  EXPECT_EQ(test::each_mistake("agents/story/test/mistakes.txt", parse), 10);
}

TEST(Cast, AStoryHasABeginningAndPlacesOfTheMap) {
  const auto mistake = [](const std::string& text) {
    const std::string what = test::trouble_of<FileError>(
        [&] { Cast(text, "f").check([](const std::string& place) { return place == "N1"; }); });
    return what.empty() ? "none" : what.substr(0, what.find('\n'));
  };
  const std::string nobody =
      "f:1:1: expected a line SAYS PERSON SENTENCE: without one the story does not begin";
  EXPECT_EQ(mistake(""), nobody);
  EXPECT_EQ(mistake("PERSON alice N1\n"), nobody);
  const std::string begun = "PERSON alice N1\nSAYS alice go\n";
  EXPECT_EQ(mistake(begun), "none");
  EXPECT_EQ(mistake(begun + "PERSON john N2\n"),
            "f:3:13: expected a place of the map, found \"N2\"");
  EXPECT_EQ(mistake(begun + "KNOWS john N3\n"),
            "f:3:12: expected a place of the map, found \"N3\"");
  EXPECT_EQ(mistake(begun + "NEAR N4 1\nSAYS alice stop\n"),
            "f:3:6: expected a place of the map, found \"N4\"");
}

TEST(Cast, TheEndIsWhatTheRobotSaysLast) {
  EXPECT_TRUE(Cast("", "f").ends_well("done: the report was brought"));
  EXPECT_FALSE(Cast("", "f").ends_well("that failed: nobody is in"));
  EXPECT_TRUE(Cast("ENDS that failed: nobody\n", "f").ends_well("that failed: nobody is in"));
}

}  // namespace
}  // namespace saphira::story
