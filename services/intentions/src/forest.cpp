#include "saphira/intentions/forest.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace saphira::intentions {
namespace {

/// A level that the behaviors service published less than this long after the parameters were
/// intended is of the parameters before: it reads the intentions of the cycle before its own, and
/// one cycle more where, live, they came too late for it.
constexpr Ticks kLevelDelay = 2;

}  // namespace

struct Forest::Node {
  IntentionNode shown;
  std::unique_ptr<Activity> activity;  ///< none: it is a behavior
  // Of a behavior.
  std::string label;
  IntendedBehavior behavior;
  Ticks since = 0;  ///< when its parameters were intended
  double level = 0.0;
  // Of an activity.
  Ticks timeout = 0;
  Ticks begun = 0;
  double progress = 0.0;
  Outcome outcome;
};

/// What an activity gets hold of: one node for one step.
class Forest::Handle : public Self {
 public:
  Handle(Forest& forest, Node& node, Ticks now, const Robot& robot)
      : forest_(forest), node_(node), now_(now), robot_(robot) {}

  const Robot& robot() const override { return robot_; }
  Ticks now() const override { return now_; }
  IntentionState state() const override { return node_.shown.state; }

  void intend_behavior(std::string_view label, std::string_view schema, int priority,
                       Arguments parameters) override {
    Node* child = forest_.child_of(node_.shown.id, label);
    if (child != nullptr && child->behavior.schema == schema &&
        child->behavior.priority == priority && child->behavior.parameters == parameters)
      return;
    if (child == nullptr || child->behavior.schema != schema) {
      if (child != nullptr)
        forest_.remove(child->shown.id);
      child = &forest_.add(node_, label, schema, true);
      child->label = label;
      child->shown.state = IntentionState::kRunning;
      // Its number makes the name unique: what is left of an earlier instance in the behaviors'
      // samples is not taken for this one.
      child->shown.name = std::string(label) + "#" + std::to_string(child->shown.id);
      child->behavior.name = child->shown.name;
      child->behavior.schema = schema;
      child->behavior.intention = child->shown.id;
    }
    child->behavior.priority = priority;
    child->behavior.parameters = std::move(parameters);
    child->since = now_;
    child->level = 0.0;
  }

  void drop_behavior(std::string_view label) override {
    if (const Node* child = forest_.child_of(node_.shown.id, label))
      forest_.remove(child->shown.id);
  }

  double level(std::string_view label) const override {
    const Node* const child = forest_.child_of(node_.shown.id, label);
    return child == nullptr ? 0.0 : child->level;
  }

  std::uint32_t intend(std::string_view name, std::string_view schema,
                       std::unique_ptr<Activity> activity, Ticks timeout, bool blocking) override {
    Node& child = forest_.add(node_, name, schema, blocking);
    child.activity = std::move(activity);
    child.timeout = timeout;
    child.begun = now_;
    return child.shown.id;
  }

  IntentionState child_state(std::uint32_t child) const override {
    const auto found = forest_.nodes_.find(child);
    const bool mine =
        found != forest_.nodes_.end() && found->second->shown.parent == node_.shown.id;
    return mine ? found->second->shown.state : IntentionState::kRemoved;
  }

  void remove_child(std::uint32_t child) override {
    if (child_state(child) != IntentionState::kRemoved)
      forest_.remove(child);
  }

  void say(std::string step) override { node_.shown.step = std::move(step); }
  void progress(double done) override { node_.progress = std::clamp(done, 0.0, 1.0); }
  void succeed(std::string reason) override {
    node_.outcome = {IntentionState::kSuccess, GoalCode::kNone, std::move(reason)};
  }
  void fail(GoalCode code, std::string reason) override {
    node_.outcome = {IntentionState::kFailure, code, std::move(reason)};
  }

 private:
  Forest& forest_;
  Node& node_;
  Ticks now_;
  const Robot& robot_;
};

Forest::Forest() = default;
Forest::~Forest() = default;
Forest::Forest(Forest&&) noexcept = default;
Forest& Forest::operator=(Forest&&) noexcept = default;

std::uint32_t Forest::plant(const GoalId& goal, std::string_view name, std::string_view schema,
                            std::unique_ptr<Activity> activity) {
  auto node = std::make_unique<Node>();
  const std::uint32_t id = ++last_id_;
  node->shown.id = id;
  node->shown.name = name;
  node->shown.schema = schema;
  node->shown.goal = goal;
  node->activity = std::move(activity);
  nodes_.emplace(id, std::move(node));
  return id;
}

Forest::Node& Forest::add(const Node& parent, std::string_view name, std::string_view schema,
                          bool blocking) {
  auto node = std::make_unique<Node>();
  const std::uint32_t id = ++last_id_;
  node->shown.id = id;
  node->shown.parent = parent.shown.id;
  node->shown.name = name;
  node->shown.schema = schema;
  node->shown.goal = parent.shown.goal;
  node->shown.blocking = blocking;
  return *nodes_.emplace(id, std::move(node)).first->second;
}

