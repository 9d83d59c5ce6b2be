#include <algorithm>
#include <cmath>
#include <list>
#include <utility>

#include "language/program.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/intentions/beliefs.hpp"
#include "saphira/intentions/forest.hpp"

namespace saphira::intentions {
namespace {

constexpr std::size_t kMostThreads = 64;  ///< of one intention

const char* word(IntentionState state) {
  return word_of(state, {"init", "running", "suspended", "suspended", "running", "success",
                         "failure", "timeout", "removed"});
}

/// An intention: an instance of a compiled schema. It has one current node, its main thread, and
/// more threads while goals run in parallel. In a cycle each thread begins one goal-set at most.
class Machine : public Activity {
 public:
  Machine(std::shared_ptr<const Program> program, const Bindings& bindings)
      : program_(std::move(program)), locals_(program_->locals.size()) {
    std::copy(program_->usual.begin(), program_->usual.end(), locals_.begin());
    for (const auto& [name, value] : bindings) {
      for (std::size_t i = 0; i < program_->parameters; ++i) {
        if (normal(program_->locals[i]) == normal(name))
          locals_[i] = value;
      }
    }
    threads_.push_back({});
    threads_.back().id = ++last_thread_;
  }

  bool keeps_children() const override { return true; }

  void step(Self& self) override {
    if (self.state() == IntentionState::kInterrupted) {
      if (!suspended_at_)
        suspended_at_ = self.now();
      self.moved_on();
      return;
    }
    if (begun_at_ < 0)
      begun_at_ = self.now();
    if (suspended_at_) {
      const Ticks away = self.now() - *std::exchange(suspended_at_, std::nullopt);
      begun_at_ += away;
      for (Thread& thread : threads_) {
        thread.since += away;
        thread.held_since += away;
      }
    }
    for (Thread& thread : threads_)
      thread.spent = false;
    go_on(self);
  }

  void child_ended(Self& self) override { go_on(self); }

  void archive(Archive& a) override;

  const Value* variable(std::string_view name) const override {
    for (std::size_t i = 0; i < program_->locals.size(); ++i)
      if (normal(program_->locals[i]) == normal(std::string(name)))
        return &locals_[i];
    return nullptr;
  }

  bool waits_for(std::uint32_t child) const override {
    return std::any_of(threads_.begin(), threads_.end(), [&](const Thread& thread) {
      return thread.waiting && thread.child == child;
    });
  }

 private:
  struct Child {
    std::uint32_t id = 0;
    bool kept = false;  ///< named, so that its outcome can be queried
  };
  struct Thread {
    std::size_t id = 0;
    std::size_t parent = 0;  ///< the waiting thread; 0: none
    /// The thread of the enclosing AND, PRESERVE or MAINTAIN, also where that does not wait: an end
    /// or interruption of that goal applies to this thread. 0: none.
    std::size_t owner = 0;
    std::size_t at = 0;    ///< the step
    bool waiting = false;  ///< for the begun step
    bool spent = false;    ///< a goal-set has been begun in this cycle
    bool fresh = true;     ///< before a goal-set
    int holds = 0;         ///< number of enclosing MAINTAINs whose conditions do not hold
    Ticks held_since = 0;
    bool over = false;
    bool restores = false;  ///< it belongs to the :by of its owner's MAINTAIN
    Ticks since = 0;        ///< start of the wait
    Ticks limit = 0;        ///< of the wait; 0: none
    std::uint32_t child = 0;
    double threshold = 0.0;
    std::vector<Child> children;  ///< its own
    std::string failed;           ///< the reason, when it is over
    GoalCode code = v1::CODE_NONE;
    bool has_failed = false;
  };

