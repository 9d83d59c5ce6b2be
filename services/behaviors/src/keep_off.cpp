#include <algorithm>
#include <cmath>

#include "free_path.hpp"
#include "predefined.hpp"

namespace saphira::behaviors {
namespace {

/// [m] at sensitivity 1. Within the first the robot becomes cautious. Within the second it turns
/// away if a small turn is enough, within the third if it has to turn far: a robot that turns on
/// the spot has time, and what sonars show of a gap from further off is narrower than the gap.
constexpr double kCaution = 1.0;
constexpr double kSmallTurn = 0.7;
constexpr double kLargeTurn = 0.45;
/// Of these distances: a way that is free so far is free; one that is free for the second part is
/// as good as blocked.
constexpr double kFree = 0.8;
constexpr double kBlocked = 0.4;

constexpr double kRoom = 0.12;                ///< [m] beside the hull, where there is room
constexpr double kTight = 0.08;               ///< [m] beside the hull, at the least
constexpr double kTightCost = radians(40.0);  ///< a tight way is worth so much of a turn

constexpr double kWidest = radians(100.0);
constexpr double kStep = radians(2.5);
/// Of the way's bearing: less than all of it, or the robot would follow the grain of the readings.
constexpr double kGain = 0.6;
constexpr double kMostTurn = radians(40.0);

/// Steers to the free direction that is nearest to where the robot would go otherwise. Keeps the
/// side on which it goes around something until the way that it would go is free again: then it
/// does not swing to and fro before an obstacle, and gets around what is hollow.
class KeepOff : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const double scale = 0.5 + 0.5 * parameters.number("sensitivity");
    std::vector<Vec2> points;  // those that matter
    for (const Vec2& p : context.lps.obstacles())
      if (p.norm() < kCaution * scale + context.model.radius + kRoom)
        points.push_back(p);
    const double radius = context.model.radius;
    const double wish = std::clamp(context.shared.goal_bearing.value_or(0.0), -kWidest, kWidest);
    // What stands behind the goal is not in the way.
    const double goal = context.shared.goal_bearing ? context.shared.goal_distance + 0.05 : 1e9;
    const double reach = std::min(kSmallTurn * scale, goal);
    const double wish_free = free_path(points, wish, radius + kRoom, reach);
    const double caution = kCaution * scale;
    const double wish_caution = std::min(caution, goal);
    const Fuzzy near = f_or(down_straight(free_path(points, wish, radius + kRoom, wish_caution),
                                          kBlocked * wish_caution, wish_caution),
                            down_straight(free_path(points, 0.0, radius + kRoom, caution),
                                          kBlocked * caution, caution));
    if (wish_free >= reach)
      side_ = Side::none;

    double best = wish;
    if (wish_free < kFree * reach) {
      const Way left = best_way(points, radius, wish, Side::left, wish_caution);
      const Way right = best_way(points, radius, wish, Side::right, wish_caution);
      if (side_ == Side::none)
        side_ = side_from(parameters.text("preferred_turn"));
      if (side_ == Side::none)
        side_ = left.cost <= right.cost ? Side::left : Side::right;
      best = (side_ == Side::left ? left : right).direction;
    }
    if (side_ != Side::none)
      context.shared.preferred_turn = side_;

    const double from = reach - (reach - std::min(reach, kLargeTurn * scale)) *
                                    straight_up(std::abs(best), radians(20.0), radians(70.0));
    const Fuzzy blocked = down_straight(wish_free, kBlocked * from, from);
    const double turn = std::min(kGain * std::abs(best), kMostTurn);
    Evaluation evaluation;
    evaluation.rules = {
        {"way is left", best > 0.0 ? 1.0 : 0.0, Action::turn_left, turn},
        {"way is right", best > 0.0 ? 0.0 : 1.0, Action::turn_right, turn},
        {"caution", near, Action::speed, parameters.number("caution_speed")},
    };
    evaluation.activity = {.turn = blocked, .speed = near};
    return evaluation;
  }

 private:
  struct Way {
    double direction = 0.0;  ///< [rad]
    double cost = 1e9;       ///< [rad]
  };

  /// The cheapest direction on that side of `wish`: the way off and the turn, and more where it is
  /// tight; one that is blocked costs more than any that is free.
  static Way best_way(const std::vector<Vec2>& points, double radius, double wish, Side side,
                      double reach) {
    Way best{wish, 1e9};
    for (int i = 0; i <= static_cast<int>(2.0 * kWidest / kStep); ++i) {
      const double direction = wish + (side == Side::left ? i : -i) * kStep;
      if (std::abs(direction) > kWidest + 1e-9)
        break;
      double cost = std::abs(direction - wish) + 0.5 * std::abs(direction);
      const double tight = free_path(points, direction, radius + kTight, reach);
      if (tight < kFree * reach)
        cost += 2.0 * kPi * (2.0 - tight / reach);
      else if (free_path(points, direction, radius + kRoom, reach) < kFree * reach)
        cost += kTightCost;
      if (cost < best.cost)
        best = {direction, cost};
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
