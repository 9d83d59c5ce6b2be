#pragma once

#include <vector>

#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

/// One behavior on its way through the blend.
struct Blended {
  int priority = 0;
  Evaluation evaluation;
  // Results of the blend:
  double turn_weight = 0.0;   ///< [0..1] activity after the suppression by higher priorities
  double speed_weight = 0.0;  ///< [0..1]
  bool recommends_turn = false;
  double turn = 0.0;  ///< [rad] counter-clockwise, of this behavior alone
  bool recommends_speed = false;
  double speed = 0.0;  ///< [m/s]
};

/// The summation on both channels.
struct Blend {
  bool turning = false;  ///< some behavior contributes
  double turn = 0.0;     ///< [rad] counter-clockwise from the present heading
  bool moving = false;
  double speed = 0.0;  ///< [m/s]
};

/// Context-dependent blending (paper 3.1). `behaviors` is in order of priority, highest (0) first.
/// On each channel the activity of a behavior is scaled by the rest that the higher priorities
/// leave: after each group of equal priority, the rest is multiplied by 1 - the group's highest
/// activity. The control value is the average of the rules' values by strength times that weight.
/// Where the turn rules' weights sum to less than one, the rest counts as "straight on". The speed
/// is an average of the recommendations alone, or the robot would creep.
Blend blend(std::vector<Blended>& behaviors, double velocity);

}  // namespace saphira::behaviors
