#include "saphira/base/shortest_ways.hpp"

#include <gtest/gtest.h>

#include "saphira/base/random.hpp"

namespace saphira {
namespace {

struct Step {
  std::size_t from;
  std::size_t to;
  double cost;
};

ShortestWays search(std::size_t places, const std::vector<Step>& steps, std::size_t from) {
  ShortestWays ways(places);
  ways.reach(from, 0.0);
  while (const auto here = ways.next())
    for (const Step& step : steps)
      if (step.from == *here)
        ways.reach(step.to, ways.cost(*here) + step.cost, *here);
  return ways;
}

TEST(ShortestWays, ALongWayOfShortStepsBeatsOneLongStep) {
  const ShortestWays ways =
      search(5, {{0, 3, 10.0}, {0, 1, 1.0}, {1, 2, 2.0}, {2, 3, 3.0}, {4, 3, 0.1}}, 0);
  EXPECT_EQ(ways.cost(3), 6.0);
  EXPECT_EQ(ways.way_to(3), (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(ways.way_to(0), (std::vector<std::size_t>{0}));
  EXPECT_EQ(ways.cost(4), ShortestWays::kNever);
  EXPECT_FALSE(ways.settled(4));
}

TEST(ShortestWays, PlacesComeByCostThenByNumber) {
  ShortestWays ways(4);
  ways.reach(3, 1.0);
  ways.reach(1, 1.0);
  ways.reach(2, 0.5);
  EXPECT_FALSE(ways.reach(2, 0.5, 3));  // no cheaper
  EXPECT_TRUE(ways.reach(3, 0.7));
  EXPECT_EQ(ways.next(), 2U);
  EXPECT_EQ(ways.next(), 3U);
  EXPECT_EQ(ways.next(), 1U);
  EXPECT_FALSE(ways.reach(1, 0.0));  // its cost is final
  EXPECT_EQ(ways.next(), std::nullopt);
}

TEST(ShortestWays, AreAsShortAsThoseOfFloydAndWarshall) {
  Random random(1);
  for (int round = 0; round < 30; ++round) {
    const std::size_t places = 2 + random.next() % 12;
    std::vector<Step> steps;
    std::vector<std::vector<double>> known(places,
                                           std::vector<double>(places, ShortestWays::kNever));
    for (std::size_t i = 0; i < places; ++i)
      known[i][i] = 0.0;
    for (std::size_t i = 0; i < 3 * places; ++i) {
      // Whole numbers: sums do not depend on their order.
      const Step step{random.next() % places, random.next() % places,
                      static_cast<double>(random.next() % 9)};
      steps.push_back(step);
      known[step.from][step.to] = std::min(known[step.from][step.to], step.cost);
    }
    for (std::size_t by = 0; by < places; ++by)
      for (std::size_t a = 0; a < places; ++a)
        for (std::size_t b = 0; b < places; ++b)
          known[a][b] = std::min(known[a][b], known[a][by] + known[by][b]);
    for (std::size_t from = 0; from < places; ++from) {
      const ShortestWays ways = search(places, steps, from);
      for (std::size_t to = 0; to < places; ++to)
        EXPECT_EQ(ways.cost(to), known[from][to]);
    }
  }
}

}  // namespace
}  // namespace saphira
