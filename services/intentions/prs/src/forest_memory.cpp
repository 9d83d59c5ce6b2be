#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "forest_node.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/forest.hpp"
#include "saphira/intentions/functions.hpp"

// The progress of a tree, over a restart of the service. Built-in activities, which manage their
// own children, begin anew with their arguments, which are places and headings by then.
namespace saphira::intentions {
namespace {

/// Intentions of one goal: the progress of a larger tree is not saved.
constexpr std::size_t kMostRemembered = 256;

}  // namespace

/// The memory of one intention.
struct Forest::SavedNode {
  std::uint32_t id = 0;
  std::uint32_t parent = 0;
  bool is_activity = false;
  std::optional<std::string> name;  ///< none: named after its number
  std::string schema;
  Bindings given;
  bool blocking = true;
  bool until_satisfied = false;
  int priority = 0;
  Ticks timeout = 0;
  Ticks begun = 0;
  std::optional<Ticks> suspended_at;
  unsigned holds = 0;
  IntentionState state = IntentionState::kInit;
  GoalCode code = v1::CODE_NONE;
  std::string reason;
  Saved activity;
  std::vector<std::pair<std::string, Value>> beliefs;  ///< that end with it

  /// Interrupted time does not count.
  Ticks begun_again(Ticks now) const { return begun + (suspended_at ? now - *suspended_at : 0); }
};

/// The memory of a tree.
struct Forest::SavedTree {
  bool control_off = false;
  std::vector<SavedNode> nodes;  ///< parents first
};

Forest::SavedNode Forest::save_one(const Node& node) const {
  SavedNode saved;
  saved.id = node.shown.id;
  saved.parent = node.shown.parent;
  saved.is_activity = node.activity != nullptr;
  if (node.shown.name != "I" + std::to_string(node.shown.id))
    saved.name = node.shown.name;
  saved.schema = node.shown.schema;
  saved.given = node.given;
  saved.blocking = node.shown.blocking;
  saved.until_satisfied = node.until_satisfied;
  saved.priority = node.shown.priority;
  saved.timeout = node.timeout;
  saved.begun = node.begun;
  if (node.suspended)
    saved.suspended_at = node.suspended_at;
  saved.holds = node.holds & ~static_cast<unsigned>(Hold::kGoal);
  saved.state = node.shown.state;
  saved.code = node.outcome.code;
  saved.reason = node.outcome.reason;
  if (node.activity != nullptr)
    saved.activity = node.activity->save();
  for (const auto& [name, id] : whiles_)
    if (const Belief* const belief = beliefs_->stored(name); id == node.shown.id && belief)
      saved.beliefs.emplace_back(belief->name, belief->value);
  return saved;
}

Saved Forest::save(std::uint32_t root) const {
  std::set<std::uint32_t> ids{root};
  for (auto id = ids.begin(); id != ids.end(); ++id) {
    const Node& node = *at(*id);
    if (node.activity != nullptr && node.activity->keeps_children())
      ids.insert(node.children.begin(), node.children.end());  // their numbers are larger
    if (ids.size() > kMostRemembered)
      return {};
  }
  SavedTree tree{control_off_.contains(root), {}};
  for (const std::uint32_t id : ids)
    tree.nodes.push_back(save_one(*at(id)));
  return {saved(tree)};
}

Forest::Node& Forest::restore_one(Node& parent, SavedNode saved, const World& world) {
  Start start;
  start.schema = saved.schema;
  start.name = saved.name.value_or("");
  start.arguments = saved.given;
  start.blocking = saved.blocking;
  start.until_satisfied = saved.until_satisfied;
  start.priority = saved.priority;
  start.timeout = saved.timeout;

  Node& child = add(parent, start.name, saved.schema, start.blocking);
  child.given = std::move(saved.given);
  if (!saved.name)
    child.shown.name = "I" + std::to_string(child.shown.id);
  if (saved.is_activity) {
    const std::shared_ptr<const Schema> schema = registry_->share(saved.schema);
    if (!schema)
      throw ActivityError("there is no activity " + saved.schema + " any more");
    child.activity = instantiate(*schema, child.given, world.robot);
    // A child that keeps its children continues; others begin, and intend their children again.
    if (child.activity->keeps_children() && saved.state != IntentionState::kInit)
      child.shown.state = IntentionState::kRunning;
    child.shown.priority = saved.priority;
  } else if (!finished(saved.state)) {
    make_behavior(child, start, world);
  }
  child.timeout = saved.timeout;
  child.begun = saved.begun_again(world.now);
  if (finished(saved.state)) {
    child.shown.state = saved.state;
    child.shown.label = "END";
    child.outcome = {saved.state, saved.code, std::move(saved.reason)};
  }
  return child;
}

void Forest::restore(std::uint32_t root, const Saved& saved, const World& world) {
  if (saved == Saved{})
    throw ActivityError("it was more than can be remembered");
  const auto tree = restored<SavedTree>(saved.text);
  const std::vector<SavedNode>& known = tree.nodes;
  if (known.empty())
    throw ActivityError("the saved state is incomplete");
  std::map<std::uint32_t, std::uint32_t> ids{{known[0].id, root}};
  try {
    for (std::size_t i = 1; i < known.size(); ++i) {
      const auto parent = ids.find(known[i].parent);
      if (parent == ids.end())
        throw ActivityError("the saved state is incomplete");
      ids[known[i].id] = restore_one(*at(parent->second), known[i], world).shown.id;
    }
    // The root last: after an earlier failure it is as it was planted.
    for (auto one = known.rbegin(); one != known.rend(); ++one) {
      Node& node = *at(ids.at(one->id));
      if (node.activity != nullptr && !finished(node.shown.state) && one->activity != Saved{})
        node.activity->restore(one->activity, ids);
    }
  } catch (...) {
    remove_children(*at(root));
    throw;
  }
  Node& top = *at(root);
  if (top.activity->keeps_children())
    top.shown.state = IntentionState::kRunning;
  top.begun = known[0].begun_again(world.now);
  for (const SavedNode& one : known)
    for (const Hold hold : {Hold::kActivity, Hold::kPerson})
      if ((one.holds & static_cast<unsigned>(hold)) != 0)
        interrupt(ids.at(one.id), hold);
  for (const SavedNode& one : known)
    for (const auto& [name, value] : one.beliefs) {
      whiles_[normal(name)] = ids.at(one.id);
      beliefs_->set(name, value, one.schema, world.now);
    }
  if (tree.control_off) {
    control_off_.insert(root);
    beliefs_->set(kBehaviorControl, Value(), top.shown.schema, world.now);
  }
}

void Forest::archive(Archive& a,
                     const std::function<std::unique_ptr<Activity>(std::uint32_t)>& make_root) {
  std::vector<std::uint32_t> ids;
  std::map<std::uint32_t, Saved> activities;
  for (const auto& [id, node] : nodes_) {
    ids.push_back(id);
    if (node->activity != nullptr && !a.restores())
      activities[id] = {saved(*node->activity)};
  }
  a("ids", ids)("activities", activities);
  if (a.restores()) {
    nodes_.clear();
    for (const std::uint32_t id : ids)
      nodes_[id] = std::make_unique<Node>();
    order_is_old_ = true;
    graves_.clear();
  }
  for (const auto& [id, node] : nodes_)
    a("I" + std::to_string(id), *node);
  a("roots", roots_)("changed", changed_)("last_id", last_id_)("now", now_)("to_begin", to_begin_)(
      "to_tell", to_tell_)("doomed", doomed_)("begun", begun_)("ended", ended_)("said", said_)(
      "requests", requests_)("questions", questions_)("control_off", control_off_)(
      "whiles", whiles_)("woken", woken_);
  if (!a.restores())
    return;
  for (const auto& [id, memory] : activities) {
    Node* const node = at(id);
    a.expect(node != nullptr, "the intention of each activity");
    const std::shared_ptr<const Schema> schema = registry_->share(node->shown.schema);
    a.expect(schema != nullptr, "no activity " + node->shown.schema);
    node->activity =
        node->shown.parent == 0 ? make_root(id) : instantiate(*schema, node->given, Robot{});
    saphira::restore(memory.text, *node->activity);
  }
}

}  // namespace saphira::intentions
