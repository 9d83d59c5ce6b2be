#include <algorithm>

#include "../../../services/behaviors/src/free_path.hpp"
#include "behaviors_in_cpp.hpp"

namespace saphira::bench {

using namespace behaviors;

namespace {

Rule turn_rule(std::string name, Fuzzy strength, double angle) {
  return {std::move(name), strength, angle >= 0.0 ? Action::turn_left : Action::turn_right,
          std::abs(angle)};
}

Side side_from(const std::string& text) {
  if (text == "left")
    return Side::left;
  return text == "right" ? Side::right : Side::none;
}

constexpr double kLookahead = 2.0;  ///< [m]
/// [m] The path that must be free is wider than the hull by this on each side: for the noise of
/// ranges and the width of a sonar's cone.
constexpr double kSlack = 0.04;
/// [m] per unit of sensitivity: the distance before the bubble over which the front goes from free
/// to blocked.
constexpr double kFrontScale = 0.2;
constexpr double kSideScale = 0.1;
/// [1/s] Before the bubble the speed is at most this times the remaining distance.
constexpr double kBraking = 0.8;
/// [rad] of turn per unit of turn gain.
constexpr double kTurnScale = radians(5.0);

/// [m] before the bubble: below the first distance the robot is blocked, until there is the second.
constexpr double kBlocked = 0.03;
constexpr double kClear = 0.2;

/// The obstacles ahead and to the sides, from the LPS: the fuzzy variables of paper 3.1.
struct Blocked {
  double gap = 0.0;  ///< [m] from the bubble to the obstacle ahead
  Fuzzy front = 0.0;
  Fuzzy front_left = 0.0;
  Fuzzy front_right = 0.0;
  Fuzzy side_left = 0.0;
  Fuzzy side_right = 0.0;
};

Blocked look(const Parameters& parameters, const Context& context) {
  const double standoff = parameters.number("standoff");
  const double front_scale = kFrontScale * parameters.number("front_sensitivity");
  const double side_scale = kSideScale * parameters.number("side_sensitivity");
  const double body = context.model.radius + kSlack;
  std::vector<Vec2> left;
  std::vector<Vec2> right;
  Blocked blocked;
  double left_gap = kLookahead;
  double right_gap = kLookahead;
  for (const Vec2& p : context.lps.obstacles()) {
    (p.y() >= 0.0 ? left : right).push_back(p);
    // Beside the robot or a little ahead, where turning would take the hull.
    if (p.x() > -0.5 * body && p.x() < body + standoff) {
      double& gap = p.y() >= 0.0 ? left_gap : right_gap;
      gap = std::min(gap, p.norm() - context.model.radius);
    }
  }
  const double left_free = free_path(left, 0.0, body, kLookahead) - standoff;
  const double right_free = free_path(right, 0.0, body, kLookahead) - standoff;
  blocked.gap = std::max(0.0, std::min(left_free, right_free));
  blocked.front_left = down_straight(left_free, 0.0, front_scale);
  blocked.front_right = down_straight(right_free, 0.0, front_scale);
  blocked.front = f_or(blocked.front_left, blocked.front_right);
  blocked.side_left = down_straight(left_gap, 0.5 * standoff, 0.5 * standoff + side_scale);
  blocked.side_right = down_straight(right_gap, 0.5 * standoff, 0.5 * standoff + side_scale);
  return blocked;
}

/// The speed that leaves room to stop before the bubble [m/s].
double careful_speed(const Blocked& blocked) {
  return kBraking * blocked.gap;
}

class AvoidCollision : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const Blocked blocked = look(parameters, context);
    const double turn = kTurnScale * parameters.number("turn_gain");
    choose_side(blocked, parameters, context);
    if (side_ != Side::none) {
      const double angle = side_ == Side::left ? turn : -turn;
      context.shared.preferred_turn = side_;
      return {{turn_rule("front blocked", 1.0, angle), {"halt", 1.0, Action::speed, 0.0}},
              {.turn = 1.0, .speed = 1.0}};
    }
    Evaluation evaluation;
    const Fuzzy away_right =
        f_and(blocked.front_left, f_not(blocked.front_right), f_not(blocked.side_right));
    const Fuzzy away_left =
        f_and(blocked.front_right, f_not(blocked.front_left), f_not(blocked.side_left));
    evaluation.rules = {
        {"front left blocked", away_right, Action::turn_right, turn},
        {"front right blocked", away_left, Action::turn_left, turn},
        {"something ahead", blocked.front, Action::speed, careful_speed(blocked)},
    };
    evaluation.activity = {.turn = f_or(away_left, away_right), .speed = blocked.front};
    return evaluation;
  }

 private:
  /// Blocked: no distance is left before the bubble. Then the robot turns on the spot to one side
  /// only, until there is a way.
  void choose_side(const Blocked& blocked, const Parameters& parameters, const Context& context) {
    if (side_ != Side::none) {
      if (blocked.gap > kClear)
        side_ = Side::none;
      return;
    }
    if (blocked.gap > kBlocked)
      return;
    side_ = side_from(parameters.text("preferred_turn"));
    if (side_ == Side::none)
      side_ = context.shared.preferred_turn;
    if (side_ != Side::none)
      return;
    const double lean =
        (blocked.front_right + blocked.side_right) - (blocked.front_left + blocked.side_left);
    if (std::abs(lean) > 0.1)
      side_ = lean > 0.0 ? Side::left : Side::right;
    else
      side_ = context.shared.goal_bearing.value_or(0.0) >= 0.0 ? Side::left : Side::right;
  }

  Side side_ = Side::none;
};

ParameterSpec sensitivity(std::string name, std::string what, double usual) {
  return number_parameter(std::move(name), std::move(what) + ": 0.5 not sensitive, 3 very", 0.5,
                          3.0, usual);
}

ParameterSpec standoff() {
  return number_parameter("standoff", "m, the bubble around the hull", 0.0, 1.0, 0.1);
}

ParameterSpec preferred_turn_parameter() {
  return choice_parameter("preferred_turn", "sfPreferredTurnDir", {"auto", "left", "right"});
}

}  // namespace

Schema avoid_collision_in_cpp() {
  return {"AvoidCollision",
          "slows and turns away sharply from what is near",
          {sensitivity("front_sensitivity", "to what is ahead", 1.5),
           sensitivity("side_sensitivity", "to what is beside", 1.0),
           number_parameter("turn_gain", "4 turns slowly, 10 fast", 4.0, 10.0, 6.0), standoff(),
           preferred_turn_parameter()},
          [] { return std::make_unique<AvoidCollision>(); }};
}

}  // namespace saphira::bench
