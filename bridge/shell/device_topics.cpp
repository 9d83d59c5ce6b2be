#include "device_topics.hpp"

#include <stdexcept>
#include <string>
#include <variant>

#include "convert.hpp"
#include "saphira/base/enumerators.hpp"

namespace saphira::bridge {

DeviceTopics::DeviceTopics(bus::Node& node, reflector::Reflector& reflector)
    : node_(node), reflector_(reflector), desk_(node, bus::topics::kRobotAnswers) {
  // In the order of reflector::Device.
  const bus::RequestTopic* const topics[] = {
      &bus::topics::kServo,       &bus::topics::kGripper, &bus::topics::kDigitalOutput,
      &bus::topics::kAnalog,      &bus::topics::kTimer,   &bus::topics::kSonar,
      &bus::topics::kSound,       &bus::topics::kServer,  &bus::topics::kSerial,
      &bus::topics::kVisionSystem};
  for (const reflector::Device device : kEnumerators<reflector::Device>)
    desk_.serve(*topics[static_cast<std::size_t>(device)], reflector::functors(device),
                [this](const Request& request) { return act(request); });
}

std::optional<Answer> DeviceTopics::act(const Request& request) {
  if (!session_)
    return Answer{AnswerCode::nobody, "no robot is connected"};
  try {
    const reflector::Wish wish = reflector::wish_of(request);
    if (const auto* said = std::get_if<reflector::VisionWish>(&wish)) {
      if (camera_ == nullptr)
        return Answer{AnswerCode::refused,
                      "the bridge was started without --vision: it knows of no vision system"};
      camera_->keep(said->text);
    }
    reflector_.request(request, wish);
    return std::nullopt;  // its result comes by publish()
  } catch (const std::invalid_argument& error) {
    return Answer{AnswerCode::bad_argument, error.what()};
  }
}

void DeviceTopics::take(const v1::Stamp& stamp, bool session) {
  session_ = session;
  desk_.take(stamp);
  publish(stamp);
}

void DeviceTopics::packet(const protocol::ServerPacket& packet, std::uint8_t type,
                          const v1::Stamp& stamp) {
  if (const auto* aux = std::get_if<protocol::AuxPacket>(&packet)) {
    serial_data_.write({.stamp = stamp, .port = aux->line, .data = aux->bytes});
    return;
  }
  const auto* const configuration = std::get_if<protocol::ConfigPacket>(&packet);
  if (configuration != nullptr && !reflector_.devices().reports().configuration)
    tell(*configuration);
  reflector_.devices().reflect(packet, type);
}

void DeviceTopics::tell(const protocol::ConfigPacket& robot) {
  node_.info("the robot's serial number is " + robot.serial +
             (robot.firmware.empty() ? "" : ", its firmware " + robot.firmware));
  if (robot.cycle != 0 && robot.cycle != 100)
    node_.warn("the robot sends its packets every " + std::to_string(robot.cycle) +
               " ms; a cycle here is 100 ms: set its SInfoCycle to 100");
}

void DeviceTopics::publish(const v1::Stamp& stamp) {
  const protocol::Information& in = reflector_.state().information;
  const Shown now{in.front_bumpers, in.rear_bumpers, in.motors_on,       in.emergency_stop,
                  in.faults,        in.charge_state, in.state_of_charge, in.compass,
                  in.gripper_bits,  in.temperature};
  for (const reflector::DeviceRequest& request : reflector_.devices().take_answered())
    desk_.answer(request.asker, request.number, request.answer);
  const bool changed = reflector_.devices().take_changed();
  if (!changed && now == shown_)
    return;
  shown_ = now;
  devices_.write(
      to_bus(reflector_.devices().requests(), reflector_.devices().reports(), in, stamp));
  for (const std::string& trouble : reflector_.devices().take_troubles())
    node_.warn(trouble);
}

}  // namespace saphira::bridge
