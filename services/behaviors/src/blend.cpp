#include "saphira/behaviors/blend.hpp"

#include <algorithm>

namespace saphira::behaviors {
namespace {

/// Weighted values of one channel.
struct Sum {
  double weight = 0.0;
  double value = 0.0;

  void add(double w, double v) {
    weight += w;
    value += w * v;
  }
};

bool turns(const Rule& rule) {
  return rule.action == Action::turn_left || rule.action == Action::turn_right;
}

/// The setpoint that the rule asks for: [rad] counter-clockwise or [m/s].
double setpoint(const Rule& rule, double velocity) {
  switch (rule.action) {
    case Action::turn_left:
    case Action::speed:
      return rule.value;
    case Action::turn_right:
      return -rule.value;
    case Action::accelerate:
      return velocity + rule.value;
    case Action::decelerate:
      // To a stop, not into reverse.
      return velocity > 0.0 ? std::max(0.0, velocity - rule.value) : velocity;
  }
  return 0.0;
}

double clamp01(double x) {
  return std::clamp(x, 0.0, 1.0);
}

/// The turn of rules with the weight `sum`: the rest to 1 counts as "straight on".
double turn_of(const Sum& sum) {
  return sum.value / std::max(1.0, sum.weight);
}

}  // namespace

Blend blend(std::vector<Blended>& behaviors, double velocity) {
  double turn_left_over = 1.0;
  double speed_left_over = 1.0;
  Sum turn;
  Sum speed;
  for (std::size_t begin = 0; begin < behaviors.size();) {
    std::size_t end = begin;
    double most_turn = 0.0;
    double most_speed = 0.0;
    for (; end < behaviors.size() && behaviors[end].priority == behaviors[begin].priority; ++end) {
      Blended& b = behaviors[end];
      Sum own_turn;
      Sum own_speed;
      for (const Rule& rule : b.evaluation.rules)
        (turns(rule) ? own_turn : own_speed).add(clamp01(rule.strength), setpoint(rule, velocity));
      const double turn_activity = clamp01(b.evaluation.activity.turn);
      const double speed_activity = clamp01(b.evaluation.activity.speed);
      b.recommends_turn = own_turn.weight > 0.0;
      b.recommends_speed = own_speed.weight > 0.0;
      b.turn = b.recommends_turn ? turn_of(own_turn) : 0.0;
      b.speed = b.recommends_speed ? own_speed.value / own_speed.weight : 0.0;
      b.turn_weight = turn_left_over * turn_activity;
      b.speed_weight = speed_left_over * speed_activity;
      turn.weight += b.turn_weight * own_turn.weight;
      turn.value += b.turn_weight * own_turn.value;
      speed.weight += b.speed_weight * own_speed.weight;
      speed.value += b.speed_weight * own_speed.value;
      most_turn = std::max(most_turn, turn_activity);
      most_speed = std::max(most_speed, speed_activity);
    }
    turn_left_over *= 1.0 - most_turn;
    speed_left_over *= 1.0 - most_speed;
    begin = end;
  }
  Blend result;
  result.turning = turn.weight > 0.0;
  result.turn = result.turning ? turn_of(turn) : 0.0;
  result.moving = speed.weight > 0.0;
  result.speed = result.moving ? speed.value / speed.weight : 0.0;
  return result;
}

}  // namespace saphira::behaviors
