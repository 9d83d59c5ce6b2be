#include "saphira/runtime/ports.hpp"

#include "requests/shell/convert.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/bus/notes.hpp"

namespace saphira::runtime {
namespace {

constexpr int kAcknowledged = 5000;  // [ms] in lockstep, for a program that hangs

}  // namespace

const char* word(Port::Use use) {
  return word_of(use, {"cycle N", "cycle N-1", "newest", "every sample", "each cycle", "changes",
                       "each cycle, kept for a minute"});
}

Ports::Ports(bus::Node& node, bus::Cycle& cycle) : node_(node), cycle_(cycle) {
  declare(bus::topics::kRobotState.name, Port::Use::kState);
  declare(bus::topics::kRobotDescription.name, Port::Use::kState);
}

void Asker::ask(Request request, std::uint64_t number) {
  request.source = node_->options().name;
  request.asker = node_->instance();
  request.number = number;
  request.stamp = cycle_->stamp();
  const bool taken = writer_.write(to_bus(request)) &&
                     (!node_->options().lockstep || writer_.wait_acknowledged(kAcknowledged));
  if (!taken)
    node_->warn("not everybody has got this request: " + describe(request));
}

Desk& Ports::requests(const bus::RequestTopic& topic, std::vector<Functor> functors) {
  declare(topic.name, Port::Use::kEvents);
  declare(topic.answers.name, Port::Use::kChanges);
  desks_.push_back(std::make_unique<Desk>(node_, topic, std::move(functors)));
  return *desks_.back();
}

void Ports::say(const std::vector<Note>& notes) {
  for (const Note& note : notes)
    bus::log(node_, note);
}

void Ports::degrade(const std::string& reason) {
  node_.status().state = v1::SERVICE_DEGRADED;
  node_.status().reason = reason;
}

}  // namespace saphira::runtime
