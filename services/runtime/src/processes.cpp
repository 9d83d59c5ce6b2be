#include "saphira/runtime/processes.hpp"

#include <utility>

namespace saphira::runtime {
namespace {

v1::ProcessState state_of(const Process& process) {
  if (process.state() < 0)
    return v1::PROCESS_SLEEPING;
  switch (process.state()) {
    case kInit:
      return v1::PROCESS_INIT;
    case kSuspend:
      return v1::PROCESS_SUSPENDED;
    case kResume:
      return v1::PROCESS_RESUMED;
    case kInterrupt:
      return v1::PROCESS_INTERRUPTED;
    default:
      return v1::PROCESS_RUNNING;
  }
}

std::vector<Functor> functors() {
  const Parameter process = text_parameter("process", "name of a process");
  return {{"interrupt", "the process cleans up and waits until it is resumed", {process}},
          {"suspend",
           "the process waits",
           {process, optional(whole_parameter("cycles", "for so many; 0: until it is resumed", 0.0,
                                              4294967295.0))}},
          {"resume", "the process goes on", {process}}};
}

/// The action of one of functors().
ProcessAction action_of(const std::string& functor) {
  return functor == "interrupt" ? ProcessAction::interrupt
         : functor == "suspend" ? ProcessAction::suspend
                                : ProcessAction::resume;
}

}  // namespace

ProcessesOnBus::ProcessesOnBus(bus::Node& node, ProcessTable& table, Others others)
    : node_(node),
      table_(table),
      others_(std::move(others)),
      desk_(node, bus::topics::kProcessRequest, functors()),
      states_(node.writer(bus::topics::kProcesses)) {
  publish();
}

ProcessesOnBus::~ProcessesOnBus() {
  states_.dispose({.instance = node_.instance()});
}

void ProcessesOnBus::step(const v1::Stamp& stamp) {
  stamp_ = stamp;
  take();
  table_.step(stamp.cycle);
  publish();
}

void ProcessesOnBus::idle() {
  take();
  publish();
}

void ProcessesOnBus::take() {
  for (const Request& request : desk_.take(stamp_))
    desk_.answer(request, act(request));
}

Answer ProcessesOnBus::act(const Request& request) {
  const std::string& process = text_of(request.arguments, "process");
  const ProcessAction action = action_of(request.functor);
  const auto cycles = static_cast<std::uint32_t>(number_of(request.arguments, "cycles"));
  std::optional<std::string> wrong;
  if (others_ && table_.find(process) == nullptr)
    wrong = others_(process, action, cycles);
  if (!wrong)
    wrong = table_.request(process, action, cycles);
  return {wrong->empty() ? AnswerCode::done : AnswerCode::refused, *wrong};
}

void ProcessesOnBus::publish() {
  if (!table_.take_changed())
    return;
  v1::ProcessSet sample{
      .instance = node_.instance(), .service = node_.options().name, .stamp = stamp_};
  for (const Process* process : table_.processes()) {
    sample.processes.push_back({.name = process->name(),
                                .state = state_of(*process),
                                .number = process->state() >= kFirstOwnState ? process->state() : 0,
                                .since = process->since(),
                                .effect = process->effect()});
  }
  states_.write(sample);
}

}  // namespace saphira::runtime
