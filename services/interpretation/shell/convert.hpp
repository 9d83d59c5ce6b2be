#pragma once

#include "saphira/idl/perception.hpp"
#include "saphira/interpretation/grid.hpp"
#include "saphira/interpretation/interpretation.hpp"

/// Conversions between the types of the bus and those of the library: pure functions.
namespace saphira::interpretation {

/// The perception sample; its stamp and odom are the caller's.
v1::Perception to_bus(const Output& output);
/// A tile of the grid by its key alone; its stamp and odom are the caller's.
v1::GridTile to_bus(const TileKey& key);
/// The same with its cells.
v1::GridTile to_bus(const Grid& grid, const TileKey& key);

}  // namespace saphira::interpretation
