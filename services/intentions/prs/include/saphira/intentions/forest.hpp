#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/idl/behavior.hpp"
#include "saphira/intentions/activity.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// One line of the intentions display (paper, Figure 10).
struct IntentionNode {
  std::uint32_t id = 0;      ///< from 1
  std::uint32_t parent = 0;  ///< 0: none
  std::string name;
  std::string schema;
  std::string arguments;  ///< its arguments in words; those of a root are its goal's
  IntentionState state = IntentionState::kInit;
  bool blocking = true;
  std::string label;  ///< the next state; B: a behavior
  std::string step;
  Ticks since = 0;   ///< start of this label
  int priority = 0;  ///< larger ones are stepped first; of a behavior 0 is the highest
  double level = 0.0;
  GoalId goal;  ///< the goal that it serves

  bool operator==(const IntentionNode&) const = default;
};

/// The result of an ended intention.
struct Outcome {
  IntentionState state = IntentionState::kRunning;
  GoalCode code = v1::CODE_NONE;
  std::string reason;
};

/// A message of an intention to people.
struct SpokenText {
  std::uint32_t intention = 0;
  std::string schema;
  std::string text;
  GoalId goal;
};

struct ForestOptions {
  std::size_t max_intentions = 4096;  ///< in all: the limit of a runaway intention's cost
  std::size_t max_behaviors = 256;    ///< of them: the bound of Intentions
  std::size_t max_children = 1024;    ///< of one intention
  std::size_t max_depth = 64;         ///< intentions within intentions
  std::size_t max_begun = 1024;       ///< in one cycle; more begin in the next one
};

/// The reasons to hold an intention. It continues when all are lifted.
enum class Hold : unsigned { kGoal = 1, kActivity = 2, kPerson = 4 };

/// The intention structures (paper 3.3.1): a forest of intentions, whose leaves are behaviors. Each
/// step does at most one thing for each intention, which keeps the whole reactive.
///
/// In a step each intention is stepped once, those of higher priority first, then the older ones.
/// Intentions that begin by start() are stepped as well, and the parent of an ended intention is
/// informed: ends go up and successors begin within the cycle.
///
/// The removal rules are manual 8.4's: an intention is removed on request, when it has finished and
/// has no parent still at work, and with its parent.
class Forest {
 public:
  /// `registry`: the schemas for start(); `beliefs`: the values set by activities; either may be
  /// none.
  explicit Forest(std::shared_ptr<const Registry> registry = nullptr,
                  std::shared_ptr<Beliefs> beliefs = nullptr, ForestOptions options = {});
  ~Forest();
  Forest(Forest&&) noexcept;
  Forest& operator=(Forest&&) noexcept;

  /// Plants a tree for a goal; returns the number of its root. It is stepped first in the next
  /// step(). In a concurrent tree no behavior can be intended: an attempt fails.
  std::uint32_t plant(const GoalId& goal, std::string_view name, std::string_view schema,
                      std::unique_ptr<Activity> activity, int priority = 0, double timeout = 0.0,
                      bool concurrent = false);
  /// Makes the activity of a root, to be restored.
  using MakeRoot = std::function<std::unique_ptr<Activity>(std::uint32_t)>;
  /// The progress in the tree of a root, for a restart of the service; none where it is too large.
  Saved save(std::uint32_t root);
  /// Restores the tree of a root under its old number. std::runtime_error where that is impossible
  /// (another version of the schema): then nothing has changed.
  void restore(std::uint32_t root, const Saved& saved, const MakeRoot& make_root);
  /// The whole forest.
  void archive(Archive& a, const MakeRoot& make_root);
  /// The newest number of an intention: after a restart later ones follow it.
  std::uint32_t last_id() const { return last_id_; }
  void begin_after(std::uint32_t last_id, Ticks now) {
    last_id_ = last_id;
    now_ = now;
  }
  /// True where save() may have changed since the last call.
  bool take_changed() { return std::exchange(changed_, false); }

  void interrupt(std::uint32_t id, Hold why = Hold::kGoal);
  void resume(std::uint32_t id, Hold why = Hold::kGoal);
  bool held(std::uint32_t id, Hold why) const;
  void remove(std::uint32_t id);

