#include "saphira/cli/map_words.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "saphira/base/text.hpp"

namespace saphira::cli {
namespace {

maps::Map a_map() {
  return maps::parse_map(
      "CORRIDOR (1) 0, 0, 0, 10000, 2000 \"hall\"\nPOS (9) 1000, 2000, 90 \"start\"\n"
      "DOOR (3) 2000, 1000, -90, 900\n",
      "a.map");
}

Request parse(const std::vector<std::string>& words) {
  return parse_map_request(words, a_map());
}

std::string parsed(const std::vector<std::string>& words) {
  return describe(parse(words));
}

std::string complaint(const std::vector<std::string>& words) {
  try {
    parse(words);
  } catch (const std::invalid_argument& error) {
    return error.what();
  } catch (const FileError& error) {
    return std::string("file: ") + error.what();
  }
  return "nothing";
}

TEST(MapWords, AreRequests) {
  EXPECT_EQ(parsed({"delete"}), "delete");
  EXPECT_EQ(parsed({"find"}), "find");
  EXPECT_EQ(parsed({"on"}), "switch on=yes");
  EXPECT_EQ(parsed({"off"}), "switch on=no");
  EXPECT_EQ(parsed({"features", "on"}), "add_features on=yes");
  EXPECT_EQ(parsed({"snap", "off"}), "snap on=no");
  EXPECT_EQ(parsed({"remove", "12"}), "remove id=12");
  EXPECT_EQ(parsed({"place", "1.5", "-2", "0.5"}), "place position=(1.5, -2, 0.5)");
  EXPECT_EQ(parsed({"place", "150cm", "-2m", "90deg"}), "place position=(1.5, -2, 1.5708)");
  const Pose named = point_of(parse({"place", "start"}).arguments, "position");
  EXPECT_EQ(named.x, 1.0);
  EXPECT_NEAR(named.th, std::numbers::pi / 2, 1e-12);
  const Request put = parse({"put", "DOOR (3) 3000, 1000, 90, 900 \"EJ-231\""});
  EXPECT_EQ(put.functor, "put");
  EXPECT_EQ(number_of(put.arguments, "id"), 3.0);
  EXPECT_EQ(text_of(put.arguments, "type"), "DOOR");
  EXPECT_EQ(text_of(put.arguments, "name"), "EJ-231");
  EXPECT_EQ(saphira::find(put.arguments, "rule"), nullptr);
  const Request zone = parse({"put", "ZONE (4) 0, 0, 0, 900, 900 slow 150 \"kitchen\""});
  EXPECT_EQ(text_of(zone.arguments, "rule"), "slow");
  EXPECT_DOUBLE_EQ(number_of(zone.arguments, "speed"), 0.15);
}

TEST(MapWords, SayWhatWasExpected) {
  EXPECT_EQ(complaint({"sing"}),
            "expected follow, list, save, show, build, load, delete, put, remove, place, find, on, "
            "off, features, snap or route, found \"sing\"");
  EXPECT_EQ(complaint({"remove"}), "expected remove ID, found 0 words after it");
  EXPECT_EQ(complaint({"route", "EJ", "265"}), "expected route PLACE, found 2 words after it");
  EXPECT_EQ(complaint({"list", "it"}), "expected list, found 1 word after it");
  EXPECT_EQ(complaint({"remove", "-1"}), "expected the id of an artifact, found \"-1\"");
  EXPECT_EQ(complaint({"place", "nowhere"}),
            "expected place X Y TH [m, rad] or the name of a POS; the map has no POS \"nowhere\"");
  EXPECT_EQ(complaint({"place", "1", "x", "0"}), "expected y [m], found \"x\"");
  EXPECT_EQ(complaint({"place", "1", "2", "0m"}), "expected the heading [rad], found \"0m\"");
  EXPECT_EQ(complaint({"features", "maybe"}), "expected on or off, found \"maybe\"");
  EXPECT_NE(complaint({"put", "DOR (3) 1, 2, 3, 4"}).find("the line:1:1"), std::string::npos);
  EXPECT_NE(complaint({"put", ""}).find("expected one artifact"), std::string::npos);
}

TEST(MapWords, LoadRefusesAFileThatWasCutOff) {
  const std::string path =
      testing::TempDir() + "saphira-cut-words-" + std::to_string(::getpid()) + ".map";
  const auto loaded = [&path](const std::string& text) {
    std::ofstream(path) << text;
    return complaint({"load", path});
  };
  EXPECT_EQ(loaded("DOOR (2) 1000, 2000, 90, 900\n"), "nothing");
  const std::string said = loaded("DOOR (2) 1000, 2000, 90, 90");
  EXPECT_NE(said.find(".map:1:"), std::string::npos) << said;
  EXPECT_NE(said.find("cut off"), std::string::npos) << said;
  std::remove(path.c_str());
}

TEST(MapWords, DescribeWhereTheRobotIs) {
  v1::Registration registration{.state = v1::REGISTRATION_TRACKING,
                                .pose_in_map = {.x = 1.0, .y = 2.0},
                                .covariance = {.xx = 0.01},
                                .confidence = 0.9,
                                .environment = 1};
  EXPECT_EQ(describe(registration, a_map()),
            "tracking (1.00, 2.00, 0 deg) +-0.10 m, 0.0 deg, 90 % sure, in corridor 1 (hall)");
  registration.closed_doors = {3, 77};
  EXPECT_NE(describe(registration, a_map()).find("(hall), door 3 closed"), std::string::npos)
      << "and no word on one that the map does not have";
}

}  // namespace
}  // namespace saphira::cli
