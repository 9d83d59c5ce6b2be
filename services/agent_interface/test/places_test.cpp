// The dialogue: places, and those that it keeps out of.
#include <numbers>

#include "dialogue_fixture.hpp"

namespace saphira::agent_interface {
namespace {

TEST_F(DialogueTest, ThisOfficeIsTheNearestDoorway) {
  EXPECT_EQ(said("Flakey, this is Karen's office"), "I know now that EJ-231 is karen's office");
  ASSERT_EQ(dialogue.knowledge().all().size(), 1u);
  EXPECT_EQ(dialogue.knowledge().all()[0].artifact, 1231u);
  EXPECT_EQ(dialogue.knowledge().all()[0].speaker, "Alice");
  EXPECT_EQ(claims(), "place-of-karen=EJ-231");
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

TEST_F(DialogueTest, AKeepOutOnTheWayIsAnsweredWithItsConsequence) {
  situation.map = maps::parse_map(std::string(kMap) + R"(
OFFICE (235) 5000, 8000, 0, 8000, 4000 "EJ-235"
DOOR (1236) 3000, 6000, -90, 900
DOOR (1237) 7000, 6000, -90, 900
)",
                                  "map");
  EXPECT_EQ(said("Flakey, keep out of EJ-233"), "I know now that I am to keep out of EJ-233");
  hear("Flakey, you may go to EJ-233");
  hear("Flakey, go to EJ-235");
  EXPECT_EQ(said("Flakey, there is a ladder in EJ-231", "Bob"),
            "I know now that there is a ladder at EJ-231; so I look for another way");
  EXPECT_EQ(said("Flakey, go slowly in EJ-235", "Bob"),
            "I know now that I am to go slowly in EJ-235");
  EXPECT_EQ(said("Flakey, keep out of EJ-233", "Bob"),
            "I know now that I am to keep out of EJ-233; so the way to EJ-235 for Alice ends");
  EXPECT_TRUE(last.canceled.empty()) << "its activity ends it, with the reason";
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

}  // namespace
}  // namespace saphira::agent_interface
