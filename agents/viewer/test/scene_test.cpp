#include "saphira/viewer/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "saphira/viewer/schema.hpp"

namespace saphira::viewer {
namespace {

using nlohmann::json;

/// Viewers read a schema whose every place has one type, in words: the first that does not.
std::string unreadable(const json& schema, const std::string& place) {
  static const std::set<std::string> simple{"boolean", "number", "integer", "string"};
  if (!schema.contains("type") || !schema["type"].is_string())
    return place;
  const std::string type = schema["type"];
  if (type == "array")
    return schema["items"].value("type", "array") == "array" ? place
                                                             : unreadable(schema["items"], place);
  if (type != "object")
    return simple.contains(type) ? "" : place;
  if (!schema.contains("properties"))
    return place;
  for (const auto& [name, member] : schema["properties"].items())
    if (const std::string found = unreadable(member, place + "." + name); !found.empty())
      return found;
  return {};
}

TEST(Schema, EachPlaceHasOneType) {
  for (const char* type :
       {"saphira::v1::RobotState", "saphira::v1::GridTile", "saphira::v1::Registration",
        "saphira::v1::GoalStatus", "saphira::v1::Intentions", "saphira::v1::Answer"})
    EXPECT_EQ(unreadable(json::parse(schema_of(type)), type), "");
  for (const DrawnChannel& drawn : drawn_channels())
    EXPECT_EQ(unreadable(json::parse(drawn_schema(drawn.type)), drawn.type), "");
  const json state = json::parse(schema_of("saphira::v1::RobotState"));
  EXPECT_EQ(state["title"], "saphira::v1::RobotState");
  EXPECT_EQ(state["properties"]["velocity"]["type"], "number");
  EXPECT_EQ(state["properties"]["status"]["enum"][2], "MOTORS_STOPPED");
  EXPECT_EQ(state["properties"]["sonars"]["items"]["properties"]["echo"]["type"], "boolean");
}

constexpr std::int64_t kNow = 1'700'000'000'250'000'000;

json content(const Scene::Messages& messages, const std::string& topic) {
  for (const DrawnMessage& each : messages)
    if (drawn_channels()[each.channel].topic == topic)
      return json::parse(each.json);
  return {};
}

TEST(Scene, RobotIsOnTheMapWhileItsPositionIsKnown) {
  Scene scene(0.0);
  v1::RobotState state{.odom = 3, .pose_in_odom = {1.0, 0.0, 0.0}};
  EXPECT_EQ(content(scene.take(state, kNow), "viewer/pose")["frame_id"], "odom");
  v1::Registration registration{.state = v1::REGISTRATION_TRACKING,
                                .odom = 3,
                                .odom_in_map = {10.0, 20.0, std::acos(-1.0) / 2}};
  scene.take(registration);
  const Scene::Messages messages = scene.take(state, kNow);
  const json pose = content(messages, "viewer/pose");
  EXPECT_EQ(pose["frame_id"], "map");
  EXPECT_EQ(pose["timestamp"], json::parse(R"({"sec":1700000000,"nsec":250000000})"));
  EXPECT_NEAR(pose["pose"]["position"]["x"], 10.0, 1e-12);
  EXPECT_NEAR(pose["pose"]["position"]["y"], 21.0, 1e-12);
  EXPECT_NEAR(pose["pose"]["orientation"]["w"], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(content(messages, "viewer/transforms")["transforms"].size(), 2U);
  for (const auto lose : {0, 1}) {
    v1::Registration other = registration;
    other.state = lose == 0 ? v1::REGISTRATION_LOST : v1::REGISTRATION_TRACKING;
    other.odom = lose == 0 ? 3 : 4;
    scene.take(other);
    EXPECT_EQ(content(scene.take(state, kNow), "viewer/pose")["frame_id"], "odom") << lose;
  }
}

TEST(Scene, EchoesArePoints) {
  v1::SonarBuckets sonars;
  v1::SonarBucket heard;
  heard.reading.echo = true;
  heard.pose_in_odom = {1.0, 2.0, std::acos(-1.0)};
  heard.x = 0.5;
  v1::SonarBucket silent;
  sonars.buckets = {heard, silent};
  const json cloud = content(Scene::take(sonars, kNow), "viewer/sonars");
  EXPECT_EQ(cloud["point_stride"], 12);
  EXPECT_EQ(cloud["data"].get<std::string>().size(), 16U) << "one point of 12 bytes in base64";
  EXPECT_EQ(cloud["data"].get<std::string>().substr(0, 6), "AAAAPw") << "0.5 as a float";
}

TEST(Scene, APictureIsACompressedImage) {
  v1::CameraPicture picture{.jpeg = {'f', 'o', 'o'}};
  const json image = content(Scene::take(picture, kNow), "viewer/camera");
  EXPECT_EQ(image["data"], "Zm9v");
  EXPECT_EQ(image["format"], "jpeg");
}

v1::GridTile tile(std::int32_t column, std::int32_t row, std::uint8_t value) {
  v1::GridTile made{.column = column, .row = row, .odom = 1, .resolution = 0.5, .side = 2};
  made.cells.assign(4, value);
  return made;
}

TEST(Scene, TilesAreOneGrid) {
  Scene scene(1.0);
  const json first = content(scene.take(tile(-1, 0, 0), false, kNow), "viewer/grid");
  EXPECT_EQ(first["column_count"], 2);
  EXPECT_EQ(first["pose"]["position"]["x"], -1.0);
  EXPECT_EQ(first["data"], "AAAAAA==");
  EXPECT_TRUE(scene.take(tile(0, 0, 100), false, kNow + 500'000'000).empty()) << "too soon";
  const json both =
      content(scene.take(tile(0, 0, 100), false, kNow + 1'000'000'000), "viewer/grid");
  EXPECT_EQ(both["column_count"], 4);
  EXPECT_EQ(both["data"], "AABkZAAAZGQ=");
  const json left = content(scene.take(tile(-1, 0, 0), true, kNow + 2'000'000'000), "viewer/grid");
  EXPECT_EQ(left["column_count"], 2);
  EXPECT_EQ(left["data"], "ZGRkZA==");
  EXPECT_TRUE(scene.take(tile(1'000'000'000, 0, 1), false, kNow + 3'000'000'000).empty())
      << "a grid that no memory holds";
  v1::GridTile cut = tile(5, 5, 1);
  cut.odom = 2;
  cut.cells.resize(1);
  EXPECT_EQ(content(scene.take(cut, false, kNow + 4'000'000'000), "viewer/grid")["data"],
            "/////w==")
      << "a tile with fewer cells than it says";
}

TEST(Scene, MapHasLinesAndNames) {
  v1::FloorMap map;
  v1::MapArtifact corridor{
      .id = 1, .type = v1::ARTIFACT_CORRIDOR, .length = 10.0, .width = 2.0, .name = "hall"};
  v1::MapArtifact door{.id = 2,
                       .type = v1::ARTIFACT_DOOR,
                       .pose_in_map = {0.0, 1.0, -std::acos(-1.0) / 2},
                       .width = 1.0};
  map.artifacts = {corridor, door};
  const json entity = content(Scene::take(map, kNow), "viewer/scene")["entities"][0];
  EXPECT_EQ(entity["frame_id"], "map");
  EXPECT_EQ(entity["texts"][0]["text"], "hall");
  EXPECT_EQ(entity["lines"][0]["points"].size(), 10U) << "two ends, one side, and one in two parts";
  EXPECT_EQ(entity["lines"][1]["points"].size(), 2U);
  EXPECT_NEAR(std::abs(entity["lines"][1]["points"][0]["x"].get<double>()), 0.5, 1e-9);
}

TEST(Scene, LogKeepsLevelAndTime) {
  v1::LogRecord record{.level = v1::LOG_WARNING, .time_ns = kNow, .text = "a broken \xFF byte"};
  const json log = content(Scene::take(record), "viewer/log");
  EXPECT_EQ(log["level"], 3);
  EXPECT_EQ(log["timestamp"]["nsec"], 250'000'000);
  EXPECT_EQ(log["message"], "a broken \xEF\xBF\xBD byte");
}

}  // namespace
}  // namespace saphira::viewer
