#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/base/identity.hpp"
#include "saphira/idl/system.hpp"
#include "saphira/requests/argument.hpp"

namespace saphira {
class Archive;
}

namespace saphira::agent_interface {

using UtteranceId = std::pair<std::uint64_t, std::uint64_t>;

/// A program that speaks to the robot; zeros: none, a person spoke.
using ProgramId = std::array<std::uint8_t, 16>;

/// An utterance to the robot.
struct Utterance {
  UtteranceId id{};
  std::string speaker;  ///< empty: unknown
  std::string text;
  double confidence = 1.0;  ///< [0..1] of the recognizer
  double time = 0.0;        ///< [s] since 1970; 0: unknown
  ProgramId program{};      ///< the task ends with this program
  std::string corrects{};   ///< the words themselves, where they put the text in place of another
  Checked person{};         ///< who said it, as checked; the speaker's name is not
};

/// An utterance of the robot.
struct Said {
  UtteranceId answers{};  ///< 0, 0: to none
  std::string listener;
  std::string text;
  bool end = false;      ///< no more answers to that utterance follow
  bool refused = false;  ///< nothing is done about that utterance: asked back, or refused
};

/// A goal on the bus: its asker, and its number there.
using GoalRef = std::pair<std::uint64_t, std::uint64_t>;

/// A goal that no program has taken up by then is withdrawn.
inline constexpr double kTakenUp = 5.0;  // [s]
inline constexpr const char* kNotTakenUp =
    "no program has taken up the goal: saphira status shows whether intentions runs";

/// The deadline [s] of the goal for a request with this one, so that its end is known and answered
/// before the request is too late; 0: none. A `drive` lasts until the deadline of its goal.
inline double goal_deadline(double of_request) {
  constexpr double answering = 0.5;  // [s] some cycles, and the way of the status
  return of_request <= 0.0 ? 0.0 : std::max(of_request - answering, 0.5 * of_request);
}

/// A goal that the dialogue wants; `tag` is its name within the dialogue.
struct WantedGoal {
  std::uint64_t tag = 0;
  std::string functor;
  Arguments arguments;
  double deadline = 0.0;  ///< [s]; 0: none
  bool lasting = false;   ///< a task, which continues while the dialogue restarts
  std::string speaker{};  ///< the person who asked for it; empty: unknown
  int priority = 0;       ///< larger: suspends the others
  Checked person{};       ///< who asked for it

  /// The asker's name on the bus; empty: unknown.
  std::string requester() const { return speaker.empty() ? speaker : speaker + " (by words)"; }
};

/// The state of a goal that the dialogue asked for.
struct Outcome {
  std::uint64_t tag = 0;
  bool success = false;
  std::string reason;
};

/// A goal that outlives a restart of the dialogue.
struct LastingGoal {
  std::uint64_t tag = 0;
  GoalRef ref{};
  std::string sample;  ///< as the shell wrote it; empty: unknown

  bool operator==(const LastingGoal&) const = default;
};

/// The rules for as long as an order is done.
struct Rules {
  std::vector<std::string> zones{};  ///< as the belief `hazards` has them: "keep-out at lobby"
  bool slow = false;                 ///< at a slow pace
  std::string source{};              ///< who said so, in words
  std::string text{};                ///< behind the order: ", slowly"
};

/// The order of a person. Its owner is the speaker of its goal.
struct Task {
  WantedGoal goal;
  std::string what;        ///< "I go to the library"
  std::string doing;       ///< "going to the library"; empty: unknown
  std::string name;        ///< "the way to the library"; empty: unknown
  UtteranceId answers{};   ///< the utterance that asked for it
  GoalRef ref{};           ///< of a lasting goal on the bus
  std::string sample;      ///< that goal as the shell wrote it
  ProgramId program{};     ///< the task ends with this program
  bool brief = false;      ///< a motion or a look: a task goes on after it
  bool waits = false;      ///< it was told that it waits
  Rules rules{};           ///< for this step
  std::vector<Task> then;  ///< the later steps of a sequence
};

/// With its later steps: "I go to the library, and then I wait there".
std::string whole_text(const Task& task);

/// The tasks of all people, and their order. A brief goal (a motion, a look) interrupts a
/// task, which goes on afterwards. A task takes the place of an earlier one of the same person; for
/// that of somebody else the robot asks first. Where identities are checked, only its owner and
/// operators end a task but by a stop. A value: no clock.
class Tasks {
 public:
  struct Outputs {
    std::vector<Said> said;
    std::vector<std::uint64_t> canceled;  ///< tags; before the new goals
    std::string why{};                    ///< they are canceled, in words; empty: no reason
    std::vector<WantedGoal> goals;
    std::vector<Task> asks;   ///< the steps for which it asks "Shall I drop that?"
    v1::AuditEntry denied{};  ///< this person may not do it; without a text: they may
  };

