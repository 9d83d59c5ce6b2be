#include "saphira/runtime/ports.hpp"

#include "saphira/bus/notes.hpp"

namespace saphira::runtime {
const char* word(Port::Use use) {
  switch (use) {
    case Port::Use::kState:
      return "cycle N";
    case Port::Use::kCycle:
      return "cycle N-1";
    case Port::Use::kNewest:
      return "newest";
    case Port::Use::kEvents:
      return "every sample";
    case Port::Use::kEach:
      return "each cycle";
    case Port::Use::kChanges:
      return "changes";
    case Port::Use::kRecall:
      break;
  }
  return "each cycle, kept for a minute";
}

Ports::Ports(bus::Node& node, bus::Cycle& cycle) : node_(node), cycle_(cycle) {
  declare(bus::topics::kRobotState.name, Port::Use::kState);
  declare(bus::topics::kRobotDescription.name, Port::Use::kState);
}

void Ports::say(const std::vector<Note>& notes) {
  for (const Note& note : notes)
    bus::log(node_, note);
}

void Ports::degrade(const std::string& reason) {
  node_.status().state(v1::SERVICE_DEGRADED);
  node_.status().reason(reason);
}

}  // namespace saphira::runtime
