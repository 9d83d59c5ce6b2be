// The CPU time of intentions: those of a delivery, and ten thousand that wait.

#include <ctime>
#include <stdexcept>

#include "executive_bench.hpp"
#include "saphira/intentions/executor.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/language.hpp"

namespace saphira::bench {
namespace {

using namespace intentions;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// Figure 10, with present behaviors: avoidance beside the delivery, six intentions that wait for
// others, monitors that wait for conditions, and a loop that computes.
const char* const kDelivery = R"(
(defintention :avoid
  :goals '((INTEND :AvoidCollision () :blocking t :priority 0 :name collide)))
(defintention :deliver-object
  :goals '((INTEND :avoid () :blocking nil)
           (INTEND :watch-robot () :blocking nil)
           (INTEND :watch-time () :blocking nil)
           (INTEND :plan-and-execute ((dest . 'EJ-231)))))
(defintention :watch-robot :goals '((WAIT-FOR (or stalled (not connected)) :forever t)))
(defintention :watch-time :goals '((WAIT-FOR (> (elapsed) 100000) :forever t)))
(defintention :plan-and-execute :params (dest)
  :goals '((EXECUTE (setq *failed-execution* nil))
           (INTEND :monitor-planex () :blocking nil)
           (INTEND :follow-path ((path . (list 1 2 3))) :name follow-it)))
(defintention :monitor-planex
  :goals '((WAIT-FOR *failed-execution* :forever t) (UNINTEND 'follow-it)))
(defintention :follow-path :params (path)
  :goals '((INTEND :watch-door () :blocking nil)
           (INTEND :corridor-to-junction ((goal . (point 10 0))))))
(defintention :watch-door :goals '((WAIT-FOR (belief 'door-closed) :forever t)))
(defintention :corridor-to-junction :params (goal)
  :goals '((INTEND :measure ((goal . goal)) :blocking nil)
           (INTEND :follow-to-target ((goal . goal)))))
(defintention :measure :params (goal)
  :goals '((:again (EXECUTE (setq *left* (distance goal)))
                   (= near (straight-down (distance goal) 0.5 2)))
           (IF (> near 0.9) (EXECUTE (say "nearly there")))
           (GOTO :again)))
(defintention :follow-to-target :params (goal) :level (straight-down (distance goal) 0.5 5)
  :goals '((INTEND :Follow ((goal . goal)) :blocking nil :name follow)
           (INTEND :KeepOff () :blocking nil :name keep-off)
           (INTEND :hold-course ((goal . goal)))))
(defintention :hold-course :params (goal)
  :goals '((PRESERVE (< (abs (bearing goal)) 4) (INTEND :TurnTo ((goal . goal)) :name orient))))
)";

std::unique_ptr<Executor> executor(const std::string& text) {
  const Functions functions = core_functions();
  Registry registry = built_in();
  const Loaded loaded = load_text("bench.act", text, functions, registry);
  if (!loaded.ok())
    throw std::logic_error(loaded.troubles.front().text());
  for (const Schema& schema : loaded.schemas)
    registry.add(schema);
  // Higher limits than a service has: the cost of one intention does not depend on the others.
  return std::make_unique<Executor>(
      std::move(registry), Memory{},
      ExecutorOptions{.forest = {.max_intentions = 65536, .max_behaviors = 65536}});
}

Inputs first_inputs() {
  Inputs inputs;
  inputs.epoch = 1;
  inputs.robot.connected = true;
  inputs.robot.odom = 1;
  return inputs;
}

GoalEvent ask(std::uint64_t number, const std::string& functor) {
  GoalEvent event;
  event.goal.id = {1, number};
  event.goal.functor = functor;
  return event;
}

/// [ms] a cycle, each with another pose of the robot and other levels.
double cycle_ms(Executor& executor, Inputs& inputs, const Outputs& first, int cycles) {
  std::vector<BehaviorLevel> levels;
  for (const IntendedBehavior& behavior : first.behaviors)
    levels.push_back({behavior.name, 0.0, 0.0});
  double begin = 0.0;
  for (int i = -5; i < cycles; ++i) {
    if (i == 0)
      begin = cpu_seconds();
    ++inputs.cycle;
    inputs.behaviors = levels;
    inputs.behaviors_cycle = inputs.cycle - 1;
    for (BehaviorLevel& level : inputs.behaviors)
      level.goal = 0.001 * (i & 511);
    inputs.robot.pose_in_odom = {0.0001 * i, 0.0, 0.0};
    const Outputs out = executor.step(inputs);
    if (out.nodes.size() != first.nodes.size())
      throw std::logic_error("the intentions do not go on as they were");
  }
  return (cpu_seconds() - begin) * 1000.0 / cycles;
}

}  // namespace

double intentions_12_ms() {
  const auto delivery = executor(kDelivery);
  Inputs inputs = first_inputs();
  inputs.events = {ask(1, "deliver-object")};
  Outputs out;
  for (int i = 0; i < 20; ++i) {
    ++inputs.cycle;
    out = delivery->step(inputs);
    inputs.events.clear();
  }
  std::size_t activities = 0;
  for (const IntentionNode& node : out.nodes)
    activities += node.label == "B" ? 0U : 1U;
  if (activities != 12)
    throw std::logic_error(std::to_string(activities) + " intentions instead of 12");
  return cycle_ms(*delivery, inputs, out, 5000);
}

double intentions_10000_ms() {
  // A tree of 1 + 10 + 10 * 999 intentions: nearly the limit of children.
  std::string text = "(defintention :top :goals '(";
  for (int i = 0; i < 10; ++i)
    text += "(INTEND :crowd () :blocking nil)";
  text +=
      "(WAIT-FOR *never* :forever t)))"
      "(defintention :crowd :goals '((:begin (= i 0))"
      "  (:more (INTEND :one () :blocking nil) (= i (+ i 1))) (IF (< i 999) (GOTO :more))"
      "  (WAIT-FOR *never* :forever t)))"
      "(defintention :one :goals '((WAIT-FOR (or *never* stalled) :forever t)))";
  const auto crowd = executor(text);
  Inputs inputs = first_inputs();
  inputs.events = {ask(1, "top")};
  Outputs out;
  for (int i = 0; i < 2500; ++i) {
    ++inputs.cycle;
    out = crowd->step(inputs);
    inputs.events.clear();
  }
  if (out.nodes.size() != 10'001)
    throw std::logic_error(std::to_string(out.nodes.size()) + " intentions instead of 10,001");
  return cycle_ms(*crowd, inputs, out, 50);
}

}  // namespace saphira::bench
