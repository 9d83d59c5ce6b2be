#pragma once

#include <cstdint>
#include <optional>

#include "saphira/base/archived.hpp"
#include "saphira/intentions/value.hpp"
#include "saphira/intentions/world.hpp"

namespace saphira::intentions {

/// Keeps the cameras on what activities want to see (the centering of paper 3.2.3), for a robot
/// whose head can turn. The belief `gaze` is a direction in the robot [rad], a person, a colour or
/// a point; without it, and when the person or colour is forgotten, the cameras look ahead.
class Gaze {
 public:
  /// The direction to ask of the head [rad], where it has to turn.
  std::optional<double> step(const World& world);

  SAPHIRA_ARCHIVE(asked_, at_, now_)

 private:
  double wanted(const World& world, const Value& watched) const;

  double asked_ = 0.0;     ///< [rad]
  std::uint64_t at_ = 0;   ///< cycle of the newest request
  std::uint64_t now_ = 0;  ///< cycle of the newest step
};

}  // namespace saphira::intentions
