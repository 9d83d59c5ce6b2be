#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace saphira {

/// The reserved states of manual Table 6-3. A process's own states are 10 or more; -n means
/// "suspended for n cycles".
enum ReservedState : int { kInit = 0, kSuspend = 1, kResume = 2, kInterrupt = 3 };
inline constexpr int kFirstOwnState = 10;

/// A micro-task (manual 6.5): a little work in every cycle, with a state that others can change.
///
/// A process with a function is called in every cycle in which it is not suspended, and changes its
/// own state. It sees kInit until then, and kInterrupt once: then it has to clean up. The work of a
/// process without a function is done by its owner, when works() is true; such a process is in
/// state 10 from its first cycle on.
class Process {
 public:
  using Function = std::function<void(Process&)>;
  enum class Turn { none, work, interrupted };
  /// The changing part of a process.
  struct Progress {
    int state = kInit;
    std::uint64_t cycle = 0;
    std::uint64_t since = 0;
    Turn turn = Turn::none;
    bool resumed = false;

    friend bool operator==(const Progress&, const Progress&) = default;
  };

  Process(std::string name, std::string effect, Function function);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  const std::string& name() const { return name_; }
  /// A description, for people.
  const std::string& effect() const { return effect_; }
  int state() const { return now_.state; }
  /// Cycle of the newest change of state; sleeping does not count anew in each cycle.
  std::uint64_t since() const { return now_.since; }

  /// sfSetProcessState. std::invalid_argument for a state that is neither reserved nor its own.
  void set_state(int state);
  /// sfSuspendProcess, sfSuspendSelf: for so many cycles; 0: until it is resumed.
  void suspend(std::uint32_t cycles = 0);
  /// sfInterruptProcess, sfInterruptSelf.
  void interrupt() { set_state(kInterrupt); }
  /// sfResumeProcess.
  void resume() { set_state(kResume); }

  bool suspended() const { return now_.state == kSuspend || now_.state < 0; }
  /// True where this cycle was its turn to work.
  bool works() const { return now_.turn == Turn::work; }
  /// True where it has to clean up in this cycle.
  bool interrupted() const { return now_.turn == Turn::interrupted; }
  /// True in its first working cycle after a suspension.
  bool resumed() const { return now_.resumed; }

 private:
  friend class ProcessTable;
  void step(std::uint64_t cycle);

  std::string name_;
  std::string effect_;
  Function function_;
  Progress now_;
};

/// Requests from outside.
enum class ProcessAction { interrupt, suspend, resume };

/// The micro-tasks of a service, round robin: each gets its turn once a cycle, in the order of
/// addition. Each gives the processor back by itself, so there is nothing to lock.
///
/// Processes cannot be deleted: an unneeded one is suspended (manual 6.5.2).
class ProcessTable {
 public:
  /// sfInitProcess. std::invalid_argument where the name is taken.
  Process& add(std::string name, std::string effect, Process::Function function = {});
  /// sfFindProcess; nullptr where there is none.
  Process* find(std::string_view name);
  const Process* find(std::string_view name) const;

  /// One cycle.
  void step(std::uint64_t cycle);

  /// Carries out a request; empty, or the reason for a failure with the existing names.
  std::string request(std::string_view name, ProcessAction action, std::uint32_t cycles = 0);
  /// True when some state has changed since the last call. A process's own sleep for some cycles
  /// does not count.
  bool take_changed();

  std::vector<const Process*> processes() const;

  template <class Archive>
  void archive(Archive& a) {
    for (const auto& process : processes_)
      a(process->name(), process->now_);
    a("told", told_)("asked", asked_);
  }

 private:
  std::vector<std::unique_ptr<Process>> processes_;
  std::vector<int> told_;  ///< states, as of the last take_changed()
  bool asked_ = false;     ///< a request came since then
};

}  // namespace saphira
