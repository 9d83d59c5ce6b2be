#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "forest_node.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/forest.hpp"
#include "saved.hpp"

// What has been done in a tree, over a restart of the service. Activities whose children are their
// own affair (those built in) begin anew with their arguments, which are places and headings by
// then.
namespace saphira::intentions {
namespace {

/// Intentions of one goal: of more than these, what has been done is not remembered.
constexpr std::size_t kMostRemembered = 256;

}  // namespace

Value Forest::save_one(const Node& node) const {
  Value::List given;
  for (const auto& [name, value] : node.given)
    given.emplace_back(Value::List{Value(name), value});
  const auto tick = [&](Ticks time) { return Value(static_cast<double>(time)); };
  const bool named = node.shown.name != "I" + std::to_string(node.shown.id);
  return Value(Value::List{
      count(node.shown.id), count(node.shown.parent), Value::truth(node.activity != nullptr),
      named ? Value(node.shown.name) : Value(), Value(node.shown.schema), Value(std::move(given)),
      Value::truth(node.shown.blocking), Value::truth(node.until_satisfied),
      Value(static_cast<double>(node.shown.priority)), Value(static_cast<double>(node.timeout)),
      tick(node.begun), node.suspended ? tick(node.suspended_at) : Value(),
      Value(static_cast<double>(node.holds & ~static_cast<unsigned>(Hold::kGoal))),
      Value(static_cast<double>(static_cast<int>(node.shown.state))),
      Value(static_cast<double>(static_cast<int>(node.outcome.code))), Value(node.outcome.reason),
      node.activity != nullptr ? node.activity->save() : Value()});
}

Value Forest::save(std::uint32_t root) const {
  std::set<std::uint32_t> ids{root};
  for (auto id = ids.begin(); id != ids.end(); ++id) {
    const Node& node = *at(*id);
    if (node.activity != nullptr && node.activity->keeps_children())
      ids.insert(node.children.begin(), node.children.end());  // their numbers are larger
    if (ids.size() > kMostRemembered)
      return {};
  }
  Value::List nodes{Value::truth(control_off_.contains(root))};
  for (const std::uint32_t id : ids)
    nodes.push_back(save_one(*at(id)));
  return Value(std::move(nodes));
}

Forest::Node& Forest::restore_one(Node& parent, const Value& saved, const World& world) {
  Saved in(saved);
  in.any();
  in.any();
  const bool is_activity = in.yes();
  const std::string name = in.text();
  const std::string schema_name = in.text();
  Bindings given;
  for (const Value& one : in.any().list()) {
    Saved each(one);
    std::string which = each.text();
    given.emplace_back(std::move(which), each.any());
  }
  Start start;
  start.schema = schema_name;
  start.name = name;
  start.arguments = given;
  start.blocking = in.yes();
  start.until_satisfied = in.yes();
  start.priority = in.whole<int>();
  start.timeout = in.whole<Ticks>();
  const Ticks begun = in.whole<Ticks>();
  const Value suspended = in.any();
  in.any();  // its holds: when the whole tree is there
  const auto state = static_cast<IntentionState>(in.whole<int>());
  Outcome outcome;
  outcome.code = static_cast<GoalCode>(in.whole<int>());
  outcome.reason = in.text();

  Node& child = add(parent, start.name, schema_name, start.blocking);
  child.given = std::move(given);
  if (name.empty())
    child.shown.name = "I" + std::to_string(child.shown.id);
  if (is_activity) {
    const std::shared_ptr<const Schema> schema = registry_->share(schema_name);
    if (!schema)
      throw ActivityError("there is no activity " + schema_name + " any more");
    child.activity = instantiate(*schema, child.given, world.robot);
    // One that keeps its children goes on; others begin, and intend again what they need.
    if (child.activity->keeps_children() && state != IntentionState::kInit)
      child.shown.state = IntentionState::kRunning;
    child.shown.priority = *start.priority;
  } else if (!finished(state)) {
    make_behavior(child, start, world);
  }
  child.timeout = start.timeout;
  // No time passed for it while it was interrupted.
  child.begun = suspended.number() == nullptr
                    ? begun
                    : begun + (world.now - static_cast<Ticks>(*suspended.number()));
  if (finished(state)) {
    child.shown.state = state;
    child.shown.label = "END";
    outcome.state = state;
    child.outcome = std::move(outcome);
  }
  return child;
}

void Forest::restore(std::uint32_t root, const Value& saved, const World& world) {
  const Value::List& nodes = saved.list();
  if (nodes.size() < 2)
    throw ActivityError("it was more than can be remembered");
  std::map<std::uint32_t, std::uint32_t> ids;
  const auto old_id = [](const Value& one) { return Saved(one).whole<std::uint32_t>(); };
  try {
    ids[old_id(nodes[1])] = root;
    for (std::size_t i = 2; i < nodes.size(); ++i) {
      Saved in(nodes[i]);
      const auto id = in.whole<std::uint32_t>();
      const auto parent = ids.find(in.whole<std::uint32_t>());
      if (parent == ids.end())
        throw ActivityError("what was remembered is not whole");
      ids[id] = restore_one(*at(parent->second), nodes[i], world).shown.id;
    }
    // The root last: it is as it was planted when anything before it fails.
    for (std::size_t i = nodes.size(); i-- > 1;) {
      Node& node = *at(ids.at(old_id(nodes[i])));
      if (node.activity != nullptr && !finished(node.shown.state) && !nodes[i].list().back().nil())
        node.activity->restore(nodes[i].list().back(), ids);
    }
  } catch (...) {
    remove_children(*at(root));
    throw;
  }
  Node& top = *at(root);
  if (top.activity->keeps_children())
    top.shown.state = IntentionState::kRunning;
  Saved first(nodes[1]);
  for (int i = 0; i < 10; ++i)
    first.any();
  top.begun = first.whole<Ticks>();
  const Value suspended = first.any();
  if (suspended.number() != nullptr)
    top.begun += world.now - static_cast<Ticks>(*suspended.number());
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    Saved in(nodes[i]);
    const auto id = in.whole<std::uint32_t>();
    for (int skipped = 0; skipped < 11; ++skipped)
      in.any();
    const auto holds = in.whole<unsigned>();
    for (const Hold hold : {Hold::kActivity, Hold::kPerson})
      if ((holds & static_cast<unsigned>(hold)) != 0)
        interrupt(ids.at(id), hold);
  }
  if (nodes[0].truthy()) {
    control_off_.insert(root);
    beliefs_->set(kBehaviorControl, Value(), top.shown.schema, world.now);
  }
}

}  // namespace saphira::intentions
