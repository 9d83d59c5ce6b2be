#include "saphira/mcp/surroundings.hpp"

#include <gtest/gtest.h>

#include "saphira/mcp/results.hpp"

namespace saphira::mcp {
namespace {

v1::Pose2 pose(double x, double y, double th) {
  return {.x = x, .y = y, .th = th};
}

v1::MapArtifact artifact(std::uint32_t id, v1::ArtifactType type, const std::string& name, double x,
                         double y) {
  return {.id = id, .type = type, .pose_in_map = pose(x, y, 0.0), .name = name};
}

class SurroundingsTest : public testing::Test {
 protected:
  SurroundingsTest() {
    map_.source = "floor.map";
    map_.artifacts = {artifact(1, v1::ARTIFACT_OFFICE, "library", 9.0, 0.0),
                      artifact(2, v1::ARTIFACT_OFFICE, "lobby", 2.0, 0.0),
                      artifact(3, v1::ARTIFACT_DOOR, "lobby", 2.0, 1.0),
                      artifact(4, v1::ARTIFACT_CORRIDOR, "", 0.0, 0.0)};
    registration_.state = v1::REGISTRATION_TRACKING;
    registration_.pose_in_map = pose(1.0, 0.0, 0.0);
    registration_.covariance.xx = 0.01;
    registration_.covariance.yy = 0.01;
    registration_.environment = 4;
    registration_.closed_doors = {3};
    robot_.pose_in_odom = pose(5.0, 5.0, 1.5707963);  // it looks along y of odom
  }
  v1::FloorMap map_;
  v1::Registration registration_;
  v1::RobotState robot_;
  v1::Perception perception_;
  v1::Vision vision_;
  v1::SonarBuckets sonars_;
};

TEST_F(SurroundingsTest, TheMapSaysWhereTheRobotIsAndWhereItCanBeSent) {
  Surroundings around;
  around.map = &map_;
  around.registration = &registration_;
  const Result result = map_of(around);
  EXPECT_EQ(result.text,
            "the robot is at (1.00, 0.00) m, heading 0.00 rad, sure to 0.10 m, in corridor 4\n"
            "places, nearest first:\n"
            "lobby (room) at (2.00, 0.00)\n"
            "library (room) at (9.00, 0.00)\n"
            "closed: lobby (door)");
  EXPECT_EQ(result.value["places"][1]["name"], "library");
  EXPECT_EQ(result.value["robot"]["in"], "corridor 4");
  EXPECT_EQ(result.value["closed_doors"], Json::array({"lobby (door)"}));
  EXPECT_EQ(misfit(result.value, form_of("map")), "");
}

TEST_F(SurroundingsTest, APlaceThatIsNotKnownIsNotSaid) {
  registration_.state = v1::REGISTRATION_LOST;
  registration_.reason = "the walls do not fit";
  Surroundings around;
  around.map = &map_;
  around.registration = &registration_;
  const Result result = map_of(around);
  EXPECT_EQ(result.text.substr(0, result.text.find('\n')),
            "the robot's place on the map is not known: the walls do not fit");
  EXPECT_FALSE(result.value.contains("robot"));
  EXPECT_FALSE(map_of({}).is_error);
  EXPECT_EQ(misfit(map_of({}).value, form_of("map")), "");
}

TEST_F(SurroundingsTest, TheViewIsInTheFrameOfTheRobotNearestFirst) {
  v1::Percept wall;  // along y of odom, so along the robot's way, 1 m to its left
  wall.type = v1::ARTIFACT_WALL;
  wall.pose_in_odom = pose(4.0, 7.0, 1.5707963);
  wall.length = 6.0;
  v1::Percept door{.type = v1::ARTIFACT_DOOR, .pose_in_odom = pose(6.0, 6.0, 0.0), .width = 0.9};
  perception_.percepts = {door, wall};
  v1::SeenThing person{.kind = v1::SEEN_PERSON,
                       .pose_in_odom = pose(5.0, 7.5, 0.0),
                       .range_known = true,
                       .points = 3.0,
                       .pointed = 95};
  vision_.stamp.cycle = 100;
  vision_.things = {person};
  v1::SonarBucket behind;  // read half a metre further back
  behind.reading.echo = true;
  behind.pose_in_odom = pose(5.0, 4.5, 1.5707963);
  behind.x = -2.5;
  v1::SonarBucket silent = behind;
  silent.reading.echo = false;
  silent.x = -0.1;
  sonars_.buckets = {behind, silent};
  const Result result = view_of({&robot_, &sonars_, nullptr, nullptr, &perception_, &vision_});
  EXPECT_EQ(result.text,
            "1.00 m left: wall, 6.0 m long\n"
            "1.41 m ahead right: door, open, 0.9 m wide\n"
            "2.50 m ahead: person, points left\n"
            "3.00 m behind: echo");
  EXPECT_EQ(result.value["seen"][1]["x"], 1.0);
  EXPECT_EQ(result.value["seen"][1]["y"], -1.0);
  EXPECT_EQ(misfit(result.value, form_of("look")), "");
}

TEST_F(SurroundingsTest, SamplesOfAnotherFrameAreLeftOut) {
  v1::Percept wall{.type = v1::ARTIFACT_WALL};
  perception_.percepts = {wall};
  perception_.odom = 7;
  EXPECT_EQ(view_of({&robot_, nullptr, nullptr, nullptr, &perception_, nullptr}).text,
            "nothing is near, or no sensor is heard");
  EXPECT_TRUE(view_of({}).is_error);
}

TEST(McpFacts, TheKnowledgeHasTheNumbersThatForgetTakes) {
  EXPECT_TRUE(facts_of(nullptr).is_error);
  v1::Knowledge knowledge;
  EXPECT_EQ(facts_of(&knowledge).text, "the robot was told nothing that it knows now");
  EXPECT_FALSE(facts_of(&knowledge).is_error);
  v1::Advice office{.number = 3};
  office.words = "room EJ-231 is Karen's office";
  office.speaker = "ann";
  office.said = "Flakey, this is Karen's office";
  office.time = 1764160200.0;
  v1::Advice hazard{.number = 4, .words = "there is a hole in the lobby"};
  knowledge.known = {office, hazard};
  const Result result = facts_of(&knowledge);
  EXPECT_EQ(result.text,
            "what people told the robot, by number:\n"
            "3: room EJ-231 is Karen's office (by ann, 2025-11-26 12:30 UTC: \"Flakey, this is "
            "Karen's office\")\n"
            "4: there is a hole in the lobby (by somebody)");
  EXPECT_EQ(result.value["known"][0]["number"], 3);
  EXPECT_EQ(result.value["known"][0]["time"], "2025-11-26 12:30 UTC");
  EXPECT_EQ(result.value["known"][1]["time"], nullptr);
  EXPECT_FALSE(result.is_error);
  EXPECT_EQ(misfit(result.value, form_of("knows")), "");

  knowledge.known = std::vector<v1::Advice>(201, office);
  const Result many = facts_of(&knowledge);
  EXPECT_EQ(many.value["known"].size(), 200U);
  EXPECT_NE(many.text.find("(older ones are left out: 1)"), std::string::npos);
}

}  // namespace
}  // namespace saphira::mcp
