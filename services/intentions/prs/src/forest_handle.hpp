#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "forest_node.hpp"

namespace saphira::intentions {

/// The handle of an activity: one node for one step.
class Forest::Handle : public Self {
 public:
  Handle(Forest& forest, Node& node, const World& world)
      : forest_(forest), node_(node), world_(world) {}

  const Robot& robot() const override { return world_.robot; }
  const World& world() const override { return world_; }
  Ticks now() const override { return world_.now; }
  IntentionState state() const override { return node_.shown.state; }

  void intend_behavior(std::string_view label, std::string_view schema, int priority,
                       Arguments parameters) override;

  void drop_behavior(std::string_view label) override;

  double level(std::string_view label) const override;

  std::uint32_t intend(std::string_view name, std::string_view schema,
                       std::unique_ptr<Activity> activity, Ticks timeout, bool blocking) override;

  std::uint32_t start(const Start& start) override { return forest_.start(node_, start, world_); }

  IntentionState child_state(std::uint32_t child) const override;
  double child_level(std::uint32_t child) const override;
  const Outcome* child_outcome(std::uint32_t child) const override;
  std::uint32_t child_named(std::string_view name) const override;

  void remove_child(std::uint32_t child) override;
  void hold_child(std::uint32_t child, bool hold) override;

  bool unintend(std::string_view name) override;

  void label(const std::string& label) override;
  void level(double satisfied) override;
  void tell(std::string text) override;
  void request(Request request) override { forest_.requests_.push_back(std::move(request)); }
  std::uint64_t ask(Request request) override { return forest_.ask(std::move(request)); }
  void believe(const std::string& name, Value value) override;
  void believe_while(const std::string& name, Value value) override;

  void say(std::string step) override { node_.shown.step = std::move(step); }
  void moved_on() override { forest_.changed_ = true; }
  void progress(double done) override { node_.progress = done >= 0.0 ? std::min(done, 1.0) : 0.0; }
  void succeed(std::string reason) override;
  void fail(GoalCode code, std::string reason) override;

 private:
  const Node* mine(std::uint32_t child) const;

  Forest& forest_;
  Node& node_;
  const World& world_;
};

}  // namespace saphira::intentions
