#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/idl/behavior.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/endings.hpp"
#include "saphira/intentions/forest.hpp"
#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/schema.hpp"
#include "saphira/intentions/stops.hpp"
#include "saphira/intentions/work.hpp"

namespace saphira::intentions {

/// An event of a goal on the bus.
struct GoalEvent {
  enum class Kind { kWritten, kDisposed, kWriterLost };
  Kind kind = Kind::kWritten;
  Goal goal;          ///< kWritten: whole; otherwise only its id counts
  std::string by{};   ///< actor [empty: its requester]
  std::string why{};  ///< kDisposed: the actor's reason [empty: none]
  /// The reason why an unknown goal is not carried out, since it may have been done already [empty:
  /// carry it out].
  std::string forgotten{};
  /// kWritten: the reason why the robot may not do it [empty: it may].
  std::string forbidden{};
  bool needs_approval = false;  ///< waits until a person approves it (Executor::approve)
};

/// The inputs of a step.
struct Inputs {
  std::uint64_t epoch = 0;
  std::uint64_t cycle = 0;
  Robot robot;
  std::vector<BehaviorLevel> behaviors;
  std::uint64_t behaviors_cycle = 0;  ///< of this epoch; 0: none yet
  std::vector<GoalEvent> events;      ///< since the last step, oldest first
  Surroundings around{};
  std::vector<v1::MissingBehavior> troubles{};  ///< behaviors that could not be made
  std::vector<ClaimEvent> claims{};             ///< since the last step, oldest first
  std::string hold{};    ///< the reason why all goals wait; empty: they do not
  std::string person{};  ///< why goals that drive are to wait for a person; empty: they are not
  std::string estop{};   ///< the program that pressed the latched emergency stop; empty: none
  std::optional<v1::StopId> stop{};  ///< the newest stop of the bridge; none: it was not heard
  std::string stop_source{};         ///< its asker
  bool confirms_stops = false;       ///< live: the bridge's newest stop comes within some cycles
  /// [cycles] Age of the intent that the behaviors were computed from.
  std::uint64_t intent_age = 1;
};

/// The changes of goals since the last call.
struct GoalUpdates {
  std::vector<GoalStatus> changed;  ///< to be published, in order
  std::vector<GoalId> withdrawn;    ///< ended long ago: withdraw their status
  std::vector<Ending> endings;      ///< to be saved
  /// To be saved in place of the earlier work; none: unchanged.
  std::optional<Work> work;
};

/// The outputs of a step.
struct Outputs {
  std::vector<IntendedBehavior> behaviors;
  std::vector<IntentionNode> nodes;
  GoalUpdates updates;
  bool behavior_control = true;      ///< sfBehaviorControl (manual 7.4)
  std::vector<SpokenText> said;      ///< to people, oldest first
  std::vector<Request> requests{};   ///< to registration, oldest first
  std::vector<Request> questions{};  ///< to agents, oldest first; each has its number
  /// The requester of a stop for which the bridge is to be asked (Executor::heed); none: no stop.
  std::optional<std::string> stop{};
};

struct ExecutorOptions {
  double keep_ended = 60.0;          ///< [s] of robot time for an ended goal's status
  std::size_t max_shown = 1024;      ///< ended goals with a status; the oldest are withdrawn
  std::size_t max_open = 256;        ///< goals that may be open at once
  std::size_t max_open_of_one = 64;  ///< of a program, so that it leaves room for those of others
  std::size_t max_ended = kMostEndings;
  bool remembers_work = false;  ///< true: GoalUpdates::work is saved
  /// The functions for activities; their conditions are beliefs. None: core_functions().
  std::shared_ptr<const Functions> functions{};
  ForestOptions forest{};
};

/// Goals in, intended behaviors out (manual 8, paper 3.3): the executor of PRS-lite with a queue of
/// goals on top.
///
/// At most one driving goal is underway: the most important, of equals the earliest. A more
/// important one interrupts it; it resumes afterwards. Goals of concurrent schemas are underway
/// beside it. Without a goal underway nothing is intended, which releases the robot.
class Executor {
 public:
  explicit Executor(Registry registry, const Memory& memory = {}, ExecutorOptions options = {});

  /// One cycle of the robot.
  Outputs step(const Inputs& inputs);

  /// Takes events between cycles, so that a requester hears of a refusal also while no robot is
  /// connected. Starts nothing: the next step is the same whether the events came before or with
  /// it.
  GoalUpdates take_events(const std::vector<GoalEvent>& events);

  /// The id of the stop that a step asked for: goals of afterwards may drive.
  void heed(const v1::StopId& own) { stops_.heed(own); }
  /// The stop that all goals that drive come after.
  v1::StopId heeds() const { return stops_.heeds().value_or(v1::StopId{}); }

