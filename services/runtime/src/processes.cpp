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

/// Nothing for a number that no enumerator has.
std::optional<ProcessAction> action_of(v1::ProcessAction action) {
  switch (action) {
    case v1::PROCESS_INTERRUPT:
      return ProcessAction::interrupt;
    case v1::PROCESS_SUSPEND:
      return ProcessAction::suspend;
    case v1::PROCESS_RESUME:
      return ProcessAction::resume;
  }
  return std::nullopt;
}

const char* word(ProcessAction action) {
  switch (action) {
    case ProcessAction::interrupt:
      return "interrupted";
    case ProcessAction::suspend:
      return "suspended";
    case ProcessAction::resume:
      break;
  }
  return "resumed";
}

}  // namespace

ProcessesOnBus::ProcessesOnBus(bus::Node& node, ProcessTable& table, Others others)
    : node_(node),
      table_(table),
      others_(std::move(others)),
      requests_(node.reader(bus::topics::kProcessRequest)),
      answers_(node.writer(bus::topics::kProcessAnswer)),
      states_(node.writer(bus::topics::kProcesses)) {
  publish();
}

ProcessesOnBus::~ProcessesOnBus() {
  v1::Processes sample;
  sample.instance(node_.instance());
  states_.dispose(sample);
}

void ProcessesOnBus::step(const v1::Stamp& stamp) {
  stamp_ = stamp;
  take_requests();
  table_.step(stamp.cycle());
  publish();
}

void ProcessesOnBus::idle() {
  take_requests();
  publish();
}

void ProcessesOnBus::take_requests() {
  for (const auto& sample : requests_.take()) {
    const v1::ProcessRequest& request = sample.data;
    if (sample.info.disposed || request.service() != node_.options().name)
      continue;
    v1::ProcessAnswer answer;
    answer.stamp(stamp_);
    answer.request(request.request());
    const std::optional<ProcessAction> action = action_of(request.action());
    if (!action) {
      answer.reason("nobody knows what action " +
                    std::to_string(static_cast<int>(request.action())) + " is");
    } else {
      std::optional<std::string> wrong;
      if (others_ && table_.find(request.process()) == nullptr)
        wrong = others_(request.process(), *action, request.cycles());
      answer.reason(wrong ? *wrong : table_.request(request.process(), *action, request.cycles()));
      if (answer.reason().empty())
        node_.info("process " + request.process() + " " + word(*action) + " by " +
                   request.source().substr(0, 255));
    }
    answer.done(answer.reason().empty());
    answers_.write(answer);
  }
}

void ProcessesOnBus::publish() {
  if (!table_.take_changed())
    return;
  v1::Processes sample;
  sample.instance(node_.instance());
  sample.service(node_.options().name);
  sample.stamp(stamp_);
  for (const Process* process : table_.processes()) {
    v1::Process one;
    one.name(process->name());
    one.state(state_of(*process));
    one.number(process->state() >= kFirstOwnState ? process->state() : 0);
    one.since(process->since());
    one.effect(process->effect());
    sample.processes().push_back(std::move(one));
  }
  states_.write(sample);
}

}  // namespace saphira::runtime