  /// The queries of expressions about this intention, and the effects of its actions.
  class View : public Own, public Effects {
   public:
    View(const Machine& machine, Self& self) : machine_(machine), self_(self) {}
    Value state_of(const std::string& name) const override {
      const std::uint32_t id = self_.child_named(name);
      return id == 0 ? Value() : Value(word(self_.child_state(id)));
    }
    double level_of(const std::string& name) const override {
      const std::uint32_t id = self_.child_named(name);
      return id == 0 ? 0.0 : self_.child_level(id);
    }
    const std::string& outcome() const override { return machine_.outcome_; }
    const std::string& reason() const override { return machine_.reason_; }
    double elapsed() const override { return in_seconds(self_.now() - machine_.begun_at_); }
    const World& world() const override { return self_.world(); }
    void say(std::string text) override { self_.tell(std::move(text)); }
    void request(Request request) override { self_.request(std::move(request)); }
    std::uint64_t ask(Request request) override { return self_.ask(std::move(request)); }
    void believe(const std::string& name, Value value) override {
      self_.believe(name, std::move(value));
    }
    void believe_while(const std::string& name, Value value) override {
      self_.believe_while(name, std::move(value));
    }

   private:
    const Machine& machine_;
    Self& self_;
  };

  Value value(const Expression& expression, Self& self) {
    View view(*this, self);
    Scope scope{self.world(), locals_, view, view};
    return evaluate(expression, scope);
  }

  // --- a cycle

  void go_on(Self& self) {
    // A thread that ends may release an earlier one, so repeat until no thread moves. A thread
    // begins one goal-set in a cycle at most, so this comes to an end.
    bool any = false;
    for (bool moved = true; moved && !over_;) {
      moved = false;
      for (auto thread = threads_.begin(); thread != threads_.end() && !over_; ++thread)
        moved = run(*thread, self) || moved;
      for (auto thread = threads_.begin(); thread != threads_.end();) {
        const bool gone = thread->over && thread->parent == 0;
        if (gone)
          bequeath(*thread);
        thread = gone ? threads_.erase(thread) : std::next(thread);
      }
      any = any || moved;
    }
    if (any)
      self.moved_on();
    if (over_)
      return;
    show(self);
    const Thread& main = threads_.front();
    const double level = program_->level   ? degree(*program_->level, self)
                         : main.child != 0 ? self.child_level(main.child)
                                           : 0.0;
    self.level(level);
    self.progress(program_->progress ? degree(*program_->progress, self) : level);
  }

  /// The degree of a condition [0..1]; 0 where its measure is missing.
  double degree(const Expression& expression, Self& self) {
    try {
      const Value is = value(expression, self);
      return is.number() != nullptr ? *is.number() : is.truthy() ? 1.0 : 0.0;
    } catch (const ActivityError&) {
      return 0.0;
    }
  }

  void show(Self& self) {
    const Thread& main = threads_.front();
    if (shown_at_ == main.at && shown_waiting_ == main.waiting)
      return;
    shown_at_ = main.at;
    shown_waiting_ = main.waiting;
    const Step& step = program_->steps[main.at];
    const std::size_t next = main.fresh ? step.set : step.set + 1;
    static const std::string end_label = "END";
    self.label(next < program_->sets.size() ? program_->sets[next].label : end_label);
    if (!main.waiting)
      self.say(program_->sets[step.set].text);
    else if (step.op == Step::Op::kWait)
      self.say(step.text == "nil"   ? "waits"
               : step.words.empty() ? "waits for " + step.text
                                    : "waits until " + step.words);
    else if (!step.words.empty())
      self.say("while " + step.words);
    else
      self.say(step.text);
  }

  /// Runs a thread until it has to wait; true where it moved.
  bool run(Thread& thread, Self& self) {
    bool moved = false;
    while (!thread.over && thread.holds == 0 && !over_) {
      if (thread.waiting) {
        if (!poll(thread, self))
          return moved;
        moved = true;
        continue;
      }
      if (thread.fresh) {
        if (thread.spent)
          return moved;
        thread.spent = true;
        thread.fresh = false;
      }
      moved = true;
      try {
        perform(thread, self);
      } catch (const ActivityError& error) {
        failure(thread, error, self);
      }
    }
    return moved;
  }