void Forest::interrupt(std::uint32_t id) {
  Node& node = *nodes_.at(id);
  // What was never begun has nothing to put away.
  node.shown.state = node.shown.state == IntentionState::kInit ? IntentionState::kSuspended
                                                               : IntentionState::kInterrupted;
}

void Forest::resume(std::uint32_t id) {
  remove_children(id);
  nodes_.at(id)->shown.state = IntentionState::kResumed;
}

void Forest::remove(std::uint32_t id) {
  remove_children(id);
  nodes_.erase(id);
}

void Forest::remove_children(std::uint32_t parent) {
  std::vector<std::uint32_t> children;
  for (auto node = nodes_.upper_bound(parent); node != nodes_.end(); ++node) {
    if (node->second->shown.parent == parent)
      children.push_back(node->first);
  }
  for (const std::uint32_t child : children)
    remove(child);
}

Forest::Node* Forest::child_of(std::uint32_t parent, std::string_view label) const {
  for (auto node = nodes_.upper_bound(parent); node != nodes_.end(); ++node) {
    if (node->second->shown.parent == parent && !node->second->activity &&
        node->second->label == label)
      return node->second.get();
  }
  return nullptr;
}

void Forest::hear(const std::vector<BehaviorLevel>& levels, Ticks tick) {
  for (auto& [id, node] : nodes_) {
    if (node->activity || tick < node->since + kLevelDelay)
      continue;
    for (const BehaviorLevel& level : levels) {
      if (level.name == node->behavior.name)
        node->level = level.goal;
    }
  }
}

void Forest::step(Ticks now, const Robot& robot) {
  std::vector<std::uint32_t> ids;
  for (const auto& [id, node] : nodes_)
    ids.push_back(id);
  for (const std::uint32_t id : ids)
    step_one(id, now, robot);
  sweep();
}

void Forest::begin(std::uint32_t id, Ticks now, const Robot& robot) {
  step_one(id, now, robot);
  sweep();
}

void Forest::step_one(std::uint32_t id, Ticks now, const Robot& robot) {
  const auto found = nodes_.find(id);
  if (found == nodes_.end() || !found->second->activity)
    return;
  Node& node = *found->second;
  if (node.shown.state == IntentionState::kSuspended || finished(node.shown.state))
    return;
  const bool interrupted = node.shown.state == IntentionState::kInterrupted;
  Handle handle(*this, node, now, robot);
  node.activity->step(handle);
  if (finished(node.outcome.state)) {
    node.shown.state = node.outcome.state;
  } else if (interrupted) {
    node.shown.state = IntentionState::kSuspended;
  } else if (node.timeout > 0 && now - node.begun >= node.timeout) {
    node.shown.state = IntentionState::kTimeout;
    node.outcome = {IntentionState::kTimeout, GoalCode::kDeadline,
                    "not done in " + plain(kTick * static_cast<double>(node.timeout)) + " s"};
  } else {
    node.shown.state = IntentionState::kRunning;
    return;
  }
  // Nothing is left running by one that does not run (manual 8.1.4, and rule 3 of 8.4).
  remove_children(id);
}

void Forest::sweep() {
  std::vector<std::uint32_t> gone;
  for (const auto& [id, node] : nodes_) {
    if (finished(node->shown.state) && node->shown.parent == 0)
      gone.push_back(id);
  }
  for (const std::uint32_t id : gone) {
    ended_[id] = nodes_.at(id)->outcome;
    remove(id);
  }
}

bool Forest::contains(std::uint32_t id) const {
  return nodes_.contains(id);
}

std::map<std::uint32_t, Outcome> Forest::take_ended() {
  return std::exchange(ended_, {});
}

Activity& Forest::activity(std::uint32_t id) {
  const auto& node = nodes_.at(id);
  assert(node->activity);
  return *node->activity;
}

const std::string& Forest::step_of(std::uint32_t id) const {
  return nodes_.at(id)->shown.step;
}

double Forest::progress_of(std::uint32_t id) const {
  return nodes_.at(id)->progress;
}

std::vector<IntendedBehavior> Forest::behaviors() const {
  std::vector<IntendedBehavior> all;
  for (const auto& [id, node] : nodes_) {
    if (!node->activity)
      all.push_back(node->behavior);
  }
  return all;
}

std::vector<IntentionNode> Forest::nodes() const {
  std::vector<IntentionNode> all;
  all.reserve(nodes_.size());
  for (const auto& [id, node] : nodes_)
    all.push_back(node->shown);
  return all;
}

}  // namespace saphira::intentions