  /// The robot is gone (no cycles come). Goals wait for it; the next step continues.
  void lose_robot(const std::string& hold = {});

  /// The disk took neither the newest work nor these endings: they come again.
  void not_saved(const std::vector<Ending>& endings) { endings_.not_saved(endings, now_); }

  /// The places of the map: a hint for a person who asks for one in place of an activity.
  void know_places(std::shared_ptr<const maps::Topology> places) { places_ = std::move(places); }
  const Registry& registry() const { return *registry_; }
  /// Begun goals and intentions keep the schemas that they have.
  Registry& registry() { return *registry_; }
  const Beliefs& beliefs() const { return *beliefs_; }
  /// The robot's cycle at a time of nodes and beliefs, whose clock began with the service and does
  /// not count its sleep. 0: before the epoch.
  std::uint64_t cycle_of(Ticks time) const {
    return static_cast<std::uint64_t>(
        std::max<Ticks>(static_cast<Ticks>(cycle_) - awake_ + time, 0));
  }

  /// The goal, also one from before a restart that was not heard again; null: not known.
  const Goal* goal(const GoalId& id) const;
  /// Lets a goal begin that needs a person's approval. False: it waits for none.
  bool approve(const GoalId& id);

  /// Interrupts an intention with its descendants, or resumes it, by the number of its node (manual
  /// 6.5, sfInterruptProcess); of a behavior: it is not intended meanwhile (manual 2.3.6). False:
  /// no such intention.
  bool interrupt(std::uint32_t node);
  bool resume(std::uint32_t node);
  /// The value of a variable of an intention, by the number of its node; valid until the next step.
  /// nullptr: no such intention or variable.
  const Value* variable(std::uint32_t node, std::string_view name);

  /// Its state but the registry, which has to have the activities, and the places.
  void archive(Archive& a);

 private:
  using Entry = GoalEntry;
  struct Wait {
    std::string why;
    GoalCode code = v1::CODE_NONE;
  };

  void pass_time(const Inputs& inputs);
  void take_in(const GoalEvent& event);
  void take_written(const GoalEvent& event);
  void put_up(Entry& entry, const Goal& goal, Arguments complete);
  static bool depends_on_odom(const Entry& entry);
  void change(Entry& entry, const GoalEvent& event);
  std::string complaint(const GoalEvent& event, GoalCode& code, Arguments& complete) const;
  bool is_place(const std::string& functor) const;
  static void become(Entry& entry, GoalState state, GoalCode code, std::string reason);
  void end(Entry& entry, GoalState state, GoalCode code, std::string reason);
  void forget_ended();
  void suspend(Entry& entry, GoalCode code, std::string reason);
  void lose_robot(Entry& entry, const std::string& hold);
  void meet_odom(std::uint64_t odom);
  void place(Entry& entry, const Robot& robot);
  void pass_changes();
  void settle();
  void check_deadlines(const Robot& robot);
  void replace();
  void end_driving(const std::string& why);
  std::string step_of(const IntentionNode& node) const;
  Wait why_to_wait(const Entry& entry) const;
  Entry* arbitrate();
  void queue(Entry& entry, const Goal& front);
  void begin(Entry& entry);
  std::vector<Belief> lasting_beliefs() const;
  std::optional<Work> work();
  void recall(const Work& work);
  void recall(Entry& entry);
  void measure(Entry& entry);
  bool collect();
  static std::optional<GoalStatus> refused_change(const Entry& entry);
  GoalUpdates take_updates();

  ExecutorOptions options_;
  std::shared_ptr<Registry> registry_;
  std::shared_ptr<const maps::Topology> places_;  ///< none: no map
  std::shared_ptr<Beliefs> beliefs_;
  Forest forest_;
  std::map<GoalId, Entry> entries_;
  std::uint64_t set_revision_ = 0;
  Endings endings_;
  std::deque<GoalId> ended_order_;  ///< ended entries, in the order of their ends
  std::uint64_t next_order_ = 1;
  Ticks now_ = 0;    ///< of deadlines, and of what others are told
  Ticks awake_ = 0;  ///< of the activities: what the service slept counts for nothing
  std::uint64_t epoch_ = 0;
  std::uint64_t cycle_ = 0;
  bool robot_here_ = false;
  bool on_map_ = false;  ///< it is known where the robot is on the map
  Ticks place_by_ = 0;   ///< goals of before a restart wait until then for on_map_
  std::string person_;   ///< of the newest inputs
  Stops stops_;
  std::optional<std::uint64_t> odom_;  ///< of the newest step with a robot
  std::vector<GoalId> withdrawn_;
};

}  // namespace saphira::intentions