  void perform(Thread& thread, Self& self) {
    const Step& step = program_->steps[thread.at];
    switch (step.op) {
      case Step::Op::kTest:
        if (value(step.expression, self).nil()) {
          failure(thread, v1::CODE_ACTIVITY,
                  step.reason ? spoken(value(*step.reason, self)) : step.text + " does not hold",
                  self);
          return;
        }
        break;
      case Step::Op::kExecute:
        value(step.expression, self);
        break;
      case Step::Op::kAssign:
        locals_[step.slot] = value(step.expression, self);
        break;
      case Step::Op::kWait:
        thread.limit = limit(step.timeout, self);
        await(thread, self);
        return;
      case Step::Op::kIntend:
        intend(thread, *step.intend, self);
        return;
      case Step::Op::kUnintend: {
        const Value name = value(step.expression, self);
        if (name.text() == nullptr)
          throw ActivityError("UNINTEND expected a name, got " + kind_of(name));
        self.unintend(*name.text());
        break;
      }
      case Step::Op::kJump:
        thread.at = step.target;
        return;
      case Step::Op::kJumpUnless:
        thread.at = value(step.expression, self).truthy() ? thread.at + 1 : step.target;
        return;
      case Step::Op::kFork:
      case Step::Op::kSplit:
        fork(thread, step, self);
        return;
      case Step::Op::kPreserve:
      case Step::Op::kMaintain:
        if (step.op == Step::Op::kPreserve && value(step.expression, self).nil()) {
          failure(thread, v1::CODE_ACTIVITY, step.text + " does not hold", self);
          return;
        }
        branch(thread, step.branches[0], self);
        await(thread, self);
        return;
      case Step::Op::kEndThread:
        thread.over = true;
        return;
      case Step::Op::kEndSet:
        if (step.set + 1 >= program_->sets.size()) {
          end_of_all(thread, self);
          return;
        }
        thread.at = program_->sets[step.set + 1].begin;
        thread.fresh = true;
        return;
      case Step::Op::kGoto:
        go_to(thread, program_->sets[step.target].begin, self);
        return;
      case Step::Op::kSucceed: {
        const std::string reason = step.reason ? spoken(value(*step.reason, self)) : "done";
        over_ = true;
        self.succeed(reason);
        return;
      }
      case Step::Op::kFail:
        failure(thread, v1::CODE_ACTIVITY,
                step.reason ? spoken(value(*step.reason, self)) : "failed", self);
        return;
    }
    ++thread.at;
  }

  /// A jump out of AND, PRESERVE or MAINTAIN: its threads end.
  void go_to(Thread& thread, std::size_t at, Self& self) {
    Thread* leaves = &thread;
    while (leaves->parent != 0)
      leaves = &*std::find_if(threads_.begin(), threads_.end(),
                              [&](const Thread& each) { return each.id == leaves->parent; });
    if (leaves != &thread)
      cut(*leaves, self);
    leaves->waiting = false;
    leaves->at = at;
    leaves->fresh = true;
  }

  static void await(Thread& thread, const Self& self) {
    thread.waiting = true;
    thread.since = self.now();
  }
  void go_behind(Thread& thread) {
    const Step& step = program_->steps[thread.at];
    thread.waiting = false;
    thread.child = 0;
    thread.at = step.target != kNowhere ? step.target : thread.at + 1;
  }

  Ticks limit(const std::optional<Expression>& timeout, Self& self) {
    if (!timeout)
      return 0;
    const Value seconds = value(*timeout, self);
    if (seconds.nil())
      return 0;
    if (seconds.number() == nullptr || !(*seconds.number() >= 0.0))
      throw ActivityError("a timeout expected a number of seconds, got " + kind_of(seconds));
    return std::max<Ticks>(1, std::llround(std::min(*seconds.number(), 1e9) / kTick));
  }

  bool too_late(const Thread& thread, const Self& self) const {
    return thread.limit > 0 && self.now() - thread.since >= thread.limit;
  }

