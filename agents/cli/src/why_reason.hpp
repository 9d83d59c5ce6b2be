#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/cli/why.hpp"
#include "why_words.hpp"

namespace saphira::cli {

/// How a behavior takes part in a channel of the blend.
struct Say {
  const v1::BehaviorState* behavior = nullptr;
  double weight = 0.0;  ///< its rules' strengths times what is left of its activity
  double share = 0.0;   ///< [0..1] of all weights on the channel
  const v1::RuleState* main_rule = nullptr;
};

/// Walks over what is known and puts it into words.
class Reason {
 public:
  explicit Reason(const Scene& scene) : scene_(scene) {}

  Explanation why();
  Explanation why_not(Wish wish);

 private:
  double told_speed() const {
    return scene_.grant ? scene_.grant->velocity() : scene_.behaviors->speed();
  }
  std::string name_of(const v1::BehaviorState& behavior) const;
  std::vector<Say> says(Channel channel) const;
  std::string told() const;
  std::string of_say(const Say& say, Channel channel) const;
  std::string wants(const std::vector<Say>& speeds, const std::vector<Say>& turns,
                    const v1::BehaviorState& behavior) const;

  const v1::RuleText* text_of(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;
  std::string antecedent(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;

  const v1::IntentionNode* node(std::uint32_t id) const;
  const v1::IntentionNode* node_of(const v1::BehaviorState& behavior) const;
  const v1::GoalStatus* status(const v1::GoalId& id) const;
  std::string goal_text(const v1::GoalId& id) const;
  std::string requester(const v1::GoalId& id) const;
  std::string purpose(const std::vector<const v1::BehaviorState*>& behaviors) const;
  std::string idle_reason() const;

  Cause grant_cause() const;
  std::optional<Cause> guard_cause() const;
  /// What is old of what the behaviors act on, and what that does to the speed.
  std::optional<Cause> age_cause() const;
  Cause rule_cause(const v1::BehaviorState& behavior, const v1::RuleState& rule) const;
  Cause behavior_cause(const Say& say, Channel channel);
  Cause channel_cause(Channel channel);
  std::optional<Cause> chain(const v1::BehaviorState& behavior);
  std::optional<Cause> chain(const v1::IntentionNode& node);
  Cause goal_cause(const v1::GoalId& id) const;
  Cause wheels(const std::string& text);

  Explanation stopped() const;
  Explanation by_hand() const;
  Explanation finish(std::string sentence, Cause cause) const;

  const Scene& scene_;
  std::set<std::uint32_t> told_nodes_;
};

}  // namespace saphira::cli
