#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/situation/why.hpp"
#include "saphira/situation/words.hpp"
#include "why_words.hpp"

namespace saphira::situation {

/// [s] After this time without a packet, the last state says little about the present.
inline constexpr double kSilence = 1.0;
/// [s] Older inputs and commands are worth mentioning.
inline constexpr double kOldInput = 0.3;

/// [s] Age of samples on a hop that is worth naming.
inline constexpr double kSlowHop = 0.15;
/// Of limits by the age of inputs (behaviors), and of our own.
inline const std::string kSlowWords = "the network, or a computer, is slow";

/// How a behavior takes part in a channel of the blend.
struct Say {
  const v1::BehaviorState* behavior = nullptr;
  double weight = 0.0;  ///< its rules' strengths times its remaining activity
  double share = 0.0;   ///< [0..1] of all weights on the channel
  const v1::RuleState* main_rule = nullptr;
};

/// "behaviors (behaviors) was refused: ..."
std::string refused(const v1::Refusal& refusal);

/// Walks over the situation and puts it into words.
class Reason {
 public:
  explicit Reason(const Situation& situation) : scene_(situation) {}

  Explanation why();
  Explanation why_not(Wish wish);

 private:
  double told_speed() const {
    return scene_.grant ? scene_.grant->velocity : scene_.behaviors->speed;
  }
  /// [rad], of a turn that goes on [rad/s]
  double told_turn() const;
  bool by_behaviors() const {
    return !scene_.grant || scene_.grant->role == v1::ROLE_BEHAVIORS || scene_.own_mind;
  }
  std::string name_of(const v1::BehaviorState& behavior) const;
  std::vector<Say> says(Channel channel) const;
  std::string told() const;
  /// The robot's motion, where it differs from its setpoints; else empty.
  std::string meanwhile() const;
  std::string detour() const;
  std::string of_say(const Say& say, Channel channel, bool with_rule) const;
  std::string wants(const std::vector<Say>& speeds, const std::vector<Say>& turns,
                    const v1::BehaviorState& behavior, bool with_rules) const;

  const v1::RuleText* text_of(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;
  std::string antecedent(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;

  const v1::IntentionNode* node(std::uint32_t id) const;
  const v1::IntentionNode* node_of(const v1::BehaviorState& behavior) const;
  const v1::GoalStatus* status(const v1::GoalId& id) const;
  std::string goal_text(const v1::GoalId& id) const;
  /// Without its arguments.
  std::string goal_name(const v1::GoalId& id) const;
  std::string requester(const v1::GoalId& id) const;
  void add_purpose(Sentence& sentence,
                   const std::vector<const v1::BehaviorState*>& behaviors) const;
  /// The reason why no behavior drives; empty where unknown.
  std::string idle_reason(bool brief = false) const;
  /// `brief`: without the goal's arguments.
  std::string goals_reason(bool brief) const;
  const v1::GoalStatus* foremost() const;
  /// The foremost goal, with the age of its status.
  std::string last_known(bool brief) const;
  std::string goal_so_far(bool brief) const;
  std::string goal_of(const v1::GoalId& id, bool brief) const;

  /// " 12 s", for a cycle that is not 0.
  std::string ago(std::uint64_t since) const;
  std::string held() const;
  std::string slow_way() const;
  Cause grant_cause() const;
  std::optional<Cause> guard_cause() const;
  /// `brief`: without the end of its reason.
  std::string guard_words(bool brief) const;
  /// Of wheels that do not obey: motors that are off, or a stall.
  std::optional<Cause> hindrance() const;
  /// The old inputs of the behaviors, and their effect on the speed.
  std::optional<Cause> age_cause() const;
  Cause rule_cause(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;
  Cause behavior_cause(const Say& say, Channel channel);
  Cause channel_cause(Channel channel);
  std::optional<Cause> chain(const v1::BehaviorState& behavior);
  std::optional<Cause> chain(const v1::IntentionNode& node);
  Cause goal_cause(const v1::GoalId& id) const;
  Cause wheels(const std::string& text);

  bool does(Wish wish) const;
  bool nothing_known() const { return !scene_.robot && !scene_.grant && !scene_.behaviors; }
  Explanation known_so_far();
  Explanation silent();
  Explanation stopped() const;
  Explanation by_hand() const;
  Explanation by_behaviors_unknown() const;
  Explanation by_behaviors_known();
  Explanation finish(const Sentence& sentence, Cause cause) const;
  /// Adds the conditions of the programs involved, as far as they are not well.
  void add_conditions(Cause& cause) const;
  void add_troubles(Sentence& sentence) const;

  const Situation& scene_;
  void add_advice(const v1::IntentionNode& of, Cause& cause);
  std::set<std::string> told_beliefs_;
  std::set<std::uint32_t> told_nodes_;
};

}  // namespace saphira::situation
