#include <algorithm>
#include <array>
#include <cmath>

#include "free_path.hpp"
#include "predefined.hpp"

namespace saphira::behaviors {
namespace {

constexpr double kLookahead = 1.0;  ///< [m] at sensitivity 1
constexpr double kRoom = 0.12;      ///< [m] beside the hull, where there is room
constexpr double kWidest = radians(100.0);
constexpr double kStep = radians(5.0);

/// Steers to the free direction that is nearest to where the robot would go otherwise. Keeps the
/// side on which it goes around something until the way that it would go is free again: then it
/// does not swing to and fro before an obstacle, and gets around what is hollow.
class KeepOff : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const double sensitivity = parameters.number("sensitivity");
    const double lookahead = kLookahead * std::clamp(0.5 + 0.5 * sensitivity, 0.5, 1.5);
    const double wide = context.model.radius + kRoom;
    const double wish = std::clamp(context.shared.goal_bearing.value_or(0.0), -kWidest, kWidest);
    // What stands behind the goal is not in the way.
    const double reach = context.shared.goal_bearing
                             ? std::min(lookahead, context.shared.goal_distance + 0.05)
                             : lookahead;
    const std::vector<Vec2>& points = context.lps.obstacles();
    const auto blocked = [&](double direction, double to) {
      return down_straight(free_path(points, direction, wide, to), 0.4 * to, to);
    };
    const Fuzzy wish_blocked = blocked(wish, reach);
    const Fuzzy ahead_blocked = blocked(0.0, lookahead);
    const Side told = side_from(parameters.text("preferred_turn"));

    if (wish_blocked <= 0.05)
      side_ = Side::none;
    double best = wish;
    if (wish_blocked > 0.0) {
      const double left = first_free(points, wish, kStep, wide, lookahead);
      const double right = first_free(points, wish, -kStep, wide, lookahead);
      if (side_ == Side::none) {
        if (told != Side::none)
          side_ = told;
        else
          side_ = std::abs(left) + std::abs(left - wish) <= std::abs(right) + std::abs(right - wish)
                      ? Side::left
                      : Side::right;
      }
      best = side_ == Side::left ? left : right;
      context.shared.preferred_turn = side_;
    }
    const Fuzzy active = f_or(wish_blocked, std::min(ahead_blocked, wish_blocked));
    Evaluation evaluation;
    evaluation.rules = {
        {"way is left", best > 0.0 ? 1.0 : 0.0, Action::turn_left,
         std::min(std::abs(best), radians(40.0))},
        {"way is right", best > 0.0 ? 0.0 : 1.0, Action::turn_right,
         std::min(std::abs(best), radians(40.0))},
        {"caution", f_or(wish_blocked, ahead_blocked), Action::speed,
         parameters.number("caution_speed")},
    };
    evaluation.activity = {.turn = active, .speed = f_or(wish_blocked, ahead_blocked)};
    return evaluation;
  }

 private:
  static double first_free(const std::vector<Vec2>& points, double wish, double step, double radius,
                           double lookahead) {
    double best = wish;
    double best_free = -1.0;
    for (int i = 0; i <= static_cast<int>(2.0 * kWidest / kStep); ++i) {
      const double direction = wish + i * step;
      if (std::abs(direction) > kWidest + 1e-9)
        break;
      const double free = free_path(points, direction, radius, lookahead);
      if (free >= 0.8 * lookahead)
        return direction;
      if (free > best_free) {
        best_free = free;
        best = direction;
      }
    }
    return best;
  }

  Side side_ = Side::none;
};

}  // namespace

Schema keep_off() {
  return {"KeepOff",
          "steers gently around what is further off",
          {number_parameter("caution_speed", "m/s, when something is near", 0.0, 2.0, 0.2),
           number_parameter("sensitivity", "0.2 not sensitive, 2 very", 0.2, 2.0, 1.0),
           preferred_turn_parameter()},
          [] { return std::make_unique<KeepOff>(); }};
}

}  // namespace saphira::behaviors
