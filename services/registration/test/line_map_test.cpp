#include "saphira/registration/line_map.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace saphira::registration {
namespace {

maps::Map map_of(const std::string& name) {
  return maps::load_map(std::string(std::getenv("SAPHIRA_SOURCE_DIR")) + "/config/maps/" + name +
                        ".map");
}

TEST(LineMap, ACorridorIsItsSidesWithoutDoorsAndJunctions) {
  const maps::Map map = maps::parse_map(
      "CORRIDOR (1) 5000, 0, 0, 10000, 2000\n"
      "CORRIDOR (2) 8000, 6000, 90, 10000, 2000\n"
      "DOOR (3) 3000, 1000, -90, 1000\n",
      "m");
  const LineMap lines(map);
  double north = 0.0;
  for (const Surface& surface : lines.surfaces())
    if (surface.feature == 0 && std::abs(surface.from.y() - 1.0) < 1e-9 &&
        std::abs(surface.to.y() - 1.0) < 1e-9) {
      north += surface.length;
      EXPECT_NEAR(surface.free.y(), -1.0, 1e-9);
    }
  EXPECT_NEAR(north, 10.0 - 1.0 - 2.0, 1e-9);
  ASSERT_EQ(lines.openings().size(), 2U);
  EXPECT_EQ(lines.openings()[0].feature, 2U);
  EXPECT_NEAR(lines.openings()[1].pose_in_map.x, 8.0, 1e-9);
  EXPECT_NEAR(lines.openings()[1].width, 2.0, 1e-9);
}

TEST(LineMap, ListsTheNearestEdges) {
  const LineMap lines(maps::parse_map("CORRIDOR (1) 5000, 0, 0, 10000, 2000\n", "m"));
  const std::vector<Edge> edges = lines.edges_near({0.4, -0.1}, 3);
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_DOUBLE_EQ(edges[0].from.x(), 0.0);
  EXPECT_DOUBLE_EQ(edges[0].to.x(), 0.0);
  EXPECT_DOUBLE_EQ(edges[1].from.y(), -1.0);
  EXPECT_DOUBLE_EQ(edges[2].from.y(), 1.0);
  EXPECT_EQ(lines.edges_near({0.4, -0.1}, 1), std::vector<Edge>{edges[0]});
}

TEST(Field, IsOfMapsOfASensibleSize) {
  const auto of = [](const std::string& text) { return LineMap(maps::parse_map(text, "a.map")); };
  EXPECT_FALSE(problem(of("")));
  EXPECT_FALSE(problem(of("CORRIDOR (1) 0, 0, 0, 9000000, 2000\n")));
  const std::string large = "OFFICE (1) 0, 0, 0, 2000000, 2000000\n";
  EXPECT_EQ(problem(of(large)),
            "expected a map of at most 25 ha, as 500 m by 500 m, got one of 2000 m by 2000 m");
  const maps::Map map = maps::parse_map(large, "a.map");
  EXPECT_THROW(Field(map, LineMap(map)), std::invalid_argument);
}

TEST(Field, TellsTheNearestWallOfTheOfficeFloor) {
  const maps::Map map = map_of("office-floor");
  const LineMap lines(map);
  const Field field(map, lines);
  EXPECT_NEAR(field.distance({17.3, 13.7}), std::hypot(0.8, 0.3), 1e-9);  // a post
  EXPECT_NEAR(field.distance({17.0, 11.0}), 0.5, 1e-9);
  EXPECT_LT(field.nearest({17.0, 11.0}).towards.x(), -0.999);
  EXPECT_NEAR(field.distance({17.5, 7.0}), 1.0, 1e-9);  // south side; the north is open
  EXPECT_TRUE(field.known({17.5, 7.0}));
  EXPECT_TRUE(field.known({14.5, 9.6}));
  EXPECT_FALSE(field.known({34.0, 20.0}));
  // Exact against all surfaces, at every known place.
  double worst = 0.0;
  int known = 0;
  for (int i = 0; i < 100 * 75; ++i) {
    const Vec2 p(0.4 * (i % 100) + 0.08, 0.4 * (i / 100) + 0.03);
    if (!field.known(p))
      continue;
    ++known;
    double nearest = 1e3;
    for (const Surface& s : lines.surfaces()) {
      const Vec2 way = (s.to - s.from) / s.length;
      const double t = std::clamp((p - s.from).dot(way), 0.0, s.length);
      nearest = std::min(nearest, (p - s.from - way * t).norm());
    }
    worst = std::max(worst, std::abs(nearest - field.distance(p)));
  }
  EXPECT_LT(worst, 0.1);
  EXPECT_GT(known, 500);
}

}  // namespace
}  // namespace saphira::registration
