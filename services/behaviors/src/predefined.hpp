#pragma once

#include "saphira/behaviors/behavior.hpp"

// The predefined behaviors of manual 7.8, each in a file of its own.
namespace saphira::behaviors {

Schema constant_velocity();
Schema stop();
Schema avoid_collision();
Schema stop_collision();
Schema keep_off();
Schema go_to_pos();
Schema turn_to();
Schema attend_at_pos();
Schema follow();
Schema follow_corridor();
Schema follow_door();

/// A turn by `angle` [rad, counter-clockwise] as a rule.
inline Rule turn_rule(std::string name, Fuzzy strength, double angle) {
  return {std::move(name), strength, angle >= 0.0 ? Action::turn_left : Action::turn_right,
          std::abs(angle)};
}

inline Side side_from(const std::string& text) {
  if (text == "left")
    return Side::left;
  return text == "right" ? Side::right : Side::none;
}

inline ParameterSpec preferred_turn_parameter() {
  return choice_parameter("preferred_turn",
                          "side to turn to when the front is blocked: sfPreferredTurnDir",
                          {"auto", "left", "right"});
}

}  // namespace saphira::behaviors
