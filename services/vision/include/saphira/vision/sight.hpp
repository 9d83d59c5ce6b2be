#pragma once

#include <optional>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/seen_thing.hpp"

namespace saphira::vision {

/// A sighting in one picture, without reference to others (paper 3.2.3).
struct Sight {
  lps::SeenThing::Kind kind = lps::SeenThing::Kind::person;
  int channel = -1;  ///< of a blob
  /// [m] On the floor. Without a range: any place in that direction.
  Vec2 place_in_robot{0.0, 0.0};
  bool range_known = true;
  double sigma_range = 0.1;        ///< [m] along the line of sight
  double sigma_across = 0.1;       ///< [m]
  double width = 0.0;              ///< [m] 0: unknown
  double height = 0.0;             ///< [m] 0: unknown
  double area = 0.0;               ///< [0..1] of the picture, of a blob
  double evidence = 1.0;           ///< [0..1] likeness to its kind
  std::optional<double> points{};  ///< [rad] direction of a person's outstretched arm, robot frame
};

}  // namespace saphira::vision
