#include <algorithm>
#include <optional>

#include "predefined.hpp"
#include "saphira/lps/point.hpp"

namespace saphira::behaviors {
namespace {

/// [rad] The heading setpoint is at most so far ahead of the robot at turn speed 1. A Pioneer,
/// which slows its turn by 300 degrees/s2, then turns at some 70 degrees/s.
constexpr double kTurn = 0.15;

class TurnTo : public Behavior {
 public:
  void init(const Parameters& parameters, const Context& context) override {
    whole_turn_ = std::abs(bearing(parameters, context));
  }

  Evaluation update(const Parameters& parameters, const Context& context) override {
    const double phi = bearing(parameters, context);
    const double success = parameters.number("success_angle");
    const double turn = std::min(std::abs(phi), kTurn * parameters.number("turn_speed"));
    const Fuzzy there = down_straight(std::abs(phi), 0.25 * success, 0.5 * success);
    Evaluation evaluation;
    evaluation.rules = {
        {"goal is left", phi > 0.0 ? 1.0 : 0.0, Action::turn_left, turn},
        {"goal is right", phi > 0.0 ? 0.0 : 1.0, Action::turn_right, turn},
    };
    evaluation.activity = {.turn = f_not(there),
                           .goal = down_straight(std::abs(phi), success, 2.0 * success),
                           .progress = whole_turn_ > 0.0
                                           ? std::clamp(1.0 - std::abs(phi) / whole_turn_, 0.0, 1.0)
                                           : 1.0};
    return evaluation;
  }

 private:
  static double bearing(const Parameters& parameters, const Context& context) {
    return lps::phi(relative(context.robot.pose_in_odom, *parameters.point("goal")));
  }

  double whole_turn_ = 0.0;  ///< [rad]
};

}  // namespace

Schema turn_to() {
  return {"TurnTo",
          "turns to face a point, the short way",
          {point_parameter("goal", "what to face"),
           number_parameter("success_angle", "rad, how near is there", 0.005, kPi, 0.1),
           number_parameter("turn_speed", "0.5 is slow, 2 is fast", 0.1, 5.0, 1.0)},
          [] { return std::make_unique<TurnTo>(); }};
}

}  // namespace saphira::behaviors
