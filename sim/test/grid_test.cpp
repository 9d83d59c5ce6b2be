#include "saphira/sim/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "saphira/base/random.hpp"

namespace saphira::sim {
namespace {

TEST(Grid, FindsAllThatAreNearInOrder) {
  Random random(1);
  Grid grid(20.0, 10.0);
  std::vector<Vec2> places(200);
  std::size_t most = 0;
  for (int round = 0; round < 50; ++round) {
    // Some of them outside of the world.
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      places[i] = {random.uniform(-3.0, 23.0), random.uniform(-3.0, 13.0)};
      grid.put(i, places[i]);
    }
    const Vec2 point(random.uniform(-3.0, 23.0), random.uniform(-3.0, 13.0));
    const double reach = random.uniform(0.0, 4.0);
    const auto& found = grid.near(point, reach);
    EXPECT_TRUE(std::ranges::is_sorted(found));
    EXPECT_EQ(std::ranges::adjacent_find(found), found.end());
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      if ((places[i] - point).norm() <= reach) {
        EXPECT_TRUE(std::ranges::binary_search(found, i)) << i;
      }
    }
    most = std::max(most, found.size());
  }
  EXPECT_LT(most, places.size());
}

TEST(Grid, WorldsOfAnySize) {
  Grid tiny(0.001, 0.001);
  tiny.put(0, {0.0, 0.0});
  EXPECT_EQ(tiny.near({0.0, 0.0}, 1.0).size(), 1U);
  Grid huge(10000.0, 10000.0);
  huge.put(0, {9999.0, 9999.0});
  EXPECT_EQ(huge.near({9998.0, 9999.0}, 2.0).size(), 1U);
}

}  // namespace
}  // namespace saphira::sim
