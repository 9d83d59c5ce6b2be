#include "forest_handle.hpp"

#include <algorithm>
#include <utility>

#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/functions.hpp"

namespace saphira::intentions {

void Forest::Handle::intend_behavior(std::string_view label, std::string_view schema, int priority,
                                     Arguments parameters) {
  if (node_.concurrent)
    throw ActivityError(kMustNotDrive);
  Node* child = forest_.child_of(node_, label);
  if (child != nullptr && child->behavior.schema == schema &&
      child->behavior.priority == priority && child->behavior.parameters == parameters)
    return;
  if (child == nullptr || child->behavior.schema != schema) {
    if (child != nullptr)
      forest_.remove(child->shown.id);
    child = &forest_.add(node_, label, schema, true);
    child->label = label;
    child->shown.state = IntentionState::kRunning;
    child->shown.label = "B";
    // The number makes the name unique: samples about an earlier instance are not taken for this
    // one.
    child->shown.name = std::string(label) + "#" + std::to_string(child->shown.id);
    child->behavior.name = child->shown.name;
    child->behavior.schema = schema;
    child->behavior.intention = child->shown.id;
  }
  child->behavior.priority = priority;
  child->shown.priority = priority;
  child->behavior.parameters = std::move(parameters);
  child->since = world_.now;
  child->level = 0.0;
}

void Forest::Handle::drop_behavior(std::string_view label) {
  if (const Node* child = forest_.child_of(node_, label))
    forest_.remove(child->shown.id);
}

double Forest::Handle::level(std::string_view label) const {
  const Node* const child = forest_.child_of(node_, label);
  return child == nullptr ? 0.0 : child->level.value_or(0.0);
}

std::uint32_t Forest::Handle::intend(std::string_view name, std::string_view schema,
                                     std::unique_ptr<Activity> activity, Ticks timeout,
                                     bool blocking) {
  Node& child = forest_.add(node_, name, schema, blocking);
  child.activity = std::move(activity);
  child.timeout = timeout;
  child.begun = world_.now;
  return child.shown.id;
}

IntentionState Forest::Handle::child_state(std::uint32_t child) const {
  const Node* const found = mine(child);
  return found == nullptr ? IntentionState::kRemoved : found->shown.state;
}

double Forest::Handle::child_level(std::uint32_t child) const {
  return mine(child) == nullptr ? 0.0 : forest_.level_of(child);
}

const Outcome* Forest::Handle::child_outcome(std::uint32_t child) const {
  const Node* const found = mine(child);
  return found == nullptr || !finished(found->shown.state) ? nullptr : &found->outcome;
}

std::uint32_t Forest::Handle::child_named(std::string_view name) const {
  const std::string wanted = normal(name);
  for (auto id = node_.children.rbegin(); id != node_.children.rend(); ++id) {
    if (normal(forest_.at(*id)->shown.name) == wanted)
      return *id;
  }
  return 0;
}

void Forest::Handle::remove_child(std::uint32_t child) {
  if (mine(child) != nullptr)
    forest_.remove(child);
}

void Forest::Handle::hold_child(std::uint32_t child, bool hold) {
  if (mine(child) == nullptr)
    return;
  if (hold)
    forest_.interrupt(child, Hold::kActivity);
  else
    forest_.resume(child, Hold::kActivity);
}

bool Forest::Handle::unintend(std::string_view name) {
  const std::string wanted = normal(name);
  for (const Node* top = &node_; top != nullptr; top = forest_.at(top->shown.parent)) {
    const Node* const found = forest_.named(*top, wanted, node_);
    if (found == nullptr)
      continue;
    const std::uint32_t id = found->shown.id;
    for (const Node* above = &node_; above != nullptr; above = forest_.at(above->shown.parent)) {
      if (above == found) {
        // It is in its own step: it is removed after that.
        forest_.doomed_.push_back(id);
        return true;
      }
    }
    forest_.tell_parent(*found);
    forest_.remove(id);
    return true;
  }
  return false;
}

void Forest::Handle::label(const std::string& label) {
  if (node_.shown.label == label)
    return;
  node_.shown.label = label;
  node_.shown.since = world_.now;
}

void Forest::Handle::level(double satisfied) {
  node_.level = satisfied >= 0.0 ? std::min(satisfied, 1.0) : 0.0;
}

void Forest::Handle::tell(std::string text) {
  forest_.said_.push_back({node_.shown.id, node_.shown.schema, std::move(text), node_.shown.goal});
}

void Forest::Handle::believe(const std::string& name, Value value) {
  if (normal(name) == kBehaviorControl) {
    if (value.nil())
      forest_.control_off_.insert(node_.root);
    else
      forest_.control_off_.erase(node_.root);
    if (!forest_.behavior_control())
      value = Value();  // another one still keeps it off
  }
  forest_.whiles_.erase(normal(name));
  forest_.beliefs_->set(name, std::move(value), node_.shown.schema, world_.now);
}

void Forest::Handle::believe_while(const std::string& name, Value value) {
  believe(name, std::move(value));
  forest_.whiles_[normal(name)] = node_.shown.id;
}

void Forest::Handle::succeed(std::string reason) {
  node_.outcome = {IntentionState::kSuccess, v1::CODE_NONE, std::move(reason)};
}

void Forest::Handle::fail(GoalCode code, std::string reason) {
  node_.outcome = {IntentionState::kFailure, code, std::move(reason)};
}

const Forest::Node* Forest::Handle::mine(std::uint32_t child) const {
  const Node* const found = forest_.at(child);
  return found != nullptr && found->shown.parent == node_.shown.id ? found : nullptr;
}

}  // namespace saphira::intentions
