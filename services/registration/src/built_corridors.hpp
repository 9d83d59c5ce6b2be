#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/registration/feature_graph.hpp"
#include "saphira/registration/map_builder.hpp"
#include "stretches.hpp"

namespace saphira::registration {

/// A corridor as its walls were seen and the robot drove between them.
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

/// The corridors that the lines of the graph make. `ahead`: echoes from straight ahead, which tell
/// where corridors end.
std::vector<BuiltCorridor> find_corridors(const FeatureGraph& graph,
                                          const std::vector<SeenPoint>& ahead,
                                          const MapBuilderSettings& settings);

}  // namespace saphira::registration
