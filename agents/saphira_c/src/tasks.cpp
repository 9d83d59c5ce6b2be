// Micro-tasks (manual 6.5) and intentions (8).

#include <algorithm>
#include <cctype>

#include "os.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/cycle.hpp"

namespace saphira::c {
namespace {

constexpr float kGoalReached = 0.9F;      // of a behavior in an intention
constexpr std::size_t kMostTasks = 4096;  // with removed ones, whose pointers may be kept

bool ended(int state) {
  return state == sfSUCCESS || state == sfFAILURE || state == sfTIMEOUT;
}

/// The place of a behavior among the intentions.
void nothing() {}

/// The processes of the manual's 6.2, in its order. The work of the first seven is done before all
/// others of a cycle (the packet, the state reflector, the registration of all geometry) and after
/// them (the motor command, the drawing); one core does that of the four of interpretation.
constexpr struct {
  const char* name;
  void (*fn)();
} kOfLibrary[] = {{"pulse_proc", pulse_proc},
                  {"motor_proc", motor_proc},
                  {"clamp_proc", clamp_proc},
                  {"sonar_proc", sonar_proc},
                  {"wake_proc", wake_proc},
                  {"draw_proc", draw_proc},
                  {"process_waiting_packets", process_waiting_packets},
                  {"execute_current_behaviors", execute_current_behaviors},
                  {"occgrid_proc", occgrid_proc},
                  {"side_segment_proc", side_segment_proc},
                  {"test_wall_proc", test_wall_proc},
                  {"test_wall_break_proc", test_wall_break_proc},
                  {"test_match_proc", test_match_proc},
                  {"test_environment_proc", test_environment_proc}};

bool is_of_library(void (*fn)()) {
  return std::any_of(std::begin(kOfLibrary), std::end(kOfLibrary),
                     [fn](const auto& each) { return each.fn == fn; });
}

void start(int first, int last) {
  for (int i = first; i <= last; ++i)
    Os::get().add(kOfLibrary[i].name, kOfLibrary[i].fn, false);
}

/// "test matching" is test_match_proc: the manual has several spellings.
std::string plain(const std::string& name) {
  std::string text = bare(name);
  if (text.ends_with("proc"))
    text.resize(text.size() - 4);
  if (text.ends_with("ing"))
    text.resize(text.size() - 3);
  return text;
}

}  // namespace

std::string bare(std::string_view name) {
  std::string text;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

Task* Os::add(const char* name, void (*fn)(), bool intention) {
  const std::lock_guard lock(mutex);
  if (Task* const there = find(fn))
    return there;
  if (tasks_.size() >= kMostTasks)
    std::erase_if(tasks_, [](const auto& task) { return task->removed; });
  auto task = std::make_unique<Task>();
  task->name = name;
  task->of_library = fn == nothing || is_of_library(fn);
  task->intention = intention;
  task->shown.name = task->name.c_str();
  task->shown.fn = fn;
  task->shown.state = sfINIT;
  if (intention && on_task_thread() && current != nullptr && current->intention)
    task->shown.dad = &current->shown;
  tasks_.push_back(std::move(task));
  return tasks_.back().get();
}

Task* Os::find(const std::string& name) {
  const std::lock_guard lock(mutex);
  for (const auto exactly : {true, false})
    for (const auto& task : tasks_)
      if (!task->removed && (exactly ? task->name == name : plain(task->name) == plain(name)))
        return task.get();
  return nullptr;
}

Task* Os::find(void (*of_library)()) {
  const std::lock_guard lock(mutex);
  for (const auto& task : tasks_)
    if (!task->removed && task->shown.fn == of_library && is_of_library(of_library))
      return task.get();
  return nullptr;
}

Task* Os::of(const process* shown) {
  const std::lock_guard lock(mutex);
  for (const auto& task : tasks_)
    if (&task->shown == shown)
      return task.get();
  return nullptr;
}

void Os::run_tasks() {
  // Tasks that are added meanwhile have their first turn in the next cycle, except those from a
  // callback of the connection: they are there already.
  std::vector<Task*> turn;
  {
    const std::lock_guard lock(mutex);
    for (const auto& task : tasks_)
      if (!task->removed)
        turn.push_back(task.get());
  }
  for (Task* const task : turn) {
    if (ending_)
      return;
    if (!task->removed)
      run_task(*task);
  }
  tend_intentions();
}

void Os::run_task(Task& task) {
  int& its_state = task.shown.state;
  {
    const std::lock_guard lock(mutex);
    if (task.intention && !ended(its_state) && its_state != sfREMOVE && task.shown.timeout > 0 &&
        ++task.age > static_cast<std::uint64_t>(task.shown.timeout))
      its_state = sfTIMEOUT;
    if (its_state == sfSUSPEND || its_state == sfREMOVE || (task.intention && ended(its_state)))
      return;
    if (its_state < 0) {
      if (++its_state == 0)
        its_state = sfRESUME;
      return;
    }
    if (!task.of_library)
      watched_ = {task.name, BootClock::seconds(), false};
  }
  const double begun = BootClock::seconds();
  current = &task;
  task.overruled = false;
  process_state = its_state;
  task.shown.fn();
  // A task of the library works in any its_state, and cleans up on request.
  if (task.of_library && process_state == sfINTERRUPT)
    process_state = sfSUSPEND;
  else if (task.of_library && (process_state == sfINIT || process_state == sfRESUME))
    process_state = 10;
  const std::lock_guard lock(mutex);
  current = nullptr;
  // sfREMOVE, which a program writes into the structure, stays, and so does another thread's word.
  if (its_state != sfREMOVE && !task.overruled)
    its_state = process_state;
  if (!task.of_library)
    mind_time(task, BootClock::seconds() - begun);
  watched_ = {};
}

void Os::mind_time(const Task& task, double seconds) {
  if (seconds > kCycle && slow_.insert(task.name).second)
    say("micro-task \"" + task.name + "\" took " + std::to_string(std::lround(seconds * 1000.0)) +
            " ms: all micro-tasks together have 100 ms in each cycle",
        true);
}

/// Manual 8.4: removes intentions, with their behaviors.
void Os::tend_intentions() {
  const std::lock_guard lock(mutex);
  for (const auto& task : tasks_) {
    Closure* const closure = task->shown.beh == nullptr ? nullptr : of(task->shown.beh);
    if (task->removed || closure == nullptr)
      continue;
    if (!ended(task->shown.state) && task->shown.state != sfREMOVE) {
      closure->shown.running =
          task->shown.state == sfSUSPEND || task->shown.state == sfINTERRUPT ? FALSE : TRUE;
      if (closure->shown.goal >= kGoalReached)
        task->shown.state = sfSUCCESS;
    }
    if (ended(task->shown.state) || task->shown.state == sfREMOVE)
      closure->removed = true;
  }
  bool more = true;
  while (more) {
    more = false;
    for (const auto& task : tasks_) {
      if (!task->intention || task->removed)
        continue;
      const Task* const dad = task->shown.dad == nullptr ? nullptr : of(task->shown.dad);
      const bool alone = dad == nullptr || dad->removed || ended(dad->shown.state);
      if (task->shown.state != sfREMOVE && !(dad != nullptr && dad->removed) &&
          !(ended(task->shown.state) && alone))
        continue;
      task->removed = true;
      more = true;
      if (Closure* const closure = task->shown.beh == nullptr ? nullptr : of(task->shown.beh))
        closure->removed = true;
    }
  }
}

/// Shows this program's micro-tasks and behaviors to other programs, which may stop and resume
/// them.
void Os::share(Robot& robot, std::uint64_t robot_cycle) {
  std::vector<SharedTask> shown;
  for (const auto& task : tasks_)
    if (!task->removed)
      shown.push_back({task->name,
                       task->intention    ? "an intention of this program"
                       : task->of_library ? "a micro-task of the library"
                                          : "a micro-task of this program",
                       task->shown.state});
  for (const auto& closure : closures)
    if (!closure->removed)
      shown.push_back({"behavior " + closure->name, "a behavior of this program",
                       closure->shown.running != FALSE ? 10 : sfSUSPEND});
  for (const TaskRequest& asked : robot.share(std::move(shown), mind(robot_cycle))) {
    const bool resume = asked.action == ProcessAction::resume;
    for (const auto& task : tasks_)
      if (!task->removed && task->name == asked.name)
        task->shown.state = resume                                     ? sfRESUME
                            : asked.action == ProcessAction::interrupt ? sfINTERRUPT
                                                                       : sfSUSPEND;
    for (const auto& closure : closures)
      if (!closure->removed && "behavior " + closure->name == asked.name)
        closure->shown.running = resume ? TRUE : FALSE;
  }
}

/// Nothing: it has neither behaviors nor intentions.
std::optional<SharedMind> Os::mind(std::uint64_t robot_cycle) const {
  SharedMind mind{robot_cycle, behaviors_said_, {}};
  const auto id_of = [this](const process* shown) {
    const auto found =
        std::ranges::find_if(tasks_, [&](const auto& task) { return &task->shown == shown; });
    return found == tasks_.end() ? 0U : static_cast<std::uint32_t>(found - tasks_.begin()) + 1U;
  };
  for (const auto& task : tasks_)
    if (task->intention && !task->removed)
      mind.intentions.push_back({id_of(&task->shown), id_of(task->shown.dad), task->name,
                                 task->shown.beh == nullptr ? "" : task->shown.beh->name,
                                 task->shown.state});
  if (mind.behaviors.behaviors.empty() && mind.intentions.empty())
    return std::nullopt;
  return mind;
}

bool Os::suspended(void (*of_library)()) {
  const Task* const task = find(of_library);
  return task != nullptr && (task->shown.state == sfSUSPEND || task->shown.state == sfINTERRUPT ||
                             task->shown.state < 0);
}

void Os::find_environment() {
  const std::lock_guard lock(mutex);
  current_environment = nullptr;
  for (const auto& artifact : map_points_)
    if (environment_ != 0 && artifact->id == static_cast<int>(environment_))
      current_environment = reinterpret_cast<point*>(artifact.get());
}

}  // namespace saphira::c

using saphira::c::Os;
using saphira::c::Task;

namespace {

/// The task of a program's pointer; for a wrong one, reports the function and the pointer.
Task* task_of(const char* function, process* p) {
  Task* const task = Os::get().of(p);
  if (task == nullptr || task->removed) {
    Os::get().say(std::string(function) + (p == nullptr ? ": the process is NULL (was it found?)"
                                                        : ": there is no such process (any more)"),
                  true);
    return nullptr;
  }
  return task;
}

void set_state(const char* function, process* p, int state) {
  const std::lock_guard lock(Os::get().mutex);
  Task* const task = task_of(function, p);
  if (task == nullptr)
    return;
  task->shown.state = state;
  if (Os::get().current != task)
    return;
  if (Os::get().on_task_thread())
    process_state = state;
  else
    task->overruled = true;
}

void set_own_state(const char* function, int state) {
  Task* const self = Os::get().on_task_thread() ? Os::get().current : nullptr;
  if (self == nullptr)
    return Os::get().say(std::string(function) + " is for micro-tasks: there is none here", true);
  set_state(function, &self->shown, state);
}

process* add_process(const char* function, void (*fn)(), const char* name, bool intention) {
  if (fn == nullptr || name == nullptr) {
    Os::get().say(
        std::string(function) + (fn == nullptr ? ": the function" : ": the name") + " is NULL",
        true);
    return nullptr;
  }
  return &Os::get().add(name, fn, intention)->shown;
}

}  // namespace

extern "C" {

int process_state = sfINIT;

process* sfInitProcess(void (*fn)(void), const char* name) {
  return add_process("sfInitProcess", fn, name, false);
}
process* sfFindProcess(const char* name) {
  Task* const task = name == nullptr ? nullptr : Os::get().find(name);
  return task == nullptr ? nullptr : &task->shown;
}
void sfSetProcessState(process* p, int state) {
  set_state("sfSetProcessState", p, state);
}
void sfSuspendProcess(process* p, int n) {
  set_state("sfSuspendProcess", p, n > 0 ? -n : sfSUSPEND);
}
void sfSuspendSelf(int n) {
  set_own_state("sfSuspendSelf", n > 0 ? -n : sfSUSPEND);
}
void sfInterruptProcess(process* p) {
  set_state("sfInterruptProcess", p, sfINTERRUPT);
}
void sfInterruptSelf(void) {
  set_own_state("sfInterruptSelf", sfINTERRUPT);
}
void sfResumeProcess(process* p) {
  set_state("sfResumeProcess", p, sfRESUME);
}
process* sf_self(void) {
  Task* const self = Os::get().on_task_thread() ? Os::get().current : nullptr;
  return self == nullptr ? nullptr : &self->shown;
}

void pulse_proc(void) {}
void motor_proc(void) {}
void clamp_proc(void) {}
void sonar_proc(void) {}
void wake_proc(void) {}
void draw_proc(void) {}
void process_waiting_packets(void) {}
void execute_current_behaviors(void) {
  Os::get().evaluate_behaviors();
}
void occgrid_proc(void) {
  Os::get().interpret();
}
void side_segment_proc(void) {}
void test_wall_proc(void) {}
void test_wall_break_proc(void) {}
void test_match_proc(void) {
  Os::get().match();
}
void test_environment_proc(void) {
  Os::get().find_environment();
}

void sfInitBasicProcs(void) {
  saphira::c::start(0, 6);
}
void sfInitControlProcs(void) {
  saphira::c::start(7, 7);
}
void sfInitInterpretationProcs(void) {
  saphira::c::start(8, 11);
}
void sfInitRegistrationProcs(void) {
  saphira::c::start(12, 13);
}
void sfInitSpecialProcs(void) {
  sfInitBasicProcs();
}
void sfInitAwareProcs(void) {
  saphira::c::start(13, 13);
}

process* sfInitIntention(void (*fn)(void), const char* name, int timeout, ...) {
  std::vector<beh_param> params;
  std::vector<int> kinds;
  va_list list;
  va_start(list, timeout);
  const bool good = saphira::c::read_arguments("sfInitIntention", params, kinds, list);
  va_end(list);
  const std::lock_guard lock(Os::get().mutex);
  process* const shown = good ? add_process("sfInitIntention", fn, name, true) : nullptr;
  if (shown == nullptr)
    return nullptr;
  Task* const task = Os::get().of(shown);
  task->params = std::move(params);
  task->shown.params = task->params.data();
  task->shown.timeout = timeout;
  return shown;
}

int finished(process* p) {
  const std::lock_guard lock(Os::get().mutex);
  const Task* const task = p == nullptr ? nullptr : Os::get().of(p);
  if (task == nullptr || task->removed)
    return 1;
  const int state = task->shown.state;
  return state == sfSUCCESS || state == sfFAILURE || state == sfTIMEOUT ? 1 : 0;
}

process* intend_beh(behavior* b, const char* name, int timeout, beh_params params, int priority) {
  const std::lock_guard lock(Os::get().mutex);
  if (b == nullptr || name == nullptr || (params == nullptr && b->n_params > 0)) {
    Os::get().say(b == nullptr      ? "intend_beh: the behavior is NULL"
                  : name == nullptr ? "intend_beh: the name is NULL"
                                    : "intend_beh: the parameters are NULL: make them by beh_alloc",
                  true);
    std::free(params);
    return nullptr;
  }
  std::vector<beh_param> copy(params, params + (params == nullptr ? 0 : b->n_params));
  std::free(params);
  saphira::c::Closure* const closure =
      Os::get().add_closure(b, priority, true, std::move(copy), true);
  Task* const task = Os::get().add(name, saphira::c::nothing, true);
  task->shown.timeout = timeout;
  task->shown.beh = &closure->shown;
  task->shown.params = closure->shown.params;
  return &task->shown;
}

beh_params beh_alloc(int n) {
  if (n < 0 || n > 1000) {
    Os::get().say("beh_alloc: expected 0 to 1000 parameters", true);
    return nullptr;
  }
  return static_cast<beh_params>(std::calloc(static_cast<std::size_t>(n) + 1, sizeof(beh_param)));
}

}  // extern "C"