  /// True where the thread's wait is over.
  bool poll(Thread& thread, Self& self) {
    const Step& step = program_->steps[thread.at];
    try {
      switch (step.op) {
        case Step::Op::kWait:
          if (value(step.expression, self).truthy()) {
            go_behind(thread);
            return true;
          }
          if (!too_late(thread, self))
            return false;
          failure(thread, v1::CODE_TIMEOUT,
                  "waited " + plain(in_seconds(thread.limit)) + " s for " + step.text, self);
          return true;
        case Step::Op::kIntend:
          return poll_child(thread, self);
        case Step::Op::kFork:
          return poll_fork(thread, self);
        case Step::Op::kPreserve:
          return poll_fork(thread, self) || poll_preserve(thread, step, self);
        case Step::Op::kMaintain:
          return poll_maintain(thread, step, self);
        default:
          return true;
      }
    } catch (const ActivityError& error) {
      failure(thread, error, self);
      return true;
    }
  }

  // --- intending

  void intend(Thread& thread, const Intend& intend, Self& self) {
    Start start;
    start.schema = intend.schema;
    start.name = intend.name;
    bool waits = intend.waits;
    thread.threshold = 2.0;  // never: until it is finished
    if (intend.threshold) {
      const Value degree = value(*intend.threshold, self);
      if (degree.nil())
        waits = false;
      else if (degree.number() != nullptr)
        thread.threshold = *degree.number();
    }
    for (const auto& [name, expression] : intend.arguments)
      start.arguments.emplace_back(name, value(expression, self));
    start.timeout = limit(intend.timeout, self);
    start.blocking = waits;
    start.until_satisfied = waits && thread.threshold > 1.0;
    if (intend.priority) {
      const Value priority = value(*intend.priority, self);
      if (priority.number() == nullptr)
        throw ActivityError("a priority expected a number, got " + kind_of(priority));
      start.priority = static_cast<int>(std::clamp(*priority.number(), -1000.0, 1000.0));
    }
    reap(intend.name, self);
    const std::uint32_t id = self.start(start);
    thread.children.push_back({id, !intend.name.empty()});
    if (waits) {
      thread.child = id;
      await(thread, self);
    } else {
      ++thread.at;
    }
  }

  /// Removes ended children that cannot be queried any more (manual 8.4 makes that the parent's
  /// task): those without a name, and one whose name is used anew.
  void reap(const std::string& name, Self& self) {
    const std::uint32_t older = name.empty() ? 0 : self.child_named(name);
    for (Thread& each : threads_) {
      std::erase_if(each.children, [&](const Child& child) {
        const IntentionState state = self.child_state(child.id);
        if (state == IntentionState::kRemoved)
          return true;
        if (!finished(state) || (child.kept && child.id != older) || child.id == each.child)
          return false;
        self.remove_child(child.id);
        return true;
      });
    }
  }

  bool poll_child(Thread& thread, Self& self) {
    const IntentionState state = self.child_state(thread.child);
    if (!finished(state) && state != IntentionState::kRemoved) {
      if (self.child_level(thread.child) < thread.threshold)
        return false;
      outcome_ = "running";
      reason_.clear();
      go_behind(thread);
      return true;
    }
    outcome_ = word(state);
    const Outcome* const outcome = self.child_outcome(thread.child);
    reason_ = outcome == nullptr ? "" : outcome->reason;
    if (state == IntentionState::kFailure || state == IntentionState::kTimeout) {
      const GoalCode code = state == IntentionState::kTimeout ? v1::CODE_TIMEOUT
                            : outcome == nullptr || outcome->code == v1::CODE_NONE
                                ? v1::CODE_ACTIVITY
                                : outcome->code;
      const std::string& schema = program_->steps[thread.at].intend->schema;
      // With its origin for the parent; without it for people.
      const std::string bare = reason_;
      failure(thread, code, schema + ": " + bare, self);
      reason_ = bare;
      return true;
    }
    go_behind(thread);
    return true;
  }

  // --- threads

  Thread& branch(Thread& parent, std::size_t at, Self& self) {
    if (threads_.size() >= kMostThreads)
      throw ActivityError("more than " + std::to_string(kMostThreads) + " goals in parallel");
    Thread thread;
    thread.id = ++last_thread_;
    thread.parent = parent.id;
    thread.owner = parent.id;
    thread.at = at;
    thread.fresh = false;
    thread.spent = true;  // its goals are part of the present goal-set
    thread.since = self.now();
    threads_.push_back(std::move(thread));
    return threads_.back();
  }

