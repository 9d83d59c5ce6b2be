#include "device_topics.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "convert.hpp"

namespace saphira::bridge {

DeviceTopics::DeviceTopics(bus::Node& node, reflector::Reflector& reflector)
    : node_(node),
      reflector_(reflector),
      devices_(node.writer(bus::topics::kDevices)),
      serial_data_(node.writer(bus::topics::kSerialData)),
      servo_(node.reader(bus::topics::kServo)),
      gripper_(node.reader(bus::topics::kGripper)),
      output_(node.reader(bus::topics::kDigitalOutput)),
      analog_(node.reader(bus::topics::kAnalog)),
      timer_(node.reader(bus::topics::kTimer)),
      sonar_(node.reader(bus::topics::kSonar)),
      sound_(node.reader(bus::topics::kSound)),
      server_(node.reader(bus::topics::kServer)),
      serial_(node.reader(bus::topics::kSerial)) {}

template <class T>
void DeviceTopics::take(bus::Reader<T>& reader, v1::Device device, bool session) {
  for (const auto& sample : reader.take()) {
    if (sample.info.disposed)
      continue;
    const std::string who = source_of(sample.data);
    std::string why = "no robot is connected";
    if (session) {
      try {
        const reflector::Wish wish = to_wish(sample.data);
        reflector_.request(who, sample.data.request(), wish);
        node_.info(text(wish) + ", asked for by " + who);
        continue;
      } catch (const std::invalid_argument& error) {
        why = error.what();
      }
    }
    ++refused_;
    reflector_.devices().refuse(device, who, sample.data.request(), "", why);
  }
}

void DeviceTopics::take(const v1::Stamp& stamp, bool session) {
  // Most of the time nobody has anything to ask. The last words of who has just left are heard.
  const std::size_t asking = servo_.matched() + gripper_.matched() + output_.matched() +
                             analog_.matched() + timer_.matched() + sonar_.matched() +
                             sound_.matched() + server_.matched() + serial_.matched();
  const std::size_t asked = std::exchange(askers_, asking);
  if (asking == 0 && asked == 0)
    return;
  take(servo_, v1::DEVICE_SERVO, session);
  take(gripper_, v1::DEVICE_GRIPPER, session);
  take(output_, v1::DEVICE_DIGITAL_OUTPUT, session);
  take(analog_, v1::DEVICE_ANALOG, session);
  take(timer_, v1::DEVICE_TIMER, session);
  take(sonar_, v1::DEVICE_SONAR, session);
  take(sound_, v1::DEVICE_SOUND, session);
  take(server_, v1::DEVICE_SERVER, session);
  take(serial_, v1::DEVICE_SERIAL, session);
  publish(stamp);
}

void DeviceTopics::packet(const protocol::ServerPacket& packet, std::uint8_t type,
                          const v1::Stamp& stamp) {
  if (const auto* aux = std::get_if<protocol::AuxPacket>(&packet)) {
    v1::SerialData data;
    data.stamp(stamp);
    data.port(aux->line);
    data.data(aux->bytes);
    serial_data_.write(data);
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
