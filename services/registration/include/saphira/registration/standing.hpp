#pragma once

#include <map>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/local_perceptual_space.hpp"

namespace saphira::registration {

struct StandingSettings {
  double moved = 0.01;           ///< [m] of dead reckoning in a cycle that is no standing...
  double turned = radians(1.0);  ///< [rad] ...likewise
  double same = 0.25;            ///< [m] two echoes of one thing
  double silence = 5.0;          ///< [m] as which the lack of an echo counts
  int learnt = 6;      ///< readings of a sonar that tell what it hears where the robot stands
  int changed = 4;     ///< in a row that are like none of them
  int accepted = 60;   ///< in a row, after which that is what it hears
  double share = 0.4;  ///< of the sonars that hear something else: the robot was carried
  int least = 3;       ///< sonars that do
};

/// Notices that a robot whose wheels stand is somewhere else: what its sonars hear has changed all
/// around. A person who comes by changes it on one side. A value.
class Standing {
 public:
  explicit Standing(StandingSettings settings = {}) : settings_(settings) {}

  /// One cycle; `moved` is what dead reckoning says. True once where the robot was carried.
  bool step(const Pose& moved, const std::vector<lps::SonarReading>& readings);

  bool operator==(const Standing& other) const { return sonars_ == other.sonars_; }

 private:
  struct Heard {
    std::vector<double> ranges;  ///< [m]
    int strange = 0;             ///< readings in a row that are like none of these

    bool operator==(const Heard&) const = default;
  };

  StandingSettings settings_;
  std::map<int, Heard> sonars_;
};

}  // namespace saphira::registration
