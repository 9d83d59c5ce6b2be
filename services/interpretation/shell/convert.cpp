#include "interpretation/shell/convert.hpp"

#include "lps/shell/convert.hpp"

namespace saphira::interpretation {
namespace {

constexpr std::size_t kMostPercepts = 256;  // the bound of Perception.percepts

}  // namespace

v1::Perception to_bus(const Output& output) {
  return {
      .percepts = converted(
          output.percepts, [](const auto& percept) { return lps::to_bus(percept); }, kMostPercepts),
      .left_wall = output.left_wall ? output.left_wall->id : 0,
      .right_wall = output.right_wall ? output.right_wall->id : 0};
}

v1::GridTile to_bus(const TileKey& key) {
  return {.column = static_cast<std::int32_t>(key.column),
          .row = static_cast<std::int32_t>(key.row)};
}

v1::GridTile to_bus(const Grid& grid, const TileKey& key) {
  v1::GridTile tile = to_bus(key);
  tile.resolution = grid.settings().resolution;
  tile.side = static_cast<std::uint32_t>(Grid::kTile);
  tile.cells = grid.cells(key);
  return tile;
}

}  // namespace saphira::interpretation
