#include "system/system.hpp"

// Each saphira_service() of CMake.
#define SAPHIRA_COMPONENT(service) \
  namespace saphira::service {     \
  runtime::Component component();  \
  }
#include "components.inc"
#undef SAPHIRA_COMPONENT

namespace saphira::system {
namespace {

using Use = runtime::Port::Use;

// The bridge is no cyclic service: it makes the cycles. A test compares this list with its
// endpoints.
const runtime::Unit kBridge{
    "bridge",
    "Exposes a robot server on the bus, and decides which program drives",
    {{"robot/state", Use::kEach},       {"robot/description", Use::kChanges},
     {"robot/answers", Use::kChanges},  {"robot/devices", Use::kChanges},
     {"robot/serial", Use::kChanges},   {"vision/channels", Use::kChanges},
     {"drive/grant", Use::kEach},       {"recall/robot", Use::kRecall},
     {"recall/grant", Use::kRecall},    {"robot/sonars", Use::kEach},
     {"drive/estop", Use::kEvents},     {"drive/estop/reset", Use::kEvents},
     {"drive/stop", Use::kEvents},      {"drive/teleop", Use::kEvents},
     {"drive/direct", Use::kEvents},    {"drive/behaviors", Use::kEvents},
     {"lockstep/permit", Use::kNewest}, {"device/servo", Use::kEvents},
     {"device/gripper", Use::kEvents},  {"device/output", Use::kEvents},
     {"device/analog", Use::kEvents},   {"device/timer", Use::kEvents},
     {"device/sonar", Use::kEvents},    {"device/sound", Use::kEvents},
     {"device/server", Use::kEvents},   {"device/serial", Use::kEvents},
     {"device/vision", Use::kEvents},   {"audit", Use::kEvents}}};

}  // namespace

std::vector<runtime::Component> services() {
  return {
#define SAPHIRA_COMPONENT(service) service::component(),
#include "components.inc"
#undef SAPHIRA_COMPONENT
  };
}

std::vector<runtime::Unit> units() {
  std::vector<runtime::Unit> units{kBridge};
  for (const runtime::Component& service : services())
    units.push_back({service.name, service.effect, runtime::ports_of(service)});
  return units;
}

std::string only_writer(const std::string& topic) {
  std::string writer;
  for (const runtime::Unit& unit : units())
    for (const runtime::Port& port : unit.ports)
      if (port.topic == topic && !port.is_input()) {
        if (!writer.empty() || port.use == runtime::Port::Use::kChanges)
          return {};
        writer = unit.name;
      }
  return writer;
}

}  // namespace saphira::system