  void fork(Thread& thread, const Step& step, Self& self) {
    for (const std::size_t at : step.branches) {
      Thread& made = branch(thread, at, self);
      if (step.op == Step::Op::kSplit) {
        made.parent = 0;
        made.owner = thread.owner;
        made.restores = thread.restores;
      }
    }
    if (step.op == Step::Op::kSplit)
      thread.at = step.target;
    else
      await(thread, self);
  }

  bool poll_fork(Thread& thread, Self& self) {
    bool all = true;
    for (const Thread& each : threads_) {
      if (each.parent != thread.id)
        continue;
      if (each.over && each.has_failed) {
        const GoalCode code = each.code;
        const std::string reason = each.failed;
        failure(thread, code, reason, self);
        return true;
      }
      all = all && each.over;
    }
    if (!all)
      return false;
    join(thread);
    go_behind(thread);
    return true;
  }

  /// Intentions that the branches have begun and left continue as the parent's, at the parent's
  /// place.
  void join(Thread& thread) {
    for (Thread& each : threads_) {
      if (each.owner != thread.id)
        continue;
      each.owner = thread.owner;
      each.restores = thread.restores;
      if (each.parent != thread.id)
        continue;
      thread.children.insert(thread.children.end(), each.children.begin(), each.children.end());
      each.children.clear();
      each.parent = 0;
      each.over = true;
    }
  }

  /// Intentions of an ended thread continue as those of another thread, and end with it: a sibling
  /// that is waited for, or the main thread.
  void bequeath(Thread& dead) {
    if (dead.children.empty())
      return;
    const auto heir = std::find_if(threads_.begin(), threads_.end(), [&](const Thread& each) {
      return dead.owner == 0 || (each.parent == dead.owner && each.restores == dead.restores);
    });
    heir->children.insert(heir->children.end(), dead.children.begin(), dead.children.end());
    dead.children.clear();
  }

  /// Ends all threads within the goal of a thread, with their intentions.
  void cut(const Thread& thread, Self& self) {
    for (Thread& each : threads_) {
      if (each.owner == thread.id)
        end(each, self);
    }
  }
  void end(Thread& thread, Self& self) {
    cut(thread, self);
    for (const Child& child : thread.children)
      self.remove_child(child.id);
    thread.children.clear();
    thread.parent = 0;
    thread.owner = 0;
    thread.over = true;
  }

  /// Holds the threads within the MAINTAIN of a thread, except those that restore its condition, or
  /// releases them.
  void hold(const Thread& thread, bool held, Self& self, bool within = false) {
    for (Thread& each : threads_) {
      if (each.owner != thread.id || (each.restores && !within))
        continue;
      each.holds += held ? 1 : -1;
      if (each.holds == (held ? 1 : 0)) {
        if (held)
          each.held_since = self.now();
        else
          each.since += self.now() - each.held_since;
        for (const Child& child : each.children)
          self.hold_child(child.id, held);
      }
      hold(each, held, self, true);
    }
  }

  bool poll_preserve(Thread& thread, const Step& step, Self& self) {
    if (value(step.expression, self).truthy())
      return false;
    failure(thread, v1::CODE_ACTIVITY, step.text + " does not hold any more", self);
    return true;
  }

  bool poll_maintain(Thread& thread, const Step& step, Self& self) {
    Thread* restoring = nullptr;
    bool held = false;
    bool finished_body = true;
    for (Thread& each : threads_) {
      if (each.parent != thread.id)
        continue;
      if (each.restores) {
        restoring = &each;
      } else {
        held = held || each.holds > 0;
        finished_body = finished_body && each.over;
      }
    }
    const bool holds = value(step.expression, self).truthy();
    if (restoring != nullptr)
      return restoring->over && end_restoring(thread, *restoring, holds, self);
    if (finished_body || holds)
      return poll_fork(thread, self);
    if (held)
      return false;
    hold(thread, true, self);
    branch(thread, step.branches[1], self).restores = true;
    return true;
  }

