#include "saphira/base/process.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "saphira/base/text.hpp"

namespace saphira {

Process::Process(std::string name, std::string effect, Function function)
    : name_(std::move(name)), effect_(std::move(effect)), function_(std::move(function)) {}

void Process::set_state(int state) {
  if (state > kInterrupt && state < kFirstOwnState)
    throw std::invalid_argument("process " + name_ + ": state " + std::to_string(state) +
                                " is reserved; its own are 10 and more");
  if (state != now_.state && !(state < 0 && now_.state < 0))
    now_.since = now_.cycle;
  now_.state = state;
}

void Process::suspend(std::uint32_t cycles) {
  constexpr std::uint32_t most = std::numeric_limits<int>::max();
  set_state(cycles == 0 ? static_cast<int>(kSuspend) : -static_cast<int>(std::min(cycles, most)));
}

void Process::step(std::uint64_t cycle) {
  now_.cycle = cycle;
  now_.turn = Turn::none;
  now_.resumed = false;
  if (now_.state == kSuspend)
    return;
  if (now_.state < 0) {
    // -n: sleeps through the next n cycles, including this one.
    if (now_.state == -1)
      set_state(kResume);
    else
      ++now_.state;
    return;
  }
  now_.turn = now_.state == kInterrupt ? Turn::interrupted : Turn::work;
  now_.resumed = now_.state == kResume;
  if (function_)
    function_(*this);
  else if (now_.state == kInit || now_.state == kResume)
    set_state(kFirstOwnState);
  // Manual 6.5.1: an interrupted process saves its state and then waits for a resume.
  if (now_.turn == Turn::interrupted && now_.state == kInterrupt)
    set_state(kSuspend);
}

Process& ProcessTable::add(std::string name, std::string effect, Process::Function function) {
  if (find(name) != nullptr)
    throw std::invalid_argument("there is a process " + name + " already");
  processes_.push_back(
      std::make_unique<Process>(std::move(name), std::move(effect), std::move(function)));
  return *processes_.back();
}

Process* ProcessTable::find(std::string_view name) {
  return const_cast<Process*>(std::as_const(*this).find(name));
}

const Process* ProcessTable::find(std::string_view name) const {
  const auto found = std::find_if(processes_.begin(), processes_.end(),
                                  [&](const auto& process) { return process->name() == name; });
  return found == processes_.end() ? nullptr : found->get();
}

void ProcessTable::step(std::uint64_t cycle) {
  // By number: a process may add another, which gets its first turn in this cycle.
  for (std::size_t i = 0; i < processes_.size(); ++i)
    processes_[i]->step(cycle);
}

std::string ProcessTable::request(std::string_view name, ProcessAction action,
                                  std::uint32_t cycles) {
  Process* const process = find(name);
  if (process == nullptr) {
    const std::string names =
        joined(processes_, ", ", [&](const auto& one) { return one->name(); });
    return "no process \"" + std::string(name) + "\"; there are " +
           (names.empty() ? "none" : names);
  }
  switch (action) {
    case ProcessAction::interrupt:
      // It has cleaned up already.
      if (process->state() == kSuspend)
        return "it is suspended already";
      process->interrupt();
      break;
    case ProcessAction::suspend:
      process->suspend(cycles);
      break;
    case ProcessAction::resume:
      if (!process->suspended() && process->state() != kInterrupt)
        return "it is not suspended";
      process->resume();
      break;
  }
  asked_ = true;
  return {};
}

bool ProcessTable::take_changed() {
  bool changed = std::exchange(asked_, false) || told_.size() != processes_.size();
  const bool all = changed;
  told_.resize(processes_.size(), kInit);
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    const int state = processes_[i]->now_.state;
    // Its own sleeping and waking does not change the state of a process.
    if (!all && (state < 0 || state == kResume))
      continue;
    const int shown = state < 0 ? -1 : state;
    changed = changed || shown != told_[i];
    told_[i] = shown;
  }
  return changed;
}

std::vector<const Process*> ProcessTable::processes() const {
  std::vector<const Process*> all;
  all.reserve(processes_.size());
  for (const auto& process : processes_)
    all.push_back(process.get());
  return all;
}

}  // namespace saphira