  /// The goal of another asker that is done before all others of them.
  struct Front {
    std::string name;  ///< "the way to library for saphira goal"
    int priority = 0;
    bool before_task = true;  ///< it also goes before the open task
  };
  /// As it is from now on; nothing: nobody else has a goal that drives.
  void heed(std::optional<Front> front) { front_ = std::move(front); }
  /// The steps of a command, one after another. A goal of "stop" ends all others at once.
  /// drops: also ends the task of somebody else, without a question.
  Outputs want(std::vector<Task> steps, const Utterance& utterance, bool drops = false);
  Outputs ended(const Outcome& outcome);
  /// Steps for a later time [s] since 1970, which end nothing before then. A stop ends them.
  struct Later {
    double time = 0.0;
    Utterance order;
    std::vector<Task> steps;
  };
  Outputs later(double time, std::vector<Task> steps, const Utterance& order);
  /// The robot was stopped other than by words: the steps for later end.
  Outputs stopped(const std::string& who);
  /// Those whose time has come.
  std::vector<Later> take_due(double now);
  /// After a wait: the wait ends, and the task goes on. After a stop: the dropped task begins anew.
  Outputs go_on(const Utterance& utterance);
  /// A program has ended or has withdrawn its words: its tasks end. A stop of it goes on.
  Outputs left(const ProgramId& program);
  /// ": I go on with the mail for alice"; empty: with nothing.
  std::string going_on(const std::string& listener) const;

  /// The open task that is not brief; nullptr: none.
  const Task* task() const;
  /// The open task of that tag; nullptr: none.
  const Task* find(std::uint64_t tag) const;
  /// A lasting goal was asked for, under that name and with that text.
  void asked(std::uint64_t tag, const GoalRef& goal, const std::string& sample);
  /// The lasting goals that have not ended.
  std::vector<LastingGoal> lasting() const;
  bool empty() const { return open_.empty(); }
  /// The open tasks, at most one of them brief.
  const std::vector<Task>& open() const { return open_; }
  /// The orders for later in the robot's words; empty: none.
  std::string doing_later() const;
  /// It is told that an open task waits. False: it was told before.
  bool note_waiting(std::uint64_t tag);
  /// The open goals are done slowly, or no longer so. Empty: there is none.
  std::string set_pace(bool slow, const std::string& source, const std::string& listener);
  /// The utterance that an activity's message answers; 0, 0: none.
  UtteranceId spoken_for() const;

  /// The lasting goals with their later steps, the tasks that a stop has ended, and the orders for
  /// later. Other goals, and all of programs, end with the dialogue.
  void archive(Archive& a);

 private:
  void begin(Task task, Outputs& out);
  void drop(bool brief, const std::string& by, const std::string& text, Outputs& out);
  void release(Outputs& out);
  void drop_later(const std::string& why, const std::function<bool(const Later&)>& meant,
                  Outputs& out);
  Outputs deny(const Task& task, const Utterance& utterance) const;
  int priority_of(const Task& next) const;
  /// "after the way to library for saphira goal, "; empty: a task that begins need not wait.
  std::string after_others(const Task& next) const;

  std::vector<Task> open_;  ///< at most one brief goal and one task
  std::vector<Later> later_;
  std::optional<Front> front_{};
  std::vector<Task> stopped_;  ///< the steps of the task that the newest stop has ended
  std::uint64_t tag_ = 0;
  /// A goal that stands between brief steps, so that the interrupted task does not go on there; 0:
  /// none.
  std::uint64_t hold_ = 0;
};

}  // namespace saphira::agent_interface
