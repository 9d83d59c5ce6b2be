#include "saphira/sim/world.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/random.hpp"

namespace saphira::sim {
namespace {

using test::source;

// Manual chapter 11 as it is printed.
TEST(World, TheManualsSampleLoads) {
  const World world = load_world(source("sim/test/data/manual-sample.wld"));
  EXPECT_DOUBLE_EQ(world.width, 38.0);
  EXPECT_DOUBLE_EQ(world.height, 30.0);
  ASSERT_EQ(world.segments.size(), 10U);
  EXPECT_EQ(world.segments[0].to, Vec2(0.0, 30.0));
  EXPECT_EQ(world.segments[4].from, Vec2(10.0, 26.0));
  EXPECT_EQ(world.segments[4].to, Vec2(13.0, 26.0));
  ASSERT_TRUE(world.start);
  EXPECT_EQ(world.start->position(), Vec2(17.5, 14.0));
  EXPECT_DOUBLE_EQ(world.start->th, -kPi / 2);
  EXPECT_EQ(world.warnings,
            std::vector<std::string>{source("sim/test/data/manual-sample.wld") +
                                     ":11: this push has no pop: it holds up to the end of the "
                                     "file"});
}

TEST(World, PushesAreNestedAndPopped) {
  const World world = parse_world(
      "width 100 height 100 push 1000 0 90 0 0 1000 0 push 1000 0 90 0 0 1000 0 pop 0 0 0 1000 "
      "pop\n"
      "0 0 1000 0",
      "w");
  ASSERT_EQ(world.segments.size(), 4U);
  const auto near = [](const Vec2& a, double x, double y) {
    EXPECT_NEAR(a.x(), x, 1e-12);
    EXPECT_NEAR(a.y(), y, 1e-12);
  };
  near(world.segments[0].to, 1.0, 1.0);
  near(world.segments[1].from, 1.0, 1.0);
  near(world.segments[1].to, 0.0, 1.0);
  near(world.segments[2].to, 0.0, 0.0);
  near(world.segments[3].to, 1.0, 0.0);
}

TEST(World, MistakesSayWhereAndWhatWasExpected) {
  EXPECT_EQ(test::each_mistake("sim/test/world-mistakes.txt",
                               [](const std::string& text) { parse_world(text, "broken.wld"); }),
            15);
}

TEST(Geometry, NearestPoint) {
  const Segment segment{{0.0, 0.0}, {2.0, 0.0}};
  EXPECT_EQ(nearest_point(segment, {1.0, 1.0}), Vec2(1.0, 0.0));
  EXPECT_EQ(nearest_point(segment, {-1.0, 1.0}), Vec2(0.0, 0.0));
  EXPECT_EQ(nearest_point(segment, {5.0, -3.0}), Vec2(2.0, 0.0));
  EXPECT_DOUBLE_EQ(distance(std::vector{segment}, {5.0, -4.0}), 5.0);
  EXPECT_EQ(distance(std::vector<Segment>{}, {0.0, 0.0}), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(nearest_point(std::vector<Segment>{}, {0.0, 0.0}));
}

TEST(Geometry, CastRay) {
  const std::vector<Segment> walls{{{3.0, -1.0}, {3.0, 1.0}}, {{2.0, 1.0}, {4.0, -1.0}}};
  const auto straight = cast_ray(walls, {0.0, 0.0}, {1.0, 0.0}, 5.0);
  ASSERT_TRUE(straight);
  EXPECT_NEAR(*straight, 3.0, 1e-12);
  const auto oblique = cast_ray(walls, {0.0, 0.5}, {1.0, 0.0}, 5.0);
  ASSERT_TRUE(oblique);
  EXPECT_NEAR(*oblique, 2.5, 1e-12);
  EXPECT_FALSE(cast_ray(walls, {0.0, 0.0}, {-1.0, 0.0}, 5.0));
  EXPECT_FALSE(cast_ray(walls, {0.0, 0.0}, {1.0, 0.0}, 2.0));
  EXPECT_FALSE(cast_ray(walls, {0.0, 2.0}, {1.0, 0.0}, 5.0));
}

// The ray agrees with marching along it by the distance to the nearest segment.
TEST(Geometry, RaysAgreeWithDistances) {
  const World world = load_world(source("config/worlds/office.wld"));
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec2 origin(random.uniform(0.1, 23.9), random.uniform(0.1, 13.9));
    const double th = random.uniform(-kPi, kPi);
    const Vec2 direction(std::cos(th), std::sin(th));
    double marched = 0.0;
    while (marched < 5.0) {
      const double free = distance(world.segments, origin + marched * direction);
      if (free < 1e-7)
        break;
      marched += free;
    }
    const auto hit = cast_ray(world.segments, origin, direction, 5.0);
    if (marched < 4.999) {
      ASSERT_TRUE(hit) << i;
      EXPECT_NEAR(*hit, marched, 1e-3) << i;
      ++hits;
    } else if (marched > 5.001) {
      EXPECT_FALSE(hit) << i;
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(Neighbourhood, GivesTheSameAnswers) {
  const World world = load_world(source("config/worlds/office.wld"));
  Neighbourhood near(world, 1.5);
  Random random(12);
  Vec2 at(1.5, 7.0);
  for (int i = 0; i < 3000; ++i) {
    at += Vec2(random.uniform(-0.1, 0.12), random.uniform(-0.1, 0.1));
    const double exact = distance(world.segments, at);
    if (exact <= 1.5) {
      ASSERT_DOUBLE_EQ(distance(near.around(at), at), exact);
    } else {
      ASSERT_GT(distance(near.around(at), at), 1.5);
    }
  }
}

}  // namespace
}  // namespace saphira::sim
