#include "saphira/maps/map.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "lines.hpp"
#include "saphira/base/random.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/maps/topology.hpp"
#include "trouble.hpp"

namespace saphira::maps {
namespace {

using lps::PointType;

/// The message of its FileError.
template <class F>
std::string trouble(F&& f) {
  return test::trouble_of<FileError>(std::forward<F>(f));
}

// Manual 6.9.1 as it is printed.
constexpr const char* kManualsExample =
    ";;\n"
    ";; Map of a small portion of the SRI AIC\n"
    ";;\n"
    "CORRIDOR (1) 0, 0, 0, 10000, 2000\n"
    "CORRIDOR (2) 0, 0, 90, 10000, 2000\n"
    "DOOR (3) 3000, 1000, 90, 1000\n"
    "WALL 1000, 1000, 0, 3000\n";

TEST(Map, TheManualsExampleLoads) {
  const Map map = parse_map(kManualsExample, "aic.map");
  ASSERT_EQ(map.features.size(), 4U);
  EXPECT_EQ(map.features[0],
            (Feature{PointType::corridor, 1, {0.0, 0.0, 0.0}, 10.0, 2.0, std::string()}));
  EXPECT_EQ(map.features[1],
            (Feature{PointType::corridor, 2, {0.0, 0.0, kPi / 2}, 10.0, 2.0, std::string()}));
  EXPECT_EQ(map.features[2],
            (Feature{PointType::door, 3, {3.0, 1.0, kPi / 2}, 0.0, 1.0, std::string()}));
  EXPECT_EQ(map.features[3],
            (Feature{PointType::wall, 0, {1.0, 1.0, 0.0}, 3.0, 0.0, std::string()}));
}

TEST(Map, BlanksCommasCaseAndLineEnds) {
  const Map map = parse_map(
      "office (7) 1000 2000 -270 4000 3000 \"EJ-231; south\" ; the comment\r\n"
      "  POS ( 8 ) +1e3,2000 , 0;x\n"
      "\n"
      "BREAK(9)0,0,180,2500",
      "m");
  ASSERT_EQ(map.features.size(), 3U);
  EXPECT_EQ(map.features[0].name, "EJ-231; south");
  EXPECT_NEAR(map.features[0].pose_in_map.th, kPi / 2, 1e-12);
  EXPECT_EQ(map.features[1].pose_in_map, (Pose{1.0, 2.0, 0.0}));
  EXPECT_EQ(map.features[2].id, 9U);
  EXPECT_DOUBLE_EQ(map.features[2].width, 2.5);
}

TEST(Map, FindsByIdAndName) {
  const Map map = parse_map(
      "WALL 0, 0, 0, 1000\nOFFICE (1) 0,0,90,4000,2000 \"EJ-231\"\nDOOR (2) 0,0,0,900 \"EJ-231\"",
      "m");
  ASSERT_NE(find(map, 2), nullptr);
  EXPECT_EQ(find(map, 2)->type, PointType::door);
  EXPECT_EQ(find(map, 3), nullptr);
  EXPECT_EQ(find(map, 0), nullptr);
  ASSERT_EQ(named(map, PointType::office, "EJ-231").size(), 1U);
  EXPECT_TRUE(named(map, PointType::office, "EJ-233").empty());
  // 4 m along y, 2 m along x.
  EXPECT_TRUE(contains(map.features[1], {0.9, 1.9}));
  EXPECT_FALSE(contains(map.features[1], {1.1, 0.0}));
}

TEST(Map, ZonesHaveARule) {
  const Map map = parse_map(
      "ZONE (900) 1000, 2000, 90, 3000, 1000 keep-out \"lab\"\n"
      "ZONE (901) 0 0 0 3000 1000 slow 150 \"kitchen\"\n"
      "zone (902) 0, 0, 180, 3000, 1000 one-way\n"
      "ZONE (903) 0, 0, 0, 3000, 1000 preferred ; no name\n",
      "m");
  ASSERT_EQ(map.features.size(), 4U);
  EXPECT_EQ(map.features[0], (Feature{PointType::zone,
                                      900,
                                      {1.0, 2.0, kPi / 2},
                                      3.0,
                                      1.0,
                                      "lab",
                                      false,
                                      ZoneRule::keep_out,
                                      0.0}));
  EXPECT_EQ(map.features[1].rule, ZoneRule::slow);
  EXPECT_DOUBLE_EQ(map.features[1].speed, 0.15);
  EXPECT_EQ(map.features[2].rule, ZoneRule::one_way);
  EXPECT_EQ(map.features[3].rule, ZoneRule::preferred);
  EXPECT_EQ(describe(map.features[0]), "keep-out zone 900 (lab)");
  EXPECT_EQ(describe(map.features[2]), "one-way zone 902");
  EXPECT_NE(to_text(map).find("ZONE (901) 0, 0, 0, 3000, 1000 slow 150 \"kitchen\""),
            std::string::npos)
      << to_text(map);
  // A zone is no place and no way.
  const Topology topology(map);
  EXPECT_TRUE(topology.regions().empty());
  EXPECT_FALSE(topology.place("lab"));
  EXPECT_TRUE(same_places(map, Map{}));
  const std::string picture = to_svg({map, "", {}, {}, {}, {}, {}, {}, {}, {}});
  for (const char* const name : {"keep-out lab", "slow kitchen", "one-way 902", "preferred 903"})
    EXPECT_NE(picture.find(name), std::string::npos) << name;
  for (const auto& [line, why] :
       {std::pair{"ZONE (1) 0,0,0,1,1", "keep-out, slow, one-way or preferred, found the end"},
        {"ZONE (1) 0,0,0,1,1 fast", "found \"fast\""},
        {"ZONE (1) 0,0,0,1,1 slow", "expected the speed in mm/s, found the end of the line"},
        {"ZONE (1) 0,0,0,1,1 slow 0", "expected the speed in mm/s between 1 and 10000"},
        {"ZONE (1) 0,0,0,1,1 keep-out 3", "found \"3\""}})
    EXPECT_TRUE(test::has(trouble([&] { parse_map(line, "m"); }), why)) << line;
}

TEST(Map, WhatIsWrittenIsReadAgain) {
  Random random(3);
  Map map;
  const PointType types[] = {PointType::corridor, PointType::door,     PointType::wall,
                             PointType::lane,     PointType::junction, PointType::office,
                             PointType::breach,   PointType::object,   PointType::position,
                             PointType::zone};
  for (std::uint32_t i = 0; i < 1000; ++i) {
    Feature feature;
    feature.type = types[i % 10];
    feature.id = feature.type == PointType::wall ? 0 : i + 1;
    feature.pose_in_map = {random.uniform(-1e4, 1e4), random.uniform(-50.0, 50.0),
                           random.uniform(-kPi, kPi)};
    feature.length = random.uniform(0.001, 100.0);
    feature.width = random.uniform(0.001, 100.0);
    if (feature.type == PointType::zone)
      feature.rule = static_cast<ZoneRule>(i / 10 % 4);
    if (feature.rule == ZoneRule::slow)
      feature.speed = random.uniform(0.001, 10.0);
    if (i % 3 == 0)
      feature.name = "room " + std::to_string(i);
    map.features.push_back(feature);
  }
  const std::string text = to_text(map);
  const Map again = parse_map(text, "written.map");
  ASSERT_EQ(again.features.size(), map.features.size());
  for (std::size_t i = 0; i < map.features.size(); ++i) {
    const Feature& a = map.features[i];
    const Feature& b = again.features[i];
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.rule, b.rule);
    EXPECT_NEAR(a.speed, b.speed, 1e-6);
    EXPECT_NEAR((a.pose_in_map.position() - b.pose_in_map.position()).norm(), 0.0, 1e-6);
    EXPECT_NEAR(sub2_angle(a.pose_in_map.th, b.pose_in_map.th), 0.0, 1e-7);
    if (b.length != 0.0) {
      EXPECT_NEAR(a.length, b.length, 1e-6);
    }
  }
  // Everything in a file is kept.
  EXPECT_EQ(to_text(again), text);
  EXPECT_EQ(parse_map(to_text(again), "m"), again);
  EXPECT_EQ(to_text(parse_map(kManualsExample, "m")),
            std::string(kManualsExample).substr(std::string(kManualsExample).find("CORR")));
}

TEST(Map, WhatNoFileHoldsIsNotWritten) {
  const Feature door{PointType::door, 1, {}, 0.0, 0.9, "EJ-231"};
  EXPECT_NO_THROW(to_text({{door}}));
  EXPECT_THROW(to_text({{door, door}}), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Feature& wrong : {Feature{PointType::door, 0, {}, 0.0, 0.9, "EJ-231"},
                               Feature{PointType::door, 1, {}, 0.0, 0.0, "EJ-231"},
                               Feature{PointType::door, 1, {}, 0.0, 0.9, "\""},
                               Feature{PointType::door, 1, {nan, 0.0, 0.0}, 0.0, 0.9, "EJ-231"},
                               Feature{PointType::invalid, 1, {}, 0.0, 0.9, "EJ-231"}})
    EXPECT_THROW(to_text({{wrong}}), std::invalid_argument);
}

TEST(MapFile, MistakesSayWhereAndWhatWasExpected) {
  EXPECT_EQ(test::each_mistake("services/common/maps/test/mistakes.txt",
                               [](const std::string& text) { parse_map(text, "broken.map"); }),
            20);
}

TEST(MapFile, ThatIsUnlikelyIsRefused) {
  const std::string path =
      ::testing::TempDir() + "saphira-unlikely-" + std::to_string(::getpid()) + ".map";
  const auto loading = [&path](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    const std::string what = trouble([&] { load_map(path); });
    return what.empty() ? "" : what.substr(path.size(), what.find('\n') - path.size());
  };
  const std::string nothing = ":1:1: expected a line for each artifact of the map, found none";
  EXPECT_EQ(loading(""), nothing);
  EXPECT_EQ(loading("; my floor\n"), nothing);
  const std::string metres =
      "; my floor\nWALL 0, 0, 0, 38\nWALL 0, 0, 90, 27.5\nDOOR (1) 12, 20, 90, 1\n";
  EXPECT_EQ(loading(metres),
            ":2:1: the whole map is smaller than a robot: is it in metres? The unit of this file "
            "is mm");
  EXPECT_EQ(loading(metres + "WALL 0, 0, 0, 400\n"), "");
  const std::string room = "WALL 0, 0, 0, 9000\nWALL 0, 0, 90, 9000\nWALL 9000, 0, 90, 9000\n";
  EXPECT_EQ(loading(room + "DOOR (1) 99000, 0, 90, 1000\n"),
            ":4:1: expected a place near the other artifacts of the map, found one 85 m off (a "
            "digit too many?)");
  EXPECT_EQ(loading(room + "DOOR (1) 20000, 0, 90, 1000\n"), "");
  EXPECT_EQ(loading("POS (1) 0, 0, 0\nPOS (2) 90000, 0, 0\nPOS (3) 180000, 0, 0\n"
                    "POS (4) 270000, 0, 0\n"),
            "")
      << "a large place";
  EXPECT_EQ(loading("POS (1) 0, 0, 0 \"home\"\n"), "");
  EXPECT_EQ(loading("POS (1) 0, 0, 0 \"a b\"\n\n; next\nPOS (2) 900, 0, 0 \"a b\"\n"),
            ":4:19: expected a name of its own: the POS of line 1 is \"a b\", too");
  EXPECT_EQ(loading("POS (1) 0, 0, 0\nPOS (2) 900, 0, 0\nOFFICE (3) 0, 0, 0, 900, 900 \"a\"\n"
                    "POS (4) 900, 0, 0 \"a\"\n"),
            "");
  std::remove(path.c_str());
}

TEST(MapFile, ThatWasCutWithinANumberIsRefused) {
  const std::string path =
      ::testing::TempDir() + "saphira-cut-" + std::to_string(::getpid()) + ".map";
  const auto load = [&path](const std::string& text) {
    std::ofstream(path) << text;
    return load_map(path).features.size();
  };
  EXPECT_EQ(load("DOOR (1) 1000, 2000, 90, 900\n"), 1U);
  EXPECT_EQ(load("DOOR (1) 1000, 2000, 90, 900 \"EJ-231\""), 1U) << "a name is whole";
  const std::string cut =
      trouble([&] { load("DOOR (1) 1000, 2000, 90, 900\nDOOR (2) 1000, 2000, 90, 90"); });
  EXPECT_TRUE(test::has(cut, ".map:2:") && test::has(cut, "cut off")) << cut;
  EXPECT_TRUE(test::has(trouble([&] {
                          load(
                              "\xFF\xFE"
                              "D O O R");
                        }),
                        "this is a text in UTF-16"));
  std::remove(path.c_str());
}

// With its traits each type is read, written, drawn and driven through.
TEST(ArtifactTraits, AreAllThatMapsAskOfAType) {
  std::set<std::string_view> words;
  for (const ArtifactTraits& each : kArtifactTraits) {
    Feature feature;
    feature.type = each.type;
    feature.id = each.id ? 7 : 0;
    feature.pose_in_map = {1.0, 2.0, 0.5};
    feature.length = each.length ? 3.0 : 0.0;
    feature.width = each.width ? 2.0 : 0.0;
    if (each.word.empty()) {
      EXPECT_EQ(each.type, PointType::invalid);
      EXPECT_THROW(to_text({{feature}}), std::invalid_argument);
      continue;
    }
    EXPECT_TRUE(words.insert(each.word).second) << each.word;
    const std::string text = to_text({{feature}});
    EXPECT_TRUE(text.starts_with(each.word)) << text;
    const Map read = parse_map(text, "test");
    ASSERT_EQ(read.features.size(), 1U);
    EXPECT_EQ(read.features[0].type, each.type);
    EXPECT_EQ(to_text(read), text);
    EXPECT_EQ(Topology(read).regions().size(), each.region ? 1U : 0U) << each.word;
    Drawing drawing;
    drawing.map = read;
    const std::string svg = to_svg(drawing);
    EXPECT_TRUE(each.area.empty() || svg.find(each.area) != std::string::npos) << each.word;
  }
  EXPECT_EQ(words.size(), kArtifactTraits.size() - 1);
}

TEST(MapFile, WhatTheRobotHasAddedIsStillItsOwnAfterSavingAndLoading) {
  const std::string text =
      "CORRIDOR (1) 5000, 0, 0, 10000, 2000 \"hall\"\n"
      "WALL 5000, 3000, 0, 2000 learned\n"
      "DOOR (2) 3000, 1000, -90, 900 \"A\" learned\n";
  const Map map = parse_map(text, "own.map");
  ASSERT_EQ(map.features.size(), 3U);
  EXPECT_FALSE(map.features[0].learned);
  EXPECT_TRUE(map.features[1].learned);
  EXPECT_TRUE(map.features[2].learned);
  EXPECT_EQ(map.features[2].name, "A");
  EXPECT_EQ(parse_map(to_text(map), "again.map"), map);
  for (const char* const wrong :
       {"WALL 0, 0, 0, 2000 learned learned\n", "WALL 0, 0, 0, 2000 learnt\n",
        "WALL 0, 0, 0, 2000 learned \"A\"\n"})
    EXPECT_THROW(parse_map(wrong, "wrong.map"), FileError) << wrong;
}

}  // namespace
}  // namespace saphira::maps
