#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/registration/feature_graph.hpp"
#include "saphira/registration/map_builder.hpp"
#include "stretches.hpp"

namespace saphira::registration {

/// A corridor, from its walls and the robot's way between them.
struct BuiltCorridor {
  Pose frame;  ///< a point of its middle line, and along it
  double width = 0.0;
  double from = 0.0;  ///< [m] along the frame's x
  double to = 0.0;
  Stretches both;   ///< a wall on either side
  Stretches walls;  ///< on one at least

  Vec2 begin() const { return transform(frame, {from, 0.0}); }
  Vec2 end() const { return transform(frame, {to, 0.0}); }
  double length() const { return to - from; }
};

/// The corridors of the lines of the graph. `ahead`: echoes from straight ahead, which mark the
/// ends of corridors.
std::vector<BuiltCorridor> find_corridors(const FeatureGraph& graph,
                                          const std::vector<SeenPoint>& ahead,
                                          const MapBuilderSettings& settings);

}  // namespace saphira::registration
