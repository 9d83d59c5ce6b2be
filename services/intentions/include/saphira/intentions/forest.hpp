#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/intentions/activity.hpp"

namespace saphira::intentions {

/// One line of the intentions display (paper, Figure 10).
struct IntentionNode {
  std::uint32_t id = 0;      ///< from 1
  std::uint32_t parent = 0;  ///< 0: none
  std::string name;
  std::string schema;
  IntentionState state = IntentionState::kInit;
  bool blocking = true;
  std::string step;
  GoalId goal;  ///< that it serves

  bool operator==(const IntentionNode&) const = default;
};

/// How an intention came to its end.
struct Outcome {
  IntentionState state = IntentionState::kRunning;
  GoalCode code = GoalCode::kNone;
  std::string reason;
};

/// The intention structures (paper 3.3.1): a forest of intentions, whose leaves are behaviors. Each
/// step does at most one thing for each of them, which is what keeps the whole reactive.
///
/// The removal rules are manual 8.4's: an intention goes when it is removed, when it has finished
/// and has no parent that is still at work, and when its parent goes.
class Forest {
 public:
  Forest();
  ~Forest();
  Forest(Forest&&) noexcept;
  Forest& operator=(Forest&&) noexcept;

  /// Plants a tree for a goal; the number of its root. It is stepped first in the next step().
  std::uint32_t plant(const GoalId& goal, std::string_view name, std::string_view schema,
                      std::unique_ptr<Activity> activity);
  void interrupt(std::uint32_t id);
  void resume(std::uint32_t id);
  void remove(std::uint32_t id);

  /// Takes in what the behaviors service published in cycle `tick`.
  void hear(const std::vector<BehaviorLevel>& levels, Ticks tick);
  /// One cycle: one step for each intention.
  void step(Ticks now, const Robot& robot);
  /// A first step out of turn for one that was planted or resumed after step(), so that nothing
  /// intended is missing for a cycle.
  void begin(std::uint32_t id, Ticks now, const Robot& robot);

  bool contains(std::uint32_t id) const;
  /// How the roots that have finished ended, since the last call; they are gone.
  std::map<std::uint32_t, Outcome> take_ended();
  Activity& activity(std::uint32_t id);
  const std::string& step_of(std::uint32_t id) const;
  double progress_of(std::uint32_t id) const;

  /// What is intended now, in the order in which it was.
  std::vector<IntendedBehavior> behaviors() const;
  /// Parents before children.
  std::vector<IntentionNode> nodes() const;

 private:
  struct Node;
  class Handle;
  using Nodes = std::map<std::uint32_t, std::unique_ptr<Node>>;

  Node& add(const Node& parent, std::string_view name, std::string_view schema, bool blocking);
  Node* child_of(std::uint32_t parent, std::string_view label) const;
  void remove_children(std::uint32_t parent);
  void step_one(std::uint32_t id, Ticks now, const Robot& robot);
  void sweep();

  Nodes nodes_;  ///< by number: a parent has a smaller one than its children
  std::uint32_t last_id_ = 0;
  std::map<std::uint32_t, Outcome> ended_;
};

}  // namespace saphira::intentions
