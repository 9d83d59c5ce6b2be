#include "saphira/runtime/ports.hpp"

namespace saphira::runtime {
namespace {

v1::LogLevel to_bus(Note::Level level) {
  switch (level) {
    case Note::Level::info:
      return v1::LOG_INFO;
    case Note::Level::warning:
      return v1::LOG_WARNING;
    case Note::Level::error:
      break;
  }
  return v1::LOG_ERROR;
}

}  // namespace

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
    node_.log(to_bus(note.level), note.text);
}

void Ports::degrade(const std::string& reason) {
  node_.status().state(v1::SERVICE_DEGRADED);
  node_.status().reason(reason);
}

}  // namespace saphira::runtime
