#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "forest_node.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/forest.hpp"

namespace saphira::intentions {
namespace {

/// Intentions of one goal: the progress of a larger tree is not saved.
constexpr std::size_t kMostRemembered = 256;

}  // namespace

/// A tree for a restart of the service. Activities that do not keep their progress begin anew with
/// their arguments, which are places and headings by then.
struct Forest::Tree {
  Forest& forest;
  const MakeRoot& make_root;
  std::vector<std::uint32_t> ids;                                     ///< parents first
  std::map<std::string, std::pair<std::uint32_t, Belief>> beliefs{};  ///< that end with a node
  bool control_off = false;

  void archive(Archive& a) {
    forest.archive(a, ids, make_root, false);
    a("beliefs", beliefs)("control_off", control_off);
  }
};

Saved Forest::save(std::uint32_t root) {
  std::set<std::uint32_t> ids{root};
  for (auto id = ids.begin(); id != ids.end(); ++id) {
    const Node& node = *at(*id);
    if (node.activity != nullptr && node.activity->keeps_children())
      ids.insert(node.children.begin(), node.children.end());  // their numbers are larger
    if (ids.size() > kMostRemembered)
      return {};
  }
  Tree tree{*this, {}, {ids.begin(), ids.end()}};
  for (const auto& [name, id] : whiles_)
    if (const Belief* const belief = beliefs_->stored(name); ids.contains(id) && belief != nullptr)
      tree.beliefs[name] = {id, *belief};
  tree.control_off = control_off_.contains(root);
  return {saved(tree)};
}

void Forest::restore(std::uint32_t root, const Saved& saved, const MakeRoot& make_root) {
  if (saved == Saved{})
    throw ActivityError("it was more than can be remembered");
  Tree tree{*this, make_root, {}};
  try {
    saphira::restore(saved.text, tree);
    if (tree.ids.empty() || tree.ids.front() != root)
      throw ActivityError("the saved state is incomplete");
  } catch (...) {
    for (const std::uint32_t id : tree.ids)
      nodes_.erase(id);
    throw;
  }
  roots_.push_back(root);
  for (const auto& [name, own] : tree.beliefs) {
    whiles_[name] = own.first;
    beliefs_->set(own.second.name, own.second.value, own.second.said_by, own.second.since);
  }
  if (tree.control_off) {
    control_off_.insert(root);
    beliefs_->set(kBehaviorControl, Value(), at(root)->shown.schema, now_);
  }
}

void Forest::archive(Archive& a, std::vector<std::uint32_t>& ids, const MakeRoot& make_root,
                     bool whole) {
  a("ids", ids);
  for (const std::uint32_t id : ids) {
    std::unique_ptr<Node>& place = nodes_[id];
    if (a.restores())
      place = std::make_unique<Node>();
    Node& node = *place;
    a("I" + std::to_string(id), node);
    if (!node.behavior.name.empty())
      continue;
    if (a.restores()) {
      const std::shared_ptr<const Schema> schema = registry_->share(node.shown.schema);
      if (!schema)
        throw ActivityError("there is no activity " + node.shown.schema + " any more");
      node.activity = node.shown.parent == 0 ? make_root(id) : instantiate(*schema, node.given, {});
    }
    if (whole || node.activity->keeps_progress())
      a("A" + std::to_string(id), *node.activity);
    if (!whole && a.restores() && !node.activity->keeps_children()) {
      node.children.clear();
      if (!finished(node.shown.state))
        node.shown.state = node.suspended ? IntentionState::kSuspended : IntentionState::kInit;
    }
  }
  order_is_old_ = order_is_old_ || a.restores();
}

void Forest::archive(Archive& a, const MakeRoot& make_root) {
  std::vector<std::uint32_t> ids;
  for (const auto& [id, node] : nodes_)
    ids.push_back(id);
  if (a.restores()) {
    nodes_.clear();
    graves_.clear();
  }
  archive(a, ids, make_root, true);
  a("roots", roots_)("changed", changed_)("last_id", last_id_)("now", now_)("to_begin", to_begin_)(
      "to_tell", to_tell_)("doomed", doomed_)("begun", begun_)("ended", ended_)("said", said_)(
      "requests", requests_)("questions", questions_)("control_off", control_off_)(
      "whiles", whiles_)("woken", woken_);
}

}  // namespace saphira::intentions
