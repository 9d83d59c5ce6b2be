#include "saphira/maps/edit.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace saphira::maps {
namespace {

using lps::PointType;

Map small() {
  return parse_map(
      "CORRIDOR (1) 0, 0, 0, 10000, 2000 \"hall\"\n"
      "DOOR (7) 1000, 1000, -90, 900 \"EJ-231\"\n"
      "WALL 0, 5000, 0, 3000\n",
      "small.map");
}

TEST(Editor, IdsStayAndAreNotGivenAgain) {
  Editor editor(small());
  const std::uint32_t wall = editor.map().features[2].id;
  EXPECT_EQ(wall, 8U) << "walls have none in the file";
  Feature door{PointType::door, 0, {3.0, 1.0, -kPi / 2}, 0.0, 0.9, ""};
  const std::uint32_t id = editor.add(door);
  EXPECT_EQ(id, 9U);
  EXPECT_TRUE(editor.remove(id));
  EXPECT_FALSE(editor.remove(id));
  EXPECT_EQ(editor.add(door), 10U);
  door.id = 7;  // taken
  EXPECT_EQ(editor.add(door), 11U);
  door.id = 9;  // it belonged to another door
  EXPECT_EQ(editor.add(door), 12U);
  door.id = 40;
  EXPECT_EQ(editor.add(door), 40U);
  door.width = 1.2;
  EXPECT_TRUE(editor.change(7, door));
  EXPECT_EQ(find(editor.map(), 7)->width, 1.2);
  EXPECT_FALSE(editor.change(9, door));
  // A removed artifact that existed before: the file is the same, except for the wall's id.
  EXPECT_NO_THROW(parse_map(to_text(editor.map()), "m"));
}

TEST(Problem, APlaceIsFiniteAndNearEnough) {
  EXPECT_FALSE(problem(Pose{}));
  EXPECT_FALSE(problem(Pose{-9999.0, 9999.0, 100.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {nan, infinite, -infinite, 1e13, -10001.0}) {
    EXPECT_TRUE(problem(Pose{wrong, 0.0, 0.0})) << wrong;
    EXPECT_TRUE(problem(Pose{0.0, wrong, 0.0})) << wrong;
  }
  EXPECT_TRUE(problem(Pose{0.0, 0.0, nan}));
  EXPECT_TRUE(problem(Pose{0.0, 0.0, infinite}));
  EXPECT_EQ(*problem(Pose{1e13, 0.0, 0.0}),
            "expected a place within 10 km [m] of the map's origin and a heading [rad], got "
            "1e+13, 0, 0");
}

TEST(Editor, RevisionsCountChanges) {
  Editor editor(small());
  EXPECT_EQ(editor.revision(), 0U);
  Feature hall = *find(editor.map(), 1);
  EXPECT_TRUE(editor.change(1, hall));
  EXPECT_EQ(editor.revision(), 0U) << "nothing is different";
  hall.length = 12.0;
  editor.change(1, hall);
  EXPECT_EQ(editor.revision(), 1U);
  editor.replace(small());
  EXPECT_EQ(editor.revision(), 2U);
}

TEST(Editor, WhatNoMapHoldsIsRefused) {
  Editor editor(small());
  Feature door{PointType::door, 0, {3.0, 1.0, 0.0}, 0.0, -1.0, ""};
  EXPECT_THROW(editor.add(door), std::invalid_argument);
  door.width = 0.9;
  EXPECT_THROW(editor.change(1, door), std::invalid_argument) << "a door is no corridor";
  door.name = "a\"b";
  EXPECT_THROW(editor.add(door), std::invalid_argument);
  EXPECT_EQ(editor.map().features.size(), 3U);
  EXPECT_EQ(editor.revision(), 0U);
}

TEST(Same, IsTheSameLineOrTheSamePlace) {
  const Map map = parse_map(
      "CORRIDOR (1) 0, 0, 0, 10000, 2000\n"
      "CORRIDOR (2) 2000, 100, 181, 12000, 2100\n"  // the same, the other way round, and longer
      "CORRIDOR (3) 12000, 0, 0, 10000, 2000\n"     // in line with it, farther on
      "DOOR (4) 1000, 1000, -90, 900\n"
      "DOOR (5) 1100, 1000, -90, 950\n"
      "DOOR (6) 1000, 1000, 90, 900\n",  // into the other side
      "a.map");
  const auto at = [&](std::uint32_t id) { return *find(map, id); };
  EXPECT_TRUE(same(at(1), at(2)));
  EXPECT_FALSE(same(at(1), at(3)));
  EXPECT_TRUE(same(at(4), at(5)));
  EXPECT_FALSE(same(at(4), at(6)));
  EXPECT_FALSE(same(at(1), at(4)));
}

}  // namespace
}  // namespace saphira::maps
