// The programs of different robots in one domain: who hears whom, and how often they announce
// themselves.
#include "fleet.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

using namespace std::chrono_literals;

Fleet fleet(const std::string& name, const std::string& robot, Others others = Others::ignored) {
  NodeOptions options;
  options.name = name;
  options.robot = robot;
  options.others = others;
  return Fleet(options);
}

Announced announcement_of(const std::string& name, const std::string& robot,
                          Others others = Others::ignored) {
  return {name, "host=here;pid=7;" + fleet(name, robot, others).fields()};
}

TEST(Fleet, ProgramsOfOneRobotMeet) {
  const Fleet bridge = fleet("bridge", "ant");
  EXPECT_TRUE(bridge.meets(announcement_of("behaviors", "ant")));
  EXPECT_FALSE(bridge.meets(announcement_of("behaviors", "bee")));
  EXPECT_FALSE(bridge.meets(announcement_of("behaviors", "ant2")));
}

TEST(Fleet, APatternMeetsItsRobots) {
  EXPECT_TRUE(fleet("list", "*").meets(announcement_of("bridge", "ant")));
  EXPECT_TRUE(fleet("bridge", "ant").meets(announcement_of("list", "*")));
  EXPECT_TRUE(fleet("bridge", "ant").meets(announcement_of("agent", "a*")));
  EXPECT_FALSE(fleet("bridge", "bee").meets(announcement_of("agent", "a*")));
}

TEST(Fleet, AProgramThatDoesNotTellItsRobotIsMet) {
  EXPECT_TRUE(fleet("bridge", "ant").meets({"agent in C", ""}));
  EXPECT_TRUE(fleet("bridge", "ant").meets({"agent in C", "host=there;pid=1;"}));
  EXPECT_TRUE(fleet("agent", "").meets(announcement_of("bridge", "ant")));
}

TEST(Fleet, AllMeetTheOneThatMeetsOthers) {
  EXPECT_TRUE(fleet("list", "ant", Others::met).meets(announcement_of("behaviors", "bee")));
  EXPECT_TRUE(fleet("behaviors", "bee").meets(announcement_of("list", "ant", Others::met)));
  EXPECT_FALSE(fleet("console", "ant", Others::noted).meets(announcement_of("bridge", "bee")));
  EXPECT_FALSE(fleet("bridge", "bee").meets(announcement_of("console", "ant", Others::noted)));
}

TEST(Fleet, NotesTheOthersUntilTheyAreSilent) {
  Fleet console = fleet("console", "ant", Others::noted);
  const Fleet copy = console;
  const Fleet::Time begin{};
  console.note(announcement_of("bridge", "bee"), begin);
  console.note(announcement_of("bridge", "cat"), begin + 4s);
  console.note(announcement_of("bridge", "bee"), begin + 5s);
  const OtherProgram bee{"bee", "bridge"};
  const OtherProgram cat{"cat", "bridge"};
  EXPECT_EQ(copy.others(begin + 5s), (std::vector{bee, cat}));
  EXPECT_EQ(copy.others(begin + 14s), std::vector{bee});
  EXPECT_TRUE(copy.others(begin + 15s).empty());
  Fleet bridge = fleet("bridge", "ant");
  bridge.note(announcement_of("bridge", "bee"), begin);
  EXPECT_TRUE(bridge.others(begin).empty());
}

TEST(Fleet, AProgramOfOneRobotHasOnePort) {
  const auto ant = fleet("bridge", "ant").ports();
  ASSERT_EQ(ant.size(), 1);
  EXPECT_EQ(fleet("behaviors", "ant").ports(), ant);
  EXPECT_NE(fleet("bridge", "bee").ports(), ant);
  const std::vector<std::uint16_t> all{2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(fleet("console", "ant", Others::noted).ports(), all);
  EXPECT_EQ(fleet("list", "*").ports(), all);
  EXPECT_EQ(fleet("agent", "a?t").ports(), all);
  EXPECT_EQ(fleet("agent", "").ports(), all);
}

TEST(Fleet, AFieldIsAWholeOne) {
  EXPECT_EQ(field("host=a;robot=ant;far=", "robot"), "ant");
  EXPECT_EQ(field("myrobot=ant", "robot"), "");
  EXPECT_EQ(field("robot", "robot"), "");
  EXPECT_EQ(field("", "robot"), "");
}

TEST(Fleet, AnnouncementsAreRareWhileNobodyIsNew) {
  Fleet own = fleet("bridge", "ant");
  Fleet::Time now{100s};
  const auto sent_in = [&](std::chrono::milliseconds span) {
    int sent = 0;
    for (const auto end = now + span; now < end; now += 250ms)
      sent += own.is_due("data", now) ? 1 : 0;
    return sent;
  };
  EXPECT_EQ(sent_in(Fleet::kOften), 12);
  EXPECT_EQ(sent_in(10s), 5);
  own.hear("newcomer", now);
  EXPECT_EQ(sent_in(Fleet::kOften), 12);
  own.hear("newcomer", now);
  EXPECT_EQ(sent_in(10s), 5);
}

TEST(Fleet, AChangedAnnouncementIsSentAtOnceAndToAllPlaces) {
  Fleet own = fleet("bridge", "ant");
  Fleet::Time now{100s};
  EXPECT_TRUE(own.is_due("data", now));
  now += 2 * Fleet::kOften;
  EXPECT_TRUE(own.is_due("data", now));
  EXPECT_TRUE(own.is_due("data", now + 1ms));
  now += 250ms;
  EXPECT_FALSE(own.is_due("data", now));
  EXPECT_TRUE(own.is_due("other data", now));
}

}  // namespace
}  // namespace saphira::bus::internal
