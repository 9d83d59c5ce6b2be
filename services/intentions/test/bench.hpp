#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "saphira/intentions/functors.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "scripted_robot.hpp"

namespace saphira::intentions {

/// "BLOCKED" of CODE_BLOCKED.
inline std::string code_name(GoalCode code) {
  static const std::map<GoalCode, std::string> kNames{{v1::CODE_UNKNOWN_FUNCTOR, "UNKNOWN_FUNCTOR"},
                                                      {v1::CODE_BAD_ARGUMENT, "BAD_ARGUMENT"},
                                                      {v1::CODE_CHANGED, "CHANGED"},
                                                      {v1::CODE_DEADLINE, "DEADLINE"},
                                                      {v1::CODE_NO_ROBOT, "NO_ROBOT"},
                                                      {v1::CODE_NO_ROUTE, "NO_ROUTE"},
                                                      {v1::CODE_APPROVAL, "APPROVAL"},
                                                      {v1::CODE_DISPOSED, "DISPOSED"},
                                                      {v1::CODE_WRITER_LOST, "WRITER_LOST"},
                                                      {v1::CODE_PREEMPTED, "PREEMPTED"},
                                                      {v1::CODE_STOPPED, "STOPPED"},
                                                      {v1::CODE_BLOCKED, "BLOCKED"},
                                                      {v1::CODE_NO_POSITION, "NO_POSITION"},
                                                      {v1::CODE_TIMEOUT, "TIMEOUT"}};
  const auto found = kNames.find(code);
  return found == kNames.end() ? std::to_string(code) : found->second;
}
/// Of "7:1".
inline v1::StopId stop_of(const std::string& text) {
  return {std::stoull(text), std::stoull(text.substr(text.find(':') + 1))};
}

/// An executor with a scripted robot, stepped by hand.
class Bench {
 public:
  explicit Bench(const Memory& before = {}, ExecutorOptions options = {})
      : executor(built_in(), before, remembering(std::move(options))), memory(before) {}

  static Goal goal(std::uint64_t number, std::string functor, Arguments arguments,
                   int priority = 0) {
    Goal made;
    made.id = {1, number};
    made.requester = "somebody";
    made.functor = std::move(functor);
    made.arguments = std::move(arguments);
    made.priority = priority;
    return made;
  }
  void ask(std::uint64_t number, std::string functor, Arguments arguments, int priority = 0) {
    write(goal(number, std::move(functor), std::move(arguments), priority));
  }
  /// Asks, and steps.
  void begin(std::uint64_t number, std::string functor, Arguments arguments, int priority = 0) {
    ask(number, std::move(functor), std::move(arguments), priority);
    step();
  }
  void write(const Goal& made) { events.push_back({GoalEvent::Kind::kWritten, made}); }
  void dispose(std::uint64_t number) { event(GoalEvent::Kind::kDisposed, number); }
  void lose_writer(std::uint64_t number) { event(GoalEvent::Kind::kWriterLost, number); }

  void step(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      step_without_moving();
      world.move(out.behaviors);
    }
  }
  /// Steps until the goal is no longer in that state, to that cycle at most.
  void run(std::uint64_t number, std::uint64_t until, GoalState while_in = v1::GOAL_UNDERWAY) {
    do
      step();
    while (state(number) == while_in && cycle < until);
  }
  void step_without_moving() {
    ++cycle;
    Inputs inputs{epoch, cycle, world.robot, world.levels, cycle - 1, std::exchange(events, {})};
    inputs.troubles = std::exchange(troubles, {});
    inputs.estop = estop;
    inputs.stop = stop;
    inputs.stop_source = "a person";
    inputs.confirms_stops = confirms_stops;
    inputs.around.registration = registration;
    inputs.around.robot_radius = radius;
    inputs.around.cycle = cycle;
    inputs.around.things = &things;
    out = executor.step(inputs);
    note(out.updates);
  }
  void hear() { note(executor.take_events(std::exchange(events, {}))); }
  void note(const GoalUpdates& updates) {
    for (const GoalStatus& each : updates.changed) {
      statuses[each.id.number] = each;
      ++published;
    }
    for (const GoalId& id : updates.withdrawn)
      statuses.erase(id.number);
    memory.endings.insert(memory.endings.end(), updates.endings.begin(), updates.endings.end());
    if (updates.work)
      memory.work = *updates.work;
  }

  const GoalStatus& status(std::uint64_t number) const { return statuses.at(number); }
  GoalState state(std::uint64_t number) const { return status(number).state; }

  Executor executor;
  ScriptedRobot world;
  std::uint64_t epoch = 100;
  std::uint64_t cycle = 0;
  std::vector<GoalEvent> events;
  std::vector<v1::MissingBehavior> troubles;  ///< of the next step
  Registered registration;                    ///< the registration's output
  std::vector<lps::SeenThing> things;         ///< that the cameras see
  double radius = 0.0;                        ///< [m] of the robot; 0: unknown
  std::string estop;  ///< program that pressed the emergency stop; empty: none
  v1::StopId stop;    ///< the newest stop of the bridge
  bool confirms_stops = false;
  Outputs out;
  std::map<std::uint64_t, GoalStatus> statuses;  ///< as a reader of goals/status has them
  std::size_t published = 0;
  Memory memory;  ///< of a newly started service

 private:
  static ExecutorOptions remembering(ExecutorOptions options) {
    options.remembers_work = true;
    return options;
  }
  void event(GoalEvent::Kind kind, std::uint64_t number) {
    GoalEvent made;
    made.kind = kind;
    made.goal.id = {1, number};
    events.push_back(made);
  }
};

}  // namespace saphira::intentions