  /// Releases the body of a MAINTAIN, or lets the MAINTAIN fail.
  bool end_restoring(Thread& thread, const Thread& restoring, bool holds, Self& self) {
    if (restoring.has_failed || !holds) {
      const GoalCode code = restoring.has_failed ? restoring.code : v1::CODE_ACTIVITY;
      const std::string why = restoring.has_failed ? ": " + restoring.failed : "";
      failure(thread, code, program_->steps[thread.at].text + " could not be restored" + why, self);
      return true;
    }
    // The intentions that restored the condition are not needed any more.
    for (Thread& each : threads_) {
      if (each.owner == thread.id && each.restores)
        end(each, self);
    }
    hold(thread, false, self);
    return true;
  }

  /// The thread has reached the end of the schema.
  void end_of_all(Thread& thread, Self& self) {
    if (thread.id != threads_.front().id) {
      thread.over = true;
      return;
    }
    over_ = true;
    self.succeed("done");
  }

  /// A mistake of the activity is named with its place.
  void failure(Thread& thread, const ActivityError& error, Self& self) {
    std::string reason = error.what();
    if (error.code() == v1::CODE_ACTIVITY)
      reason += " (" + program_->file.substr(program_->file.rfind('/') + 1) + ", line " +
                std::to_string(program_->steps[thread.at].line) + ")";
    failure(thread, error.code(), reason, self);
  }

  void failure(Thread& thread, GoalCode code, const std::string& reason, Self& self) {
    reason_ = reason;
    cut(thread, self);
    const Step& step = program_->steps[thread.at];
    // A failed intention must not continue beside its replacement.
    if (thread.child != 0 && !finished(self.child_state(thread.child)))
      self.remove_child(thread.child);
    thread.child = 0;
    thread.waiting = false;
    if (step.other != kNowhere) {
      thread.at = step.other;
      return;
    }
    if (thread.id == threads_.front().id) {
      over_ = true;
      self.fail(code, reason);
      return;
    }
    for (const Child& child : thread.children)
      self.remove_child(child.id);
    thread.children.clear();
    thread.over = true;
    thread.has_failed = true;
    thread.failed = reason;
    thread.code = code;
  }

  std::shared_ptr<const Program> program_;
  std::vector<Value> locals_;
  std::list<Thread> threads_;  ///< the main thread first
  std::size_t last_thread_ = 0;
  bool over_ = false;
  Ticks begun_at_ = -1;
  std::optional<Ticks> suspended_at_;
  std::string outcome_;  ///< of the newest awaited INTEND
  std::string reason_;
  std::size_t shown_at_ = kNowhere;
  bool shown_waiting_ = false;
};

// --- memory over a restart

/// A hash of a program's code: saved progress of another version is of no use.
std::string mark_of(const Program& program) {
  Fnv1a hash;
  const auto add = [&](const std::string& text) {
    hash.add(text);
    hash.add(std::uint8_t{0});
  };
  for (const std::string& local : program.locals)
    add(local);
  for (const Step& step : program.steps) {
    add(step.text);
    hash.add(static_cast<std::uint8_t>(step.op));
    hash.add(static_cast<std::uint8_t>(step.set));
  }
  return "v" + hash.text();
}

void Machine::archive(Archive& a) {
  std::string program = mark_of(*program_);
  a("program", program);
  if (program != mark_of(*program_))
    throw ActivityError("the schema " + program_->name + " is another than it was");
  a("locals", locals_)("threads", threads_)("last_thread", last_thread_)("begun_at", begun_at_);
  a("suspended_at", suspended_at_)("outcome", outcome_)("reason", reason_)("over", over_);
  a("shown_at", shown_at_)("shown_waiting", shown_waiting_);
  a.expect(locals_.size() == program_->locals.size() && !threads_.empty(),
           "the progress of " + program_->name);
  for (const Thread& thread : threads_)
    a.expect(thread.at < program_->steps.size(), "the progress of " + program_->name);
}

}  // namespace

std::unique_ptr<Activity> make_machine(std::shared_ptr<const Program> program,
                                       const Bindings& bindings) {
  return std::make_unique<Machine>(std::move(program), bindings);
}

}  // namespace saphira::intentions
