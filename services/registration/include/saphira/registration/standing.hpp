#pragma once

#include <map>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/registration/search.hpp"

namespace saphira::registration {

struct StandingSettings {
  double moved = 0.02;  ///< [m] of dead reckoning that counts as motion, also a slow one...
  double turned = radians(2.0);    ///< [rad] ...likewise
  double same = 0.04;              ///< [m] two echoes of one object
  double silence = 5.0;            ///< [m] range that stands for silence
  int learnt = 6;                  ///< readings of a sonar that define its normal ranges at a place
  int changed = 3;                 ///< number in a row with different ranges
  int accepted = 5;                ///< number in a row after which the new range is normal
  double share = 0.4;              ///< of the sonars with changed ranges: the robot was carried
  int least = 3;                   ///< sonars with changed ranges...
  double around = radians(100.0);  ///< [rad] ...and the angle that these look into
};

/// Detects that a robot with standing wheels was carried: the ranges of its sonars have changed all
/// around, and at once. A person near by changes them on one side, be it most of them: five of a
/// Pioneer's seven sonars look ahead. A person who walks around it changes them one after the
/// other, and each change is soon normal. A value.
class Standing {
 public:
  explicit Standing(StandingSettings settings = {}) : settings_(settings) {}

  /// One cycle; `moved` is by dead reckoning. True once where the robot was carried.
  bool step(const Pose& moved, const std::vector<PlacedReading>& readings);
  /// The robot may have moved since the last step.
  void forget() {
    way_ = {};
    sonars_.clear();
  }

  SAPHIRA_ARCHIVE(way_, sonars_)

 private:
  struct Sonar {
    double direction = 0.0;      ///< [rad] in dead reckoning, of the newest reading
    std::vector<double> ranges;  ///< [m]
    int strange = 0;             ///< readings in a row unlike any of these
  };

  StandingSettings settings_;
  Pose way_;  ///< since the ranges of the place are collected
  std::map<int, Sonar> sonars_;
};

}  // namespace saphira::registration
