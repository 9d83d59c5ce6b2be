// The robot's devices: requests, their results, and reports.

#include <stdexcept>

#include "saphira/bridge/core.hpp"

namespace saphira::bridge {

std::optional<Answer> Core::device(const Request& request) {
  if (!in_session())
    return Answer{AnswerCode::nobody, "no robot is connected"};
  try {
    const bool says = request.functor == "say";
    if (says && !settings_.vision)
      return Answer{AnswerCode::refused,
                    "the bridge was started without --vision: it knows of no vision system"};
    reflector_.request(request);
    if (request.person && request.person->role != "services" && request.person->role != "robot")
      put(v1::AuditEntry{.act = v1::AUDIT_ASKED, .who = request.source, .text = describe(request)});
    if (says)
      put(VisionSet{text_of(request.arguments, "text")});
    return std::nullopt;
  } catch (const std::invalid_argument& error) {
    return Answer{AnswerCode::bad_argument, error.what()};
  }
}

/// A packet of another type than the information packet.
void Core::reflect(const protocol::ServerPacket& packet, std::uint8_t type) {
  if (std::holds_alternative<protocol::AuxPacket>(packet) ||
      (settings_.vision && std::holds_alternative<protocol::VisionPacket>(packet)))
    return;
  const auto* const robot = std::get_if<protocol::ConfigPacket>(&packet);
  if (robot != nullptr && !reflector_.devices().reports().configuration) {
    info("the robot's serial number is " + robot->serial +
         (robot->firmware.empty() ? "" : ", its firmware " + robot->firmware));
    if (robot->cycle != 0 && robot->cycle != 100)
      warn("the robot sends its packets every " + std::to_string(robot->cycle) +
           " ms; a cycle here is 100 ms: set its SInfoCycle to 100");
  }
  reflector_.devices().reflect(packet, type);
}

void Core::tell_devices() {
  reflector::Devices& devices = reflector_.devices();
  for (reflector::DeviceRequest& request : devices.take_answered())
    put(LaterAnswer{request.asker, request.number, std::move(request.answer), request.device});
  const protocol::Information& in = reflector_.state().information;
  const auto before = std::exchange(
      shown_, {in.front_bumpers, in.rear_bumpers, in.motors_on, in.emergency_stop, in.faults,
               in.charge_state, in.state_of_charge, in.compass, in.gripper_bits, in.temperature});
  if (!devices.take_changed() && shown_ == before)
    return;
  put(DevicesChanged{devices.requests(), devices.reports(), in, session_.stamp});
  for (const std::string& trouble : devices.take_troubles())
    warn(trouble);
}

}  // namespace saphira::bridge
