#include <cmath>

#include "saphira/situation/words.hpp"
#include "why_reason.hpp"

namespace saphira::situation {

/// True where the robot's command, from any program, is that motion.
bool Reason::does(Wish wish) const {
  const double turn = told_turn();
  const double speed = scene_.grant->role == v1::ROLE_NONE ? 0.0 : told_speed();
  const double velocity = scene_.robot ? scene_.robot->velocity : speed;
  switch (wish) {
    case Wish::turn_left:
      return turn >= kNoTurn;
    case Wish::turn_right:
      return turn <= -kNoTurn;
    case Wish::faster:
      return std::abs(speed) >= std::abs(velocity) + kFarFromTold;
    case Wish::slower:
      break;
  }
  return std::abs(speed) <= std::abs(velocity) - kFarFromTold;
}

Explanation Reason::why_not(Wish wish) {
  const bool turning = wish == Wish::turn_left || wish == Wish::turn_right;
  const Channel channel = turning ? Channel::turn : Channel::speed;
  const std::string wanted = wish == Wish::turn_left    ? "turn left"
                             : wish == Wish::turn_right ? "turn right"
                             : wish == Wish::faster     ? "go faster"
                                                        : "go slower";
  const std::string no = "It does not " + wanted;
  const Explanation as_it_is = why();
  const auto instead = [&](const std::string& first) {
    Sentence sentence;
    sentence.add(0, first + ". " + as_it_is.sentence.substr(0, as_it_is.sentence.size() - 1));
    return finish(sentence, as_it_is.cause);
  };
  if (!scene_.grant || (by_behaviors() && !scene_.behaviors))
    return instead("It is not known whether it is to " + wanted);
  if (wish != Wish::slower && hindrance())
    return instead(no);
  if (does(wish))
    return instead("It does " + wanted);
  if (!by_behaviors() || (!scene_.past && scene_.silence > kSilence))
    return instead(no);

  const v1::BehaviorSet& all = *scene_.behaviors;
  const double speed = told_speed();
  Cause cause{"wheels", told()};
  if (wish == Wish::faster && scene_.grant->guard != v1::GUARD_NONE &&
      all.speed > speed + kNoSpeed) {
    const Cause guard = *guard_cause();
    cause.because.push_back(guard);
    cause.because.push_back(channel_cause(channel));
    Sentence sentence;
    sentence.add(0, no + " because " + guard.text);
    sentence.add(1, "; the behaviors want " + speed_text(all.speed));
    return finish(sentence, std::move(cause));
  }

  if (const auto limit = age_cause(); wish == Wish::faster && limit && !all.limit_reason.empty()) {
    cause.because.push_back(*limit);
    cause.because.push_back(channel_cause(channel));
    Sentence sentence;
    sentence.add(0, no + ": " + limit->text);
    return finish(sentence, std::move(cause));
  }

  const auto would = [&](const v1::RuleState& rule) {
    switch (wish) {
      case Wish::turn_left:
        return rule.action == v1::CONTROL_TURN_LEFT && rule.value > 0.0;
      case Wish::turn_right:
        return rule.action == v1::CONTROL_TURN_RIGHT && rule.value > 0.0;
      case Wish::faster:
        return rule.action == v1::CONTROL_ACCELERATE ||
               (rule.action == v1::CONTROL_SPEED && rule.value > speed + kNoSpeed);
      case Wish::slower:
        break;
    }
    return rule.action == v1::CONTROL_DECELERATE ||
           (rule.action == v1::CONTROL_SPEED && rule.value < speed - kNoSpeed);
  };
  // The best reason comes from the rule that was nearest to success.
  enum Rank { not_true, too_little, no_activity, suppressed, outweighed };
  struct Best {
    int rank = -1;
    double measure = 0.0;
    std::string text;
  } best;
  const auto consider = [&](Rank rank, double measure, std::string text, Cause detail) {
    cause.because.push_back(std::move(detail));
    if (rank > best.rank || (rank == best.rank && measure > best.measure))
      best = {rank, measure, std::move(text)};
  };
  const std::vector<Say> say = says(channel);
  for (const v1::BehaviorState& behavior : all.behaviors) {
    // The rules of a behavior that is not running are unknown.
    if (!behavior.running)
      continue;
    for (const v1::RuleState& rule : behavior.rules) {
      if (!would(rule))
        continue;
      // The setpoint of a rule that does not hold is no wish.
      if (wish == Wish::faster && rule.action == v1::CONTROL_SPEED && rule.strength < kNoSay)
        continue;
      const std::string who =
          name_of(behavior) + " would (rule " + rule.name + ", " + control_text(rule) + ")";
      const double weight = weight_of(behavior, channel);
      Cause detail = rule_cause(behavior, rule);
      detail.text = name_of(behavior) + ": " + detail.text;
      if (rule.strength < kNoSay) {
        const std::string text = antecedent(behavior, rule);
        consider(not_true, 0.0, who + ", but finds no cause" + (text.empty() ? "" : ": " + text),
                 std::move(detail));
      } else if (turning && rule.strength * rule.value < kNoTurn) {
        consider(too_little, rule.value, who + ", but that turn is too small to matter",
                 std::move(detail));
      } else if (activity_of(behavior, channel) < kNoSay) {
        consider(no_activity, rule.strength, who + ", but says itself that it does not count now",
                 std::move(detail));
      } else if (weight < kNoSay) {
        std::vector<std::string> above;
        for (const v1::BehaviorState& other : all.behaviors)
          if (other.running && other.priority < behavior.priority &&
              activity_of(other, channel) >= kNoSay)
            above.push_back(name_of(other));
        consider(suppressed, rule.strength,
                 who + ", but " + (above.empty() ? "others of higher priority" : listed(above)) +
                     (above.size() == 1 ? " has a higher priority and decides alone"
                                        : " have a higher priority and decide alone"),
                 std::move(detail));
      } else {
        const Say* against = nullptr;
        const Say* own = nullptr;
        for (const Say& other : say) {
          if (other.behavior == &behavior) {
            own = &other;
            continue;
          }
          const bool opposed = turning ? (wish == Wish::turn_left) != (other.behavior->turn > 0.0)
                               : wish == Wish::faster ? other.behavior->speed < speed + kNoSpeed
                                                      : other.behavior->speed > speed - kNoSpeed;
          if (opposed && other.weight >= kNoSay && against == nullptr)
            against = &other;
        }
        // Rules within one behavior may oppose each other, too.
        std::string what = who + ", but ";
        if (against == nullptr && own != nullptr)
          what += "all its rules together want " + wish_of(behavior, channel);
        else if (against == nullptr)
          what += "it weighs too little for it";
        else
          what += name_of(*against->behavior) + " wants " + of_say(*against, channel, true);
        consider(outweighed, rule.strength * weight, std::move(what), std::move(detail));
      }
    }
  }
  Sentence sentence;
  if (best.rank < 0) {
    sentence.add(
        0, no + ": no running behavior " + (turning ? "has a rule that would" : "wants that"));
    for (const Say& one : say)
      if (one.weight >= kNoSay) {
        sentence.add(1, "; " + name_of(*one.behavior) + " wants " + of_say(one, channel, true));
        break;
      }
    return finish(sentence, wheels(told()));
  }
  cause.because.push_back(channel_cause(channel));
  sentence.add(0, no + ": " + best.text);
  return finish(sentence, std::move(cause));
}

}  // namespace saphira::situation
