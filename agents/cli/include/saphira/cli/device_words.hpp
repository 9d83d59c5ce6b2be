#pragma once

#include <string>
#include <vector>

#include "saphira/bus/topics.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::cli {

/// A request to a device, and its topic.
struct DeviceCommand {
  const bus::RequestTopic* topic = nullptr;
  Request request;
};

/// The requests that a device takes, as people type them; one line each.
extern const char* const kDeviceWords;

/// The devices, in that order.
std::vector<std::string> device_names();

/// A device command as a person types it: the device and its action (kDeviceWords).
/// std::invalid_argument with the expected form for any other.
DeviceCommand parse_device(const std::vector<std::string>& words);

/// The state of the robot's devices: name and value, of the existing ones. For a robot without
/// robot/devices (an older bridge; null), from its state.
std::vector<std::vector<std::string>> device_rows(const v1::RobotState& robot,
                                                  const v1::Devices* devices);

}  // namespace saphira::cli
