#pragma once

#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::c {

/// The style of the next drawing.
struct Pen {
  int width = 1;  ///< [pixels]
  int dashed = 0;
  int line = 14;  ///< a colour of Table 6-4
  int patch = 14;
};
/// A rectangle from the program, or the line across it: its lower left corner in the LPS, its
/// extent [mm].
struct Drawn {
  Pen pen;
  bool line = false;
  float x = 0.0F;
  float y = 0.0F;
  float dx = 0.0F;
  float dy = 0.0F;
};
/// The rectangles and lines that were drawn since the last call.
std::vector<Drawn> take_drawn();

/// Passes typed keys to the program. In the thread of the micro-tasks, once a cycle.
void take_keys();
/// Likewise a place that a person has pointed out [m] [robot], as a click there.
void click(const Vec2& in_robot);

}  // namespace saphira::c