  /// Takes the behaviors service's reports on the intent of cycle `tick`. A report for the cycle in
  /// which a behavior's parameters were intended does not count yet, nor an older one.
  void hear(const std::vector<BehaviorLevel>& levels, Ticks tick);
  /// A behavior that cannot be made fails the intention that began it.
  void hear(const std::vector<v1::MissingBehavior>& troubles);
  /// One cycle: one step for each intention.
  void step(const World& world);
  void step(Ticks now, const Robot& robot);
  /// A first step out of turn for an intention that was planted or resumed after step(), so that no
  /// behavior is missing for a cycle. An intention that was stepped and continues is left alone.
  void begin(std::uint32_t id, const World& world);

  bool contains(std::uint32_t id) const;
  /// True for an intention that is not a behavior.
  bool is_activity(std::uint32_t id) const;
  /// The outcomes of finished roots since the last call; the roots are gone.
  std::map<std::uint32_t, Outcome> take_ended();
  std::vector<SpokenText> take_said();
  std::vector<Request> take_requests();
  /// Questions to agents, with their numbers.
  std::vector<Request> take_questions();
  Activity& activity(std::uint32_t id);
  /// The deepest intention that it waits for, directly or in turn; itself where it waits for none:
  /// the present work.
  const IntentionNode& foremost(std::uint32_t id) const;
  double progress_of(std::uint32_t id) const;
  /// Its satisfaction [0..1].
  double level_of(std::uint32_t id) const;

  /// False while an existing tree has set *behavior-control* to nil (sfBehaviorControl, manual
  /// 7.4).
  bool behavior_control() const;
  /// True for a belief that ends with the intention that set it. save() includes its value.
  bool ends_with_intention(std::string_view belief) const;

  /// The intended behaviors, in the order of intending.
  std::vector<IntendedBehavior> behaviors() const;
  /// Parents before children.
  std::vector<IntentionNode> nodes() const;

 private:
  struct Node;
  struct Tree;
  class Handle;
  using Nodes = std::map<std::uint32_t, std::unique_ptr<Node>>;

  Node* at(std::uint32_t id) const;
  Node& add(Node& parent, std::string_view name, std::string_view schema, bool blocking);
  Node* child_of(const Node& parent, std::string_view label) const;
  Node* named(const Node& top, std::string_view name, const Node& seeker) const;
  std::uint32_t start(Node& parent, const Start& start, const World& world);
  void make_behavior(Node& node, const Start& start, const World& world);
  std::uint64_t ask(Request request);
  void archive(Archive& a, std::vector<std::uint32_t>& ids, const MakeRoot& make_root, bool whole);
  void watch(Node& node, const World& world);
  void remove_children(Node& parent);
  void drop(std::uint32_t id);
  void end_beliefs(std::uint32_t id);
  void tell_parent(const Node& node);
  void suspend(Node& node);
  void wake(Node& node);
  static double level_of(const Node& node);
  void sort();
  void step_one(Node& node, const World& world);
  void work_off(const World& world);
  void conclude(Node& node, bool interrupted, const World& world);
  void end_cycle(const World& world);

  std::shared_ptr<const Registry> registry_;
  std::shared_ptr<Beliefs> beliefs_;
  ForestOptions options_;
  Nodes nodes_;  ///< by number: a parent has a smaller one than its children
  std::vector<std::uint32_t> roots_;
  std::vector<Node*> order_;      ///< of stepping
  std::vector<Node*> behaviors_;  ///< in the order in which they were intended
  bool order_is_old_ = false;
  bool changed_ = false;
  /// Removed since the last step: they may include the intention that is being stepped.
  std::vector<std::unique_ptr<Node>> graves_;
  std::uint32_t last_id_ = 0;
  Ticks now_ = 0;
  std::deque<std::uint32_t> to_begin_;  ///< started, and not stepped yet
  std::deque<std::uint32_t> to_tell_;   ///< parents of ended children
  std::vector<std::uint32_t> doomed_;   ///< removed by itself or by its descendants
  std::size_t begun_ = 0;               ///< of to_begin_ in this cycle
  std::map<std::uint32_t, Outcome> ended_;
  std::vector<SpokenText> said_;
  std::vector<Request> requests_;
  std::vector<Request> questions_;
  std::set<std::uint32_t> control_off_;  ///< roots that switched behavior control off
  std::map<std::string, std::uint32_t, std::less<>> whiles_;  ///< beliefs that end with a node
  std::vector<std::uint32_t> woken_;  ///< resumed behaviors, whose points may be old
};

}  // namespace saphira::intentions
