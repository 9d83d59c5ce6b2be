#include "saphira/interpretation/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saphira::interpretation {
namespace {

TEST(Grid, AnEchoIsAnObstacleAndTheWayToItIsFree) {
  Grid grid;
  for (int i = 0; i < 4; ++i)
    grid.add(0, {0.0, 0.1 * i, 0.0}, 1.0);
  EXPECT_GT(grid.probability({1.0, 0.15}).value_or(0.0), 0.5);
  EXPECT_LT(grid.probability({0.5, 0.15}).value_or(1.0), 0.2);
  EXPECT_FALSE(grid.probability({2.0, 0.0}));  // no evidence behind it
  EXPECT_FALSE(grid.probability({-0.5, 0.0}));
}

// Readings from one place are one event.
TEST(Grid, StandingStillSaysNoMoreThanOneReading) {
  Grid once;
  Grid often;
  once.add(0, {}, 1.0);
  for (int i = 0; i < 20; ++i)
    often.add(0, {}, 1.0);
  EXPECT_EQ(*once.probability({1.0, 0.0}), *often.probability({1.0, 0.0}));
  EXPECT_EQ(*once.probability({0.5, 0.0}), *often.probability({0.5, 0.0}));
}

// A corridor with a smooth wall at y = 1: the sonar to the side hears it, and one that looks 30
// degrees ahead hears nothing of it, over and over.
TEST(Grid, AMirroringWallStays) {
  Grid grid;
  for (int i = 0; i < 75; ++i) {
    const double x = 0.08 * i;
    grid.add(0, {x, 0.0, kPi / 2.0}, 1.0);
    grid.add(1, {x, 0.0, radians(30.0)}, std::nullopt);
    grid.add(2, {x, 0.0, radians(45.0)}, std::nullopt);
  }
  int kept = 0;
  int all = 0;
  for (int i = 0; i < 70; ++i) {
    const double x = 2.0 + 0.05 * i;
    ++all;
    kept += grid.probability({x, 1.0}).value_or(0.0) > 0.5 ? 1 : 0;
  }
  EXPECT_GT(kept, 0.95 * all);
}

TEST(Grid, IsClearedFromSeveralDirections) {
  Grid grid;
  for (int i = 0; i < 5; ++i)
    grid.add(0, {0.0, 0.07 * i, 0.0}, 1.0);
  ASSERT_GT(grid.probability({1.0, 0.15}).value_or(0.0), 0.5);
  // The box is gone: all around it sonars hear the wall behind.
  for (int i = 0; i < 62; ++i) {
    const double angle = 0.1 * i;
    grid.add(0, {1.0 - std::cos(angle), 0.15 - std::sin(angle), angle}, 3.0);
  }
  EXPECT_LT(grid.probability({1.0, 0.15}).value_or(1.0), 0.3);
}

// A wall at y = 1 with an opening, whose edges are heard by the rim of the beam: the rest of their
// arcs would close it if it did not explain the echoes as well.
TEST(Grid, ADoorwayStaysOpen) {
  const auto blocked = [](double attribution) {
    GridSettings settings;
    settings.attribution = attribution;
    Grid grid(settings);
    for (double x = 0.0; x < 5.0; x += 0.07) {
      const double edge = x <= 2.0 || x >= 2.9 ? 0.0 : std::min(x - 2.0, 2.9 - x);
      grid.add(0, {x, 0.0, kPi / 2.0}, edge < 0.17 ? std::hypot(1.0, edge) : 2.5);
    }
    int cells = 0;
    for (int x = 0; x <= 10; ++x)
      for (int y = -4; y <= 4; ++y)
        cells += grid.probability({2.2 + 0.05 * x, 1.0 + 0.05 * y}).value_or(0.0) > 0.5 ? 1 : 0;
    return cells;
  };
  EXPECT_EQ(blocked(GridSettings().attribution), 0);
  EXPECT_GT(blocked(0.0), 0);
}

TEST(Grid, GoesWithTheRobotInTiles) {
  Grid grid;
  std::size_t most = 0;
  std::size_t dropped = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = -30.0 + 0.2 * i;
    grid.move_to({x, 0.0});
    dropped += grid.dropped().size();
    EXPECT_TRUE(grid.changed().empty());
    grid.add(0, {x, 0.0, kPi / 2.0}, 2.0);
    EXPECT_FALSE(grid.changed().empty());
    most = std::max(most, grid.tiles().size());
  }
  EXPECT_GT(dropped, 40U);
  EXPECT_LT(most, 60U);
  EXPECT_FALSE(grid.probability({-25.0, 1.0}));

  // Each cell of a tile agrees with probability().
  const Vec2 at(29.0, 2.0);
  const TileKey key = grid.tile_of(at);
  const std::vector<std::uint8_t> cells = grid.cells(key);
  ASSERT_EQ(cells.size(), static_cast<std::size_t>(Grid::kTile * Grid::kTile));
  const double size = grid.settings().resolution;
  int seen = 0;
  for (long row = 0; row < Grid::kTile; ++row)
    for (long column = 0; column < Grid::kTile; ++column) {
      const auto cell = cells[static_cast<std::size_t>(row * Grid::kTile + column)];
      const auto probability =
          grid.probability({(static_cast<double>(key.column * Grid::kTile + column) + 0.5) * size,
                            (static_cast<double>(key.row * Grid::kTile + row) + 0.5) * size});
      ASSERT_EQ(cell == Grid::kNeverSeen, !probability);
      if (probability) {
        ++seen;
        EXPECT_NEAR(cell / 200.0, *probability, 0.003);
      }
    }
  EXPECT_GT(seen, 100);
  EXPECT_TRUE(grid.cells({1000, 1000}).empty());

  grid.clear();
  grid.move_to({30.0, 0.0});
  EXPECT_FALSE(grid.dropped().empty());
  EXPECT_TRUE(grid.tiles().empty());
}

}  // namespace
}  // namespace saphira::interpretation
