#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/archive.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/value.hpp"
#include "saphira/intentions/world.hpp"

namespace saphira::intentions {

/// The level of a behavior's own goal that counts as reached (paper 3.4, degrees of blocking).
inline constexpr double kSatisfied = 0.9;

/// The reported satisfaction of a behavior instance.
struct BehaviorLevel {
  std::string name;       ///< of the instance
  double goal = 0.0;      ///< [0..1] how far its goal is satisfied
  double progress = 0.0;  ///< [0..1]
};

/// The arguments and options by which one intention begins another (paper 3.4, Intend).
struct Start {
  std::string_view schema;  ///< an activity or a behavior
  std::string_view name;    ///< empty: to be assigned
  Bindings arguments;
  Ticks timeout = 0;  ///< 0: none
  bool blocking = true;
  /// The behavior finishes when it is satisfied. Otherwise it lasts.
  bool until_satisfied = false;
  std::optional<int> priority;  ///< none: that of the parent; of behaviors 2
};

/// The result of an ended intention.
struct Outcome;

/// A behavior that should exist with these parameters.
struct IntendedBehavior {
  std::string name;  ///< of the instance, unique in the set
  std::string schema;
  int priority = 0;  ///< 0 is the highest
  bool running = true;
  Arguments parameters;
  std::uint32_t intention = 0;  ///< the node that intends it
  bool blocking = false;        ///< an intention waits for it

  bool operator==(const IntendedBehavior&) const = default;
};

/// The state of an intention (manual 8.4), less the numbers of the C form: the user's own states
/// are the activity's members, and kRunning stands for all of them.
enum class IntentionState {
  kInit,         ///< to be stepped for the first time
  kRunning,      ///< in a state of its own
  kSuspended,    ///< not stepped until it is resumed
  kInterrupted,  ///< one more step, to clean up; then suspended
  kResumed,      ///< to be stepped for the first time after a suspension
  kSuccess,
  kFailure,
  kTimeout,
  kRemoved
};

inline constexpr bool finished(IntentionState state) {
  return state == IntentionState::kSuccess || state == IntentionState::kFailure ||
         state == IntentionState::kTimeout;
}

class Activity;

/// An activity's view and actions in its step. The forest makes it for one step of one intention.
class Self {
 public:
  virtual ~Self() = default;

  virtual const Robot& robot() const = 0;
  virtual const World& world() const = 0;
  virtual Ticks now() const = 0;
  /// kInit, kResumed, kRunning or kInterrupted.
  virtual IntentionState state() const = 0;

  /// Intends a behavior under a label of this intention's own, or changes the existing one
  /// (intend_beh, manual 8.5). It lasts until it is dropped or this intention ends or is
  /// interrupted.
  virtual void intend_behavior(std::string_view label, std::string_view schema, int priority,
                               Arguments parameters) = 0;
  virtual void drop_behavior(std::string_view label) = 0;
  /// The behavior's own satisfaction [0..1]; 0 until the behaviors service has reported it for the
  /// present parameters. The measure for degrees of blocking (paper 3.4).
  virtual double level(std::string_view label) const = 0;

  /// Intends a child; returns its number. Timeout in ticks, 0: none. A child ends with this
  /// intention at the latest; its outcome can be read until it is removed (manual 8.4).
  virtual std::uint32_t intend(std::string_view name, std::string_view schema,
                               std::unique_ptr<Activity> activity, Ticks timeout,
                               bool blocking) = 0;
  virtual IntentionState child_state(std::uint32_t child) const = 0;
  virtual void remove_child(std::uint32_t child) = 0;

  /// Intends an activity or behavior by name; returns its number. It begins in the same cycle,
  /// after this step. ActivityError for an unknown schema, for arguments that it does not take, or
  /// for too many intentions.
  virtual std::uint32_t start(const Start& start) = 0;
  /// A child's satisfaction [0..1].
  virtual double child_level(std::uint32_t child) const = 0;
  /// A child's outcome; nullptr while it has not ended, or for an unknown child.
  virtual const Outcome* child_outcome(std::uint32_t child) const = 0;
  /// The newest child of that name; 0: none.
  virtual std::uint32_t child_named(std::string_view name) const = 0;
  /// Interrupts a child with its descendants, until it is resumed. For activities that keep their
  /// children (Activity::keeps_children).
  virtual void hold_child(std::uint32_t child, bool hold) = 0;
  /// Ends the nearest intention of that name in the same tree (paper 3.4, Unintend): first among
  /// its own descendants, then among its parent's, and so on. False: none.
  virtual bool unintend(std::string_view name) = 0;

  /// The next state, for the display.
  virtual void label(const std::string& label) = 0;
  /// This intention's satisfaction [0..1].
  virtual void level(double satisfied) = 0;
  virtual void tell(std::string text) = 0;         ///< a message to people
  virtual void request(Request request) = 0;       ///< of registration
  virtual std::uint64_t ask(Request request) = 0;  ///< agents; the number of the question
  virtual void believe(const std::string& name, Value value) = 0;  ///< an environment variable
  /// The same, until this intention ends or is removed.
  virtual void believe_while(const std::string& name, Value value) = 0;

  /// The present step, for people: short, and the same from cycle to cycle.
  virtual void say(std::string step) = 0;
  /// Reports that its progress has changed.
  virtual void moved_on() = 0;
  virtual void progress(double done) = 0;  ///< [0..1]
  virtual void succeed(std::string reason) = 0;
  virtual void fail(GoalCode code, std::string reason) = 0;
};

/// An instance of a schema: a finite-state machine with one step a cycle (manual 8.1).
///
/// Must: return soon, use no clock and no randomness of its own, and end unless it is meant to
/// last. May: ignore kInterrupted, since its behaviors and children are removed for it; it has to
/// intend them anew when it is resumed.
class Activity {
 public:
  virtual ~Activity() = default;
  virtual void step(Self& self) = 0;
  /// A child has ended or is gone, in the cycle in which step() has been called already.
  virtual void child_ended(Self& self) { static_cast<void>(self); }
  /// True where it waits for that child's end. Where a behavior cannot be made, an intention that
  /// does not wait for it fails: the other behaviors must not drive without it.
  virtual bool waits_for(std::uint32_t child) const {
    static_cast<void>(child);
    return false;
  }
  /// True: interruption and resumption apply to its children as well. False: its children are
  /// removed.
  virtual bool keeps_children() const { return false; }
  /// True: it goes on where it was after a restart of the service. It reports its progress
  /// (Self::moved_on). False: its arguments are enough.
  virtual bool keeps_progress() const { return keeps_children(); }
  /// Its whole state, to go on at the same place in the same forest.
  virtual void archive(Archive& a) { static_cast<void>(a); }
  /// The value of a parameter or variable of its own; nullptr where it has none of that name.
  virtual const Value* variable(std::string_view name) const {
    static_cast<void>(name);
    return nullptr;
  }
  /// New arguments for the running activity; false where it has to be begun anew.
  virtual bool change(const Arguments& arguments) {
    static_cast<void>(arguments);
    return false;
  }
  /// The deadline of its goal has come: the reason in words where that is a success, empty where it
  /// is a failure.
  virtual std::string at_deadline(const Robot& robot) {
    static_cast<void>(robot);
    return {};
  }
};

}  // namespace saphira::intentions
