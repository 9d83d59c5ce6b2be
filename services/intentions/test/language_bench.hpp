#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "saphira/intentions/executor.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/language.hpp"

namespace saphira::intentions {

using Names = std::vector<std::string>;

/// The activity :it with these goals.
inline std::string activity(const std::string& goals, const std::string& rest = "") {
  return "(defintention :it " + rest + " :goals '(" + goals + "))";
}

inline std::string errors(const Loaded& loaded) {
  std::string text;
  for (const Diagnostic& trouble : loaded.troubles)
    text += trouble.text() + "\n";
  return text;
}

enum class MayFail { kNo, kYes };

/// An executor with activities from a text, and an obedient world.
class Stage {
 public:
  explicit Stage(const std::string& activities, const Functions& functions = core_functions(),
                 std::size_t most = ForestOptions{}.max_intentions,
                 MayFail may_fail = MayFail::kNo) {
    options.forest.max_intentions = most;
    options.functions = std::make_shared<const Functions>(functions);
    Registry registry = built_in();
    loaded = load_activities({{"test.act", activities}}, functions, registry);
    EXPECT_TRUE(loaded.ok() || may_fail == MayFail::kYes) << errors(loaded);
    for (const Schema& schema : loaded.schemas)
      registry.add(schema);
    executor = std::make_unique<Executor>(std::move(registry), Memory{}, options);
    inputs.epoch = 7;
    inputs.robot.connected = true;
    inputs.robot.odom = 1;
  }

  void ask(std::uint64_t id, const std::string& functor, Arguments arguments = {},
           int priority = 0) {
    GoalEvent event;
    event.goal.id = {1, id};
    event.goal.functor = functor;
    event.goal.arguments = std::move(arguments);
    event.goal.priority = priority;
    event.goal.level = level;
    inputs.events.push_back(event);
  }
  /// Asks for an activity, and steps.
  void begin(std::uint64_t id, const std::string& functor, int cycles = 1) {
    ask(id, functor);
    step(cycles);
  }
  void begin(int cycles = 1) { begin(1, "it", cycles); }
  void dispose(std::uint64_t id) {
    GoalEvent event;
    event.kind = GoalEvent::Kind::kDisposed;
    event.goal.id = {1, id};
    inputs.events.push_back(event);
  }

  /// Sets the level of the behavior whose name begins so, and steps.
  void satisfy(const std::string& name, double goal, int cycles = 0) {
    levels[name] = goal;
    step(cycles);
  }

  /// Sets whether a wheel is stalled, and steps.
  void stall(bool stalled, int cycles = 1) {
    inputs.robot.left_stalled = stalled;
    step(cycles);
  }

  void step(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      inputs.behaviors.clear();
      for (const IntendedBehavior& behavior : out.behaviors) {
        const std::string name = behavior.name.substr(0, behavior.name.rfind('#'));
        inputs.behaviors.push_back({behavior.name, levels.contains(name) ? levels[name] : 0.0, 0});
      }
      inputs.behaviors_cycle = inputs.cycle;
      ++inputs.cycle;
      out = executor->step(inputs);
      inputs.events.clear();
      inputs.claims.clear();
      inputs.troubles.clear();
      for (const GoalStatus& status : out.updates.changed)
        statuses[status.id.number] = status;
      for (const SpokenText& said : out.said)
        messages.push_back(said.text);
    }
  }

  const GoalStatus& status(std::uint64_t id) { return statuses[id]; }
  /// "*Plan (I3) S2; o Stop (halt) B": the intention display in one line.
  std::string display() const {
    std::string text;
    for (const IntentionNode& node : out.nodes)
      text += (text.empty() ? "" : "; ") + std::string(node.blocking ? "* " : "o ") + node.schema +
              " " + node.label;
    return text;
  }
  std::vector<std::string> behaviors() const {
    std::vector<std::string> names;
    for (const IntendedBehavior& behavior : out.behaviors)
      names.push_back(behavior.schema);
    return names;
  }
  Value belief(const std::string& name) const {
    for (const Belief& belief : executor->beliefs().all()) {
      if (belief.name == name)
        return belief.value;
    }
    return {};
  }

  ExecutorOptions options;
  Loaded loaded;
  std::unique_ptr<Executor> executor;
  Inputs inputs;
  Outputs out;
  std::map<std::uint64_t, GoalStatus> statuses;
  std::map<std::string, double> levels;
  std::vector<std::string> messages;
  double level = 0.0;
};

/// Somebody claims it, and it is so in the next step.
inline void claim(Stage& stage, const std::string& name, bool holds) {
  stage.inputs.claims.push_back({ClaimEvent::Kind::kSaid,
                                 {9, name.size() > 1 ? std::uint64_t(name[1]) : 1U},
                                 "somebody",
                                 name,
                                 Value::truth(holds)});
  stage.step();
}

}  // namespace saphira::intentions
